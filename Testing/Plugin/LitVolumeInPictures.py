"""Lit Volume wherever ParaView draws: in animations, in screenshots larger than the screen, for either eye, from a trace; with shadow
rays and an environment as Medium Ray Caster has them."""
import glob
import os

import lit_view
import numpy
import pictures
from paraview import smtrace
from paraview.simple import *

output = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "LitVolumeInPictures")
lit_view.load(remote=True)
LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals()) # its names, here too


def sky():
    """@return an environment, blue on one side"""
    path = output + ".hdr"
    width, height = 8, 4
    red, green, blue = ([weak] * 4 + [strong] * 4 for weak, strong in ((20, 40), (20, 90), (30, 200)))
    row = bytes([2, 2, 0, width]) + b"".join(bytes([width] + channel) for channel in (red, green, blue, [125] * width))
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + height * row)
    return EnvironmentReader(FileName=path)


def lights_and_environment(light, view):
    """Light that was never scattered is found by rays through the picture's own lights."""
    shown = lit_view.show_lit(light, view)
    rig = LightRig(SunElevation=20, SunAzimuth=200)
    more = {"Lights": rig, "Environment": sky(), "ShadowRays": 1, "ShowBackground": 1}
    without = lit_view.drawn(view)
    for name, value in more.items():
        setattr(shown, name, value)
    found = lit_view.drawn(view)
    pictures.write(output + "Sky.png", found)
    lit_view.check_same(found, lit_view.cast(light, view, **more))
    assert numpy.abs(found - without).mean() > 5, "they change nothing"
    shown.ShadowRays = shown.ShowBackground = 0
    shown.Lights = shown.Environment = None
    lit_view.check_same(lit_view.drawn(view), without)


def larger_than_the_screen(light, view):
    size = [8 * length for length in view.ViewSize]
    SaveScreenshot(output + "Large.png", view, ImageResolution=size)
    lit_view.check_same(pictures.read(output + "Large.png"), lit_view.cast(light, view, ImageSize=size))


def middle_of(pixels):
    """@return the column about which an object is drawn that is brighter than its surroundings"""
    weights = pixels.sum(axis=(0, 2)).astype(float)
    return (weights * numpy.arange(len(weights))).sum() / weights.sum()


def eye_sees(source, view, eye):
    """@return the column about which it is drawn"""
    Show(source, view).Ambient = 1
    for _ in range(2): # ParaView takes the first one after none still with one camera for both
        SaveScreenshot(output + "Eye.png", view, ImageResolution=view.ViewSize, StereoMode=eye)
    Hide(source, view)
    return middle_of(pictures.read(output + "Eye.png"))


def either_eye(view):
    """The volume of a ball is seen where its surface is."""
    ball = Sphere(Center=[4, 3, 2], Radius=4, ThetaResolution=64, PhiResolution=64)
    cells = Wavelet(WholeExtent=[-10, 10, -10, 10, -10, 10])
    dense = Calculator(Input=cells, ResultArrayName="density",
                       Function="if((coordsX-4)^2+(coordsY-3)^2+(coordsZ-2)^2<16,1,0)")
    medium = ParticipatingMedium(Input=PointDatatoCellData(Input=dense), MaximumDensity=1, ExtinctionScale=3)
    light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1])
    focal_point = list(view.CameraFocalPoint)
    view.CameraFocalPoint = [(a + 2 * b) / 3 for a, b in zip(view.CameraPosition, focal_point)] # of which both eyes see the same
    view.CameraParallelScale = 12
    for view.CameraParallelProjection in (1, 0):
        left, right = ([eye_sees(source, view, eye + " Eye Only") for source in (ball, light)] for eye in ("Left", "Right"))
        assert abs(left[0] - right[0]) > 2, ("both eyes see the same", left, right)
        assert abs(left[0] - left[1]) < 1 and abs(right[0] - right[1]) < 1, ("not where the ball is", left, right)
    view.CameraFocalPoint = focal_point


def animation(light, rig, view):
    """Each frame shows its own light and its own camera."""
    Show(light, view)
    scene = GetAnimationScene()
    scene.PlayMode = "Sequence"
    scene.NumberOfFrames = 3
    scene.StartTime, scene.EndTime = 0, 2
    sun = GetAnimationTrack("SunAzimuth", proxy=rig)
    sun.KeyFrames = [CompositeKeyFrame(KeyTime=0, KeyValues=[0]), CompositeKeyFrame(KeyTime=1, KeyValues=[180])]
    SaveAnimation(output + "Frame.png", view, ImageResolution=view.ViewSize, FrameWindow=[0, 2])
    frames = [pictures.read(path) for path in sorted(glob.glob(output + "Frame.*.png"))]
    assert len(frames) == 3, len(frames)
    for frame, rig.SunAzimuth in zip(frames, (0, 90, 180)):
        lit_view.check_same(frame, lit_view.cast(light, view))
    assert numpy.abs(frames[0] - frames[2]).mean() > 2, "the sun stands still"
    Hide(light, view)


def trace():
    """What ParaView writes down of a Lit Volume draws it again."""
    smtrace.start_trace()
    light = lit_view.solved()
    view = lit_view.black_view()
    lit_view.show_lit(light, view)
    expected = lit_view.drawn(view)
    written = smtrace.stop_trace()
    assert "Lit Volume" in written, written
    ResetSession()
    exec(compile(written, "the trace", "exec"), {})
    again = lit_view.make_black(GetActiveView())
    shown = GetRepresentation(view=again)
    assert shown.Representation == "Lit Volume"
    shown.Exposure = lit_view.EXPOSURE # neither size nor what scripts set is written down
    lit_view.check_same(lit_view.drawn(again), expected)


light = lit_view.solved()
view = lit_view.black_view()
lights_and_environment(light, view)
larger_than_the_screen(light, view)
Hide(light, view)
either_eye(view)
animation(light, light.Lights, view)
ResetSession()
trace()
