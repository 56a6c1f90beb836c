"""The light rig's default and added lights arrive as data, and a bad light is an error with empty output."""
import math
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def array(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name)).tolist()


rig = LightRig()
lights = servermanager.Fetch(rig)
assert lights.GetNumberOfPoints() == 1 and lights.GetNumberOfVerts() == 1
assert array(lights, "light_type") == [0]
assert array(lights, "power") == [[1, 1, 1]]
direction = array(lights, "direction")[0]
assert all(abs(a - b) < 1e-12 for a, b in zip(direction, (0.5, 0.5, -math.sqrt(0.5)))), direction

rig.DirectionalLights = [0, 0, -2, 1, 2, 3]
rig.PointLights = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]
rig.SpotLights = [0, 0, 1, 0, 0, -1, 5, 5, 5, 30]
rig.RectangleLights = [0, 0, 4, 0, 0, -1, 6, 6, 6, 2, 3]
rig.UpdatePipeline()
lights = servermanager.Fetch(rig)
assert array(lights, "light_type") == [0, 0, 1, 1, 2, 3]
assert array(lights, "direction")[1] == [0, 0, -1]
assert array(lights, "power")[2:4] == [[4, 5, 6], [10, 11, 12]]
assert lights.GetPoint(3) == (7, 8, 9)
assert array(lights, "angle") == [0, 0, 0, 0, 30, 0]
assert array(lights, "size")[5] == [2, 3]

rig.PointLights = []
rig.Sun = 0
rig.UpdatePipeline()
assert array(servermanager.Fetch(rig), "light_type") == [0, 2, 3]

rig.PointLights = [0, 0, 0, 5, 5]
rig.UpdatePipeline()
assert servermanager.Fetch(rig).GetNumberOfPoints() == 0
rig.PointLights = [0, 0, 0, 5, 5, 5]
rig.UpdatePipeline()
assert array(servermanager.Fetch(rig), "light_type") == [0, 1, 2, 3]
