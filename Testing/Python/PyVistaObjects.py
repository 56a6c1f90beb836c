"""PyVista's objects go in as they are, and it wraps what comes out: they are VTK's, where it stands on the host's VTK."""
import os
import sys

import numpy
import tyndall

sys.path.append(os.environ.get("TYNDALL_PYVISTA", ""))  # what `Data/fetch pyvista` fetched, behind all that is there
try:
    import pyvista
except ImportError as error:
    print(f"Skipped: {error}. `Data/fetch pyvista` fetches a PyVista that works with this VTK.")
    sys.exit(125)

count = 8
density = numpy.random.default_rng(20261125).uniform(0.0, 1.0, (count, count, count))
grid = pyvista.ImageData(dimensions=(count + 1,) * 3, spacing=(0.5, 1.0, 2.0))
grid.cell_data["sigma_a"] = 0.1 * density.ravel(order="F")
grid.cell_data["sigma_s"] = 0.9 * density.ravel(order="F")
sun = tyndall.vtkLightRig()

# A grid in solve is the arrays in solve.
asked = dict(lights=sun, Tolerance=1e-3)
light = tyndall.solve(grid, **asked)
arrays = tyndall.solve(dict(sigma_a=0.1 * density, sigma_s=0.9 * density), (0.5, 1.0, 2.0), **asked)
assert light.fluence.max() > 0.0
numpy.testing.assert_array_equal(light.fluence, arrays.fluence)

# What comes out is wrapped: the same voxels, arrays, field data and tables.
wrapped = pyvista.wrap(light.image)
assert isinstance(wrapped, pyvista.ImageData) and wrapped.dimensions == grid.dimensions, wrapped
assert wrapped.spacing == grid.spacing and wrapped.bounds == grid.bounds, wrapped
numpy.testing.assert_array_equal(wrapped.cell_data["fluence"], light.fluence.ravel(order="F"))
assert wrapped.field_data["energy_balance"].shape[0] == 5, wrapped.field_data["energy_balance"]
table = pyvista.wrap(light.table)
numpy.testing.assert_array_equal(table["residual"], light.convergence["residual"])

# The classes take grids and lights of PyVista's, and PyVista's own filters take what they make.
rig = pyvista.wrap(sun.GetOutputDataObject(0)) if sun.Update() is None else None
maps = tyndall.vtkLightPropagationMaps()
maps.SetInputData(grid)
maps.SetLightsData(rig.copy())
maps.SetTolerance(1e-3)
maps.Update()
found = pyvista.wrap(maps.GetOutputDataObject(0))
numpy.testing.assert_array_equal(found.cell_data["fluence"], wrapped.cell_data["fluence"])
slice_of_it = found.slice(normal="z")
assert slice_of_it.n_cells == count * count and slice_of_it.cell_data["fluence"].min() > 0.0, slice_of_it
numpy.testing.assert_array_equal(tyndall.solve(grid, lights=rig, Tolerance=1e-3).fluence, light.fluence)

# A sky as PyVista's image, and a picture of light that was wrapped.
sky = pyvista.ImageData(dimensions=(16, 8, 1))
sky.point_data["radiance"] = numpy.full((128, 3), 2.0)
furnace = tyndall.solve(dict(sigma_a=0.0 * density, sigma_s=density), environment=sky, Tolerance=1e-5)
numpy.testing.assert_allclose(furnace.fluence, 8.0 * numpy.pi, rtol=5e-3)
picture = tyndall.picture(tyndall.Light(wrapped, light.table), (40, 30))
assert picture[..., :3].max() > 0

# What is no image is refused by name.
for other in (pyvista.RectilinearGrid([0.0, 1.0, 3.0], [0.0, 1.0], [0.0, 1.0]), pyvista.Sphere(),
              pyvista.MultiBlock([grid, grid]), grid.cast_to_unstructured_grid()):
    try:
        tyndall.solve(other)
    except TypeError as error:
        assert other.GetClassName() in str(error) and "vtkResampleToImage" in str(error), error
    else:
        raise AssertionError(f"{type(other)} was taken")
# Its advice works.
box = grid.cast_to_unstructured_grid()
resampled = pyvista.ImageData(dimensions=(9, 9, 9), spacing=(0.5, 1.0, 2.0)).sample(box)
assert tyndall.solve(resampled, lights=sun, Tolerance=1e-3).fluence.max() > 0.0
print(f"PyVista {pyvista.__version__} on VTK {tyndall.host.VERSION}")
