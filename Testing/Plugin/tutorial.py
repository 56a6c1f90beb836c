"""The steps of a page of the documentation, as events that ParaView plays.

Steps are the items of numbered lists. In them, words in bold are what is clicked: a button of the toolbar Light
Transport by its filter's name; Filters, Light Transport and an entry of that menu; Open; OK (after a file in `code`);
Apply; an entry of the pipeline browser; or a property of the panel, followed by the value in italics that is chosen for
it (on or off: of a check box).
"""
import os
import re
import xml.etree.ElementTree as ElementTree

SOURCE = os.environ["TYNDALL_SOURCE"]
PANEL = "pqClientMainWindow/propertiesDock/propertiesPanel/"
PROPERTIES = PANEL + "scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/PropertiesFrame/ProxyPanel/"
BROWSER = "pqClientMainWindow/pipelineBrowserDock/pipelineBrowser"


def filters():
    """Names of the buttons, in their order: those of the menu."""
    menu = ElementTree.parse(os.path.join(SOURCE, "Plugin/Menu/Menu.xml"))
    return [proxy.get("name") for proxy in menu.iterfind("ParaViewFilters/Category/Proxy")]


def steps_to(page, picture):
    """What leads to a picture: the steps of the page's first section, and those of the picture's own.
    @return of each step what is named: (kind of markup, words)"""
    with open(os.path.join(SOURCE, "Plugin/Documentation", page)) as file:
        sections = file.read().split("\n## ")[1:]
    own = [section for section in sections if "(images/%s.png)" % picture in section]
    assert len(own) == 1, "%s has no picture %s, or has it twice" % (page, picture)
    text = "\n".join(dict.fromkeys(sections[:1] + own))
    items = re.findall(r"^\d+\. (.*(?:\n   .*)*)", text, re.MULTILINE)
    steps = [re.findall(r"(\*\*|\*|`)(.+?)\1", " ".join(item.split())) for item in items]
    assert steps and all(steps), "a step of %s names nothing" % page
    return steps


class Player:
    def __init__(self):
        self.events, self.clicks = [], 0
        self.in_menu = False
        self.pipeline = []  # what is in the pipeline browser, each below the one before

    def event(self, thing, command, argument="", clicks=1):
        self.events.append((thing, command, argument))
        self.clicks += clicks

    def choose(self, label, value):
        widget = PROPERTIES + label.replace(" ", "")
        if value in ("on", "off"):
            self.event(widget + "/CheckBox", "set_boolean", "true" if value == "on" else "false")
        else:
            self.event(widget + "/ComboBox", "set_string", value, clicks=2)

    def select(self, name):
        place = "/0:0" * (2 + self.pipeline.index(name))
        self.event(BROWSER, "mousePress", "1,1,0,30,8," + place, clicks=0)
        self.event(BROWSER, "mouseRelease", "1,0,0,30,8," + place)

    def click(self, word, before):
        name = word.replace(" ", "")
        if word == "Apply":
            self.event(PANEL + "Accept", "activate")
        elif word == "Open":
            self.event("pqClientMainWindow/MainControlsToolbar/1QToolButton0", "activate")
        elif word == "OK":
            self.event("pqClientMainWindow/FileOpenDialog", "filesSelected", os.path.join(SOURCE, before), clicks=2)
            self.pipeline.append(os.path.basename(before))
        elif word in ("Filters", "Light Transport"):
            self.in_menu = True
            self.clicks += 1
        elif name in self.pipeline:
            self.select(name)
        else:
            self.make(name)

    def make(self, name):
        assert name in filters(), "no filter, and nothing in the pipeline: " + name
        if self.in_menu:
            self.event("pqClientMainWindow/menubar/menuFilters/Light Transport", "activate", name)
        else:
            self.event("pqClientMainWindow/Light Transport/1QToolButton%d" % filters().index(name), "activate")
        self.in_menu = False
        self.pipeline.append(name + "1")

    def play(self, step):
        for (kind, word), (next_kind, value) in zip(step, step[1:] + [("", "")]):
            if kind == "**" and next_kind == "*":
                self.choose(word, value)
            elif kind == "**":
                self.click(word, next((words for mark, words in step if mark == "`"), ""))

    def save_state(self, path):
        self.event("pqClientMainWindow/menubar/menu_File", "activate", "actionFileSaveServerState", clicks=0)
        self.event("pqClientMainWindow/FileSaveServerStateDialog", "filesSelected", path, clicks=0)

    def write(self, path):
        root = ElementTree.Element("pqevents")
        for thing, command, argument in self.events:
            ElementTree.SubElement(root, "pqevent", object=thing, command=command, arguments=argument)
        ElementTree.ElementTree(root).write(path, xml_declaration=True, encoding="UTF-8")
