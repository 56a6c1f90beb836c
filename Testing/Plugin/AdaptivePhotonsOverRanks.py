"""Two ranks: each finds the whole map and smooths the whole light, and hands on its piece."""
import os

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkImageData
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
assert servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions() == 2
rank = servermanager.vtkProcessModule.GetProcessModule().GetPartitionId()

ball = Sphere(Radius=0.6, ThetaResolution=32, PhiResolution=32)
medium = MeshVoxelizer(Input=ball, SampleDimensions=[20, 16, 12])
lights = LightRig(SunElevation=60, PointLights=[0, 0, 3, 5, 5, 5])
importance = PhotonImportance(Input=medium, Lights=lights, PilotCount=1024, PilotDimensions=[8, 8, 6])
emitter = PhotonEmitter(Input=medium, Lights=lights, ImportanceMap=importance, PhotonCount=8000)
marcher = PhotonMarcher(Input=medium, Photons=emitter, PhotonCounts=1)
light = PhotonReconstruction(Input=marcher)


def check(proxy, port, name, size):
    """Whether the rank's piece is that of the whole."""
    algorithm = proxy.GetClientSideObject()
    piece = vtkImageData()
    piece.DeepCopy(algorithm.GetOutputDataObject(port))
    cells = numpy.prod(size)
    assert 0 < piece.GetNumberOfCells() < cells, (name, piece.GetExtent())
    algorithm.UpdateWholeExtent()
    whole = vtkImageData()
    whole.DeepCopy(algorithm.GetOutputDataObject(port))
    assert [d - 1 for d in whole.GetDimensions()] == list(size), (name, whole.GetDimensions())
    whole.Crop(piece.GetExtent())
    found, wanted = (vtk_to_numpy(image.GetCellData().GetArray(name)) for image in (piece, whole))
    assert found.size and (found == wanted).all(), name
    return piece


# Asked for in pieces, as a view of ParaView does: first the light, which asks the map for all of it.
light.UpdatePipeline()
check(light, 0, "fluence", (20, 16, 12))
check(light, 0, "fluence_error", (20, 16, 12))
own = emitter.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints()
assert own > 7900, own  # each rank's marcher asks for all
importance.UpdatePipeline()
check(importance, 0, "importance", (32, 32, 2))
OutputPort(importance, 1).UpdatePipeline() if hasattr(OutputPort(importance, 1), "UpdatePipeline") else None
importance.UpdatePropertyInformation()
assert importance.UsedGradientThreshold > 0
