"""The octree opens in ParaView: its nodes are drawn, converted, saved and read again, and equal the image's levels."""
import os

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkImageData
from paraview.vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())

# Half a ball of glass in air, on a grid that is no power of two, of unequal spacing, that begins elsewhere than at 0.
size, spacing, first = (37, 24, 50), (0.5, 1.0, 0.25), (-3, 5, 20)
z, y, x = numpy.meshgrid(*[numpy.arange(size[a]) - (0.4, 0.4, 1)[a] * size[a] for a in (2, 1, 0)], indexing="ij")
index = numpy_to_vtk(numpy.where(x * x + y * y + z * z / 4 < 64, 1.5, 1.0).astype("f").ravel(), deep=True)
index.SetName("ior")
data = vtkImageData()
data.SetExtent([bound for a in range(3) for bound in (first[a], first[a] + size[a])])
data.SetSpacing(spacing)
data.GetCellData().AddArray(index)
image = TrivialProducer()
image.GetClientSideObject().SetOutput(data)
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

# Drawn, with its nodes of several levels on the face that is seen.
view = CreateView("RenderView")
view.ViewSize = [200, 200]
view.OrientationAxesVisibility = 0
shown = Show(nodes, view)
shown.Representation = "Surface With Edges"
ColorBy(shown, ("CELLS", "octree_level"))
view.ResetCamera()
Render(view)
colors = numpy.unique(vtk_to_numpy(view.CaptureWindow(1).GetPointData().GetScalars()), axis=0)
assert len(colors) > 4, colors

# What the panel sets.
few = octree.NodeCount
octree.Tolerance = 1
octree.UpdatePipeline()
octree.UpdatePropertyInformation()
assert octree.NodeCount == 1 < few and servermanager.Fetch(octree).GetCellData().GetArray("octree_level").GetRange() == (6, 6)
assert octree.Seconds > 0 and octree.DeviceName and not octree.LeftOut
