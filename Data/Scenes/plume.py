"""Smoke of a fire at night, in a lamp's light and in the fire's: from density to a picture.

    pvpython plume.py [--output FILE.png] [--size 480 720] [--voxels N]

In ParaView's window: File, Load State, with the plugin loaded. plume.vti holds the smoke's density, relative to the
fire's, in voxels of 2.5 cm. make_scenes.py made it.
"""
import argparse
import os
import sys

from paraview.simple import *

parser = argparse.ArgumentParser()
parser.add_argument("--output", default="plume.png")
parser.add_argument("--size", type=int, nargs=2, default=[480, 720])
parser.add_argument("--voxels", type=int, default=0, help="along the plume's height; default: as in the file")
arguments = parser.parse_args()

if "MediumRayCaster" not in globals():  # else the plugin is loaded already
    LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
here = os.path.dirname(os.path.abspath(__file__))

density, kind = XMLImageDataReader(registrationName="Density", FileName=[os.path.join(here, "plume.vti")]), "CELLS"
if arguments.voxels:
    x0, x1, y0, y1, z0, z1 = density.GetDataInformation().GetBounds()
    parts = [max(2, round(arguments.voxels * edge / (z1 - z0))) for edge in (x1 - x0, y1 - y0, z1 - z0)]
    density, kind = ResampleToImage(Input=density, UseInputBounds=1, SamplingDimensions=parts), "POINTS"
# Smoke of wood: light, and a little browner where it is thick.
smoke = ParticipatingMedium(registrationName="Smoke", Input=density, DensityArray=[kind, "smoke"], ExtinctionScale=14,
                            Albedo=[0.95, 0.94, 0.92])
# A lamp from above on the left, W; and what glows below.
lamps = LightRig(registrationName="Lamps", Sun=0, SpotLights=[-4.0, 1.6, 5.0, 4.0, -1.6, -2.8, 300, 292, 276, 64],
                 PointLights=[0, 0, -0.15, 7, 2.8, 0.6])
light = LightPropagationMaps(registrationName="Light", Input=smoke, Lights=lamps, SkyColor=[0.02, 0.03, 0.05],
                             Tolerance=2e-2)
picture = MediumRayCaster(registrationName="Picture", Input=light, Lights=lamps, ImageSize=arguments.size,
                          CameraPosition=[0.5, -9.6, 2.1], CameraFocalPoint=[0.1, 0, 2.16], CameraViewAngle=26.5,
                          BackgroundRadiance=[0.02, 0.025, 0.035], Exposure=0.5)
if not sys.argv[0]:  # no command line: ParaView's window
    Show(picture, GetActiveViewOrCreate("RenderView"))
    ResetCamera()
else:
    SaveData(arguments.output, proxy=picture)
    light.UpdatePropertyInformation()
    print(light.Orders, "orders, energy balance to", light.BalanceError, "in", light.Seconds, "s")
