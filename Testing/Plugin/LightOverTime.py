"""The example time_series.py: each step begins from the light of the one before, and is as if it had not."""
import os
import runpy
import sys

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

folder = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "time_series")
os.makedirs(folder, exist_ok=True)
script = os.path.join(os.environ["TYNDALL_SOURCE"], "Plugin/Examples/time_series.py")
sys.argv = [script, folder, "--steps", "4"]
runpy.run_path(script, run_name="__main__")
LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def fluence(image):
    return vtk_to_numpy(image.GetCellData().GetArray("fluence")).astype(float)


# The last step again, from darkness on and to more digits.
last = servermanager.Fetch(XMLImageDataReader(FileName=[os.path.join(folder, "light_3.vti")]))
medium = ParticipatingMedium(Input=XMLImageDataReader(FileName=[os.path.join(folder, "smoke_3.vti")]), ExtinctionScale=0.8)
light = LightPropagationMaps(Input=medium, Lights=LightRig(SunElevation=31, SunAzimuth=180), SkyColor=[0.2, 0.2, 0.2],
                             Tolerance=1e-7)
exact = fluence(servermanager.Fetch(light))
error = numpy.sqrt(((fluence(last) - exact)**2).sum() / (exact**2).sum())
print("error of the last step %.2g" % error)
assert error < 1e-4

# Only a light that is kept is a column of the table.
def columns():
    table = servermanager.Fetch(light, idx=1)
    return [table.GetColumnName(i) for i in range(table.GetNumberOfColumns())]


assert "sweeps_saved" not in columns()
light.WarmStart = 1
light.Tolerance = 1e-4
light.UpdatePipeline()
assert "sweeps_saved" in columns()
light.UpdatePropertyInformation()
first = light.Orders
assert light.SweepsSaved == 0 and "there is none" in light.LeftOut
light.SkyColor = [0.21, 0.21, 0.21]
light.UpdatePipeline()
light.UpdatePropertyInformation()
assert light.Orders < first and light.SweepsSaved > 0 and "begun from the last light" in light.LeftOut, light.LeftOut
light.DirectionsPerFace = 16
light.UpdatePipeline()
light.UpdatePropertyInformation()
assert light.SweepsSaved == 0 and "the directions have changed" in light.LeftOut, light.LeftOut
