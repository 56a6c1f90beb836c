"""In ParaView's window the first Apply of a solver shows light: of the default sky, as Lit Volume, in the one view there is.

    python3 FirstApply.py paraview [arguments...]    on an X display
"""
import os
import subprocess
import sys

from saved_state import State, forget, values

session = os.path.join(os.path.dirname(os.path.abspath(__file__)), "FirstApply.xml")

forget("FirstApply.pvsm", "SecondApply.pvsm")
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
