"""What PiecesOverRanks.py runs: light in media of which each rank has only a piece.

    pvbatch --symmetric light_of_pieces.py FOLDER CASE...

Of the cases that give light each rank writes its pieces to FOLDER; those that must fail, and an abort, are checked here.
"""
import os
import sys

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkDoubleArray, vtkImageData
from paraview.vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from pieces import dies_amid, errors_of, flag_duplicates, source_of
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

folder = sys.argv[1]
LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
module = servermanager.vtkProcessModule.GetProcessModule()
rank, ranks = module.GetPartitionId(), module.GetNumberOfLocalPartitions()
SIZE = [-8, 8, -7, 7, -6, 6]
same = {"UseInputBounds": 0, "SamplingBounds": SIZE, "SamplingDimensions": [17, 15, 13]}


def density_of(extent):
    """Cells of a cloud that is told by where they are, x fastest."""
    x, y, z = (numpy.arange(extent[2 * a], extent[2 * a + 1]) + 0.5 for a in range(3))
    z, y, x = numpy.meshgrid(z, y, x, indexing="ij")
    return (0.3 + 0.2 * numpy.sin(0.7 * x) * numpy.cos(0.5 * y + 0.3 * z)).astype(numpy.float32).ravel()


def add_density(image, values, name="density"):
    array = numpy_to_vtk(values, deep=True)
    array.SetName(name)
    image.GetCellData().AddArray(array)


def piece_of(extent, own=None, name="density", components=1, spacing=1.0, g=None):
    """@param own  cells outside of this extent are duplicates of another rank's, with a wrong value"""
    image = vtkImageData()
    image.SetExtent(extent)
    image.SetSpacing(spacing, spacing, spacing)
    values = density_of(extent)
    if own:
        values[flag_duplicates(image, own)] = 99
    add_density(image, numpy.repeat(values, components).reshape(-1, components), name)
    if g is not None:
        fact = vtkDoubleArray()
        fact.SetName("g")
        fact.InsertNextValue(g)
        image.GetFieldData().AddArray(fact)
    return image


def solved(density, array, full=1, **settings):
    """@param full  density of extinction 0.2"""
    medium = ParticipatingMedium(Input=density, DensityArray=array, ExtinctionScale=0.2, MinimumDensity=0,
                                 MaximumDensity=full, Albedo=[0.9, 0.9, 0.9])
    light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=4, **settings)
    light.UpdatePipeline()
    return light


def by_blocks(density, array, solve=solved, **settings):
    """The same where each rank solves its piece, of which alone it has the medium."""
    light = solve(density, array, Decomposition="Blocks", **settings)
    medium = light.Input.GetClientSideObject().GetOutputDataObject(0)
    output = light.GetClientSideObject().GetOutputDataObject(0)
    assert medium.GetExtent() == output.GetExtent(), (medium.GetExtent(), output.GetExtent())
    print("rank %d of %d has %d cells" % (rank, ranks, medium.GetNumberOfCells()), flush=True)
    return light


def keep(case, light, picture=None, array="fluence"):
    """Writes the rank's piece of the light, and of a picture, with where it lies."""
    kept = {}
    for name, proxy, arrays in (("light", light, "CellData"), ("picture", picture, "PointData")):
        output = proxy.GetClientSideObject().GetOutputDataObject(0) if proxy else None
        if output and output.GetNumberOfCells() > 0:
            attributes = getattr(output, "Get" + arrays)()
            values = vtk_to_numpy(attributes.GetArray(array if name == "light" else "radiance"))
            ghosts = attributes.GetArray("vtkGhostType")
            kept[name] = values
            kept[name + "_extent"] = output.GetExtent()
            kept[name + "_ghosts"] = vtk_to_numpy(ghosts) if ghosts else numpy.zeros(len(values))
            if name == "light":
                kept["balance"] = vtk_to_numpy(output.GetFieldData().GetArray("energy_balance"))
    numpy.savez(os.path.join(folder, "%s.%d.npz" % (case, rank)), **kept)


def resampled(data, **settings):
    return solved(ResampleToImage(Input=data, **same), ["POINTS", "RTData"], **settings)


def parts(cuts):
    """Extents, a rank each, of an image of 12 x 5 x 4 cells that is cut along x."""
    return [[cuts[r], cuts[r + 1], 0, 5, 0, 4] for r in range(ranks)]


def even_cuts():
    return [round(12 * r / ranks) for r in range(ranks + 1)]


def tetrahedra():
    light = resampled(Tetrahedralize(Input=Wavelet(WholeExtent=SIZE)))
    keep("tetrahedra", light)  # before the ray caster asks each rank for all of it
    camera = dict(CameraPosition=[30, 20, 10], CameraFocalPoint=[0, 0, 0], ImageSize=[24, 18])
    picture = MediumRayCaster(Input=light, **camera)
    picture.UpdatePipeline()
    keep("picture", None, picture)


def adaptive():
    """Asked for by pieces, ParaView's AMR has other values on other numbers of ranks; each rank gets all of what it is."""
    keep("adaptive", resampled(ImageDataToAMR(Input=Wavelet(WholeExtent=SIZE)), Decomposition="Whole on the first rank"))


def pvti():
    path = os.path.join(folder, "wavelet%d.pvti" % ranks)
    SaveData(path, proxy=Wavelet(WholeExtent=SIZE))
    module.GetGlobalController().Barrier()  # the first rank writes what all read
    keep("pvti", solved(XMLPartitionedImageDataReader(FileName=[path]), ["POINTS", "RTData"]))


def turned():
    """Right angles turn an image, of which its reader tells no directions before it has read it."""
    for case, matrix in (("turned", [0, 0, 1, 1, 0, 0, 0, 1, 0]), ("turned_down", [-1, 0, 0, 0, 1, 0, 0, 0, -1])):
        path = os.path.join(folder, "%s%d.vti" % (case, rank))
        image = piece_of([0, 12, 0, 5, 0, 8])
        image.SetDirectionMatrix(matrix)
        writer = vtkXMLImageDataWriter()
        writer.SetFileName(path)
        writer.SetInputData(image)
        writer.Write()
        light = solved(XMLImageDataReader(FileName=[path]), ["CELLS", "density"], Decomposition="Whole on the first rank")
        keep(case, light)
        if ranks == 1:  # a writer asks for what was told before
            SaveData(path, proxy=light)
            found = XMLImageDataReader(FileName=[path])
            found.UpdatePipeline()
            bounds = [proxy.GetClientSideObject().GetOutputDataObject(0).GetBounds() for proxy in (light, found)]
            assert bounds[0] == bounds[1], bounds


BOXES = [[2, 8, 1, 5, 5, 10], [-5, 6, -6, -3, -2, 5], [1, 5, 0, 9, 4, 8]]


def series():
    """Files of which each has another box, through several filters; time and again, and where the reader is asked, too."""
    files = []
    for box in BOXES:
        files.append(os.path.join(folder, "box%d_%d.vdb" % (ranks, len(files))))
        SaveData(files[-1], proxy=Wavelet(WholeExtent=box))
    module.GetGlobalController().Barrier()
    reader = VDBReader(FileName=files)
    medium = ParticipatingMedium(Input=reader, DensityArray=["CELLS", "RTData"], ExtinctionScale=0.2, MinimumDensity=0, MaximumDensity=277)
    whole, blocks = ({"Decomposition": how} for how in ("Whole on the first rank", "Blocks"))
    lights = {"whole": LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=4, **whole),
              "blocks": LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=4, **(blocks if ranks > 1 else whole)),
              "lattice": LatticeBoltzmannLighting(Input=medium, SkyColor=[1, 1, 1], Tolerance=1e-8)}
    for time, first in ((1, False), (0, False), (2, True), (1, False)):
        if first:
            reader.UpdatePipeline(time)
            medium.UpdatePipeline(time)
        for name, light in lights.items():
            light.UpdatePipeline(time)
            keep("series_%s_%d" % (name, time), light)
        read = reader.GetClientSideObject().GetOutputDataObject(0).GetExtent()
        last = [bound + 1 for bound in BOXES[time]]  # of cells around the points
        assert all(BOXES[time][a] <= read[a] and read[a + 1] <= last[a + 1] for a in (0, 2, 4)), (rank, time, read)
    for shown in (medium, lights["whole"]):
        faces_follow(shown)


def faces_follow(series):
    """Surface of each time, in any order, has the faces of that time's box and no other, on all ranks together."""
    view = CreateRenderView(ViewSize=[40, 40])
    shown = Show(series, view, "UniformGridRepresentation")
    shown.Representation = "Surface"
    Render(view)
    for time in (0, 1, 2, 0, 2, 1):
        view.ViewTime = time
        Render(view)
        drawn = shown.GetClientSideObject().GetActiveRepresentation().GetRenderedDataObject(0)
        own, faces = vtkDoubleArray(), vtkDoubleArray()
        own.InsertNextValue(drawn.GetNumberOfCells())
        faces.SetNumberOfValues(1)
        module.GetGlobalController().AllReduce(own, faces, 2)  # 2: their sum
        nx, ny, nz = (BOXES[time][a + 1] - BOXES[time][a] + 1 for a in (0, 2, 4))  # voxels around the points
        expected = 2 * (nx * ny + ny * nz + nz * nx)
        assert faces.GetValue(0) == expected, (rank, series.SMProxy.GetXMLName(), time, faces.GetValue(0), expected)
    Delete(view)


def own_pieces(case, pieces, solve=solved):
    keep(case, solve(source_of(pieces[rank]), ["CELLS", "density"]))


def even():
    own_pieces("even", [piece_of(extent) for extent in parts(even_cuts())])


def ghosts():
    """Pieces with two layers of neighbours, of which they have wrong values."""
    own = parts(even_cuts())
    own_pieces("ghosts", [piece_of([max(e[0] - 2, 0), min(e[1] + 2, 12)] + e[2:], own=e) for e in own])


def uneven_pieces():
    """Blocks of a voxel each before the last rank, which has the rest; the second rank has no data."""
    cuts = [0] + [max(r - 1, 1) if ranks > 2 else r for r in range(1, ranks)] + [12]
    return [piece_of(extent) if extent[1] > extent[0] else vtkImageData() for extent in parts(cuts)]


def uneven():
    own_pieces("uneven", uneven_pieces())


def alone():
    """The last rank has all."""
    own_pieces("alone", [vtkImageData() for _ in range(ranks - 1)] + [piece_of([0, 12, 0, 5, 0, 4])])


def wavelet(decomposition, **settings):
    density = Wavelet(WholeExtent=SIZE)
    solve = by_blocks if decomposition == "Blocks" else solved
    return solve(density, ["POINTS", "RTData"], full=277, NetFlux=1, **settings)


def blocks_wavelet():
    """A source that gives each rank its piece; asked again it is not solved again, but where a property changed."""
    light = wavelet("Blocks")
    keep("blocks_wavelet", light)
    lines = light.GetClientSideObject().GetOutputDataObject(1)
    before = lines.GetMTime()
    light.Input.Input.Modified()
    light.UpdatePipeline()
    light.Tolerance = 1e-2
    light.UpdatePipeline()
    assert lines.GetNumberOfRows() > 0 and before, "no rows"


PLAIN = dict(Acceleration="None (as published)", Source="Constant (as published)", EmissionError=0)


def blocks_estimated():
    """Errors as the whole has them; and light to a target."""
    keep("blocks_estimated", wavelet("Blocks", EstimateError=1, **PLAIN), array="fluence_error")
    light = wavelet("Blocks", TargetError=0.2, **PLAIN)
    keep("blocks_target", light, array="fluence_error")
    used = facts_of(light, "settings_used")
    assert "VoxelsDividedBy" in used and "Decomposition = 2" in used, used


def whole_estimated():
    keep("whole_estimated", wavelet("Whole on the first rank", EstimateError=1, **PLAIN), array="fluence_error")
    keep("whole_target", wavelet("Whole on the first rank", TargetError=0.2, **PLAIN), array="fluence_error")


def blocks_budget():
    """What does not fit the device lies in host memory: the same light; of ordinates it is one error, that says how much."""
    medium = ParticipatingMedium(Input=Wavelet(WholeExtent=[-24, 24, -23, 23, -22, 22]), DensityArray=["POINTS", "RTData"])
    settings = dict(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=4, MaximumOrders=2, Decomposition="Blocks")
    found = []
    for budget in (0, 1):
        light = LightPropagationMaps(MemoryBudget=budget, **settings)
        light.UpdatePipeline()
        assert ("in host memory" in facts_of(light, "device")) == (budget > 0), facts_of(light, "device")
        found.append(vtk_to_numpy(light.GetClientSideObject().GetOutputDataObject(0).GetCellData().GetArray("fluence")))
    assert (found[0] == found[1]).all()
    light = DiscreteOrdinates(MemoryBudget=1, **{**settings, "DirectionsPerFace": 9})
    errors = errors_of(light)
    light.UpdatePipeline()
    assert len(errors) == 1 and "has 1 MiB left" in errors[0], (rank, errors)
    assert light.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells() == 0


def photons(decomposition, **settings):
    """Photons that bend."""
    density = Calculator(Input=Wavelet(WholeExtent=SIZE), ResultArrayName="ior",
                         Function="1.2 + 0.1*sin(0.4*coordsX) + 0.1*cos(0.5*coordsY + 0.3*coordsZ)")
    medium = ParticipatingMedium(Input=density, DensityArray=["POINTS", "RTData"], ExtinctionScale=0.05, MinimumDensity=0,
                                 MaximumDensity=277)
    emitter = PhotonEmitter(Input=medium, Lights=LightRig(SunElevation=50), PhotonCount=20000)
    light = PhotonMarcher(Input=medium, Photons=emitter, PhotonCounts=1, Decomposition=decomposition,
                          **settings)
    light.UpdatePipeline()
    return light


def blocks_photons():
    light = photons("Blocks")
    keep("blocks_photons", light)
    made = light.Photons.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints()
    assert made <= 20000 / ranks + 2, (rank, made, "photons")


def whole_photons():
    keep("whole_photons", photons("Whole on the first rank"))


def blocks_scattered():
    keep("blocks_scattered", photons("Blocks", MaximumOrders=0))


def whole_scattered():
    keep("whole_scattered", photons("Whole on the first rank", MaximumOrders=0))


def photons_differ():
    """Ranks that ask for other paths, or by another scheme, do not march: one error."""
    for setting in ({"PathCount": 5}, {"Scheme": 0}):
        light = PhotonMarcher(Input=fog(), Photons=PhotonEmitter(Input=fog(), SkyColor=[1, 1, 1], PhotonCount=2000),
                              Decomposition="Blocks", **(setting if odd_rank() else {}))
        errors = errors_of(light)
        light.UpdatePipeline()
        assert len(errors) == 1 and "disagree about Scheme or PathCount" in errors[0], (rank, errors)
        assert light.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells() == 0


def photons_abort():
    """What one rank aborts while photons are scattered ends on all, and can be marched after that."""
    light = PhotonMarcher(Input=fog(), Photons=PhotonEmitter(Input=fog(), SkyColor=[1, 1, 1], PhotonCount=20000),
                          MaximumOrders=0, Decomposition="Blocks")
    filter = light.GetClientSideObject()
    if odd_rank():
        filter.AddObserver("ProgressEvent", lambda caller, event: caller.GetProgress() > 0.1 and caller.SetAbortExecute(1))
    errors = errors_of(light)
    light.UpdatePipeline()
    output = filter.GetOutputDataObject(0)
    assert not errors and output.GetNumberOfCells() == 0 and output.GetFieldData().HasArray("aborted"), errors
    filter.RemoveObservers("ProgressEvent")
    filter.SetAbortExecute(0)
    light.Seed = 2
    light.UpdatePipeline()
    assert filter.GetOutputDataObject(0).GetNumberOfCells() > 0 and not errors, errors


def photons_killed():
    light = PhotonMarcher(Input=fog(), Photons=PhotonEmitter(Input=fog(), SkyColor=[1, 1, 1], PhotonCount=200000),
                          MaximumOrders=0, Decomposition="Blocks")
    killed_amid(light, 0.1)  # scattered photons are on their way


def fog():
    return ParticipatingMedium(Input=Wavelet(WholeExtent=SIZE), DensityArray=["POINTS", "RTData"], ExtinctionScale=1,
                               MinimumDensity=0, MaximumDensity=300, Albedo=[0.99, 0.99, 0.99])


def blocks_plain():
    """Orders one by one, to compare with one rank's solve of the whole."""
    keep("blocks_plain", wavelet("Blocks", Acceleration="None (as published)"))


def whole_plain():
    light = wavelet("Whole on the first rank", Acceleration="None (as published)", Source="Constant (as published)", EmissionError=0)
    keep("whole_plain", light)


ONE_BY_ONE = dict(Acceleration="None (as published)", Source="Constant (as published)", EmissionError=0, UncollidedDirections=0)


def turbid(decomposition, **settings):
    """Scattering forwards, in colour, round a periodic axis and before a bright face."""
    medium = ParticipatingMedium(Input=Wavelet(WholeExtent=SIZE), DensityArray=["POINTS", "RTData"], ExtinctionScale=0.2, MinimumDensity=0,
                                 MaximumDensity=277, Albedo=[0.9, 0.8, 0.7], PhaseFunction="Henyey-Greenstein", MeanCosine=0.85)
    light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=9, PeriodicY=1, FaceAlbedo=[0, 0.6, 0, 0, 0, 0.3],
                                 Decomposition=decomposition, NetFlux=1, **settings)
    light.UpdatePipeline()
    return light


def blocks_turbid():
    light = turbid("Blocks", **ONE_BY_ONE)
    cells = light.GetClientSideObject().GetOutputDataObject(0).GetCellData()
    assert cells.GetNumberOfTuples() == 0 or cells.GetArray("scattered_moments"), "no moments"
    keep("blocks_turbid", light)


def whole_turbid():
    keep("whole_turbid", turbid("Whole on the first rank", **ONE_BY_ONE))


def facts_of(light, name):
    """@return the strings of field data, joined; none on a rank without voxels"""
    array = light.GetClientSideObject().GetOutputDataObject(0).GetFieldData().GetAbstractArray(name)
    return "\n".join(array.GetValue(i) for i in range(array.GetNumberOfValues())) if array else ""


def seconds_of(light):
    """That the solve took: it was not solved again where they are the same."""
    table = light.GetClientSideObject().GetOutputDataObject(1)
    return table.GetColumnByName("seconds").GetValue(table.GetNumberOfRows() - 1)


def untouched(density, array, solve=solved, **settings):
    """With Decomposition as it stands ranks solve their pieces, of which alone each has the medium; one rank is told to."""
    light = solve(density, array, **({"Decomposition": "Blocks"} if ranks == 1 else {}), **settings)
    medium = light.Input.GetClientSideObject().GetOutputDataObject(0)
    output = light.GetClientSideObject().GetOutputDataObject(0)
    assert medium.GetExtent() == output.GetExtent(), (medium.GetExtent(), output.GetExtent())
    used = facts_of(light, "settings_used")
    assert output.GetNumberOfCells() == 0 or "Decomposition = 2" in used, (rank, used)
    return light


def untouched_even():
    own_pieces("untouched_even", [piece_of(extent) for extent in parts(even_cuts())], solve=untouched)


def untouched_uneven():
    own_pieces("untouched_uneven", uneven_pieces(), solve=untouched)


def untouched_lit():
    """Colours of the screen, of which the exposure is that of all; another one, and another quality, are made anew."""
    light = untouched(Wavelet(WholeExtent=SIZE), ["POINTS", "RTData"], full=277, Quality="Fine", LitColor=1)
    seconds = seconds_of(light)
    light.ToneCurve = "Linear"
    light.UpdatePipeline()
    assert seconds_of(light) == seconds, "solved again for a colour"
    keep("untouched_lit", light, array="lit_color")
    facts = light.GetClientSideObject().GetOutputDataObject(0).GetFieldData()
    told = [facts.GetArray(name).GetValue(0) for name in ("lit_color_exposure", "lit_color_distance")]
    numpy.savez(os.path.join(folder, "lit_facts.%d.npz" % rank), facts=told)
    assert "EmissionError = 0.01" in facts_of(light, "settings_used"), facts_of(light, "settings_used")


def thick(density, array, full=1, **settings):
    """White voxels of several mean free paths."""
    medium = ParticipatingMedium(Input=density, DensityArray=array, ExtinctionScale=4, MinimumDensity=0,
                                 MaximumDensity=full, Albedo=[0.999, 0.999, 0.999])
    light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], Lights=LightRig(SunElevation=50), DirectionsPerFace=9,
                                 **settings)
    light.UpdatePipeline()
    return light


def untouched_thick():
    """What leaves thick voxels at the box's faces is told by each rank, of all faces."""
    light = untouched(Wavelet(WholeExtent=SIZE), ["POINTS", "RTData"], solve=thick, full=277)
    keep("untouched_thick", light)
    surface = light.GetClientSideObject().GetOutputDataObject(0).GetFieldData().GetArray("surface_radiance")
    numpy.savez(os.path.join(folder, "surface.%d.npz" % rank), facts=vtk_to_numpy(surface))


def whole_thick():
    keep("whole_thick", thick(Wavelet(WholeExtent=SIZE), ["POINTS", "RTData"], full=277))


def untouched_given():
    """Uncollided light of photons, of which each rank has that of its piece."""
    medium = ParticipatingMedium(Input=Wavelet(WholeExtent=SIZE), DensityArray=["POINTS", "RTData"], ExtinctionScale=0.3,
                                 MinimumDensity=0, MaximumDensity=277, MeanCosine=0.6)
    emitter = PhotonEmitter(Input=medium, Lights=LightRig(SunElevation=50), PhotonCount=20000)
    photons = PhotonMarcher(Input=medium, Photons=emitter, Decomposition="Blocks")
    light = LightPropagationMaps(Input=medium, UncollidedLight=photons, DirectionsPerFace=9, MaximumOrders=6,
                                 **({"Decomposition": "Blocks"} if ranks == 1 else {}))
    light.UpdatePipeline()
    given, output = (proxy.GetClientSideObject().GetOutputDataObject(0) for proxy in (photons, light))
    assert given.GetExtent() == output.GetExtent(), (rank, given.GetExtent(), output.GetExtent())
    assert "Decomposition = 2" in facts_of(light, "settings_used")
    keep("untouched_given", light)


def whole_where_few():
    """Ranks that choose solve a medium of few voxels as a whole."""
    few, os.environ["TYNDALL_PIECES_FROM"] = os.environ["TYNDALL_PIECES_FROM"], "264"
    for high, how in ((11, "Decomposition = 1"), (12, "Decomposition = 2")):  # 264 voxels, and 288
        medium = ParticipatingMedium(Input=Wavelet(WholeExtent=[1, high, 1, 6, 1, 4]), DensityArray=["POINTS", "RTData"])
        light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=4)
        light.UpdatePipeline()
        assert how in facts_of(light, "settings_used"), (high, facts_of(light, "settings_used"))
        assert high == 12 or "pieces: the first rank solved the whole, for a medium of few voxels" in facts_of(light, "left_out")
    os.environ["TYNDALL_PIECES_FROM"] = few


def whole_where_better():
    """What pieces cannot do, or not as well, each rank solves as a whole, says why, and does not solve again."""
    medium = ParticipatingMedium(Input=Wavelet(WholeExtent=SIZE), DensityArray=["POINTS", "RTData"], ExtinctionScale=0.4,
                                 MinimumDensity=0, MaximumDensity=277, Albedo=[0.999, 0.999, 0.999])
    for why, settings in (("Scheme as published", {"Scheme": 0}),):
        light = LightPropagationMaps(**{**dict(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=4), **settings})
        errors = errors_of(light)
        light.UpdatePipeline()
        used, left = facts_of(light, "settings_used"), facts_of(light, "left_out")
        assert "Decomposition = 1" in used and "pieces: the first rank solved the whole, for " + why in left, (why, used, left)
        seconds = seconds_of(light)
        light.LitColor = 1
        light.UpdatePipeline()
        output = light.GetClientSideObject().GetOutputDataObject(0)
        assert seconds_of(light) == seconds and output.GetCellData().HasArray("lit_color"), why
        assert not errors and output.GetNumberOfCells() < 16 * 14 * 12, (why, errors)


def first_published():
    """A scheme as published is solved by the first rank, which sends each rank its piece of the light."""
    light = wavelet("Automatic", Scheme=0)
    keep("first_published", light)
    assert light.GetClientSideObject().GetOutputDataObject(1).GetNumberOfRows() > 0, "no history on rank %d" % rank
    assert ranks == 1 or "pieces: the first rank solved the whole, for Scheme as published" in facts_of(light, "left_out")


def first_compares():
    """Solvers are compared on the first rank, which has the table, and sends each rank its piece of the reference."""
    medium = ParticipatingMedium(Input=Wavelet(WholeExtent=SIZE), DensityArray=["POINTS", "RTData"], MaximumDensity=277)
    compared = SolverComparison(Input=medium, SkyColor=[1, 1, 1], Directions=[4], Coarsenings=[1], Orders=[1], MapResolutions=[1],
                                PhotonCounts=[1000], Repeats=1, MonteCarloReference=0)
    errors = errors_of(compared)
    compared.UpdatePipeline()
    filter = compared.GetClientSideObject()
    table, reference = filter.GetOutputDataObject(0), filter.GetOutputDataObject(1)
    assert not errors and (table.GetNumberOfRows() > 0) == (rank == 0), (rank, errors)
    assert 0 < reference.GetNumberOfCells() and (ranks == 1 or reference.GetNumberOfCells() < 34 * 30 * 26 / 2), rank  # of half the spacing


def absorbing(case, decomposition):
    """Thick voxels that absorb much: they shine by octant."""
    medium = ParticipatingMedium(Input=Wavelet(WholeExtent=SIZE), DensityArray=["POINTS", "RTData"], ExtinctionScale=2,
                                 MinimumDensity=0, MaximumDensity=277, Albedo=[0.2, 0.2, 0.2])
    light = LightPropagationMaps(Input=medium, Lights=LightRig(SunElevation=50), DirectionsPerFace=4, Decomposition=decomposition)
    light.UpdatePipeline()
    keep(case, light)


def blocks_absorbing():
    absorbing("blocks_absorbing", "Automatic" if ranks > 1 else "Blocks")


def whole_absorbing():
    absorbing("whole_absorbing", "Whole on the first rank")


def blocks_ghosts():
    """The output is asked for with ghost cells: those of the neighbour's light, flagged."""
    light = wavelet("Blocks")
    filter = light.GetClientSideObject()
    filter.UpdatePiece(rank, ranks, 2)
    keep("blocks_ghosts", light)
    output = filter.GetOutputDataObject(0)
    flags = vtk_to_numpy(output.GetCellData().GetArray("vtkGhostType")) if ranks > 1 else numpy.zeros(1)
    fluence = vtk_to_numpy(output.GetCellData().GetArray("fluence"))
    assert ranks == 1 or flags.any()
    assert numpy.isfinite(fluence).all() and fluence.min() > 0
    numpy.savez(os.path.join(folder, "ghost_cells.%d.npz" % rank), extent=output.GetExtent(), fluence=fluence)


def blocks_given_all():
    """A source that gives every rank all of the image, whatever it is asked for."""
    own_pieces("blocks_given_all", [piece_of([0, 12, 0, 5, 0, 4])] * ranks, solve=given_all)


def given_all(density, array):
    return solved(density, array, Decomposition="Blocks")


def blocks_even():
    own_pieces("blocks_even", [piece_of(extent) for extent in parts(even_cuts())], solve=by_blocks)


def blocks_uneven():
    own_pieces("blocks_uneven", uneven_pieces(), solve=by_blocks)


def on_lattice(density, array, full=1, **settings):
    """Thick voxels in colour under a sun and a sky, by a lattice."""
    medium = ParticipatingMedium(Input=density, DensityArray=array, ExtinctionScale=2, MinimumDensity=0,
                                 MaximumDensity=full, Albedo=[0.99, 0.9, 0.7])
    lights = settings.pop("Lights", None) or LightRig(SunElevation=50)
    light = LatticeBoltzmannLighting(Input=medium, Lights=lights, SkyColor=[0.1, 0.1, 0.2], NetFlux=1,
                                     FaceAlbedo=[0, 0, 0, 0, 0.3, 0], **settings)
    light.UpdatePipeline()
    return light


def lattice_by_blocks(density, array, **settings):
    return by_blocks(density, array, solve=on_lattice, **{"Tolerance": 1e-8, **settings})


def lattice_wavelet():
    """Asked again it is not solved again, but where a property changed."""
    light = lattice_by_blocks(Wavelet(WholeExtent=SIZE), ["POINTS", "RTData"], full=277)
    keep("lattice_wavelet", light)
    steps = light.GetClientSideObject().GetOutputDataObject(1)
    before = steps.GetMTime()
    light.Input.Input.Modified()
    light.UpdatePipeline()
    assert steps.GetNumberOfRows() > 0 and steps.GetMTime() >= before


def lattice_exact():
    keep("lattice_exact", lattice_by_blocks(Wavelet(WholeExtent=SIZE), ["POINTS", "RTData"], full=277, Tolerance=1e-7))


def lattice_whole():
    settings = {"Decomposition": "Whole on the first rank", "Tolerance": 1e-7}
    keep("lattice_whole", on_lattice(Wavelet(WholeExtent=SIZE), ["POINTS", "RTData"], full=277, **settings))


def lattice_even():
    own_pieces("lattice_even", [piece_of(extent) for extent in parts(even_cuts())], solve=lattice_by_blocks)


def lattice_uneven():
    own_pieces("lattice_uneven", uneven_pieces(), solve=lattice_by_blocks)


def with_cosines():
    """Pieces with cells g that are the same in one half of the voxels that scatter, and vary in the other one. In the last layer
    nothing scatters, and g is 1."""
    pieces = [piece_of(extent) for extent in parts(even_cuts())]
    for piece, extent in zip(pieces, parts(even_cuts())):
        x = numpy.arange(piece.GetNumberOfCells()) % max(extent[1] - extent[0], 1) + extent[0]
        values = vtk_to_numpy(piece.GetCellData().GetArray("density"))
        values[x == 11] = 0
        add_density(piece, numpy.where(x == 11, 1, numpy.where(x < 6, 0.5, 0.05 * x)).astype(numpy.float32), "g")
    return pieces


def lattice_cosines():
    own_pieces("lattice_cosines", with_cosines(), solve=lattice_by_blocks)


def ordinates_cosines():
    own_pieces("ordinates_cosines", with_cosines(), solve=ordinates_by_blocks)


def blocks_cosines():
    own_pieces("blocks_cosines", with_cosines(), solve=by_blocks)


def near_lamp():
    return PointLight(Position=[7, 2, 6], Power=[9, 5, 9])


def lattice_lamps():
    own_pieces("lattice_lamps", uneven_pieces(),
               solve=lambda density, array: lattice_by_blocks(density, array, Lights=near_lamp()))


def lattice_around():
    own_pieces("lattice_around", uneven_pieces(),
               solve=lambda density, array: lattice_by_blocks(density, array, PeriodicX=1, PeriodicY=1))


def lattice_of_photons(**settings):
    """Of photons, which each rank makes and marches some of."""
    medium = ParticipatingMedium(Input=source_of(uneven_pieces()[rank]), DensityArray=["CELLS", "density"], ExtinctionScale=2,
                                 MinimumDensity=0, MaximumDensity=1, Albedo=[0.99, 0.9, 0.7])
    emitter = PhotonEmitter(Input=medium, Lights=LightRig(SunElevation=50), PhotonCount=20000)
    light = LatticeBoltzmannLighting(Input=medium, Photons=emitter, NetFlux=1, **{"Tolerance": 1e-8, **settings})
    light.UpdatePipeline()
    return light


def lattice_photons():
    light = lattice_of_photons()
    keep("lattice_photons", light)
    made = light.Photons.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints()
    assert made <= 20000 / ranks + 2, (rank, made, "photons")
    output = light.GetClientSideObject().GetOutputDataObject(0)
    if ranks > 1 and output.GetNumberOfCells() > 0:
        used = output.GetFieldData().GetAbstractArray("settings_used")
        said = [used.GetValue(i) for i in range(used.GetNumberOfValues())]
        assert "Decomposition = 2" in said, said


def lattice_photons_few():
    """A medium of few voxels, of which the rank without any cannot know that: none waits, and no photon counts twice."""
    few, os.environ["TYNDALL_PIECES_FROM"] = os.environ["TYNDALL_PIECES_FROM"], "1e9"
    keep("lattice_photons_few", lattice_of_photons())
    os.environ["TYNDALL_PIECES_FROM"] = few


def lattice_photons_whole():
    keep("lattice_photons_whole", lattice_of_photons(Decomposition="Whole on the first rank"))


def lattice_turns():
    """Photons that march beside the steps of blocks of voxels: not by blocks of ranks."""
    light = lattice_of_photons(Interleaved=1, VoxelsPerTurn=5, BlockSize=4, MaximumOrders=30)
    keep("lattice_turns", light)
    if ranks > 1 and light.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells() > 0:
        left = facts_of(light, "left_out")
        assert "pieces: the first rank solved the whole, for BlockSize" in left, left


def by_ordinates(density, array, full=1, **settings):
    medium = ParticipatingMedium(Input=density, DensityArray=array, ExtinctionScale=0.5, MinimumDensity=0, MaximumDensity=full,
                                 Albedo=[0.9, 0.8, 0.7], MeanCosine=0.5)
    lights = settings.pop("Lights", None) or LightRig(SunElevation=50)
    light = DiscreteOrdinates(Input=medium, Lights=lights, SkyColor=[0.1, 0.1, 0.2], NetFlux=1,
                              DirectionsPerFace=9, Terms=16, **settings)
    light.UpdatePipeline()
    return light


def ordinates_by_blocks(density, array, **settings):
    return by_blocks(density, array, solve=by_ordinates, **settings)


FACES = {"FaceAlbedo": [0, 0.4, 0, 0, 0.3, 0], "Quality": "Draft"}


def ordinates_faces():
    own_pieces("ordinates_faces", uneven_pieces(),
               solve=lambda density, array: drafted(density, array, Lights=near_lamp(), **FACES))


def drafted(density, array, **settings):
    light = ordinates_by_blocks(density, array, **settings)
    used = facts_of(light, "settings_used")
    assert light.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells() == 0 or "Tolerance = 0.01" in used, used
    return light


def ordinates_faces_whole():
    own_pieces("ordinates_faces_whole", [piece_of([0, 12, 0, 5, 0, 4])],
               solve=lambda density, array: by_ordinates(density, array, Lights=near_lamp(), **FACES))


def ordinates_around():
    own_pieces("ordinates_around", uneven_pieces(),
               solve=lambda density, array: ordinates_by_blocks(density, array, PeriodicX=1, FaceAlbedo=[0, 0, 0, 0, 0.3, 0]))


def ordinates_even():
    own_pieces("ordinates_even", [piece_of(extent) for extent in parts(even_cuts())], solve=ordinates_by_blocks)


def ordinates_uneven():
    own_pieces("ordinates_uneven", uneven_pieces(), solve=ordinates_by_blocks)


def ordinates_whole():
    own_pieces("ordinates_whole", [piece_of([0, 12, 0, 5, 0, 4])], solve=by_ordinates)


EVEN = [end + 1 - i % 2 for i, end in enumerate(SIZE)]  # of points, and so of voxels: the lattice halves no odd number
PREVIEWED = (("maps", solved, {"Source": 1, "UncollidedDirections": 36}), ("ordinates", by_ordinates, {"Quality": "Fine"}), ("lattice", on_lattice, {}))


def previews():
    """Of all solvers; what blocks cannot do (a linear source with finer directions) previews can."""
    for name, solve, settings in PREVIEWED:
        light = untouched(Wavelet(WholeExtent=EVEN), ["POINTS", "RTData"], solve=solve, full=277, Preview=1, **settings)
        keep("preview_" + name, light)
        left = facts_of(light, "left_out")
        assert "a preview, of 8 x 7 x 6 of 16 x 14 x 12 voxels" in left or not left, (name, left)


def previews_whole():
    for name, solve, settings in PREVIEWED:
        keep("preview_%s_whole" % name, solve(Wavelet(WholeExtent=EVEN), ["POINTS", "RTData"], full=277, Preview=1,
                                              Decomposition="Whole on the first rank", **settings))


def warm_by_blocks(case, solver, **settings):
    """Where an albedo was edited, light begins from the last one, of which each rank has kept its own part."""
    medium = ParticipatingMedium(Input=source_of(uneven_pieces()[rank]), DensityArray=["CELLS", "density"],
                                 ExtinctionScale=0.5, MinimumDensity=0, MaximumDensity=1, Albedo=[0.9, 0.9, 0.9])
    light = solver(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=4, Decomposition="Blocks", WarmStart=1,
                   **settings)
    light.UpdatePipeline()
    light.UpdatePropertyInformation()
    assert "WarmStart): there is none" in light.LeftOut, light.LeftOut
    medium.Albedo = [0.88, 0.88, 0.88]
    light.UpdatePipeline()
    light.UpdatePropertyInformation()
    assert light.SweepsSaved > 0 and "begun from the last light" in light.LeftOut, (light.SweepsSaved, light.LeftOut)
    keep(case, light)


def blocks_warm():
    warm_by_blocks("blocks_warm", LightPropagationMaps)


def ordinates_warm():
    warm_by_blocks("ordinates_warm", DiscreteOrdinates, Terms=16)


def blocks_errors():
    """What cannot be solved by pieces is one error that names it; what one rank lacks, on all of them."""
    medium = ParticipatingMedium(Input=Wavelet(WholeExtent=SIZE), DensityArray=["POINTS", "RTData"])
    for named, settings in (("blocks) with Scheme as published", {"Scheme": 0}),
                            ("blocks) with Scheme as published", {"Scheme": rank % 2})):
        light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], Decomposition="Blocks", **settings)
        errors = errors_of(light)
        light.UpdatePipeline()
        light.UpdatePipeline()
        assert len(errors) == 1 and named in errors[0], (rank, named, errors)
        assert light.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells() == 0
    odd = rank == ranks - 1
    piece = piece_of(parts(even_cuts())[rank], name="smoke" if odd else "density")
    light = LightPropagationMaps(Input=ParticipatingMedium(Input=source_of(piece), DensityArray=["CELLS", "density"]),
                                 Decomposition="Blocks", SkyColor=[1, 1, 1])
    errors = errors_of(light.Input)
    light.UpdatePipeline()
    assert len(errors) == 1 and "On rank %d: " % (ranks - 1) in errors[0], (rank, errors)


def blocks_abort():
    """What one rank aborts ends on all, and can be solved after that."""
    light = by_blocks_slow()
    solver = light.GetClientSideObject()
    if odd_rank():
        solver.AddObserver("ProgressEvent", lambda caller, event: caller.SetAbortExecute(1))
    errors = errors_of(light)
    light.UpdatePipeline()
    output = solver.GetOutputDataObject(0)
    assert not errors and output.GetNumberOfCells() == 0 and output.GetFieldData().HasArray("aborted"), errors
    solver.RemoveObservers("ProgressEvent")
    solver.SetAbortExecute(0)  # which the observer set once more when all was done
    light.Tolerance = 1e-3
    light.UpdatePipeline()
    output = solver.GetOutputDataObject(0)
    assert output.GetNumberOfCells() > 0 and not output.GetFieldData().HasArray("aborted") and not errors, errors
    before = vtk_to_numpy(output.GetCellData().GetArray("fluence")).copy()

    # Stopped once more: each rank keeps its piece of the light of before, which says so.
    if odd_rank():
        solver.AddObserver("ProgressEvent", lambda caller, event: caller.SetAbortExecute(1))
    light.Tolerance = 1e-7
    light.UpdatePipeline()
    output = solver.GetOutputDataObject(0)
    assert output.GetFieldData().HasArray("aborted") and not errors, errors
    assert (vtk_to_numpy(output.GetCellData().GetArray("fluence")) == before).all()
    solver.RemoveObservers("ProgressEvent")
    solver.SetAbortExecute(0)


def blocks_ignored():
    """An index that is not 1 on one rank alone is in the light of all, and the first rank warns of it."""
    piece = piece_of(parts(even_cuts())[rank])
    index = numpy.ones(piece.GetNumberOfCells(), dtype=numpy.float32)
    index[0] = 1.5 if odd_rank() else 1.0
    add_density(piece, index, "ior")
    medium = ParticipatingMedium(Input=source_of(piece), DensityArray=["CELLS", "density"])
    for solver in (LightPropagationMaps, DiscreteOrdinates):
        light = solver(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=9, Decomposition="Blocks")
        warnings = []
        light.GetClientSideObject().AddObserver("WarningEvent", lambda caller, event: warnings.append(event))
        light.UpdatePipeline()
        ignored = light.GetClientSideObject().GetOutputDataObject(0).GetFieldData().GetAbstractArray("ignored")
        assert ignored and ignored.GetValue(0).startswith("ior "), (rank, ignored)
        assert len(warnings) == (1 if rank == 0 else 0), (rank, warnings)


def blocks_killed():
    killed_amid(by_blocks_slow())


def killed_amid(light, after=0.0):
    """The last rank is killed when so much is done."""
    if odd_rank():
        dies_amid(light, after)
    light.UpdatePipeline()


def odd_rank():
    return rank == ranks - 1


def by_blocks_slow():
    medium = ParticipatingMedium(Input=Wavelet(WholeExtent=SIZE), DensityArray=["POINTS", "RTData"],
                                 ExtinctionScale=0.2, MinimumDensity=0, MaximumDensity=300)
    return LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=16, Tolerance=1e-7,
                                Decomposition="Blocks")


def fails(case, piece, said, filters=(lambda density: ParticipatingMedium(Input=density,
                                                                          DensityArray=["CELLS", "density"]),)):
    """One error, with the same words on every rank, and an empty output; that of the filter after it is empty, too."""
    medium = filters[0](source_of(piece))
    light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=4, Decomposition="Whole on the first rank")
    errors, later = errors_of(medium), errors_of(light)
    light.UpdatePipeline()
    assert len(errors) == 1 and said in errors[0] and not later, (case, rank, errors, later)
    assert light.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells() == 0, case
    light.UpdatePipeline()
    assert len(errors) == 1, (case, "again", errors)
    print("%s: %s" % (case, errors[0].split("): ")[-1].strip()), flush=True)


def wrong_pieces():
    """@return (name, this rank's piece, what the error says) of pieces that make no whole"""
    odd = rank == ranks - 1
    whole = parts(even_cuts())[rank]
    yield "arrays", piece_of(whole, name="smoke" if odd else "density"), '"density" is on rank 0 and not on rank'
    yield "components", piece_of(whole, components=3 if odd else 1), "other components or another type"
    yield "spacing", piece_of(whole, spacing=2.0 if odd else 1.0), "different origins, spacings or directions"
    yield "g", piece_of(whole, g=0.5 if odd else 0.2), "say different things of the phase function (g 0.2; g 0.5)"
    yield "gap", piece_of([whole[0] + odd, whole[1] + odd] + whole[2:]), "which make no whole"
    short = piece_of(whole)
    if odd:
        density = vtk_to_numpy(short.GetCellData().GetArray("density"))
        add_density(short, density[:5])
    yield "short", short, "On rank %d: Array 'density' has 5 values" % (ranks - 1)
    mine = piece_of([0, 12, 0, 5, 0, 4])
    vtk_to_numpy(mine.GetCellData().GetArray("density"))[7] += rank
    yield "overlap", mine, 'cell array "density" has different values'


def errors():
    for name, piece, said in wrong_pieces():
        fails(name, piece, said)
    odd = rank == ranks - 1
    fails("one rank", piece_of(parts(even_cuts())[rank]), "On rank %d: " % (ranks - 1),
          [lambda density: ParticipatingMedium(Input=density, DensityArray=["CELLS", "none" if odd else "density"])])


def blocks_of_wrong_pieces():
    """One error, by the first filter that sees what is wrong, and with the same words on all ranks."""
    for name, piece, said in wrong_pieces():
        if name == "overlap":
            continue  # where each rank has the whole it is its piece of that
        medium = ParticipatingMedium(Input=source_of(piece), DensityArray=["CELLS", "density"])
        if name == "g":  # which ParticipatingMedium would replace by its own
            array = piece.GetCellData().GetArray("density")
            array.SetName("sigma_s")
            absorption = numpy_to_vtk(vtk_to_numpy(array), deep=True)
            absorption.SetName("sigma_a")
            piece.GetCellData().AddArray(absorption)
            medium = source_of(piece)
        light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], AngularDegree=0)
        errors, later = errors_of(medium), errors_of(light)
        light.UpdatePipeline()
        light.UpdatePipeline()
        assert len(errors + later) == 1, (name, rank, errors, later)
        assert light.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells() == 0, name
        with open(os.path.join(folder, "error.%s.%d" % (name, rank)), "w") as file:
            file.write((errors + later)[0].split("): ")[-1].strip())


def abort():
    """What one rank aborts ends on all."""
    medium = ParticipatingMedium(Input=source_of(piece_of(parts(even_cuts())[rank])),
                                 DensityArray=["CELLS", "density"])
    light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=16, Acceleration=0,
                                 MaximumOrders=100000, Tolerance=1e-9)
    solver = light.GetClientSideObject()
    if rank == ranks - 1:
        solver.AddObserver("ProgressEvent", lambda caller, event: caller.SetAbortExecute(1))
    errors = errors_of(light)
    light.UpdatePipeline()
    output = solver.GetOutputDataObject(0)
    assert not errors and output.GetNumberOfCells() == 0 and output.GetFieldData().HasArray("aborted"), errors


def no_file():
    """A file that only the first rank has: all have the light of it, where it is asked for all of it; asked for pieces, one error."""
    path = os.path.join(folder, "own%d.vti" % rank)
    if rank == 0:
        writer = vtkXMLImageDataWriter()
        writer.SetFileName(path)
        writer.SetInputData(piece_of([0, 12, 0, 5, 0, 4]))
        writer.Write()
    keep("no_file", solved(XMLImageDataReader(FileName=[path]), ["CELLS", "density"], Decomposition="Whole on the first rank"))
    if ranks > 1:
        medium = ParticipatingMedium(Input=XMLImageDataReader(FileName=[path]), DensityArray=["CELLS", "density"])
        light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1])
        errors, before = errors_of(light), errors_of(medium)
        light.UpdatePipeline()
        errors += before
        assert len(errors) == 1 and "of 0 12 0 5 0 4" in errors[0] and "no piece came" in errors[0], errors
        assert light.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells() == 0


def missing():
    """The last rank asks for nothing: the others do not wait for it forever (TYNDALL_RANKS_WAIT), nor twice."""
    medium = ParticipatingMedium(Input=source_of(piece_of([0, 12, 0, 5, 0, 4])), DensityArray=["CELLS", "density"])
    light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1])
    errors, later = errors_of(medium), errors_of(light)
    for _ in range(2 if rank < ranks - 1 else 0):
        light.UpdatePipeline()
        assert len(errors) == 1 and "Rank %d did not come" % (ranks - 1) in errors[0] and not later, (errors, later)
        assert light.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells() == 0


def elsewhere():
    """The last rank has no lamps, so that ranks come to other filters: each has one error, and what is right then works."""
    medium = ParticipatingMedium(Input=source_of(piece_of(parts(even_cuts())[rank])), DensityArray=["CELLS", "density"])
    lights = [] if odd_rank() else [LightRig()]
    light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=4, **{"Lights": rig for rig in lights})
    errors = [errors_of(proxy) for proxy in [medium, light, *lights]]
    light.UpdatePipeline()
    light.UpdatePipeline()
    said = sum(errors, [])
    assert len(said) == 1 and "Rank %d came to another filter than rank 0" % (ranks - 1) in said[0], (rank, said)
    assert light.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells() == 0
    right = solved(source_of(piece_of(parts(even_cuts())[rank])), ["CELLS", "density"], Lights=LightRig())
    assert right.GetClientSideObject().GetOutputDataObject(0).GetNumberOfCells() > 0, rank


def killed():
    medium = ParticipatingMedium(Input=source_of(piece_of(parts(even_cuts())[rank])),
                                 DensityArray=["CELLS", "density"])
    killed_amid(LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=16))


for case in sys.argv[2:]:
    globals()[case]()
print("rank %d is done" % rank, flush=True)
