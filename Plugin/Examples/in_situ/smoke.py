"""A simulation that hands its field to ParaView Catalyst while it runs: smoke that rises and curls.

    eval "$(./run env)"
    python3 Plugin/Examples/in_situ/smoke.py Plugin/Examples/in_situ/light.py [OUTPUT FOLDER] [--steps 24]

The script, light.py, lights it and makes a picture of each step. The simulation knows nothing of light: what it hands over
is a density.
"""
import argparse
import os

import numpy
from paraview.catalyst import bridge
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData

VOXELS = 40
SPACING = 1.0 / VOXELS  # edge of a voxel, m
STEP = 0.06  # time step, s


def velocity(place, time):
    """m/s at places [3, n]: up in the middle, round about the axis, and waves that break it up."""
    x, y, z = place
    rise = 0.5 * numpy.exp(-8.0 * ((x - 0.5)**2 + (y - 0.5)**2))
    u = 0.5 * (0.5 - y) + 0.10 * numpy.sin(9.0 * z - 2.0 * time)
    v = 0.5 * (x - 0.5) + 0.10 * numpy.cos(7.0 * z + 3.0 * time)
    return numpy.array([u, v, rise])


def interpolated(field, place):
    """Linear between voxel centres, 0 outside."""
    at = place / SPACING - 0.5
    below = numpy.floor(at).astype(int)
    part = at - below
    padded = numpy.pad(field, 1)
    result = 0.0
    for corner in numpy.ndindex(2, 2, 2):
        index = [numpy.clip(below[axis] + corner[axis] + 1, 0, VOXELS + 1) for axis in range(3)]
        weight = numpy.prod([part[axis] if corner[axis] else 1.0 - part[axis] for axis in range(3)], axis=0)
        result = result + weight * padded[tuple(index)]
    return result


def step(smoke, place, time, duration):
    """Smoke is carried along, and new smoke comes up from below."""
    carried = interpolated(smoke, place - duration * velocity(place, time)).reshape(smoke.shape)
    x, y, z = (axis.reshape(smoke.shape) for axis in place)
    source = numpy.exp(-200.0 * ((x - 0.5)**2 + (y - 0.5)**2 + (z - 0.12)**2))
    return carried + 3.0 * duration * source


def image_of(smoke):
    """As VTK has it: x runs fastest."""
    image = vtkImageData()
    image.SetDimensions(VOXELS + 1, VOXELS + 1, VOXELS + 1)
    image.SetSpacing(SPACING, SPACING, SPACING)
    array = numpy_to_vtk(smoke.ravel(order="F"))
    array.SetName("density")
    image.GetCellData().SetScalars(array)
    return image


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("script")
    parser.add_argument("folder", nargs="?", default=os.environ.get("TYNDALL_TEST_OUTPUT", "."))
    parser.add_argument("--steps", type=int, default=24)
    options = parser.parse_args()
    os.environ["IN_SITU_FOLDER"] = os.path.abspath(options.folder)  # folder of the output, for the Catalyst script
    bridge.initialize()
    bridge.add_pipeline(options.script, 2)
    centres = (numpy.arange(VOXELS) + 0.5) * SPACING
    place = numpy.array(numpy.meshgrid(centres, centres, centres, indexing="ij")).reshape(3, -1)
    smoke = numpy.zeros((VOXELS, VOXELS, VOXELS))
    for number in range(options.steps):
        smoke = step(smoke, place, number * STEP, STEP)
        bridge.coprocess((number + 1) * STEP, number, image_of(smoke))
    bridge.finalize()


if __name__ == "__main__":
    main()
