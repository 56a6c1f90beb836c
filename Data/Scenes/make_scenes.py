"""Makes the media, the mesh and the skies of this folder.    pvpython make_scenes.py [--output FOLDER]

Always the same: what looks random comes from a hash of whole numbers.

    cumulus.vdb  liquid water of a fair-weather cumulus, g/m^3; voxels of 10 m
    plume.vti    smoke that rises from a fire, relative to the fire's; voxels of 2.5 cm
    hall.vti     dusty air in a hall with three windows: sigma_a, sigma_s, 1/m; voxels of 4 cm
    goblet.ply   a glass turned on a lathe, mm: closed, each edge in two triangles
    sky.hdr      a clear sky over grassland, W/(m^2 sr)
    studio.hdr   a dark room with two soft boxes, for glass
"""
import argparse
import math
import os
import struct

import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
CORNERS = [(a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)]
EDGES = numpy.array([[1, 1, 0], [-1, 1, 0], [1, -1, 0], [-1, -1, 0], [1, 0, 1], [-1, 0, 1], [1, 0, -1], [-1, 0, -1],
                     [0, 1, 1], [0, -1, 1], [0, 1, -1], [0, -1, -1]], float)


def hashed(i, j, k, seed):
    """32 bits for each point of a lattice."""
    word = numpy.uint32
    i, j, k = (numpy.asarray(n).astype(word) for n in (i, j, k))
    h = (i * word(0x8da6b343) ^ j * word(0xd8163841) ^ k * word(0xcb1ab31f)) + word(seed * 0x9e3779b1 & 0xffffffff)
    for shift, factor in ((16, 0x7feb352d), (15, 0x846ca68b), (16, 1)):
        h = (h ^ (h >> word(shift))) * word(factor)
    return h


def evenly(i, seed):
    """A number in [0, 1) for each whole number."""
    return hashed(i, 7 * i, 13 * i, seed) / 2.0 ** 32


def eased(t):
    """0 below 0, 1 above 1, smooth between."""
    t = numpy.clip(t, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def perlin(x, y, z, seed, period=None):
    """Perlin's gradient noise, of cells of edge 1; it repeats after `period` of them."""
    i, j, k = (numpy.floor(a).astype(int) for a in (x, y, z))
    f = x - i, y - j, z - k
    blend = [t * t * t * (t * (6 * t - 15) + 10) for t in f]
    total = 0.0
    for corner in CORNERS:
        at = [n + o if period is None else (n + o) % period for n, o in zip((i, j, k), corner)]
        slope = EDGES[hashed(*at, seed) % 12]
        value = sum(slope[..., a] * (f[a] - corner[a]) for a in range(3))
        for b, o in zip(blend, corner):
            value = value * (b if o else 1.0 - b)
        total = total + value
    return total


def fractal(x, y, z, seed, octaves, gain=0.5, shape=lambda n: n):
    """Sum of octaves of noise, each of half the size and `gain` times the one before; their weights add to 1."""
    total, weight, weights = 0.0, 1.0, 0.0
    for octave in range(octaves):
        total = total + weight * shape(perlin(x, y, z, seed + octave))
        weights += weight
        weight *= gain
        x, y, z = 2.03 * x + 11.7, 2.03 * y + 3.1, 2.03 * z + 7.9
    return total / weights


def middles(counts, edge, origin=(0.0, 0.0, 0.0)):
    """Coordinates of the voxels' centres, three arrays [x][y][z]."""
    return numpy.meshgrid(*((numpy.arange(n) + 0.5) * edge + o for n, o in zip(counts, origin)), indexing="ij")


# Cumulus: turrets of merged balls, with smaller balls on them and again on these, like a cauliflower.

TURRETS = ((600, 600, 150, 230), (850, 640, 130, 200), (400, 560, 90, 160), (1080, 600, 80, 130), (700, 420, 90, 150),
           (640, 760, 90, 150), (720, 610, 360, 190), (640, 560, 520, 130), (860, 650, 290, 140), (260, 560, 50, 90))
BASE = 60.0  # of the cloud above the box's floor, m


def balls():
    """x, y, height above the base, radius; m."""
    made, count = [], 0

    def grow(x, y, z, radius, generations):
        nonlocal count
        made.append((x, y, z, radius))
        if generations == 0 or radius < 25.0:
            return
        for _ in range(14 if generations == 2 else 9):
            cosine, turn, size, out = map(float, evenly(numpy.arange(count + 1, count + 5), 11))
            count += 4
            cosine = 2.0 * cosine - 1.0
            cosine = -cosine if cosine < -0.35 else cosine  # few below
            sine, turn, out = math.sqrt(1.0 - cosine * cosine), 2.0 * math.pi * turn, radius * (0.86 + 0.1 * out)
            grow(x + out * sine * math.cos(turn), y + out * sine * math.sin(turn), z + out * cosine,
                 radius * (0.30 + 0.22 * size), generations - 1)

    for turret in TURRETS:
        grow(*turret, 2)
    return made


def distance_to_balls(x, y, z, edge):
    """Of each voxel from the surface of the nearest ball, m; negative inside. Far from all of them: large."""
    distance = numpy.full(x.shape, 1e9)
    for u, v, w, radius in balls():
        w += BASE
        near = tuple(slice(max(0, int((c - radius - 60.0) / edge)), int((c + radius + 60.0) / edge) + 2)
                     for c in (u, v, w))
        away = numpy.sqrt((x[near] - u) ** 2 + (y[near] - v) ** 2 + (z[near] - w) ** 2) - radius
        distance[near] = numpy.minimum(distance[near], away)
    return distance


def cumulus():
    """Grams of liquid water per cubic metre, and the voxels' edge in m."""
    edge = 10.0
    x, y, z = middles((150, 120, 88), edge)
    bent = [fractal(x / 160.0, y / 160.0, z / 160.0, seed, 3) for seed in (1, 21, 41)]
    distance = distance_to_balls(x + 28.0 * bent[0], y + 28.0 * bent[1], z + 18.0 * bent[2], edge)
    billows = fractal(x / 90.0, y / 90.0, z / 90.0, 60, 4, 0.55, lambda n: 1.0 - 2.2 * abs(n))
    distance -= 26.0 * (billows - 0.45)
    floor = BASE + 10.0 * fractal(x / 120.0, y / 120.0, 0.0 * z, 80, 3)
    distance = numpy.maximum(distance, floor - z)
    # Air that rises from the base condenses more and more water; at the edge it mixes with dry air.
    water = 0.15 + 0.9 * numpy.maximum(z - BASE, 0.0) / 700.0
    lumps = 1.0 + 0.6 * fractal(x / 60.0, y / 60.0, z / 60.0, 90, 4, 0.6)
    density = eased(-distance / 14.0) * water * numpy.maximum(lumps, 0.3)
    density[density < 0.01] = 0.0
    return density, edge


# Plume: smoke that is stirred by eddies as large as the plume is wide there, and by smaller ones that these carry.

PERIOD, FINENESS = 8, 6  # of the swirl that repeats: its cells, and samples a cell
EDDIES = ((2.6, 1.05, 8), (1.35, 0.62, 7), (0.7, 0.34, 6), (0.36, 0.15, 4))  # size, way (in plume's radii), steps


def swirl():
    """A velocity without sources, the curl of three noises; rms 1."""
    at = numpy.arange(PERIOD * FINENESS) / FINENESS
    at = numpy.meshgrid(at, at, at, indexing="ij")
    a, b, c = (perlin(*at, seed, PERIOD) for seed in (5, 12, 19))

    def slope(f, axis):
        return (numpy.roll(f, -1, axis) - numpy.roll(f, 1, axis)) * (0.5 * FINENESS)

    curl = numpy.stack([slope(c, 1) - slope(b, 2), slope(a, 2) - slope(c, 0), slope(b, 0) - slope(a, 1)], -1)
    return (curl / math.sqrt((curl ** 2).sum(-1).mean())).astype(numpy.float32)


def carried(field, places):
    """The swirl at places [n][3], between its samples."""
    n = field.shape[0]
    places = places * FINENESS
    low = numpy.floor(places)
    part, low = (places - low).astype(numpy.float32), low.astype(numpy.int32) % n
    high, flat, total = (low + 1) % n, field.reshape(-1, 3), 0.0
    for corner in CORNERS:
        i, j, k = ((high if o else low)[:, axis] for axis, o in enumerate(corner))
        weight = numpy.prod([part[:, axis] if o else 1.0 - part[:, axis] for axis, o in enumerate(corner)], axis=0)
        total = total + flat[(i * n + j) * n + k] * weight[:, None]
    return total


def stirred_smoke(x, y, z, field):
    """Smoke at places, m: 1 in the fire. The plume's radius grows with height, and it leans with the wind."""
    narrow, opening = 0.1, 0.115
    radius = narrow + opening * z
    # Distances in radii of the plume: there eddies are alike at every height.
    q = numpy.stack([(x - 0.018 * z * z) / radius, y / radius, numpy.log(radius / narrow) / opening], -1)
    stirring = eased((z - 0.1) / 0.7)[:, None]
    for number, (size, distance, steps) in enumerate(EDDIES, 1):
        for _ in range(steps):
            q -= carried(field, q / size + number * numpy.array([3.1, 1.7, 0.4])) * (distance / steps * stirring)
    across = numpy.sqrt(q[:, 0] ** 2 + q[:, 1] ** 2)
    puff = q[:, 2] / 1.4
    step = numpy.floor(puff)
    puff = evenly(step, 91) + (evenly(step + 1, 91) - evenly(step, 91)) * eased(puff - step)
    head = eased((math.log((narrow + opening * 3.3) / narrow) / opening - q[:, 2]) / 1.2)  # it has just got there
    return eased((1.0 - across) / 0.35) * head * (0.45 + 0.9 * puff) * (narrow / radius) ** 1.1


def plume():
    """Density of smoke, the voxels' edge in m, and the box's corner: means over 2^3 places a voxel."""
    edge, counts, origin = 0.025, (98, 92, 176), (-1.1, -1.15, 0.0)
    field, density = swirl(), 0.0
    for corner in CORNERS:
        x, y, z = (m.ravel() + (o - 0.5) * 0.5 * edge for m, o in zip(middles(counts, edge, origin), corner))
        near = numpy.flatnonzero((x - 0.018 * z * z) ** 2 + y ** 2 < (3.2 * (0.1 + 0.115 * z)) ** 2)
        part = numpy.zeros(x.size)
        part[near] = stirred_smoke(x[near], y[near], z[near], field)
        density = density + part.reshape(counts) / 8.0
    return numpy.rint(1000.0 * density) / 1000.0, edge, origin


# Hall: dust between stone walls; the front is open. Walls are black outside, so that no light gets through them.

def hall():
    """sigma_a and sigma_s, 1/m, and the voxels' edge in m."""
    edge, counts = 0.04, (128, 80, 86)
    length, width, height = (edge * n for n in counts)
    x, y, z = middles(counts, edge)
    window = numpy.zeros(counts, bool)
    for middle in (-0.72, 0.0, 0.72):
        aside, half, spring = abs(y - 0.5 * width - middle), 0.24, 2.35
        pointed = (z >= spring) & ((aside + half) ** 2 + (z - spring) ** 2 < (2.0 * half) ** 2)
        bar = abs(z - 1.85) < 0.021
        window |= (aside < half) & (z > 1.35) & ((z < spring) | pointed) & ~bar
    black = ((x < 0.16) & ~window) | (y > width - 0.08) | (x > length - 0.08) | (z < 0.04) | (z > height - 0.12)
    # Stone becomes dense within 16 cm: voxels of one mean free path or less look smooth.
    depth = numpy.maximum(numpy.maximum(0.24 - z, y - (width - 0.32)), x - (length - 0.32))
    stone = 26.0 * numpy.clip(depth / 0.16, 0.0, 1.0) ** 2
    dust = 0.14 * numpy.maximum(1.0 + 1.1 * fractal(x / 0.9, y / 0.9, z / 0.6, 7, 4, 0.55), 0.15)
    sigma_a = numpy.where(black, 150.0, 0.3 * stone)
    sigma_s = numpy.where(black, 8.0, 0.7 * stone + dust)
    return numpy.rint(250.0 * sigma_a) / 250.0, numpy.rint(250.0 * sigma_s) / 250.0, edge


# Goblet: radius and height of points of its outline, mm: foot, stem, bowl, rim, and down inside.

OUTLINE = (((0, 0), (20, 0), (36, 0)),
           ((36, 0), (39, 1.2), (40, 3.5), (38.5, 5.6)),
           ((38.5, 5.6), (28, 8), (16, 11), (9.5, 17), (7.5, 26), (8, 33), (12.5, 38), (13.5, 42), (11.5, 46.5),
            (7.8, 51), (7.6, 57), (11, 63)),
           ((11, 63), (22, 68.5), (33, 78), (40, 92), (42, 108), (40.5, 126), (38.5, 140)),
           ((38.5, 140), (37.6, 143), (35.4, 144.2), (33, 142.8), (32.4, 140)),
           ((32.4, 140), (34, 126), (35.2, 108), (33, 93), (26.5, 83), (15, 77.5), (0, 76)))


def smooth_line(points, parts):
    """Catmull and Rom's spline through points, each stretch in so many parts."""
    ends = (points[0], *points, points[-1])
    line = []
    for a, b, c, d in zip(ends, ends[1:], ends[2:], ends[3:]):
        for t in (n / parts for n in range(parts)):
            line.append(tuple(0.5 * (2 * q + (r - p) * t + (2 * p - 5 * q + 4 * r - s) * t * t
                                     + (3 * q - p - 3 * r + s) * t * t * t) for p, q, r, s in zip(a, b, c, d)))
    return line + [tuple(map(float, points[-1]))]


def goblet(around=96):
    """Points and triangles of the outline turned about z, outsides out."""
    line = []
    for piece in OUTLINE:
        line = line[:-1] + smooth_line(piece, 4)
    points, triangles = [(0.0, 0.0, line[0][1])], []
    for radius, height in line[1:-1]:
        for turn in (2.0 * math.pi * n / around for n in range(around)):
            points.append((radius * math.cos(turn), radius * math.sin(turn), height))
    points.append((0.0, 0.0, line[-1][1]))
    rings, last = len(line) - 2, len(points) - 1
    for n in range(around):
        m = (n + 1) % around
        triangles.append((0, 1 + m, 1 + n))
        for ring in range(rings - 1):
            a, b = 1 + ring * around, 1 + (ring + 1) * around
            triangles += [(a + n, a + m, b + m), (a + n, b + m, b + n)]
        triangles.append((last - around + n, last - around + m, last))
    return points, triangles


# Skies: rows from the zenith down, columns from azimuth -180 degrees on, red, green, blue.

def directions(rows):
    """Elevation's sine and azimuth in degrees of each pixel."""
    elevation = (0.5 - (numpy.arange(rows) + 0.5) / rows) * math.pi
    azimuth = -180.0 + 180.0 / rows * (numpy.arange(2 * rows) + 0.5)
    return numpy.meshgrid(numpy.sin(elevation), azimuth, indexing="ij")


def sky():
    up, _ = directions(128)
    high = numpy.sqrt(numpy.maximum(up, 0.0))[..., None]
    air = numpy.array([80.0, 98.0, 122.0]) * (1.0 - high) + numpy.array([10.0, 24.0, 60.0]) * high
    return numpy.where(up[..., None] > 0.0, air, [27.0, 29.0, 18.0])


def studio():
    up, azimuth = directions(96)
    room = 0.05 + 0.25 * eased(0.5 + 1.2 * up)[..., None] * numpy.array([0.85, 0.95, 1.1])
    for middle, width, low, high, light in ((-150.0, 22.0, -0.1, 0.75, (5.0, 4.9, 4.7)),
                                            (20.0, 14.0, 0.0, 0.8, (2.6, 2.9, 3.4))):
        aside = abs((azimuth - middle + 180.0) % 360.0 - 180.0)
        box = eased((width - aside) / 3.0) * eased((up - low) / 0.04) * eased((high - up) / 0.04)
        room = room + box[..., None] * numpy.array(light)
    return room


def rgbe(pixels):
    """Radiance's four bytes a pixel."""
    largest = pixels.max(axis=-1)
    fraction, exponent = numpy.frexp(largest)
    scale = numpy.where(largest > 0.0, fraction * 256.0 / numpy.maximum(largest, 1e-30), 0.0)
    return numpy.concatenate([pixels * scale[..., None], exponent[..., None] + 128.0], axis=-1).astype(numpy.uint8)


def runs_of(row):
    """Radiance's packing of one channel of a row: equal bytes as a count and the byte, others as they are."""
    packed, at = b"", 0
    while at < len(row):
        run = 1
        while at + run < len(row) and run < 127 and row[at + run] == row[at]:
            run += 1
        packed += bytes((128 + run, row[at])) if run > 2 else bytes((run,)) + row[at:at + run]
        at += run
    return packed


def write_sky(path, pixels):
    rows, columns, _ = pixels.shape
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (rows, columns))
        for row in rgbe(pixels):
            file.write(struct.pack(">BBH", 2, 2, columns))
            file.write(b"".join(runs_of(row[:, channel].tobytes()) for channel in range(4)))


def write_mesh(path, points, triangles):
    with open(path, "wb") as file:
        file.write(b"ply\nformat binary_little_endian 1.0\ncomment A goblet, mm; made by make_scenes.py of Tyndall\n"
                   b"element vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
                   b"element face %d\nproperty list uchar int vertex_indices\nend_header\n"
                   % (len(points), len(triangles)))
        file.write(numpy.array(points, dtype="<f4").tobytes())
        for triangle in triangles:
            file.write(struct.pack("<B3i", 3, *triangle))


def image(arrays, edge, origin=(0.0, 0.0, 0.0)):
    """Values [x][y][z], by their names, as cells of a vtkImageData."""
    from paraview.vtk.util.numpy_support import numpy_to_vtk
    from paraview.vtk.vtkCommonDataModel import vtkImageData
    data = vtkImageData()
    data.SetSpacing(edge, edge, edge)
    data.SetOrigin(*origin)
    for name, array in arrays.items():
        data.SetDimensions(*(n + 1 for n in array.shape))
        values = numpy_to_vtk(array.ravel(order="F").astype(numpy.float32), deep=True)
        values.SetName(name)
        data.GetCellData().AddArray(values)
    data.GetCellData().SetActiveScalars(next(iter(arrays)))
    return data


def write_vdb(path, data):
    from paraview import simple
    simple.LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    source.UpdatePipeline()
    VDBWriter(Input=source, FileName=path, SaveAsHalf=1).UpdatePipeline()  # noqa: F821, of the plugin


def write_vti(path, data):
    from paraview.vtk.vtkIOXML import vtkXMLImageDataWriter
    writer = vtkXMLImageDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(data)
    writer.SetCompressionLevel(9)
    writer.EncodeAppendedDataOff()
    writer.Write()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--output", default=HERE)
    output = parser.parse_args().output
    os.makedirs(output, exist_ok=True)

    density, edge = cumulus()
    write_vdb(os.path.join(output, "cumulus.vdb"), image({"liquid_water": density}, edge))
    density, edge, origin = plume()
    write_vti(os.path.join(output, "plume.vti"), image({"smoke": density}, edge, origin))
    sigma_a, sigma_s, edge = hall()
    write_vti(os.path.join(output, "hall.vti"), image({"sigma_a": sigma_a, "sigma_s": sigma_s}, edge))
    write_mesh(os.path.join(output, "goblet.ply"), *goblet())
    write_sky(os.path.join(output, "sky.hdr"), sky())
    write_sky(os.path.join(output, "studio.hdr"), studio())


if __name__ == "__main__":
    main()
