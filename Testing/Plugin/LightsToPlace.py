"""Sun, PointLight, SpotLight and RectangleLight begin where the data are, are put together by a LightGroup, light a solver by themselves, and come back from a state."""
import os

from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def array(source, name, port=0):
    source.UpdatePipeline()
    data = source.GetClientSideObject().GetOutputDataObject(port)
    return vtk_to_numpy(data.GetPointData().GetArray(name)).tolist()


alone = Sun(registrationName="Alone")  # nothing is there yet
assert list(alone.Position) == [-0.5, -0.5, 0.7071] and list(alone.FocalPoint) == [0, 0, 0]
picture = Wavelet(WholeExtent=[0, 1000, 0, 1000, 0, 0])
picture.UpdatePipeline()
assert list(PointLight().ShapeSize for _ in "1") == [0.02], "a picture is not the scene"

wavelet = Wavelet(WholeExtent=[0, 10, 0, 10, 0, 10])  # the box from 0 to 10, 17.3 from corner to corner
wavelet.UpdatePipeline()
sun, lamp, panel = Sun(), PointLight(), RectangleLight()
spot = SpotLight(FocalPoint=[1, 2, 3])
assert list(sun.FocalPoint) == [5, 5, 5] and list(sun.Position) == [-3.7, -3.7, 17.2], list(sun.Position)
assert list(lamp.Position) == [5, 5, 17.1] and list(lamp.Power) == [1900] * 3, list(lamp.Power)
assert list(spot.FocalPoint) == [1, 2, 3], "what a script says stays"
assert list(panel.Size) == [4.3, 4.3], list(panel.Size)

rig = LightRig()
assert array(rig, "light_type") == [0] and array(rig, "color", 1), "the rig's own sun is drawn"
group = LightGroup(registrationName="Group", Input=[rig, sun, lamp, spot, panel])
assert array(group, "light_type") == [0, 0, 1, 2, 3]
assert array(group, "power")[2] == [1900] * 3
lamp.Power = [1, 2, 3]
assert array(group, "power")[2] == [1, 2, 3]
assert array(lamp, "color", 1)[0][2] == 255, "its own colour"
group.Input = [lamp, panel]
assert array(group, "light_type") == [1, 3]

SetActiveSource(wavelet)
medium = ParticipatingMedium(Input=wavelet)
solver = LightPropagationMaps(Input=medium, Lights=lamp, MaximumOrders=1)
solver.UpdatePipeline()
assert "fluence" in solver.CellData.keys() and solver.CellData["fluence"].GetRange(0)[1] > 0

view = CreateRenderView()
view.CameraPosition, view.CameraFocalPoint = [1, 2, 30], [1, 1, 1]
sun.InvokeCommand("TakeCamera")
assert list(sun.Position) == [1, 2, 30] and list(sun.FocalPoint) == [1, 1, 1], list(sun.Position)
panel.InvokeCommand("TakeCamera")
assert list(panel.Position) == [1, 2, 30] and list(panel.Direction) == [0, -1, -29], list(panel.Direction)

state = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "LightsToPlace.pvsm")
SaveState(state)
ResetSession()
LoadState(state)
assert array(FindSource("Group"), "light_type") == [1, 3]
assert list(FindSource("Alone").Position) == [-0.5, -0.5, 0.7071]
