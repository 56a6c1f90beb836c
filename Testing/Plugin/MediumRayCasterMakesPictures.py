"""A medium, lit and solved, becomes a picture: its arrays, its camera, its facts on the panel, and how it is shown."""
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def pixels(caster, name):
    caster.UpdatePipeline()
    return vtk_to_numpy(servermanager.Fetch(caster).GetPointData().GetArray(name))


def fact(caster, name):
    caster.UpdatePropertyInformation()
    return caster.SMProxy.GetProperty(name).GetElement(0)


medium = ParticipatingMedium(Input=Wavelet(WholeExtent=[-8, 8, -8, 8, -8, 8]))
lights = LightRig()
light = LightPropagationMaps(Input=medium, Lights=lights, DirectionsPerFace=4)
caster = MediumRayCaster(Input=light, ImageSize=[160, 120], BackgroundRadiance=[0.1, 0.2, 0.3])

image = servermanager.Fetch(caster)
assert image.GetDimensions() == (160, 120, 1)
assert pixels(caster, "color").shape == (160 * 120, 4) and pixels(caster, "color")[:, 3].min() == 255
assert pixels(caster, "radiance").shape == (160 * 120, 3)
alpha = pixels(caster, "alpha")
assert alpha[0] == 0 and alpha[160 * 60 + 80] > 0
assert abs(pixels(caster, "radiance")[0] - [0.1, 0.2, 0.3]).max() < 1e-6, "the corner shows the background"
depth = pixels(caster, "depth")
assert (depth > 0).all() and (depth < 1e4).all()
assert fact(caster, "Seconds") > 0 and fact(caster, "UsedExposure") > 0
assert "emission" in fact(caster, "LeftOut")

# A background is shown in the colour that was chosen, at any exposure and by either curve, and leaves the exposure alone.
caster.BackgroundRadiance = [0, 0, 0]
caster.UpdatePipeline()
black = fact(caster, "UsedExposure")
caster.BackgroundColor = [0.2, 0.4, 0.8]
for caster.ToneCurve in ("Filmic", "Linear"):
    for caster.Exposure in (0, 0.3):
        assert abs(pixels(caster, "color")[0][:3].astype(int) - [51, 102, 204]).max() <= 1, pixels(caster, "color")[0]
        assert caster.Exposure or abs(fact(caster, "UsedExposure") / black - 1) < 1e-6
caster.ToneCurve, caster.Exposure = "Filmic", 0
caster.BackgroundColor = [0, 0, 0]

# Less light in single scattering than in all, with and without shadow rays.
caster.ShowBackground = 0
everything = pixels(caster, "radiance").sum()
caster.SingleScatteringOnly = 1
once = pixels(caster, "radiance").sum()
assert 0 < once < everything, (once, everything)
caster.ShadowRays = 1
caster.Lights = lights
shadow_rays = pixels(caster, "radiance").sum()
assert 0 < shadow_rays < everything, (shadow_rays, everything)
caster.ShadowRays = 0
caster.SingleScatteringOnly = 0

# A camera of one's own: from far away the medium is small.
caster.CameraPosition = [0, -1000, 0]
assert 0 < (pixels(caster, "alpha") > 0).mean() < 0.05

view = CreateView("RenderView")
shown = Show(caster, view)
assert shown.Representation == "Slice"
assert shown.MapScalars == 0, "shown in its own colours"
SaveData(os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "MediumRayCasterMakesPictures.png"), proxy=caster)
