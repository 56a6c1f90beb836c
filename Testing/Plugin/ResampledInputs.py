"""What is no image becomes one by Resample To Image: unstructured grids, adaptive meshes, blocks; .pvti is read as it is. The light is that of
the image that they were made of."""
import os

import numpy
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def balance(density):
    """@return absorbed and escaped, of all power that came in"""
    medium = ParticipatingMedium(Input=density, DensityArray=["POINTS", "RTData"], ExtinctionScale=0.2)
    light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=4)
    light.UpdatePipeline()
    output = light.GetClientSideObject().GetOutputDataObject(0)
    fluence = vtk_to_numpy(output.GetCellData().GetArray("fluence"))
    assert fluence.size and numpy.isfinite(fluence).all() and fluence.max() > 0
    entered, _, absorbed, escaped, _ = vtk_to_numpy(output.GetFieldData().GetArray("energy_balance"))
    return numpy.array([absorbed, escaped]) / entered


def check(found, expected, tolerance, what):
    print("%s: absorbed %.5f, escaped %.5f" % (what, *found))
    assert abs(found - expected).max() < tolerance, (what, found, expected)


image = Wavelet(WholeExtent=[-8, 8, -7, 7, -6, 6])
expected = balance(image)
cells = Tetrahedralize(Input=image)
same = {"UseInputBounds": 0, "SamplingBounds": [-8, 8, -7, 7, -6, 6], "SamplingDimensions": [17, 15, 13]}
check(balance(ResampleToImage(Input=cells, **same)), expected, 1e-3, "tetrahedra")
adaptive = ImageDataToAMR(Input=image)
check(balance(ResampleToImage(Input=adaptive, **same)), expected, 1e-3, "adaptive mesh")
halves = [ExtractSubset(Input=image, VOI=[*ends, -7, 7, -6, 6]) for ends in ([-8, 0], [0, 8])]
check(balance(ResampleToImage(Input=GroupDatasets(Input=halves), **same)), expected, 1e-6, "blocks")
path = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "ResampledInputs.pvti")
SaveData(path, proxy=image)
check(balance(XMLPartitionedImageDataReader(FileName=[path])), expected, 1e-6, ".pvti")
