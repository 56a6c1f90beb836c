"""In ParaView's window a page is played (tutorial.py), up to one of its pictures; which is as the window then looks.

    python3 PlayedPage.py PAGE PICTURE paraview [arguments...]    on an X display of its own

`./run baselines` takes the page's pictures anew.
"""
import os
import subprocess
import sys
import time

import numpy

import pictures
import tutorial
from saved_state import State, folder, forget, values
from screen import Screen

PATIENCE = 300  # seconds after which something hangs, on the slowest machine
WIDTH, HEIGHT = 1152, 728  # of the window where it is tested, without the status bar and its figures
STATUS_BAR = 34
IMAGES = os.path.join(os.environ["TYNDALL_SOURCE"], "Plugin/Documentation/images")

page, picture = sys.argv[1:3]
output = os.path.join(folder, picture)
player = tutorial.Player()
for step in tutorial.steps_to(page, picture):
    player.play(step)
player.save_state(output + ".pvsm")
player.write(output + ".xml")
print("%d clicks" % player.clicks)
if picture == "start-lit":
    assert player.clicks <= 8, "the page promises eight clicks"


def wait_for_the_end():
    end, text = time.monotonic() + PATIENCE, ""
    while "Success =  true" not in text:
        assert time.monotonic() < end, "not played within %g s" % PATIENCE
        assert paraview.poll() is None, "ParaView has gone"
        assert "Success =  false" not in text and "Couldn't find object" not in text, text
        time.sleep(0.1)
        with open(output + ".log", errors="replace") as said:
            text = said.read()


def window():
    """The window's pixels, when they no longer change."""
    last, pixels, same = None, None, 0
    while same < 3:
        last, pixels = pixels, screen.pixels(0, 0, WIDTH, HEIGHT)
        same = same + 1 if pixels == last else 0
        time.sleep(0.5)
    rows = numpy.frombuffer(pixels, numpy.uint8).reshape(HEIGHT, WIDTH, 4)[::-1, :, 2::-1]  # bottom row first
    return rows.astype(int)


def repaint():
    """Resize the window and back. At times Qt leaves black lines at a view that grew while its kernels were compiled."""
    for height in (HEIGHT, HEIGHT + STATUS_BAR):
        size = ["windowsize", str(WIDTH), str(height)]
        subprocess.run(["xdotool", "search", "--name", "^ParaView"] + size, check=True)
        time.sleep(1)


def open_menu():
    """Filters, Light Transport, by hand: the order of its entries and their icons are then part of the picture."""
    subprocess.run(["xdotool", "mousemove", "216", "11", "click", "1"], check=True)
    time.sleep(1)
    subprocess.run(["xdotool", "key", "l"], check=True)


forget(picture + ".pvsm")
with open(output + ".log", "w") as log:
    paraview = subprocess.Popen(sys.argv[3:] + ["--test-script=%s.xml" % output], stdout=log, stderr=subprocess.STDOUT)
try:
    wait_for_the_end()
    screen = Screen()
    repaint()
    if picture == "start-menu":
        open_menu()
    seen = window()
finally:
    paraview.kill()
    paraview.wait()

state = State(picture + ".pvsm")


def is_lit():
    """The last solver's light is seen as Lit Volume, and is bright."""
    medium, solver = state.one(type="ParticipatingMedium"), state.one(type="LightPropagationMaps")
    assert values(solver, "Input") == [medium.get("id")]
    representations = state.all(group="representations", type="UniformGridRepresentation")
    lit = [proxy for proxy in representations if values(proxy, "Input") == [solver.get("id")]]
    assert ["1"] in [values(proxy, "Visibility") for proxy in lit], "the light is seen"
    assert all(values(proxy, "Representation") == ["Lit Volume"] for proxy in lit)
    bright = (seen[:, 310:1140].min(axis=2) > 110).mean()
    assert bright > 0.02, "no lit cloud: %.3f of the view is bright" % bright


def is_water():
    is_lit()
    medium, solver = state.one(type="ParticipatingMedium"), state.one(type="LightPropagationMaps")
    assert values(medium, "Preset") == ["1"] and values(medium, "LengthUnit") == ["4"]
    assert values(solver, "Preview") == ["1"]


def has_a_picture():
    is_lit()
    assert values(state.one(type="MediumRayCaster"), "Input") == [state.one(type="LightPropagationMaps").get("id")]
    assert len(state.all(type="PictureView")) == 1, "a view of its own"


def has_its_sun():
    is_water()
    assert values(state.one(type="LightPropagationMaps"), "Lights") == [state.one(type="LightRig").get("id")]


def is_sliced():
    solver = state.one(type="LightPropagationMaps").get("id")
    assert values(state.one(type="Cut"), "Input") == [solver] == values(state.one(type="ProbeLine"), "Input")
    assert len(state.all(type="XYChartView")) == 1, "a curve"


def is_glass():
    marcher = state.one(type="PhotonMarcher")
    assert values(marcher, "Input") == [state.one(type="MeshVoxelizer").get("id")]
    assert values(marcher, "Photons") == [state.one(type="PhotonEmitter").get("id")]
    assert values(state.one(type="PhotonEmitter"), "Lights") == [state.one(type="LightRig").get("id")]


{
    "start-lit": is_lit, "start-menu": is_lit, "start-picture": has_a_picture, "start-water": is_water,
    "guide-sun": has_its_sun, "guide-light": is_sliced, "guide-glass": is_glass,
}[picture]()
wrong = pictures.compare(picture, seen, folder=IMAGES)
assert not wrong or tutorial.PARAVIEW != tutorial.PICTURED, wrong
