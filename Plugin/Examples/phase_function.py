"""How many terms a phase function needs: figures 3 and 4 of Gong et al., by the source SeparablePhaseFunction.

    pvpython phase_function.py [OUTPUT FOLDER] [--directions 256] [--size 900 600]

Writes phase-function-error.png, the relative error of N terms for four mean cosines beside theory, and phase-function.png,
Henyey and Greenstein's phase function and what 8 and 24 terms make of it.
"""
import argparse
import math
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkTable
from paraview.vtk.vtkChartsCore import vtkAxis, vtkChart, vtkChartLegend, vtkChartXY
from paraview.vtk.vtkCommonCore import vtkFloatArray
from paraview.vtk.vtkIOImage import vtkPNGWriter
from paraview.vtk.vtkRenderingCore import vtkWindowToImageFilter
from paraview.vtk.vtkViewsContext2D import vtkContextView

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
# As published: directions of equal weights, point values of the phase function, and no correction (Repaired) that makes
# the sum of terms conserve power.
PUBLISHED = dict(DirectionSet=2, Repaired=0)
# Colours of Okabe and Ito, which colour-blind readers can tell apart.
COLORS = ((0, 114, 178), (230, 159, 0), (0, 158, 115), (213, 94, 0))


def column(table, name):
    array = table.GetColumnByName(name)
    return [array.GetComponent(i, 0) for i in range(array.GetNumberOfTuples())]


class Chart:
    """Lines over a common abscissa, as a picture."""

    def __init__(self, title, bottom, left, size):
        self.view = vtkContextView()
        self.view.GetRenderer().SetBackground(1, 1, 1)
        self.view.GetRenderWindow().SetSize(*size)
        self.view.GetRenderWindow().SetMultiSamples(8)
        self.view.GetRenderWindow().SetOffScreenRendering(True)
        self.chart = vtkChartXY()
        self.view.GetScene().AddItem(self.chart)
        self.chart.SetTitle(title)
        self.chart.SetShowLegend(True)
        self.chart.GetLegend().SetInline(False)
        self.chart.GetLegend().SetHorizontalAlignment(vtkChartLegend.RIGHT)
        self.chart.GetLegend().SetVerticalAlignment(vtkChartLegend.TOP)
        self.chart.GetAxis(vtkAxis.BOTTOM).SetTitle(bottom)
        self.chart.GetAxis(vtkAxis.LEFT).SetTitle(left)
        self.chart.GetAxis(vtkAxis.LEFT).LogScaleOn()
        self.tables = []

    def line(self, abscissa, ordinate, label, color, width=2.5, marks=False):
        table = vtkTable()
        for name, values in (("x", abscissa), (label, ordinate)):
            array = vtkFloatArray()
            array.SetName(name)
            for value in values:
                array.InsertNextValue(value)
            table.AddColumn(array)
        self.tables.append(table)  # keeps a reference, because the chart does not
        plot = self.chart.AddPlot(vtkChart.POINTS if marks else vtkChart.LINE)
        plot.SetInputData(table, 0, 1)
        plot.SetColor(*color, 255)
        plot.SetWidth(width)
        plot.SetLabel(label)

    def save(self, path):
        self.view.GetRenderWindow().Render()
        grab = vtkWindowToImageFilter()
        grab.SetInput(self.view.GetRenderWindow())
        grab.ReadFrontBufferOff()
        writer = vtkPNGWriter()
        writer.SetFileName(path)
        writer.SetInputConnection(grab.GetOutputPort())
        writer.Write()


def tables_of(**settings):
    """Factors and errors of a separable phase function."""
    phase = SeparablePhaseFunction(**settings)
    phase.UpdatePipeline()
    tables = [servermanager.Fetch(phase, idx=port) for port in (0, 1)]
    Delete(phase)
    return tables


def draw_errors(arguments):
    """Figure 3: relative RMSE over the number of terms."""
    chart = Chart("Relative error of N singular values (lines) and theory (marks)", "Terms N", "Relative error", arguments.size)
    for g, color in zip((0.25, 0.35, 0.4, 0.5), COLORS):
        _, errors = tables_of(G=g, SpiralDirections=arguments.directions, Terms=40, **PUBLISHED)
        terms = column(errors, "terms")
        chart.line(terms, column(errors, "error_singular_values"), "g = %g" % g, color)
        chart.line(terms[::3], column(errors, "error_theory")[::3], "theory, g = %g" % g, color, marks=True)
        print("g %g: error of 24 terms %.4f, theory %.4f, power scattered off by up to %.2g" % (
            g, column(errors, "error")[23], column(errors, "error_theory")[23], column(errors, "row_sum_error")[23]))
    chart.save(os.path.join(arguments.output, "phase-function-error.png"))


def draw_function(arguments, g=0.5):
    """Figure 4: the phase function from the first direction into all others, over the angle."""
    chart = Chart("Henyey and Greenstein's phase function, g = %g" % g, "Angle (degrees)", "1/sr", arguments.size)
    angles = range(0, 181)
    exact = [(1 - g * g) / (4 * math.pi * (1 + g * g - 2 * g * math.cos(math.radians(a))) ** 1.5) for a in angles]
    chart.line(list(angles), exact, "exact", (90, 90, 90), 5.0)
    factors, errors = tables_of(G=g, SpiralDirections=arguments.directions, Terms=24, **PUBLISHED)
    directions = factors.GetColumnByName("direction")
    first, count = directions.GetTuple(0), directions.GetNumberOfTuples()
    eigenvalues = column(errors, "eigenvalue")
    u = [column(factors, "u_%d" % (k + 1)) for k in range(24)]
    cosines = [sum(a * b for a, b in zip(first, directions.GetTuple(i))) for i in range(count)]
    for terms, color in ((8, COLORS[1]), (24, COLORS[0])):
        pairs = sorted((math.degrees(math.acos(max(-1.0, min(1.0, cosines[i])))),
                        sum(eigenvalues[k] * u[k][0] * u[k][i] for k in range(terms))) for i in range(count))
        pairs = [pair for pair in pairs if pair[1] > 0.0]  # values below 0 cannot be shown on a logarithmic axis
        chart.line([p[0] for p in pairs], [p[1] for p in pairs], "%d terms" % terms, color)
    chart.save(os.path.join(arguments.output, "phase-function.png"))


parser = argparse.ArgumentParser(description="How many terms a phase function needs.")
parser.add_argument("output", nargs="?", default=".")
parser.add_argument("--directions", type=int, default=256)
parser.add_argument("--size", type=int, nargs=2, default=[900, 600])
arguments = parser.parse_args()
draw_errors(arguments)
draw_function(arguments)
