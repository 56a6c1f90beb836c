"""Each step of a series of .vti or .vdb is solved once, though ParaView's readers read it twice: for UpdatePipeline, which
asks for no time, and for Show, which asks for that of the view. So it is as a surface and as Lit Volume, and where an
animation of it is saved.
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


def count_runs(light):
    """@return a list with the number of times that it solves, which goes on counting"""
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
    return runs


def steps_one_by_one(series, representation, case):
    light = LightPropagationMaps(Input=series, DirectionsPerFace=4)
    runs = count_runs(light)
    scene = GetAnimationScene()
    scene.AnimationTime = GetTimeKeeper().Time = 0.0
    light.UpdatePipeline()
    view = CreateRenderView(ViewSize=[60, 60])
    Show(light, view, "UniformGridRepresentation").Representation = representation
    Render(view)
    assert runs[0] == 1, (case, runs)
    scene.UpdateAnimationUsingDataTimeSteps()
    for time in (1.0, 2.0):
        scene.AnimationTime = time
        light.UpdatePipeline(time)
        Render(view)
    assert runs[0] == 3, (case, runs)
    view.CameraPosition = [9, 8, 7]  # a look at the same light
    Render(view)
    assert runs[0] == 3, (case, runs)
    light.SkyColor = [2, 2, 2]  # other light is solved
    light.UpdatePipeline(2.0)
    assert runs[0] == 4, (case, runs)
    Delete(view)
    Delete(light)


def an_animation(series, representation, case):
    light = LightPropagationMaps(Input=series, DirectionsPerFace=4)
    runs = count_runs(light)
    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.AnimationTime = GetTimeKeeper().Time = 0.0
    view = CreateRenderView(ViewSize=[60, 60])
    Show(light, view, "UniformGridRepresentation").Representation = representation
    SaveAnimation(os.path.join(folder, "animation.png"), view, ImageResolution=[60, 60], FrameWindow=[0, 2])
    assert runs[0] == 3, (case, runs)
    Delete(view)
    Delete(light)


for extension in ("vti", "vdb"):
    files = write(extension)
    for representation in ("Surface", "Lit Volume"):
        for play in (steps_one_by_one, an_animation):
            series = OpenDataFile(files)
            play(series, representation, (extension, representation, play.__name__))
            Delete(series)
