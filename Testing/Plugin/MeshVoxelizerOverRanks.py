"""Two ranks: the mesh is in pieces, the medium is made of the whole, and each rank has its half."""
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
medium.UpdatePropertyInformation()
assert abs(medium.OccupiedVolume - 4.15) < 0.1, medium.OccupiedVolume
