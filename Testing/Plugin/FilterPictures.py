"""What each filter shows in ParaView's views, of the media in Data/Scenes, against pictures that were looked at."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import pictures
from drawing import colored, cut, drawn

from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def scene(name):
    return os.path.join(os.environ["TYNDALL_SOURCE"], "Data/Scenes", name)


def across_cloud(source, array, low, high):
    plane = cut(source, [0, 1, 0], [0, 601, 0])
    return drawn(lambda view: colored(plane, array, low, high, view), [240, 150], [750, -3000, 440], [750, 0, 440], 460)


def across_goblet(source, array, low, high):
    plane = cut(source, [0, 1, 0], [0, 0.01, 0])
    return drawn(lambda view: colored(plane, array, low, high, view), [200, 160], [44, -500, 72], [44, 0, 72], 82)


def across_plume(source, array, low, high):
    plane = cut(source, [0, 1, 0], [0, 0.001, 0])
    return drawn(lambda view: colored(plane, array, low, high, view), [120, 200], [0.1, -10, 2.2], [0.1, 0, 2.2], 2.25)


def flat(source, array, low, high, size, middle, scale):
    """An image that lies in x and y."""
    return drawn(lambda view: colored(source, array, low, high, view, Representation="Surface", MapScalars=1), size,
                 [middle[0], middle[1], 10 * scale], [*middle, 0], scale, (0, 1, 0))


def chart(table, x, y=None):
    """y, or what is shown at first, over x, or row by row where x is None."""
    view = CreateView("XYChartView", ViewSize=[240, 160], ShowLegend=0, LeftAxisLogScale=1)
    shown = Show(table, view)
    if y:
        shown.SeriesVisibility = [y]
    if x:
        shown.XArrayName = x
    else:
        shown.UseIndexForXAxis, view.BottomAxisLogScale = 1, 0
    Render(view)
    pixels = pictures.of_image(view.CaptureWindow(1))
    Delete(view)
    return pixels


def cloud_pictures():
    """The cumulus: read, made a medium, lit by all methods of light propagation."""
    water = VDBReader(FileName=scene("cumulus.vdb"))
    yield "VDBReader", across_cloud(water, ("CELLS", "liquid_water"), 0, 1)
    coarse = ResampleToImage(Input=water, UseInputBounds=1, SamplingDimensions=[51, 41, 31])
    medium = ParticipatingMedium(Input=coarse, DensityArray=["POINTS", "liquid_water"],
                                 Preset="Cloud (1 g/m^3 of water, 10 um droplets)", MillimetresPerUnit=1000)
    yield "ParticipatingMedium", across_cloud(medium, ("CELLS", "sigma_s"), 0, 0.15)
    sun = LightRig(SunElevation=40, SunAzimuth=180, SunPower=[1, 1, 1])
    sky = EnvironmentReader(FileName=scene("studio.hdr"))
    yield "EnvironmentReader", flat(sky, ("POINTS", "radiance"), 0, 5, [200, 104], [95.5, 47.5], 50)
    light = LightPropagationMaps(Input=medium, Lights=sun, SkyColor=[0.1, 0.1, 0.1], NetFlux=1,
                                 EstimateError=1)
    yield "LightPropagationMapsFluence", across_cloud(light, ("CELLS", "fluence"), 0, 3.5)
    yield "LightPropagationMapsUnscattered", across_cloud(light, ("CELLS", "fluence_direct"), 0, 2.3)
    yield "LightPropagationMapsNetFlux", across_cloud(light, ("CELLS", "net_flux", "X"), -0.3, 1)
    yield "LightPropagationMapsError", across_cloud(light, ("CELLS", "fluence_error"), 0, 0.1)
    yield "LightPropagationMapsConvergence", chart(OutputPort(light, 1), "iteration", "residual")
    picture = MediumRayCaster(Input=light, ImageSize=[240, 150], CameraPosition=[700, -1950, 0],
                              CameraFocalPoint=[720, 600, 400], CameraViewAngle=23)
    yield "MediumRayCasterDepth", flat(picture, ("POINTS", "depth"), 2150, 2700, [240, 150], [119.5, 74.5], 75)


def plume_pictures():
    """The plume, as published: what one scattering order sends on, and what is collected of it."""
    density = XMLImageDataReader(FileName=[scene("plume.vti")])
    coarse = ResampleToImage(Input=density, UseInputBounds=1, SamplingDimensions=[25, 24, 45])
    medium = ParticipatingMedium(Input=coarse, DensityArray=["POINTS", "smoke"], ExtinctionScale=14)
    sun = LightRig(SunElevation=20, SunAzimuth=180)
    first = LPMCollect(Input=LPMPropagate(Input=medium, Lights=sun, DirectionsPerFace=9))
    buffers = LPMPropagate(Input=first, Lights=sun, DirectionsPerFace=9)
    yield "LPMPropagate", across_plume(buffers, ("CELLS", "T_xmax", "Magnitude"), 0, 0.01)
    yield "LPMCollect", across_plume(LPMCollect(Input=buffers), ("CELLS", "fluence"), 0, 1.5)
    few = ResampleToImage(Input=density, UseInputBounds=1, SamplingDimensions=[13, 12, 23])
    small = ParticipatingMedium(Input=few, DensityArray=["POINTS", "smoke"], ExtinctionScale=14)
    # Errors by setting: run times are never the same.
    settings = SolverComparison(Input=small, Lights=sun, Directions=[4, 9, 16, 25, 49], Coarsenings=[1], Repeats=1, MonteCarloReference=0,
                                MapResolutions=[1], PhotonCounts=[1000, 10000], EstimateError=0, TimeBudget=1e6)
    yield "SolverComparison", chart(OutputPort(settings, 0), None)  # seconds differ from run to run


def goblet_pictures():
    """The goblet: voxelised, and the way of adaptive photons through it."""
    goblet = PLYReader(FileNames=[scene("goblet.ply")])
    medium = MeshVoxelizer(Input=goblet, ModelBounds=[-56, 144, -56, 56, -8, 152], SampleDimensions=[75, 42, 60],
                           FilterSize=5)
    yield "MeshVoxelizerIndex", across_goblet(medium, ("CELLS", "ior"), 1, 1.5)
    octree = RefractionOctree(Input=medium)
    yield "RefractionOctreeLevels", across_goblet(octree, ("CELLS", "octree_level"), 0, 4)
    sun = LightRig(SunElevation=50, SunAzimuth=180)
    importance = PhotonImportance(Input=octree, Lights=sun, PilotCount=4096)
    yield "PhotonImportanceMap", flat(importance, ("CELLS", "importance"), 0, 3, [160, 160], [0.5, 0.5], 0.52)
    yield "PhotonImportancePilot", across_goblet(OutputPort(importance, 1), ("CELLS", "fluence"), 0, 2)
    photons = PhotonEmitter(Input=octree, Lights=sun, ImportanceMap=importance, PhotonCount=20000)
    few = PhotonEmitter(Input=octree, Lights=sun, ImportanceMap=importance, PhotonCount=3000)
    yield "PhotonEmitter", drawn(lambda view: colored(few, ("POINTS", "weight"), 0, 2, view, PointSize=3,
                                                      Representation="Points"),
                                 [200, 160], [-400, -200, 500], [44, 0, 72], 110)
    noisy = PhotonMarcher(Input=octree, Photons=photons)
    smooth = PhotonReconstruction(Input=noisy)
    yield "PhotonReconstructionFluence", across_goblet(smooth, ("CELLS", "fluence"), 0, 2)
    yield "PhotonReconstructionLevel", across_goblet(smooth, ("CELLS", "mip_level"), 0, 3)
    yield "PhotonReconstructionError", across_goblet(smooth, ("CELLS", "fluence_error"), 0, 0.4)


def light_pictures():
    """Lights as arrows along their directions."""
    rig = LightRig(SunElevation=50, PointLights=[-3, 0, 0, 1, 1, 1], SpotLights=[0, 0, 1, 1, 0, -1, 1, 1, 1, 40],
                   RectangleLights=[3, 0, 1, 0, 0, -1, 1, 1, 1, 1, 1])
    arrows = Glyph(Input=rig, GlyphType="Arrow", OrientationArray=["POINTS", "direction"], ScaleFactor=2,
                   GlyphMode="All Points")
    yield "LightRig", drawn(lambda view: colored(arrows, ("POINTS", "light_type"), 0, 3, view), [200, 150],
                            [2, -12, 5], [0, 0, 0], 3.2)


faults = []
for made in (light_pictures, cloud_pictures, plume_pictures, goblet_pictures):
    for name, pixels in made():
        faults += pictures.compare(name, pixels)
assert not faults, "\n".join(faults)
