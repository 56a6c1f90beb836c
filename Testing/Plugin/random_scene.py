"""Random scenes, by number and seed: a medium, what illuminates it, and how it is solved. numpy only, so that every rank
makes the same scene from the same numbers.
"""
import math

import numpy

SOLVERS = ("maps", "maps", "ordinates", "lattice", "photons")


def with_few_digits(values):
    """Rounded so that a product of two such numbers is a float: what illuminates a scene then has exactly so many times the power."""
    mantissa, exponent = numpy.frexp(values)
    return numpy.ldexp(numpy.round(mantissa * 4096) / 4096, exponent)


class Scene:
    """One random scene. `medium` holds arrays by name, [z][y][x] or [z][y][x][3]; `sources` is what illuminates it, one
    independent part each, so that parts can be solved alone and together."""

    def __init__(self, seed, number):
        self.random = numpy.random.default_rng([seed, number])
        self.name = "scene %d of seed %d" % (number, seed)
        self.solver = self.random.choice(SOLVERS)
        self.size = self.random.integers(3, 15, 3)  # voxels along x, y, z
        edge = 10 ** self.random.uniform(-1.5, 1.5)
        self.spacing = edge * (self.random.uniform(0.5, 2, 3) if self.solver != "lattice" else numpy.ones(3))
        self.origin = edge * self.random.uniform(-30, 30, 3)
        self.periodic = self.random.random(3) < (0.2 if self.solver != "photons" else 0)
        if self.periodic.any():  # over ranks light that wraps around takes a pass through all blocks for each lap
            self.size = numpy.minimum(self.size, 6)
        self.colours = 3 if self.random.random() < 0.3 else 1
        self.medium = self.make_medium()
        self.face_albedo = [0.0] * 6
        if self.solver in ("maps", "ordinates") and self.random.random() < 0.25:
            albedo = self.random.uniform(0, 0.9, 6) * ~numpy.repeat(self.periodic, 2)
            self.face_albedo = [float(a) for a in albedo]
        count = self.random.integers(1, 5)
        self.sources = []
        for _ in range(count):
            self.sources.append(self.make_source())
        self.split = self.random.integers(0, count + 1) if count > 1 else 0

    def pick(self, *choices):
        return choices[self.random.integers(len(choices))]

    def field(self):
        """Values from 0 to 1: noise, blobs, layers or a block in empty space."""
        shape = self.size[::-1]
        kind = self.pick("noise", "blobs", "layers", "block")
        if kind == "noise":
            return self.random.random(shape)
        z, y, x = numpy.meshgrid(*[(numpy.arange(n) + 0.5) / n for n in shape], indexing="ij")
        if kind == "layers":
            return (numpy.floor(4 * self.pick(x, y, z)) % 2) * self.random.random()
        if kind == "block":
            low, high = numpy.sort(self.random.random((2, 3)), axis=0)
            inside = numpy.ones(shape, bool)
            for axis, place in enumerate((x, y, z)):
                inside &= (place >= low[axis]) & (place <= high[axis])
            return inside * 1.0
        blobs = numpy.zeros(shape)
        for _ in range(3):
            centre, width = self.random.random(3), self.random.uniform(0.1, 0.4)
            blobs += numpy.exp(-((x - centre[0]) ** 2 + (y - centre[1]) ** 2 + (z - centre[2]) ** 2) / width ** 2)
        return blobs / blobs.max()

    def make_medium(self):
        """Extinction from 0.01 to 8 mean free paths a voxel at most, and enough absorption that every solve ends soon."""
        most = 10 ** self.random.uniform(-2, 0.9) / self.spacing.max()
        around = (self.size * self.spacing)[self.periodic]
        if len(around) > 0:  # light that wraps around hundreds of times before it is lost takes minutes over ranks
            most = max(most, 3 / around.min())
        extinction = most * self.field()
        albedo = self.random.uniform(0, 0.98) * (self.field() if self.random.random() < 0.3 else 1.0)
        self.g = self.random.uniform(-0.5, 0.85) if self.random.random() < 0.4 and self.solver != "lattice" else 0.0
        colour = self.random.uniform(0.5, 1, 3) if self.colours == 3 else numpy.ones(1)
        arrays = {"sigma_s": (extinction * albedo)[..., None] * colour,
                  "sigma_a": (extinction * (1 - albedo))[..., None] * colour[::-1]}
        if len(around) > 0:
            arrays["sigma_a"] += 0.1 * most
        return arrays

    def place(self, inside):
        """A point in the box, or some box edges beside it."""
        box = self.size * self.spacing
        reach = self.random.random(3)
        if not inside:
            axis = self.random.integers(3)
            reach[axis] = self.pick(-1, 1) * self.random.uniform(1.3, 4) + 0.5
        return [float(p) for p in self.origin + reach * box]

    def direction(self):
        along = self.random.normal(size=3)
        return [float(a) for a in along / numpy.linalg.norm(along)]

    def power(self):
        return [float(p) for p in 10 ** self.random.uniform(-2, 2) *
                (self.random.uniform(0.2, 1, 3) if self.colours == 3 else numpy.ones(3))]

    def make_source(self):
        kinds = ["sun", "point", "spot", "rectangle", "sky", "environment"]
        if self.solver != "photons":  # which send none
            kinds += ["faces", "emission"]
        elif any(s["kind"] == "environment" for s in self.sources):
            kinds.remove("environment")  # rounding of the sum to floats would turn photons by a little, and some then go another way
        kind = self.pick(*kinds)
        around = self.periodic.any()
        if kind in ("point", "spot", "rectangle"):
            edges = self.random.uniform(0.1, 1.5, 2) * (self.size * self.spacing).mean()
            return {"kind": "lamp", "light_type": {"point": 1, "spot": 2, "rectangle": 3}[kind],
                    "position": self.place(around or self.random.random() < 0.5), "direction": self.direction(),
                    "power": self.power(), "size": [float(e) for e in edges], "angle": float(self.random.uniform(5, 180))}
        if kind == "sun":
            return {"kind": "lamp", "light_type": 0, "position": [0.0] * 3, "direction": self.direction(),
                    "power": self.power(), "size": [0.0, 0.0], "angle": 0.0}
        if kind == "emission":
            dark = 1 - self.pick(0.0, 0.9)
            shining = self.field() * (self.random.random(self.size[::-1]) < dark)
            return {"kind": "emission", "values": with_few_digits(shining[..., None] * numpy.array(self.power()[:self.colours]))}
        if kind == "environment":
            return {"kind": "environment", "values": with_few_digits(self.random.random((8, 16, 1)) * numpy.array(self.power()))}
        if kind == "faces":
            return {"kind": "faces", "values": [float(v) for v in self.random.random(6) * (self.random.random(6) < 0.4)]}
        return {"kind": "sky", "values": self.power()}

    def cuts(self, ranks):
        """Extents of cells, a rank each: uneven, along a random axis; a rank may have none."""
        random = numpy.random.default_rng(int(self.size.sum()) + ranks)
        axis = random.integers(3)
        at = numpy.sort(random.integers(0, self.size[axis] + 1, ranks - 1))
        borders = [0, *[int(a) for a in at], int(self.size[axis])]
        extents = []
        for rank in range(ranks):
            extent = [int(e) for n in self.size for e in (0, n)]
            extent[2 * axis:2 * axis + 2] = borders[rank:rank + 2]
            extents.append(extent)
        return extents

    def describe(self):
        kinds = [s["kind"] if s["kind"] != "lamp" else ("sun", "point", "spot", "rectangle")[s["light_type"]]
                 for s in self.sources]
        tau = (self.medium["sigma_s"] + self.medium["sigma_a"]).max() * self.spacing.max()
        return "%s: %s, %s voxels, tau %.2g a voxel, g %.2f, %d colours, periodic %s, face albedo %s, lit by %s, %d of them apart" % (
            self.name, self.solver, "x".join(str(n) for n in self.size), tau, self.g, self.colours,
            "".join(a for a, p in zip("xyz", self.periodic) if p) or "nowhere",
            "yes" if any(self.face_albedo) else "no", ", ".join(kinds), self.split)


def scaled(source, factor):
    """The same source with all of its power times `factor`."""
    def times(values):
        return (numpy.asarray(values) * factor).tolist() if isinstance(values, list) else values * factor

    name = "power" if source["kind"] == "lamp" else "values"
    return {**source, name: times(source[name])}


def is_finite(values):
    return bool(numpy.isfinite(values).all()) and not math.isnan(float(values.sum()))
