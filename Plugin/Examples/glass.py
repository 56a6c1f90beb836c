"""A ball of glass in fog on a table: photons along bent rays.    pvpython glass.py [folder for the picture]"""
import os
import sys

from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
folder = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("TYNDALL_TEST_OUTPUT", ".")

# Converts a mesh to voxels with a refractive index: glass inside, thin fog outside.
ball = Sphere(Radius=0.5, ThetaResolution=80, PhiResolution=80)
medium = MeshVoxelizer(Input=ball, ModelBounds=[-1, 1, -1, 1, -0.6, 1.4], SampleDimensions=[96] * 3, InsideIndex=1.5,
                       InsideScattering=[0.02] * 3, OutsideScattering=[0.35] * 3, OutsideAbsorption=[0.03] * 3)

lamp = LightRig(Sun=0, PointLights=[0.9, 1.1, 3.6, 110, 110, 110])
photons = PhotonEmitter(Input=medium, Lights=lamp, PhotonCount=300000)
light = PhotonMarcher(Input=medium, Photons=photons, PathCount=151)
picture = MediumRayCaster(Input=light, ImageSize=[400, 300], CameraPosition=[0.3, -4.4, 1.3],
                          CameraFocalPoint=[0, 0, 0.15], CameraViewAngle=27, SurfaceReflection="Fresnel",
                          TableFace="-z", TableColor=[0.7, 0.68, 0.65], Exposure=3)
SaveData(os.path.join(folder, "glass.png"), proxy=picture)

light.UpdatePropertyInformation()
print("energy balance to", light.BalanceError, "in", light.Seconds, "s")
assert light.BalanceError < 1e-5
