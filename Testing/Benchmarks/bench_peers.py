"""Error against time beside other programs.    ./run bench peers [SCENE...] [--environment FOLDER] [--quick]

Scenes: slabs, cube-5, cloud-20, cube-100. Slabs: reflectance and transmittance, beside PythonicDISORT and disortpp;
reference: adding-doubling. The others: fluence of 8 x 8 x 8 blocks of unit cubes with a face that shines, by light
propagation maps and the project's own Monte Carlo, by Mitsuba 3 (light followed back from random points of the blocks), and
by a forward Monte Carlo in Dr.Jit; reference: Data/Reference/peer_cubes.csv. Prints a JSON line a method and setting, then
lines with `ratio`, and tables.

The programs come from PyPI into FOLDER (build/release/peers) at the first run; what cannot be had is left out, with a word.
TYNDALL_BENCH_QUICK or --quick: slabs and the thinnest cube in a few seconds, whose figures mean nothing, and only programs
that are there already.
"""
import argparse
import collections
import functools
import itertools
import json
import math
import os
import statistics
import subprocess
import sys
import time

import numpy

here = os.path.dirname(os.path.abspath(__file__))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(here, "Peers"))
from bench_error import DEFAULT, MONTE_CARLO, eat, image, reference_rows, root  # noqa: E402
from scenes import BLOCKS, SCENES  # noqa: E402

from paraview.vtk.util.numpy_support import vtk_to_numpy  # noqa: E402
from paraview.vtk.vtkCommonCore import vtkDoubleArray  # noqa: E402

TARGETS = (0.1, 0.03, 0.01, 0.003)
ERRORS = ("error_l2", "error_relative")
DARK = 1e-3  # blocks with less than that of the brightest's fluence are not compared
METHODS = {"forward": "forward Monte Carlo in Dr.Jit", "adjoint": "Mitsuba, adjoint estimate"}
STREAMS = (4, 8, 16, 32)


def ask(script, folder, quick, *arguments, words=""):
    """The lines that a program of Peers/ prints, run by a python of its own."""
    own = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONHOME", "LD_LIBRARY_PATH")}
    command = ["python3", "-B", os.path.join(here, "Peers", script), folder, *(["--quick"] if quick else []), *arguments]
    sys.stdout.flush()
    return subprocess.run(command, input=words, stdout=subprocess.PIPE, universal_newlines=True, env=own).stdout.splitlines()


def print_row(**row):
    print(json.dumps({"bench": "peers", **eat.known(row)}), flush=True)


def reference_of(name):
    """Mean fluence of the blocks, NaN where it is too dark to be compared, and its own errors."""
    fluence, sigma = numpy.zeros((2,) + (BLOCKS,) * 3)
    for row in reference_rows("peer_cubes"):
        if row["scene"] == name:
            place = int(row["iz"]), int(row["iy"]), int(row["ix"])
            fluence[place], sigma[place] = float(row["phi"]), float(row["sigma"])
    known = numpy.where(fluence < DARK * fluence.max(), math.nan, fluence)
    return known, errors_of(fluence + sigma, known)


def errors_of(fluence, reference):
    bright = ~numpy.isnan(reference)
    difference = fluence[bright] - reference[bright]
    return {"error_l2": float(numpy.linalg.norm(difference) / numpy.linalg.norm(reference[bright])),
            "error_max": float(abs(difference).max() / reference[bright].max()),
            "error_relative": float(numpy.sqrt(numpy.mean((difference / reference[bright]) ** 2)))}


def own_rows(name, reference, quick):
    """Light propagation maps by default on three grids and with more and fewer directions, and Monte Carlo of the project."""
    _, extinction, albedo = SCENES[name]
    edge = 16 if quick else 64
    repeat = edge // extinction.shape[0]
    extinction = extinction.repeat(repeat, 0).repeat(repeat, 1).repeat(repeat, 2) if repeat else extinction[::2, ::2, ::2]
    medium = image({"sigma_a": (1.0 - albedo) * extinction, "sigma_s": albedo * extinction}, (1, 1, 1), (edge,) * 3)
    rows, facts = eat.compare(
        (DEFAULT, MONTE_CARLO), Input=medium, Reference=image({"fluence": reference}, (1, 1, 1), (BLOCKS,) * 3),
        FaceRadiance=[0, 0, 0, 0, 1.0 / math.pi, 0], Directions=[25] if quick else [4, 9, 25], MapResolutions=[1],
        Coarsenings=[1] if quick else [1, 2, 4, 8], Orders=[], EstimateError=0, Repeats=1 if quick else 3,
        PhotonCounts=[1000] if quick else [1000, 10000, 100000, 1000000], TimeBudget=15.0)
    eat.print_left_out(facts["left_out"])
    return rows


def peer_rows(answer, reference):
    """A setting of another program: the root of the mean square of the errors of its runs, the median of their seconds."""
    found = [errors_of(numpy.reshape(fluence, (BLOCKS,) * 3), reference) for fluence in answer["fluence"]]
    row = {key: math.sqrt(statistics.fmean(each[key] ** 2 for each in found)) for key in found[0]}
    return {"method": METHODS[answer["program"]], "version": answer["version"], "setting": answer["setting"],
            "grid": "%d^3 blocks" % BLOCKS, "seconds": statistics.median(answer["seconds"]), **row}


def time_to(rows, target, error):
    """Seconds to an error, and whether they are extrapolated: of Monte Carlo, time goes by the inverse square of the error."""
    seconds = eat.seconds_for(rows, target, error)
    if not math.isnan(seconds) or rows[0]["method"] == DEFAULT:
        return seconds, False
    longest = max(rows, key=lambda row: row["seconds"])
    return longest["seconds"] * (longest[error] / target) ** 2, True


def compare_times(case, rows, noise):
    """Lines of JSON and a table: seconds to an error, over those of light propagation maps. No error below twice the
    reference's own is looked at."""
    title = "%s; reference: Monte Carlo, itself off by %.1g (error_l2) and %.1g (error_relative)" % (
        SCENES[case][0], *(noise[error] for error in ERRORS))
    lines = ["\n%s\n%-34s %-15s" % (title, "seconds to", "error") + "".join("%22s" % ("%g%%" % (100 * t)) for t in TARGETS)]
    for error, method in itertools.product(ERRORS, dict.fromkeys(row["method"] for row in rows)):
        cells = []
        for target in TARGETS:
            if target < 2.0 * noise[error]:
                cells.append("-")
                continue
            ours, _ = time_to([row for row in rows if row["method"] == DEFAULT], target, error)
            seconds, extrapolated = time_to([row for row in rows if row["method"] == method], target, error)
            ratio = "" if math.isnan(seconds / ours) else " (%.2g)" % (seconds / ours)
            cells.append("never" if math.isnan(seconds) else "%s%.2g s%s" % ("~" if extrapolated else "", seconds, ratio))
            print_row(case=case, method=method, against=DEFAULT, seconds=seconds, ratio=seconds / ours,
                      extrapolated=extrapolated, **{error: target})
        lines.append("%-34s %-15s" % (method, error) + "".join("%22s" % cell for cell in cells))
    print("\n".join(lines))
    print("~: extrapolated, time by the inverse square of the error. In brackets: times the seconds of %s" % DEFAULT, flush=True)


def cube(name, folder, quick):
    reference, noise = reference_of(name)
    rows = own_rows(name, reference, quick)
    rows += [peer_rows(json.loads(line), reference) for line in ask("cube_peers.py", folder, quick, name)]
    for row in rows:
        print_row(case=name, **row)
    compare_times(name, rows, noise)


def slab_medium(tau, albedo, g, layers):
    medium = image({"sigma_a": (1.0 - albedo) * tau, "sigma_s": albedo * tau}, (1.0 / layers, 1.0 / layers, 1.0), (1, 1, layers))
    cosine = vtkDoubleArray()
    cosine.SetName("g")
    cosine.InsertNextValue(g)
    medium.GetClientSideObject().GetOutputDataObject(0).GetFieldData().AddArray(cosine)
    return medium


def own_slab(case, truth, layers, runs):
    """By the filter as it is, its proxy's update included: the solve alone is in the milliseconds."""
    tau, albedo, g, light = case
    lit = {"FaceRadiance": [0, 0, 0, 0, 0, 1.0 / math.pi]} if light == "diffuse" else {
        "Lights": eat.LightRig(SunElevation=30, SunAzimuth=130)}
    solver = eat.LightPropagationMaps(Input=slab_medium(tau, albedo, g, layers), PeriodicX=1, PeriodicY=1, **lit)
    solver.UpdatePipeline()
    seconds = []
    for run in range(runs):
        solver.Tolerance = 1e-4 * (1.0 + 1e-6 * (run + 1))  # a proxy whose properties are as before is not updated
        start = time.perf_counter()
        solver.UpdatePipeline()
        seconds.append(time.perf_counter() - start)
    facts = solver.GetClientSideObject().GetOutputDataObject(0).GetFieldData()
    balance, out = (vtk_to_numpy(facts.GetArray(name)) for name in ("energy_balance", "face_power_out"))
    return slab_row(DEFAULT, "%d layers" % layers, statistics.median(seconds), [out[face] / balance[0] for face in (5, 4)], truth)


def slab_row(method, setting, seconds, found, truth, **more):
    off = [is_ - should for is_, should in zip(found, truth)]
    return {"method": method, "setting": setting, "grid": "", "seconds": seconds, "error_reflectance": off[0],
            "error_transmittance": off[1], "error_max": max(map(abs, off)), "error_l2": math.hypot(*off) / math.hypot(*truth), **more}


def slab_truths(quick):
    """Reflectance and transmittance by adding-doubling, by case: tau, albedo, g, light."""
    truths = {}
    for row in reference_rows("slab") + reference_rows("slab_forward"):
        tau, albedo, g = (float(row[name]) for name in ("tau", "omega", "g"))
        if tau in ((1.0,) if quick else (1.0, 10.0, 1000.0)) and albedo in (0.5, 0.9, 0.99, 1.0) and g in (0.0, 0.85):
            for light in ("diffuse", "mu05"):
                truths[tau, albedo, g, light] = float(row["R_" + light]), float(row["T_" + light])
    return dict(itertools.islice(truths.items(), 2)) if quick else truths


def slabs(folder, quick):
    truths = slab_truths(quick)
    asked = [(case, streams) for case in truths for streams in STREAMS]
    words = "".join("%g %g %g %s %d\n" % (*case, streams) for case, streams in asked)
    rows = [(case, own_slab(case, truth, layers, 1 if quick else 7)) for case, truth in truths.items()
            for layers in ((64,) if quick else (1, 64))]
    for line in ask("slab_peers.py", folder, quick, words=words):
        program, version, number, *found, seconds = line.split()
        case, streams = asked[int(number)]
        rows.append((case, slab_row(program, "%d streams" % streams, float(seconds), [float(each) for each in found], truths[case],
                                    version=version)))
    ours = {case: row["seconds"] for case, row in rows if row["method"] == DEFAULT}
    for case, row in rows:
        print_row(case="slab, tau %g, albedo %g, g %g, %s" % case, against=DEFAULT, ratio=row["seconds"] / ours[case], **row)
    print_slabs(rows)


def print_slabs(rows):
    groups = collections.defaultdict(list)
    for (_, _, g, light), row in rows:
        groups[g, light, row["method"], row["setting"]].append(row)
    print("\n%-6s %-8s %-24s %-12s %6s %12s %12s %12s" % (
        "g", "light", "method", "setting", "cases", "median s", "median error", "worst error"))
    for (g, light, method, setting), of in sorted(groups.items()):
        wrong = [row["error_max"] for row in of]
        print("%-6g %-8s %-24s %-12s %6d %12.2g %12.1e %12.1e" % (
            g, light, method, setting, len(of), statistics.median(row["seconds"] for row in of), statistics.median(wrong), max(wrong)))
    print("Errors: the larger of those of reflectance and transmittance, over what came in", flush=True)


def main():
    scenes = {"slabs": slabs, **{name: functools.partial(cube, name) for name in SCENES}}
    parser = argparse.ArgumentParser()
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=", ".join(scenes))
    parser.add_argument("--environment", metavar="FOLDER", default=os.path.join(root, "build", "release", "peers"))
    parser.add_argument("--quick", action="store_true", default="TYNDALL_BENCH_QUICK" in os.environ)
    arguments = parser.parse_args()
    unknown = [name for name in arguments.scenes if name not in scenes]
    if unknown:
        parser.error("there is no scene %s; there are %s" % (unknown[0], ", ".join(scenes)))
    eat.load()
    for name in arguments.scenes or (list(scenes)[:2] if arguments.quick else scenes):
        scenes[name](arguments.environment, arguments.quick)


if __name__ == "__main__":
    main()
