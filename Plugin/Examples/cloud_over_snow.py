"""A cloud above grass and above snow: what its shadow leaves of the light comes back from the ground and lights it from
below.

    pvpython cloud_over_snow.py [folder for the pictures]
"""
import os
import sys

from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
folder = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("TYNDALL_TEST_OUTPUT", ".")

# A cloud in a box 960 m wide and 640 m high: mass of water in g/m^3, in voxels of 20 m. The ground is the face -z.
box = Wavelet(WholeExtent=[-24, 24, -24, 24, -16, 16], Maximum=1, XMag=0.13, YMag=0.11, ZMag=0.14,
              XFreq=17, YFreq=13, ZFreq=19, StandardDeviation=0.25)
water = Calculator(Input=box, ResultArrayName="density", Function="0.3*max(0,RTData-0.62)")
cloud = ParticipatingMedium(Input=water, Preset="Cloud (1 g/m^3 of water, 10 um droplets)", MaximumDensity=1,
                            MillimetresPerUnit=20000)
sun = LightRig(SunElevation=50, SunAzimuth=200, SunPower=[4, 3.7, 3.2])
light = LightPropagationMaps(Input=cloud, Lights=sun, SkyColor=[0.03, 0.06, 0.13], Tolerance=5e-3)
picture = MediumRayCaster(Input=light, Lights=sun, ImageSize=[400, 300], Exposure=0.5,
                          BackgroundRadiance=[0.03, 0.06, 0.13], CameraPosition=[70, -120, 26],
                          CameraFocalPoint=[0, 0, -4], CameraViewAngle=24)

from_below = {}
for ground, albedo, colour in ("grass", 0.3, [0.5, 1.0, 0.3]), ("snow", 0.8, [1.0, 1.0, 1.0]):
    light.FaceAlbedo = [0, 0, 0, 0, albedo, 0]  # albedo of the ground, the face -z; FaceAlbedoColor sets its colour
    light.FaceAlbedoColor = [1] * 12 + colour + [1] * 3
    SaveData(os.path.join(folder, "cloud-over-%s.png" % ground), proxy=picture)
    light.UpdatePropertyInformation()
    print(ground, light.Orders, "orders, energy balance to", light.BalanceError, "in", light.Seconds, "s")
    assert light.BalanceError < 1e-5
    total = IntegrateVariables(Input=light)
    total.UpdatePipeline()
    from_below[ground] = total.GetCellDataInformation().GetArray("fluence").GetRange(0)[1]
assert from_below["snow"] > 1.1 * from_below["grass"]
