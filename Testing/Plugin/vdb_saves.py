"""What VDBOverRanks.py runs: saves .vdb files with as many ranks as there are, or on a server.

    pvbatch [--symmetric] vdb_saves.py FOLDER [PORT]    PORT of a server
"""
import os
import sys

from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkFloatArray, vtkImageData, vtkUnsignedCharArray

folder = sys.argv[1]
if len(sys.argv) > 2:
    Connect("localhost", int(sys.argv[2]))
LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=len(sys.argv) > 2, ns=globals())
if len(sys.argv) > 2:
    LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=False, ns=globals())
module = servermanager.vtkProcessModule.GetProcessModule()
rank, ranks = module.GetPartitionId(), module.GetNumberOfLocalPartitions()
everywhere = len(sys.argv) == 2 and (module.GetSymmetricMPIMode() or ranks == 1)  # this script runs on every rank


def path(name):
    return os.path.join(folder, name)


# Points that are averaged, cells, vectors, integers and a medium's field data.
wavelet = Wavelet(WholeExtent=[-14, 15, 3, 30, -2, 9])
gradient = Gradient(Input=wavelet, ScalarArray=["POINTS", "RTData"])
cells = PointDatatoCellData(Input=wavelet, ProcessAllArrays=1)
level = Calculator(Input=cells, AttributeType="Cell Data", ResultArrayName="level", Function="floor(RTData / 50)",
                   ResultArrayType="Int")
SaveData(path("points.vdb"), proxy=gradient)
SaveData(path("cells.vdb"), proxy=level, Compression="Zip", Background=3.0)
SaveData(path("medium.vdb"), proxy=ParticipatingMedium(Input=cells, Preset=1,
                                                        DensityArray=["CELLS", "RTData"], MinimumDensity=0,
                                                        MaximumDensity=260))
half = Calculator(Input=cells, AttributeType="Cell Data", ResultArrayName="small", Function="RTData / 1000")
SaveData(path("half.vdb"), proxy=half, SaveAsHalf=1, Tolerance=0.01)

# A slab of one layer of cells, of which not every rank gets any.
SaveData(path("thin.vdb"), proxy=Wavelet(WholeExtent=[0, 2, 0, 1, 5, 6]))
SaveData(path("flat.vdb"), proxy=Wavelet(WholeExtent=[0, 9, 0, 8, 5, 5]))

# Failures: on all ranks, and the file that was there stays (VDBOverRanks.py looks).
huge = Calculator(Input=cells, AttributeType="Cell Data", ResultArrayName="huge", Function="RTData * 1000")
SaveData(path("kept.vdb"), proxy=huge, SaveAsHalf=1)
SaveData(path("no/such/folder.vdb"), proxy=cells)


def piece_of(extent, flags=None):
    """Cells of an image, which know where they are; `flags` says for a cell which vtkGhostType it has."""
    image = vtkImageData()
    image.SetExtent(extent)
    density, ghosts = vtkFloatArray(), vtkUnsignedCharArray()
    density.SetName("density")
    ghosts.SetName("vtkGhostType")
    for k in range(extent[4], extent[5]):
        for j in range(extent[2], extent[3]):
            for i in range(extent[0], extent[1]):
                flag = flags(i, j, k) if flags else 0
                ghosts.InsertNextValue(flag)
                density.InsertNextValue(-99.0 if flag & 1 else i + 100 * j + 10000 * k + 1)
    image.GetCellData().AddArray(density)
    if flags:
        image.GetCellData().AddArray(ghosts)
    return image


def save_pieces(name, pieces, whole):
    producer = servermanager.sources.PVTrivialProducer()
    algorithm = producer.GetClientSideObject()
    algorithm.SetOutput(pieces[rank])
    if hasattr(algorithm, "SetWholeExtent"):
        algorithm.SetWholeExtent(whole)
    writer = servermanager.writers.VDBWriter(Input=producer, FileName=path(name))
    writer.UpdatePipeline()


if everywhere:
    hidden = lambda i, j, k: 32 if (i, j, k) == (3, 2, 1) else 0
    if ranks == 1:
        pieces = [piece_of([0, 12, 0, 5, 0, 4], hidden)]
    else:
        # Overlapping pieces, whose copies of other ranks' cells are flagged, and have other values.
        cuts = [round(12 * r / ranks) for r in range(ranks + 1)]
        pieces = []
        for r in range(ranks):
            own = range(cuts[r], cuts[r + 1])
            flags = lambda i, j, k, own=own: (0 if i in own else 1) | hidden(i, j, k)
            pieces.append(piece_of([max(cuts[r] - 2, 0), min(cuts[r + 1] + 2, 12), 0, 5, 0, 4], flags))
    save_pieces("ghosts.vdb", pieces, [0, 12, 0, 5, 0, 4])

    # The last rank has everything; it also has the field data.
    whole = piece_of([4, 9, 0, 5, 0, 4])
    note = vtkFloatArray()
    note.SetName("vdb:density:background")
    note.InsertNextValue(5.0)
    whole.GetFieldData().AddArray(note)
    save_pieces("last.vdb", [vtkImageData() for _ in range(ranks - 1)] + [whole], [4, 9, 0, 5, 0, 4])

    if ranks > 1:
        # Pieces of no one image: an error on every rank, and no file.
        save_pieces("gap.vdb", [piece_of([5 * r, 5 * r + 3, 0, 2, 0, 2]) for r in range(ranks)], [0, 15, 0, 2, 0, 2])
        assert not os.path.exists(path("gap.vdb"))
print("rank %d is done" % rank, flush=True)
