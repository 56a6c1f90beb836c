"""What PicturesOverRanks.py runs: pictures of media of which each rank has only a piece.

    pvbatch --symmetric pictures_of_pieces.py FOLDER CASE...

Of the cases that give a picture each rank writes its part of it to FOLDER, with the extent of what it was given; those
that must fail, and an abort, are checked here.
"""
import ctypes
import os
import sys

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkDoubleArray, vtkExtentTranslator, vtkImageData
from paraview.vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from pieces import dies_amid, errors_of, flag_duplicates, source_of
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

folder = sys.argv[1]
LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
module = servermanager.vtkProcessModule.GetProcessModule()
rank, ranks = module.GetPartitionId(), module.GetNumberOfLocalPartitions()
SIZE = [13, 9, 11]  # cells
WHOLE = [0, SIZE[0], 0, SIZE[1], 0, SIZE[2]]


def cells_of(extent):
    """@return z, y, x of the centres of cells, x fastest"""
    x, y, z = (numpy.arange(extent[2 * a], extent[2 * a + 1]) + 0.5 for a in range(3))
    return [axis.ravel() for axis in numpy.meshgrid(z, y, x, indexing="ij")]


def add(image, name, *components, to=None):
    array = numpy_to_vtk(numpy.stack(components, axis=-1).astype(numpy.float32), deep=True)
    array.SetName(name)
    (to or image.GetCellData()).AddArray(array)


def add_fact(image, name, values, components=1):
    fact = vtkDoubleArray()
    fact.SetName(name)
    fact.SetNumberOfComponents(components)
    for value in values:
        fact.InsertNextTuple([value] * components)
    image.GetFieldData().AddArray(fact)


def medium_of(extent, own=None, coloured=False):
    """A cloud whose cells are told by where they are, thick enough that half of the light is lost in it.
    @param own  cells outside of this extent are duplicates of another rank's"""
    image = vtkImageData()
    image.SetExtent(extent)
    image.SetSpacing(0.5, 0.5, 0.4)
    z, y, x = cells_of(extent)
    wave = 1 + numpy.sin(0.7 * x) * numpy.cos(0.9 * y + 0.3 * z)
    shades = [1, 0.7, 0.4] if coloured else [1]
    add(image, "sigma_a", *(0.05 * wave * shade for shade in shades))
    add(image, "sigma_s", *(0.3 * wave * shade for shade in shades))
    light = 1 + 0.3 * numpy.cos(0.5 * x + 0.8 * z)
    add(image, "fluence", *(light * shade for shade in shades))
    add(image, "fluence_direct", 0.4 * light)
    if own:
        flag_duplicates(image, own)
    return image


def with_layers(own, layers=1):
    return [max(bound - layers, 0) if i % 2 == 0 else min(bound + layers, WHOLE[i]) for i, bound in enumerate(own)]


def boxes(whole=WHOLE):
    """@return the extent of each rank, as ParaView cuts"""
    extents = []
    for piece in range(ranks):
        translator = vtkExtentTranslator()
        translator.SetWholeExtent(whole)
        translator.SetNumberOfPieces(ranks)
        translator.SetPiece(piece)
        translator.PieceToExtent()
        extents.append(list(translator.GetExtent()))
    return extents


def piece(**more):
    """With an array that the first rank has alone: where pieces are put together that is an error."""
    own = boxes()[rank]
    image = medium_of(with_layers(own), own, **more)
    if rank == 0:
        add(image, "only_here", cells_of(image.GetExtent())[0])
    return image


def plain_piece():
    image = piece()
    image.GetCellData().RemoveArray("only_here")
    return image


def cast(source, **more):
    """@return a caster of what a rank has, updated"""
    if isinstance(source, vtkImageData):
        source = source_of(source)
    caster = MediumRayCaster(Input=source, **{**dict(ImageSize=[61, 47], BackgroundColor=[0.1, 0.1, 0.2]), **more})
    caster.UpdatePipeline()
    return caster


def keep(case, caster):
    """Writes the rank's part of the picture, and how much it was given."""
    algorithm = caster.GetClientSideObject()
    picture, given = algorithm.GetOutputDataObject(0), algorithm.GetInputDataObject(0, 0)
    kept = {"given": given.GetExtent(), "bytes": given.GetActualMemorySize() * 1024}
    if picture.GetNumberOfPoints() > 0:
        kept["extent"] = picture.GetExtent()
        for name in ("color", "radiance", "alpha", "depth", "picture_error"):
            if picture.GetPointData().HasArray(name):
                kept[name] = vtk_to_numpy(picture.GetPointData().GetArray(name))
        kept["exposure"] = vtk_to_numpy(picture.GetFieldData().GetArray("exposure"))
        left_out = picture.GetFieldData().GetAbstractArray("left_out")
        kept["left_out"] = [left_out.GetValue(i) for i in range(left_out.GetNumberOfValues())]
    numpy.savez(os.path.join(folder, "%s.%d.npz" % (case, rank)), **kept)


def even():
    keep("even", cast(piece()))


def coloured():
    """In parallel projection, over a background whose radiance follows from the exposure."""
    keep("coloured", cast(piece(coloured=True), CameraPosition=[-20, 30, 12], CameraFocalPoint=[3, 2, 2],
                          CameraParallelProjection=1, CameraParallelScale=3))


def inside():
    """From within, with nothing behind, two layers of neighbours."""
    own = boxes()[rank]
    keep("inside", cast(medium_of(with_layers(own, 2), own), CameraPosition=[3.1, 2.2, 2.3],
                        CameraFocalPoint=[0.5, 1, 0.2], CameraViewAngle=90, ShowBackground=0, Exposure=2))


def uneven():
    """Layers of a voxel each before the last rank, which has the rest; the second rank has no data."""
    cuts = [0] + [max(r - 1, 1) if ranks > 2 else r for r in range(1, ranks)] + [SIZE[0]]
    own = [cuts[rank], cuts[rank + 1]] + WHOLE[2:]
    empty = own[0] == own[1]
    keep("uneven", cast(vtkImageData() if empty else medium_of(with_layers(own), own)))


def alone():
    """The last rank has all."""
    keep("alone", cast(medium_of(WHOLE) if rank == ranks - 1 else vtkImageData()))


def phase():
    """Light that has a direction, and scatters forwards."""
    image = piece()
    z, y, x = cells_of(image.GetExtent())
    add(image, "mean_direction", 0.5 * numpy.cos(x), 0.5 * numpy.sin(x), 0.2 * numpy.cos(y))
    add_fact(image, "g", [0.6])
    keep("phase", cast(image))


def ground():
    """Faces that give back light are seen through the medium."""
    image = piece()
    cells = 2 * (SIZE[0] * SIZE[1] + SIZE[1] * SIZE[2] + SIZE[2] * SIZE[0])
    add_fact(image, "face_power", 1 + 0.5 * numpy.sin(0.1 * numpy.arange(cells)))
    add_fact(image, "face_albedo", [0, 0, 0, 0, 0.8, 0.5])
    keep("ground", cast(image))


def bare():
    """Pieces without their neighbours' cells."""
    keep("bare", cast(medium_of(boxes()[rank])))


def bare_uneven():
    """Such pieces of two voxels and one, a rank without."""
    cuts = {1: [0, 13], 2: [0, 1, 13], 3: [0, 0, 2, 13], 4: [0, 2, 3, 3, 13]}[ranks]
    own = [cuts[rank], cuts[rank + 1]] + WHOLE[2:]
    keep("bare_uneven", cast(vtkImageData() if own[0] == own[1] else medium_of(own)))


def bare_points():
    """Such pieces with data of points, as Resample To Image makes them: those outside of its input are hidden."""
    extent = boxes()[rank]
    image = medium_of(extent)
    for name in ("sigma_a", "sigma_s", "fluence", "fluence_direct"):
        image.GetCellData().RemoveArray(name)
    x, y, z = (numpy.arange(extent[2 * a], extent[2 * a + 1] + 1) for a in range(3))
    z, y, x = (axis.ravel() for axis in numpy.meshgrid(z, y, x, indexing="ij"))
    hidden = x + y < 9
    wave = numpy.where(hidden, 9, 1 + numpy.sin(0.7 * x) * numpy.cos(0.9 * y + 0.3 * z))
    for name, scale in (("sigma_a", 0.1), ("sigma_s", 0.3), ("fluence", 1)):
        add(image, name, scale * wave, to=image.GetPointData())
    flags = numpy_to_vtk((2 * hidden).astype(numpy.uint8), deep=True)
    flags.SetName("vtkGhostType")
    image.GetPointData().AddArray(flags)
    keep("bare_points", cast(image))


def bend(image):
    """A lens, away from the faces."""
    z, y, x = cells_of(image.GetExtent())
    inside = numpy.maximum(1 - ((x - 6.5) ** 2 + (y - 4.5) ** 2 + (z - 5.5) ** 2) / 3.9 ** 2, 0)
    add(image, "ior", 1 + 0.4 * inside ** 2)
    return image


def sky():
    """An environment that tells directions apart."""
    image = vtkImageData()
    image.SetDimensions(64, 32, 1)
    polar, turn = (axis.ravel() for axis in numpy.meshgrid(numpy.linspace(0, 3.1, 32), numpy.linspace(0, 6.2, 64), indexing="ij"))
    add(image, "radiance", 1 + 0.3 * numpy.cos(turn), 1 + 0.3 * numpy.sin(turn), 1 + 0.3 * numpy.cos(polar), to=image.GetPointData())
    return source_of(image)


def glass():
    """Rays that bend."""
    keep("glass", cast(bend(piece()), Environment=sky()))


def glass_coloured():
    """The same through coloured smoke, from within."""
    keep("glass_coloured", cast(bend(piece(coloured=True)), CameraPosition=[3.1, 2.2, 2.3], CameraFocalPoint=[0.5, 1, 0.2],
                                CameraViewAngle=90))


def glass_bare():
    """Pieces without their neighbours' cells, of two voxels and one, a rank without."""
    cuts = {1: [0, 13], 2: [0, 1, 13], 3: [0, 0, 2, 13], 4: [0, 2, 3, 3, 13]}[ranks]
    own = [cuts[rank], cuts[rank + 1]] + WHOLE[2:]
    keep("glass_bare", cast(vtkImageData() if own[0] == own[1] else bend(medium_of(own)), Environment=sky()))


def mirror():
    """A surface that reflects, and a table."""
    image = piece()
    z, y, x = cells_of(image.GetExtent())
    radius = numpy.sqrt((x - 7) ** 2 + (y - 4) ** 2 + (z - 5) ** 2)
    add(image, "ior", 1 + 0.25 * (1 - numpy.tanh(radius - 3)))
    keep("mirror", cast(image, SurfaceReflection="Fresnel", TableFace="-z", TableReflectance=0.3, Environment=sky()))


def shadows():
    """Lamps throw shadows across pieces."""
    keep("shadows", cast(piece(), Lights=LightRig(SunElevation=20), ShadowRays=1))


def estimate():
    """Of which the error is estimated, that of its light too."""
    image = piece()
    z, y, x = cells_of(image.GetExtent())
    add(image, "fluence_error", 0.05 + 0.03 * numpy.cos(x + z))
    add_fact(image, "error_length", numpy.array([3.0]), 1)
    keep("estimate", cast(image, EstimateError=1))


def table():
    keep("table", cast(piece(), TableFace="-z"))


def moments():
    """Light in angular moments, and lamps' light apart, with shadows; some voxels do not scatter."""
    image = piece(coloured=True)
    z, y, x = cells_of(image.GetExtent())
    add(image, "scattered_moments", 0.2 + 0.05 * numpy.cos(x), 0.05 * numpy.sin(y), 0.03 * numpy.cos(z), 0.04 * numpy.sin(x))
    add(image, "straight_on", 0 * x + 0.25)
    vtk_to_numpy(image.GetCellData().GetArray("sigma_s"))[x.astype(int) % 5 == 2] = 0
    add_fact(image, "g", [0.5])
    lamps = vtkDoubleArray()
    lamps.SetName("lamps_apart")
    lamps.SetNumberOfComponents(13)
    lamps.InsertNextTuple([0, 0, 0, 0, 0.5, 0.3, -1, 3, 2, 1, 0, 0, 0])
    lamps.InsertNextTuple([1, 1, -2, 3, 0, 0, -1, 60, 90, 120, 0, 0, 0])
    image.GetFieldData().AddArray(lamps)
    keep("moments", cast(image))


def surface():
    """Light at the surface of thick voxels takes several of them."""
    image = piece()
    for name in ("sigma_a", "sigma_s"):
        vtk_to_numpy(image.GetCellData().GetArray(name))[:] *= 20
    cells = 2 * (SIZE[0] * SIZE[1] + SIZE[1] * SIZE[2] + SIZE[2] * SIZE[0])
    add_fact(image, "surface_radiance", 0.2 + 0.1 * numpy.sin(0.1 * numpy.arange(cells)), 4)
    keep("surface", cast(image))


def turned():
    """A picture from another side, of what is kept on the ranks."""
    caster = cast(bend(piece()), Environment=sky())
    caster.CameraViewAngle = 31
    caster.UpdatePipeline()
    caster.UpdatePropertyInformation()
    assert caster.SceneKept
    keep("turned", caster)


def memory_of(field):
    """@return bytes of this process: VmRSS now, VmHWM at most"""
    with open("/proc/self/status") as status:
        return 1024 * int(next(line for line in status if line.startswith(field)).split()[1])


def keep_memory(case, source, small, **more):
    """What a rank takes for its picture at most, beside its piece.
    @param small  what has been seen before is what any picture takes"""
    cast(small, **more)
    ctypes.CDLL(None).malloc_trim(0)  # what numpy has given back
    with open("/proc/self/clear_refs", "w") as peak:
        peak.write("5")
    before = memory_of("VmRSS")
    caster = cast(source, **more)
    numpy.savez(os.path.join(folder, "%s.%d.npz" % (case, rank)), taken=memory_of("VmHWM") - before)


def memory():
    """A larger lens, without layers."""
    keep_memory("memory", source_of(bend(medium_of(boxes([0, 192, 0, 160, 0, 128])[rank]))), bend(plain_piece()), Environment=sky())


def memory_of_shadows():
    """Pieces of which the first ones are in the others' shadow."""
    keep_memory("memory_of_shadows", source_of(medium_of(boxes([0, 128, 0, 128, 0, 128])[rank])), plain_piece(),
                Lights=LightRig(SunElevation=20), ShadowRays=1)


def reader():
    """A file of 64^3 voxels, of which each rank reads its piece."""
    path = os.path.join(folder, "medium.vti")
    if rank == 0:
        writer = vtkXMLImageDataWriter()
        writer.SetFileName(path)
        writer.SetInputData(medium_of([0, 64, 0, 64, 0, 64]))
        writer.Write()
    module.GetGlobalController().Barrier()
    keep("reader", cast(XMLImageDataReader(FileName=[path])))


def solved():
    """Light of a solver, of which each rank is given its piece."""
    medium = ParticipatingMedium(Input=Wavelet(WholeExtent=[-10, 10, -9, 9, -8, 8]), ExtinctionScale=0.001)
    keep("solved", cast(LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=4)))


def properties():
    """Each rank has the picture that it asks for, though not all ask for the same."""
    more = dict(CameraViewAngle=35, Exposure=2, BackgroundColor=[0, 0, 0]) if rank == ranks - 1 else {}
    caster = cast(plain_piece(), **more)
    found = caster.GetClientSideObject().GetOutputDataObject(0)
    assert found.GetNumberOfPoints() > 0
    if rank == ranks - 1:
        assert vtk_to_numpy(found.GetFieldData().GetArray("exposure"))[0] == 2


def fails(case, image, said, **more):
    """One error, with the same words on every rank, and an empty output."""
    caster = MediumRayCaster(Input=source_of(image), ImageSize=[61, 47], **more)
    errors = errors_of(caster)
    caster.UpdatePipeline()
    assert len(errors) == 1 and said in errors[0], (case, rank, errors)
    assert caster.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints() == 0, case
    caster.UpdatePipeline()
    assert len(errors) == 1, (case, "again", errors)
    print("%s: %s" % (case, errors[0].split("): ")[-1].strip()), flush=True)


def errors():
    odd = rank == ranks - 1
    image = plain_piece()
    if odd:
        image.GetCellData().RemoveArray("fluence")
    fails("arrays", image, '"fluence" is on rank 0 and not on rank')
    image = plain_piece()
    add_fact(image, "g", [0.5 if odd else 0.2])
    fails("g", image, "say different things of the phase function (g 0.2; g 0.5)")
    image = plain_piece()
    vtk_to_numpy(image.GetCellData().GetArray("sigma_s"))[:] *= -1 if odd else 1
    fails("values", image, "sigma_s")
    fails("gap", medium_of([0, 3] + WHOLE[2:] if odd else [4, 13] + WHOLE[2:]), "which make no whole")
    fails("device", plain_piece(), "On rank %d: " % (ranks - 1), Device="none of these" if odd else "")


def abort():
    """What one rank aborts ends on all."""
    caster = MediumRayCaster(Input=source_of(plain_piece()), ImageSize=[800, 600])
    algorithm = caster.GetClientSideObject()
    if rank == ranks - 1:
        algorithm.AddObserver("ProgressEvent", lambda caller, event: caller.SetAbortExecute(1))
    errors = errors_of(caster)
    caster.UpdatePipeline()
    output = algorithm.GetOutputDataObject(0)
    assert not errors and output.GetNumberOfPoints() == 0 and output.GetFieldData().HasArray("aborted"), errors


def killed():
    """The last rank, while rays that bend go from rank to rank."""
    caster = MediumRayCaster(Input=source_of(bend(piece())), Environment=sky(), ImageSize=[800, 600])
    if rank == ranks - 1:
        dies_amid(caster, 0.1)
    caster.UpdatePipeline()


for case in sys.argv[2:]:
    globals()[case]()
print("rank %d is done" % rank, flush=True)
