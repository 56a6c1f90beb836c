"""Lit Volume with a server that draws, in pieces where it has several ranks: the client's window shows what it would draw itself.

    pvpython LitVolumeOnServer.py RANKS
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import a_server
import lit_view
import numpy
import pictures
from paraview.simple import *

ranks = int(sys.argv[1])
output = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "LitVolumeOnServer%d" % ranks)
LARGEST = 1 if ranks == 1 else 2  # of 255: pieces are laid over each other in eight bits


def drawn_pictures():
    """@return what a window shows, by name"""
    view = lit_view.black_view()
    light = lit_view.solved()
    shown = lit_view.show_lit(light, view)
    found = {"": lit_view.drawn(view)}
    for side, place in (("Left", [-38, -12, 15]), ("Below", [5, 22, -34]), ("Within", [4, -6, 3])):
        view.CameraPosition = place
        found[side] = lit_view.drawn(view)
    lit_view.place_camera(view)
    view.CameraParallelProjection, view.CameraParallelScale = 1, 12
    found["Parallel"] = lit_view.drawn(view)
    view.CameraParallelProjection = 0
    shown.Exposure = 0
    found["Exposed"] = lit_view.drawn(view)
    shown.SingleScatteringOnly = 1
    found["ExposedAgain"] = lit_view.drawn(view)
    shown.SingleScatteringOnly = 0
    shown.ShowBackground, shown.BackgroundColor = 1, [0, 0.6, 0.2]
    found["Behind"] = lit_view.drawn(view)
    shown.ShowBackground, shown.Exposure = 0, lit_view.EXPOSURE
    sphere = Show(Sphere(Center=[2, -5, 1], Radius=5, ThetaResolution=64, PhiResolution=64), view)
    sphere.Ambient, sphere.Diffuse, sphere.AmbientColor = 1, 0, [0, 0, 1]
    found["WithSphere"] = lit_view.drawn(view)
    return found


def check(name, found, expected):
    assert found.shape == expected.shape, (name, found.shape, expected.shape)
    assert expected.max() > 100 and found.std() > 5, name + ": there is nothing to compare"
    apart = numpy.abs(found.astype(int) - expected).max(axis=2)
    counts = (apart <= LARGEST).mean()
    print(name or "Front", "largest difference", apart.max(), "sum", found.sum() / expected.sum(), "equal", counts)
    # A sphere that is divided among ranks has other pixels at its edges.
    return counts > 0.99 if name == "WithSphere" else apart.max() <= LARGEST


lit_view.load(remote=False)
expected = drawn_pictures()
with a_server.started(ranks, output + ".log") as (port, _):
    Connect("localhost", port)
    lit_view.load(remote=True)
    found = drawn_pictures()
for name, pixels in found.items():
    apart = numpy.minimum(numpy.abs(pixels.astype(int) - expected[name]) * 20, 255).astype(pixels.dtype)
    pictures.write(output + name + ".png", numpy.concatenate([pixels, expected[name], apart], axis=1))
wrong = [name or "Front" for name, pixels in found.items() if not check(name, pixels, expected[name])]
assert not wrong, wrong
