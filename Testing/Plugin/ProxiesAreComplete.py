"""Every property of every proxy: documented, bounded, reachable in Python by its XML name, and its results on the panel."""
import glob
import os
import re
import xml.etree.ElementTree as ElementTree

from paraview import servermanager
from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())

faults = []


def words(element):
    return " ".join((element.text or "").split()) if element is not None else ""


def is_array_chooser(prop):
    return prop.find("ArrayListDomain") is not None


def is_internal(prop):
    """What other properties and ParaView itself read, and a user does not."""
    return prop.find("TimeStepsInformationHelper") is not None or prop.get("name").endswith("Info")


# What a real number may be measured in; as the documentation says it.
UNITS = re.compile(r"length|\bW\b|degree|[Vv]oxel|pixel|[Mm]illimet|, s\b|bytes|[Nn]o unit|unit of|[Nn]umber of")


def numbers(text):
    return [float(word) for word in (text or "").split()]


def faults_of_number(prop):
    """A number's unit, range and default: in the documentation what ParaView's help does not make of the domain."""
    text = words(prop.find("Documentation"))
    if prop.tag == "DoubleVectorProperty" and not is_internal(prop) and not UNITS.search(text):
        yield "its documentation does not say its unit"
    domain = next((child for child in prop if child.tag in ("DoubleRangeDomain", "IntRangeDomain")), None)
    if domain is None or prop.get("information_only") or prop.get("default_values") is None:
        return
    count = int(prop.get("number_of_elements", 1))
    default, low, high = numbers(prop.get("default_values")), numbers(domain.get("min")), numbers(domain.get("max"))
    if len(default) != count:
        yield "%d defaults for %d numbers" % (len(default), count)
    for bound, name in ((low, "min"), (high, "max")):
        if bound and len(bound) != count:
            yield "%d numbers in %s for %d" % (len(bound), name, count)
    if any(d < l for d, l in zip(default, low)) or any(d > h for d, h in zip(default, high)):
        yield "its default is not in its range"


def faults_of_choice(prop):
    """An enumeration's entries: with texts, and the default among them."""
    domain = prop.find("EnumerationDomain")
    if domain is None:
        return
    values = [entry.get("value") for entry in domain.findall("Entry")]
    if prop.get("default_values") not in values:
        yield "its default is none of its choices"
    if len(set(values)) < len(values) or any(not entry.get("text") for entry in domain.findall("Entry")):
        yield "choices that are the same or have no text"


def faults_of_groups(proxy):
    """Groups and decorators name what there is, and a property is in one group."""
    groups = proxy.findall("PropertyGroup")
    grouped = [each.get("name") for group in groups for each in group.findall("Property")]
    names = {child.get("name") for child in proxy if child.tag.endswith("Property")}
    exposed = {each.get("name") for each in proxy.findall("SubProxy/ExposedProperties/Property")}
    for name in grouped:
        if name not in names | exposed:
            yield "a group has '%s', which there is not" % name
        if grouped.count(name) > 1:
            yield "'%s' is in several groups" % name
    for widget in proxy.iter("PropertyWidgetDecorator"):
        if widget.get("property") not in names:
            yield "a decorator looks at '%s', which there is not" % widget.get("property")


# Proxies that compute: each shows its run time, and what the scene did not need.
COMPUTING = """ParticipatingMedium MeshVoxelizer RefractionOctree PhotonImportance PhotonEmitter PhotonMarcher
PhotonReconstruction LPMPropagate LPMCollect LightPropagationMaps DiscreteOrdinates LatticeBoltzmannLighting
MediumRayCaster SeparablePhaseFunction SolverComparison""".split()
# Those that could not compute what they leave out.
WITHOUT_SWITCH = "PhotonEmitter LPMCollect SeparablePhaseFunction SolverComparison".split()


def faults_of_runs(proxy):
    names = {child.get("name") for child in proxy if child.tag.endswith("Property")}
    if proxy.get("name") in COMPUTING and "Seconds" not in names:
        yield "it does not show its run time (Seconds)"
    if proxy.get("name") in COMPUTING and "LeftOut" not in names:
        yield "it does not show what it leaves out (LeftOut)"
    if proxy.get("name") in COMPUTING and ("LeaveOut" in names) == (proxy.get("name") in WITHOUT_SWITCH):
        yield "whether it has the switch LeaveOut differs from numerics.md, section 10, Omitted terms"


def faults_of_proxy(proxy):
    documentation = proxy.find("Documentation")
    if len(words(documentation)) < 40:
        yield "its documentation does not say what it does"
    for kind in ("short_help", "long_help"):
        if documentation is None or not documentation.get(kind):
            yield "no " + kind
    for port in proxy.findall("OutputPort"):
        if not port.get("name"):
            yield "an output port without name"
    yield from faults_of_groups(proxy)
    yield from faults_of_runs(proxy)
    hints = proxy.find("Hints")
    places = ("ShowInMenu", "ReaderFactory", "WriterFactory")
    if hints is None or not any(hints.find(place) is not None for place in places):
        yield "it is in no menu and opens no file"
    exposed = {each.get("name") for each in proxy.findall("SubProxy/ExposedProperties/Property")}
    shown = [prop.get("name") for prop in proxy.iter() if prop.get("information_only") and prop.get("panel_visibility")]
    if (shown or "GridSummary" in exposed) and (hints is None or hints.find("FreshResults") is None):
        yield "its results %s stay those of the first update" % shown


def faults_of_property(prop):
    name, label = prop.get("name"), prop.get("label", prop.get("name"))
    if len(words(prop.find("Documentation"))) < 10:
        yield "no documentation"
    if prop.tag == "IdTypeVectorProperty":
        yield "ParaView's panel does not show numbers of this kind"
    yield from faults_of_number(prop)
    yield from faults_of_choice(prop)
    if label.replace(" ", "") != name:
        yield "its label '%s' makes another name in Python" % label
    if prop.get("information_only"):
        if not is_internal(prop) and not (prop.get("panel_visibility") and prop.get("default_values") is not None):
            yield "a result that the panel does not show"
        return
    if prop.tag == "Property":  # a button
        return
    if prop.tag == "InputProperty":
        if prop.find("Hints/Optional") is not None and not prop.get("clean_command"):
            yield "it cannot be disconnected"
        return
    bounded = any(child.tag.endswith("Domain") for child in prop)
    free = prop.get("repeat_command") or name in ("Device", "FileName")
    if not bounded and not free:
        yield "no domain"
    if is_array_chooser(prop) and prop.get("default_values"):
        # Else ParaView chooses the active scalars, or the first array, where there is no array of the default's name.
        domain = prop.find("ArrayListDomain")
        if domain.get("none_string") != "(by name)" or domain.get("attribute_type") != "EdgeFlag":
            yield "where there is no array of its name, another one is chosen"
    if not prop.get("repeat_command") and not prop.find("FileListDomain") is not None:
        chosen = is_array_chooser(prop) or name == "FileName" or prop.tag == "ProxyProperty"
        if not chosen and prop.get("default_values") is None:
            yield "no default"


def check(file, group, proxy):
    name = proxy.get("name")
    internal = group.startswith(("internal", "views"))
    if not internal:
        faults.extend("%s: %s" % (name, fault) for fault in faults_of_proxy(proxy))
        if proxy.get("label", name).replace(" ", "") != name:
            faults.append("%s: its label makes another name in Python" % name)
            return
        reachable = dir(getattr(getattr(servermanager, group), name)())
    properties = [child for child in proxy if child.tag.endswith("Property")]
    for prop in properties:
        faults.extend("%s.%s: %s" % (name, prop.get("name"), fault) for fault in faults_of_property(prop))
    names = [prop.get("name") for prop in properties if not is_internal(prop)]
    names += [exposed.get("name") for exposed in proxy.findall("SubProxy/ExposedProperties/Property")
              if not exposed.get("name").endswith("Info")]
    if not internal:
        faults.extend("%s.%s: not reachable in Python" % (name, each) for each in names if each not in reachable)


def faults_of_menus(files):
    """Menu.xml has each proxy that is to be in a menu, and the plugin an icon of its own for each."""
    plugin = os.path.join(os.environ["TYNDALL_SOURCE"], "Plugin")
    listed = [proxy.get("name") for proxy in ElementTree.parse(os.path.join(plugin, "Menu/Menu.xml")).iter("Proxy")]
    icons = [file.text for file in ElementTree.parse(os.path.join(plugin, "Icons/Tyndall.qrc")).iter("file")]
    asked = {}
    for file in files:
        for proxy in ElementTree.parse(file).getroot().iterfind("ProxyGroup/SourceProxy"):
            if proxy.find("Hints/ShowInMenu") is not None:
                asked[proxy.get("name")] = os.path.basename(proxy.find("Hints/ShowInMenu").get("icon", "none"))
    if sorted(listed) != sorted(asked):
        yield "Menu.xml: it lists %s too much, and not %s" % (set(listed) - set(asked), set(asked) - set(listed))
    for name, icon in asked.items():
        if icon not in icons or not os.path.exists(os.path.join(plugin, "Icons", icon)):
            yield "%s: there is no icon %s" % (name, icon)
        if list(asked.values()).count(icon) > 1:
            yield "%s: others have its icon, too" % name


files = glob.glob(os.path.join(os.environ["TYNDALL_SOURCE"], "Plugin/ServerManager/*.xml"))
assert len(files) >= 9, files
for file in sorted(files):
    for group in ElementTree.parse(file).getroot().findall("ProxyGroup"):
        for proxy in (each for each in group if each.tag != "Extension"):
            check(file, group.get("name"), proxy)
faults.extend(faults_of_menus(files))
assert not faults, "\n" + "\n".join(faults)
