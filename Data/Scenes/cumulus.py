"""A fair-weather cumulus in the sun: from water to a picture.

    pvpython cumulus.py [--output FILE.png] [--size 800 500] [--voxels N]

In ParaView's window: File, Load State, with the plugin loaded. cumulus.vdb holds grams of liquid water per cubic metre
in voxels of 10 m; sky.hdr a clear sky over grassland, W/(m^2 sr). make_scenes.py made both.
"""
import argparse
import os
import sys

from paraview.simple import *

parser = argparse.ArgumentParser()
parser.add_argument("--output", default="cumulus.png")
parser.add_argument("--size", type=int, nargs=2, default=[800, 500])
parser.add_argument("--voxels", type=int, default=0, help="along the cloud's longest edge; default: as in the file")
arguments = parser.parse_args()

if "MediumRayCaster" not in globals():  # else the plugin is loaded already
    LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
here = os.path.dirname(os.path.abspath(__file__))

water = VDBReader(registrationName="Liquid water", FileName=os.path.join(here, "cumulus.vdb"))
kind = "CELLS"
if arguments.voxels:
    kind = "POINTS"
    x0, x1, y0, y1, z0, z1 = water.GetDataInformation().GetBounds()
    parts = [max(2, round(arguments.voxels * edge / (x1 - x0))) for edge in (x1 - x0, y1 - y0, z1 - z0)]
    water = ResampleToImage(Input=water, UseInputBounds=1, SamplingDimensions=parts)
cloud = ParticipatingMedium(registrationName="Cloud", Input=water, DensityArray=[kind, "liquid_water"],
                            Preset="Cloud (1 g/m^3 of water, 10 um droplets)", MillimetresPerUnit=1000)
sun = LightRig(registrationName="Sun", SunElevation=34, SunAzimuth=195, SunPower=[950, 890, 790])
sky = EnvironmentReader(registrationName="Sky", FileName=os.path.join(here, "sky.hdr"))
light = LightPropagationMaps(registrationName="Light", Input=cloud, Lights=sun, Environment=sky, DirectionsPerFace=9,
                             Tolerance=2e-2)
picture = MediumRayCaster(registrationName="Picture", Input=light, Lights=sun, Environment=sky, ShadowRays=1,
                          ImageSize=arguments.size, CameraPosition=[700, -1950, 0], CameraFocalPoint=[720, 600, 400],
                          CameraViewAngle=23, Exposure=0.0048)
if not sys.argv[0]:  # no command line: ParaView's window
    Show(picture, GetActiveViewOrCreate("RenderView"))
    ResetCamera()
else:
    SaveData(arguments.output, proxy=picture)
    light.UpdatePropertyInformation()
    print(light.Orders, "orders, energy balance to", light.BalanceError, "in", light.Seconds, "s")
