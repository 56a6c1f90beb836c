"""Photons where they are needed: a ball of glass in fog, after Pfeuti's figures 4.6 to 4.8.

    pvbatch adaptive.py --output FOLDER [--grid 128] [--photons 122000] [--rich 12200000] [--size 800 600]

Makes the light of photons spread evenly, of two fifths as many that are sent where an importance map says, and of a hundred times
as many to compare with. Writes pictures, side by side with their differences from the rich light's picture, eight times as
strong (grey: none), and prints errors, times and where they come from. `./run demo` calls it.
"""
import argparse
import os
import time

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from paraview.vtk.vtkCommonDataModel import vtkImageData
from paraview.vtk.vtkIOImage import vtkPNGWriter

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())

arguments = argparse.ArgumentParser()
arguments.add_argument("--output", required=True)
arguments.add_argument("--grid", type=int, default=128)
arguments.add_argument("--photons", type=int, default=122000, help="spread evenly")
arguments.add_argument("--rich", type=int, default=12200000, help="photons of the light to compare with")
arguments.add_argument("--size", type=int, nargs=2, default=[800, 600])
arguments = arguments.parse_args()
os.makedirs(arguments.output, exist_ok=True)

ball = Sphere(registrationName="Ball", Radius=0.5, ThetaResolution=160, PhiResolution=160)
box = [-1, 1, -1, 1, -0.6, 1.4]
medium = MeshVoxelizer(registrationName="Ball in fog", Input=ball, ModelBounds=box, SampleDimensions=[arguments.grid] * 3,
                       InsideIndex=1.5, InsideScattering=[0.02] * 3, OutsideScattering=[0.35] * 3, OutsideAbsorption=[0.03] * 3)
octree = RefractionOctree(registrationName="Octree", Input=medium)
lamp = LightRig(registrationName="Lamp", Sun=0, PointLights=[0.9, 1.1, 3.6, 110, 110, 110])
seconds = {}


def timed(name, proxy):
    """Do a filter's work; its time adds to that of its light."""
    begin = time.perf_counter()
    proxy.UpdatePipeline()
    seconds[name] = seconds.get(name, 0.0) + time.perf_counter() - begin
    return proxy


def evenly(name, photons, **settings):
    """Photons spread evenly."""
    emitter = timed(name, PhotonEmitter(registrationName=name + ": photons", Input=medium, Lights=lamp, PhotonCount=photons, **settings))
    return timed(name, PhotonMarcher(registrationName=name, Input=medium, Photons=emitter, Octree=octree))


def adaptively(name, photons):
    """As many photons with the pilot ones, sent where the light is uneven. All that estimators may want is gathered."""
    importance = timed(name, PhotonImportance(registrationName=name + ": importance", Input=octree, Lights=lamp))
    emitter = PhotonEmitter(registrationName=name + ": photons", Input=medium, Lights=lamp,
                            ImportanceMap=OutputPort(importance, 0), PhotonCount=photons - importance.PilotCount)
    timed(name, emitter)
    return timed(name, PhotonMarcher(registrationName=name, Input=medium, Photons=emitter, Octree=octree, PhotonCounts=1))


def fluence(light):
    return vtk_to_numpy(servermanager.Fetch(light).GetCellData().GetArray("fluence")).astype(float)


def picture(name, light):
    """What a screen shows: rows x columns x 3, 0 to 255."""
    caster = MediumRayCaster(registrationName="Picture, " + name, Input=light, ImageSize=arguments.size,
                             CameraPosition=[0.3, -4.4, 1.3], CameraFocalPoint=[0.0, 0.0, 0.15], CameraViewAngle=27,
                             SurfaceReflection="Fresnel", TableFace="-z", TableColor=[0.7, 0.68, 0.65], Exposure=3)
    image = servermanager.Fetch(caster)
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(arguments.size[1], arguments.size[0], -1)[:, :, :3].astype(int)


def save(name, pixels):
    rows, columns, _ = pixels.shape
    image = vtkImageData()
    image.SetDimensions(columns, rows, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(numpy.ascontiguousarray(pixels.reshape(-1, 3)).astype(numpy.uint8), deep=True))
    writer = vtkPNGWriter()
    writer.SetFileName(os.path.join(arguments.output, name + ".png"))
    writer.SetInputData(image)
    writer.Write()


rich = evenly("a hundred times as many", arguments.rich)
even = evenly("spread evenly", arguments.photons)
noisy = adaptively("adaptive", arguments.photons * 2 // 5)


def rebuilt(name, **settings):
    return timed(name, PhotonReconstruction(registrationName=name, Input=noisy, **settings))


lights = {
    "spread evenly": even,
    "adaptive": rebuilt("adaptive: reconstruction"),
    "adaptive, as published": rebuilt("as published", Scheme="As published"),
    "constant radius, level 1": rebuilt("level 1", Scheme="Constant radius", Level=1),
    "constant radius, level 4": rebuilt("level 4", Scheme="Constant radius", Level=4),
    "nearest photon": rebuilt("nearest", Scheme="Nearest photons", NearestPhotons=1),
    "20 nearest photons": rebuilt("nearest 20", Scheme="Nearest photons", NearestPhotons=20),
}
reference = fluence(rich)
shown = picture("rich", rich)
pictures, differences = {}, {}
print("%-26s %14s %16s" % ("light", "error, L2", "of its picture"))
for name, light in lights.items():
    pictures[name] = picture(name, light)
    differences[name] = numpy.clip(128 + 8 * (pictures[name] - shown), 0, 255)
    error = numpy.linalg.norm(fluence(light) - reference) / numpy.linalg.norm(reference)
    print("%-26s %14.4f %11.2f/255" % (name, error, numpy.sqrt(numpy.mean((pictures[name] - shown) ** 2.0))))
for name, value in seconds.items():
    print("%-40s %8.3f s" % (name, value))


def side_by_side(names):
    """Pictures above, differences below; the first row of an image is its lowest."""
    return numpy.concatenate([numpy.concatenate([of[name] for name in names], axis=1) for of in (differences, pictures)])


save("adaptive", pictures["adaptive"])
save("adaptive-against-even", side_by_side(["spread evenly", "adaptive"]))
save("estimators", numpy.concatenate([
    side_by_side(["nearest photon", "20 nearest photons", "adaptive"]),
    side_by_side(["constant radius, level 1", "constant radius, level 4", "adaptive, as published"])]))
