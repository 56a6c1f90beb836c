"""The steps of a page of the documentation, as events that ParaView plays.

Steps are the items of numbered lists. In them, words in bold are what is clicked: a button of the toolbar Light
Transport by its filter's name; Filters or Sources, and an entry of these menus by the words that lead to it; Open; OK
(after a file in `code`, or in a dialog); Apply; an entry of the pipeline browser; a button of the panel or of the camera's toolbar; or a property
of the panel, followed by the value in italics that is given to it (on or off: of a check box; numbers; an entry of a
list).

A section of start.md continues from the page's first one. Any section may continue from the sections that it links to
after the words "continue from the state after".
"""
import os
import re
import sys
import xml.etree.ElementTree as ElementTree

from pipeline_browser import Browser

SOURCE = os.environ["TYNDALL_SOURCE"]
# The ParaView that plays, by the plugin's folder on its command line; the pages show the window of PICTURED.
PARAVIEW = tuple(int(number) for number in re.search(r"/paraview-(\d+)\.(\d+)/", " ".join(sys.argv)).groups())
PICTURED = (5, 11)
WINDOW = "pqClientMainWindow/"
PANEL = WINDOW + "propertiesDock/propertiesPanel/"
TOOLBAR = WINDOW + ("filters." if PARAVIEW >= (5, 13) else "") + "Light Transport/"
BROWSER = WINDOW + "pipelineBrowserDock/pipelineBrowser"
PROPERTIES = PANEL + "scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/PropertiesFrame/ProxyPanel/"
PROXIES_OF_OTHERS = {"Sphere": "SphereSource", "Slice": "Cut", "Plot Over Line": "ProbeLine"}
BUTTONS = {
    "Z Normal": PROPERTIES + "CutFunction/ProxySelectionWidget/frame/ChosenProxyWidget/InteractivePlane/useZNormal",
    "X Axis": PROPERTIES + "InteractiveLine/xAxis",
    "+Y": WINDOW + "cameraToolbar/actionPositiveY",
    "Zoom to Data": WINDOW + "cameraToolbar/actionZoomToData",
}


def filters():
    """Names of the buttons, in their order: those of the menu."""
    menu = ElementTree.parse(os.path.join(SOURCE, "Plugin/Menu/Menu.xml"))
    return [proxy.get("name") for proxy in menu.iterfind("ParaViewFilters/Category/Proxy")]


def sections(page):
    """@return text by heading, those of the second and third level, in order"""
    with open(os.path.join(SOURCE, "Plugin/Documentation", page)) as file:
        parts = re.split(r"^##+ (.+)\n", file.read(), flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2]))


def anchor(heading):
    return re.sub(r"[^a-z0-9 -]", "", heading.lower()).replace(" ", "-")


def with_prerequisites(page, heading):
    """@return text of a section, after those that it continues from"""
    found = sections(page)
    named = re.search(r"continue\s+from\s+the\s+state\s+after\s+((?:\[[^]]*\]\([^)]*\)[,\s]*(?:and\s+)?)+)", found[heading])
    texts = []
    if named:
        for other, fragment in re.findall(r"\(([^)#]*)#([^)]*)\)", named[1]):
            wanted = [each for each in sections(other or page) if anchor(each) == fragment]
            assert len(wanted) == 1, "%s has no section %s" % (other or page, fragment)
            texts += with_prerequisites(other or page, wanted[0])
    elif page == "start.md" and heading != next(iter(found)):
        texts += with_prerequisites(page, next(iter(found)))
    return texts + [found[heading]]


def steps_to(page, picture):
    """What leads to a picture: the steps of its section, and before them of those that it continues from.
    @return of each step what is named: (kind of markup, words)"""
    own = [heading for heading, text in sections(page).items() if "(images/%s.png)" % picture in text]
    assert len(own) == 1, "%s has no picture %s, or has it twice" % (page, picture)
    text = "\n".join(dict.fromkeys(with_prerequisites(page, own[0])))
    items = re.findall(r"^\d+\. (.*(?:\n   .*)*)", text, re.MULTILINE)
    steps = [re.findall(r"(\*\*|\*|`)(.+?)\1", " ".join(item.split())) for item in items]
    assert steps and all(steps), "a step of %s names nothing" % page
    return steps


def has_slider(prop):
    """Whether the panel shows a property by a slider: one number of a range that ends on both sides."""
    ends = [domain for domain in prop if domain.tag.endswith("RangeDomain") and domain.get("min") and domain.get("max")]
    return bool(ends) and prop.get("number_of_elements", "1") == "1"


class Player:
    def __init__(self):
        self.events, self.clicks = [], 0
        self.menu = []  # what was clicked of one, as yet
        self.browser = Browser()
        self.dialog = ""  # the name of the input that it asks for

    def event(self, thing, command, argument="", clicks=1):
        self.events.append((thing, command, argument))
        self.clicks += clicks

    def choose(self, label, value):
        widget = PROPERTIES + label.replace(" ", "")
        numbers = value.split(", ") if re.fullmatch(r"-?[\d.]+(, -?[\d.]+)*", value) else []
        prop = self.browser.property_of_selected(label)
        if value in ("on", "off"):
            self.event(widget + "/CheckBox", "set_boolean", "true" if value == "on" else "false")
        elif numbers:
            kind = "" if prop.tag.startswith("Int") else "Double"
            for place, number in enumerate(numbers):
                edit = "%sRangeWidget/%sLineEdit" % (kind or "Int", kind) if has_slider(prop) else (
                    "%sLineEdit%d" % (kind, place))
                self.event("%s/%s" % (widget, edit), "set_string", number)
        elif prop.tag == "InputProperty":
            self.browser.connect_selected(value.split(":")[0])
            self.event(widget + "/1QComboBox0", "set_string", value, clicks=2)
        else:
            self.event(widget + "/ComboBox", "set_string", value, clicks=2)

    def select(self, name, tree=BROWSER):
        place = self.browser.place(name)
        self.event(tree, "mousePress", "1,1,0,30,8," + place, clicks=0)
        self.event(tree, "mouseRelease", "1,0,0,30,8," + place)

    def click(self, word, before):
        name = word.replace(" ", "")
        if self.menu:
            self.follow_menu(word)
        elif word == "Apply":
            self.browser.apply()
            self.event(PANEL + "Accept", "activate")
        elif word == "Open":
            self.event(WINDOW + "MainControlsToolbar/actionOpenData", "activate")
        elif word == "OK" and self.dialog:
            self.event(WINDOW + "SelectInputDialog/buttonBox/1QPushButton0", "activate")
            self.dialog = ""
        elif word == "OK":
            self.event(WINDOW + "FileOpenDialog", "filesSelected", os.path.join(SOURCE, before), clicks=2)
            self.browser.add_source(os.path.basename(before))
        elif word in ("Filters", "Sources"):
            self.menu = [word]
            self.event(WINDOW + "menubar", "activate", "menu" + word)
        elif word in BUTTONS:
            self.event(BUTTONS[word], "activate")
        elif self.browser.has(name):
            self.select(name)
            self.browser.select(name)
        else:
            assert name in filters(), "no filter, and nothing in the pipeline: " + name
            self.event(TOOLBAR + "1QToolButton%d" % filters().index(name), "activate")
            self.browser.add_filter(name)

    def follow_menu(self, word):
        self.menu.append(word)
        if len(self.menu) < 3:
            self.clicks += 1
            return
        top, category, _ = self.menu
        category = category if category == "Light Transport" else category.replace(" ", "")  # as the menus are called
        name = PROXIES_OF_OTHERS.get(word, word.replace(" ", ""))
        self.event(WINDOW + "menubar/menu%s/%s" % (top, category), "activate", name)
        if top == "Sources":
            self.browser.add_source(word.replace(" ", "") + "1", name)
        else:
            self.browser.add_filter(name, word.replace(" ", "") + "1")
        self.menu = []

    def choose_in_dialog(self, label, name):
        """Another input, which a filter asks for before it is made."""
        dialog = WINDOW + "SelectInputDialog/"
        self.event(dialog + "buttonFrame/" + label, "set_boolean", "true")
        self.select(name, dialog + "pipelineView")
        self.browser.connect_selected(name, now=True)
        self.dialog = label

    def play(self, step):
        for (kind, word), (next_kind, value) in zip(step, step[1:] + [("", "")]):
            if kind == "**" and next_kind == "*" and self.browser.asks_for(word):
                self.choose_in_dialog(word, value)
            elif kind == "**" and next_kind == "*":
                self.choose(word, value)
            elif kind == "**":
                self.click(word, next((words for mark, words in step if mark == "`"), ""))

    def save_state(self, path):
        self.event(WINDOW + "menubar/menu_File", "activate", "actionFileSaveServerState", clicks=0)
        self.event(WINDOW + "FileSaveServerStateDialog", "filesSelected", path, clicks=0)

    def write(self, path):
        root = ElementTree.Element("pqevents")
        for thing, command, argument in self.events:
            ElementTree.SubElement(root, "pqevent", object=thing, command=command, arguments=argument)
        ElementTree.ElementTree(root).write(path, xml_declaration=True, encoding="UTF-8")
