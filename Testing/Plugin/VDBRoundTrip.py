"""A .vdb file is written, listed, read in part and as a series over time, and damaged, all through proxies."""
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
folder = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "VDBRoundTrip")
os.makedirs(folder, exist_ok=True)

wavelet = Wavelet(WholeExtent=[-4, 5, 0, 6, 2, 9])
cells = PointDatatoCellData(Input=wavelet)
twice = Calculator(Input=cells, AttributeType="Cell Data", ResultArrayName="twice", Function="2*RTData")
files = []
for step in range(3):
    wavelet.Maximum = 100.0 + 50.0 * step
    files.append(os.path.join(folder, f"wavelet_{step}.vdb"))
    SaveData(files[-1], proxy=twice, Compression="Zip")
expected = servermanager.Fetch(twice)


def values(data, name):
    return vtk_to_numpy(data.GetCellData().GetArray(name))


# One file, by the reader ParaView finds for it.
reader = OpenDataFile(files[2])
assert reader.SMProxy.GetXMLName() == "VDBReader", reader.SMProxy.GetXMLName()
reader.UpdatePipeline()
data = servermanager.Fetch(reader)
assert data.GetExtent() == (-4, 5, 0, 6, 2, 9), data.GetExtent()
assert data.GetOrigin() == expected.GetOrigin() and data.GetSpacing() == expected.GetSpacing()
assert sorted(reader.Grids.Available) == ["RTData", "twice"], reader.Grids.Available
assert (values(data, "RTData") == values(expected, "RTData")).all()
assert (values(data, "twice") == values(expected, "twice")).all()
reader.UpdatePropertyInformation()
assert "twice: double" in str(reader.GridSummary), reader.GridSummary

reader.Grids = ["twice"]
reader.UpdatePipeline()
data = servermanager.Fetch(reader)
assert [data.GetCellData().GetArrayName(i) for i in range(data.GetCellData().GetNumberOfArrays())] == ["twice"]

# The series.
series = VDBReader(FileName=files)
series.UpdatePipelineInformation()
assert len(series.TimestepValues) == 3, series.TimestepValues
maxima = []
for time in series.TimestepValues:
    series.UpdatePipeline(time)
    maxima.append(values(servermanager.Fetch(series), "RTData").max())
assert maxima[0] < maxima[1] < maxima[2], maxima

# A series whose boxes change, with an empty one and one that meets no other: in UpdatePipeline, in a view, and as an
# animation, to and fro. What the view draws as Surface are the faces of that time's box.
boxes = []
edges = [(0, 5), None, (3, 9), (-2, 8), (20, 24)]
for step, edge in enumerate(edges):
    extent = edge and [*edge] * 3
    boxes.append(os.path.join(folder, f"box_{step}.vdb"))
    if extent is None:
        nothing = Calculator(Input=cells, AttributeType="Cell Data", ResultArrayName="d", Function="0*RTData")
        chosen = PassArrays(Input=nothing, CellDataArrays=["d"])
        SaveData(boxes[-1], proxy=chosen, Background=0.0)
        # A file of VDBWriter notes its extent, which other programs do not: without these notes the grid is empty.
        with open(boxes[-1], "rb") as file:
            bytes_of = file.read()
        with open(boxes[-1], "wb") as file:
            file.write(bytes_of.replace(b"image_extent_min", b"other_extent_min"))
        continue
    density = PointDatatoCellData(Input=Wavelet(WholeExtent=extent))
    SaveData(boxes[-1], proxy=Calculator(Input=density, AttributeType="Cell Data", ResultArrayName="d", Function="1"))
counts = [125, 0, 216, 1000, 64]


def has_faces_of(representation, edge):
    drawn = representation.GetClientSideObject().GetActiveRepresentation().GetRenderedDataObject(0)
    bounds = [0.0] * 6
    drawn.GetBounds(bounds)
    cells = drawn.GetNumberOfCells()
    return cells == 0 if edge is None else cells == 6 * (edge[1] - edge[0]) ** 2 and bounds == [*edge] * 3


changing = VDBReader(FileName=boxes)
changing.Grids = ["d"]
medium = ParticipatingMedium(Input=changing)
light = LightPropagationMaps(Input=medium, DirectionsPerFace=1, MaximumOrders=1)
for time in (0, 1, 3, 2, 4, 1, 0, 3):
    light.UpdatePipeline(time)
    assert servermanager.Fetch(changing).GetNumberOfCells() == counts[time], (time, "reader")
    assert servermanager.Fetch(light).GetNumberOfCells() == counts[time], (time, "solver")
scene = GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
for of in (changing, medium, light):  # each alone: a view of the reader would have it read before the others ask
    name = of.SMProxy.GetXMLName()
    view = CreateRenderView(ViewSize=[60, 60])
    shown = Show(of, view, "UniformGridRepresentation")
    shown.Representation = "Surface"
    Render(view)
    for time in (3, 0, 4, 1, 2, 4, 0, 2):
        scene.AnimationTime = time
        Render(view)
        assert of.GetDataInformation().GetNumberOfCells() == counts[time], (time, name, "view")
        assert has_faces_of(shown, edges[time]), (time, name, "faces")
    scene.GoToFirst()
    scene.Play()
    assert of.GetDataInformation().GetNumberOfCells() == counts[4], (name, "animation")
    assert has_faces_of(shown, edges[4]), (name, "faces after the animation")
    Delete(view)

# A damaged one: no data, and the session lives on.
damaged = os.path.join(folder, "damaged.vdb")
with open(files[0], "rb") as whole, open(damaged, "wb") as part:
    part.write(whole.read()[:-100])
broken = VDBReader(FileName=[damaged])
broken.UpdatePipeline()
assert servermanager.Fetch(broken).GetNumberOfCells() == 0
series.UpdatePipeline(series.TimestepValues[0])
assert servermanager.Fetch(series).GetNumberOfCells() == 9 * 6 * 7

# A medium keeps its phase function.
medium = ParticipatingMedium(Input=cells, Preset=1, PhaseFunction="Schlick")
medium.UpdatePipeline()
g = servermanager.Fetch(medium).GetFieldData().GetArray("g").GetValue(0)
SaveData(os.path.join(folder, "medium.vdb"), proxy=medium)
again = OpenDataFile(os.path.join(folder, "medium.vdb"))
again.UpdatePipeline()
assert g != 0 and servermanager.Fetch(again).GetFieldData().GetArray("g").GetValue(0) == g
assert servermanager.Fetch(again).GetFieldData().GetAbstractArray("phase_function").GetValue(0) == "schlick"
