"""A Radiance picture is opened by its own reader and brightened; a damaged one is an error without data."""
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
path = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "sky.hdr")
width, height = 8, 4
rows = b"".join(bytes([2, 2, 0, width]) + bytes([128 + width, 128 + 16 * row]) + bytes([128 + width, 64]) * 2 +
                bytes([128 + width, 129]) for row in range(height))
with open(path, "wb") as file:
    file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + rows)


def radiance(proxy):
    proxy.UpdatePipeline()
    data = servermanager.Fetch(proxy)
    return data, vtk_to_numpy(data.GetPointData().GetArray("radiance"))


reader = EnvironmentReader(FileName=path)
data, values = radiance(reader)
assert data.GetDimensions() == (width, height, 1), data.GetDimensions()
assert abs(values[0][0] - (128 + 48 + 0.5) / 128) < 1e-6, "row 0 is the bottom row"
reader.Exposure = 2.0
assert abs(radiance(reader)[1][0][0] - (128 + 48 + 0.5) / 32) < 1e-6
reader.Width = 4
assert radiance(reader)[0].GetDimensions() == (4, 2, 1)
reader.MaximumRadiance = 1.0
assert abs(radiance(reader)[1].max() - 1.0) < 1e-6

with open(path, "ab") as file:
    file.truncate(len(rows))
damaged = EnvironmentReader(FileName=path)
damaged.UpdatePipeline()
assert servermanager.Fetch(damaged).GetNumberOfPoints() == 0
