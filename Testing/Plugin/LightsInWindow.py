"""In ParaView's window a lamp is dragged by its handle, and a sun put where the camera is by its button.

    python3 LightsInWindow.py paraview [arguments...]    on an X display
"""
import os
import subprocess
import sys

from saved_state import State, forget, values

session = os.path.join(os.path.dirname(os.path.abspath(__file__)), "LightsInWindow.xml")
names = ("LampMade.pvsm", "LampDragged.pvsm", "SunAtCamera.pvsm")
forget(*names)
subprocess.run(sys.argv[1:] + ["--exit", "--test-script=" + session], check=True)


def numbers(proxy, name):
    return [float(number) for number in values(proxy, name)]


def distance(first, second):
    return max(abs(a - b) for a, b in zip(first, second))


states = [State(name) for name in names]
made, dragged = (numbers(state.one(type="PointLight"), "Position") for state in states[:2])
assert made == [0, 0, 0.7], made
assert distance(made, dragged) > 0.002, dragged  # the ball, of radius 0.02, fills the view

sun, view = states[2].one(type="Sun"), states[2].one(group="views", type="RenderView")
for of_light, of_view in (("Position", "CameraPosition"), ("FocalPoint", "CameraFocalPoint")):
    assert distance(numbers(sun, of_light), numbers(view, of_view)) < 1e-9, (of_light, numbers(sun, of_light))
assert distance(numbers(sun, "Position"), [-0.5, -0.5, 0.7071]) > 0.1, "the camera is elsewhere"
