"""A proxy's panel begins with what its filter has by default: where XML and class say it apart, they say the same.

The class's own defaults are read off a fresh instance's PrintSelf: a line "Name: value", or "Name: (a, b, c)"."""
import glob
import os
import re
import xml.etree.ElementTree as ElementTree

from paraview import servermanager
from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=False, ns=globals())

NUMBERS = ("IntVectorProperty", "DoubleVectorProperty", "IdTypeVectorProperty")


def printed(filter_):
    """{name: [numbers]} of what a VTK object prints of itself."""
    lines = {}
    for line in str(filter_).splitlines():
        name, colon, text = line.strip().partition(":")
        words = re.sub(r"[(),]", " ", text).split()
        try:
            lines[name] = [float(word) for word in words]
        except ValueError:
            pass
    return lines


faults, compared = [], 0
for path in sorted(glob.glob(os.path.join(os.environ["TYNDALL_SOURCE"], "Plugin", "ServerManager", "*.xml"))):
    groups = ElementTree.parse(path).getroot().findall("ProxyGroup")
    for group, proxy in ((g.get("name"), p) for g in groups for p in g if p.get("class") and p.get("name")):
        if group not in ("sources", "filters"):  # readers, writers and representations
            continue
        made = servermanager.ProxyManager().NewProxy(group, proxy.get("name"))
        made.UpdateVTKObjects()
        own = printed(made.GetClientSideObject().NewInstance())
        for prop in (p for p in proxy if p.tag in NUMBERS and not p.get("information_only")):
            values, name = prop.get("default_values"), prop.get("name")
            if values is None or values == "none" or name not in own:
                continue
            compared += 1
            if [float(word) for word in values.split()] != own[name]:
                faults.append("%s.%s: the panel begins with %s, the class with %s" %
                              (proxy.get("name"), name, values, own[name]))

assert compared > 100, "only %d properties were compared" % compared
assert not faults, "\n" + "\n".join(faults)
print("%d defaults are those of their filters" % compared)
