"""Comparing pictures with those of Data/Baseline, for the tests of the label image.

A picture that differs is in the folder TYNDALL_TEST_OUTPUT under the baseline's name: look at both. If it is right,
`./run baselines` makes it the baseline: it sets TYNDALL_REMAKE_BASELINES, and pictures that differ or are new are written
to Data/Baseline.

"""
import os

import numpy
from paraview.vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from paraview.vtk.vtkCommonDataModel import vtkImageData
from paraview.vtk.vtkIOImage import vtkPNGReader, vtkPNGWriter

BASELINES = os.path.join(os.environ["TYNDALL_SOURCE"], "Data/Baseline")

# What may differ is rounding; one machine gives the same bits each time. Measured on all pictures:
#   0.0105 of 255 in the mean at most, 0.004% of the pixels (edges of glass)  between this machine (AVX-512) and kernels
#       that PoCL compiled for Haswell, Sandy Bridge and plain x86-64, with Mesa drawing by vectors of 128 bits
#   0.07 to 1.4    a lamp 2% brighter, where exposure is fixed
#   0.5            one of its colours 4% weaker
#   0.06 to 0.6    the sun 3 degrees further (least: the cloud of cloud.py)
#   0.8 to 1.0     a refractive index of 1.51 instead of 1.5
#   2.2            the camera turned by one pixel
MEAN, PART = 0.05, 0.0005


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
    writer.SetCompressionLevel(9)
    writer.Write()


def difference(name, pixels, mean, part, folder=BASELINES):
    """@return what is wrong with a picture, a list"""
    path = os.path.join(folder, name + ".png")
    if not os.path.exists(path):
        return [name + ": there is no baseline"]
    baseline = read(path)
    if baseline.shape != pixels.shape:
        return ["%s: %s pixels instead of %s" % (name, pixels.shape, baseline.shape)]
    off = abs(pixels - baseline).max(axis=2)
    found = off.mean(), (off > 24).mean()
    print("%s: mean difference %.4f of 255 (at most %g), %.4f%% of pixels differ (at most %g%%)" % (
        name, found[0], mean, 100 * found[1], 100 * part))
    return [] if found[0] <= mean and found[1] <= part else ["%s differs: %g, %g" % ((name,) + found)]


def compare(name, pixels, mean=MEAN, part=PART, folder=BASELINES):
    """
    @param mean  difference from the baseline at most, of 255, on the average of pixels
    @param part  of the pixels that may differ by more than 24 of 255
    @param folder  of the baseline
    @return what is wrong, a list
    """
    write(os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], name + ".png"), pixels)
    wrong = difference(name, pixels, mean, part, folder)
    if wrong and "TYNDALL_REMAKE_BASELINES" in os.environ:
        print("Remade: " + wrong[0])
        write(os.path.join(folder, name + ".png"), pixels)
        return []
    return wrong
