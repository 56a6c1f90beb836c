"""What is no image is refused from scripts, too, by one error that names Resample To Image; images in blocks are solved one by one,
with one warning."""
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkRectilinearGrid, vtkTable
from vtkmodules.util.numpy_support import numpy_to_vtk
import numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
window = vtkOutputWindow.GetInstance()  # Python prints there, too

wavelet = Wavelet(WholeExtent=[-3, 3, -3, 3, -3, 3])
wavelet.UpdatePipeline()


def rectilinear():
    grid = vtkRectilinearGrid()
    grid.SetDimensions(3, 3, 3)
    for place in (grid.SetXCoordinates, grid.SetYCoordinates, grid.SetZCoordinates):
        place(numpy_to_vtk(numpy.array([0.0, 1.0, 3.0]), deep=1))
    density = numpy_to_vtk(numpy.ones(8), deep=1)
    density.SetName("RTData")
    grid.GetCellData().SetScalars(density)
    producer = TrivialProducer()
    producer.GetClientSideObject().SetOutput(grid)
    return producer


def messages(proxy):
    """What an update says."""
    said = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(said)
    proxy.UpdatePipeline()
    vtkOutputWindow.SetInstance(window)
    return said.GetOutput()


def table():
    producer = TrivialProducer()
    producer.GetClientSideObject().SetOutput(vtkTable())
    return producer


def leaves(proxy):
    """The blocks of its output, on the server: Fetch of ParaView 5.11 does not bring partitioned collections."""
    proxy.UpdatePipeline()
    found = []
    iterator = proxy.GetClientSideObject().GetOutputDataObject(0).NewIterator()
    while not iterator.IsDoneWithTraversal():
        found.append(iterator.GetCurrentDataObject())
        iterator.GoToNextItem()
    return found


def write(Input):
    """A writer, which writes where it is updated."""
    file = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "other.vdb")
    return servermanager.writers.VDBWriter(Input=Input, FileName=file)


medium = ParticipatingMedium(Input=wavelet)
glass = MeshVoxelizer(Input=Sphere(), SampleDimensions=[6, 6, 6])
photons = PhotonEmitter(Input=glass, Lights=LightRig(), PhotonCount=100)
marched = PhotonMarcher(Input=glass, Photons=photons)
# What makes a filter of an input, and an input that it takes.
cases = [(ParticipatingMedium, wavelet), (LightPropagationMaps, medium), (DiscreteOrdinates, medium),
         (LatticeBoltzmannLighting, medium), (MediumRayCaster, LightPropagationMaps(Input=medium)), (RefractionOctree, glass),
         (lambda Input: PhotonMarcher(Input=Input, Photons=photons), glass),
         (lambda Input: PhotonReconstruction(Input=Input, Scheme="Constant radius"), marched),
         (LPMCollect, LPMPropagate(Input=medium, SkyColor=[1, 1, 1])), (write, wavelet)]
others = (("vtkRectilinearGrid", rectilinear()), ("vtkUnstructuredGrid", AppendDatasets(Input=[wavelet])),
          ("vtkOverlappingAMR", ImageDataToAMR(Input=wavelet)), ("vtkTable", table()))
for kind, source in others:
    source.UpdatePipeline()
    for make, taken in cases:
        SetActiveSource(source)  # whose arrays a script's filter begins with, whatever its Input is
        proxy = make(Input=source)
        said = messages(proxy)
        case = (proxy.GetXMLName(), kind, said)
        assert said.count("ERROR") == 1 and "ResampleToImage" in said and " is a " + kind + ";" in said, case
        if make is not write:
            assert servermanager.Fetch(proxy).GetNumberOfCells() == 0, case
            assert messages(proxy) == "", case  # once
        proxy.Input = taken
        said = messages(proxy)
        assert said.count("ERROR") == 0, case + (said,)
        assert make is write or servermanager.Fetch(proxy).GetNumberOfCells() > 0, case

wavelet = Wavelet(WholeExtent=[-6, 0, -3, 3, -3, 3])  # without voxel (0, 0, 0)
alone = vtk_to_numpy(servermanager.Fetch(LightPropagationMaps(
    Input=ParticipatingMedium(Input=wavelet, MaximumDensity=100))).GetCellData().GetArray("fluence"))
for group in ("vtkMultiBlockDataSet", "vtkPartitionedDataSetCollection"):
    medium = ParticipatingMedium(Input=GroupDatasets(Input=[wavelet, wavelet], OutputType=group), MaximumDensity=100)
    assert messages(medium) == "", group
    light = LightPropagationMaps(Input=medium)
    said = messages(light)
    assert said.count(" is a ") == 1 and group + " of 2 blocks. Each is lit as if it were alone" in said, (group, said)
    blocks = leaves(light)
    assert len(blocks) == 2, (group, blocks)
    for block in blocks:
        assert (vtk_to_numpy(block.GetCellData().GetArray("fluence")) == alone).all(), group
    grids = GroupDatasets(Input=[others[0][1], others[0][1]], OutputType=group)
    said = messages(RefractionOctree(Input=grids))
    assert said.count("ERROR") == 1 and "ResampleToImage" in said and "vtkRectilinearGrid" in said, (group, said)
    said = messages(write(grids))
    assert said.count("ERROR") == 1 and "ResampleToImage" in said, (group, said)
