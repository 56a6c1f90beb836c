"""Light in the 3D view, compared with Medium Ray Caster's picture, for the tests of the representation Lit Volume."""
import os

import numpy
import pictures
from paraview import servermanager
from paraview.simple import *

import paraview.simple

paraview.simple._DisableFirstRenderCameraReset()

SIZE = [200, 150]
EXPOSURE = 4.0


def load(remote):
    LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=remote, ns=globals())


def solved():
    medium = ParticipatingMedium(Input=Wavelet(WholeExtent=[-8, 8, -8, 8, -8, 8]),
                                 MinimumDensity=37, MaximumDensity=277, ExtinctionScale=0.1)
    return LightPropagationMaps(Input=medium, Lights=LightRig(), DirectionsPerFace=4)


def show_nothing_else(view):
    """Pixels are those of what is shown, over black."""
    view.OrientationAxesVisibility = 0
    view.UseFXAA = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [0, 0, 0]


def make_black(view):
    view.ViewSize = SIZE
    show_nothing_else(view)
    place_camera(view)
    return view


def place_camera(view):
    view.CameraPosition = [9, -40, 21]
    view.CameraFocalPoint = [1, 0.5, -1]
    view.CameraViewUp = [0, 0, 1]
    view.CameraViewAngle = 35


def black_view():
    return make_black(CreateView("RenderView"))


def show_lit(light, view):
    shown = Show(light, view)
    shown.Representation = "Lit Volume"
    shown.Exposure = EXPOSURE
    return shown


def drawn(view):
    Render(view)
    return pictures.of_image(view.CaptureWindow(1))


def caster(light, view, **more):
    """
    @param more  properties that it has otherwise than the view, or beside it
    @return a Medium Ray Caster with the view's camera and size
    """
    of_view = {"ImageSize": list(view.ViewSize), "Exposure": EXPOSURE, "CameraPosition": view.CameraPosition,
               "CameraFocalPoint": view.CameraFocalPoint, "CameraViewUp": view.CameraViewUp,
               "CameraViewAngle": view.CameraViewAngle}
    return MediumRayCaster(Input=light, **{**of_view, **more})


def cast(light, view, **more):
    """@return the pixels of such a picture, over black"""
    return pictures.of_image(servermanager.Fetch(caster(light, view, **more)), "color")


def check_same(found, expected):
    assert found.shape == expected.shape, (found.shape, expected.shape)
    assert expected.max() > 100 and found.std() > 10, "there is nothing to compare"
    assert numpy.abs(found - expected).max() <= 1, numpy.abs(found - expected).max()
