"""From a mesh to photons to light, through proxies: paths are lines, power is kept, and both schemes give light."""
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())

ball = Sphere(Radius=0.6, ThetaResolution=48, PhiResolution=48)
medium = MeshVoxelizer(Input=ball)
medium.SampleDimensions = [32, 32, 32]
rig = LightRig(SunElevation=60)

emitter = PhotonEmitter(Input=medium, Lights=rig)
emitter.PhotonCount = 20000
emitter.Sampler = "Halton"
photons = servermanager.Fetch(emitter)
assert photons.GetNumberOfPoints() == 20000
emitter.UpdatePropertyInformation()  # what the panel shows
assert emitter.Photons == 20000 and emitter.Power[0] > 0

marcher = PhotonMarcher(Input=medium, Photons=emitter)
marcher.PathCount = 12
light = servermanager.Fetch(marcher)
paths = servermanager.Fetch(marcher, idx=1)
assert paths.GetNumberOfLines() == 12, paths.GetNumberOfLines()
assert paths.GetNumberOfPoints() > 24, "none of them is bent"
balance = vtk_to_numpy(light.GetFieldData().GetArray("energy_balance"))
entered, emitted, absorbed, escaped, left = balance.reshape(5, -1)[:, 0]
assert entered > 0 and abs(entered + emitted - absorbed - escaped - left) < 1e-6 * entered, balance
marcher.UpdatePropertyInformation()
assert marcher.BalanceError < 1e-6 and marcher.Steps > 0 and marcher.Missed == 0
fluence = vtk_to_numpy(light.GetCellData().GetArray("fluence"))
assert fluence.max() > 3 * fluence.mean(), "no caustic"

octree = RefractionOctree(Input=medium)
steps = marcher.Steps
marcher.Octree = octree
marcher.UpdatePipeline()
marcher.UpdatePropertyInformation()
assert marcher.Steps < steps, (marcher.Steps, steps)
marcher.Octree = None

marcher.Scheme = "As published"
light = servermanager.Fetch(marcher)
assert vtk_to_numpy(light.GetCellData().GetArray("fluence")).max() > 0
marcher.UpdatePropertyInformation()
assert 0 < marcher.PackingLoss < 1, marcher.PackingLoss
assert light.GetFieldData().GetArray("packing_loss").GetValue(0) == marcher.PackingLoss
