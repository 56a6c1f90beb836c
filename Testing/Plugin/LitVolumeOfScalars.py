"""Lit Volume of an image that is no medium: its colours and opacities, lit by the view's lights or by connected ones,
are what the filters make of them, also after an edit; and a skull, against its baseline."""
import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import lit_view
import numpy
import pictures
from paraview.simple import *

lit_view.load(remote=True)
LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())  # its names, here too
output = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "LitVolumeOfScalars")


def difference(one, other):
    return numpy.abs(one - other).max()


wavelet = Wavelet(WholeExtent=[-8, 8, -8, 8, -8, 8])
view = lit_view.black_view()
shown = Show(wavelet, view)
assert not shown.ColorArrayName[1], shown.ColorArrayName[:]
shown = lit_view.show_lit(wavelet, view)
assert shown.ColorArrayName[:] == ["POINTS", "RTData"], "the first array is chosen"
low, high = wavelet.PointData["RTData"].GetRange()
opacities, colors = GetOpacityTransferFunction("RTData"), GetColorTransferFunction("RTData")
for points in (opacities.Points, colors.RGBPoints):
    assert abs(points[0] - low) < 1e-3 and abs(points[-4] - high) < 1e-3, (points[:], low, high)

# The light kit illuminates it, and the next frame shows an edited map.
opacities.Points = [low, 0, 0.5, 0, 150, 0, 0.5, 0, high, 0.6, 0.5, 0]
before = lit_view.drawn(view)
pictures.write(output + "LightKit.png", before)
assert before.max() > 100 and before.std() > 10, (before.max(), before.std())
colors.RGBPoints = [low, 0.9, 0.2, 0.1, high, 0.9, 0.2, 0.1]
red = lit_view.drawn(view)
assert red[75, 100, 0] > 2 * red[75, 100, 2], red[75, 100]

# The light kit stands still where it is told to.
shown.LightsFollowCamera = "Never"
assert difference(lit_view.drawn(view), red) <= 1
view.CameraPosition = [-30, 30, -21]
standing = lit_view.drawn(view)
shown.LightsFollowCamera = "At Rest"
assert difference(lit_view.drawn(view), standing) > 20
lit_view.place_camera(view)
colors.RGBPoints = [low, 0.2, 0.3, 0.9, high, 0.9, 0.8, 0.5]

# In a light of the scene it is what the filters make of it.
view.UseLight = 0
sun = AddLight(view=view)
sun.Coords, sun.Type, sun.Position, sun.FocalPoint, sun.Intensity = "Scene", "Directional", [0, 0, 1], [0, 0, 0], 0.8
lit = lit_view.drawn(view)
medium = ParticipatingMedium(Input=wavelet, UseTransferFunctions=1)
rig = LightRig(SunElevation=90, SunPower=[0.8 * math.pi] * 3)
solved = LightPropagationMaps(Input=medium, Lights=rig)
expected = lit_view.cast(solved, view)
pictures.write(output + "ByFilters.png", numpy.concatenate([lit, expected], axis=1))
lit_view.check_same(lit, expected)
shown.OpacityArrayName, shown.UseSeparateOpacityArray = ["POINTS", "RTData"], 1
assert difference(lit_view.drawn(view), lit) <= 1, "the same opacity by another array"
shown.UseSeparateOpacityArray = 0

# Connected lights are used instead of the view's; other properties of the medium.
sun.Intensity = 0.1
assert lit.mean() > 1.5 * lit_view.drawn(view).mean(), "an edit of the light is shown"
shown.Lights = rig
assert difference(lit_view.drawn(view), lit) <= 1
shown.MeanCosine = medium.MeanCosine = 0.5
shown.ExtinctionScale = medium.ExtinctionScale = 0.5
shown.ScalarOpacityUnitDistance = medium.ScalarOpacityUnitDistance = 2.5
thin = lit_view.drawn(view)
assert difference(thin, lit) > 20
lit_view.check_same(thin, lit_view.cast(solved, view))
sky = EnvironmentReader(FileName=os.path.join(os.environ["TYNDALL_SOURCE"], "Data/Scenes/sky.hdr"))
shown.Environment = solved.Environment = sky
bright = lit_view.drawn(view)
assert bright.mean() > 1.05 * thin.mean(), (bright.mean(), thin.mean())
lit_view.check_same(bright, lit_view.cast(solved, view))
shown.Environment = solved.Environment = None
shown.ColorMeans = medium.ColorMeans = "Emission"
lit_view.check_same(lit_view.drawn(view), lit_view.cast(solved, view))
shown.ColorMeans = "Albedo"

# To Volume and back; a state.
shown.Representation = "Volume"
assert difference(lit_view.drawn(view), thin) > 20
shown.Representation = "Lit Volume"
assert difference(lit_view.drawn(view), thin) <= 1
SaveState(output + ".pvsm")
ResetSession()
LoadState(output + ".pvsm")
assert difference(lit_view.drawn(GetActiveViewOrCreate("RenderView")), thin) <= 1

# Cells.
ResetSession()
cells = PointDatatoCellData(Input=Wavelet(WholeExtent=[-8, 8, -8, 8, -8, 8]))
view = lit_view.black_view()
shown = lit_view.show_lit(cells, view)
assert shown.ColorArrayName[:] == ["CELLS", "RTData"], shown.ColorArrayName[:]
lit = lit_view.drawn(view)
pictures.write(output + "OfCells.png", lit)
assert lit.max() > 100 and lit.std() > 10, (lit.max(), lit.std())

# A skull, whose bone has values from 2.9 on.
path = os.path.join(os.environ["TYNDALL_FETCHED_DATA"], "skull_2.9.inr")
if not os.path.exists(path):
    print("There is no %s; Data/fetch fetches it" % path)
    sys.exit(125)
ResetSession()
skull = ImageReader(FileNames=[path], DataScalarType="float", DataByteOrder="LittleEndian", FileDimensionality=3,
                    ScalarArrayName="density", DataExtent=[0, 63, 0, 63, 0, 63], DataSpacing=[3.943, 3.943, 3.651])
view = lit_view.black_view()
view.CameraPosition, view.CameraFocalPoint = [-130, -340, 230], [124, 124, 110]
view.CameraViewAngle = 24
shown = Show(skull, view)
shown.Representation = "Lit Volume"
GetOpacityTransferFunction("density").Points = [0, 0, 0.5, 0, 2.4, 0, 0.5, 0, 3.2, 0.8, 0.5, 0, 6, 0.9, 0.5, 0]
GetColorTransferFunction("density").RGBPoints = [0, 0.8, 0.5, 0.4, 2.5, 0.8, 0.5, 0.4, 3.2, 0.95, 0.9, 0.8,
                                                6, 0.95, 0.92, 0.85]
wrong = pictures.compare("skull-of-colors", lit_view.drawn(view))
assert not wrong, wrong
