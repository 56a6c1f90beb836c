"""A density becomes a medium: by default one that fits the data, or a real one, in the dataset's unit."""
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def cells(source, name):
    return vtk_to_numpy(servermanager.Fetch(source).GetCellData().GetArray(name))


wavelet = Wavelet(WholeExtent=[-4, 4, -4, 4, -4, 4])

# Made before the data is known: the active scalars, as they are.
medium = ParticipatingMedium(Input=wavelet)
as_is = cells(medium, "sigma_s") / 0.9

# Made after: relative density 1 is the largest density there is.
wavelet.UpdatePipeline()
largest = wavelet.PointData["RTData"].GetRange()[1]
SetActiveSource(wavelet)  # whose arrays it chooses from
medium = ParticipatingMedium(Input=wavelet)
assert medium.DensityArray[1] == "RTData" and medium.MinimumDensity == 0, medium.DensityArray
assert abs(medium.MaximumDensity - largest) < 1e-9 * largest, medium.MaximumDensity
assert abs(cells(medium, "sigma_s") * largest - 0.9 * as_is).max() < 1e-3
assert abs(cells(medium, "sigma_a") * largest - 0.1 * as_is).max() < 1e-3

# What is told is that of the last update, without being asked for.
for unit in ("m", "km", "mm"):
    medium.LengthUnit = unit
    medium.UpdatePipeline()
    assert medium.PhysicalExtent.endswith(" " + unit), (unit, medium.PhysicalExtent)
medium.LengthUnit = "Millimetres Per Unit"

medium.Albedo = [0.9, 0.6, 0.3]
medium.ExtinctionScale = 2
medium.EmissionScale = 0.5
scattering, absorption, emission = (cells(medium, name) for name in ("sigma_s", "sigma_a", "emission"))
assert scattering.shape == (729, 3) and emission.shape == (729,)
assert abs(scattering + absorption - 4 * emission[:, None]).max() < 1e-5

medium.Preset = "Skim milk"
medium.MillimetresPerUnit = 10
medium.ExtinctionScale = 1
assert abs(cells(medium, "sigma_s") * largest - as_is[:, None] * [7.0, 12.2, 19.0]).max() < 1e-2

# Each colour scatters as it does: real media, three numbers, a table that a Mie code printed.
def fact(name):
    return servermanager.Fetch(medium).GetFieldData().GetAbstractArray(name)


medium.Preset = "Espresso"
assert fact("g").GetNumberOfValues() == 3, fact("g")
medium.Preset = "Custom"
medium.ChannelMeanCosines = [0.1, 0.2, 0.3]
assert [fact("g").GetComponent(0, c) for c in range(3)] == [0.1, 0.2, 0.3]
medium.ChannelMeanCosines = []
medium.MeanCosine = 0.5
assert fact("g").GetNumberOfValues() == 1 and fact("g").GetValue(0) == 0.5

path = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "mie.csv")
with open(path, "w") as file:
    file.write("angle,p11\n" + "".join("%d,%.6g\n" % (angle, 100 / (1 + angle)) for angle in range(0, 181, 5)))
printed = Calculator(Input=CSVReader(FileName=[path]), AttributeType="Row Data", ResultArrayName="cosine",
                     Function="cos(angle*3.14159265358979/180)")
table = Calculator(Input=printed, AttributeType="Row Data", ResultArrayName="value", Function="p11")
medium.PhaseFunction = "Tabulated"
medium.PhaseTable = table
assert fact("phase_function").GetValue(0) == "tabulated" and fact("phase_cosine").GetNumberOfValues() == 37
assert 0 < fact("g").GetValue(0) < 1, fact("g").GetValue(0)
medium.PhaseFunction = "Henyey-Greenstein"
medium.PhaseTable = None
assert fact("phase_cosine") is None and fact("g").GetValue(0) == 0.5
