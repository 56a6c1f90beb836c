"""Fluence of blocks by Mitsuba 3: its integrator volpath follows light back from random points of each block along random
directions; 4 pi times the mean radiance is the fluence (Mitsuba has no tally of fluence)."""
import drjit
import mitsuba
import numpy

from scenes import BLOCKS

mitsuba.set_variant("llvm_ad_mono")
ROULETTE_DEPTH = 1000  # Mitsuba's 5 takes 5% of the paths a collision where 1% is absorbed: the noise then has no end


def side(axis, degrees, **more):
    to = mitsuba.ScalarTransform4f
    half = to().translate([0.5, 0.5, 0.5])
    return {"type": "rectangle", "bsdf": {"type": "null"},
            "to_world": half @ to().rotate(axis, degrees) @ to().translate([0, 0, 0.5]) @ to().scale([0.5, 0.5, 1]), **more}


def load(extinction, albedo):
    """Six squares around the medium. The one that shines faces inwards: the medium is on its outer side by Mitsuba's count,
    and no gap between lamp and medium, which its ray offsets would jump, is needed."""
    if extinction.size == 1:
        medium = {"type": "homogeneous", "albedo": albedo, "sigma_t": float(extinction.max())}
    else:
        grid = mitsuba.VolumeGrid(extinction[..., None].astype(numpy.float32))
        medium = {"type": "heterogeneous", "albedo": albedo,
                  "sigma_t": {"type": "gridvolume", "grid": grid, "filter_type": "nearest", "raw": True}}
    scene = {"type": "scene", "medium": {**medium, "id": "medium"},
             "integrator": {"type": "volpath", "max_depth": 1000000, "rr_depth": ROULETTE_DEPTH}}
    inside = {"type": "ref", "id": "medium"}
    for number, (axis, degrees) in enumerate((([0, 1, 0], 90), ([0, 1, 0], -90), ([1, 0, 0], 90), ([1, 0, 0], -90),
                                              ([0, 1, 0], 0))):
        scene["side%d" % number] = side(axis, degrees, interior=inside)
    lamp = side([0, 1, 0], 0, exterior=inside, emitter={"type": "area", "radiance": 1.0 / numpy.pi})
    lamp["to_world"] = mitsuba.ScalarTransform4f().translate([0.5, 0.5, 0.0]).scale([0.5, 0.5, 1])
    scene["lamp"] = lamp
    return mitsuba.load_dict(scene)


def block_fluence(scene, samples, seed):
    """Fluence of the blocks, [z][y][x], by so many paths a block."""
    count = BLOCKS ** 3 * samples
    sampler = mitsuba.load_dict({"type": "independent"})
    sampler.seed(seed, count)
    block = drjit.arange(mitsuba.UInt32, count) // drjit.opaque(mitsuba.UInt32, samples)
    corner = mitsuba.Point3f(block % BLOCKS, (block // BLOCKS) % BLOCKS, block // BLOCKS ** 2)
    origin = (corner + mitsuba.Point3f(sampler.next_1d(), sampler.next_1d(), sampler.next_1d())) / BLOCKS
    direction = mitsuba.warp.square_to_uniform_sphere(sampler.next_2d())
    medium = next(shape.interior_medium() for shape in scene.shapes() if shape.interior_medium() is not None)
    ray = mitsuba.RayDifferential3f(mitsuba.Ray3f(origin, direction))
    radiance = scene.integrator().sample(scene, sampler, ray, medium)[0][0]
    mean = drjit.block_sum(radiance, samples) * (4.0 * numpy.pi / samples)
    return numpy.array(mean, dtype=float).reshape((BLOCKS,) * 3)  # waits
