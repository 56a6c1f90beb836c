"""Two ranks: each finds the whole map, and marches photons through its piece, whose light it smooths to that of the whole."""
import os

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


def copies(algorithm):
    """The images on all ports of a filter."""
    images = [vtkImageData() for port in range(algorithm.GetNumberOfOutputPorts())]
    for port, image in enumerate(images):
        image.DeepCopy(algorithm.GetOutputDataObject(port))
    return images


def check(proxy, names, sizes, precision=0):
    """Whether the rank's pieces are those of the whole, to so much of the largest: arrays and voxels of each port."""
    proxy.UpdatePipeline()  # in pieces, as a view of ParaView asks for them
    algorithm = proxy.GetClientSideObject()
    pieces = copies(algorithm)
    for asking in range(len(pieces)):  # all ports follow the one that asks
        asked = algorithm.GetOutputInformation(asking)
        asked.Set(Pipeline.UPDATE_PIECE_NUMBER(), 0)
        asked.Set(Pipeline.UPDATE_NUMBER_OF_PIECES(), 1)
        algorithm.Modified()
        algorithm.GetExecutive().Update(asking)
        for port, whole in enumerate(copies(algorithm)):
            what = names[port], pieces[port].GetExtent(), whole.GetExtent()
            assert [d - 1 for d in whole.GetDimensions()] == sizes[port], what
            assert 0 < pieces[port].GetNumberOfCells() < whole.GetNumberOfCells(), what
            largest = {name: abs(vtk_to_numpy(whole.GetCellData().GetArray(name))).max() for name in names[port]}
            whole.Crop(pieces[port].GetExtent())
            for name in names[port]:
                found, wanted = (vtk_to_numpy(image.GetCellData().GetArray(name)) for image in (pieces[port], whole))
                assert found.size and (abs(found - wanted) <= precision * largest[name]).all(), (name, what)


check(importance, [["importance"], ["fluence", "photon_count", "origin_mean", "chosen"]], [[32, 32, 2], [8, 8, 6]])
light.Scheme = "As published"
check(light, [["fluence", "mean_direction", "mip_level"]], [[20, 16, 12]], 1e-6)
light.Scheme = "Conservative"
check(light, [["fluence", "fluence_error", "mean_direction", "mip_level"]], [[20, 16, 12]], 1e-6)
own = emitter.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints()
assert own > 7900, own  # each rank's marcher asks for all
light.UpdatePropertyInformation()
importance.UpdatePropertyInformation()
assert light.MeanError > 0 and importance.UsedGradientThreshold > 0
