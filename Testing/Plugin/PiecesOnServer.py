"""Servers of many ranks, each of which has only a piece of the medium: the client gets the light that it would compute itself. With
kill a rank of the last one is then killed amid its work: the server ends, and the client lives and is told.

    pvpython PiecesOnServer.py DECOMPOSITION RANKS... [kill]

With Blocks each rank solves its piece, else all solve the whole.
"""
import os
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import a_server
import numpy
import whole_chain
from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkDataObject
from paraview.vtk.util.numpy_support import vtk_to_numpy

kills = sys.argv[-1] == "kill"
decomposition, counts = sys.argv[1], [int(count) for count in sys.argv[2:] if count != "kill"]
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


def ranks_of(server):
    """Processes that mpiexec has started."""
    return [int(process) for process in
            subprocess.run(["ps", "-o", "pid=", "--ppid", str(server.pid)], stdout=subprocess.PIPE, text=True).stdout.split()]


def kill_one(server, count):
    """The server has ended when this returns."""
    ranks = ranks_of(server)
    assert len(ranks) == count, ranks
    endless = solver(medium_of_tetrahedra(), DirectionsPerFace=64, Acceleration=0, MaximumOrders=1000000, Tolerance=1e-12)
    killer = subprocess.Popen(["sh", "-c", "sleep 3; kill -9 %d" % ranks[-1]])
    start = time.time()
    try:
        endless.UpdatePipeline()
    except RuntimeError as error:
        print("the client is told:", error)
    assert killer.wait(10) == 0
    server.wait(30)
    assert server.returncode != 0 and time.time() - start < 33, "3 seconds before the rank is killed, 30 after"
    try:
        count = Sphere().GetDataInformation().GetNumberOfPoints()
    except (RuntimeError, AttributeError):
        count = 0
    assert count == 0, "the server is gone"
    print("the client lives")


expected = light_and_picture()
for count in counts:
    with a_server.started(count, log) as (port, server):
        Connect("localhost", port)
        assert servermanager.ActiveConnection.GetNumberOfDataPartitions() == count
        for found, wanted in zip(light_and_picture(), expected):
            error = abs(found - wanted).max() / abs(wanted).max()
            print("%d ranks: %.1e" % (count, error), flush=True)
            assert error < 1e-6, (count, found, wanted)
        if kills and count == counts[-1]:
            kill_one(server, count)
        else:
            Disconnect()
os._exit(0)  # without talking to the server once more
