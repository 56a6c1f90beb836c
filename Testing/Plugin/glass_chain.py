"""A ball of glass in fog under sun and sky, photons through it, a picture: what the tests of servers and ranks run."""
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkDataObject
from paraview.vtk.util.numpy_support import vtk_to_numpy

from whole_chain import fetch, write_sky

SIZE = [20, 24, 16]


def solve(sky):
    """@return the light in and around the ball"""
    LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
    ball = Sphere(Radius=0.6, ThetaResolution=24, PhiResolution=24)
    medium = MeshVoxelizer(Input=ball, SampleDimensions=SIZE, OutsideMeanCosine=0.5)
    octree = RefractionOctree(Input=medium)
    environment = EnvironmentReader(FileName=sky)
    photons = PhotonEmitter(Input=medium, Lights=LightRig(SunElevation=60), Environment=environment, PhotonCount=5000,
                            Sampler="Halton")
    light = PhotonMarcher(Input=medium, Photons=photons, Octree=octree, PathCount=7)
    light.UpdatePipeline()
    return light


def render(light):
    """@return a picture of it"""
    picture = MediumRayCaster(Input=light, Environment=light.Photons.Environment, ImageSize=[64, 48],
                              SurfaceReflection="Fresnel", TableFace="-z", TableColor=[0.5, 0.4, 0.3],
                              CameraPosition=[0.3, -4, 1], CameraFocalPoint=[0, 0, -0.1])
    picture.UpdatePipeline()
    return picture


def solve_and_render(sky):
    """@return light and picture"""
    light = solve(sky)
    return light, render(light)


def values(light, picture):
    """@return light, radiance, paths and the facts on the panel, at the client"""
    light.UpdatePropertyInformation()
    fluence, facts = fetch(light, vtkDataObject.CELL, "fluence", SIZE)
    ranks = servermanager.ActiveConnection.GetNumberOfDataPartitions()
    paths = [servermanager.Fetch(light, rank, idx=1) for rank in range(ranks)]
    return {
        "fluence": fluence,
        "mean_direction": fetch(light, vtkDataObject.CELL, "mean_direction", SIZE)[0],
        "ior": fetch(light, vtkDataObject.CELL, "ior", SIZE)[0],
        "radiance": fetch(picture, vtkDataObject.POINT, "radiance", [64, 48, 1])[0],
        "balance": vtk_to_numpy(facts.GetArray("energy_balance")).copy(),
        "paths": sum(path.GetNumberOfLines() for path in paths),
        "bends": sum(path.GetNumberOfPoints() for path in paths),
        "facts": (light.Steps, light.Missed, light.Photons.PhotonCount),
    }
