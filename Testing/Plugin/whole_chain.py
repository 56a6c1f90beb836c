"""Density, medium, sun and sky, light, picture, through proxies: what the tests of servers and ranks run."""
import os

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkDataObject
from paraview.vtk.util.numpy_support import vtk_to_numpy

SIZE = [-10, 10, -8, 8, -6, 6]


def write_sky(path):
    """A small Radiance picture, brighter above than below."""
    rows = b"".join(bytes([2, 2, 0, 8]) + b"".join(bytes([136, shade]) for shade in (200 - 40 * row, 180, 160, 128))
                    for row in range(4))
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + rows)


def solve(sky):
    """@return the light of a small cloud under a sun and a sky"""
    LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
    wavelet = Wavelet(WholeExtent=SIZE)
    wavelet.UpdatePipeline()
    medium = ParticipatingMedium(Input=wavelet, ExtinctionScale=0.3, Albedo=[0.95, 0.9, 0.8])
    medium.UpdatePipeline()
    sun = LightRig(SunElevation=60)
    environment = EnvironmentReader(FileName=sky)
    light = LightPropagationMaps(Input=medium, Lights=sun, Environment=environment, DirectionsPerFace=9)
    light.UpdatePipeline()
    return light


def render(light):
    """@return a picture of it"""
    picture = MediumRayCaster(Input=light, Environment=light.Environment, ImageSize=[64, 48])
    picture.UpdatePipeline()
    return picture


def solve_and_render(sky):
    """@return light and picture"""
    light = solve(sky)
    return light, render(light)


def fetch(proxy, association, name, size):
    """@return an array of an image of which each rank has a piece, and the field data of the last"""
    whole = None
    for rank in range(servermanager.ActiveConnection.GetNumberOfDataPartitions()):
        piece = servermanager.Fetch(proxy, rank)  # without a rank it would be that of the first one alone
        low, high = piece.GetExtent()[::2], piece.GetExtent()[1::2]
        array = piece.GetAttributes(association).GetArray(name)
        if whole is None:
            whole = numpy.full(size[::-1] + [array.GetNumberOfComponents()], numpy.nan)
        count = [h - l + (association == vtkDataObject.POINT) for l, h in zip(low, high)]
        start = [l - f for l, f in zip(low, proxy.GetDataInformation().GetExtent()[::2])]
        place = tuple(slice(s, s + c) for s, c in zip(start[::-1], count[::-1]))
        whole[place] = vtk_to_numpy(array).reshape(count[::-1] + [-1])
    assert not numpy.isnan(whole).any(), "%s has holes" % name
    return whole, piece.GetFieldData()


def values(light, picture):
    """@return fluence, radiance, convergence and the facts on the panel, at the client"""
    light.UpdatePropertyInformation()
    fluence, facts = fetch(light, vtkDataObject.CELL, "fluence", [21, 17, 13])  # a voxel for each point
    return {
        "fluence": fluence,
        "radiance": fetch(picture, vtkDataObject.POINT, "radiance", [64, 48, 1])[0],
        "balance": vtk_to_numpy(facts.GetArray("energy_balance")).copy(),
        "rows": servermanager.Fetch(light, idx=1).GetNumberOfRows(),
        "orders": light.Orders,
    }
