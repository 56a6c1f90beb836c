"""The plugin is loaded by a server, and its lights come to the client."""
import os
import socket
import subprocess

from paraview import servermanager
from paraview.simple import *


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


port = free_port()
server = subprocess.Popen(["pvserver", f"--server-port={port}"], stdout=subprocess.PIPE, text=True)
try:
    for line in server.stdout:
        if "Accepting connection" in line:
            break
    Connect("localhost", port)
    LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
    rig = LightRig(PointLights=[1, 2, 3, 4, 5, 6])
    rig.UpdatePipeline()
    assert rig.GetDataInformation().GetNumberOfPoints() == 2
    lights = servermanager.Fetch(rig)
    assert lights.GetPoint(1) == (1, 2, 3)
    assert servermanager.ActiveConnection.IsRemote()
    assert server.poll() is None
finally:
    server.kill()
