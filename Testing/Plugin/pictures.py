"""Comparing pictures with baselines in Testing/Baselines, for the tests of the label image.

A picture that differs is in the folder TYNDALL_TEST_OUTPUT under the baseline's name: look at both, and copy it to the
baselines if it is right.
"""
import os

import numpy
from paraview.vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from paraview.vtk.vtkCommonDataModel import vtkImageData
from paraview.vtk.vtkIOImage import vtkPNGReader, vtkPNGWriter

BASELINES = os.path.join(os.environ["TYNDALL_SOURCE"], "Testing/Baselines")


def read(path):
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    return of_image(reader.GetOutput())


def of_image(image, name=None):
    """@return rows x columns x 3 of an image's array, 0 to 255"""
    data = image.GetPointData()
    colors = vtk_to_numpy(data.GetArray(name) if name else data.GetScalars())
    columns, rows, _ = image.GetDimensions()
    return colors.reshape(rows, columns, -1)[:, :, :3].astype(int)


def write(path, pixels):
    rows, columns, _ = pixels.shape
    image = vtkImageData()
    image.SetDimensions(columns, rows, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(pixels.reshape(-1, 3).astype(numpy.uint8), deep=True))
    writer = vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetInputData(image)
    writer.Write()


def compare(name, pixels, mean=1.0, part=0.01):
    """
    @param mean  difference from the baseline at most, of 255, on the average of pixels
    @param part  of the pixels that may differ by more than 24 of 255
    @return what is wrong, a list
    """
    write(os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], name + ".png"), pixels)
    path = os.path.join(BASELINES, name + ".png")
    if not os.path.exists(path):
        return [name + ": there is no baseline"]
    baseline = read(path)
    if baseline.shape != pixels.shape:
        return ["%s: %s pixels instead of %s" % (name, pixels.shape, baseline.shape)]
    difference = abs(pixels - baseline).max(axis=2)
    found = difference.mean(), (difference > 24).mean()
    print("%s: mean difference %.3f of 255, %.3f%% of pixels differ" % (name, found[0], 100 * found[1]))
    return [] if found[0] <= mean and found[1] <= part else ["%s differs: %g, %g" % ((name,) + found)]
