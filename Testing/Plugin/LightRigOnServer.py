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
    Wavelet(WholeExtent=[0, 10, 0, 10, 0, 10]).UpdatePipeline()
    assert list(Sun().FocalPoint) == [0, 0, 0], "the client does not have the plugin"
    LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=False, ns=globals())
    sun = Sun()
    assert list(sun.FocalPoint) == [5, 5, 5], "it has, and the scene is the server's"
    group = LightGroup(Input=[rig, sun])
    group.UpdatePipeline()
    assert servermanager.Fetch(group).GetNumberOfPoints() == 3
    view = CreateRenderView()
    view.CameraPosition = [1, 2, 30]
    sun.InvokeCommand("TakeCamera")
    assert list(sun.Position) == [1, 2, 30], list(sun.Position)
    Show(OutputPort(sun, 1), view)
    Render(view)
    assert server.poll() is None
