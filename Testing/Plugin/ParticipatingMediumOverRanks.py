"""Two ranks: each has its half of the medium, and tells the size of the whole to light."""
import os
import re

from paraview import servermanager
from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
assert servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions() == 2

# A density that grows along z, the axis that is divided: (k + 1/2) / 32 in layer k of 32.
box = Wavelet(WholeExtent=[0, 8, 0, 8, 0, 32])
density = Calculator(Input=box, ResultArrayName="density", Function="coordsZ")
medium = ParticipatingMedium(Input=density, DensityArray=["POINTS", "density"], ExtinctionScale=0.5, LengthUnit="m",
                             PointData="Average To Cells")
medium.MaximumDensity = 32
medium.UpdatePipeline()
piece = medium.GetClientSideObject().GetOutputDataObject(0)
assert piece.GetNumberOfCells() == 8 * 8 * 32 / 2, piece.GetExtent()

told = str(medium.GetClientSideObject())  # on this rank, whose class Python does not know
for name, wanted in (("OpticalThickness", 0.5 * 16), ("MeanFreePath", 1 / (0.5 * 0.5))):
    found = float(re.search(name + r": (\S+)", told)[1])
    assert abs(found - wanted) < 1e-5, (name, found, wanted)
assert "PhysicalExtent: 8 x 8 x 32 m" in told, told
medium.UpdatePropertyInformation()
assert abs(medium.OpticalThickness - 0.5 * 16) < 1e-5, medium.OpticalThickness

# Voxels around points: one more of them along each axis, and those of the plane of points that both ranks have once.
medium.PointData = "Voxels Around Points"
medium.UpdatePipeline()
medium.UpdatePropertyInformation()
assert abs(medium.OpticalThickness - 0.5 * 16.5) < 1e-5, medium.OpticalThickness
assert str(medium.PhysicalExtent) == "9 x 9 x 33 m", medium.PhysicalExtent
