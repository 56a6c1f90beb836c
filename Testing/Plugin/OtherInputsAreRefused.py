"""What is no image is refused from scripts, too, by one error that names Resample To Image; images in blocks are solved one by one."""
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkRectilinearGrid
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


solvers = (LightPropagationMaps, DiscreteOrdinates, LatticeBoltzmannLighting)
for kind, source in (("vtkRectilinearGrid", rectilinear()), ("vtkUnstructuredGrid", AppendDatasets(Input=[wavelet]))):
    source.UpdatePipeline()
    for make in (ParticipatingMedium, *solvers):
        proxy = make(Input=source)
        said = messages(proxy)
        assert said.count("ERROR") == 1 and "ResampleToImage" in said and kind in said, (make, kind, said)
        assert servermanager.Fetch(proxy).GetNumberOfCells() == 0, (make, kind)
        assert messages(proxy) == "", (make, kind)  # once
        proxy.Input = wavelet if make is ParticipatingMedium else ParticipatingMedium(Input=wavelet)
        assert messages(proxy).count("ERROR") == 0, (make, kind)
        assert servermanager.Fetch(proxy).GetNumberOfCells() == 216, (make, kind)

medium = ParticipatingMedium(Input=GroupDatasets(Input=[wavelet, wavelet]), MaximumDensity=100)
alone = vtk_to_numpy(servermanager.Fetch(LightPropagationMaps(
    Input=ParticipatingMedium(Input=wavelet, MaximumDensity=100))).GetCellData().GetArray("fluence"))
blocks = servermanager.Fetch(LightPropagationMaps(Input=medium))
assert blocks.GetNumberOfBlocks() == 2, blocks
for i in range(2):
    assert (vtk_to_numpy(blocks.GetBlock(i).GetCellData().GetArray("fluence")) == alone).all(), i
