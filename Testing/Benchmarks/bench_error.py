"""Error against run time of every solver, scene by scene.    ./run bench error [SCENE...] [--output FOLDER] [--references FOLDER] [--patience 1] [--quick]

Scenes: slabs and cubes with trusted reference values, Kobayashi's void and shield, the CT scan under a photographed sky and a thick cloud
against converged runs, the caustic of a glass ball, forward scattering (a cloud and tissue) and Rayleigh scattering against Monte Carlo,
and pictures. Prints a JSON line a method and setting; writes FOLDER/error.csv and
FOLDER/error-SCENE.png; and ends with what the default gains over the method as published at equal error, and with a table of what to use
when. TYNDALL_BENCH_QUICK: small grids, few seconds.
"""
import argparse
import csv
import json
import math
import os
import sys

import numpy

here = os.path.dirname(os.path.abspath(__file__))
root = os.path.dirname(os.path.dirname(here))
sys.path.insert(0, os.path.join(root, "Plugin", "Examples"))
sys.dont_write_bytecode = True
import error_against_time as eat  # noqa: E402

from paraview import servermanager  # noqa: E402
from paraview.simple import ImageReader, ResampleToImage, Sphere, TrivialProducer, XMLImageDataReader  # noqa: E402
from paraview.vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy  # noqa: E402
from paraview.vtk.vtkCommonCore import vtkStringArray  # noqa: E402
from paraview.vtk.vtkCommonDataModel import vtkImageData  # noqa: E402

DEFAULT, PLAIN, PUBLISHED = "light propagation maps", "constant source, not accelerated", "as published"
PROPAGATION = (DEFAULT, PLAIN, PUBLISHED)
MONTE_CARLO, LATTICE, ORDINATES, CHAIN = "Monte Carlo", "lattice Boltzmann", "discrete ordinates", "photons, then maps"
FIELDS = PROPAGATION + (ORDINATES, LATTICE)
EXACT = {"DirectionsPerFace": 400, "MapResolution": 2, "EmissionError": 0.005}


def reference_rows(name):
    with open(os.path.join(root, "Data", "Reference", name + ".csv")) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def image(arrays, length, size, phase=None, g=0.0):
    """A source of an image of the box from 0 to `length`; arrays are [z][y][x] or numbers. phase: name of the phase function."""
    data = vtkImageData()
    data.SetDimensions(*(n + 1 for n in size))
    data.SetSpacing(*(l / n for l, n in zip(length, size)))
    for name, values in arrays.items():
        full = numpy.broadcast_to(numpy.asarray(values, dtype=numpy.float32), size[::-1])
        array = numpy_to_vtk(numpy.ascontiguousarray(full).ravel(), deep=True)
        array.SetName(name)
        data.GetCellData().AddArray(array)
    if phase:
        name = vtkStringArray()
        name.SetName("phase_function")
        name.InsertNextValue(phase)
        data.GetFieldData().AddArray(name)
        cosine = numpy_to_vtk(numpy.array([g]), deep=True)
        cosine.SetName("g")
        data.GetFieldData().AddArray(cosine)
    source = TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    source.UpdatePipeline()
    return source


class Bench:
    """What all scenes share: where figures go, and whether there are but few seconds."""

    def __init__(self, quick, output, references=None, patience=1.0):
        self.quick, self.output, self.references, self.patience = quick, output, references, patience
        self.rows = []      # of all scenes, with `case`
        self.titles = {}    # of scenes, in their order
        self.errors = {}    # which column is the error of a scene; else error_l2

    def compare(self, methods, seconds, **settings):
        settings.setdefault("Directions", [4, 25] if self.quick else [4, 9, 25, 64, 100])
        settings.setdefault("MapResolutions", [1] if self.quick else [1, 2])
        settings.setdefault("Coarsenings", [1, 2] if self.quick else [1, 2, 4])
        settings.setdefault("Orders", [3] if self.quick else [1, 3, 10, 30, 100])
        settings.setdefault("Repeats", 1 if self.quick else 3)
        return eat.compare(methods, TimeBudget=min(seconds, 20.0) if self.quick else self.patience * seconds, **settings)

    def compare_converged(self, case, methods, seconds, **settings):
        """The same against a converged run, which may have been kept."""
        kept = os.path.join(self.references, case + ".vti") if self.references else None
        if kept and os.path.exists(kept):
            return self.compare(methods, 0.5 * seconds, Reference=XMLImageDataReader(FileName=[kept]), **settings)
        return self.compare(methods, seconds, save_reference=kept, **settings)

    def report(self, case, title, rows, facts, error="error_l2", error_title=None):
        """Print, plot and keep a scene's rows."""
        self.titles[case], self.errors[case] = title, error
        for row in rows:
            print(json.dumps({"bench": "error", "case": case, **eat.known(row)}), flush=True)
            self.rows.append({"case": case, **row})
        print("\n%s\nreference: %s" % (title, "; ".join(facts["reference"])))
        eat.print_table(rows, error)
        eat.print_left_out(facts["left_out"])
        print("", flush=True)
        eat.plot(rows, os.path.join(self.output, "error-%s.png" % case), title, error, error_title)

    def of(self, case, methods=None):
        """Rows of a scene that have an error, by error."""
        error = self.errors[case]
        return [row for row in self.rows if row["case"] == case and (methods is None or row["method"] in methods)
                and error in row and not math.isnan(row[error])]


def slabs(bench):
    """Diffuse light on one face; albedo 1. The error is that of the transmittance, relative; that of the reflectance is in the table."""
    known = {float(row["tau"]): row for row in reference_rows("slab")
             if float(row["omega"]) == 1.0 and float(row["g"]) == 0.0}
    extrapolation, = (float(row["q"]) for row in reference_rows("hopf") if row["tau"] == "inf")
    for thickness in (1.0, 1e4) if bench.quick else (0.01, 1.0, 100.0, 1e4, 1e6):
        if thickness in known:
            truth = {"T": float(known[thickness]["T_diffuse"]), "R": float(known[thickness]["R_diffuse"])}
        else:  # to 1e-6 above 10
            truth = {"T": 4.0 / (3.0 * (thickness + 2.0 * extrapolation))}
            truth["R"] = 1.0 - truth["T"]
        voxels = 32
        size, length = (1, 1, voxels), (1.0 / voxels, 1.0 / voxels, 1.0)
        rows, facts = bench.compare(
            FIELDS, 3.0 if bench.quick else 12.0, Input=image({"sigma_a": 0.0, "sigma_s": thickness}, length, size), PeriodicX=1, PeriodicY=1,
            Reference=image({"fluence": math.nan}, length, size), FaceRadiance=[0, 0, 0, 0, 1 / math.pi, 0],
            Orders=[10] if bench.quick else [10, 100, 1000], Repeats=1, EstimateError=0)
        for row in rows:
            for name, face in (("T", 5), ("R", 4)):
                row["error_" + name] = abs(row["face_power_out"][face] / row["power_in"] / truth[name] - 1.0)
        facts["reference"] = ["transmittance %.6g, reflectance %.6g" % (truth["T"], truth["R"])]
        bench.report("slab-%g" % thickness, "Slab of optical thickness %g, albedo 1, %d voxels" % (thickness, voxels), rows, facts,
                     "error_T", "Relative error of transmittance")


def cubes(bench):
    edge = 20 if bench.quick else 40
    for case, title, file, sigma, more, emission in (
            ("cube-diffuse", "Cube of optical thickness 1, albedo 0.9, diffuse light on a face", "cube_fluence_tau1_w0.9_g0_diffuse", 1.0,
             {"FaceRadiance": [0, 0, 0, 0, 1 / math.pi, 0]}, None),
            ("cube-emitting", "Emitting cube of optical thickness 5, albedo 0.9", "cube_fluence_tau5_w0.9_g0_volume", 5.0, {},
             1.0 / (4.0 * math.pi))):
        fluence, noise = numpy.zeros((10, 10, 10)), 0.0
        for row in reference_rows(file):
            fluence[int(row["iz"]), int(row["iy"]), int(row["ix"])] = float(row["phi"])
            noise += float(row["sigma"]) ** 2
        arrays = {"sigma_a": 0.1 * sigma, "sigma_s": 0.9 * sigma}
        if emission:
            arrays["emission"] = emission
        methods = FIELDS + (() if emission else (MONTE_CARLO,))  # photons are made of lights
        rows, facts = bench.compare(methods, 30.0, Input=image(arrays, (1, 1, 1), (edge,) * 3),
                                    Reference=image({"fluence": fluence}, (1, 1, 1), (10,) * 3), **more)
        facts["reference"] = ["Monte Carlo, 10 x 10 x 10 voxels, itself off by %.2g" % (math.sqrt(noise) / numpy.linalg.norm(fluence))]
        bench.report(case, title, rows, facts)


def kobayashi_medium(voxels, scattering):
    """The box of 200 cm with the source in its middle: mirrored, so that no face has to reflect."""
    far = numpy.abs(-100.0 + 200.0 / voxels * (numpy.arange(voxels) + 0.5))
    farthest = numpy.maximum(numpy.maximum(far[:, None, None], far[None, :, None]), far[None, None, :])
    sigma = numpy.where(farthest < 10.0, 0.1, numpy.where(farthest < 50.0, 1e-4, 0.1))
    emission = numpy.where(farthest < 10.0, 1.0 / (4.0 * math.pi), 0.0)
    return image({"sigma_a": (1.0 - scattering) * sigma, "sigma_s": scattering * sigma, "emission": emission}, (200.0,) * 3, (voxels,) * 3)


def kobayashi(bench):
    """Point values, far from the source 1e-6 of those in it: the error is the root of the mean square of the points' relative errors."""
    voxels = 20 if bench.quick else 60
    for case, scattering, column in (("kobayashi-absorber", 0.0, "own_i"), ("kobayashi-scattering", 0.5, "pub_ii")):
        reference = numpy.full((voxels,) * 3, math.nan)
        points = {}
        for row in reference_rows("kobayashi_problem1"):
            place = tuple(float(row[axis]) for axis in "xyz")
            i, j, k = (int((100.0 + x) * voxels / 200.0) for x in place)
            reference[k, j, i] = float(row[column])
            points[place] = float(row[column])
        medium = kobayashi_medium(voxels, scattering)
        rows, facts = bench.compare(FIELDS, 70.0, Input=medium, Reference=image({"fluence": reference}, (200.0,) * 3, (voxels,) * 3),
                                    Coarsenings=[1] if bench.quick else [1, 3], Orders=[], MapResolutions=[1],
                                    Directions=[4, 25] if bench.quick else [25, 100])
        facts["reference"] = ["Kobayashi et al. 2001, problem 1, %d points" % len(points)]
        bench.report(case, "Kobayashi's void and shield, %s, voxels of %.2g cm" % (
            "absorber" if scattering == 0.0 else "half scattering", 200.0 / voxels), rows, facts, "error_relative",
            "Relative error of points (root mean square)")
        print_points(points, medium, voxels)


def print_points(points, medium, voxels):
    """Errors point by point, of voxels against points: the default, with settings that do for one percent, and as published."""
    light = {}
    for name, settings in (("default, 25", {}), ("default, 100", {"DirectionsPerFace": 100}), ("400, exact rays", EXACT), ("published, 25", {"Scheme": "As published"})):
        solved = eat.LightPropagationMaps(Input=medium, **settings)
        light[name] = vtk_to_numpy(servermanager.Fetch(solved).GetCellData().GetArray("fluence")).reshape((voxels,) * 3)
    print("%-16s %12s" % ("point, cm", "reference") + "".join(" %14s" % name for name in light))
    for place, value in points.items():
        i, j, k = (int((100.0 + x) * voxels / 200.0) for x in place)
        print("%-16s %12.5g" % ("%g %g %g" % place, value) + "".join(" %13.2f%%" % (100.0 * (of[k, j, i] / value - 1.0)) for of in light.values()))
    print("", flush=True)


def scan(bench):
    """The demo's scene: a skull under a photographed sky and a low sun."""
    data = os.path.join(root, "build", "data")
    path = os.path.join(data, "skull_2.9.inr")
    if not os.path.exists(path):
        print("The CT scan is not there (./run bench fetches it): left out")
        return
    header = dict(line.split("=", 1) for line in open(path, "rb").read(256).decode("latin-1").split("\n") if "=" in line)
    extent = [value for axis in "XYZ" for value in (0, int(header[axis + "DIM"]) - 1)]
    skull = ImageReader(FileNames=[path], DataScalarType="float", DataByteOrder="LittleEndian", FileDimensionality=3,
                        ScalarArrayName="density", DataExtent=extent, DataSpacing=[float(header["V" + axis]) for axis in "XYZ"])
    edge = 16 if bench.quick else 52
    resampled = ResampleToImage(Input=skull, UseInputBounds=1, SamplingDimensions=[edge + 1] * 3)
    bone = eat.ParticipatingMedium(Input=resampled, MinimumDensity=1.9, MaximumDensity=3.5, ExtinctionScale=0.3, Albedo=[0.93, 0.87, 0.76])
    sky = eat.EnvironmentReader(FileName=os.path.join(data, "sunset.exr"))
    sun = eat.LightRig(SunElevation=30, SunAzimuth=130, SunPower=[34, 26, 17])
    rows, facts = bench.compare_converged("ct-scan", FIELDS + ("photons", MONTE_CARLO), 200.0, Input=bone, Lights=sun, Environment=sky,
                                **({} if bench.quick else {"Directions": [4, 25, 100], "Orders": [1, 3, 10]}))
    bench.report("ct-scan", "CT scan under a sky, %d voxels an edge" % edge, rows, facts)


def lognormal(edge, rng):
    """A field of mean 1 whose logarithm is smooth and has standard deviation 1."""
    waves = numpy.fft.fftfreq(edge) * edge
    square = waves[:, None, None] ** 2 + waves[None, :, None] ** 2 + waves[None, None, :] ** 2
    spectrum = numpy.fft.fftn(rng.standard_normal((edge,) * 3)) / (1.0 + square) ** (11.0 / 12.0)
    spectrum[0, 0, 0] = 0.0
    field = numpy.fft.ifftn(spectrum).real
    field = numpy.exp(field / field.std())
    return field / field.mean()


def cloud(bench):
    edge = 16 if bench.quick else 48
    extinction = 100.0 * lognormal(edge, numpy.random.default_rng(5))
    medium = image({"sigma_a": 1e-4 * extinction, "sigma_s": (1.0 - 1e-4) * extinction}, (1, 1, 1), (edge,) * 3)
    sun = eat.LightRig(SunElevation=50, SunAzimuth=130, SunPower=[3, 3, 3])
    rows, facts = bench.compare_converged("thick-cloud", FIELDS + (MONTE_CARLO,), 5.0 if bench.quick else 150.0, Input=medium, Lights=sun, SkyColor=[0.2, 0.2, 0.2],
                                Orders=[3] if bench.quick else [10, 30, 100, 300, 1000])
    bench.report("thick-cloud", "Log-normal cloud of optical thickness 100, albedo 0.9999, %d voxels an edge" % edge, rows, facts)


def caustic(bench):
    edge = 16 if bench.quick else 64
    ball = Sphere(Radius=0.5, ThetaResolution=160, PhiResolution=160)
    glass = eat.MeshVoxelizer(Input=ball, ModelBounds=[-1, 1, -1, 1, -0.6, 1.4], SampleDimensions=[edge] * 3, InsideIndex=1.5,
                              InsideScattering=[0.02] * 3, OutsideScattering=[0.35] * 3, OutsideAbsorption=[0.03] * 3)
    octree = eat.RefractionOctree(Input=glass)
    lamp = eat.LightRig(Sun=0, PointLights=[0.9, 1.1, 3.6, 110, 110, 110])
    rows, facts = bench.compare_converged("glass-ball", ("photons", "adaptive photons", "photons as published", MONTE_CARLO, LATTICE, CHAIN), 90.0, Input=octree, Lights=lamp, AllSamplers=1,
                                StepSizes=[0.5, 2], IntegratorOrders=[2, 4], OctreeTolerances=[0.01, 0.1],
                                PhotonCounts=[1000, 10000] if bench.quick else [10000, 30000, 100000, 300000, 1000000])
    bench.report("glass-ball", "Caustic of a glass ball, %d voxels an edge" % edge, rows, facts)


def scattering(bench):
    """A cloud (g 0.85), tissue (g 0.9) and air (Rayleigh), all solvers, against Monte Carlo."""
    edge = 12 if bench.quick else 32
    cloudy = lognormal(edge, numpy.random.default_rng(7))
    for case, title, sigma, albedo, phase, g in (
            ("forward-cloud", "Cloud of optical thickness 20, g 0.85", 20.0 * cloudy, 0.999, "henyey_greenstein", 0.85),
            ("tissue", "Tissue of optical thickness 50, g 0.9, albedo 0.99", 50.0, 0.99, "henyey_greenstein", 0.9),
            ("rayleigh", "Rayleigh scattering, optical thickness 1, albedo 1", 1.0, 1.0, "rayleigh", 0.0)):
        medium = image({"sigma_a": (1.0 - albedo) * sigma, "sigma_s": albedo * sigma}, (1, 1, 1), (edge,) * 3, phase, g)
        sun = eat.LightRig(SunElevation=50, SunAzimuth=130, SunPower=[3, 3, 3])
        rows, facts = bench.compare_converged(case, FIELDS + (MONTE_CARLO,), 90.0, Input=medium, Lights=sun, MonteCarloReference=1,
                                              Directions=[4, 25] if bench.quick else [4, 9, 25, 64], Orders=[], MapResolutions=[1], Terms=[4, 9, 16], Previews=1,
                                              PhotonCounts=[10000] if bench.quick else [10000, 100000, 1000000])
        bench.report(case, "%s, %d voxels an edge" % (title, edge), rows, facts)


def pictures(bench):
    """Qualities of pictures of a cloud."""
    edge = 16 if bench.quick else 64
    extinction = 30.0 * lognormal(edge, numpy.random.default_rng(5))
    medium = image({"sigma_a": 1e-3 * extinction, "sigma_s": extinction}, (1, 1, 1), (edge,) * 3)
    sun = eat.LightRig(SunElevation=50, SunAzimuth=130, SunPower=[3, 3, 3])
    rows, facts = bench.compare_converged("pictures", ("picture",), 60.0, Input=medium, Lights=sun, MonteCarloReference=0, ImageSize=[800, 600],
                                          CameraPosition=[2.5, -2, 1.5], CameraFocalPoint=[0.5, 0.5, 0.5])
    bench.report("pictures", "Pictures of a cloud, %d voxels an edge, 800 x 600 pixels" % edge, rows, facts, error_title="Relative error of radiance (L2)")


def percent(error):
    return "%.2g%%" % (100.0 * error)


def print_speedups(bench):
    """Time that the default and the method as published need for the same error."""
    for case in ("ct-scan", "thick-cloud"):
        ours, theirs = (bench.of(case, (method,)) for method in (DEFAULT, PUBLISHED)) if case in bench.titles else ((), ())
        if not ours or not theirs:
            continue
        ends = min(theirs, key=lambda row: row["error_l2"])
        print("\nEqual-error speed-up of the default over 'as published': " + bench.titles[case])
        for target in sorted((0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, ends["error_l2"]), reverse=True):
            fast, slow = (eat.seconds_for(rows, target) for rows in (ours, theirs))
            if math.isnan(fast):
                least = min(ours, key=lambda row: row["error_l2"])
                print("  error %7s: not with these settings; the default ends at %s after %.3g s" % (
                    percent(target), percent(least["error_l2"]), least["seconds"]))
                break
            if math.isnan(slow):
                print("  error %7s: default %8.3g s, as published never: it ends at %s after %.3g s" % (
                    percent(target), fast, percent(ends["error_l2"]), ends["seconds"]))
            else:
                print("  error %7s: default %8.3g s, as published %8.3g s: %.3g times" % (percent(target), fast, slow, slow / fast))
                print(json.dumps({"bench": "error", "case": case, "method": DEFAULT, "against": PUBLISHED, "error_l2": target,
                                  "seconds": fast, "ratio": slow / fast}))


def print_advice(bench):
    """What to use when, in Markdown."""
    print("\n| scene | error 10% | 1% | 0.1% | best |\n|---|---|---|---|---|")
    for case, title in bench.titles.items():
        rows, error = bench.of(case), bench.errors[case]
        for quantity, (suffix, _) in eat.QUANTITIES.items():
            of = [row for row in rows if row["quantity"] == quantity]
            if not of:
                continue
            cells = []
            for target in eat.TARGETS:
                best = eat.fastest_for(of, target, error)
                cells.append("%s, %s: %.2g s" % (best["method"], best["setting"], best["seconds"]) if best else "none")
            least = min(of, key=lambda row: row[error])
            cells.append("%s, %s: %s in %.2g s" % (least["method"], least["setting"], percent(least[error]), least["seconds"]))
            print("| %s%s | %s |" % (title, suffix, " | ".join(cells)))
    print("", flush=True)


def main():
    scenes = {"slabs": slabs, "cubes": cubes, "kobayashi": kobayashi, "scan": scan, "cloud": cloud, "caustic": caustic,
              "scattering": scattering, "pictures": pictures}
    parser = argparse.ArgumentParser()
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=", ".join(scenes))
    parser.add_argument("--output", default=os.path.join(root, "build", "bench"))
    parser.add_argument("--references", metavar="FOLDER", help="keep converged runs there, and take those that are there")
    parser.add_argument("--patience", type=float, default=1.0, help="times the seconds that scenes may take")
    parser.add_argument("--quick", action="store_true", default="TYNDALL_BENCH_QUICK" in os.environ)
    arguments = parser.parse_args()
    unknown = [name for name in arguments.scenes if name not in scenes]
    if unknown:
        parser.error("there is no scene %s; there are %s" % (unknown[0], ", ".join(scenes)))
    eat.load()
    for folder in filter(None, (arguments.output, arguments.references)):
        os.makedirs(folder, exist_ok=True)
    bench = Bench(arguments.quick, arguments.output, arguments.references, arguments.patience)
    for name in arguments.scenes or scenes:
        scenes[name](bench)
    eat.write_csv(bench.rows, os.path.join(arguments.output, "error.csv"))
    print_speedups(bench)
    print_advice(bench)
    print("Plots and error.csv: " + arguments.output)


if __name__ == "__main__":
    main()
