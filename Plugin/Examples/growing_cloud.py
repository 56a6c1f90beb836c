"""A cloud that grows, as an animation: a series of .vdb files, each lit once, and a picture of each.

    pvpython growing_cloud.py [OUTPUT FOLDER] [--steps 8] [--voxels 48] [--size 480 360]

Writes the series growth_0.vdb, ..., opens it as a user would, and saves the animation as pictures growth.0000.png, ...
WarmStart lets each step's light begin from that of the step before; the exposure is given, so that the pictures do not
flicker.
"""
import argparse
import os

from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def write_growth(folder, steps, voxels):
    """Relative density of water in a box of 480 m, more and more of it, from a flat base upwards."""
    half = voxels // 2
    noise = Wavelet(WholeExtent=[-half, half] * 3, Maximum=1, XMag=0.13, YMag=0.11, ZMag=0.14, XFreq=17, YFreq=13, ZFreq=19,
                    StandardDeviation=0.5)
    files = []
    for step in range(steps):
        grown = 0.35 + 0.65 * (step + 1) / steps
        bubble = "%g-sqrt((coordsX/%d)^2+(coordsY/%d)^2+((coordsZ+%d)/%d)^2)" % (grown, half, half, half // 2, half)
        water = Calculator(Input=noise, ResultArrayName="density",
                           Function="if(coordsZ>%d,max(0,RTData-0.7+%s),0)" % (-half // 2, bubble))
        files.append(os.path.join(folder, "growth_%d.vdb" % step))
        SaveData(files[-1], proxy=PointDatatoCellData(Input=water, ProcessAllArrays=0,
                                                      PointDataArraytoprocess=["density"]))
    return files


def light_of(series, view):
    """The chain from files to light in the view. @return light, its representation"""
    cloud = ParticipatingMedium(Input=series, DensityArray=["CELLS", "density"], MillimetresPerUnit=10000,
                                Preset="Cloud (1 g/m^3 of water, 10 um droplets)")
    cloud.MaximumDensity = 2.0  # set after creation, so that it holds at all times: density 1 is 0.5 g/m^3
    sun = LightRig(SunElevation=30, SunAzimuth=200, SunPower=[4, 3.7, 3.2])
    light = LightPropagationMaps(Input=cloud, Lights=sun, SkyColor=[0.05, 0.09, 0.16], Tolerance=5e-3, WarmStart=1)
    shown = Show(light, view, "UniformGridRepresentation")
    shown.Representation = "Lit Volume"
    shown.Lights = sun
    shown.Exposure = 1.2
    return light, shown


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", default=os.environ.get("TYNDALL_TEST_OUTPUT", "."))
    parser.add_argument("--steps", type=int, default=8)
    parser.add_argument("--voxels", type=int, default=48)
    parser.add_argument("--size", type=int, nargs=2, default=[480, 360])
    options = parser.parse_args()
    series = OpenDataFile(write_growth(options.folder, options.steps, options.voxels))
    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    view = CreateRenderView(ViewSize=options.size, UseColorPaletteForBackground=0, Background=[0.22, 0.36, 0.55],
                            OrientationAxesVisibility=0)
    light, _ = light_of(series, view)
    far = 2.4 * options.voxels
    view.CameraPosition, view.CameraViewUp = [0.5 * far, -0.9 * far, 0.2 * far], [0, 0, 1]
    view.CameraFocalPoint, view.CameraViewAngle = [0, 0, 0], 28
    SaveAnimation(os.path.join(options.folder, "growth.png"), view, ImageResolution=options.size,
                  FrameWindow=[0, options.steps - 1])
    light.UpdatePropertyInformation()
    print("%d steps; the last one: %d sweeps, balance to %.1g" % (options.steps, light.Orders, light.BalanceError))
    assert light.BalanceError < 1e-5


if __name__ == "__main__":
    main()
