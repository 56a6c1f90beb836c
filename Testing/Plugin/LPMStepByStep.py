"""Three scattering orders, propagated and collected step by step, are what LightPropagationMaps computes as published."""
import os

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def cells(proxy, name):
    return vtk_to_numpy(servermanager.Fetch(proxy).GetCellData().GetArray(name))


wavelet = Wavelet(WholeExtent=[-6, 6, -5, 5, -4, 4])
medium = Calculator(Input=wavelet, Function="RTData / 300", ResultArrayName="sigma_s")
medium = Calculator(Input=medium, Function="RTData / 2000", ResultArrayName="sigma_a")
sun = LightRig()

together = LightPropagationMaps(Input=medium, Lights=sun, SkyColor=[0.1, 0.2, 0.3], DirectionsPerFace=9,
                                MaximumOrders=3, Scheme="As published")
light = medium
for order in range(3):
    buffers = LPMPropagate(Input=light, Lights=sun, SkyColor=[0.1, 0.2, 0.3], DirectionsPerFace=9)
    buffers.UpdatePipeline()
    buffers.UpdatePropertyInformation()
    assert buffers.Order == order, buffers.Order
    assert buffers.Bytes == 6 * 9 * 3 * 4 * 13 * 11 * 9, buffers.Bytes
    assert buffers.Seconds > 0, buffers.Seconds
    assert cells(buffers, "T_zmin").shape == (13 * 11 * 9, 27)
    light = LPMCollect(Input=buffers)

expected = cells(together, "fluence")
difference = numpy.abs(cells(light, "fluence") - expected).max()
assert expected.min() > 0 and difference < 2e-6 * expected.max(), difference
assert cells(light, "unscattered").shape == (13 * 11 * 9, 18)
light.UpdatePropertyInformation()
assert light.Seconds > 0, light.Seconds
