"""A volume's colours and opacities become a medium: taken from the representation, and followed when they are edited."""
import math
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def cells(source, name):
    return vtk_to_numpy(servermanager.Fetch(source).GetCellData().GetArray(name))


wavelet = Wavelet(WholeExtent=[-4, 4, -4, 4, -4, 4])
view = CreateRenderView()
shown = Show(wavelet, view)
shown.SetRepresentationType("Volume")
ColorBy(shown, ("POINTS", "RTData"))
opacities = GetOpacityTransferFunction("RTData")
opacities.Points = [0, 0.5, 0.5, 0, 300, 0.5, 0.5, 0]
colors = GetColorTransferFunction("RTData")
colors.RGBPoints = [0, 1, 0, 0, 300, 1, 0, 0]
shown.ScalarOpacityUnitDistance = 2

medium = ParticipatingMedium(Input=wavelet)
medium.UseTransferFunctions = 1
assert medium.LookupTable.SMProxy.GetGlobalIDAsString() == colors.SMProxy.GetGlobalIDAsString()
assert medium.DensityArray[1] == "RTData" and medium.ScalarOpacityUnitDistance == 2, medium.DensityArray
scattering, absorption = cells(medium, "sigma_s"), cells(medium, "sigma_a")
half = math.log(2) / 2
middle = 4 * 81 + 4 * 9 + 4
assert scattering.shape == (729, 3), scattering.shape
assert abs(scattering[middle, 0] - 0.9999 * half) < 1e-5 and scattering[middle, 1] < 1e-3, scattering[middle]
assert abs((scattering + absorption)[middle] - half).max() < 1e-5
assert abs((scattering + absorption)[0] - half / 8).max() < 1e-5  # an eighth of the voxel at the corner is inside

opacities.Points = [0, 0.75, 0.5, 0, 300, 0.75, 0.5, 0]
edited = cells(medium, "sigma_s") + cells(medium, "sigma_a")
assert abs(edited[middle] - 2 * half).max() < 1e-5, "an edited function makes another medium"
colors.RGBPoints = [0, 0.5, 0.5, 0.5, 300, 0.5, 0.5, 0.5]
assert cells(medium, "sigma_s").shape == (729,), "a grey volume makes a grey medium"

medium.ColorMeans = "Emission"
assert abs(cells(medium, "emission")[middle] - 2 * half * 0.21404).max() < 1e-4, cells(medium, "emission")[middle]

# At creation, and from a colour map that is given.
SetActiveSource(wavelet)  # whose arrays it chooses from
other = ParticipatingMedium(Input=wavelet, UseTransferFunctions=1, LookupTable=colors, ScalarOpacityFunction=opacities)
other.ScalarOpacityUnitDistance = 1
assert abs((cells(other, "sigma_s") + cells(other, "sigma_a"))[middle] - 4 * half) < 1e-5
