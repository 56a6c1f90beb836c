"""tyndall.solve: arrays keep their axes, light its unit; what filters report comes as an exception."""
import gc
import warnings

import numpy
import tyndall
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkRectilinearGrid

shape = (9, 14, 11)


def raises(kind, words, work):
    try:
        work()
    except kind as error:
        assert words in str(error), error
        return
    raise AssertionError(f"no {kind.__name__} about {words}")


# A furnace: where all shines alike and nothing absorbs, fluence is 4 pi times the radiance, whatever scatters.
density = numpy.random.default_rng(20261125).uniform(0.0, 1.0, shape)
light = tyndall.solve(density, (0.5, 1.0, 2.0), albedo=1.0, sky=3.0, Tolerance=1e-5)
assert light.fluence.shape == shape, light.fluence.shape
numpy.testing.assert_allclose(light.fluence, 12.0 * numpy.pi, rtol=2e-3)
balance = light.energy_balance
assert abs(balance["escaped"] / balance["entered"] - 1.0) < 1e-4, balance
assert len(light.convergence["residual"]) > 1

# Axes: light along +y meets an absorbing plate across it. Beer's law before, in and behind the plate.
sigma = numpy.zeros(shape)
sigma[:, 10, :] = 5.0
lamp = tyndall.vtkLightRig()
lamp.SetSun(False)
lamp.AddDirectionalLight(0.0, 1.0, 0.0, 1.0, 1.0, 1.0)  # travels along +y
shadow = tyndall.solve(dict(sigma_a=sigma, sigma_s=0.0 * sigma), 1.0, lights=lamp)
along = shadow.fluence.mean(axis=(0, 2))
numpy.testing.assert_allclose(along[:10], 1.0, rtol=1e-4)
numpy.testing.assert_allclose(along[11:], numpy.exp(-5.0), rtol=1e-3)
numpy.testing.assert_allclose(along[10], (1.0 - numpy.exp(-5.0)) / 5.0, rtol=1e-3)

# Colour is the last index.
coloured = tyndall.solve(density, 1.0, albedo=(0.2, 0.5, 0.9), sky=(1.0, 1.0, 1.0))
means = coloured.fluence.mean(axis=(0, 1, 2))
assert coloured.fluence.shape == shape + (3,) and means[0] < means[1] < means[2], means

# An array outlives the light it came from: other light of the same size would be put where it lay.
once = tyndall.solve(density, 1.0, sky=1.0, MaximumOrders=2)
fluence, before = once.fluence, once.fluence.copy()
del once
gc.collect()
others = [tyndall.solve(density, 1.0, sky=7.0, MaximumOrders=2) for _ in range(4)]
numpy.testing.assert_array_equal(fluence, before)

# Where nothing else shines it is the solvers' own default sky, and they say so; properties are something that shines.
# A clear medium shows the light alone.
clear = dict(sigma_a=0.0 * density, sigma_s=0.0 * density)
maps = tyndall.vtkLightPropagationMaps()
maps.SetInputData(tyndall.image_of(1.0, **clear))
maps.Update()
default = tyndall.solve(clear)
numpy.testing.assert_array_equal(default.fluence.ravel(order="F"),
                                 vtk_to_numpy(maps.GetOutputDataObject(0).GetCellData().GetArray("fluence")))
assert default.fluence.min() > 0.0 and "DefaultSky" in default.left_out[0], default.left_out
glowing = dict(clear, emission=0.0 * density)  # an array of zeros is no light
assert "DefaultSky" in tyndall.solve(glowing).left_out[0]
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    warnings.simplefilter("ignore", DeprecationWarning)  # of what VTK does to arrays, since numpy 2.5
    assert tyndall.solve(clear, DefaultSky=False).fluence.max() == 0.0
assert len(told) == 1 and "Nothing shines" in str(told[0].message), told
for method, properties in (("maps", dict(FaceRadiance=(2.0,) * 6)), ("maps", dict(SkyColor=(2.0, 2.0, 2.0))),
                           ("ordinates", dict(SkyColor=(2.0, 2.0, 2.0)))):
    numpy.testing.assert_allclose(tyndall.solve(clear, method=method, **properties).fluence, 8.0 * numpy.pi, rtol=2e-3)
uncollided = tyndall.solve(density, sky=2.0, MaximumOrders=0).image
furnace = tyndall.solve(density, albedo=1.0, sky=2.0, method="ordinates")
sunless = tyndall.solve(density, albedo=1.0, UncollidedLightData=uncollided, method="ordinates")
assert sunless.fluence.mean() < 1.01 * furnace.fluence.mean(), sunless.fluence.mean()

picture = tyndall.picture(light, (40, 30))
assert picture.shape == (30, 40, 4) and picture.dtype == numpy.uint8 and picture[..., :3].max() > 0

# What people hand in: other classes of lights, numbers as arrays, g by voxel, masked arrays, arrays that do not fit.
sun, rig = tyndall.vtkSun(), tyndall.vtkLightRig()
rig.SetSun(False)
rig.AddDirectionalLight(0.0, 0.0, -1.0, 1.0, 1.0, 1.0)
sun.Update()
by_class = tyndall.solve(density, lights=sun, MaximumOrders=1).fluence
numpy.testing.assert_array_equal(tyndall.solve(density, lights=sun.GetOutput(), MaximumOrders=1).fluence, by_class)
assert by_class.max() > 0.0
few = dict(albedo=0.9, sky=1.0, MaximumOrders=2)
of_number = tyndall.solve(density, g=0.8, **few).fluence
for g in (numpy.float64(0.8), numpy.array(0.8), numpy.array([0.8]), numpy.full(shape, 0.8)):
    numpy.testing.assert_allclose(tyndall.solve(density, g=g, **few).fluence, of_number, rtol=1e-6)
by_colour = tyndall.solve(density, g=[0.0, 0.5, 0.8], **few).fluence
numpy.testing.assert_allclose(by_colour[..., 2], of_number, rtol=1e-3)
halves = numpy.where(numpy.arange(shape[0])[:, None, None] < 4, 0.0, 0.8) * numpy.ones(shape)
lamp_in_it = dict(albedo=0.9, lights=rig, MaximumOrders=2, NetFlux=True)
assert (tyndall.solve(density, g=halves, **lamp_in_it).fluence != tyndall.solve(density, g=0.8, **lamp_in_it).fluence).any()
masked = numpy.ma.masked_greater(density, 0.99)
count = numpy.ma.count_masked(masked)
raises(ValueError, f"density is masked in {count} places", lambda: tyndall.solve(masked))
raises(ValueError, "emission is masked in", lambda: tyndall.solve(density, emission=masked))
numpy.testing.assert_array_equal(tyndall.solve(numpy.ma.masked_greater(density, 2.0), **few).fluence,
                                 tyndall.solve(density, **few).fluence)
raises(ValueError, "g has the shape", lambda: tyndall.solve(density, g=halves[1:]))
raises(ValueError, "g has the shape (2,)", lambda: tyndall.solve(density, g=[0.1, 0.2]))
raises(ValueError, "spacing has the shape (2,)", lambda: tyndall.solve(density, (1.0, 2.0)))
raises(ValueError, "origin has the shape (4,)", lambda: tyndall.solve(density, origin=(0.0,) * 4))
raises(ValueError, "sky has the shape (2,)", lambda: tyndall.solve(density, sky=(1.0, 2.0)))
raises(ValueError, "albedo is no array of numbers", lambda: tyndall.solve(density, albedo="white"))
raises(ValueError, "density is no array of numbers", lambda: tyndall.solve(numpy.full(shape, "thick")))
raises(TypeError, "does not take FaceRadiance", lambda: tyndall.solve(density, FaceRadiance=(1.0, 2.0)))
raises(TypeError, "lights is a list", lambda: tyndall.solve(density, lights=[sun]))
short = sun.GetOutput().NewInstance()
short.DeepCopy(sun.GetOutput())
short.GetPointData().GetArray("power").Resize(0)
raises(tyndall.SolvingError, "'power' has 0 values where the dataset has 1",
       lambda: tyndall.solve(density, lights=short))

raises(tyndall.SolvingError, "Tolerance is -1", lambda: tyndall.solve(density, Tolerance=-1.0))
raises(TypeError, "no property Tollerance", lambda: tyndall.solve(density, Tollerance=1.0))
raises(ValueError, "maps, ordinates, lattice", lambda: tyndall.solve(density, method="magic"))
raises(ValueError, "has the shape", lambda: tyndall.solve(dict(sigma_a=density, sigma_s=density[1:])))
raises(TypeError, "extinction, g would not be used", lambda: tyndall.solve(clear, 1.0, extinction=2.0, g=0.0))
raises(TypeError, "spacing, albedo would not be used", lambda: tyndall.solve(light.image, 1.0, albedo=0.5))
raises(TypeError, "vtkResampleToImage", lambda: tyndall.solve(vtkRectilinearGrid()))
raises(KeyError, "there is", lambda: light["brightness"])
