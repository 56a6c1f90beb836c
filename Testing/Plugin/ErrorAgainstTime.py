"""The example error_against_time.py on a small scene in files: table, lines, plot and advice."""
import csv
import json
import math
import os
import sys

import numpy
from paraview import servermanager, smtrace
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy
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

# One click makes the recommended filters on the inputs of a comparison: their light has the error of the row.
mesh = Sphere()
ball = MeshVoxelizer(Input=mesh, SampleDimensions=[12] * 3, OutsideScattering=[1, 1, 1], FilterSize=3)
sun = LightRig(SunElevation=40)
OFF = dict.fromkeys(error_against_time.SWITCHES.values(), 0)


def values_of(source, name):
    return vtk_to_numpy(servermanager.Fetch(source).GetCellData().GetArray(name)).ravel()


def click(scene, reference, filters, array, **settings):
    comparison = SolverComparison(**{**OFF, "Input": scene, "Lights": sun, "Reference": reference, "Coarsenings": [1], "MapResolutions": [1],
                                     "Orders": [], "Directions": [9], "PhotonCounts": [2000], "Repeats": 1, "TimeBudget": 1e6, "EstimateError": 0, **settings})
    comparison.UpdatePipeline()
    best = next(row for row in error_against_time.rows_of(comparison)[0] if row["filters"] == comparison.RecommendedFilters)
    assert best["recommended"] and comparison.Recommended.startswith(best["method"] + ", " + best["setting"]), comparison.Recommended
    assert [one.split()[0] for one in best["filters"].split(" | ")] == filters, best
    smtrace.start_trace()
    made = error_against_time.make_recommended(comparison)
    trace = smtrace.stop_trace()
    for filter in filters:
        assert filter + "(" in trace, (filter, trace)
    assert made is not None and made.SMProxy.GetXMLName() == filters[-1], made
    if array:
        truth = values_of(reference, array)
        error = numpy.linalg.norm(values_of(made, "fluence") - truth) / numpy.linalg.norm(truth)
        assert abs(error - best["error_l2"]) < 1e-5, (best, error)
    return comparison, made


straight = LightPropagationMaps(Input=medium, Lights=sun, SkyColor=[0.1] * 3, DirectionsPerFace=64)
sky = {"SkyColor": [0.1] * 3}
click(medium, straight, ["LightPropagationMaps"], "fluence", LightPropagationMaps=1, Tolerance=1e-2, **sky)
click(medium, straight, ["DiscreteOrdinates"], "fluence", DiscreteOrdinates=1, Terms=[4], **sky)
comparison, made = click(medium, straight, ["LightPropagationMaps", "MediumRayCaster"], None, LightPropagationMaps=1, Pictures=1, ImageSize=[32, 24],
                         CameraPosition=[30, 20, 10], **sky)
assert list(made.CameraPosition) == [30, 20, 10] and list(made.ImageSize) == [32, 24] and made.Input.GetXMLName() == "LightPropagationMaps"
traced = PhotonMarcher(Input=ball, Photons=PhotonEmitter(Input=ball, Lights=sun, PhotonCount=20000), MaximumOrders=0)
click(ball, traced, ["PhotonEmitter", "PhotonMarcher", "LightPropagationMaps"], "fluence", PhotonsThenMaps=1)
click(ball, traced, ["PhotonEmitter", "PhotonMarcher"], "fluence", MonteCarlo=1)
click(ball, traced, ["PhotonEmitter", "PhotonMarcher", "PhotonReconstruction"], "fluence_direct", Photons=1, StepSizes=[0.5])
click(ball, traced, ["MeshVoxelizer", "PhotonEmitter", "PhotonMarcher", "PhotonReconstruction"], "fluence_direct", Mesh=mesh,
      SupersamplingFactors=[4], FilterSizes=[3])
