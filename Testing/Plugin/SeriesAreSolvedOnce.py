"""Each step of a series of .vti or .vdb is solved once, though ParaView's readers read it twice: for UpdatePipeline, which
asks for no time, and for Show, which asks for that of the view.
"""
import os

from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
folder = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "series")
os.makedirs(folder, exist_ok=True)


def write(extension):
    files = []
    for step in range(3):
        medium = ParticipatingMedium(Input=Wavelet(WholeExtent=[0, 6] * 3, XFreq=10 + step))
        files.append(os.path.join(folder, "medium_%d.%s" % (step, extension)))
        SaveData(files[-1], proxy=medium)
    return files


for extension in ("vti", "vdb"):
    light = LightPropagationMaps(Input=OpenDataFile(write(extension)), DirectionsPerFace=4)
    solver = light.GetClientSideObject()
    runs = [0]
    reports = []  # of progress, of a run

    def begin(caller, event):
        reports.clear()

    def report(caller, event):
        if 0.0 < caller.GetProgress() < 1.0:
            runs[0] += not reports
            reports.append(caller.GetProgress())

    solver.AddObserver("StartEvent", begin)
    solver.AddObserver("ProgressEvent", report)
    scene = GetAnimationScene()
    scene.AnimationTime = 0.0
    light.UpdatePipeline()
    view = CreateRenderView(ViewSize=[60, 60])
    Show(light, view)
    Render(view)
    assert runs[0] == 1, (extension, runs)
    scene.UpdateAnimationUsingDataTimeSteps()
    for time in (1.0, 2.0):
        scene.AnimationTime = time
        light.UpdatePipeline(time)
        Render(view)
    assert runs[0] == 3, (extension, runs)
    light.SkyColor = [2, 2, 2]  # other light is solved
    light.UpdatePipeline(2.0)
    assert runs[0] == 4, (extension, runs)
    Delete(view)
    Delete(light)
