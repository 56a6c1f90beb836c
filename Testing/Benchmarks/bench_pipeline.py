"""What a ParaView user waits for beside the kernels, filter by filter.    ./run bench pipeline [FILTER...] [adaptive] [--grid 128] [--repeats 7] [--scenes ball ring] [--quick]

Through proxies, as a user does it: something changes, the filter's proxy is updated, and ParaView gathers what its panels show of
the output (GetDataInformation of every port: ranges of all components). `seconds` is the wall time of both, `kernel_seconds` what the
filter says that its kernels took in the same update (the property Seconds: wall time within Kernels/, the device's queue finished; of
maps and ordinates up to the end of the last iteration; of the ray caster that of casting rays and reading the picture), `ratio` the median of
their quotients. Inputs are up to date, and so are ranges of their arrays; programs are compiled. ParticipatingMedium runs no kernels.

`adaptive`: photons sent where they are needed against photons spread evenly, at equal error (of 122000 even ones), on the three scenes
of measurements.md and on two more. A lamp moves, and the chain behind it is brought up to date with the information of every proxy
in it; the medium is on the device. The two chains run in turns. TYNDALL_BENCH_QUICK: small grids, few seconds.
"""
import argparse
import json
import math
import os
import statistics
import sys
import time

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

here = os.path.dirname(os.path.abspath(__file__))
root = os.path.dirname(os.path.dirname(here))
LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())

RATIO_GOAL, CASTER_GOAL, ADAPTIVE_GOAL = 1.4, 1.3, 0.7


def report(**values):
    print(json.dumps({"bench": "pipeline", **values}), flush=True)


def bring_up_to_date(proxy):
    """Update, and what panels ask of the output."""
    proxy.UpdatePipeline()
    for port in range(proxy.SMProxy.GetNumberOfOutputPorts()):
        proxy.GetDataInformation(port).GetPointDataInformation()


def known_seconds(proxy):
    proxy.UpdatePipelineInformation()
    return proxy.GetPropertyValue("Seconds") if proxy.GetProperty("Seconds") else None


class Bench:
    def __init__(self, grid, repeats, scenes=None):
        self.grid, self.repeats, self.scenes = grid, repeats, scenes

    def report_filter(self, name, proxy, change, goal=RATIO_GOAL, **more):
        """Bring the proxy up to date again and again, after change(number of the time)."""
        walls, kernels, ratios = [], [], []
        for i in range(-2, self.repeats):
            change(i)
            begin = time.perf_counter()
            bring_up_to_date(proxy)
            wall = time.perf_counter() - begin
            kernel = known_seconds(proxy)
            if i >= 0:
                walls.append(wall)
                if kernel:
                    kernels.append(kernel)
                    ratios.append(wall / kernel)
        row = {"seconds": statistics.median(walls)}
        if kernels:
            row.update(kernel_seconds=statistics.median(kernels), ratio=statistics.median(ratios), goal=goal,
                       met=statistics.median(ratios) <= goal)
        report(case=name, method="proxy", grid="%dx%dx%d" % ((self.grid,) * 3), repeats=self.repeats, **row, **more)


def setter(proxy, name, value):
    """A change of a property that asks for the whole work again and changes next to nothing of it."""
    def change(i):
        setattr(proxy, name, value(i))
    return change


def cloud(bench):
    """A density with colour, as a user has it."""
    n = bench.grid // 2
    box = Wavelet(WholeExtent=[-n, n] * 3, Maximum=1, XMag=0.13, YMag=0.11, ZMag=0.14, XFreq=17, YFreq=13, ZFreq=19, StandardDeviation=0.3)
    water = Calculator(Input=box, ResultArrayName="density", Function="max(0,RTData-0.5)")
    medium = ParticipatingMedium(Input=PointDatatoCellData(Input=water), Albedo=[0.99, 0.97, 0.9], MaximumDensity=1, ExtinctionScale=8.0 / bench.grid)
    bring_up_to_date(medium)
    return medium


def glass(bench, mesh=None, lamp=None, scattering=0.02, **more):
    mesh = mesh or Sphere(Radius=0.5, ThetaResolution=160, PhiResolution=160)
    mesh.UpdatePipeline()
    bounds = mesh.GetDataInformation().GetBounds()
    edge = 2.0 * max(bounds[2 * a + 1] - bounds[2 * a] for a in range(3))
    middle = [0.5 * (bounds[2 * a + 1] + bounds[2 * a]) for a in range(3)]
    box = [middle[a] + side * edge / 2 for a in range(3) for side in (-1, 1)]
    medium = MeshVoxelizer(Input=mesh, ModelBounds=box, SampleDimensions=[bench.grid] * 3, InsideIndex=1.5, InsideScattering=[scattering] * 3,
                           OutsideScattering=[0.8 / edge] * 3, OutsideAbsorption=[0.1 / edge] * 3, **more)
    octree = RefractionOctree(Input=medium)
    bring_up_to_date(octree)
    place = [middle[a] + offset * edge for a, offset in enumerate(lamp or (0.35, 0.2, 1.5))]
    rig = LightRig(Sun=0, PointLights=place + [100.0] * 3)
    bring_up_to_date(rig)
    return medium, octree, rig, place


def participating_medium(bench):
    medium = cloud(bench)
    bench.report_filter("ParticipatingMedium", medium, setter(medium, "ExtinctionScale", lambda i: (8.0 + 1e-4 * i) / bench.grid))


def solver(bench, make, name):
    sun = LightRig(SunElevation=50, SunAzimuth=130, SunPower=[3, 2.8, 2.5])
    proxy = make(Input=cloud(bench), Lights=sun, SkyColor=[0.1, 0.15, 0.2], MaximumOrders=3)
    bench.report_filter(name, proxy, setter(proxy, "SkyColor", lambda i: [0.1, 0.15, 0.2 + 1e-4 * i]))


def maps(bench):
    solver(bench, LightPropagationMaps, "LightPropagationMaps")


def ordinates(bench):
    solver(bench, DiscreteOrdinates, "DiscreteOrdinates")


def lattice(bench):
    solver(bench, LatticeBoltzmannLighting, "LatticeBoltzmannLighting")


def caster(bench):
    sun = LightRig(SunElevation=50, SunAzimuth=130, SunPower=[3, 2.8, 2.5])
    light = LightPropagationMaps(Input=cloud(bench), Lights=sun, SkyColor=[0.1, 0.15, 0.2], MaximumOrders=3)
    bring_up_to_date(light)
    size = [800, 600] if bench.grid >= 64 else [80, 60]
    n = float(bench.grid)
    picture = MediumRayCaster(Input=light, Lights=sun, ImageSize=size, CameraViewAngle=24)
    bench.report_filter("MediumRayCaster", picture, setter(picture, "CameraPosition", lambda i: [n + 0.01 * n * i, -2.0 * n, 0.9 * n]),
                        goal=CASTER_GOAL, picture="%dx%d" % tuple(size))


def voxelizer(bench):
    medium = glass(bench)[0]
    bench.report_filter("MeshVoxelizer", medium, setter(medium, "InsideIndex", lambda i: 1.5 + 1e-4 * i))


def octree(bench):
    tree = glass(bench)[1]
    bench.report_filter("RefractionOctree", tree, setter(tree, "Tolerance", lambda i: 0.01 + 1e-6 * i))


def photons(bench):
    """Both chains, a filter after the other; each is changed alone."""
    medium, tree, rig, _ = glass(bench)
    count = 122000 if bench.grid >= 64 else 2000
    importance = PhotonImportance(Input=tree, Lights=rig)
    bench.report_filter("PhotonImportance", importance, setter(importance, "Seed", lambda i: i + 5))
    for name, map_ in (("", {}), (", adaptive", {"ImportanceMap": OutputPort(importance, 0)})):
        photons_of = count * 2 // 5 if map_ else count
        emitter = PhotonEmitter(Input=medium, Lights=rig, PhotonCount=photons_of, **map_)
        bench.report_filter("PhotonEmitter" + name, emitter, setter(emitter, "Seed", lambda i: i + 5), photons=photons_of)
        marcher = PhotonMarcher(Input=medium, Photons=emitter, Octree=tree)

        def other_photons(i):
            emitter.Seed = i + 50
            bring_up_to_date(emitter)

        bench.report_filter("PhotonMarcher" + name, marcher, other_photons, photons=photons_of)
    rebuilt = PhotonReconstruction(Input=marcher)

    def other_light(i):
        other_photons(i)
        bring_up_to_date(marcher)

    bench.report_filter("PhotonReconstruction", rebuilt, other_light, photons=photons_of)


class Chain:
    """Photons of a lamp to their light, even or adaptive."""

    def __init__(self, scene, adaptive, count):
        self.medium, self.tree, self.rig, self.place = scene
        self.importance = PhotonImportance(Input=self.tree, Lights=self.rig) if adaptive else None
        map_ = {"ImportanceMap": OutputPort(self.importance, 0)} if adaptive else {}
        self.emitter = PhotonEmitter(Input=self.medium, Lights=self.rig, PhotonCount=1, **map_)
        self.marcher = PhotonMarcher(Input=self.medium, Photons=self.emitter, Octree=self.tree)
        self.proxies = [self.importance] if adaptive else []
        self.proxies += [self.emitter, self.marcher] + ([PhotonReconstruction(Input=self.marcher)] if adaptive else [])
        self.send(count)

    def send(self, count):
        self.count = count
        if self.importance:
            self.importance.PilotCount = min(1024, max(count // 10, 1))
            count -= self.importance.PilotCount
        self.emitter.PhotonCount = count

    def update(self):
        """Seconds of the whole chain."""
        begin = time.perf_counter()
        for proxy in self.proxies:
            bring_up_to_date(proxy)
        return time.perf_counter() - begin

    def move_lamp(self, i):
        """By next to nothing."""
        place = list(self.place)
        place[0] += 1e-7 * (i + 1)
        self.rig.PointLights = place + [100.0] * 3
        bring_up_to_date(self.rig)

    def error(self, reference):
        return numpy.linalg.norm(self.fluence() - reference) / numpy.linalg.norm(reference)

    def fluence(self):
        data = self.proxies[-1].GetClientSideObject().GetOutputDataObject(0)
        return vtk_to_numpy(data.GetCellData().GetArray("fluence")).astype(float)


def count_for(chain, wanted, reference, most):
    """Photons with which a chain has that error; None: not with `most`."""
    before, count = None, max(most // 64, 200)
    while count <= most:
        chain.send(count)
        chain.update()
        error = chain.error(reference)
        if error <= wanted:
            if before is None:
                return count, error
            part = math.log(before[1] / wanted) / math.log(before[1] / error)
            count = int(before[0] * (count / before[0]) ** part)
            chain.send(count)
            chain.update()
            return count, chain.error(reference)
        before, count = (count, error), int(1.5 * count)
    return None, before[1]


def adaptive(bench):
    """Two scenes that no setting was tuned on: a ring under a lamp from the side, and a cone."""
    armadillo = os.path.join(root, "build", "data", "armadillo.ply")
    scenes = {
        "ball": lambda: glass(bench),
        "perturbed cube": lambda: glass(bench, Box(XLength=0.8, YLength=0.8, ZLength=0.8), scattering=0.8, IndexNoise=0.05, ScatteringNoise=0.8, NoiseSize=0.1),
        "armadillo": lambda: glass(bench, PLYReader(FileNames=[armadillo])) if os.path.exists(armadillo) else None,
        "ring": lambda: glass(bench, Superquadric(Toroidal=1, ThetaResolution=64, PhiResolution=64, Size=0.5), lamp=(-0.9, 0.3, 1.1)),
        "cone": lambda: glass(bench, Cone(Resolution=96, Height=1.0, Radius=0.4), lamp=(0.2, -1.4, 0.5)),
    }
    even_count, rich_count = (122000, 6000000) if bench.grid >= 64 else (2000, 50000)
    for name, make in scenes.items():
        if bench.scenes and name not in bench.scenes:
            continue
        scene = make()
        if scene is None:
            print("%s is not there (./run bench fetches it): left out" % name)
            continue
        even = Chain(scene, False, rich_count)
        even.update()
        reference = even.fluence()
        even.send(even_count)
        even.update()
        wanted = even.error(reference)
        chain = Chain(scene, True, 1)
        count, error = count_for(chain, wanted, reference, even_count)
        row = {"case": name, "grid": "%dx%dx%d" % ((bench.grid,) * 3), "against": "even photons", "error_l2": error, "error_even": wanted}
        if count is None:
            report(method="adaptive photons", seconds=None, met=False, **row)
            continue
        walls = ([], [])
        for i in range(-1, bench.repeats):
            for ways, one in zip(walls, (chain, even)):
                one.move_lamp(2 * i + (one is even))
                seconds = one.update()
                if i >= 0:
                    ways.append(seconds)
        ratio = statistics.median(a / b for a, b in zip(*walls))
        report(method="adaptive photons", photons=count, photons_even=even_count, seconds=statistics.median(walls[0]),
               seconds_even=statistics.median(walls[1]), ratio=ratio, goal=ADAPTIVE_GOAL, met=ratio <= ADAPTIVE_GOAL, **row)
        for proxy in chain.proxies[::-1] + even.proxies[::-1]:
            Delete(proxy)


def main():
    parts = {"medium": participating_medium, "maps": maps, "ordinates": ordinates, "lattice": lattice, "caster": caster,
             "voxelizer": voxelizer, "octree": octree, "photons": photons, "adaptive": adaptive}
    parser = argparse.ArgumentParser()
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(parts))
    parser.add_argument("--grid", type=int)
    parser.add_argument("--repeats", type=int)
    parser.add_argument("--scenes", nargs="+", help="of adaptive: by their names")
    parser.add_argument("--quick", action="store_true", default="TYNDALL_BENCH_QUICK" in os.environ)
    arguments = parser.parse_args()
    unknown = [name for name in arguments.parts if name not in parts]
    if unknown:
        parser.error("there is no part %s; there are %s" % (unknown[0], ", ".join(parts)))
    bench = Bench(arguments.grid or (16 if arguments.quick else 128), arguments.repeats or (2 if arguments.quick else 7), arguments.scenes)
    for name in arguments.parts or parts:
        parts[name](bench)


if __name__ == "__main__":
    main()
