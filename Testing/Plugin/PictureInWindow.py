"""In ParaView's window a picture opens in a view of its own without a bar of colours, and takes the 3D view's camera by its button,
and follows it where it is asked to.

    python3 PictureInWindow.py paraview [arguments...]    on an X display
"""
import os
import subprocess
import sys

from saved_state import State, forget, values

session = os.path.join(os.path.dirname(os.path.abspath(__file__)), "PictureInWindow.xml")
forget("PictureInWindow.pvsm")
forget("PictureFollows.pvsm")
subprocess.run(sys.argv[1:] + ["--exit", "--test-script=" + session], check=True)



def cameras(state):
    """Of the picture and of the 3D view, by property."""
    caster, view = state.one(type="MediumRayCaster"), state.one(group="views", type="RenderView")
    return {name: [[float(number) for number in values(proxy, name)] for proxy in (caster, view)]
            for name in ("CameraPosition", "CameraFocalPoint", "CameraViewUp")}


def assert_taken(state):
    for name, (taken, of_view) in cameras(state).items():
        assert max(abs(a - b) for a, b in zip(taken, of_view)) < 1e-9, (name, taken, of_view)


state, turned = State("PictureInWindow.pvsm"), State("PictureFollows.pvsm")
assert_taken(state)
assert cameras(turned)["CameraPosition"][1] != cameras(state)["CameraPosition"][1], "the view was not turned"
assert_taken(turned)
views = sorted(proxy.get("type") for proxy in state.all(group="views"))
assert views == ["PictureView", "RenderView"], views
caster = state.one(type="MediumRayCaster")
shown = [proxy for proxy in state.all(group="representations", type="UniformGridRepresentation")
         if values(proxy, "Input") == [caster.get("id")]]
assert [values(proxy, "Representation") for proxy in shown] == [["Slice"]], shown
colors = values(shown[0], "LookupTable")
bars = [bar for bar in state.all(type="ScalarBarWidgetRepresentation") if values(bar, "LookupTable") == colors]
assert all(values(bar, "Visibility") == ["0"] for bar in bars), "a bar of colours"
