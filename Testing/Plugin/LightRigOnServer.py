"""The plugin is loaded by a server, and its lights come to the client."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import a_server
from paraview import servermanager
from paraview.simple import *

with a_server.started(1, os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "LightRigOnServer.log")) as (port, server):
    Connect("localhost", port)
    LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
    rig = LightRig(PointLights=[1, 2, 3, 4, 5, 6])
    rig.UpdatePipeline()
    assert rig.GetDataInformation().GetNumberOfPoints() == 2
    lights = servermanager.Fetch(rig)
    assert lights.GetPoint(1) == (1, 2, 3)
    assert servermanager.ActiveConnection.IsRemote()
    assert server.poll() is None
