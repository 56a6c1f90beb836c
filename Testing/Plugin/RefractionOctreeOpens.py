"""The octree opens in ParaView: its nodes are drawn, converted, saved and read again, and equal the image's levels."""
import os

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())

# A ball of glass in air, on a grid that is no power of two, of unequal spacing, that begins elsewhere than at 0.
size, spacing, first = (37, 24, 50), (0.5, 1.0, 0.25), (-3, 5, 20)
image = ProgrammableSource(OutputDataSetType="vtkImageData")
image.ScriptRequestInformation = """
from paraview.vtk import vtkStreamingDemandDrivenPipeline as Pipeline
extent = [%d, %d, %d, %d, %d, %d]
self.GetExecutive().GetOutputInformation(0).Set(Pipeline.WHOLE_EXTENT(), extent, 6)
""" % tuple(bound for axis in range(3) for bound in (first[axis], first[axis] + size[axis]))
image.Script = """
import numpy
from paraview.vtk.util.numpy_support import numpy_to_vtk
size, spacing, first = %r, %r, %r
data = self.GetImageDataOutput()
data.SetExtent([b for a in range(3) for b in (first[a], first[a] + size[a])])
data.SetSpacing(spacing)
z, y, x = numpy.meshgrid(*[numpy.arange(size[a]) - 0.4 * size[a] for a in (2, 1, 0)], indexing="ij")
n = numpy.where(x * x + y * y + z * z / 4 < 64, 1.5, 1.0).astype("f").ravel()
array = numpy_to_vtk(n, deep=True)
array.SetName("ior")
data.GetCellData().AddArray(array)
""" % (size, spacing, first)
image.UpdatePipeline()

octree = RefractionOctree(Input=image)
assert list(octree.GetPropertyValue("IndexArray")) == ["CELLS", "ior"], octree.IndexArray
octree.UpdatePipeline()
octree.UpdatePropertyInformation()
levels = vtk_to_numpy(servermanager.Fetch(octree).GetCellData().GetArray("octree_level"))
assert levels.dtype == numpy.uint8 and len(levels) == size[0] * size[1] * size[2]
assert levels.min() == 0 and levels.max() >= 3, (levels.min(), levels.max())
levels = levels.reshape(size[::-1])


def check_nodes(cells):
    """Unstructured cells, one a node, against the levels of the image."""
    assert cells.GetNumberOfCells() == octree.NodeCount, (cells.GetNumberOfCells(), octree.NodeCount)
    of_nodes = vtk_to_numpy(cells.GetCellData().GetArray("octree_level"))
    covered = numpy.zeros(levels.shape, int)
    for cell in range(cells.GetNumberOfCells()):
        bounds = cells.GetCell(cell).GetBounds()
        low = [round(bounds[2 * a] / spacing[a]) - first[a] for a in range(3)]
        high = [round(bounds[2 * a + 1] / spacing[a]) - first[a] for a in range(3)]
        assert [h - l for l, h in zip(low, high)] == [1 << of_nodes[cell]] * 3, (low, high, of_nodes[cell])
        inside = tuple(slice(low[a], high[a]) for a in (2, 1, 0))
        assert (levels[inside] == of_nodes[cell]).all(), (low, of_nodes[cell])
        covered[inside] += 1
    assert (covered == 1).all()


nodes = OutputPort(octree, 1)
assert nodes.GetDataInformation().GetDataSetTypeAsString() == "vtkHyperTreeGrid"
as_cells = HyperTreeGridToUnstructuredGrid(Input=nodes)
check_nodes(servermanager.Fetch(as_cells))

# Saved by ParaView and opened again.
file = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "octree.htg")
SaveData(file, proxy=nodes)
again = OpenDataFile(file)
check_nodes(servermanager.Fetch(HyperTreeGridToUnstructuredGrid(Input=again)))

# Drawn: something of each level's colour is there.
view = CreateView("RenderView")
view.ViewSize = [200, 200]
view.UseColorPaletteForBackground = 0
view.Background = [0, 0, 0]
shown = Show(nodes, view)
ColorBy(shown, ("CELLS", "octree_level"))
view.OrientationAxesVisibility = 0
view.ResetCamera()
Render(view)
picture = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "octree.png")
SaveScreenshot(picture, view)
pixels = vtk_to_numpy(servermanager.Fetch(OpenDataFile(picture)).GetPointData().GetArray(0))
assert len(numpy.unique(pixels[:, :3], axis=0)) > 3 and (pixels[:, :3].max(axis=1) > 0).mean() > 0.2

# What the panel sets.
few = octree.NodeCount
octree.Tolerance = 1
octree.UpdatePipeline()
octree.UpdatePropertyInformation()
assert octree.NodeCount == 1 < few and servermanager.Fetch(octree).GetCellData().GetArray("octree_level").GetRange() == (6, 6)
assert octree.Seconds > 0 and octree.DeviceName and not octree.LeftOut
