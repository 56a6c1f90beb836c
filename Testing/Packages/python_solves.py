"""python_solves.py FOLDER: the package tyndall, which lies in the folder, solves; what it gives is printed to all digits."""
import sys

import numpy
import tyndall
from tyndall import vtkLightPropagationMaps

assert tyndall.__file__.startswith(sys.argv[1]), tyndall.__file__
with open("/proc/self/maps") as maps:
    ours = {line.split()[-1] for line in maps if "libvtkTyndall" in line}
assert ours and all(library.startswith(sys.argv[1]) for library in ours), ours
assert vtkLightPropagationMaps().GetTolerance() > 0.0

furnace = tyndall.solve(numpy.ones((4, 4, 4)), albedo=1.0, sky=3.0, Tolerance=1e-5)
numpy.testing.assert_allclose(furnace.fluence, 12.0 * numpy.pi, rtol=2e-3)  # 4 pi times the radiance
density = numpy.random.default_rng(20261125).uniform(0.0, 1.0, (6, 5, 4))
light = tyndall.solve(density, (0.5, 1.0, 2.0), albedo=0.9)
balance = light.energy_balance
assert light.fluence.shape == density.shape and light.fluence.min() > 0.0
assert abs((balance["absorbed"] + balance["escaped"] + balance["left over"]) / balance["entered"] - 1.0) < 1e-4, balance
print("fluence", light.fluence.ravel().tolist())
print("energy", {name: numpy.asarray(power).tolist() for name, power in balance.items()})
