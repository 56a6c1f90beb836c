"""Lights, an environment, light of photons and a map that were connected can be disconnected again."""
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk.util.numpy_support import vtk_to_numpy

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())

medium = ParticipatingMedium(Input=Wavelet(WholeExtent=[-3, 3, -3, 3, -3, 3]))
medium.UpdatePipeline()
lights = LightRig()
sky = Calculator(Input=Wavelet(WholeExtent=[0, 7, 0, 3, 0, 0]), ResultArrayName="radiance", Function="1+0*RTData")
sky.UpdatePipeline()


def brightness(proxy):
    """The largest value of the light in a filter's output."""
    data = servermanager.Fetch(proxy)
    names = ["radiance", "fluence"] + ["T_" + side for side in ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")]
    found = [attributes.GetArray(name) for attributes in (data.GetPointData(), data.GetCellData())
             for name in names if attributes.HasArray(name)]
    return max(vtk_to_numpy(array).max() for array in found)


def switch_default_sky_off(proxy):
    if "DefaultSky" in proxy.ListProperties():
        proxy.DefaultSky = 0


for make in (LightPropagationMaps, LPMPropagate, MediumRayCaster):
    proxy = make(Input=medium)
    switch_default_sky_off(proxy)
    dark = brightness(proxy)
    assert dark == 0, (make, dark)
    for name, source in (("Lights", lights), ("Environment", sky)):
        setattr(proxy, name, source)
        assert brightness(proxy) > 0, (make, name)
        setattr(proxy, name, None)
        assert brightness(proxy) == 0, (make, name)

emitter = PhotonEmitter(Input=medium, SkyColor=[1, 1, 1], PhotonCount=2000)

marched = PhotonMarcher(Input=medium, Photons=emitter)
for make in (LightPropagationMaps, DiscreteOrdinates, LatticeBoltzmannLighting):
    proxy = make(Input=medium, DefaultSky=0)
    proxy.UncollidedLight = marched
    assert brightness(proxy) > brightness(marched), make  # it is scattered as well
    proxy.UncollidedLight = None
    assert brightness(proxy) == 0, make
    if make is LatticeBoltzmannLighting:
        proxy.Photons = emitter
        assert brightness(proxy) > brightness(marched)
        proxy.Photons = None
        assert brightness(proxy) == 0


def batches():
    return servermanager.Fetch(emitter).GetPointData().GetArray("batch").GetRange()[1] + 1


assert batches() == 1, batches()
importance = PhotonImportance(Input=medium, Lights=lights)
for name, source in (("Environment", sky), ("Lights", None)):
    setattr(importance, name, source)
emitter.ImportanceMap = importance  # of the sky alone
assert batches() == 2, batches()
assert list(vtk_to_numpy(servermanager.Fetch(importance).GetFieldData().GetArray("light"))) == [-1]
emitter.ImportanceMap = None
assert batches() == 1, batches()
