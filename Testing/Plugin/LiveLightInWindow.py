"""In ParaView's window a light's handle is dragged with Auto Apply and the solver's Preview on: the picture changes without
Apply. With Preview off again the light itself is there.

    python3 LiveLightInWindow.py LIGHT paraview [arguments...]    on an X display; LIGHT: Sun or RectangleLight
"""
import os
import subprocess
import sys

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataReader

import pictures
import tutorial
from saved_state import State, folder, forget, values

# Of each light: its handle's rows on the panel, from where to where in the view it is dragged, what that changes.
LIGHTS = {
    "Sun": ("InteractiveLine", (0.5, 0.5), (0.95, 0.1), "FocalPoint"),
    "RectangleLight": ("InteractivePlane", (0.094, 0.5), (0.3, 0.2), "Position"),
}
VIEW = ("pqClientMainWindow/centralwidget/MultiViewWidget/CoreWidget/qt_tabwidget_stackedwidget/MultiViewWidget1/"
        "Container/Frame.0/CentralWidgetFrame/Viewport")
SOURCES, FILTERS = ("pqClientMainWindow/menubar/menu%s/Alphabetical" % menu for menu in ("Sources", "Filters"))
FILE = "pqClientMainWindow/menubar/menu_File"
LIGHT_ROW, SOLVER_ROW = "/0:0/1:0", "/0:0/2:0"  # in the pipeline browser, below the density

kind = sys.argv[1]
rows, begin, end, moved = LIGHTS[kind]
handle = tutorial.PROPERTIES + rows + "/show3DWidget"
player = tutorial.Player()


def path(moment, ending):
    return os.path.join(folder, "LiveLight%s%s.%s" % (kind, moment, ending))


def make(menu, name):
    player.event(menu, "activate", name)
    player.event(tutorial.PANEL + "Accept", "activate")


def select(row):
    player.event(tutorial.BROWSER, "mousePress", "1,1,0,30,8," + row)
    player.event(tutorial.BROWSER, "mouseRelease", "1,0,0,30,8," + row)


def preview(on):
    player.event(tutorial.PROPERTIES + "Preview/CheckBox", "set_boolean", "true" if on else "false")


def pause():
    """Auto Apply comes a moment after the change."""
    player.event("pqClientMainWindow", "pause", "1000")


def save_light(moment):
    """Of the solver, which is selected."""
    player.event(FILE, "activate", "actionFileSaveData")
    player.event("pqClientMainWindow/FileSaveDialog", "filesSelected", path(moment, "vti"))
    player.event("pqClientMainWindow/WriterSettingsDialog/widget/OKButton", "activate")


def save_picture(moment):
    player.event(FILE, "activate", "actionFileSaveScreenshot")
    player.event("pqClientMainWindow/SaveScreenshotFileDialog", "filesSelected", path(moment, "png"))
    player.event("pqClientMainWindow/SaveScreenshotDialog/widget/OKButton", "activate")


def drag():
    """The handles are shown for it alone: what changes between two pictures is the light."""
    middle = tuple((a + b) / 2 for a, b in zip(begin, end))
    select(LIGHT_ROW)
    player.event(handle, "set_boolean", "true")
    for command, place, buttons in (("mouseMove", begin, "0,0,0"), ("mousePress", begin, "1,1,0"),
                                    ("mouseMove", middle, "0,1,0"), ("mouseMove", end, "0,1,0"),
                                    ("mouseRelease", end, "1,0,0")):
        player.event(VIEW, command, "(%g,%g,%s)" % (*place, buttons))
    pause()
    player.event(handle, "set_boolean", "false")


def fluence(moment):
    """By voxel, and whether it says that it is a preview."""
    reader = vtkXMLImageDataReader()
    reader.SetFileName(path(moment, "vti"))
    reader.Update()
    light = reader.GetOutput()
    left_out = light.GetFieldData().GetAbstractArray("left_out")
    said = [left_out.GetValue(i) for i in range(left_out.GetNumberOfValues())]
    return vtk_to_numpy(light.GetCellData().GetArray("fluence")).astype(float), any("a preview" in line for line in said)


def picture(moment):
    return pictures.read(path(moment, "png"))


def difference(one, other):
    return numpy.sqrt(((one - other) ** 2).sum() / (other ** 2).sum())


make(SOURCES, "RTAnalyticSource")
make(SOURCES, kind)
select("/0:0/0:0")
make(FILTERS, "ParticipatingMedium")
player.event(FILTERS, "activate", "LightPropagationMaps")
player.event(tutorial.PROPERTIES + "Lights/1QComboBox0", "set_string", kind + "1:Lights")
preview(True)
player.event(tutorial.PANEL + "Accept", "activate")
player.event("pqClientMainWindow/MainControlsToolbar/actionAutoApply", "set_boolean", "true")
player.save_state(path("Before", "pvsm"))
save_light("Before")
save_picture("Before")
drag()
player.save_state(path("After", "pvsm"))
save_picture("After")
select(SOLVER_ROW)
save_light("After")
preview(False)
pause()
save_light("Full")
player.event("pqClientMainWindow/MainControlsToolbar/actionAutoApply", "set_boolean", "false")
player.write(path("", "xml"))

for moment in ("Before", "After", "Full"):
    forget(*(os.path.basename(path(moment, ending)) for ending in ("pvsm", "vti", "png")))
subprocess.run(sys.argv[2:] + ["--exit", "--test-script=" + path("", "xml")], check=True)

places = [[float(number) for number in values(State(os.path.basename(path(moment, "pvsm"))).one(type=kind), moved)]
          for moment in ("Before", "After")]
print("%s: %s, then %s" % (moved, *places))
assert max(abs(a - b) for a, b in zip(*places)) > 3, "the handle was not dragged"

before, after = picture("Before"), picture("After")
changed = (abs(before - after).max(axis=2) > 12).mean()
print("%.3f of the view's pixels change by more than 12 of 255" % changed)
assert changed > 0.05, "the picture is what it was"

(at_first, is_preview), (preview, still), (light, no_more) = (fluence(moment) for moment in ("Before", "After", "Full"))
assert is_preview and still and not no_more
print("to the light itself: %.3f, before the drag %.3f" % (difference(preview, light), difference(at_first, light)))
assert difference(preview, light) < 0.2, "the preview is not of the light where it is now"
assert difference(at_first, light) > 2 * difference(preview, light), "the light is where it was"
