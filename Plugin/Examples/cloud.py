"""A cloud of water under the sun: from density to a picture.    pvpython cloud.py [folder for the picture]"""
import os
import sys

from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
os.chdir(sys.argv[1] if len(sys.argv) > 1 else os.environ.get("TYNDALL_TEST_OUTPUT", "."))

# A cloud 480 m wide: mass of water in g/m^3, a ball modulated by waves.
box = Wavelet(WholeExtent=[-24, 24] * 3, Maximum=1, XMag=0.13, YMag=0.11, ZMag=0.14,
              XFreq=17, YFreq=13, ZFreq=19, StandardDeviation=0.3)
water = Calculator(Input=box, ResultArrayName="density", Function="0.5*max(0,RTData-0.5)")
cloud = ParticipatingMedium(Input=water, Preset="Cloud (1 g/m^3 of water, 10 um droplets)", MaximumDensity=1,
                            MillimetresPerUnit=10000)  # a voxel is 10 m

sun = LightRig(SunElevation=30, SunAzimuth=180, SunPower=[4, 3.7, 3.2])
light = LightPropagationMaps(Input=cloud, Lights=sun, SkyColor=[0.03, 0.06, 0.13], Tolerance=5e-3)
picture = MediumRayCaster(Input=light, Lights=sun, ImageSize=[400, 300], BackgroundRadiance=[0.03, 0.06, 0.13],
                          CameraPosition=[50, -95, 45], CameraViewAngle=24)
SaveData("cloud.png", proxy=picture)

light.UpdatePropertyInformation()
print(f"{light.Orders} orders, energy balance to {light.BalanceError:.0e} in {light.Seconds:.2f} s")
assert light.BalanceError < 1e-5
