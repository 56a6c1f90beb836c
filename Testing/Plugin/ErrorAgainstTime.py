"""The example error_against_time.py on a small scene in files: table, lines, plot and advice."""
import csv
import json
import math
import os
import sys

from paraview.simple import *
from paraview.vtk.vtkIOImage import vtkPNGReader

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
folder = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "error_against_time")
os.makedirs(folder, exist_ok=True)


def output(name):
    return os.path.join(folder, name)


waves = Wavelet(WholeExtent=[-4, 4] * 3)
medium = ParticipatingMedium(Input=waves, ExtinctionScale=0.3, Albedo=[0.9] * 3)
SaveData(output("waves.vti"), proxy=medium)
SaveData(output("sun.vtp"), proxy=LightRig(SunElevation=40))

script = os.path.join(os.environ["TYNDALL_SOURCE"], "Plugin/Examples/error_against_time.py")
sys.path.insert(0, os.path.dirname(script))
sys.dont_write_bytecode = True
sys.argv = [script, output("waves.vti"), "--lights", output("sun.vtp"), "--sky", "0.1", "0.1", "0.1", "--directions", "4", "25",
            "--coarsenings", "1", "2", "--photons", "1000", "10000", "--budget", "1e6", "--repeats", "1", "--output", folder]
for name in ("waves.csv", "waves.jsonl", "waves.png"):
    if os.path.exists(output(name)):
        os.remove(output(name))
import error_against_time

error_against_time.main()

rows = list(csv.DictReader(open(output("waves.csv"))))
lines = [json.loads(line) for line in open(output("waves.jsonl"))]
assert len(rows) == len(lines) > 10, (len(rows), len(lines))
assert {row["method"] for row in rows} == {"light propagation maps", "constant source, not accelerated", "as published", "photons"}
assert all(math.isfinite(float(row["error_l2"])) and float(row["seconds"]) > 0 for row in rows)
assert any(row["pareto"] == "1" for row in rows)
picture = vtkPNGReader()
picture.SetFileName(output("waves.png"))
picture.Update()
assert picture.GetOutput().GetNumberOfPoints() > 500000
assert picture.GetOutput().GetPointData().GetScalars().GetRange(0)[0] < 100, "the plot is not blank"

# What is said of a made table.
made = [{"method": "as published", "setting": name, "quantity": "fluence", "seconds": seconds, "error_l2": error}
        for name, seconds, error in (("a", 1.0, 0.1), ("b", 100.0, 0.001), ("c", 50.0, 0.2))]
assert [row["setting"] for row in error_against_time.front(made)] == ["a", "b"]
assert abs(error_against_time.seconds_for(made, 0.01) - 10.0) < 1e-9
assert math.isnan(error_against_time.seconds_for(made, 1e-4))
assert error_against_time.fastest_for(made, 0.01)["setting"] == "b"
said = list(error_against_time.advice(made))
assert len(said) == 3 and "as published, b" in said[1], said
