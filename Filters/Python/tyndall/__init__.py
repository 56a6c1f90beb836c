"""Light transport in participating media: Tyndall's VTK classes, and `solve` for numpy arrays.

    from tyndall import vtkLightPropagationMaps     # any class of the library, as in C++
    light = tyndall.solve(density, spacing)         # see solve's own help

The classes belong to one VTK: that of the Python modules (vtkmodules) they were built beside, which `tyndall.host`
names: of Debian's ParaView, of Debian's VTK, or of pip's. PyVista's objects are VTK's, and go in as they are, where
PyVista stands on the same VTK.
"""

from .host import check_vtk, find_opencl

check_vtk()
find_opencl()

from .vtkTyndall import *
from .solving import Light, SolvingError, image_of, picture, solve
