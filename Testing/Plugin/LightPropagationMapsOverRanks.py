"""Two ranks: each solves the whole and hands on its piece, so that there is no seam where the pieces meet. Points are
voxels, as they are without --symmetric: proxies begin with arrays that have ParaView average nothing."""
import os

import numpy as np

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray
from vtkmodules.vtkParallelCore import vtkCommunicator, vtkMultiProcessController

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


def voxels_of_all(proxy):
    """Over all ranks."""
    proxy.UpdatePipeline()
    own, all_ = vtkIntArray(), vtkIntArray()
    cells = proxy.GetClientSideObject().GetOutputDataObject(0)
    ghosts = cells.GetCellGhostArray()  # the plane of points that both have
    own.InsertNextValue(cells.GetNumberOfCells() - (np.count_nonzero(vtk_to_numpy(ghosts)) if ghosts else 0))
    vtkMultiProcessController.GetGlobalController().AllReduce(own, all_, vtkCommunicator.SUM_OP)
    return all_.GetValue(0)


small = Wavelet(WholeExtent=[0, 4, 0, 5, 0, 6])
index = Calculator(Input=small, ResultArrayName="ior", Function="1 + 0.001 * coordsX")
absorbing = Calculator(Input=index, ResultArrayName="sigma_a", Function="0.1")
scattering = Calculator(Input=absorbing, ResultArrayName="sigma_s", Function="0.2")
for solver in (LightPropagationMaps, DiscreteOrdinates, LatticeBoltzmannLighting, RefractionOctree):
    of_points = solver(Input=scattering, **({"SkyColor": [1, 1, 1]} if solver != RefractionOctree else {}))
    assert voxels_of_all(of_points) == 5 * 6 * 7, (solver.__name__, voxels_of_all(of_points))
