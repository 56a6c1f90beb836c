"""A cloud of water under the sun: its energy balance, and a picture.    python -m tyndall.demo [PICTURE.png]

The scene of Plugin/Examples/cloud.py, without ParaView.
"""
import sys

import numpy
import tyndall
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData
from vtkmodules.vtkFiltersCore import vtkArrayCalculator
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkIOImage import vtkPNGWriter

SKY = (0.03, 0.06, 0.13)


def cloud():
    """A cloud 480 m wide in voxels of 10 m: a ball of water, modulated by waves."""
    box = vtkRTAnalyticSource()
    box.SetWholeExtent(-24, 24, -24, 24, -24, 24)
    box.SetMaximum(1.0)
    box.SetStandardDeviation(0.3)
    box.SetXMag(0.13), box.SetYMag(0.11), box.SetZMag(0.14)
    box.SetXFreq(17.0), box.SetYFreq(13.0), box.SetZFreq(19.0)
    water = vtkArrayCalculator()
    water.SetInputConnection(box.GetOutputPort())
    water.AddScalarArrayName("RTData")
    water.SetResultArrayName("density")
    water.SetFunction("0.5*max(0,RTData-0.5)")
    medium = tyndall.vtkParticipatingMedium()
    medium.SetInputConnection(water.GetOutputPort())
    medium.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, "density")
    medium.SetPreset(medium.CLOUD)
    medium.SetMaximumDensity(1.0)
    medium.SetMillimetresPerUnit(10000.0)
    medium.Update()
    return medium.GetOutputDataObject(0)


def write(pixels, name):
    """Writes a picture as tyndall.picture returns it."""
    image = vtkImageData()
    image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
    colors = numpy_to_vtk(numpy.ascontiguousarray(pixels[::-1]).reshape(-1, pixels.shape[2]), deep=True)
    image.GetPointData().SetScalars(colors)
    writer = vtkPNGWriter()
    writer.SetInputData(image)
    writer.SetFileName(name)
    writer.Write()


def main(name="cloud.png"):
    sun = tyndall.vtkLightRig()
    sun.SetSunElevation(30.0)
    sun.SetSunAzimuth(180.0)
    sun.SetSunPower(4.0, 3.7, 3.2)
    print("Solving; the first solve compiles the kernels, which takes a minute or two.", flush=True)
    light = tyndall.solve(cloud(), lights=sun, sky=SKY, Tolerance=5e-3)
    for term, power in light.energy_balance.items():
        print(f"{term:10} {' '.join(f'{channel:12.6e}' for channel in power)} W")
    power = {term: numpy.sum(channels) for term, channels in light.energy_balance.items()}
    error = 1.0 - (power["absorbed"] + power["escaped"] + power["left over"]) / (power["entered"] + power["emitted"])
    print(f"{len(light.convergence['iteration'])} orders, energy balance to {abs(error):.0e} in {light.seconds:.2f} s")
    write(tyndall.picture(light, (400, 300), LightsConnection=sun.GetOutputPort(), BackgroundRadiance=SKY,
                          CameraPosition=(50.0, -95.0, 45.0), CameraViewAngle=24.0), name)
    print(f"The picture: {name}")


if __name__ == "__main__":
    main(*sys.argv[1:2])
