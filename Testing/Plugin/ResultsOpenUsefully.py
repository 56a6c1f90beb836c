"""Light opens without a bar of colours, and other ways to show it begin with fluence, logarithmic where it spans decades; a chart of its convergence begins with residual and change, one of a comparison with points, a colour for each method."""
import os

from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def shown(extinction, view):
    medium = ParticipatingMedium(Input=Wavelet(WholeExtent=[-5, 5, -5, 5, -5, 5]), MaximumDensity=100,
                                 ExtinctionScale=extinction, Albedo=[0.2, 0.2, 0.2])
    light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1], DirectionsPerFace=4)
    light.UpdatePipeline()
    return light, Show(OutputPort(light, 0), view)


for extinction, decades in ((0.1, False), (5, True)):
    view = CreateView("RenderView")
    light, display = shown(extinction, view)
    lowest, highest = light.CellData["fluence"].GetRange()
    assert (highest >= 100 * lowest) == decades, (lowest, highest)
    assert display.Representation == "Lit Volume" and not display.ColorArrayName[1], display.ColorArrayName
    display.Representation = "Slice"
    assert display.ColorArrayName[1] == "fluence", display.ColorArrayName
    colors = display.LookupTable
    assert bool(colors.UseLogScale) == decades, (extinction, colors.UseLogScale)
    assert colors.RGBPoints[0] > 0 and abs(colors.RGBPoints[-4] - highest) < 1e-6 * highest, colors.RGBPoints
    Delete(colors)  # which all have in common that are coloured by fluence
    Delete(view)

view = CreateView("RenderView")
medium = ParticipatingMedium(Input=Wavelet(WholeExtent=[-5, 5, -5, 5, -5, 5]), MaximumDensity=300)
marched = PhotonMarcher(Input=medium, Photons=PhotonEmitter(Input=medium, Lights=LightRig(), PhotonCount=1000, Batches=2))
assert Show(marched, view).Representation == "Outline", "its paths are to be seen"
for filter in (PhotonReconstruction(Input=marched), LPMCollect(Input=LPMPropagate(Input=medium, Lights=LightRig()))):
    display = Show(OutputPort(filter, 0), view)
    assert display.Representation == "Lit Volume", (filter, display.Representation)
    display.Representation = "Slice"
    assert display.ColorArrayName[1] == "fluence", (filter, display.ColorArrayName)

chart = CreateView("XYChartView")
plotted = Show(OutputPort(light, 1), chart)
series = plotted.SMProxy.GetProperty("SeriesVisibility")  # name, 0 or 1, name, ...
pairs = [series.GetElement(i) for i in range(series.GetNumberOfElements())]
states = dict(zip(pairs[::2], pairs[1::2]))
assert sorted(name for name, on in states.items() if on == "1") == ["change", "residual"], states
assert plotted.XArrayName == "iteration" and plotted.UseIndexForXAxis == 0
assert chart.LeftAxisLogScale == 1 and chart.BottomAxisLogScale == 0

comparison = SolverComparison(Input=medium, Lights=LightRig(), Directions=[4, 9], Coarsenings=[1], Orders=[1], MapResolutions=[1],
                              PhotonCounts=[100, 1000], TimeBudget=1e6, MonteCarloReference="Never")
chart = CreateView("XYChartView")
plotted = Show(OutputPort(comparison, 0), chart)


def series_of(name):
    values = plotted.SMProxy.GetProperty(name)  # series, value, series, ...
    values = [values.GetElement(i) for i in range(values.GetNumberOfElements())]
    return dict(zip(values[::2], values[1::2]))


shown = sorted(name for name, on in series_of("SeriesVisibility").items() if on == "1")
assert shown == ["error of " + method for method in
                 ("as published", "constant source, not accelerated", "light propagation maps", "photons")], shown
for name in shown:
    assert series_of("SeriesLineStyle")[name] == "0" and series_of("SeriesMarkerStyle")[name] == "4", name
assert plotted.XArrayName == "seconds" and plotted.UseIndexForXAxis == 0
assert chart.LeftAxisLogScale == 1 and chart.BottomAxisLogScale == 1
