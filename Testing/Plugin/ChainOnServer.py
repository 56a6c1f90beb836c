"""A whole chain on a server: the client gets the light that it would compute itself.

    pvpython ChainOnServer.py RANKS [MODULE]    the module that makes the chain; whole_chain if it is not said
"""
import importlib
import os
import socket
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import numpy
from paraview import servermanager
from paraview.simple import *

ranks = int(sys.argv[1])
name = sys.argv[2] if len(sys.argv) > 2 else "whole_chain"
chain = importlib.import_module(name)
file = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "ChainOnServer%d%s" % (ranks, name))


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


sky = file + ".hdr"
chain.write_sky(sky)
expected = chain.values(*chain.solve_and_render(sky))

port = free_port()
launcher = ["mpiexec", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
# pvpython is a rank of MPI itself; what that has left in the environment would make mpiexec fail.
environment = {name: value for name, value in os.environ.items() if not name.startswith(("OMPI_", "PMIX_"))}
log = open(file + ".log", "w")
server = subprocess.Popen(launcher + ["pvserver", "--server-port=%d" % port], stdout=subprocess.PIPE, stderr=log,
                          text=True, env=environment)
try:
    assert any("Accepting connection" in line for line in server.stdout), "the server does not start, see " + log.name
    Connect("localhost", port)
    assert servermanager.ActiveConnection.IsRemote()
    assert servermanager.ActiveConnection.GetNumberOfDataPartitions() == ranks
    found = chain.values(*chain.solve_and_render(sky))
    assert found.keys() == expected.keys()
    for name, value in found.items():
        assert numpy.shape(value) == numpy.shape(expected[name]), name
        assert numpy.all(value == expected[name]), (name, value, expected[name])
finally:
    server.terminate()  # mpiexec takes its ranks with it
    try:
        server.wait(10)
    except subprocess.TimeoutExpired:  # a server does not always hear it
        server.kill()
