"""The representation Lit Volume: its pixels are those of Medium Ray Caster, before and behind other objects, in saved
screenshots, states and traces."""
import os

import lit_view
import numpy
import pictures
from paraview import servermanager, smtrace
from paraview.simple import *

lit_view.load(remote=True)
output = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "LitVolumeInView")
light = lit_view.solved()
view = lit_view.black_view()
assert Show(light, view).Representation == "Lit Volume", "it is how a solver's light is shown at first"
shown = lit_view.show_lit(light, view)
assert "Lit Volume" in shown.GetProperty("Representation").Available
alone = lit_view.drawn(view)
pictures.write(output + ".png", alone)
lit_view.check_same(alone, lit_view.cast(light, view))

# Colours, which Lit Volume does not use, are no change of it (they were the end of ParaView).
ColorBy(shown, ("CELLS", "sigma_s"))
assert shown.Representation == "Lit Volume"
lit_view.check_same(lit_view.drawn(view), alone)

# A screenshot, of another size.
SaveScreenshot(output + "Large.png", view, ImageResolution=[400, 300])
large = pictures.read(output + "Large.png")
assert large.shape == (300, 400, 3)
means = large.reshape(150, 2, 200, 2, 3).mean(axis=(1, 3))
assert numpy.abs(means - alone).mean() < 2, numpy.abs(means - alone).mean()

# A sphere half inside hides the medium behind it, and is dimmed by what is before it.
sphere = Sphere(Center=[0, -8, 0], Radius=4, ThetaResolution=64, PhiResolution=64)
ball = Show(sphere, view)
ball.Ambient, ball.Diffuse = 1, 0
ball.AmbientColor = [0, 0, 1]
with_ball = lit_view.drawn(view)
pictures.write(output + "WithSphere.png", with_ball)
Hide(light, view)
ball_alone = lit_view.drawn(view)
Show(light, view)
blue = (ball_alone[:, :, 2] > 250) & (ball_alone[:, :, 0] < 5)
assert blue.sum() > 500
assert (with_ball[~blue] == alone[~blue]).mean() > 0.99, "beside the sphere nothing changes but its edge"
ray = numpy.argwhere(blue)
middle = tuple(ray.mean(axis=0).astype(int))
assert with_ball[middle][2] > alone[middle][2], "the sphere shines through"
assert with_ball[middle][0] < alone[middle][0], "it hides the light behind it"

# A sphere behind the medium shines through it.
sphere.Center = [-3, 14, -8]
behind = lit_view.drawn(view)
pictures.write(output + "Behind.png", numpy.concatenate([behind, alone], axis=1))
assert (behind[:, :, 2].astype(int) - alone[:, :, 2]).max() > 20
Hide(sphere, view)

# What the representation is told: another exposure, the environment.
shown.Exposure = 2 * lit_view.EXPOSURE
assert lit_view.drawn(view).mean() > 1.1 * alone.mean()
shown.Exposure = 0
chosen = lit_view.drawn(view)
pictures.write(output + "Exposed.png", chosen)
assert 40 < chosen[75, 100].max() < 256, "the exposure is chosen"
used = shown.UsedExposure
assert used > 0, used  # which is told
shown.Exposure = used
lit_view.check_same(lit_view.drawn(view), chosen)
shown.Exposure = lit_view.EXPOSURE
shown.ShowBackground = 1
shown.BackgroundColor = [0, 0.6, 0.2]
for shown.Exposure in (lit_view.EXPOSURE, 0):
    assert abs(lit_view.drawn(view)[0, 0].astype(int) - [0, 153, 51]).max() <= 1, "the colour that was chosen"
shown.Exposure = lit_view.EXPOSURE
shown.ShowBackground = 0
lit_view.check_same(lit_view.drawn(view), alone)

# Lines that are thinner than a pixel stay as they are where a background is shown and edges are smoothed.
view.GetRenderWindow().SetMultiSamples(4)
beside = lit_view.drawn(view)[:, :40, 0].astype(float).sum()
line = Show(Line(Point1=[-20, 14, -14], Point2=[22, 14, 13]), view)
line.AmbientColor = line.DiffuseColor = [1, 1, 1]
line.Ambient, line.Diffuse, line.LineWidth = 1, 0, 0.5
shown.BackgroundColor = [0, 0.6, 0.2]


def of_line():
    """How much red the line adds."""
    return lit_view.drawn(view)[:, :40, 0].astype(float).sum() - beside


without = of_line()
shown.ShowBackground = 1
assert without > 500 and abs(of_line() / without - 1) < 0.1, (of_line(), without)
shown.ShowBackground = 0
Delete(line.Input)
view.GetRenderWindow().SetMultiSamples(0)

# Arrays of other names: what the solver was told to take is what is shown.
renamed = light.Input
for name, was in (("mua", "sigma_a"), ("mus", "sigma_s")):
    renamed = Calculator(Input=renamed, AttributeType="Cell Data", ResultArrayName=name, Function=was)
renamed = PassArrays(Input=renamed, CellDataArrays=["mua", "mus"], FieldDataArrays=["g", "phase_function"])
told = lit_view.LightPropagationMaps(Input=renamed, Lights=light.Lights, DirectionsPerFace=4,
                            AbsorptionArray=["CELLS", "mua"], ScatteringArray=["CELLS", "mus"])
Hide(light, view)
other = lit_view.show_lit(told, view)
lit_view.check_same(lit_view.drawn(view), alone)
Hide(told, view)
Show(light, view)

# A state gives the same picture.
SaveState(output + ".pvsm")
assert "Lit Volume" in open(output + ".pvsm").read()
ResetSession()
LoadState(output + ".pvsm")
again = GetActiveViewOrCreate("RenderView")
lit_view.check_same(lit_view.drawn(again), alone)
