"""A whole chain on a server: the client gets the light that it would compute itself.

    pvpython ChainOnServer.py RANKS [MODULE]    the module that makes the chain; whole_chain if it is not said
"""
import importlib
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import a_server
import numpy
from paraview import servermanager
from paraview.simple import *

ranks = int(sys.argv[1])
name = sys.argv[2] if len(sys.argv) > 2 else "whole_chain"
chain = importlib.import_module(name)
file = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "ChainOnServer%d%s" % (ranks, name))

sky = file + ".hdr"
chain.write_sky(sky)
expected = chain.values(*chain.solve_and_render(sky))

with a_server.started(ranks, file + ".log") as (port, _):
    Connect("localhost", port)
    assert servermanager.ActiveConnection.IsRemote()
    assert servermanager.ActiveConnection.GetNumberOfDataPartitions() == ranks
    found = chain.values(*chain.solve_and_render(sky))
    assert found.keys() == expected.keys()
    for name, value in found.items():
        assert numpy.shape(value) == numpy.shape(expected[name]), name
        # A picture of several ranks is put together of those of their pieces, and solvers solve pieces; photons' light is the same.
        rounded = ["radiance"] + (["fluence", "balance"] if chain.__name__ == "whole_chain" else [])
        tolerance = 1e-6 * numpy.max(numpy.abs(expected[name])) if name in rounded and ranks > 1 else 0
        apart = numpy.max(numpy.abs(numpy.subtract(value, expected[name])))
        assert apart <= tolerance, (name, apart, value, expected[name])
