#!/usr/bin/env python3
"""Writes reference.md: every filter and every property, as ParaView's server-manager XML describes them.

    make_reference.py            writes Plugin/Documentation/reference.md
    make_reference.py --check    fails where that file is not what this would write

What a property means, its unit, its default and its range are said once, in Plugin/ServerManager/*.xml.
"""
import pathlib
import re
import sys
import textwrap
import xml.etree.ElementTree as ElementTree

HERE = pathlib.Path(__file__).resolve().parent
PROXIES = HERE.parent / "ServerManager"
REFERENCE = HERE / "reference.md"
COLUMNS = 120
NAME = re.compile(r"\b[A-Za-z]+(?:_[A-Za-z0-9]+)+\b")

HEAD = """# Reference

This page lists every filter and every property. `make_reference.py` generates it from `Plugin/ServerManager/*.xml`:
change the documentation there, then run the script. The [guide](guide.md) shows how to combine the filters.

Properties have the names that Python and ParaView's traces use; the panel shows them with spaces. The C++ class of a
filter `X` is `vtkX`; a property `P` is set by `SetP`, and a result `R` is read by `GetR`. Properties marked *advanced*
appear on the panel after a click on the gear beside its search field. "Length" as a unit means the dataset's own unit
of length. A number outside the valid values of a property is refused with an error, never replaced. Some C++ classes
accept more values than panels offer, for example angles above a full turn, or more directions. A choice accepts its
text or its number: `Scheme="Conservative"` or `Scheme=1`.

The *domain* is the whole grid, a *subdomain* is the part of it on one rank, and a *halo* is the layer of ghost cells
around a subdomain.
"""


def escaped(text):
    """Plain words as Markdown that shows them unchanged, names of arrays and variables as code."""
    for mark in "\\*<>|[]`":
        text = text.replace(mark, "\\" + mark)
    return NAME.sub(r"`\g<0>`", text)


def words(text):
    return " ".join((text or "").split())


def paragraphs(element):
    """The paragraphs of a documentation, which blank lines part."""
    dedented = textwrap.dedent((element.text or "").strip("\n"))
    return [words(part) for part in dedented.split("\n\n") if words(part)]


def wrapped(text):
    return textwrap.fill(text, COLUMNS, break_long_words=False, break_on_hyphens=False)


def code(text):
    return "`" + text + "`"


def plain_number(text):
    """A number of the XML as people write it: 2 for 2.0, 1e-9 as it is."""
    return text[:-2] if text.endswith(".0") else text


def bounds(domain, whole):
    """The valid values of a number, from a range domain."""
    low, high = (sorted(set(map(plain_number, (domain.get(side) or "").split()))) for side in ("min", "max"))
    if len(low) > 1 or len(high) > 1:
        sys.exit("A range that differs by component: say here how to write it")
    if low and high:
        return "%s to %s" % (low[0], high[0])
    if low or high:
        return ("at least " + low[0]) if low else ("at most " + high[0])
    return "any whole number" if whole else "any number"


def entries(prop):
    domain = prop.find("EnumerationDomain")
    return [(each.get("value"), each.get("text")) for each in domain.findall("Entry")] if domain is not None else []


def component_labels(prop):
    return [each.get("label") for each in prop.iter("ComponentLabel")]


def valid_values(prop):
    if prop.tag == "Property":
        return "a button; in Python `InvokeCommand(\"%s\")`" % prop.get("name")
    count = int(prop.get("number_of_elements", 1))
    several = "%d numbers, each " % count if count > 1 and prop.tag != "StringVectorProperty" else ""
    if prop.tag == "InputProperty":
        kinds = " or ".join(code(each.get("value")) for each in prop.iter("DataType"))
        many = ", several" if prop.get("multiple_input") == "1" else ""
        return kinds + many + (", optional" if prop.find("Hints/Optional") is not None else "")
    if entries(prop):
        return ", ".join(escaped(text) if text == value else "%s (%s)" % (escaped(text), value)
                         for value, text in entries(prop))
    if prop.find("BooleanDomain") is not None:
        return "0 or 1"
    for kind in ("DoubleRangeDomain", "IntRangeDomain"):
        if prop.find(kind) is not None:
            return several + bounds(prop.find(kind), kind.startswith("Int"))
    if prop.find("ArrayListDomain") is not None:
        return "an array of the input"
    if prop.find("ArraySelectionDomain") is not None:
        return "names of what the file has"
    if prop.find("FileListDomain") is not None or prop.get("name") == "FileName":
        return "a file name"
    if component_labels(prop) and prop.get("repeat_command"):
        return "rows of " + prop.get("number_of_elements_per_command") + ": " + ", ".join(component_labels(prop))
    if prop.get("repeat_command"):
        return "whole numbers" if prop.tag == "IntVectorProperty" else "numbers"
    return "any number" if prop.tag == "DoubleVectorProperty" else "text"


def default(prop):
    value = prop.get("default_values")
    if prop.find("ArrayListDomain") is not None:
        return code(value.split(";")[-1]) if value else "its scalars"
    if not value:
        return "none" if prop.get("repeat_command") and component_labels(prop) else ""
    text = dict(entries(prop)).get(value)
    return escaped(text) if text else " ".join(map(plain_number, value.split()))


def condition(proxy, prop):
    """When the panel shows a property, or nothing."""
    for widget in prop.iter("PropertyWidgetDecorator"):
        if widget.get("mode") != "visibility":
            continue
        other = next(each for each in proxy if each.get("name") == widget.get("property"))
        value = dict(entries(other)).get(widget.get("value"), widget.get("value"))
        verb = "is not" if widget.get("inverse") == "1" else "is"
        return " Shown if `%s` %s %s." % (other.get("name"), verb, escaped(value))
    return ""


def is_internal(prop):
    """What ParaView and other properties read, and no user."""
    return prop.find("TimeStepsInformationHelper") is not None or prop.get("name").endswith("Info")


def properties_of(proxy, proxies):
    """A proxy's properties, those of the proxies inside it that it shows included."""
    own = [child for child in proxy if child.tag.endswith("Property")]
    for part in proxy.findall("SubProxy"):
        inner = proxies[part.find("Proxy").get("proxyname")]
        shown = {each.get("name") for each in part.findall("ExposedProperties/Property")}
        own += [child for child in inner if child.get("name") in shown]
    return [prop for prop in own if not is_internal(prop)]


def row(*cells):
    return "| " + " | ".join(cells) + " |"


def settings_table(proxy, settings):
    yield row("property", "default", "valid values", "meaning")
    yield "|---|---|---|---|"
    for prop in settings:
        name = code(prop.get("name")) + (" *advanced*" if prop.get("panel_visibility") == "advanced" else "")
        meaning = escaped(words(prop.find("Documentation").text)) + condition(proxy, prop)
        yield row(name, default(prop), valid_values(prop), meaning)


def results_table(results):
    yield row("result", "meaning")
    yield "|---|---|"
    for prop in results:
        yield row(code(prop.get("name")), escaped(words(prop.find("Documentation").text)))


def where(proxy):
    """How a user gets at it."""
    name, label = proxy.get("name"), proxy.get("label", proxy.get("name"))
    for kind, verb in (("ReaderFactory", "File, Open"), ("WriterFactory", "File, Save Data")):
        factory = proxy.find("Hints/" + kind)
        if factory is not None:
            return "%s, for %s" % (verb, " and ".join("." + each for each in factory.get("extensions").split()))
    if proxy.tag == "RepresentationProxy":
        return "Representation, %s, of an image in the 3D view" % label
    menu = "Sources" if proxy.get("group") == "sources" else "Filters"
    return "%s, Light Transport, %s" % (menu, label)


def page_of(proxy, proxies):
    yield "## " + proxy.get("name")
    yield ""
    ports = [each.get("name") for each in proxy.findall("OutputPort")]
    outputs = "" if not ports else " Output%s: %s." % ("s" if len(ports) > 1 else "", ", ".join(ports))
    yield wrapped("*%s* Menu: %s.%s" % (escaped(words(proxy.find("Documentation").get("short_help"))), where(proxy), outputs))
    for paragraph in paragraphs(proxy.find("Documentation")):
        yield ""
        yield wrapped(escaped(paragraph))
    properties = properties_of(proxy, proxies)
    results = [prop for prop in properties if prop.get("information_only")]
    yield ""
    yield from settings_table(proxy, [prop for prop in properties if prop not in results])
    if results:
        yield ""
        yield from results_table(results)
    yield ""


def all_proxies():
    """@return (those a user sees, all by name)"""
    seen, all_by_name = [], {}
    for file in sorted(PROXIES.glob("*.xml")):
        for group in ElementTree.parse(file).getroot().findall("ProxyGroup"):
            for proxy in (each for each in group if each.tag != "Extension"):
                all_by_name[proxy.get("name")] = proxy
                proxy.set("group", group.get("name"))
                if not group.get("name").startswith(("internal", "views")) or proxy.tag == "RepresentationProxy":
                    seen.append(proxy)
    return sorted(seen, key=lambda proxy: proxy.get("name").lower()), all_by_name


def reference():
    seen, proxies = all_proxies()
    lines = [HEAD, row("filter", "purpose"), "|---|---|"]
    for proxy in seen:
        name = proxy.get("name")
        short = escaped(words(proxy.find("Documentation").get("short_help")))
        lines.append(row("[%s](#%s)" % (name, name.lower()), short))
    lines.append("")
    for proxy in seen:
        lines += page_of(proxy, proxies)
    return "\n".join(lines).rstrip("\n") + "\n"


def main(arguments):
    if arguments not in ([], ["--check"]):
        sys.exit(__doc__)
    text = reference()
    if not arguments:
        REFERENCE.write_text(text)
    elif not REFERENCE.exists() or REFERENCE.read_text() != text:
        sys.exit("Plugin/Documentation/reference.md is not what Plugin/ServerManager/*.xml says: run "
                 "Plugin/Documentation/make_reference.py and commit what it writes")


main(sys.argv[1:])
