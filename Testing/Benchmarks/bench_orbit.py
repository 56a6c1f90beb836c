"""Frames while the camera goes round a volume in ParaView's window.

    ./run bench orbit [--grid 128] [--frames 20] [--rounds 3] [--size 800 600] [--quick]

The volume is shown as Lit Volume, as ParaView's own Volume of one colour, and by that with its scattering option (shaded, scattering
blended by 1, `--reach` of its shadows, 0 to 1), in turns, in one run; as Volume with the solver's LitColor too. ParaView's window is
opened, and the mouse dragged over the 3D view: the events go to the view's interactor, which draws a frame for each of them as it does
for a hand's. `seconds` (moving) and `still` are seconds a frame, medians and longest of all rounds; still frames are drawn with the full resolution after the mouse is let go, with the
camera turned between them. The first frames of a turn are not counted: they take the data to the mapper and find the resolution for the
frame time. What took 30 seconds is not drawn again.

Last row: the largest difference between a pixel of Lit Volume, as the window has it, and of Medium Ray Caster with the same camera.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import time
import traceback

WINDOW = "TYNDALL_BENCH_ORBIT" # for the part that runs in ParaView's window: its arguments, as JSON
GOAL_MOVING, GOAL_STILL, GOAL_DIFFERENCE = 0.05, 0.12, 1
PATIENCE = 30 # seconds, after which no more frames of one way are drawn
here = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() else None


def report(**values):
    print(json.dumps({"bench": "orbit", **values}), flush=True)


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--grid", type=int)
    parser.add_argument("--frames", type=int)
    parser.add_argument("--rounds", type=int)
    parser.add_argument("--size", type=int, nargs=2, metavar=("WIDTH", "HEIGHT"), help="of the view in pixels")
    parser.add_argument("--reach", type=float, default=0.0, help="of the scattering option: 0, as ParaView has it at first, to 1")
    parser.add_argument("--picture", help="of the window, a file NAME.png: NAME-METHOD.png")
    parser.add_argument("--quick", action="store_true", default="TYNDALL_BENCH_QUICK" in os.environ)
    given = parser.parse_args()
    quick = given.quick
    return {"grid": given.grid or (16 if quick else 128), "frames": given.frames or (3 if quick else 20), "picture": given.picture,
            "reach": given.reach, "rounds": given.rounds or (1 if quick else 3), "size": given.size or ([200, 150] if quick else [800, 600])}


def open_window(arguments):
    """@return its exit status"""
    plugin = os.environ["TYNDALL_PLUGIN"]
    environment = {**os.environ, WINDOW: json.dumps({**arguments, "here": here}), "TYNDALL_PREPARE": "0"}
    command = ["paraview", "--dr", "--plugin-search-paths=" + os.path.dirname(plugin), "--plugins=Tyndall",
               "--script=" + os.path.abspath(__file__)]
    read, write = os.pipe()
    environment["TYNDALL_BENCH_OUTPUT"] = str(write) # ParaView's window shows what Python prints in its own console
    window = subprocess.Popen(command, env=environment, pass_fds=[write])
    os.close(write)
    with os.fdopen(read) as lines:
        for line in lines:
            print(line, end="", flush=True)
    return window.wait()


class Window:
    """The view of ParaView's window, and a solved medium in it."""

    def __init__(self, grid, frames, rounds, size, reach, picture, here):
        global simple, lit_view
        os.environ.setdefault("TYNDALL_SOURCE", os.path.dirname(os.path.dirname(here)))
        sys.path.insert(0, os.path.join(here, "../Plugin"))
        import lit_view
        from paraview import simple
        self.edge = float(grid)
        self.grid, self.frames, self.rounds, self.reach, self.picture = "%dx%dx%d" % ((grid,) * 3), frames, rounds, reach, picture
        half = grid // 2
        medium = simple.ParticipatingMedium(Input=simple.Wavelet(WholeExtent=[-half, half] * 3), MinimumDensity=37, MaximumDensity=277,
                                            ExtinctionScale=2.56 / grid)
        self.light = simple.LightPropagationMaps(Input=medium, Lights=simple.LightRig(), LitColor=1, Exposure=lit_view.EXPOSURE)
        self.view = view = simple.GetActiveViewOrCreate("RenderView")
        simple.GetLayout().SetSize(*size)
        lit_view.show_nothing_else(view)
        self.look()
        simple.Render(view)
        assert list(view.ViewSize) == list(size), ("the screen is too small for this view", list(view.ViewSize))
        self.shown = simple.Show(self.light, view)

    def look(self):
        self.view.CenterOfRotation = self.view.CameraFocalPoint = [0, 0, 0]
        self.view.CameraPosition = [0.55 * self.edge, -2.5 * self.edge, 1.25 * self.edge]
        self.view.CameraViewUp = [0, 0, 1]

    def lit_volume(self):
        self.shown.Representation = "Lit Volume"
        self.shown.Exposure = lit_view.EXPOSURE

    def volume(self, array):
        self.shown.Representation = "Volume"
        simple.ColorBy(self.shown, ("CELLS", array))
        self.shown.Shade = 0
        self.shown.VolumetricScatteringBlending = 0
        self.shown.GlobalIlluminationReach = 0

    def one_color(self):
        self.volume("sigma_s")
        low, high = self.light.CellData["sigma_s"].GetRange(0)
        high = max(high, low + 1e-9)
        self.shown.LookupTable.RGBPoints = [low, 0.9, 0.9, 0.9, high, 0.9, 0.9, 0.9]
        self.shown.ScalarOpacityFunction.Points = [low, 0, 0.5, 0, high, 1, 0.5, 0]
        self.shown.ScalarOpacityUnitDistance = 20

    def scattering(self):
        self.one_color()
        self.shown.Shade = 1
        self.shown.VolumetricScatteringBlending = 1
        self.shown.GlobalIlluminationReach = self.reach

    def lit_color(self):
        self.volume("lit_color")

    def ways(self):
        return {"Lit Volume": self.lit_volume, "Volume of one colour": self.one_color, "Volume with scattering": self.scattering,
                "Volume of lit_color": self.lit_color}

    def moving(self):
        """Drag the mouse. @return seconds of each frame"""
        interactor = self.view.GetInteractor()
        drawn = [0]
        watch = self.view.GetRenderWindow().AddObserver("EndEvent", lambda *_: drawn.__setitem__(0, drawn[0] + 1))
        x, y = (length // 2 for length in self.view.ViewSize)
        interactor.SetEventInformation(x, y)
        interactor.InvokeEvent("LeftButtonPressEvent")
        seconds = []
        for i in range(1, self.frames + 4):
            if sum(seconds) > PATIENCE:
                break
            interactor.SetEventInformation(x + 4 * i, y)
            begin = time.perf_counter()
            interactor.InvokeEvent("MouseMoveEvent")
            seconds.append(time.perf_counter() - begin)
            assert drawn[0] >= i, "a move of the mouse drew no frame"
        interactor.InvokeEvent("LeftButtonReleaseEvent")
        self.view.GetRenderWindow().RemoveObserver(watch)
        return seconds[3:] or seconds[-1:]

    def still(self):
        seconds = []
        while len(seconds) < 1 + max(self.frames // 3, 2) and sum(seconds) < PATIENCE:
            simple.GetActiveCamera().Azimuth(5)
            begin = time.perf_counter()
            self.view.SMProxy.StillRender()
            seconds.append(time.perf_counter() - begin)
        return seconds[1:] or seconds

    def save(self, way):
        if self.picture:
            name, extension = os.path.splitext(self.picture)
            simple.SaveScreenshot("%s-%s%s" % (name, way.replace(" ", "-"), extension), self.view)

    def compare_ways(self):
        times = {}
        for turn in range(self.rounds):
            for way, choose in self.ways().items():
                self.look()
                choose()
                if turn == 0:
                    self.save(way)
                moving, still = times.setdefault(way, ([], []))
                moving += self.moving()
                still += self.still()
        ours = [statistics.median(of_one) for of_one in times["Lit Volume"]]
        for way, (moving, still) in times.items():
            row = {"ratio_moving": statistics.median(moving) / ours[0], "ratio_still": statistics.median(still) / ours[1]}
            if way == "Lit Volume":
                row = {"goal_moving": GOAL_MOVING, "goal_still": GOAL_STILL, "met": ours[0] <= GOAL_MOVING and ours[1] <= GOAL_STILL}
            report(case="orbit", method=way, grid=self.grid, picture="%dx%d" % tuple(self.view.ViewSize),
                   seconds=statistics.median(moving), longest_moving=max(moving), frames_a_second=1 / statistics.median(moving),
                   still=statistics.median(still), longest_still=max(still), **row)

    def compare_with_caster(self):
        self.lit_volume()
        found = lit_view.drawn(self.view)
        begin = time.perf_counter()
        expected = lit_view.cast(self.light, self.view)
        difference = int(abs(found - expected).max())
        report(case="pixels", method="Lit Volume against Medium Ray Caster", grid=self.grid, seconds=time.perf_counter() - begin,
               largest_difference_of_255=difference, mean_of_255=float(expected.mean()), goal=GOAL_DIFFERENCE,
               met=difference <= GOAL_DIFFERENCE)


def in_window():
    """What ParaView runs: it has no way to end itself with a status after a script."""
    status = 1
    sys.stdout = os.fdopen(int(os.environ["TYNDALL_BENCH_OUTPUT"]), "w")
    try:
        window = Window(**json.loads(os.environ[WINDOW]))
        window.compare_ways()
        window.compare_with_caster()
        status = 0
    except Exception:
        sys.__stderr__.write(traceback.format_exc())
    sys.stdout.flush()
    sys.__stderr__.flush()
    os._exit(status)


if WINDOW in os.environ:
    in_window()
else:
    sys.exit(open_window(parse()))
