"""Light transport in participating media: Tyndall's VTK classes, and `solve` for numpy arrays.

    from tyndall import vtkLightPropagationMaps     # any class of the library, as in C++
    light = tyndall.solve(density, spacing)         # see solve's own help

The classes belong to one VTK: that of the Python modules (vtkmodules) they were built beside, Debian's ParaView or
Debian's VTK 9.1. PyVista's objects are VTK's, and go in as they are, where PyVista stands on the same VTK, not on pip's.
"""

from .host import check_vtk

check_vtk()

from .vtkTyndall import *
from .solving import Light, SolvingError, image_of, picture, solve
