"""For scripts of pvbatch --symmetric in which each rank has a piece of an image of its own."""
import os
import time

import numpy
from paraview import servermanager
from paraview.vtk.util.numpy_support import numpy_to_vtk


def errors_of(proxy):
    """@return the texts of the errors that the proxy's filter makes from now on"""
    texts = []

    def note(caller, event, text):
        texts.append(text)

    note.CallDataType = "string0"
    proxy.GetClientSideObject().AddObserver("ErrorEvent", note)
    return texts


def dies_amid(proxy, after=0.0):
    """This rank is killed when so much of the filter's work is done; the others are to hear of it from mpiexec."""
    def end(caller, event):
        if caller.GetProgress() >= after:
            print("killed at %f" % time.time(), flush=True)
            os.kill(os.getpid(), 9)

    proxy.GetClientSideObject().AddObserver("ProgressEvent", end)


def source_of(piece):
    """@return a source of what this rank has"""
    producer = servermanager.sources.PVTrivialProducer()
    producer.GetClientSideObject().SetOutput(piece)
    return producer


def flag_duplicates(image, own):
    """Flags cells outside of an extent as those of another rank.
    @return which these are"""
    extent = image.GetExtent()
    inside = [(n >= own[2 * a]) & (n < own[2 * a + 1])
              for a, n in enumerate(numpy.arange(extent[2 * a], extent[2 * a + 1]) for a in range(3))]
    ghost = ~(inside[2][:, None, None] & inside[1][None, :, None] & inside[0][None, None, :]).ravel()
    flags = numpy_to_vtk(ghost.astype(numpy.uint8), deep=True)
    flags.SetName("vtkGhostType")
    image.GetCellData().AddArray(flags)
    return ghost
