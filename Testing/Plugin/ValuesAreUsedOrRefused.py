"""Every number of every proxy, at the ends of the range that its XML says and beyond: never replaced in silence by another
value. What is beyond is refused with one error that names the property, and empty outputs, and a value in the range heals it; the
ends are taken."""
import glob
import math
import os
import struct
import xml.etree.ElementTree as ElementTree

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkImageData
import numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
folder = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "values_are_used_or_refused")
os.makedirs(folder, exist_ok=True)
window = vtkOutputWindow.GetInstance()  # Python prints there, too

# Where filters can do more than panels offer, on which side: "below", "above" or both. NaN and infinity are refused there, too.
WIDER = {
    "EnvironmentAzimuth": "below above",  # any angle
    "SunAzimuth": "below above",
    "LPMPropagate.MapResolution": "above",  # to 16
    "StoredDirections": "above",
    "SpotLight.Angle": "below",  # above 0
    "PhotonMarcher.StepSize": "above",  # to 1e4
    "CameraViewAngle": "below above",  # within (0, 180)
    "MediumRayCaster.StepSize": "below above",
    "MediumRayCaster.SurfaceIndex": "above",
    "InsideIndex": "below above",
    "OutsideIndex": "below above",
    "MeanCosine": "below above",  # within (-1, 1)
    "SecondMeanCosine": "below above",
    "InsideMeanCosine": "below above",
    "OutsideMeanCosine": "below above",
    "OutsideScattering": "below",  # automatic
    "IndexNoise": "above",  # less than the index
    "FilterSize": "above",
    "SupersamplingFactor": "above",
    "PilotCount": "above",
    "TimeBudget": "below",
    "UncollidedDirections": "above",  # any square number
    "AngularDegree": "above",  # to 15
    "PhotonImportance.Background": "below",  # above 0
    "DiscreteOrdinates.Terms": "above",  # to as many as there are directions
    "DiscreteOrdinates.SpiralDirections": "above",
}
# The ends of what only says how a slider goes, or need something else set with them.
AT_THE_END = {
    "ShapeSize", "Size",  # above 0
    "PilotCount",  # a million photons
    "TableColor", "TableReflectance",  # both together are at most 1
    "TimeBudget",  # no time for a row
    "PhaseFunction",  # the last one needs a table
    "Terms",  # as many as there are directions at most
}

faults = []
keep = []


def image(cells=4, **arrays):
    data = vtkImageData()
    data.SetDimensions(cells + 1, cells + 1, cells + 1)
    for name, value in arrays.items():
        values = numpy_to_vtk(numpy.full(cells**3, value, dtype=numpy.float32), deep=1)
        values.SetName(name)
        data.GetCellData().AddArray(values)
    producer = TrivialProducer()
    producer.GetClientSideObject().SetOutput(data)
    keep.append(data)
    return producer


def write_picture(path):
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n")
        file.write(struct.pack("4B", 128, 128, 128, 129) * 8)
    return path


def photons(medium):
    return PhotonEmitter(Input=medium, Lights=LightRig(), PhotonCount=200, Batches=2)


medium = image(sigma_a=0.1, sigma_s=0.2, ior=1.0, density=0.5)
bends = image(sigma_a=0.1, sigma_s=0.2, ior=1.0)
bent = bends.GetClientSideObject().GetOutputDataObject(0).GetCellData().GetArray("ior")
for i in range(bent.GetNumberOfTuples()):
    bent.SetTuple1(i, 1.0 + 0.01 * (i % 4))
picture = write_picture(os.path.join(folder, "picture.hdr"))
stored = os.path.join(folder, "stored.vdb")
SaveData(stored, proxy=medium)


def comparison():
    reference = LightPropagationMaps(Input=medium, Lights=LightRig())
    made = SolverComparison(Input=medium, Lights=LightRig(), Reference=reference, Directions=[4], MapResolutions=[1],
                            Coarsenings=[1], Orders=[1], PhotonCounts=[100], ConstantSource=0, AsPublished=0, Photons=0,
                            EstimateError=0, Repeats=1)
    return made


# A proxy of each kind, ready to work.
SCENES = {
    "DiscreteOrdinates": lambda: DiscreteOrdinates(Input=medium, Lights=LightRig(), Terms=4),
    "EnvironmentReader": lambda: EnvironmentReader(FileName=picture),
    "LatticeBoltzmannLighting": lambda: LatticeBoltzmannLighting(Input=medium, Lights=LightRig()),
    "LightGroup": lambda: LightGroup(Input=[LightRig(), Sun()]),
    "LightRig": LightRig,
    "VDBReader": lambda: VDBReader(FileName=[stored]),
    "LPMPropagate": lambda: LPMPropagate(Input=medium, Lights=LightRig(), DirectionsPerFace=4),
    "LPMCollect": lambda: LPMCollect(Input=LPMPropagate(Input=medium, Lights=LightRig(), DirectionsPerFace=4)),
    "LightPropagationMaps": lambda: LightPropagationMaps(Input=medium, Lights=LightRig()),
    "MediumRayCaster": lambda: MediumRayCaster(Input=medium, Lights=LightRig(), ImageSize=[8, 6]),
    "MeshVoxelizer": lambda: MeshVoxelizer(Input=Sphere(ThetaResolution=8, PhiResolution=8), SampleDimensions=[8, 8, 8]),
    "ParticipatingMedium": lambda: ParticipatingMedium(Input=medium, DensityArray=["CELLS", "density"]),
    "PhotonEmitter": lambda: PhotonEmitter(Input=medium, Lights=LightRig(), PhotonCount=200),
    "PhotonImportance": lambda: PhotonImportance(Input=medium, Lights=LightRig(), PilotCount=64, PilotDimensions=[4, 4, 4]),
    "PhotonMarcher": lambda: PhotonMarcher(Input=bends, Photons=photons(bends)),
    "PointLight": PointLight,
    "RectangleLight": RectangleLight,
    "SpotLight": SpotLight,
    "Sun": Sun,
    "PhotonReconstruction": lambda: PhotonReconstruction(Input=PhotonMarcher(
        Input=medium, Photons=photons(medium), PhotonCounts=1)),
    "RefractionOctree": lambda: RefractionOctree(Input=bends),
    "SeparablePhaseFunction": lambda: SeparablePhaseFunction(Terms=9),
    "SolverComparison": comparison,
}


def update(proxy):
    """Errors of an update, one text an error."""
    said = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(said)
    try:
        proxy.UpdatePipeline()
    finally:
        vtkOutputWindow.SetInstance(window)
    return [part.strip() for part in said.GetOutput().split("ERROR: ")[1:]]


def arrays_of(data):
    kinds = [data.GetRowData()] if data.IsA("vtkTable") else [data.GetPointData(), data.GetCellData()]
    return [kind.GetArray(i) for kind in kinds for i in range(kind.GetNumberOfArrays())]


def is_empty(data):
    return data.GetNumberOfElements(data.ROW if data.IsA("vtkTable") else data.POINT) == 0


def is_finite(data):
    """Of tables it is not asked: a NaN there says that something is not known."""
    return data.IsA("vtkTable") or all(numpy.isfinite(vtk_to_numpy(array)).all() for array in arrays_of(data) if array)


class Worker:
    """A proxy that works by updating."""

    def __init__(self, name):
        self.proxy = SCENES[name]()

    def run(self):
        return update(self.proxy), self.proxy.GetClientSideObject().GetOutputDataObject(0)

    def empty(self, data):
        return is_empty(data)


class Writer:
    """The writer, whose output is a file."""
    path = os.path.join(folder, "written.vdb")

    def __init__(self):
        self.proxy = servermanager.writers.VDBWriter(Input=medium, FileName=self.path)

    def run(self):
        if os.path.exists(self.path):
            os.remove(self.path)
        self.proxy.UpdateVTKObjects()
        return update(self.proxy), None

    def empty(self, _):
        return not os.path.exists(self.path)


def numbers(text):
    return [float(word) for word in (text or "").split()]


def bad_values(name, prop):
    """(value, component) beyond the range, and whether it must be refused; else it may be worked with as it is."""
    whole = prop.tag == "IntVectorProperty"
    names = [name, prop.get("name")]
    sides = WIDER.get(".".join(names), WIDER.get(names[1], ""))
    count = int(prop.get("number_of_elements", 1))
    choices = [int(entry.get("value")) for entry in prop.findall("EnumerationDomain/Entry")]
    ranges = prop.findall("IntRangeDomain") + prop.findall("DoubleRangeDomain") + prop.findall("ArrayRangeDomain")
    if not choices and not ranges:
        return
    low = [min(choices)] if choices else numbers(ranges[0].get("min"))
    high = [max(choices)] if choices else numbers(ranges[0].get("max"))
    for component in {0, count - 1}:
        if low:
            below = low[component] - (1 if whole else max(1e-3, 1e-3 * abs(low[component])))
            yield below, component, "below" not in sides
        if high:
            above = high[component] + (1 if whole else 1e-3 * max(1, abs(high[component])))
            yield above, component, "above" not in sides
        if not whole:
            for value in (math.nan, math.inf, -math.inf):
                yield value, component, True
            yield 1e308, component, False


def ends(prop):
    """The numbers at both ends of the range, one list for all components each."""
    choices = [int(entry.get("value")) for entry in prop.findall("EnumerationDomain/Entry")]
    if choices:
        return [[min(choices)], [max(choices)]]
    ranges = prop.findall("IntRangeDomain") + prop.findall("DoubleRangeDomain")
    return [numbers(ranges[0].get(end)) for end in ("min", "max") if ranges and ranges[0].get(end)]


def set_numbers(worker, handle, prop, values):
    for i, value in enumerate(values):
        handle.SetElement(i, int(value) if prop.tag == "IntVectorProperty" else value)
    worker.proxy.UpdateVTKObjects()


def try_end(worker, prop, values, what):
    handle = worker.proxy.GetProperty(prop.get("name")).SMProperty
    conservative = [handle.GetElement(i) for i in range(handle.GetNumberOfElements())]
    set_numbers(worker, handle, prop, values)
    found, data = worker.run()
    if found or worker.empty(data):
        faults.append("%s: it is in the range, and refused: %s" % (what, found))
    set_numbers(worker, handle, prop, conservative)


def try_value(worker, prop, value, component, must_be_refused, what):
    handle = worker.proxy.GetProperty(prop.get("name")).SMProperty
    conservative = [handle.GetElement(i) for i in range(handle.GetNumberOfElements())]
    whole = prop.tag == "IntVectorProperty"
    handle.SetElement(component, int(value) if whole else value)
    worker.proxy.UpdateVTKObjects()
    found, data = worker.run()
    if found or must_be_refused:
        if len(found) != 1:
            faults.append("%s: %d errors: %s" % (what, len(found), found))
        elif must_be_refused and prop.get("name") not in found[0]:
            faults.append("%s: an error that does not name it: %s" % (what, found[0]))
        elif not worker.empty(data):
            faults.append("%s: an error, and an output" % what)
    elif data is not None and not is_finite(data):
        faults.append("%s: no error, and an output that is not finite" % what)
    set_numbers(worker, handle, prop, conservative)
    return bool(found)


def check(name, proxy):
    worker = Writer() if name == "VDBWriter" else Worker(name)
    properties = list(proxy)
    tried = 0
    for prop in properties:
        numeric = prop.tag in ("IntVectorProperty", "DoubleVectorProperty")
        if not numeric or prop.get("information_only") or prop.get("repeat_command"):
            continue
        refused = False
        for value, component, must_be_refused in bad_values(name, prop):
            what = "%s.%s[%d] = %g" % (name, prop.get("name"), component, value)
            refused = try_value(worker, prop, value, component, must_be_refused, what) or refused
            tried += 1
        for values in ends(prop):
            if prop.get("name") not in AT_THE_END:
                try_end(worker, prop, values, "%s.%s = %s" % (name, prop.get("name"), values))
                tried += 1
        if refused:
            found, data = worker.run()
            if found or worker.empty(data):
                faults.append("%s.%s: it does not work again with a conservative value: %s" % (name, prop.get("name"), found))
    return tried


tried = 0
files = sorted(glob.glob(os.path.join(os.environ["TYNDALL_SOURCE"], "Plugin/ServerManager/*.xml")))
trees = [group for file in files for group in ElementTree.parse(file).getroot().findall("ProxyGroup")]
for group in trees:
    if not group.get("name").startswith(("internal", "views")):
        for proxy in (each for each in group if each.tag != "Extension"):
            tried += check(proxy.get("name"), proxy)
print("%d values tried" % tried)
assert tried > 300, tried
assert not faults, "%d faults\n" % len(faults) + "\n".join(faults)
