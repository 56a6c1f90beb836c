"""Solves random scenes (random_scene.py) through proxies, and prints a line beginning with FINDING for each claim that one
of them breaks. RandomPipelines.py runs it.

    pvbatch random_pipelines.py FOLDER SEED COUNT SECONDS
    mpiexec -n N pvbatch --symmetric random_pipelines.py FOLDER SEED COUNT SECONDS

One rank solves scenes 0, 1, ... until there are COUNT of them or SECONDS have passed, and keeps their fluence. Several
ranks solve the same scenes, each its own piece, and keep the pieces.
"""
import os
import sys
import time

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkCellArray, vtkDoubleArray, vtkImageData, vtkIntArray, vtkPoints, vtkPolyData
from paraview.vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from pieces import errors_of, source_of
from random_scene import Scene, is_finite, scaled, with_few_digits

folder, seed, count, seconds = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4])
LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
module = servermanager.vtkProcessModule.GetProcessModule()
rank, ranks = module.GetPartitionId(), module.GetNumberOfLocalPartitions()

BALANCE, ABSORBED = 1e-4, 1e-4  # of the power that enters and is emitted
LINEAR, SUPERPOSED = 1e-6, 1e-3  # of the largest fluence
PHOTONS = 20000


def array_of(values, name):
    array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    array.SetName(name)
    return array


def image_of(scene, sources, extent):
    """The medium, with what it emits; cells of `extent` alone."""
    image = vtkImageData()
    if any(extent[2 * a + 1] <= extent[2 * a] for a in range(3)):
        return image
    image.SetExtent(extent)
    image.SetSpacing(*scene.spacing)
    image.SetOrigin(*scene.origin)
    own = tuple(slice(extent[2 * a], extent[2 * a + 1]) for a in (2, 1, 0))
    arrays = dict(scene.medium)
    for source in sources:
        if source["kind"] == "emission":
            arrays["emission"] = arrays.get("emission", 0) + source["values"]
    for name, values in arrays.items():
        image.GetCellData().AddArray(array_of(values[own].reshape(-1, values.shape[-1]).astype(numpy.float32), name))
    g = vtkDoubleArray()
    g.SetName("g")
    g.InsertNextValue(scene.g)
    image.GetFieldData().AddArray(g)
    return image


def lights_of(sources):
    lamps = [s for s in sources if s["kind"] == "lamp"]
    if not lamps:
        return None
    lights, points, vertices = vtkPolyData(), vtkPoints(), vtkCellArray()
    points.SetDataTypeToDouble()
    for i, lamp in enumerate(lamps):
        points.InsertNextPoint(lamp["position"])
        vertices.InsertNextCell(1, [i])
    lights.SetPoints(points)
    lights.SetVerts(vertices)
    for name in ("light_type", "direction", "power", "size", "angle"):
        values = numpy.array([lamp[name] for lamp in lamps], numpy.int32 if name == "light_type" else numpy.float64)
        lights.GetPointData().AddArray(array_of(values, name))
    return lights


def environment_of(sources):
    skies = [s["values"] for s in sources if s["kind"] == "environment"]
    if not skies:
        return None
    image = vtkImageData()
    image.SetDimensions(16, 8, 1)
    image.GetPointData().AddArray(array_of(sum(skies).reshape(-1, 3).astype(numpy.float32), "radiance"))
    return image


def incident_of(sources):
    """Properties for what shines on the medium, the same for every solver but FaceRadiance."""
    settings = {"SkyColor": [sum(s["values"][c] for s in sources if s["kind"] == "sky") for c in range(3)]}
    for name, data in (("Lights", lights_of(sources)), ("Environment", environment_of(sources))):
        if data:
            settings[name] = source_of(data)
    return settings


def solver_of(scene, sources, extent):
    """@return the proxies of the pipeline, the solver last"""
    medium = source_of(image_of(scene, sources, extent))
    incident = incident_of(sources)
    if scene.solver == "photons":
        emitter = PhotonEmitter(Input=medium, PhotonCount=PHOTONS, Seed=7, **incident)
        return [emitter, PhotonMarcher(Input=medium, Photons=emitter, MaximumOrders=0)]
    kind = {"maps": LightPropagationMaps, "ordinates": DiscreteOrdinates, "lattice": LatticeBoltzmannLighting}
    faces = [float(sum(s["values"][f] for s in sources if s["kind"] == "faces")) for f in range(6)]
    around = {"Periodic" + axis: int(p) for axis, p in zip("XYZ", scene.periodic)}
    return [kind[scene.solver](Input=medium, FaceRadiance=faces, FaceAlbedo=scene.face_albedo, DefaultSky=0,
                               Tolerance=1e-6, **incident, **around)]


class Light:
    """What a pipeline gives: arrays of the light as numpy has them, or the errors."""

    def __init__(self, scene, sources, extent):
        pipeline = solver_of(scene, sources, extent)
        errors = [errors_of(proxy) for proxy in pipeline]
        pipeline[-1].UpdatePipeline()
        self.errors = sum(errors, [])
        output = pipeline[-1].GetClientSideObject().GetOutputDataObject(0)
        self.there = output.GetNumberOfCells() > 0
        cells, facts = output.GetCellData(), output.GetFieldData()
        self.extent = output.GetExtent()
        if self.there:
            self.fluence = vtk_to_numpy(cells.GetArray("fluence")).astype(float).reshape(output.GetNumberOfCells(), -1)
            error = cells.GetArray("fluence_error")
            self.error = vtk_to_numpy(error).astype(float).reshape(self.fluence.shape) if error else 0 * self.fluence
            ghosts = cells.GetArray("vtkGhostType")
            self.own = vtk_to_numpy(ghosts) == 0 if ghosts else numpy.ones(len(self.fluence), bool)
            self.balance = vtk_to_numpy(facts.GetArray("energy_balance")).astype(float).reshape(5, -1)
        for proxy in pipeline:
            Delete(proxy)


def whole(scene):
    return [int(e) for n in scene.size for e in (0, n)]


class Claims:
    """What holds of one scene's light; each that does not is printed."""

    def __init__(self, scene):
        self.scene = scene

    def find(self, what):
        print("FINDING %s | %s" % (self.scene.describe(), what), flush=True)

    def below(self, what, found, limit):
        if not found <= limit:  # which is true of not a number, too
            self.find("%s: %.3g, at most %.0e is right" % (what, found, limit))

    def is_light(self, light):
        if light.errors or not light.there:
            self.find("an error, or no light: %s" % (" / ".join(light.errors)[:600] or "empty output"))
            return False
        if not is_finite(light.fluence) or light.fluence.min() < 0:
            self.find("fluence is not finite, or negative: %g" % light.fluence.min())
            return False
        return True

    def conserves(self, light):
        entered, emitted, absorbed, escaped, left = light.balance
        power = (entered + emitted).max()
        self.below("energy balance", abs(entered + emitted - absorbed - escaped - left).max(), BALANCE * power)
        sigma_a = self.scene.medium["sigma_a"].astype(numpy.float32).astype(float)
        sigma_a = sigma_a.reshape(len(light.fluence), -1)
        found = (sigma_a * light.fluence).sum(axis=0) * self.scene.spacing.prod()
        spread = 0.0
        if self.scene.solver == "photons":  # which count what they absorb by chance, and fluence by paths
            spread = 4 * (sigma_a * light.error).sum(axis=0).max() * self.scene.spacing.prod()
        self.below("absorbed against the sum of sigma_a fluence", abs(absorbed - found).max(), ABSORBED * power + spread)

    def differ(self, what, light, expected, limit, error=None):
        most = expected.max()
        if error is not None:  # of photons, in standard errors
            off = abs(light - expected).mean() / max(error.mean(), 1e-30 * most)
            self.below(what + ", in standard errors", off, 3.0)
        elif most > 0:
            self.below(what, abs(light - expected).max() / most, limit)


def check_alone(number):
    scene = Scene(seed, number)
    claims = Claims(scene)
    extent = whole(scene)
    light = Light(scene, scene.sources, extent)
    if not claims.is_light(light):
        return
    claims.conserves(light)
    again = Light(scene, scene.sources, extent)
    if claims.is_light(again) and not (again.fluence == light.fluence).all():
        claims.find("solved twice, the bits differ")
    factor = float(with_few_digits(scene.random.uniform(0.01, 100)))
    brighter = Light(scene, [scaled(s, factor) for s in scene.sources], extent)
    if claims.is_light(brighter):
        claims.differ("%g times the power" % factor, brighter.fluence / factor, light.fluence, LINEAR)
    if 0 < scene.split < len(scene.sources):
        parts = [Light(scene, part, extent) for part in (scene.sources[:scene.split], scene.sources[scene.split:])]
        if all([claims.is_light(part) for part in parts]):
            error = sum(part.error ** 2 for part in [light, *parts]) ** 0.5 if scene.solver == "photons" else None
            claims.differ("the sum of each part's light", parts[0].fluence + parts[1].fluence, light.fluence, SUPERPOSED, error)
    numpy.savez(os.path.join(folder, "%d.npz" % number), fluence=light.fluence)


def check_over_ranks(number):
    """Keeps this rank's piece."""
    scene = Scene(seed, number)
    light = Light(scene, scene.sources, scene.cuts(ranks)[rank])
    if light.errors:
        print("FINDING %s | on rank %d of %d: %s" % (scene.describe(), rank, ranks, light.errors[0][:600]), flush=True)
    kept = {"fluence": light.fluence, "extent": light.extent, "own": light.own} if light.there else {}
    numpy.savez(os.path.join(folder, "%d.%d.npz" % (number, rank)), **kept)


def time_is_left(begun):
    """The first rank's clock decides for all."""
    left = vtkIntArray()
    left.InsertNextValue(int(time.time() - begun < seconds))
    if ranks > 1:
        module.GetGlobalController().Broadcast(left, 0)
    return left.GetValue(0) == 1


begun, done = time.time(), 0
while done < count and time_is_left(begun):
    start = time.time()
    (check_alone if ranks == 1 else check_over_ranks)(done)
    if rank == 0:
        print("%.1f s for %s" % (time.time() - start, Scene(seed, done).describe()), flush=True)
    done += 1
if rank == 0:
    print("%d scenes of seed %d on %d ranks in %.0f s" % (done, seed, ranks, time.time() - begun), flush=True)
    with open(os.path.join(folder, "done.%d" % ranks), "w") as file:
        file.write(str(done))
