"""Density, light rig, light propagation maps: light comes out, with its convergence and what the panel says of it."""
import os
import re

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def fluence(source):
    source.UpdatePipeline()
    source.UpdatePropertyInformation()  # what the panel shows
    return vtk_to_numpy(servermanager.Fetch(source).GetCellData().GetArray("fluence"))


wavelet = Wavelet(WholeExtent=[-6, 6, -6, 6, -6, 6])
wavelet.UpdatePipeline()
medium = ParticipatingMedium(Input=wavelet, ExtinctionScale=0.3)
medium.UpdatePipeline()
light = LightPropagationMaps(Input=medium, Lights=LightRig())
assert [light.AbsorptionArray[1], light.ScatteringArray[1], light.EmissionArray[1]] == ["sigma_a", "sigma_s", "(by name)"]

# With nothing touched, a right picture.
lit = fluence(light)
assert lit.shape == (13**3,) and 0.05 < lit.min() and lit.max() < 5, (lit.min(), lit.max())
assert light.Orders > 3 and 0 < light.Residual <= 1e-4 and light.BalanceError < 1e-5 and light.Seconds > 0
assert light.DeviceName
data = servermanager.Fetch(light)
assert data.GetFieldData().GetAbstractArray("device").GetValue(0) == light.DeviceName
entered, emitted, absorbed, escaped, left = vtk_to_numpy(data.GetFieldData().GetArray("energy_balance"))
assert entered > 0 and emitted == 0 and abs(entered - absorbed - escaped - left) < 1e-5 * entered

convergence = servermanager.Fetch(light, idx=1)
columns = [convergence.GetColumnName(i) for i in range(convergence.GetNumberOfColumns())]
assert columns == ["iteration", "seconds", "residual", "change", "absorbed", "escaped", "left_over"], columns
assert convergence.GetNumberOfRows() == light.Orders

# How far it may be off, on the panel and as an array.
light.EstimateError = 1
assert abs(fluence(light) - lit).max() == 0
assert 1e-4 < light.EstimatedError < 0.3, light.EstimatedError
error = vtk_to_numpy(servermanager.Fetch(light).GetCellData().GetArray("fluence_error"))
assert error.shape == lit.shape and abs((error**2).mean() / (lit**2).mean() / light.EstimatedError**2 - 1) < 1e-3
light.EstimateError = 0
fluence(light)
assert light.EstimatedError == 0

# A budget changes where things lie, not the light.
light.MemoryBudget = 1
assert abs(fluence(light) - lit).max() == 0
assert "in host memory" in light.DeviceName, light.DeviceName
light.MemoryBudget = 0

# Properties reach the solver.
light.Source, light.Acceleration = "Constant (as published)", "None (as published)"
assert abs(fluence(light) / lit - 1).max() < 0.05
light.Source, light.Acceleration = "Automatic", "Automatic"
light.MaximumOrders = 1
single = fluence(light)
assert light.Orders == 1 and (single < lit).all()
light.MaximumOrders = 0
light.Lights = None
light.SkyColor = [1, 1, 2]
light.NetFlux = 1
sky = fluence(light)
assert sky.shape == (13**3, 3)
assert abs(sky[:, 2] / sky[:, 0] - 2).max() < 1e-4, sky
assert servermanager.Fetch(light).GetCellData().GetArray("net_flux").GetNumberOfComponents() == 9
light.Scheme = "As published"
light.MaximumOrders = 3
published = fluence(light)
light.Algorithm = "Sequential (Algorithm 1)"
assert abs(fluence(light) / published - 1).max() < 1e-3

# What emits later is seen, though the filter was there before.
light.Scheme = "Conservative"
light.SkyColor = [0, 0, 0]
medium.EmissionScale = 1
assert fluence(light).min() > 0

# Another name for an array.
renamed = Calculator(Input=medium, AttributeType="Cell Data", ResultArrayName="thick", Function="10*sigma_s")
medium.EmissionScale = 0
light.SkyColor = [1, 1, 1]
thin = fluence(light)
light.Input = renamed
light.ScatteringArray = ["CELLS", "thick"]
assert fluence(light).mean() < thin.mean()

# What the light adds stays its own: the medium it came from has no balance, and keeps none when it is made again.
assert servermanager.Fetch(medium).GetFieldData().GetArray("energy_balance") is None
medium.ExtinctionScale = 2
assert servermanager.Fetch(light).GetFieldData().GetArray("energy_balance")

# What the panel says of the half-range flux is what comes out.
for solver, settings in (LightPropagationMaps, {"UncollidedDirections": 25}), (DiscreteOrdinates, {}):
    light = solver(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=25, MaximumOrders=1, **settings)
    light.UpdatePipeline()
    light.UpdatePropertyInformation()
    said = light.SMProxy.GetProperty("HalfRangeFlux").GetDocumentation().GetDescription()
    told = re.search(r"([\d.]+) with 25\s+directions", said)[1]
    assert f"{light.HalfRangeFlux:.{len(told) - 2}f}" == told, (light.HalfRangeFlux, told)

medium.MeanCosine = 0.5
light.UpdatePipeline()
light.UpdatePropertyInformation()
told = re.search(r"([\d.]+) for a sky if scattering is anisotropic", said)[1]
assert f"{light.HalfRangeFlux:.{len(told) - 2}f}" == told, (light.HalfRangeFlux, told)
