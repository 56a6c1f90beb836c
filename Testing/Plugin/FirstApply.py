"""In ParaView's window the first Apply of a solver shows light: of the default sky, as Lit Volume, in the one view there is.

    python3 FirstApply.py paraview [arguments...]    on an X display
"""
import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

folder = os.environ["TYNDALL_TEST_OUTPUT"]
session = os.path.join(os.path.dirname(os.path.abspath(__file__)), "FirstApply.xml")


class State:
    """What ParaView saved."""

    def __init__(self, name):
        self.proxies = list(ElementTree.parse(os.path.join(folder, name)).iter("Proxy"))

    def all(self, **attributes):
        return [proxy for proxy in self.proxies if all(proxy.get(key) == value for key, value in attributes.items())]

    def one(self, **attributes):
        found = self.all(**attributes)
        assert len(found) == 1, (attributes, found)
        return found[0]


def values(proxy, name):
    """Numbers, texts or the proxies of a property."""
    prop = next(each for each in proxy.findall("Property") if each.get("name") == name)
    return [each.get("value") for each in prop if each.tag in ("Element", "Proxy")]


for name in ("FirstApply.pvsm", "SecondApply.pvsm"):
    if os.path.exists(os.path.join(folder, name)):
        os.remove(os.path.join(folder, name))
subprocess.run(sys.argv[1:] + ["--exit", "--test-script=" + session], check=True)

first = State("FirstApply.pvsm")
solver = first.one(type="LightPropagationMaps")
assert values(solver, "Lights") == [], values(solver, "Lights")
views = [proxy.get("type") for proxy in first.all(group="views")]
assert views == ["RenderView"], views

shown = [proxy for proxy in first.all(group="representations", type="UniformGridRepresentation")
         if values(proxy, "Input") == [solver.get("id")]]
assert len(shown) == 1 and values(shown[0], "Visibility") == ["1"], shown
assert values(shown[0], "Representation") == ["Lit Volume"], values(shown[0], "Representation")
assert "fluence" not in values(shown[0], "ColorArrayName"), values(shown[0], "ColorArrayName")  # no bar of colours

second = State("SecondApply.pvsm")
assert values(second.one(type="LightPropagationMaps"), "Lights") == [second.one(type="LightRig").get("id")]
