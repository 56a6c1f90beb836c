"""A forward Monte Carlo in Dr.Jit, vectorised: the strongest of the peers, and where the reference values come from.

Photons start on the face that shines; tentative collisions come by the greatest extinction of the grid (Woodcock's delta
tracking; in an even medium every collision is real), each is counted in its block's fluence, real ones scatter
isotropically and multiply the weight by the albedo; light photons go on with probability 1/2 and twice the weight.
A lane that has lost its photon starts the next, so that no lane of a vector waits for the longest history."""
import drjit
import numpy
from drjit.llvm import Array3f, Bool, Float, Float64, PCG32, UInt32

from scenes import BLOCKS

LANES = 1 << 14
LIGHT = 0.25  # weights below it are put to the test


@drjit.syntax
def trace(extinction, voxels, even, greatest, albedo, lanes, histories, seed, tally):
    random = PCG32(size=lanes, initstate=seed)
    left = histories + drjit.zeros(UInt32, lanes)
    weight = drjit.zeros(Float, lanes)
    position, direction = drjit.zeros(Array3f, lanes), drjit.zeros(Array3f, lanes)
    turns = drjit.full(Bool, True, lanes)
    while (left > 0) | (weight > 0):
        starts = weight == 0
        left = drjit.select(starts, left - 1, left)
        height = random.next_float32()
        height = drjit.select(starts, drjit.sqrt(height), 1.0 - 2.0 * height)
        sine, cosine = drjit.sincos(2.0 * drjit.pi * random.next_float32())
        across = drjit.sqrt(drjit.maximum(0.0, 1.0 - height * height))
        drawn = Array3f(across * cosine, across * sine, height)
        if drjit.hint(even, mode="scalar"):
            direction = drawn
        else:
            direction = drjit.select(starts | turns, drawn, direction)
        position = drjit.select(starts, Array3f(random.next_float32(), random.next_float32(), 0.0), position)
        weight = drjit.select(starts, 1.0, weight)

        position += direction * (-drjit.log(1.0 - random.next_float32()) / greatest)
        inside = (drjit.min(position) >= 0.0) & (drjit.max(position) < 1.0)
        x, y, z = (UInt32(position[axis] * BLOCKS) for axis in range(3))
        drjit.scatter_add(tally, Float64(weight), (z * BLOCKS + y) * BLOCKS + x, inside)
        if drjit.hint(even, mode="scalar"):
            weight *= albedo
        else:
            x, y, z = (UInt32(position[axis] * voxels) for axis in range(3))
            here = drjit.gather(Float, extinction, (z * voxels + y) * voxels + x, inside)
            turns = random.next_float32() * greatest < here
            weight = drjit.select(turns, weight * albedo, weight)
        tested = weight < LIGHT
        weight = drjit.select(tested, drjit.select(random.next_float32() < 0.5, 2.0 * weight, 0.0), weight)
        weight = drjit.select(inside, weight, 0.0)
    return tally


def block_fluence(extinction, albedo, histories, seed):
    """Fluence of the blocks, [z][y][x], of unit flux on the face; and the number of histories, a multiple of lanes."""
    lanes = min(LANES, histories)
    each = histories // lanes
    greatest = float(extinction.max())
    tally = trace(Float(extinction.ravel().astype(numpy.float32)), extinction.shape[0], extinction.size == 1,
                  Float(greatest), Float(albedo), lanes, drjit.opaque(UInt32, each), drjit.opaque(UInt32, seed),
                  drjit.zeros(Float64, BLOCKS ** 3))
    sums = numpy.array(tally, dtype=float)  # waits
    return sums.reshape((BLOCKS,) * 3) * (BLOCKS ** 3 / (greatest * each * lanes)), each * lanes
