"""The photons' chain as ParaView writes it down: a Python trace runs again, states in both formats load, with the same light."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import glass_chain

import numpy
from paraview import servermanager, smstate, smtrace
from paraview.simple import *

file = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "GlassFromTraceAndState")
glass_chain.write_sky(file + ".hdr")


def proxy(kind):
    found = [each for each in GetSources().values() if each.GetXMLName() == kind]
    assert len(found) == 1, (kind, GetSources())
    return found[0]


def check(expected, how):
    light, picture = proxy("PhotonMarcher"), proxy("MediumRayCaster")
    picture.UpdatePipeline()
    light.UpdatePipeline()
    for name, value in glass_chain.values(light, picture).items():
        assert numpy.all(value == expected[name]), "%s of %s is not the same" % (name, how)


def forget():
    for each in list(GetSources().values())[::-1]:
        Delete(each)
    del each
    assert not GetSources()


smtrace.start_trace()
light, picture = glass_chain.solve_and_render(file + ".hdr")
trace = smtrace.stop_trace()
expected = glass_chain.values(light, picture)
for setting in ("MeshVoxelizer(", "RefractionOctree(", "PhotonEmitter(", "PhotonMarcher(", "MediumRayCaster(", "'Halton'",
                "TableColor"):
    assert setting in trace, (setting, trace)

SaveState(file + ".pvsm")
in_python = smstate.get_state()
del light, picture
forget()
exec(trace, {})
check(expected, "the trace")

forget()
LoadState(file + ".pvsm")
check(expected, "the state")

forget()
names = {}  # it expects the plugin to be there
LoadPlugin(os.environ["TYNDALL_PLUGIN"], ns=names)
exec(in_python, names)
check(expected, "the state in Python")
