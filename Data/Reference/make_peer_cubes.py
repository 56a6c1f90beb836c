#!/usr/bin/env python3
"""Makes peer_cubes.csv: fluence of 8 x 8 x 8 blocks of the cubes of ./run bench peers, by a long forward Monte Carlo.

    build/release/peers/bin/python Data/Reference/make_peer_cubes.py [THREADS]

The python is that of the benchmark's environment. The same program is one of the peers there, by other random numbers.
Even cubes are averaged over the eight symmetries of the light; sigma is the standard error, from batches.
"""
import importlib.metadata
import os
import sys

import drjit
import numpy

root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(root, "Testing", "Benchmarks", "Peers"))
import forward  # noqa: E402
from scenes import SCENES  # noqa: E402

HISTORIES = 1 << 22  # a batch
BATCHES = {"cube-5": 100, "cloud-20": 20, "cube-100": 30}
FIRST_SEED = 1000    # the benchmark's are below


def symmetrised(fluence):
    both = fluence + fluence.transpose(0, 2, 1)
    both = both + both[:, ::-1, :]
    return (both + both[:, :, ::-1]) / 8.0


def main():
    if len(sys.argv) > 1:
        drjit.set_thread_count(int(sys.argv[1]))
    with open(os.path.join(root, "Data", "Reference", "peer_cubes.csv"), "w") as file:
        file.write("# unit cubes of Testing/Benchmarks/Peers/scenes.py, isotropic scattering, face z = 0 shines, diffuse, unit "
                   "flux: mean fluence of 8^3 blocks and its standard error. Own forward Monte Carlo, make_peer_cubes.py "
                   "(Dr.Jit %s), %s batches of %d histories\n" % (
                       importlib.metadata.version("drjit"), ", ".join(map(str, BATCHES.values())), HISTORIES))
        file.write("scene,ix,iy,iz,phi,sigma\n")
        for name, (_, extinction, albedo) in SCENES.items():
            found = []
            for batch in range(BATCHES[name]):
                fluence, _ = forward.block_fluence(extinction, albedo, HISTORIES, FIRST_SEED + batch)
                found.append(symmetrised(fluence) if extinction.size == 1 else fluence)
            mean = numpy.mean(found, axis=0)
            sigma = numpy.std(found, axis=0, ddof=1) / len(found) ** 0.5
            print("%s: standard error over fluence, L2: %.2g" % (name, numpy.linalg.norm(sigma) / numpy.linalg.norm(mean)))
            for z, y, x in numpy.ndindex(mean.shape):
                file.write("%s,%d,%d,%d,%.6e,%.1e\n" % (name, x, y, z, mean[z, y, x], sigma[z, y, x]))


if __name__ == "__main__":
    main()
