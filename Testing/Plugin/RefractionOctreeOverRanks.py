"""Two ranks: each has its piece of the levels, which are those of the whole, and the trees that begin in it."""
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
assert servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions() == 2
rank = servermanager.vtkProcessModule.GetProcessModule().GetPartitionId()

wavelet = Wavelet(WholeExtent=(0, 8, 0, 6, 0, 12))
even = Calculator(Input=wavelet, ResultArrayName="ior", Function="1.33")
uneven = Calculator(Input=wavelet, ResultArrayName="ior", Function="1 + 0.5 * coordsX / 8")
for medium, level, count in ((even, 4, 1), (uneven, 0, 8 * 6 * 12)):
    octree = RefractionOctree(Input=medium, PointData="Average To Cells")
    octree.UpdatePipeline()
    piece = octree.GetClientSideObject().GetOutputDataObject(0)
    assert piece.GetNumberOfCells() == 8 * 6 * 12 / 2, piece.GetExtent()
    levels = vtk_to_numpy(piece.GetCellData().GetArray("octree_level"))
    assert (levels == level).all(), levels  # of the whole: a piece of it alone would have level 3

    nodes = OutputPort(octree, 1)
    cells = HyperTreeGridToUnstructuredGrid(Input=nodes)
    cells.UpdatePipeline()
    own = cells.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells()
    trees = count / 2 if count > 1 else 1 - rank  # one node is one tree
    assert own == trees, (rank, own)
    octree.UpdatePropertyInformation()
    assert octree.NodeCount == count, octree.NodeCount
