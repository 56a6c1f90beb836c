"""Light transport in participating media: Tyndall's VTK classes, and `solve` for numpy arrays.

    from tyndall import vtkLightPropagationMaps     # any class of the library, as in C++
    light = tyndall.solve(density, spacing)         # see solve's own help

The classes belong to one VTK: that of the Python modules (vtkmodules) they were built beside, Debian's ParaView or
Debian's VTK 9.1. Objects of another VTK in the same process (pip's vtk, on which pip's pyvista stands) are strangers to
them; PyVista works where it is installed on the same VTK.
"""

from .vtkTyndall import *
from .solving import Light, SolvingError, image_of, picture, solve
