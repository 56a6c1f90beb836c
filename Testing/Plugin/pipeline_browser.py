"""Where things stand in ParaView's pipeline browser, which the tests of its window click by rows.

A thing with one input stands below it, or below that output of it which is the input; one with several stands at the
top, and a link to it below each of them. Things come in the order in which they were made or moved there.
"""
import glob
import os
import xml.etree.ElementTree as ElementTree

SERVER_MANAGER = os.path.join(os.environ["TYNDALL_SOURCE"], "Plugin/ServerManager/*.xml")


def our_proxies():
    files = [ElementTree.parse(path) for path in sorted(glob.glob(SERVER_MANAGER))]
    return {proxy.get("name"): proxy for file in files for proxy in file.iter() if proxy.tag.endswith("Proxy")}


class Entry:
    def __init__(self, name, proxy, inputs=()):
        self.name, self.proxy, self.inputs = name, proxy, list(inputs)
        self.new_inputs = []
        self.below = []  # names: of things, and of those that are linked

    def outputs(self):
        found = [] if self.proxy is None else [port.get("name") for port in self.proxy.iter("OutputPort")]
        return found if len(found) > 1 else []


class Browser:
    def __init__(self):
        self.proxies = our_proxies()
        self.entries, self.top = {}, []
        self.selected = None

    def add_source(self, name, proxy=None):
        self.entries[name] = self.selected = Entry(name, self.proxies.get(proxy))
        self.top.append(name)

    def add_filter(self, proxy, name=None):
        """Below what is selected."""
        above = self.selected
        name = name or proxy + "1"
        self.entries[name] = self.selected = Entry(name, self.proxies.get(proxy), [above.name])
        above.below.append(name)

    def has(self, name):
        return name in self.entries or self.owner_of_output(name) is not None

    def owner_of_output(self, name):
        return next((entry for entry in reversed(list(self.entries.values())) if name in entry.outputs()), None)

    def select(self, name):
        self.selected = self.entries.get(name) or self.owner_of_output(name)

    def connect_selected(self, name, now=False):
        self.selected.new_inputs.append(name)
        if now:
            self.apply()

    def apply(self):
        for entry in self.entries.values():
            for name in entry.new_inputs:
                self.entries[name].below.append(entry.name)
                if len(entry.inputs) == 1:
                    self.top.append(entry.name)
                entry.inputs.append(name)
            entry.new_inputs = []

    def place(self, name):
        """@return the rows that lead there, as Qt's events have them: /row:column below the server"""
        if name not in self.entries:
            owner = self.owner_of_output(name)
            return self.place(owner.name) + "/%d:0" % owner.outputs().index(name)
        entry = self.entries[name]
        if not entry.inputs:
            return "/0:0/%d:0" % self.top.index(name)
        above = self.entries[entry.inputs[0]]  # with several inputs this is a link, which is as good and further up
        first_output = "/0:0" if above.outputs() else ""
        return self.place(above.name) + first_output + "/%d:0" % above.below.index(name)

    def property_of_selected(self, label):
        for prop in self.selected.proxy.iter() if self.selected.proxy is not None else ():
            if prop.tag.endswith("Property") and prop.get("name") == label.replace(" ", ""):
                return prop
        return ElementTree.Element("IntVectorProperty")  # of ParaView's own: the tests see if that is wrong

    def asks_for(self, label):
        """Whether the selected filter, just made, asks for this input in a dialog: one that it needs."""
        if self.selected is None or self.selected.proxy is None:
            return False
        needed = [prop.get("name") for prop in self.selected.proxy.iter("InputProperty")
                  if prop.get("panel_widget") is None]
        return label in needed and label not in ("Input",) and len(self.selected.inputs) == 1
