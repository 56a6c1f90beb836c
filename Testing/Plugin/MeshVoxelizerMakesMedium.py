"""Meshes become media of voxels, by what is on the panel: one mesh, several, open ones, and what ParaView draws of them."""
import os

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def cells(source, name):
    array = servermanager.Fetch(source).GetCellData().GetArray(name)
    return vtk_to_numpy(array) if array else None


ball = Sphere(Radius=1, ThetaResolution=40, PhiResolution=40)
medium = MeshVoxelizer(Input=ball, SampleDimensions=[24, 24, 24])
medium.UpdatePipeline()
medium.UpdatePropertyInformation()
assert abs(medium.OccupiedVolume - 4.15) < 0.05, medium.OccupiedVolume
assert medium.Seconds > 0 and medium.DeviceName and not medium.LeftOut
n, occupancy = cells(medium, "ior"), cells(medium, "occupancy")
assert n.shape == (24 ** 3,) and n.min() == 1 and abs(n.max() - 1.5) < 1e-3
assert cells(medium, "ior_gradient").shape == (24 ** 3, 3)
assert occupancy.min() == 0 and occupancy.max() == 1 and ((occupancy > 0) & (occupancy < 1)).any()
edge = medium.GetDataInformation().GetBounds()[1] - medium.GetDataInformation().GetBounds()[0]
fog = 0.5 / edge  # untouched, what suits the box
assert numpy.allclose(medium.UsedOutsideScattering, fog, rtol=1e-9), (medium.UsedOutsideScattering, edge)
assert abs(cells(medium, "sigma_s") - fog * (1 - occupancy)).max() < 1e-6

# What later filters take: the octree, and a volume on the screen.
octree = RefractionOctree(Input=medium)
assert cells(octree, "octree_level").max() >= 1
view = CreateView("RenderView", ViewSize=[100, 100])
Show(medium, view, "UniformGridRepresentation")
Render(view)

# Several meshes, the second of a material of its own.
box = Box(XLength=0.6, YLength=0.6, ZLength=0.6)
both = MeshVoxelizer(Input=[ball, box], SampleDimensions=[24, 24, 24], FilterSize=1,
                     Materials=[1, 1.33, 0.2, 0.4, 0.6, 0, 0, 0, 0])
n = cells(both, "ior").reshape(24, 24, 24)
assert abs(n[12, 12, 12] - 1.33) < 1e-6 and abs(n[12, 12, 6] - 1.5) < 1e-6, (n[12, 12, 12], n[12, 12, 6])
assert cells(both, "sigma_s").shape == (24 ** 3, 3)
both.Materials = [1, 1.33, 0.2, 0.4]  # not whole: an error, and no medium
both.UpdatePipeline()
assert both.GetDataInformation().GetNumberOfCells() == 0
both.Materials = []
both.MaterialArray = ["CELLS", "foo"]
both.UpdatePipeline()
assert both.GetDataInformation().GetNumberOfCells() == 0
both.MaterialArray = ["CELLS", "material_id"]
both.Input = ball
n = cells(both, "ior").reshape(24, 24, 24)
assert abs(n[12, 12, 12] - 1.5) < 1e-6, n[12, 12, 12]

# A constant index is written; what it makes needless is not.
medium.InsideIndex = 1
medium.UpdatePipeline()
medium.UpdatePropertyInformation()
assert set(cells(medium, "ior")) == {1} and cells(medium, "ior_gradient") is None
assert "ior_gradient" in medium.LeftOut, medium.LeftOut

# A box, of the panel's numbers.
medium.InsideIndex = 1.5
medium.ModelBounds = [-2, 2, -1, 1, -1, 1]
medium.UpdatePipeline()
assert medium.GetDataInformation().GetBounds() == (-2, 2, -1, 1, -1, 1), medium.GetDataInformation().GetBounds()

# Half a ball is open: nothing comes out, and nothing dies.
half = Sphere(ThetaResolution=20, EndTheta=180)
nothing = MeshVoxelizer(Input=half)
nothing.UpdatePipeline()
assert nothing.GetDataInformation().GetNumberOfCells() == 0
