"""Lit Volume with a server that draws: the client's window shows what it would draw itself.

    pvpython LitVolumeOnServer.py RANKS
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import a_server
import lit_view
import numpy
import pictures
from paraview import servermanager
from paraview.simple import *

ranks = int(sys.argv[1])
output = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "LitVolumeOnServer%d" % ranks)
lit_view.load(remote=False)
view = lit_view.black_view()
expected = lit_view.cast(lit_view.solved(), view)

with a_server.started(ranks, output + ".log") as (port, _):
    Connect("localhost", port)
    lit_view.load(remote=True)
    view = lit_view.black_view()
    light = lit_view.solved()
    shown = lit_view.show_lit(light, view)
    found = lit_view.drawn(view)
    pictures.write(output + ".png", numpy.concatenate([found, expected], axis=1))
    if ranks == 1:
        lit_view.check_same(found, expected)
    else:  # thin parts are darker (limits.md), and there is no seam
        assert 0.5 < found.sum() / expected.sum() < 1, found.sum() / expected.sum()
        shown.Exposure = 0
        chosen = lit_view.drawn(view)
        pictures.write(output + "Exposed.png", chosen)
        for pixels in (found, chosen):
            column = pixels[40:115, 110].mean(axis=1)
            assert column.min() > 20 and numpy.abs(numpy.diff(column)).max() < 6, "there is a seam, or no medium"
