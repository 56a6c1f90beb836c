"""A glass in the sun, on a table: a mesh, photons along bent rays, a picture with the caustic.

    pvpython goblet.py [--output FILE.png] [--size 640 600] [--voxels 192] [--photons 1000000]

In ParaView's window: File, Load State, with the plugin loaded. goblet.ply is a goblet in mm, closed; studio.hdr a dark
room with two soft boxes. make_scenes.py made both.
"""
import argparse
import os
import sys

from paraview.simple import *

parser = argparse.ArgumentParser()
parser.add_argument("--output", default="goblet.png")
parser.add_argument("--size", type=int, nargs=2, default=[640, 600])
parser.add_argument("--voxels", type=int, default=192, help="along the box's longest edge")
parser.add_argument("--photons", type=int, default=1000000)
arguments = parser.parse_args()

if "MediumRayCaster" not in globals():  # else the plugin is loaded already
    LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
here = os.path.dirname(os.path.abspath(__file__))

goblet = PLYReader(registrationName="Goblet", FileNames=[os.path.join(here, "goblet.ply")])
box = [-66, 154, -66, 110, -6, 150]  # the table is its floor
edges = [box[2 * a + 1] - box[2 * a] for a in range(3)]
glass = MeshVoxelizer(registrationName="Glass", Input=goblet, ModelBounds=box,
                      SampleDimensions=[round(arguments.voxels * edge / max(edges)) for edge in edges], FilterSize=5,
                      InsideIndex=1.5, InsideAbsorption=[0.004, 0.0015, 0.002], OutsideScattering=[2e-5] * 3)
octree = RefractionOctree(registrationName="Octree", Input=glass)
sun = LightRig(registrationName="Sun", SunElevation=50, SunAzimuth=210, SunPower=[10, 9.3, 8])
room = EnvironmentReader(registrationName="Room", FileName=os.path.join(here, "studio.hdr"))
photons = PhotonEmitter(registrationName="Photons", Input=glass, Lights=sun, Environment=room, Batches=2,
                        PhotonCount=arguments.photons)
marched = PhotonMarcher(registrationName="Marched photons", Input=glass, Photons=photons, Octree=octree)
light = PhotonReconstruction(registrationName="Light", Input=marched)  # smooth where the light is even
picture = MediumRayCaster(registrationName="Picture", Input=light, Environment=room, ImageSize=arguments.size,
                          CameraPosition=[210, -460, 250], CameraFocalPoint=[34, 12, 58], CameraViewAngle=24.5,
                          SurfaceReflection="Fresnel", TableFace="-z", TableColor=[0.36, 0.29, 0.24],
                          TableReflectance=0.03, Exposure=0.7)
if not sys.argv[0]:  # no command line: ParaView's window
    Show(picture, GetActiveViewOrCreate("RenderView"))
    ResetCamera()
else:
    SaveData(arguments.output, proxy=picture)
    marched.UpdatePropertyInformation()
    print("balance of power to", marched.BalanceError)
