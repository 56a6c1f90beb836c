"""What a user looks at along the photons' chain, against pictures that were looked at: caustic, paths, octree, glass ball."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import pictures
import whole_chain

import paraview.simple
from paraview import servermanager
from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())

paraview.simple._DisableFirstRenderCameraReset()

ball = Sphere(Radius=0.5, ThetaResolution=64, PhiResolution=64)
medium = MeshVoxelizer(Input=ball, ModelBounds=[-1, 1, -1, 1, -1.4, 1], SampleDimensions=[60, 60, 72],
                       OutsideMeanCosine=0.4)
octree = RefractionOctree(Input=medium, Tolerance=0.02)
sun = LightRig(SunElevation=90)
photons = PhotonEmitter(Input=medium, Lights=sun, PhotonCount=150000)
light = PhotonMarcher(Input=medium, Photons=photons, Octree=octree, PathCount=60)


def drawn(show):
    """@return pixels of a view that looks along y at what `show` shows in it"""
    view = CreateView("RenderView")
    view.ViewSize = [200, 240]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    show(view)
    view.CameraPosition = [0, -10, -0.2]
    view.CameraFocalPoint = [0, 0, -0.2]
    view.CameraViewUp = [0, 0, 1]
    view.CameraParallelProjection = 1
    view.CameraParallelScale = 1.25
    Render(view)
    pixels = pictures.of_image(view.CaptureWindow(1))
    Delete(view)
    return pixels


def colored(source, array, low, high, view, **properties):
    shown = Show(source, view, **properties)
    ColorBy(shown, array)
    shown.SetScalarBarVisibility(view, False)
    GetColorTransferFunction(array[1]).RescaleTransferFunction(low, high)
    return shown


def show_caustic(view):
    cut = Slice(Input=light, SliceType="Plane")
    cut.SliceType.Normal = [0, 1, 0]
    cut.SliceType.Origin = [0, 0.001, 0]
    colored(cut, ("CELLS", "fluence"), 0, 4, view)


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
    caster = MediumRayCaster(Input=light, Environment=EnvironmentReader(FileName=sky), ImageSize=[200, 150], CameraPosition=[1.5, -5, 0.8],
                             CameraFocalPoint=[0, 0, -0.35], CameraViewAngle=26, SurfaceReflection="Fresnel",
                             TableFace="-z")
    return pictures.of_image(servermanager.Fetch(caster), "color")


faults = pictures.compare("PhotonCaustic", drawn(show_caustic))
faults += pictures.compare("PhotonPaths", drawn(show_paths))
faults += pictures.compare("RefractionOctreeNodes", drawn(show_octree))
faults += pictures.compare("GlassBall", glass_ball(), mean=0.3, part=0.001)  # computed, not drawn
assert not faults, "\n".join(faults)
