"""Every port for images refuses what is none by one error, which says what it got and what makes an image of it; every
port refuses data with an array that has not a value for each point, cell or row, which would be read beyond its end."""
import os

import numpy
import tyndall
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import (
    vtkAMRBox, vtkDataObject, vtkHierarchicalBoxDataSet, vtkHyperTreeGrid, vtkImageData, vtkMultiBlockDataSet,
    vtkMutableDirectedGraph, vtkOverlappingAMR, vtkPartitionedDataSet, vtkPartitionedDataSetCollection, vtkPolyData,
    vtkRectilinearGrid, vtkStructuredGrid, vtkTable, vtkUniformGrid, vtkUnstructuredGrid)
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm

count = 4


def filled(image, spacing=1.0):
    """An image with all that a filter may want of its medium or its light."""
    image.SetDimensions((count + 1,) * 3)
    image.SetSpacing((spacing,) * 3)
    for name, components in (("sigma_a", 1), ("sigma_s", 1), ("ior", 1), ("fluence", 1), ("fluence_direct", 1),
                             ("fluence_batches", 2)):
        array = numpy_to_vtk(numpy.ones((count**3, components), dtype=numpy.float32), deep=True)
        array.SetName(name)
        image.GetCellData().AddArray(array)
    image.GetCellData().SetActiveScalars("sigma_s")
    return image


def rectilinear():
    grid = vtkRectilinearGrid()
    grid.SetDimensions(3, 3, 3)
    for place in (grid.SetXCoordinates, grid.SetYCoordinates, grid.SetZCoordinates):
        place(numpy_to_vtk(numpy.array([0.0, 1.0, 3.0]), deep=True))
    return grid


def structured():
    grid = vtkStructuredGrid()
    grid.SetDimensions(2, 2, 2)
    return grid


def tree():
    grid = vtkHyperTreeGrid()
    grid.SetDimensions(2, 2, 2)
    return grid


def amr(kind):
    """Two levels of images, the finer one in a corner of the coarser."""
    made = kind()
    made.Initialize(2, [1, 1])
    made.SetOrigin((0.0, 0.0, 0.0))
    for level, spacing in ((0, 1.0), (1, 0.5)):
        made.SetSpacing(level, (spacing,) * 3)
        made.SetAMRBox(level, 0, vtkAMRBox((0, 0, 0), (count - 1,) * 3))
        made.SetDataSet(level, 0, filled(vtkUniformGrid(), spacing))
    return made


def blocks(make):
    made = vtkMultiBlockDataSet()
    for i in range(2):
        made.SetBlock(i, make())
    return made


def partitions(make):
    made = vtkPartitionedDataSet()
    made.SetPartition(0, make())
    return made


def collection(make):
    made = vtkPartitionedDataSetCollection()
    for i in range(2):
        made.SetPartition(i, 0, make())
    return made


def image():
    return filled(vtkImageData())


# What an error names, and the data.
KINDS = [(data.GetClassName(), data) for data in (
    rectilinear(), structured(), vtkUnstructuredGrid(), vtkPolyData(), vtkTable(), vtkMutableDirectedGraph(), tree(),
    amr(vtkOverlappingAMR), amr(vtkHierarchicalBoxDataSet))]
IN_BLOCKS = [("vtkRectilinearGrid", make(rectilinear)) for make in (blocks, partitions, collection)]


def messages(algorithm):
    """What an update says."""
    window, said = vtkOutputWindow.GetInstance(), vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(said)
    algorithm.Write() if hasattr(algorithm, "Write") else algorithm.Update()
    vtkOutputWindow.SetInstance(window)
    return said.GetOutput()


def ports_for_images(algorithm):
    """Those that take any data: one that takes images alone would leave the word to VTK."""
    for port in range(algorithm.GetNumberOfInputPorts()):
        taken = algorithm.GetInputPortInformation(port).Get(vtkAlgorithm.INPUT_REQUIRED_DATA_TYPE(), 0)
        assert taken != "vtkImageData", (algorithm.GetClassName(), port)
        if taken in ("vtkDataSet", "vtkDataObject"):
            yield port


sun = tyndall.vtkLightRig()


def photons():
    emitter = tyndall.vtkPhotonEmitter()
    emitter.SetPhotonCount(100)
    emitter.SetInputData(image())
    emitter.SetLightsConnection(sun.GetOutputPort())
    emitter.Update()
    return emitter.GetOutputDataObject(0)


def propagated():
    first = tyndall.vtkLPMPropagate()
    first.SetInputData(image())
    first.SetSkyColor(1.0, 1.0, 1.0)
    first.Update()
    return first.GetOutputDataObject(0)


def with_valid_input(name):
    made = getattr(tyndall, name)()
    made.SetInputDataObject(0, propagated() if name == "vtkLPMCollect" else image())
    if hasattr(made, "SetLightsConnection"):
        made.SetLightsConnection(sun.GetOutputPort())
    if name == "vtkPhotonMarcher":
        made.SetPhotonsData(photons())
    if name == "vtkVDBWriter":
        made.SetFileName("refused.vdb")
    return made


def is_empty(algorithm):
    for port in range(algorithm.GetNumberOfOutputPorts()):
        output = algorithm.GetOutputDataObject(port)
        if any(output.GetNumberOfElements(kind) > 0 for kind in (vtkDataObject.CELL, vtkDataObject.ROW)):
            return False
    return True


def refuses(algorithm, port, named, data):
    case = (algorithm.GetClassName(), port, named, data.GetClassName())
    before = algorithm.GetInputDataObject(port, 0)
    algorithm.SetInputDataObject(port, data)
    said = messages(algorithm)
    assert said.count("ERROR") == 1 and "Warning" not in said, case + (said,)
    for word in (algorithm.GetClassName(), " is a " + named + ";", "ResampleToImage"):
        assert word in said, case + (said,)
    if isinstance(algorithm, tyndall.vtkVDBWriter):
        assert not os.path.exists(algorithm.GetFileName()), case
    else:
        assert is_empty(algorithm), case
        assert messages(algorithm) == "", case  # once
    algorithm.SetInputDataObject(port, before)


def spoilt(data):
    """Copies with one array that is too short, of each kind that the data have."""
    for kind, of in ((vtkDataObject.POINT, "points"), (vtkDataObject.CELL, "cells"), (vtkDataObject.ROW, "rows")):
        count = data.GetNumberOfElements(kind) if data.GetAttributes(kind) else 0
        if count == 0:
            continue
        made = data.NewInstance()
        made.ShallowCopy(data)
        array = numpy_to_vtk(numpy.ones(count - 1), deep=True)
        array.SetName("short")
        made.GetAttributes(kind).AddArray(array)
        yield of, made


def refuses_short_arrays(algorithm):
    for port in range(algorithm.GetNumberOfInputPorts()):
        before = algorithm.GetInputDataObject(port, 0)
        for of, data in spoilt(before) if before else ():
            algorithm.SetInputDataObject(port, data)
            said = messages(algorithm)
            case = (algorithm.GetClassName(), port, of, said)
            assert said.count("ERROR") == 1 and "Warning" not in said, case
            assert "values where the dataset has " in said and of + " (input %d" % port in said, case
            assert isinstance(algorithm, tyndall.vtkVDBWriter) or is_empty(algorithm), case
            yield port, of
        algorithm.SetInputDataObject(port, before)


FILTERS = [name for name in dir(tyndall) if isinstance(getattr(tyndall, name), type)
           and issubclass(getattr(tyndall, name), vtkAlgorithm) and name not in ("vtkLitVolumeMapper",)]
tried = 0
short = 0
for name in FILTERS:
    try:
        algorithm = getattr(tyndall, name)()
    except (TypeError, NotImplementedError):  # abstract
        continue
    if not list(ports_for_images(algorithm)):
        continue
    algorithm = with_valid_input(name)
    for port in ports_for_images(algorithm):
        for named, data in KINDS:
            refuses(algorithm, port, named, data)
        for named, data in IN_BLOCKS:
            refuses(algorithm, port, data.GetClassName() if name == "vtkVDBWriter" else named, data)
    short += len(list(refuses_short_arrays(algorithm)))
    said = messages(algorithm)
    assert "ERROR" not in said, (name, said)
    if name == "vtkVDBWriter":
        os.remove(algorithm.GetFileName())
    else:
        assert not is_empty(algorithm), name
    tried += 1
assert tried == 14, tried
assert short > 2 * tried, short

# A table whose columns are not as long as each other.
table = vtkTable()
for column, rows in (("cosine", 5), ("value", 3)):
    array = numpy_to_vtk(numpy.linspace(-1.0, 1.0, rows), deep=True)
    array.SetName(column)
    table.GetRowData().AddArray(array)
medium = with_valid_input("vtkParticipatingMedium")
medium.SetPhaseFunction(medium.TABULATED)
medium.SetPhaseTableData(table)
said = messages(medium)
assert said.count("ERROR") == 1 and "'value' has 3 values where the dataset has 5 rows" in said, said

# Images in blocks are worked on one by one, where the filter has an output; one image is written.
for make, parts in ((blocks, 2), (collection, 2), (partitions, 1)):
    octree = tyndall.vtkRefractionOctree()
    octree.SetInputDataObject(make(image))
    assert messages(octree) == ""
    assert octree.GetOutputDataObject(0).GetNumberOfCells() == parts * count**3, make
writer = with_valid_input("vtkVDBWriter")
refuses(writer, 0, "vtkPartitionedDataSetCollection", collection(image))
assert messages(writer) == "" and os.path.exists("refused.vdb")
os.remove("refused.vdb")
