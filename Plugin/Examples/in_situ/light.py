"""A script for ParaView Catalyst: lights the field `density` of a running simulation, and makes a picture of each step.

For a simulation of your own change the name of its input, the array
and the medium; smoke.py runs this one.
"""
import os

from paraview import catalyst
from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
options = catalyst.Options()  # when Catalyst runs this script; default: at each time step
folder = os.environ.get("IN_SITU_FOLDER", ".")

simulation = TrivialProducer(registrationName="input")  # the simulation's data: Catalyst finds the source by this name
medium = ParticipatingMedium(Input=simulation, DensityArray=["CELLS", "density"], ExtinctionScale=30,
                             Albedo=[0.95, 0.93, 0.9])
medium.MaximumDensity = 1  # set after creation: an argument equal to the default, 1, would be replaced
sun = LightRig(SunElevation=35, SunAzimuth=160, SunPower=[3, 2.8, 2.5])
light = LightPropagationMaps(Input=medium, Lights=sun, SkyColor=[0.1, 0.14, 0.2], Tolerance=1e-3)
picture = MediumRayCaster(Input=light, Lights=sun, ImageSize=[240, 320], BackgroundRadiance=[0.1, 0.14, 0.2], Exposure=2,
                          CameraPosition=[1.6, -1.6, 0.9], CameraFocalPoint=[0.5, 0.5, 0.5], CameraViewAngle=34)


def catalyst_execute(info):
    picture.UpdatePipeline(info.time)
    light.UpdatePropertyInformation()
    print("step %d, time %.2f: %d sweeps, balance to %.1g" % (info.cycle, info.time, light.Orders, light.BalanceError))
    assert light.BalanceError < 1e-5
    SaveData(os.path.join(folder, "smoke_%02d.png" % info.cycle), proxy=picture)
