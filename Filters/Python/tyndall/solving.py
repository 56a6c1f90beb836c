"""numpy in, numpy out: the filters in a few lines, for scripts and notebooks.

All arrays are indexed [x, y, z], and a last index holds red, green and blue where there is colour. Lengths are in the
unit of `spacing`; light is in W of that unit (fluence in W / length^2).
"""
import dataclasses
import warnings

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData, vtkPolyData, vtkTable
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm

from . import vtkTyndall as classes

METHODS = {
    "maps": classes.vtkLightPropagationMaps,
    "ordinates": classes.vtkDiscreteOrdinates,
    "lattice": classes.vtkLatticeBoltzmannLighting,
}


class SolvingError(RuntimeError):
    """What a filter reported as an error."""


@dataclasses.dataclass
class Light:
    """What a solver found. `light["name"]` is any cell array of `image`, as it lies in memory there, not a copy."""

    image: vtkImageData  # the medium's voxels with all arrays, as input of further filters, writers or plotters
    table: vtkTable  # convergence of the solve, one row per iteration
    seconds: float = 0.0  # run time of the solver

    def __getitem__(self, name):
        array = self.image.GetCellData().GetArray(name)
        if array is None:
            raise KeyError(f"{name}: there is {', '.join(self.names)}")
        return by_voxels(vtk_to_numpy(array), self.image)

    @property
    def names(self):
        data = self.image.GetCellData()
        return [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]

    @property
    def fluence(self):
        """Radiance integrated over all directions, W / length^2."""
        return self["fluence"]

    @property
    def convergence(self):
        """The columns of the table, by name."""
        columns = [self.table.GetColumn(i) for i in range(self.table.GetNumberOfColumns())]
        return {column.GetName(): vtk_to_numpy(column) for column in columns}

    @property
    def energy_balance(self):
        """W entered, emitted, absorbed, escaped and left over, each a number or red, green and blue."""
        tuples = vtk_to_numpy(self.image.GetFieldData().GetArray("energy_balance"))
        return dict(zip(("entered", "emitted", "absorbed", "escaped", "left over"), tuples))

    @property
    def left_out(self):
        """What the scene did not need, a line each."""
        text = self.image.GetFieldData().GetAbstractArray("left_out")
        return [text.GetValue(i) for i in range(text.GetNumberOfValues())] if text else []


def solve(medium, spacing=None, *, origin=None, extinction=None, albedo=None, g=None, emission=None, lights=None,
          sky=None, environment=None, method="maps", **properties):
    """Light that is scattered many times in a medium.

    medium       density of each voxel, [x, y, z] (of which extinction and albedo make the medium); or a dict with
                 sigma_a, sigma_s and perhaps emission, [x, y, z] or [x, y, z, rgb]; or a vtkImageData with cell arrays
                 of these names, as pyvista.ImageData is one
    spacing      edge of a voxel, a number or three, default 1; not with a vtkImageData, which has its own
    origin       corner of the first voxel, default 0, 0, 0; not with a vtkImageData
    extinction   1 / length of density 1: sigma_t = extinction * density, default 1; with density alone, as are
    albedo       part of it that is scattered, a number or red, green and blue, default 0.9
    g            mean cosine of Henyey and Greenstein's phase function, default 0: isotropic; a number, or red, green and
                 blue, or one for each voxel, [x, y, z] or [x, y, z, rgb]
    emission     radiance per unit length, W / (length^3 sr), [x, y, z] or [x, y, z, rgb]
    lights       a vtkLightRig, vtkSun, vtkPointLight, ..., or polydata as they make it
    sky          radiance from everywhere, a number or red, green and blue, W / (length^2 sr)
    environment  radiance in latitude-longitude layout, [row from the top, column, rgb], or a vtkImageData
    method       "maps", "ordinates" or "lattice"
    properties   of that solver, by their names: Tolerance=1e-3, MaximumOrders=3, FaceRadiance=(1, 0, 0, 0, 0, 0)

    Where nothing shines the solver's default sky does, a sun and a grey sky; `left_out` of the light says so, and
    DefaultSky=False leaves it dark.

    Arrays with masked values are refused: nothing says what is there.

    Raises SolvingError with the filter's own words, TypeError for an argument that this medium would not use, and
    ValueError for arrays of a wrong shape; the filter's warnings become Python's.
    """
    if method not in METHODS:
        raise ValueError(f"method {method!r}: there is {', '.join(METHODS)}")
    solver = METHODS[method]()
    filters = [solver]
    place = _given(spacing=spacing, origin=origin)
    making = _given(extinction=extinction, albedo=albedo, g=g)
    if isinstance(medium, vtkImageData):
        _refuse({**place, **making}, "a vtkImageData has its own; leave them out, or give arrays")
        image = medium
    elif hasattr(medium, "GetClassName"):
        raise TypeError(f"medium is a {medium.GetClassName()}; it must be an image, vtkImageData: vtkResampleToImage "
                        "(of PyVista: ImageData.sample) makes one of cells that have a volume")
    elif isinstance(medium, dict):
        _refuse(making, "sigma_a and sigma_s say it already; leave them out, or give density alone")
        image = image_of(**place, **medium)
    else:
        maker = classes.vtkParticipatingMedium()
        filters.append(maker)
        g = making.get("g", 0.0)
        by_voxel = numpy.ndim(g) > 1
        maker.SetInputData(image_of(**place, density=medium, **(dict(g=g) if by_voxel else {})))
        maker.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "density")
        maker.SetMillimetresPerUnit(1.0)
        maker.SetExtinctionScale(making.get("extinction", 1.0))
        maker.SetAlbedo(_triple("albedo", making.get("albedo", 0.9)))
        maker.SetPhaseFunction(maker.HENYEY_GREENSTEIN if numpy.any(g) else maker.ISOTROPIC)
        if not by_voxel and numpy.size(g) == 1:
            maker.SetMeanCosine(float(numpy.reshape(g, ())))
        elif not by_voxel:
            maker.SetChannelMeanCosines(*_triple("g", g))
        image = _result(maker, filters)
    if emission is not None:
        shining = vtkImageData()
        shining.ShallowCopy(image)
        _add(shining, "emission", emission)
        image = shining
    solver.SetInputData(image)
    for name, value in properties.items():
        _set(solver, name, value)
    _light_up(solver, lights, sky, environment)
    return Light(_result(solver, filters), solver.GetOutputDataObject(1), solver.GetSeconds())


def picture(light, size=(800, 600), **properties):
    """A picture of the medium in its light, [row from the top, column, red green blue alpha] as bytes.

    properties are vtkMediumRayCaster's, by their names: CameraPosition=(0, -3, 1), CameraFocalPoint=..., Exposure=1.
    Without a camera it stands before -y, far enough to see the whole box.
    """
    caster = classes.vtkMediumRayCaster()
    caster.SetInputData(light.image)
    caster.SetImageSize(*size)
    if "CameraPosition" not in properties:
        low, high = numpy.reshape(light.image.GetBounds(), (3, 2)).T
        middle, diagonal = (low + high) / 2, float(numpy.linalg.norm(high - low))
        caster.SetCameraFocalPoint(*middle)
        caster.SetCameraPosition(middle[0], middle[1] - 2.0 * diagonal, middle[2])
        caster.SetCameraViewUp(0.0, 0.0, 1.0)
    for name, value in properties.items():
        _set(caster, name, value)
    image = _result(caster, [caster])
    width, height, _ = image.GetDimensions()
    color = vtk_to_numpy(image.GetPointData().GetArray("color"))
    return numpy.ascontiguousarray(color.reshape(height, width, color.shape[1])[::-1])


def by_voxels(values, image):
    """Values of cells, seen as [x, y, z] or [x, y, z, component]."""
    return values.reshape(_voxels(image)[::-1] + values.shape[1:]).swapaxes(0, 2)


def image_of(spacing=1.0, origin=(0.0, 0.0, 0.0), **arrays):
    """A vtkImageData of voxels with these cell arrays, each [x, y, z] or [x, y, z, component]."""
    if not arrays:
        raise ValueError("an image of no array has no size")
    shape = numpy.shape(next(iter(arrays.values())))
    if len(shape) < 3:
        raise ValueError(f"voxels are [x, y, z], this array has {len(shape)} indices")
    image = vtkImageData()
    image.SetDimensions(*(count + 1 for count in shape[:3]))
    image.SetSpacing(*_triple("spacing", spacing))
    image.SetOrigin(*_triple("origin", origin))
    for name, values in arrays.items():
        _add(image, name, values)
    return image


def _voxels(image):
    return tuple(max(points - 1, 1) for points in image.GetDimensions())


def _numbers(name, values, kind=numpy.float32):
    masked = numpy.ma.count_masked(values)
    if masked:
        raise ValueError(f"{name} is masked in {masked} places; say what is there: {name}.filled(0), for one")
    try:
        return numpy.asarray(values, dtype=kind)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} is no array of numbers: {error}") from None


def _add(image, name, values):
    values = _numbers(name, values)
    voxels = _voxels(image)
    if values.shape[:3] != voxels or values.ndim not in (3, 4):
        raise ValueError(f"{name} has the shape {values.shape}, the voxels are {voxels}")
    flat = numpy.ascontiguousarray(values.swapaxes(0, 2)).reshape((-1,) + values.shape[3:])
    array = numpy_to_vtk(flat, deep=True)
    array.SetName(name)
    image.GetCellData().AddArray(array)


def _given(**arguments):
    return {name: value for name, value in arguments.items() if value is not None}


def _refuse(arguments, why):
    if arguments:
        raise TypeError(f"{', '.join(arguments)} would not be used: {why}")


def _light_up(solver, lights, sky, environment):
    if isinstance(lights, vtkAlgorithm):
        solver.SetLightsConnection(lights.GetOutputPort())
    elif isinstance(lights, vtkPolyData):
        solver.SetLightsData(lights)
    elif lights is not None:
        raise TypeError(f"lights is a {type(lights).__name__}; it must be a vtkLightRig, a vtkSun, ..., or their vtkPolyData")
    if sky is not None:
        solver.SetSkyColor(_triple("sky", sky))
    if isinstance(environment, vtkImageData):
        solver.SetEnvironmentData(environment)
    elif environment is not None:
        solver.SetEnvironmentData(_environment(environment))


def _environment(radiance):
    radiance = _numbers("environment", radiance)
    if radiance.ndim != 3 or radiance.shape[2] != 3:
        raise ValueError(f"an environment is [row, column, rgb], this one has the shape {radiance.shape}")
    image = vtkImageData()
    image.SetDimensions(radiance.shape[1], radiance.shape[0], 1)
    array = numpy_to_vtk(numpy.ascontiguousarray(radiance[::-1]).reshape(-1, 3), deep=True)
    array.SetName("radiance")
    image.GetPointData().SetScalars(array)
    return image


def _result(algorithm, filters):
    """Updates it. The first error of any of the filters is raised."""
    errors = []
    told = []
    for one in filters:
        told.append((one, one.AddObserver("ErrorEvent", _hears(errors.append))))
        told.append((one, one.AddObserver("WarningEvent", _hears(_warn))))
    algorithm.Update()
    for one, number in told:
        one.RemoveObserver(number)
    if errors:
        raise SolvingError(errors[0])
    return algorithm.GetOutputDataObject(0)


def _hears(takes):
    def hear(caller, event, text):
        takes(text.split("): ", 1)[-1].strip())

    hear.CallDataType = "string0"
    return hear


def _warn(text):
    warnings.warn(text, stacklevel=5)


def _set(algorithm, name, value):
    setter = getattr(algorithm, "Set" + name, None)
    if setter is None:
        raise TypeError(f"{algorithm.GetClassName()} has no property {name}")
    try:
        setter(*value) if isinstance(value, (tuple, list, numpy.ndarray)) else setter(value)
    except TypeError as error:
        raise TypeError(f"{algorithm.GetClassName()} does not take {name}={value!r}: {error}") from None


def _triple(name, value):
    if numpy.shape(value) not in ((), (1,), (3,)):
        raise ValueError(f"{name} has the shape {numpy.shape(value)}; it must be one number or three")
    return tuple(float(x) for x in numpy.broadcast_to(_numbers(name, value, float), 3))
