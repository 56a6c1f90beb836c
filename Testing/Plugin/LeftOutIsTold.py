"""What a build leaves out is told where it is used, by one error that names the option (two ranks of pvbatch: on each).

    pvpython LeftOutIsTold.py OPTION    OPENVDB, OPENEXR or MPI: TYNDALL_WITH_... that is off
"""
import os
import sys

from paraview.simple import *
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
option = sys.argv[1]
path = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "LeftOut.")
wavelet = Wavelet(WholeExtent=[0, 8, 0, 8, 0, 8])


def read(reader, ending):
    with open(path + ending, "w") as file:
        file.write("not read")
    reader(FileName=path + ending).UpdatePipeline()


def write():
    SaveData(path + "written.vdb", proxy=PointDatatoCellData(Input=wavelet))
    assert not os.path.exists(path + "written.vdb")


def prepare():
    ParticipatingMedium(Input=wavelet).UpdatePipeline()


USES = {
    "OPENVDB": (lambda: read(VDBReader, "vdb"), write),
    "OPENEXR": (lambda: read(EnvironmentReader, "exr"),),
    "MPI": (prepare,),
}
window = vtkOutputWindow.GetInstance()  # Python prints there, too
for use in USES[option]:
    said = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(said)
    try:
        use()
    except RuntimeError as error:  # of a writer
        print("an exception, too: %s" % error)
    finally:
        vtkOutputWindow.SetInstance(window)
    print(said.GetOutput())
    assert said.GetOutput().count("TYNDALL_WITH_" + option) == 1, said.GetOutput()
