"""Two ranks: each finds the whole map and smooths the whole light, and hands on its piece."""
import os

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkImageData
from paraview.vtk import vtkStreamingDemandDrivenPipeline as Pipeline
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
assert servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions() == 2

ball = Sphere(Radius=0.6, ThetaResolution=32, PhiResolution=32)
medium = MeshVoxelizer(Input=ball, SampleDimensions=[20, 16, 12])
lights = LightRig(SunElevation=60, PointLights=[0, 0, 3, 5, 5, 5])
importance = PhotonImportance(Input=medium, Lights=lights, PilotCount=1024, PilotDimensions=[8, 8, 6])
emitter = PhotonEmitter(Input=medium, Lights=lights, ImportanceMap=importance, PhotonCount=8000)
marcher = PhotonMarcher(Input=medium, Photons=emitter, PhotonCounts=1)
light = PhotonReconstruction(Input=marcher)


def check(proxy, port, names, size):
    """Whether the rank's piece is that of the whole."""
    algorithm = proxy.GetClientSideObject()
    piece, whole = vtkImageData(), vtkImageData()
    piece.DeepCopy(algorithm.GetOutputDataObject(port))
    assert 0 < piece.GetNumberOfCells() < numpy.prod(size), (names, piece.GetExtent())
    asked = algorithm.GetOutputInformation(port)
    asked.Set(Pipeline.UPDATE_PIECE_NUMBER(), 0)
    asked.Set(Pipeline.UPDATE_NUMBER_OF_PIECES(), 1)
    algorithm.GetExecutive().Update(port)
    whole.DeepCopy(algorithm.GetOutputDataObject(port))
    assert [d - 1 for d in whole.GetDimensions()] == list(size), (names, whole.GetDimensions())
    whole.Crop(piece.GetExtent())
    for name in names:
        found, wanted = (vtk_to_numpy(image.GetCellData().GetArray(name)) for image in (piece, whole))
        assert found.size and (found == wanted).all(), name


# In pieces, as a view of ParaView asks for them: the map's layers are known only when it is made.
importance.UpdatePipeline()
check(importance, 0, ["importance"], (32, 32, 2))
pilot = OutputPort(importance, 1)
pilot.UpdatePipeline()
check(importance, 1, ["fluence", "photon_count", "origin_mean", "chosen"], (8, 8, 6))
light.UpdatePipeline()
check(light, 0, ["fluence", "fluence_error", "mean_direction", "mip_level"], (20, 16, 12))
own = emitter.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints()
assert own > 7900, own  # each rank's marcher asks for all
light.UpdatePropertyInformation()
importance.UpdatePropertyInformation()
assert light.MeanError > 0 and importance.UsedGradientThreshold > 0
