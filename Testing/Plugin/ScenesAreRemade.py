"""What is in Data/Scenes is what make_scenes.py makes, and what it is said to be: small, closed, with air around it."""
import collections
import filecmp
import os
import runpy
import sys

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

SCENES = os.path.join(os.environ["TYNDALL_SOURCE"], "Data/Scenes")
MADE = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "scenes")

script = os.path.join(SCENES, "make_scenes.py")
sys.argv = [script, "--output", MADE]
runpy.run_path(script, run_name="__main__")
LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def voxels(reader, folder, name, array):
    image = servermanager.Fetch(reader(os.path.join(folder, name)))
    size = [n - 1 for n in image.GetDimensions()]
    return vtk_to_numpy(image.GetCellData().GetArray(array)).astype(float).reshape(size[::-1]), image.GetSpacing()


def vdb(path):
    return VDBReader(FileName=path)


def vti(path):
    return XMLImageDataReader(FileName=[path])


# Numbers are rounded to steps: another processor's last bit may tip one over.
for name, array, reader, step in (("cumulus.vdb", "liquid_water", vdb, 1e-3), ("plume.vti", "smoke", vti, 1e-3),
                                  ("hall.vti", "sigma_a", vti, 4e-3), ("hall.vti", "sigma_s", vti, 4e-3)):
    (kept, spacing), (made, again) = (voxels(reader, folder, name, array) for folder in (SCENES, MADE))
    assert kept.shape == made.shape and numpy.allclose(spacing, again), (name, kept.shape, made.shape)
    off = abs(kept - made)
    assert off.max() < 1.01 * step and (off > 0).mean() < 1e-4, (name, off.max(), (off > 0).mean())
    assert kept.min() >= 0, name
    if name != "hall.vti":  # there is air around it, but below what rises from below
        assert 0.5 < kept.max() < 2 and 0.02 < (kept > 0).mean() < 0.5, (name, kept.max(), (kept > 0).mean())
        sides = [kept[-1], kept[:, 0], kept[:, -1], kept[:, :, 0], kept[:, :, -1]]
        assert max(side.max() for side in sides) < 0.01, (name, [side.max() for side in sides])
for name in ("goblet.ply", "sky.hdr", "studio.hdr"):
    assert filecmp.cmp(os.path.join(SCENES, name), os.path.join(MADE, name), shallow=False), name
for name in os.listdir(SCENES):
    assert os.path.getsize(os.path.join(SCENES, name)) < 1e6, name

mesh = servermanager.Fetch(PLYReader(FileNames=[os.path.join(SCENES, "goblet.ply")]))
triangles = vtk_to_numpy(mesh.GetPolys().GetData()).reshape(-1, 4)[:, 1:]
edges = collections.Counter((a, b) for t in triangles for a, b in zip(t, numpy.roll(t, -1)))
assert set(edges.values()) == {1} and all((b, a) in edges for a, b in edges), "closed, manifold, of one orientation"
points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
corners = points[triangles]
volume = numpy.einsum("ij,ij->i", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])).sum() / 6
assert 5e4 < volume < 3e5, volume  # mm^3, outsides out
