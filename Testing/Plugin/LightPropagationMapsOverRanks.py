"""Two ranks: each solves the whole and hands on its piece, so that there is no seam where the pieces meet."""
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
assert servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions() == 2

whole = (0, 8, 0, 6, 0, 12)
wavelet = Wavelet(WholeExtent=whole)
medium = ParticipatingMedium(Input=wavelet, MinimumDensity=0, MaximumDensity=0,  # 1 everywhere
                             PointData="Average To Cells")
light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1])
light.UpdatePipeline()

piece = light.GetClientSideObject().GetOutputDataObject(0)
extent = piece.GetExtent()
assert piece.GetNumberOfCells() == 8 * 6 * 12 / 2
axis = [a for a in range(3) if extent[2 * a : 2 * a + 2] != whole[2 * a : 2 * a + 2]]
assert len(axis) == 1, extent  # one axis is split
axis = axis[0]
size = [extent[2 * a + 1] - extent[2 * a] for a in range(3)]
fluence = vtk_to_numpy(piece.GetCellData().GetArray("fluence")).reshape(size[::-1])
layers = fluence.mean(axis=tuple(a for a in range(3) if a != 2 - axis))
if extent[2 * axis] != whole[2 * axis]:
    layers = layers[::-1]  # from the outside to the seam
assert layers[-1] < 0.85 * layers[0], layers

entered, emitted, absorbed, escaped, left = vtk_to_numpy(piece.GetFieldData().GetArray("energy_balance"))
area = 2 * (8 * 6 + 6 * 12 + 12 * 8)
assert abs(entered / (area * 3.14159265) - 1) < 0.03, entered  # into the whole, not into the piece
