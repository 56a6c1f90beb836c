"""From a mesh to a picture with adaptive photons, through proxies: the map, dense photons, smooth light and its error."""
import math
import os

import numpy
from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def cells(data, name):
    return vtk_to_numpy(data.GetCellData().GetArray(name)).astype(float)


def fact(data, name):
    return vtk_to_numpy(data.GetFieldData().GetArray(name))


ball = Sphere(Radius=0.6, ThetaResolution=48, PhiResolution=48)
medium = MeshVoxelizer(Input=ball, SampleDimensions=[32, 32, 32])
octree = RefractionOctree(Input=medium)
sun = LightRig(SunElevation=60)

importance = PhotonImportance(Input=octree, Lights=sun)
map_ = servermanager.Fetch(importance)
assert map_.GetDimensions() == (33, 33, 2), map_.GetDimensions()
density = cells(map_, "importance")
assert abs(density.mean() - 1) < 1e-5 and density.min() >= 0.29 and density.max() > 1.5, (density.min(), density.max())
assert list(fact(map_, "light")) == [0] and list(fact(map_, "even")) == [0]
pilot = servermanager.Fetch(importance, idx=1)
assert pilot.GetDimensions() == (17, 17, 17), pilot.GetDimensions()
assert cells(pilot, "origin_mean").shape == (4096, 2)
assert 0 < cells(pilot, "chosen").sum() < 4096
importance.UpdatePropertyInformation()  # what the panel shows
assert importance.Even == 0 and importance.UsedGradientThreshold > 0 and importance.DeviceName

emitter = PhotonEmitter(Input=octree, Lights=sun, ImportanceMap=importance, PhotonCount=20000)
photons = servermanager.Fetch(emitter)
weight = vtk_to_numpy(photons.GetPointData().GetArray("weight"))
batch = vtk_to_numpy(photons.GetPointData().GetArray("batch"))
assert 0 < weight.min() < 0.9 and 1.1 < weight.max() < 3.5, (weight.min(), weight.max())
assert set(batch) == {0, 1}, set(batch)
emitter.UpdatePropertyInformation()
power = emitter.Power[0]

marcher = PhotonMarcher(Input=octree, Photons=emitter, PhotonCounts=1)
noisy = servermanager.Fetch(marcher)
assert cells(noisy, "photon_count").max() > 20 and cells(noisy, "photon_weight").max() < 3.5
batches = cells(noisy, "fluence_batches")
assert numpy.allclose(batches.reshape(len(batches), -1).mean(1), cells(noisy, "fluence"), rtol=1e-4, atol=1e-6)

reconstruction = PhotonReconstruction(Input=marcher)
smooth = servermanager.Fetch(reconstruction)
total = cells(noisy, "fluence").sum()
assert abs(cells(smooth, "fluence").sum() / total - 1) < 1e-5
assert numpy.isfinite(cells(smooth, "fluence_error")).all() and cells(smooth, "fluence_error").min() >= 0
assert 0 <= cells(smooth, "mip_level").min() and 0 < cells(smooth, "mip_level").max() <= 5
assert not smooth.GetCellData().HasArray("fluence_batches") and smooth.GetCellData().HasArray("ior")
assert list(fact(smooth, "energy_balance")) == list(fact(noisy, "energy_balance"))
reconstruction.UpdatePropertyInformation()
error = math.sqrt((cells(smooth, "fluence_error") ** 2).sum() / (cells(smooth, "fluence") ** 2).sum())
assert abs(reconstruction.MeanError / error - 1) < 1e-6 and 0.001 < error < 0.5, (reconstruction.MeanError, error)
assert fact(smooth, "fluence_bias")[0] == reconstruction.Bias and abs(reconstruction.Bias) < 0.2

for scheme in ("As published", "Constant radius", "Nearest photons"):
    reconstruction.Scheme = scheme
    reconstruction.ConserveFluence = "Always"
    other = servermanager.Fetch(reconstruction)
    assert abs(cells(other, "fluence").sum() / total - 1) < 1e-5, scheme
    assert not other.GetCellData().HasArray("fluence_error"), scheme
reconstruction.Scheme = "Conservative"

picture = MediumRayCaster(Input=reconstruction, ImageSize=[80, 60])
radiance = vtk_to_numpy(servermanager.Fetch(picture).GetPointData().GetArray("radiance"))
assert numpy.isfinite(radiance).all() and radiance.max() > 0

# Other light: the medium is not prepared again, and the map stays what it is.
sun.SunPower = [1e6, 1e6, 1e6]
reconstruction.UpdatePipeline()
marcher.UpdatePropertyInformation()
emitter.UpdatePropertyInformation()
assert marcher.MediumKept == 1
assert abs(emitter.Power[0] / power / 1e6 - 1) < 1e-4, (emitter.Power, power)
assert abs(cells(servermanager.Fetch(importance), "importance") - density).max() < 1e-6

# Another medium: nothing of the old one is left.
medium.InsideIndex = 1.1
reconstruction.UpdatePipeline()
marcher.UpdatePropertyInformation()
assert marcher.MediumKept == 0
fresh = PhotonMarcher(Input=octree, Photons=emitter, PhotonCounts=1)
assert (cells(servermanager.Fetch(fresh), "fluence") == cells(servermanager.Fetch(marcher), "fluence")).all()

# Without a map photons are spread evenly, in one batch, of which the conservative scheme cannot tell the error.
emitter.ImportanceMap = None
photons = servermanager.Fetch(emitter)
assert photons.GetPointData().GetArray("weight").GetRange() == (1, 1)
assert photons.GetPointData().GetArray("batch").GetRange() == (0, 0)
