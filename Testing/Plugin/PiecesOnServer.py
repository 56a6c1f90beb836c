"""Servers of many ranks, each of which has only a piece of the medium: the client gets the light that it would compute itself.

    pvpython PiecesOnServer.py DECOMPOSITION RANKS...

With Blocks each rank solves its piece, else all solve the whole.
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import a_server
import numpy
import whole_chain
from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkDataObject
from paraview.vtk.util.numpy_support import vtk_to_numpy

decomposition, counts = sys.argv[1], [int(count) for count in sys.argv[2:]]
log = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "PiecesOnServer.%s.log" % decomposition[:5])
SIZE = [-8, 8, -7, 7, -6, 6]


def medium_of_tetrahedra():
    cells = Tetrahedralize(Input=Wavelet(WholeExtent=SIZE))
    image = ResampleToImage(Input=cells, UseInputBounds=0, SamplingBounds=SIZE, SamplingDimensions=[17, 15, 13])
    return ParticipatingMedium(Input=image, DensityArray=["POINTS", "RTData"], ExtinctionScale=0.2, MinimumDensity=0,
                               MaximumDensity=300)


def solver(medium, **settings):
    return LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], Lights=LightRig(), Decomposition=decomposition, **settings)


def light_and_picture():
    """@return fluence, balance and radiance, at the client"""
    LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
    light = solver(medium_of_tetrahedra(), DirectionsPerFace=4)
    picture = MediumRayCaster(Input=light, CameraPosition=[30, 20, 10], CameraFocalPoint=[0, 0, 0], ImageSize=[24, 18])
    light.UpdatePipeline()
    picture.UpdatePipeline()
    fluence, facts = whole_chain.fetch(light, vtkDataObject.CELL, "fluence", [17, 15, 13])
    radiance = whole_chain.fetch(picture, vtkDataObject.POINT, "radiance", [24, 18, 1])[0]
    return fluence, vtk_to_numpy(facts.GetArray("energy_balance")).copy(), radiance


expected = light_and_picture()
for count in counts:
    with a_server.started(count, log) as (port, server):
        Connect("localhost", port)
        assert servermanager.ActiveConnection.GetNumberOfDataPartitions() == count
        for found, wanted in zip(light_and_picture(), expected):
            error = abs(found - wanted).max() / abs(wanted).max()
            print("%d ranks: %.1e" % (count, error), flush=True)
            assert error < 1e-6, (count, found, wanted)
        Disconnect()
os._exit(0)  # without talking to the server once more
