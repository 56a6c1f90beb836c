"""A whole chain over two ranks: each has its pieces of the light and the picture, equal to those of the whole: to rounding
where each rank solves or casts its piece of the medium, light of photons bit for bit.

    pvbatch --symmetric ChainOverRanks.py [MODULE]    the module that makes the chain; whole_chain if it is not said
"""
import importlib
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from paraview import servermanager
from paraview.vtk import vtkImageData

rank = servermanager.vtkProcessModule.GetProcessModule().GetPartitionId()
assert servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions() == 2
name = sys.argv[1] if len(sys.argv) > 1 else "whole_chain"
chain = importlib.import_module(name)
sky = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "ChainOverRanks%d%s.hdr" % (rank, name))
chain.write_sky(sky)


def check(proxy, association, name, tolerance):
    """@param tolerance  of the largest value"""
    algorithm = proxy.GetClientSideObject()
    piece = vtkImageData()
    piece.DeepCopy(algorithm.GetOutputDataObject(0))
    algorithm.UpdateWholeExtent()
    whole = algorithm.GetOutputDataObject(0)
    expected = vtkImageData()
    expected.DeepCopy(whole)
    expected.Crop(piece.GetExtent())
    assert 0 < piece.GetNumberOfPoints() < whole.GetNumberOfPoints(), piece.GetExtent()
    found = piece.GetAttributes(association).GetArray(name)
    wanted = expected.GetAttributes(association).GetArray(name)
    assert found.GetNumberOfValues() == wanted.GetNumberOfValues() > 0
    apart = max(abs(found.GetValue(i) - wanted.GetValue(i)) for i in range(found.GetNumberOfValues()))
    print(name, "differs by", apart, flush=True)
    assert apart <= tolerance * wanted.GetMaxNorm(), (name, apart)


light = chain.solve(sky)
check(light, vtkImageData.CELL, "fluence", 1e-6 if name == "whole_chain" else 0)
check(chain.render(light), vtkImageData.POINT, "radiance", 1e-6)
