"""Sunlight through windows, seen in dusty air: the Tyndall effect, from coefficients to a picture.

    pvpython hall.py [--output FILE.png] [--size 640 480] [--voxels N]

In ParaView's window: File, Load State, with the plugin loaded. hall.vti holds sigma_a and sigma_s, 1/m, of the air and
the walls of a hall in voxels of 4 cm; its front is open. make_scenes.py made it.
"""
import argparse
import os
import sys

from paraview.simple import *

parser = argparse.ArgumentParser()
parser.add_argument("--output", default="hall.png")
parser.add_argument("--size", type=int, nargs=2, default=[640, 480])
parser.add_argument("--voxels", type=int, default=0, help="along the hall; default: as in the file")
arguments = parser.parse_args()

if "MediumRayCaster" not in globals():  # else the plugin is loaded already
    LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
here = os.path.dirname(os.path.abspath(__file__))

hall = XMLImageDataReader(registrationName="Hall", FileName=[os.path.join(here, "hall.vti")])
if arguments.voxels:
    x0, x1, y0, y1, z0, z1 = hall.GetDataInformation().GetBounds()
    parts = [max(2, round(arguments.voxels * edge / (x1 - x0))) for edge in (x1 - x0, y1 - y0, z1 - z0)]
    hall = ResampleToImage(Input=hall, UseInputBounds=1, SamplingDimensions=parts)
sun = LightRig(registrationName="Sun", SunElevation=34, SunAzimuth=173, SunPower=[20, 17.3, 13.2])
light = LightPropagationMaps(registrationName="Light", Input=hall, Lights=sun, SkyColor=[0.05, 0.07, 0.11],
                             Tolerance=2e-2)
picture = MediumRayCaster(registrationName="Picture", Input=light, Lights=sun, ShadowRays=1, StepSize=0.2,
                          ImageSize=arguments.size, CameraPosition=[4.6, -4.9, 2.1], CameraFocalPoint=[2.3, 1.45, 1.35],
                          CameraViewAngle=30, BackgroundRadiance=[0.01, 0.012, 0.016], Exposure=2.2)
if not sys.argv[0]:  # no command line: ParaView's window
    Show(picture, GetActiveViewOrCreate("RenderView"))
    ResetCamera()
else:
    SaveData(arguments.output, proxy=picture)
    light.UpdatePropertyInformation()
    print(light.Orders, "orders, energy balance to", light.BalanceError, "in", light.Seconds, "s")
