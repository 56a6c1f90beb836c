"""A server of three ranks, each of which solves its block, loses one of them amid the solve: the other ranks end, and the client is told,
lives, and solves on in itself.

    pvpython ServerLosesARank.py

A client of ParaView 5.11 that asks a server for properties after it has ended aborts or not, by chance (vtkSMSessionClient::PullState parses a
reply that has not arrived). So the test sees to it that the plugin asks nothing then, and asks only for data itself.
"""
import os
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import a_server
from paraview import servermanager
from paraview.simple import *

PLUGIN = os.environ["TYNDALL_PLUGIN"]
LOG = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "ServerLosesARank.log")
RANKS = 3
CONNECTION_LOST = 6789  # vtkPVSessionBase::ConnectionLost
PATIENCE = 60  # seconds from the death of a rank to the end of the solve, for the busiest machine


def solver(**settings):
    medium = ParticipatingMedium(Input=Wavelet(WholeExtent=[-8, 8, -7, 7, -6, 6]), ExtinctionScale=2,
                                 Albedo=[1, 1, 1], MinimumDensity=0, MaximumDensity=300)
    return LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], Decomposition="Blocks", **settings)


def ranks_of(server):
    """Processes that mpiexec has started."""
    return [int(process) for process in
            subprocess.run(["ps", "-o", "pid=", "--ppid", str(server.pid)], stdout=subprocess.PIPE, text=True).stdout.split()]


def are_there(processes):
    listed = subprocess.run(["ps", "-o", "stat=", "-p", ",".join(map(str, processes))], stdout=subprocess.PIPE, text=True)
    return any(not state.startswith("Z") for state in listed.stdout.split())


class Killer:
    """Kills a rank when the solve has told several times how far it is, and, where that does not end it in time, all of them."""

    def __init__(self, processes):
        self.processes = processes
        self.reports = 0
        self.time = self.last_resort = None

    def __call__(self, handler, event):
        self.reports += handler.GetLastProgressText() == "vtkLightPropagationMaps"  # not while kernels are compiled
        if self.time is None and self.reports == 3:
            all_of_them = " ".join(map(str, self.processes))
            self.last_resort = subprocess.Popen(["sh", "-c", "sleep %d; kill -9 %s" % (PATIENCE, all_of_them)],
                                                start_new_session=True)
            self.time = time.time()
            os.kill(self.processes[-1], signal.SIGKILL)

    def seconds(self):
        return time.time() - self.time

    def rest(self):
        if self.last_resort:
            os.killpg(self.last_resort.pid, signal.SIGKILL)
            self.last_resort.wait()


def lose_a_rank(session, endless, ranks):
    """The other ranks have ended when this returns."""
    losses, before_and_after = [], []
    session.AddObserver(CONNECTION_LOST, lambda *_: losses.append(True))  # at each message that cannot be sent, too
    for priority in 1, -1:  # the plugin has 0
        endless.SMProxy.AddObserver("UpdateDataEvent", lambda *_: before_and_after.append(len(losses)), priority)
    killer = Killer(ranks)
    session.GetProgressHandler().AddObserver("ProgressEvent", killer)
    try:
        endless.UpdatePipeline()
        assert killer.time, "the solve ended before a rank was killed"
        print("%.1f s later the solve has ended" % killer.seconds(), flush=True)
        while are_there(ranks) and killer.seconds() < PATIENCE:
            time.sleep(0.2)
        assert killer.seconds() < PATIENCE, "ranks wait for the one that was killed"
    finally:
        killer.rest()
    assert losses, "the client is not told"
    assert len(set(before_and_after)) == 1, "the plugin asks a server that has ended"


LoadPlugin(PLUGIN, remote=False, ns=globals())
with a_server.started(RANKS, LOG) as (port, server):
    Connect("localhost", port)
    LoadPlugin(PLUGIN, remote=True, ns=globals())
    ranks = ranks_of(server)
    assert len(ranks) == RANKS, ranks
    endless = solver(DirectionsPerFace=64, Acceleration=0, MaximumOrders=1000000, Tolerance=1e-9)
    lose_a_rank(servermanager.ActiveConnection.Session, endless, ranks)
    assert server.wait(30) != 0
    assert endless.GetDataInformation().GetNumberOfPoints() == 0
    print("the client lives", flush=True)
    Connect()
    light = solver(DirectionsPerFace=4)
    light.UpdatePipeline()
    assert light.CellData["fluence"].GetRange()[0] > 0
    print("and solves on", flush=True)
os._exit(0)  # without talking to the server once more
