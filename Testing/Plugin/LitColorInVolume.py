"""A solver's lit_color, shown by ParaView's representation Volume, is about what Medium Ray Caster makes of the light."""
import os

import lit_view
import numpy
import pictures
from paraview import servermanager
from paraview.simple import *

lit_view.load(remote=True)
LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())  # its names, here too
PICTURES = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "LitColorInVolume")


def cloud():
    """Waves on a ball, of several mean free paths, under the sun and a blue sky; a voxel's edge is 1."""
    box = Wavelet(WholeExtent=[-24, 24] * 3, Maximum=1, XMag=0.13, YMag=0.11, ZMag=0.14, XFreq=17, YFreq=13, ZFreq=19,
                  StandardDeviation=0.3)
    density = Calculator(Input=box, ResultArrayName="density", Function="max(0,RTData-0.5)")
    medium = ParticipatingMedium(Input=density, MaximumDensity=1, ExtinctionScale=4)
    sun = LightRig(SunElevation=30, SunAzimuth=180, SunPower=[4, 3.7, 3.2])
    return LightPropagationMaps(Input=medium, Lights=sun, SkyColor=[0.03, 0.06, 0.13], DirectionsPerFace=9,
                                Tolerance=5e-3), [50, -95, 45]


SMALL = """
from paraview.vtk.vtkCommonDataModel import vtkImageData
self.GetOutputDataObject(0).ShallowCopy(self.GetInputDataObject(0, 0))
self.GetOutputDataObject(0).SetSpacing(0.1, 0.12, 0.1)
"""


def fog():
    """Thin and warm, of small voxels that are no cubes, under a sun from behind, by another solver."""
    box = Wavelet(WholeExtent=[-16, 16, -20, 20, -12, 12], Maximum=1, XMag=0.2, YMag=0.1, ZMag=0.2, XFreq=10, YFreq=25,
                  ZFreq=12, StandardDeviation=0.3)
    density = Calculator(Input=box, ResultArrayName="density", Function="max(0,RTData-0.4)")
    small = ProgrammableFilter(Input=density, OutputDataSetType="vtkImageData", Script=SMALL)
    medium = ParticipatingMedium(Input=small, MaximumDensity=1, ExtinctionScale=1.5, Albedo=[0.95, 0.9, 0.8])
    sun = LightRig(SunElevation=60, SunAzimuth=20, SunPower=[3, 3, 3])
    return DiscreteOrdinates(Input=medium, Lights=sun, DirectionsPerFace=9, Terms=4, Tolerance=5e-3), [-6, 5, 3]


def view_from(position):
    view = lit_view.black_view()
    view.ViewSize = [400, 300]
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewAngle = position, [0, 0, 0], 30
    return view


def picture(light, view, exposure):
    image = servermanager.Fetch(lit_view.caster(light, view, Exposure=exposure))
    return pictures.of_image(image, "color"), image.GetFieldData().GetArray("exposure").GetValue(0)


def difference(found, expected):
    """@return root mean square of all channels, % of white"""
    assert expected.max() > 150 and expected.std() > 20, "there is nothing to compare"
    return 100 * numpy.sqrt(((found - expected) ** 2).mean()) / 255


# Measured: 1.47% and 3.29%; with the bare opacity of voxels 6.2% and 22%, without their unit distance 18% of the fog.
for name, make, most in (("Cloud", cloud, 2), ("Fog", fog, 4)):
    light, position = make()
    light.UpdatePipeline()
    light.UpdatePropertyInformation()
    seconds = light.Seconds
    assert "lit_color" not in light.CellData.keys()
    light.LitColor = 1
    view = view_from(position)
    shown = Show(light, view)
    assert shown.Representation == "Volume" and shown.ColorArrayName[:] == ["CELLS", "lit_color"]
    light.UpdatePropertyInformation()
    assert light.Seconds == seconds, "the light is not solved again"
    facts = light.FieldData
    distance, exposure = (facts["lit_color_" + fact].GetRange()[0] for fact in ("distance", "exposure"))
    found = lit_view.drawn(view)
    expected, automatic = picture(light, view, exposure)[0], picture(light, view, 0)[1]
    pictures.write(PICTURES + name + ".png", numpy.concatenate([found, expected], axis=1))
    found_from_cast = difference(found, expected)
    print("%s: %.2f%%, distance %g, exposure %g, that of the view %g" %
          (name, found_from_cast, distance, exposure, automatic), flush=True)
    assert found_from_cast < most, found_from_cast
    assert 0.4 < exposure / automatic < 2.5, (exposure, automatic)

    # Other arrays are mapped, and Volume has its colours again when they are chosen.
    ColorBy(shown, ("CELLS", "fluence"))
    assert shown.MapScalars == 1
    ColorBy(shown, ("CELLS", "lit_color"))
    assert shown.MapScalars == 0 and shown.ScalarOpacityFunction.Points[:] == [0, 0, 0.5, 0, 255, 1, 0.5, 0]
    assert numpy.abs(lit_view.drawn(view) - found).max() <= 1
    shown.Representation = "Slice"
    shown.Representation = "Volume"
    assert numpy.abs(lit_view.drawn(view) - found).max() <= 1

    # Off, nothing of it stays.
    light.LitColor = 0
    light.UpdatePipeline()
    assert "lit_color" not in light.CellData.keys() and "lit_color_distance" not in light.FieldData.keys()
    Delete(view)

# Where Lit Color is switched on later, Volume shows it when it is chosen.
view = view_from(position)
shown = Show(light, view)
assert shown.Representation == "Lit Volume"
light.LitColor = 1
Render(view)
shown.Representation = "Volume"
later = lit_view.drawn(view)
assert numpy.abs(later - found).max() <= 1, numpy.abs(later - found).max()

# A state gives the same picture, its unit distance as well.
SaveState(PICTURES + ".pvsm")
ResetSession()
LoadState(PICTURES + ".pvsm")
again = lit_view.drawn(GetActiveViewOrCreate("RenderView"))
assert numpy.abs(again - found).max() <= 1, numpy.abs(again - found).max()
