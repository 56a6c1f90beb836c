"""A cumulus with the low sun behind it and with the sun behind the camera: its droplets scatter forwards, which makes the
bright edges, and what an isotropic cloud of the same transport looks like.

    pvbatch silver_lining.py [--output FOLDER] [--voxels 112] [--size 640 400]

The water is that of Data/Scenes/cumulus.vdb (made by make_scenes.py). The cloud is written to a .vdb with all that tells
how it scatters, read again, and lit. `./run demo` calls this, with 72 voxels.
"""
import argparse
import os
import time

import numpy
from paraview.simple import *
from paraview import servermanager
from paraview.vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from paraview.vtk.vtkCommonDataModel import vtkImageData
from paraview.vtk.vtkIOImage import vtkPNGWriter

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())

parser = argparse.ArgumentParser()
parser.add_argument("--output", default=os.environ.get("TYNDALL_TEST_OUTPUT", "."))
parser.add_argument("--voxels", type=int, default=112, help="along the cloud's longest edge")
parser.add_argument("--size", type=int, nargs=2, default=[640, 400], help="columns and rows of each picture")
arguments = parser.parse_args()
os.makedirs(arguments.output, exist_ok=True)
here = os.path.dirname(os.path.abspath(__file__))


def output(name):
    return os.path.join(arguments.output, name)


# Density is the mass of water in g/m^3, length is in metres. Droplets of 10 um have an extinction of 0.15 1/m at 1
# g/m^3, and absorb nearly nothing.
water = VDBReader(registrationName="Liquid water",
                  FileName=os.path.join(here, "..", "..", "Data", "Scenes", "cumulus.vdb"))
water.UpdatePipeline()
x0, x1, y0, y1, z0, z1 = water.GetDataInformation().GetBounds()
parts = [max(3, round(arguments.voxels * edge / (x1 - x0)) + 1) for edge in (x1 - x0, y1 - y0, z1 - z0)]
coarse = ResampleToImage(registrationName="As many voxels", Input=water, UseInputBounds=1, SamplingDimensions=parts)


def cloud(name, g):
    """The cloud with a mean cosine g and the same transport of light, by way of a .vdb file."""
    medium = ParticipatingMedium(registrationName=name, Input=coarse, DensityArray=["POINTS", "liquid_water"],
                                 ExtinctionScale=0.15 * (1 - 0.85) / (1 - g), Albedo=[0.9999] * 3,
                                 MeanCosine=g)
    medium.MaximumDensity = 1
    file = output(name + ".vdb")
    VDBWriter(Input=medium, FileName=file).UpdatePipeline()
    return VDBReader(registrationName=name + " from .vdb", FileName=file)


sky = EnvironmentReader(registrationName="Sky", FileName=os.path.join(here, "..", "..", "Data", "Scenes", "sky.hdr"))
centre = [0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.5 * (z0 + z1)]


def picture(medium, degree, sun_azimuth, exposure):
    """What a camera before the cloud sees, the sun at an azimuth."""
    sun = LightRig(SunElevation=14, SunAzimuth=sun_azimuth, SunPower=[900, 780, 600])
    light = LightPropagationMaps(Input=medium, Lights=sun, Environment=sky, AngularDegree=degree, Tolerance=1e-2)
    caster = MediumRayCaster(Input=light, Lights=sun, Environment=sky, ImageSize=arguments.size, Exposure=exposure,
                             CameraPosition=[centre[0], centre[1] - 2800, z0 - 350], CameraViewAngle=17,
                             CameraFocalPoint=centre)
    caster.UpdatePipeline()
    light.UpdatePropertyInformation()
    print("%-36s %7.2f s, %d orders, balance to %.1e" % ("angular degree %d, sun at %d degrees" % (degree, sun_azimuth),
                                                         light.Seconds, light.Orders, light.BalanceError))
    assert light.BalanceError < 1e-4
    pixels = vtk_to_numpy(servermanager.Fetch(caster).GetPointData().GetArray("color"))
    return pixels.reshape(arguments.size[1], arguments.size[0], -1)[:, :, :3]


def write_row(name, pictures):
    """Pictures side by side, as a .png."""
    pixels = numpy.ascontiguousarray(numpy.concatenate(pictures, axis=1))
    image = vtkImageData()
    image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
    image.GetPointData().SetScalars(numpy_to_vtk(pixels.reshape(-1, 3), deep=True))
    writer = vtkPNGWriter()
    writer.SetInputData(image)
    writer.SetFileName(output(name + ".png"))
    writer.Write()


begin = time.perf_counter()
even, forward = cloud("isotropic-cloud", 0.0), cloud("cloud", 0.85)
for name, azimuth, exposure in (("sun-behind-the-cloud", 78, 0.0015), ("sun-behind-the-camera", 250, 0.0042)):
    write_row(name, [picture(even, 0, azimuth, exposure), picture(forward, -1, azimuth, exposure)])
print("%.1f s in all" % (time.perf_counter() - begin))
