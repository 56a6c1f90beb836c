"""What a user looks at along the photons' chain, against baselines: caustic, paths, octree, glass ball."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import pictures
import whole_chain
from drawing import colored, cut, drawn

from paraview import servermanager
from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())

ball = Sphere(Radius=0.5, ThetaResolution=64, PhiResolution=64)
medium = MeshVoxelizer(Input=ball, ModelBounds=[-1, 1, -1, 1, -1.4, 1], SampleDimensions=[60, 60, 72],
                       OutsideMeanCosine=0.4)
octree = RefractionOctree(Input=medium, Tolerance=0.02)
sun = LightRig(SunElevation=90)
photons = PhotonEmitter(Input=medium, Lights=sun, PhotonCount=150000)
light = PhotonMarcher(Input=medium, Photons=photons, Octree=octree, PathCount=60)


def show_caustic(view):
    colored(cut(light, [0, 1, 0], [0, 0.001, 0]), ("CELLS", "fluence"), 0, 4, view)


def show_paths(view):
    colored(OutputPort(light, 1), ("POINTS", "power_left"), 0.5, 1, view, LineWidth=2)


def show_octree(view):
    cells = HyperTreeGridToUnstructuredGrid(Input=OutputPort(octree, 1))
    half = Clip(Input=cells, ClipType="Plane", Crinkleclip=1, Invert=0)
    half.ClipType.Normal = [0, 1, 0]
    half.ClipType.Origin = [0, 0.001, 0]
    colored(half, ("CELLS", "octree_level"), 0, 4, view, Representation="Surface With Edges")


def glass_ball():
    sky = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "PhotonPictures.hdr")
    whole_chain.write_sky(sky)
    caster = MediumRayCaster(Input=light, Environment=EnvironmentReader(FileName=sky), ImageSize=[200, 150],
                             CameraPosition=[1.5, -5, 0.8], CameraFocalPoint=[0, 0, -0.35], CameraViewAngle=26,
                             SurfaceReflection="Fresnel", TableFace="-z")
    return pictures.of_image(servermanager.Fetch(caster), "color")


def along_y(show):
    return drawn(show, [200, 240], [0, -10, -0.2], [0, 0, -0.2], 1.25)


faults = pictures.compare("PhotonCaustic", along_y(show_caustic))
faults += pictures.compare("PhotonPaths", along_y(show_paths))
faults += pictures.compare("RefractionOctreeNodes", along_y(show_octree))
faults += pictures.compare("GlassBall", glass_ball())
assert not faults, "\n".join(faults)
