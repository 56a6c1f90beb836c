"""Arrays are found by their names: what else is in the image (the density it came from) does not shine or dim."""
import math
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def picture(light):
    caster = MediumRayCaster(Input=light, ImageSize=[80, 60])
    chosen = [list(caster.GetPropertyValue(name)) for name in
              ("AbsorptionArray", "ScatteringArray", "FluenceArray", "DirectFluenceArray")]
    assert chosen == [["CELLS", name] for name in ("sigma_a", "sigma_s", "fluence", "fluence_direct")], chosen
    assert caster.EmissionArray[1] == "(by name)", caster.EmissionArray
    return vtk_to_numpy(servermanager.Fetch(caster).GetPointData().GetArray("radiance"))


wavelet = Wavelet(WholeExtent=[-8, 8, -8, 8, -8, 8])
density = Calculator(Input=wavelet, ResultArrayName="density", Function="RTData")
density.UpdatePipeline()
medium = ParticipatingMedium(Input=density, DensityArray=["POINTS", "density"], ExtinctionScale=0.5)
medium.UpdatePipeline()
bare = PassArrays(Input=medium, CellDataArrays=["sigma_a", "sigma_s"], FieldDataArrays=["g"])
bare.UpdatePipeline()
assert "density" in medium.GetPointDataInformation().keys() or "density" in medium.CellData.keys(), "there is something to mistake"

sky = 2.0
seen = {}
for name, source in (("all", medium), ("bare", bare)):
    light = LightPropagationMaps(Input=source, SkyColor=[sky] * 3, DirectionsPerFace=9)
    light.UpdatePipeline()
    assert "sigma_a" not in light.GetPointDataInformation().keys(), "nothing is converted for it"
    seen[name] = picture(light)
    fluence = light.CellData["fluence"].GetRange()
    assert 0 < fluence[0] and fluence[1] < 4 * math.pi * sky * 1.0001, fluence

assert (seen["all"] == seen["bare"]).all(), abs(seen["all"] - seen["bare"]).max()
assert 0 < seen["all"].max() <= sky, seen["all"].max()  # nothing is brighter than the sky that lights it
