"""Two ranks: the mesh is in pieces, each rank gets all of it and makes its half of the medium, which is that of the whole."""
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
assert servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions() == 2

medium = MeshVoxelizer(Input=Sphere(Radius=1, ThetaResolution=40, PhiResolution=40), SampleDimensions=[16, 16, 16])
medium.UpdatePipeline()
piece = medium.GetClientSideObject().GetOutputDataObject(0)
assert piece.GetNumberOfCells() == 16 ** 3 / 2, piece.GetExtent()
occupancy = vtk_to_numpy(piece.GetCellData().GetArray("occupancy"))
assert occupancy.max() == 1 and abs(occupancy.sum() * piece.GetSpacing()[0] ** 3 - 4.15 / 2) < 0.05  # half of the ball
whole = MeshVoxelizer(Input=Sphere(Radius=1, ThetaResolution=40, PhiResolution=40), SampleDimensions=[16, 16, 16])
algorithm = whole.GetClientSideObject()
algorithm.Update()  # each rank by itself
all = algorithm.GetOutputDataObject(0)
assert all.GetNumberOfCells() == 16 ** 3
all.Crop(piece.GetExtent())
for name in ("occupancy", "ior", "ior_gradient", "sigma_a", "sigma_s"):
    found, wanted = (vtk_to_numpy(image.GetCellData().GetArray(name)) for image in (piece, all))
    assert found.size and (found == wanted).all(), name
medium.UpdatePropertyInformation()
assert abs(medium.OccupiedVolume - 4.15) < 0.1, medium.OccupiedVolume
