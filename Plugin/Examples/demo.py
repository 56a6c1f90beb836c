"""From a CT scan under a photographed sky to pictures and data, by Tyndall's proxies alone.

    pvbatch demo.py --data FOLDER --output FOLDER [--grid 104] [--size 800 600]

FOLDER holds skull_2.9.inr (CGAL's demo data, Debian package libcgal-demo) and sunset.exr (Blender's studio lights, Debian
package blender-data). `./run demo` fetches both and calls this.
"""
import argparse
import math
import os
import time

from paraview.simple import *
from paraview import servermanager

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())

arguments = argparse.ArgumentParser()
arguments.add_argument("--data", required=True)
arguments.add_argument("--output", required=True)
arguments.add_argument("--grid", type=int, default=104, help="voxels an axis that the scan is resampled to")
arguments.add_argument("--size", type=int, nargs=2, default=[800, 600], help="columns and rows of the pictures")
arguments = arguments.parse_args()
os.makedirs(arguments.output, exist_ok=True)

stages = []


def stage(name, work):
    """Do some work and note how long it took."""
    begin = time.perf_counter()
    result = work()
    stages.append((name, time.perf_counter() - begin))
    return result


def data(name):
    # Absolute path, so that a saved ParaView state finds the file from any folder.
    return os.path.abspath(os.path.join(arguments.data, name))


def output(name):
    return os.path.join(arguments.output, name)


# The scan: 64^3 floats after a header of 256 bytes, which contains the edges of a voxel in mm.
header = dict(line.split("=", 1) for line in open(data("skull_2.9.inr"), "rb").read(256).decode("latin-1").split("\n") if "=" in line)
scan = ImageReader(registrationName="Scan", FileNames=[data("skull_2.9.inr")], DataScalarType="float",
                   DataByteOrder="LittleEndian", FileDimensionality=3, ScalarArrayName="density",
                   DataExtent=[0, int(header["XDIM"]) - 1, 0, int(header["YDIM"]) - 1, 0, int(header["ZDIM"]) - 1],
                   DataSpacing=[float(header["VX"]), float(header["VY"]), float(header["VZ"])])
fine = ResampleToImage(registrationName="Finer scan", Input=scan, UseInputBounds=1,
                       SamplingDimensions=[arguments.grid] * 3)
stage("read and resample the scan", fine.UpdatePipeline)

# Bone: its surface has the value 2.9 in the scan. Bone scatters nearly all light and absorbs more blue than red. The
# optical thickness of real bone is some twenty times larger; this thin fog lets light into the skull.
medium = ParticipatingMedium(registrationName="Bone", Input=fine, MinimumDensity=1.9, MaximumDensity=3.5,
                             ExtinctionScale=0.3, Albedo=[0.93, 0.87, 0.76])
stage("make the medium", medium.UpdatePipeline)

sky = EnvironmentReader(registrationName="Sky", FileName=data("sunset.exr"))
stage("read the sky", sky.UpdatePipeline)

# The sun is low, to the left and behind the skull, so that its light shines through the bone.
sun = LightRig(registrationName="Sun", SunElevation=30, SunAzimuth=130, SunPower=[34, 26, 17])

light = LightPropagationMaps(registrationName="Light", Input=medium, Lights=sun, Environment=sky, Tolerance=1e-2)
stage("solve multiple scattering", light.UpdatePipeline)
light.UpdatePropertyInformation()
facts = servermanager.Fetch(light).GetFieldData()

bounds = light.GetDataInformation().GetBounds()
centre = [0.5 * (bounds[2 * axis] + bounds[2 * axis + 1]) for axis in range(3)]


def picture(name, azimuth, elevation, single=0):
    """Render from a place on a sphere about the skull."""
    a, e, distance = math.radians(azimuth), math.radians(elevation), 560.0
    caster = MediumRayCaster(registrationName=name, Input=light, Lights=sun, Environment=sky, ImageSize=arguments.size,
                             CameraFocalPoint=centre, SingleScatteringOnly=single, Exposure=0.45,
                             CameraPosition=[centre[0] + distance * math.cos(a) * math.cos(e),
                                             centre[1] + distance * math.sin(a) * math.cos(e),
                                             centre[2] + distance * math.sin(e)])
    stage("render " + name, caster.UpdatePipeline)
    SaveData(output(name + ".png"), proxy=caster)
    return caster


hero = picture("skull-multiple-scattering", 300, 10)
picture("skull-single-scattering", 300, 10, single=1)
picture("skull-on-the-square", 245, 6)


def slice_through_light():
    """Light is data: its fluence in a plane through the skull, in ParaView's own view."""
    view = CreateView("RenderView", ViewSize=arguments.size, OrientationAxesVisibility=0, Background=[0.12, 0.12, 0.14],
                      UseColorPaletteForBackground=0)
    cut = Slice(registrationName="Slice", Input=light, SliceType="Plane")
    cut.SliceType.Origin = centre
    cut.SliceType.Normal = [1, 0, 0]
    shown = Show(cut, view)
    ColorBy(shown, ("CELLS", "fluence", "Magnitude"))
    shown.Ambient, shown.Diffuse = 1, 0  # the colours of the colour bar, without shading
    table = GetColorTransferFunction("fluence")
    table.ApplyPreset("Inferno (matplotlib)", True)
    shown.RescaleTransferFunctionToDataRange()
    low, high = light.CellData["fluence"].GetRange(-1)
    table.RescaleTransferFunction(max(low, 2e-3 * high), high)
    table.MapControlPointsToLogSpace()
    table.UseLogScale = 1
    bar = GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle, bar.Visibility = "fluence, W/mm\u00b2", "", 1
    bar.TitleColor = bar.LabelColor = [1, 1, 1]
    bar.TitleFontSize = bar.LabelFontSize = round(16 * arguments.size[1] / 600)
    bar.ScalarBarThickness = round(16 * arguments.size[1] / 600)
    view.CameraPosition = [centre[0] + 600, centre[1], centre[2]]
    view.CameraFocalPoint, view.CameraViewUp, view.CameraParallelProjection = centre, [0, 0, 1], 1
    view.CameraParallelScale = 0.55 * max(bounds[3] - bounds[2], bounds[5] - bounds[4])
    SaveScreenshot(output("fluence-slice.png"), view)
    return view


def show_beside(view, caster):
    """What the state opens with: the light and a picture of it."""
    other = CreateView("RenderView", ViewSize=arguments.size, OrientationAxesVisibility=0, InteractionMode="2D",
                       CameraParallelProjection=1)
    Show(caster, other)
    ResetCamera(other)
    layout = CreateLayout("Light and picture")
    layout.SplitHorizontal(0, 0.5)
    layout.AssignView(1, other)
    layout.AssignView(2, view)


slice_view = stage("draw a slice of the light", slice_through_light)
stage("write light.vti", lambda: SaveData(output("light.vti"), proxy=light))
stage("write light.vdb", lambda: VDBWriter(Input=light, FileName=output("light.vdb")).UpdatePipeline())
show_beside(slice_view, hero)
SaveState(output("skull.pvsm"))

balance = facts.GetArray("energy_balance")
print("%-34s %9s" % ("stage", "seconds"))
for name, seconds in stages:
    print("%-34s %9.2f" % (name, seconds))
print("%-34s %9d" % ("scattering orders", light.Orders))
print("%-34s %9.1e" % ("energy balance, relative error", light.BalanceError))
for i, name in enumerate(("entered", "emitted", "absorbed", "escaped", "left over")):
    print("%-34s %s" % ("  " + name + ", W (red, green, blue)", "  ".join("%10.1f" % x for x in balance.GetTuple(i))))
print("%-34s %s" % ("device", facts.GetAbstractArray("device").GetValue(0)))
left_out = facts.GetAbstractArray("left_out")
for i in range(left_out.GetNumberOfValues()):
    print("%-34s %s" % ("left out" if i == 0 else "", left_out.GetValue(i)))
