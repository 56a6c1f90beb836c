"""numpy in, numpy out, drawn with matplotlib: a lumpy cloud under the sun, in plain Python without ParaView's window.

    python3 arrays.py [PICTURE]     with the package tyndall on PYTHONPATH (the guide says where it is)

Draws a slice of the fluence, the fall of the light along the column in its middle, and how the solver converged.
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot
import numpy
import tyndall

# Density of a ball with lumps, in a box of 40^3 voxels of 12 m.
count, edge = 40, 12.0
x, y, z = (numpy.indices((count,) * 3) - (count - 1) / 2) * edge
lumps = numpy.sin(x / 37.0) * numpy.sin(y / 29.0 + 1.0) * numpy.sin(z / 41.0 + 2.0)
density = numpy.clip(1.5 * (1.0 - numpy.sqrt(x**2 + y**2 + z**2) / 200.0) + lumps, 0.0, 1.0)

sun = tyndall.vtkLightRig()
light = tyndall.solve(density, edge, extinction=0.05, albedo=0.999, lights=sun, Tolerance=1e-3)
# Arrays are indexed [x, y, z]. They have one channel, because sun and cloud are grey.
fluence, direct = light.fluence, light["fluence_direct"]
print(", ".join(f"{name} {power:.4g} W" for name, power in light.energy_balance.items()))

figure, (left, middle, right) = pyplot.subplots(1, 3, figsize=(13, 4), constrained_layout=True)
half = count * edge / 2
shown = left.imshow(fluence[:, count // 2, :].T, origin="lower", extent=(-half, half, -half, half), cmap="magma")
left.set(title="fluence, y = 0", xlabel="x, m", ylabel="z, m")
figure.colorbar(shown, ax=left, label="W / m$^2$")
heights = z[0, 0, :]
middle.plot(heights, fluence[count // 2, count // 2, :], color="#0072b2", label="all light")
middle.plot(heights, direct[count // 2, count // 2, :], color="#d55e00", linestyle="--", label="unscattered")
middle.set(title="the column x = y = 0", xlabel="z, m", ylabel="fluence, W / m$^2$", yscale="log")
middle.legend()
right.semilogy(light.convergence["iteration"], light.convergence["residual"], "o-", color="#009e73")
right.set(title="convergence", xlabel="row", ylabel="residual")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "arrays.png", dpi=110)
