"""The whole chain on a server: the client gets the light that it would compute itself.

    pvpython ChainOnServer.py RANKS
"""
import os
import socket
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import whole_chain

from paraview import servermanager
from paraview.simple import *

ranks = int(sys.argv[1])


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


sky = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "ChainOnServer%d.hdr" % ranks)
whole_chain.write_sky(sky)
expected = whole_chain.values(*whole_chain.solve_and_render(sky))

port = free_port()
launcher = ["mpiexec", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
# pvpython is a rank of MPI itself; what that has left in the environment would make mpiexec fail.
environment = {name: value for name, value in os.environ.items() if not name.startswith(("OMPI_", "PMIX_"))}
log = open(os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "ChainOnServer%d.log" % ranks), "w")
server = subprocess.Popen(launcher + ["pvserver", "--server-port=%d" % port], stdout=subprocess.PIPE, stderr=log,
                          text=True, env=environment)
try:
    assert any("Accepting connection" in line for line in server.stdout), "the server does not start, see " + log.name
    Connect("localhost", port)
    assert servermanager.ActiveConnection.IsRemote()
    assert servermanager.ActiveConnection.GetNumberOfDataPartitions() == ranks
    found = whole_chain.values(*whole_chain.solve_and_render(sky))
    for name in ("fluence", "radiance", "balance"):
        assert found[name].shape == expected[name].shape, name
        assert (found[name] == expected[name]).all(), (name, abs(found[name] - expected[name]).max())
    assert (found["orders"], found["rows"]) == (expected["orders"], expected["rows"]), found
finally:
    server.terminate()  # mpiexec takes its ranks with it
    try:
        server.wait(10)
    except subprocess.TimeoutExpired:  # a server does not always hear it
        server.kill()
