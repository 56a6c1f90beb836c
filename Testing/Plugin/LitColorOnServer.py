"""A solver's lit_color in ParaView's representation Volume, from a server: as the client shows it by itself.

    pvpython LitColorOnServer.py RANKS
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
output = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "LitColorOnServer%d" % ranks)
ANYTHING = 1e6  # MB: the server draws nothing
MOST = 1 if ranks == 1 else 10  # of 255; measured 0 and 7: ranks round their pieces' pictures before they are put together


def shown():
    """@return a view of the light, and it"""
    view = lit_view.black_view()
    light = lit_view.solved()
    light.LitColor = 1
    light.Exposure = lit_view.EXPOSURE
    volume = Show(light, view)
    assert volume.Representation == "Volume" and volume.ColorArrayName[:] == ["CELLS", "lit_color"]
    return view, light


lit_view.load(remote=False)
expected = lit_view.drawn(shown()[0])
assert expected.max() > 100 and expected.std() > 10, "there is nothing to compare"

with a_server.started(ranks, output + ".log") as (port, _):
    Connect("localhost", port)
    lit_view.load(remote=True)
    view, light = shown()
    by_server = lit_view.drawn(view)
    view.RemoteRenderThreshold = ANYTHING
    by_client = lit_view.drawn(view)
    pictures.write(output + ".png", numpy.concatenate([by_server, by_client, expected], axis=1))
    for name, found in (("server", by_server), ("client", by_client)):
        difference = numpy.abs(found - expected)
        print("drawn by the %s: at most %d, in the mean %.3f of 255" % (name, difference.max(), difference.mean()), flush=True)
        assert difference.max() <= MOST, (name, difference.max())
