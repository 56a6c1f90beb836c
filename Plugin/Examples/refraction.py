"""Glass in lit fog: two meshes voxelised, photons marched along bent rays, pictures with refraction.

    pvbatch refraction.py --data FOLDER --output FOLDER [--grid 192] [--photons 3000000] [--size 800 600]

FOLDER holds armadillo.ply and elephant.ply (CGAL's demo data, Debian package libcgal-demo) and sunset.exr (Blender's studio
lights, Debian package blender-data). `./run demo` fetches all and calls this.
"""
import argparse
import math
import os
import time

from paraview.simple import *
from paraview import servermanager
from vtkmodules.vtkFiltersCore import vtkImageAppend
from vtkmodules.vtkImagingCore import vtkExtractVOI
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())

arguments = argparse.ArgumentParser()
arguments.add_argument("--data", required=True)
arguments.add_argument("--output", required=True)
arguments.add_argument("--grid", type=int, default=192, help="voxels along the box's longest edge")
arguments.add_argument("--photons", type=int, default=3000000)
arguments.add_argument("--size", type=int, nargs=2, default=[800, 600], help="columns and rows of the pictures")
arguments.add_argument("--scenes", nargs="*", default=["armadillo", "elephant", "solvers"])
arguments = arguments.parse_args()
os.makedirs(arguments.output, exist_ok=True)

stages = []


def stage(name, proxy):
    """Do a filter's work and note how long it took."""
    begin = time.perf_counter()
    proxy.UpdatePipeline()
    stages.append((name, time.perf_counter() - begin))
    return proxy


def data(name):
    return os.path.abspath(os.path.join(arguments.data, name))


def output(name):
    return os.path.join(arguments.output, name)


def standing(name):
    """A mesh of CGAL's, whose up is y, with z upwards and its bounds."""
    mesh = PLYReader(registrationName=name, FileNames=[data(name + ".ply")])
    upright = Transform(registrationName=name + " upright", Input=mesh)
    upright.Transform.Rotate = [90, 0, 0]
    stage("read " + name, upright)
    return upright, upright.GetDataInformation().GetBounds()


def voxels(bounds, part=1):
    """Cubic voxels in a box, along its longest edge as many as were asked for, or a part of these."""
    edges = [bounds[2 * a + 1] - bounds[2 * a] for a in range(3)]
    return [max(1, round(part * arguments.grid * edge / max(edges))) for edge in edges]


def light_in(name, medium, lights, photons, environment=None):
    """March photons through a medium."""
    octree = stage(name + ": octree", RefractionOctree(registrationName=name + " octree", Input=medium))
    emitter = PhotonEmitter(registrationName=name + " photons", Input=medium, Lights=lights, PhotonCount=photons)
    if environment:
        emitter.Environment = environment
    stage(name + ": photons", emitter)
    marcher = PhotonMarcher(registrationName=name + " light", Input=medium, Photons=emitter, Octree=octree, PathCount=60)
    return stage(name + ": march photons", marcher)


def around(centre, distance, azimuth, elevation):
    """A place on a sphere about a centre, angles in degrees."""
    a, e = math.radians(azimuth), math.radians(elevation)
    return [centre[0] + distance * math.cos(a) * math.cos(e), centre[1] + distance * math.sin(a) * math.cos(e),
            centre[2] + distance * math.sin(e)]


def picture(name, light, **settings):
    """Render, and save what a screen shows."""
    caster = MediumRayCaster(registrationName=name, Input=light, ImageSize=arguments.size, **settings)
    stage("render " + name, caster)
    SaveData(output(name + ".png"), proxy=caster)
    return caster


def panels(name, casters):
    """Save one picture of four: the squares in their middles, two above two."""
    rows = vtkImageAppend()
    rows.SetAppendAxis(1)
    for pair in casters[2:], casters[:2]:
        row = vtkImageAppend()
        for one in pair:
            image = servermanager.Fetch(one)
            columns, height = image.GetDimensions()[:2]
            left = max(0, (columns - height) // 2)
            middle = vtkExtractVOI()
            middle.SetVOI(left, left + min(columns, height) - 1, 0, height - 1, 0, 0)
            middle.SetInputData(image)
            row.AddInputConnection(middle.GetOutputPort())
        rows.AddInputConnection(row.GetOutputPort())
    writer = vtkPNGWriter()
    writer.SetFileName(output(name + ".png"))
    writer.SetInputConnection(rows.GetOutputPort())
    writer.Write()


def armadillo(sky):
    """Of green glass, on a table, in thin fog by the sea: the sun behind it draws a caustic."""
    mesh, b = standing("armadillo")
    middle = [0.5 * (b[0] + b[1]), 0.5 * (b[2] + b[3])]
    box = [middle[0] - 125, middle[0] + 125, middle[1] - 85, middle[1] + 165, b[4] - 6, b[5] + 14]
    medium = MeshVoxelizer(registrationName="Armadillo in fog", Input=mesh, ModelBounds=box, SampleDimensions=voxels(box),
                           InsideIndex=1.5, InsideAbsorption=[0.02, 0.005, 0.009], OutsideScattering=[0.0006] * 3,
                           InsideMeanCosine=0.7, OutsideMeanCosine=0.7)
    stage("armadillo: voxels", medium)
    sun = LightRig(registrationName="Sun", SunElevation=52, SunAzimuth=262, SunPower=[26, 22.6, 16])
    light = light_in("armadillo", medium, sun, arguments.photons, sky)
    centre = [middle[0] + 10, middle[1] + 35, 0.5 * (box[4] + box[5]) - 24]
    picture("armadillo-in-glass", light, Environment=sky, CameraPosition=around(centre, 560, 70, 11),
            CameraFocalPoint=centre, SurfaceReflection="Fresnel", TableFace="-z", TableColor=[0.16, 0.13, 0.11],
            TableReflectance=0.06, Exposure=0.7)
    return light


def elephant_in_a_sphere(part=1):
    """Inside a sphere of another material, lit by a spot from behind (Bernabei et al., figure 8a): one hue, and only the
    refractive index and the density differ. Medium, lamp, and the centre."""
    mesh, b = standing("elephant")
    centre = [0.5 * (b[2 * a] + b[2 * a + 1]) for a in range(3)]
    sphere = Sphere(registrationName="Sphere", Center=centre, Radius=0.72, ThetaResolution=160, PhiResolution=160)
    box = [c + side for c in centre for side in (-0.82, 0.82)]

    def material(number, index, density):
        return [number, index, *(density * h for h in (0.9, 0.55, 0.2)), *(density * h for h in (0.05, 0.225, 0.4)), 0]

    medium = MeshVoxelizer(registrationName="Elephant in a sphere", Input=[sphere, mesh], ModelBounds=box,
                           SampleDimensions=voxels(box, part), OutsideScattering=[0, 0, 0],
                           Materials=material(0, 1.1, 0.35) + material(1, 1.4, 5))
    stage("elephant: voxels", medium)
    lamp = around(centre, 4, 75, 35)
    spot = LightRig(registrationName="Spot", Sun=0,
                    SpotLights=[*lamp, *(c - p for c, p in zip(centre, lamp)), 60, 60, 60, 24])
    return medium, spot, centre


def seen(name, light, centre):
    """The elephant from the side."""
    return picture("elephant-in-a-sphere" + name, light, Exposure=0.25, CameraPosition=around(centre, 5, 260, 10),
                   CameraFocalPoint=centre, CameraViewAngle=19, SurfaceReflection="Fresnel")


def elephant():
    """Its light scattered once, and many times."""
    medium, spot, centre = elephant_in_a_sphere()
    bent = light_in("elephant", medium, spot, arguments.photons)
    light = stage("elephant: scattered many times", LightPropagationMaps(registrationName="elephant scattered light",
                                                                         Input=medium, UncollidedLight=bent))
    seen("-one-scattering", bent, centre)
    seen("", light, centre)
    return light


def elephant_by_four_solvers():
    """The same light scattered many times by photons alone, by a lattice alone, by photons and a lattice, and by photons and
    maps, in half as many voxels along each edge. Photons alone are without bias, and the others' measure."""
    medium, spot, centre = elephant_in_a_sphere(0.5)
    bent = light_in("elephant", medium, spot, arguments.photons // 3)
    photons = PhotonMarcher(registrationName="elephant by photons", Input=medium, Photons=bent.Photons, Octree=bent.Octree,
                            MaximumOrders=0, ErrorBatches=0)
    solved = {
        "photons": photons,
        "lattice": LatticeBoltzmannLighting(registrationName="elephant by a lattice", Input=medium, Lights=spot,
                                            Tolerance=1e-3),
        "photons-and-lattice": LatticeBoltzmannLighting(registrationName="elephant by photons and a lattice", Input=medium,
                                                        UncollidedLight=bent, Tolerance=1e-3),
        "photons-and-maps": LightPropagationMaps(registrationName="elephant by photons and maps", Input=medium,
                                                 UncollidedLight=bent, Tolerance=1e-3)}
    views = [seen("-by-" + name, stage("elephant: by " + name, light), centre) for name, light in solved.items()]
    panels("elephant-by-four-solvers", views)
    compare(photons, {name: light for name, light in solved.items() if light is not photons})
    return photons


def compare(reference, others):
    """Print how far fluence is from that of photons that were followed through every scattering, where the medium is."""
    right = fluence(reference)
    for name, light in others.items():
        difference = abs(fluence(light) - right).sum() / right.sum()
        comparisons.append(("elephant by %s, fluence against photons alone" % name, difference))


def fluence(light):
    """Of all voxels and channels."""
    return vtk_to_numpy(servermanager.Fetch(light).GetCellData().GetArray("fluence")).astype(float)


comparisons = []
sky = EnvironmentReader(registrationName="Sky", FileName=data("sunset.exr"))
lights = {}
if "armadillo" in arguments.scenes:
    lights["armadillo"] = armadillo(sky)
if "elephant" in arguments.scenes:
    lights["elephant"] = elephant()
if "solvers" in arguments.scenes:
    lights["elephant by photons"] = elephant_by_four_solvers()

print("%-34s %9s" % ("stage", "seconds"))
for name, seconds in stages:
    print("%-34s %9.2f" % (name, seconds))
for name, light in lights.items():
    light.UpdatePropertyInformation()
    print("%-40s %9.1e" % (name + ": balance, relative error", light.BalanceError))
for name, difference in comparisons:
    print("%-62s %5.1f%%" % (name, 100 * difference))
