"""Drawing a filter's output as ParaView's views show it, for the tests of the label image."""
import pictures

import paraview.simple
from paraview.simple import *

paraview.simple._DisableFirstRenderCameraReset()


def drawn(show, size, position, focal_point, scale, up=(0, 0, 1)):
    """
    @param show  called with a view, shows something in it
    @param scale  half the height of what is seen, length
    @return pixels of the view
    """
    view = CreateView("RenderView")
    view.ViewSize = size
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    show(view)
    view.CameraPosition = position
    view.CameraFocalPoint = focal_point
    view.CameraViewUp = up
    view.CameraParallelProjection = 1
    view.CameraParallelScale = scale
    Render(view)
    pixels = pictures.of_image(view.CaptureWindow(1))
    Delete(view)
    return pixels


def colored(source, array, low, high, view, **properties):
    """Shows a source, coloured by an array from low to high."""
    shown = Show(source, view, **properties)
    ColorBy(shown, array)
    shown.SetScalarBarVisibility(view, False)
    GetColorTransferFunction(array[1]).RescaleTransferFunction(low, high)
    return shown


def cut(source, normal, origin):
    """A plane through a source."""
    plane = Slice(Input=source, SliceType="Plane")
    plane.SliceType.Normal = normal
    plane.SliceType.Origin = origin
    return plane
