"""A picture's camera is taken from a 3D view by its button, and follows it where it is asked to; its exposure can stay that of the first picture."""
import os

from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())

solver = LightPropagationMaps(Input=ParticipatingMedium(Input=Wavelet(WholeExtent=[0, 8, 0, 8, 0, 8])), MaximumOrders=1)
view = CreateRenderView()
Show(solver, view)
view.CameraPosition, view.CameraFocalPoint, view.CameraViewAngle = [1, 2, 40], [4, 4, 4], 20
caster = MediumRayCaster(Input=solver, ImageSize=[40, 30])
caster.InvokeCommand("TakeCamera")
assert list(caster.CameraPosition) == [1, 2, 40] and list(caster.CameraFocalPoint) == [4, 4, 4]
assert caster.CameraViewAngle == 20 and caster.CameraParallelProjection == 0

pictures = CreateView("PictureView")
assert pictures.OrientationAxesVisibility == 0
shown = Show(caster, pictures)
assert shown.Representation == "Slice" and shown.MapScalars == 0, (shown.Representation, shown.MapScalars)
SetActiveView(pictures)  # whose own camera is not taken
Render(pictures)
caster.InvokeCommand("TakeCamera")
assert list(caster.CameraPosition) == [1, 2, 40], list(caster.CameraPosition)

view.CameraPosition = [10, 2, 40]
Render(view)
assert list(caster.CameraPosition) == [1, 2, 40], "it does not follow unless it is asked to"
caster.FollowCamera = 1
view.CameraParallelProjection, view.CameraParallelScale = 1, 7
Render(view)
assert list(caster.CameraPosition) == [10, 2, 40]
assert caster.CameraParallelProjection == 1 and caster.CameraParallelScale == 7
caster.FollowCamera = 0


def exposure():
    caster.UpdatePipeline()
    caster.SMProxy.UpdatePropertyInformation()
    return caster.UsedExposure


def brighter():
    solver.SkyColor = [2 * each + 1 for each in solver.SkyColor]


caster.AutoExposure = "First Picture"
first = exposure()
assert first > 0
brighter()
assert exposure() == first, (first, exposure())
caster.AutoExposure = "Each Picture"
assert exposure() != first
brighter()
caster.AutoExposure = "First Picture"
again = exposure()
assert again != first
caster.Exposure = 0.5
assert exposure() == 0.5
