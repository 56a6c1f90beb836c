"""Lit Volume drawn by two ranks that run the script themselves: the picture of the whole, also where a rank has no piece.

    pvbatch --symmetric LitVolumeOverRanks.py
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import glass_chain
import lit_view
import numpy
import pictures
from paraview import servermanager
from paraview.simple import *

rank = servermanager.vtkProcessModule.GetProcessModule().GetPartitionId()
assert servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions() == 2
output = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "LitVolumeOverRanks")
lit_view.load(remote=True)
LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())  # its names, here too
view = lit_view.black_view()
wrong = []  # said at the end: until then the other rank waits for this one


def drawn(name, size):
    """@return the pixels, on the first rank, which has them all"""
    SaveScreenshot(output + name + ".png", view, ImageResolution=size)
    return pictures.read(output + name + ".png") if rank == 0 else None


def check(name, light, **more):
    size = more.get("ImageSize", lit_view.SIZE)
    whole = lit_view.caster(light, view, **more).GetClientSideObject()
    whole.UpdateWholeExtent()
    expected = pictures.of_image(whole.GetOutputDataObject(0), "color")
    found = drawn(name, size)
    if rank == 0:
        apart = numpy.abs(found.astype(int) - expected)
        pictures.write(output + name + "Beside.png", numpy.concatenate([found, expected], axis=1))
        print(name, "largest difference", apart.max(), flush=True)
        if expected.max() < 100 or found.std() < 5:
            wrong.append(name + ": there is nothing to compare")
        if apart.max() > 2:
            wrong.append("%s: %d apart" % (name, apart.max()))


light = lit_view.solved()
lit_view.show_lit(light, view)
check("Front", light)
check("Large", light, ImageSize=[2 * length for length in lit_view.SIZE])
view.SMProxy.InteractiveRender()
check("StillAgain", light)
Hide(light, view)

# Light from lamps by moments, and what is behind seen through coloured smoke.
smoke = ParticipatingMedium(Input=Wavelet(WholeExtent=[-8, 8, -8, 8, -8, 8]), MinimumDensity=37, MaximumDensity=277,
                            ExtinctionScale=0.1, Albedo=[0.9, 0.7, 0.4])
coloured = LightPropagationMaps(Input=smoke, Lights=LightRig(), DirectionsPerFace=4)
lit_view.show_lit(coloured, view).ShowBackground = 1
check("Coloured", coloured, ShowBackground=1)
Hide(coloured, view)

# One voxel: the second rank has none.
single = ParticipatingMedium(Input=Wavelet(WholeExtent=[-8, -7, -8, -7, -8, -7]), MinimumDensity=0, MaximumDensity=100,
                             ExtinctionScale=5)
one = LightPropagationMaps(Input=single, Lights=LightRig(), DirectionsPerFace=4)
lit_view.show_lit(one, view)
view.CameraPosition, view.CameraFocalPoint = [-5.5, -12, -6], [-7.5, -7.5, -7.5]
check("OneVoxel", one)
Hide(one, view)

# Rays that bend: each rank shows its piece, and none waits for another.
sky = output + "%d.hdr" % rank
glass_chain.write_sky(sky)
glass = glass_chain.solve(sky)
shown = Show(glass, view)
shown.Representation = "Lit Volume"
ResetCamera(view)
found = drawn("Glass", lit_view.SIZE)
if rank == 0 and found.max() < 50:
    wrong.append("Glass: nothing is shown")
assert not wrong, wrong
