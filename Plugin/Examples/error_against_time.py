"""Which solver, at which setting, for a scene of your own: error against run time, as table and plot.

    pvpython error_against_time.py MEDIUM [--lights FILE.vtp] [--sun ELEVATION AZIMUTH R G B] [--point X Y Z R G B]
        [--sky R G B] [--environment FILE.exr] [--reference FILE.vti] [--budget 300] [--output FOLDER] ...

MEDIUM is a .vti or .vdb file with cells sigma_a and sigma_s, or with a density, of which ParticipatingMedium then makes the medium
(--extinction and --albedo say how). Runs the filter SolverComparison; writes FOLDER/NAME.csv, NAME.jsonl and NAME.png, and prints
what to use for errors of 10%, 1% and 0.1%, and the filters of the recommended setting. bench_error.py does the same for scenes with
trusted reference values, with the functions here. In a script, make_recommended(comparison) creates the recommended filters on the
inputs of a comparison, as the button Make Recommended does.
"""
import argparse
import csv
import json
import math
import os

from paraview import servermanager
from paraview.simple import *
from paraview.vtk import vtkTable
from paraview.vtk.vtkChartsCore import vtkAxis, vtkChart, vtkChartLegend, vtkChartXY, vtkPlotLine, vtkPlotPoints
from paraview.vtk.vtkCommonCore import vtkDoubleArray, vtkFloatArray, vtkStringArray
from paraview.vtk.vtkIOImage import vtkPNGWriter
from paraview.vtk.vtkRenderingCore import vtkWindowToImageFilter
from paraview.vtk.vtkViewsContext2D import vtkContextView

TARGETS = (0.1, 0.01, 0.001)
# Colours of Okabe and Ito, which colour-blind readers can tell apart, and shapes of markers for print in grey.
STYLES = {
    "light propagation maps": ((0, 114, 178), vtkPlotPoints.CIRCLE),
    "constant source, not accelerated": ((230, 159, 0), vtkPlotPoints.SQUARE),
    "as published": ((213, 94, 0), vtkPlotPoints.DIAMOND),
    "as published, sequential": ((204, 121, 167), vtkPlotPoints.DIAMOND),
    "discrete ordinates": ((160, 130, 60), vtkPlotPoints.SQUARE),
    "lattice Boltzmann": ((120, 60, 160), vtkPlotPoints.DIAMOND),
    "photons": ((0, 158, 115), vtkPlotPoints.CIRCLE),
    "adaptive photons": ((86, 180, 233), vtkPlotPoints.SQUARE),
    "photons as published": ((110, 110, 110), vtkPlotPoints.DIAMOND),
    "Monte Carlo": ((0, 0, 0), vtkPlotPoints.CIRCLE),
    "photons, then maps": ((0, 60, 120), vtkPlotPoints.SQUARE),
    "voxelizer and photons": ((150, 75, 0), vtkPlotPoints.SQUARE),
    "picture": ((200, 0, 60), vtkPlotPoints.CIRCLE),
}
# What the legend adds to the method for what is compared, and the colour of the band along the best settings.
QUANTITIES = {"fluence": ("", (200, 200, 200)), "fluence_direct": (" (unscattered light)", (200, 225, 210)), "radiance": (" (radiance)", (240, 210, 220))}


def rows_of(comparison):
    """The table of a SolverComparison proxy as a list of dictionaries, and its facts."""
    table = servermanager.Fetch(comparison)
    columns = [table.GetColumn(i) for i in range(table.GetNumberOfColumns())]
    rows = []
    for i in range(table.GetNumberOfRows()):
        row = {}
        for column in columns:
            if column.GetNumberOfComponents() > 1:
                row[column.GetName()] = list(column.GetTuple(i))
            else:
                row[column.GetName()] = column.GetValue(i)
        rows.append(row)
    facts = {}
    for name in ("reference", "recommended", "left_out", "device"):
        array = table.GetFieldData().GetAbstractArray(name)
        facts[name] = [array.GetValue(i) for i in range(array.GetNumberOfValues())] if array else []
    return rows, facts


def print_left_out(lines):
    """What was not compared; settings of a method in one line."""
    together = {}
    for line in lines:
        method = next((name for name in sorted(STYLES, key=len, reverse=True) if line.startswith(name + ", ")), None)
        setting, _, why = line[len(method) + 2:].partition(": ") if method else ("", "", line)
        together.setdefault((method, why), []).append(setting)
    for (method, why), settings in together.items():
        print("left out: " + (why if method is None else "%s (%s): %s" % (method, "; ".join(settings), why)))


def shown(value):
    return [shown(each) for each in value] if isinstance(value, list) else float("%.6g" % value) if isinstance(value, float) else value


def known(row):
    """What of a row is a number or a word: JSON has no NaN."""
    return {key: shown(value) for key, value in row.items() if not (isinstance(value, float) and math.isnan(value))}


def write_json(rows, path, **more):
    with open(path, "w") as file:
        for row in rows:
            file.write(json.dumps({**more, **known(row)}) + "\n")


def write_csv(rows, path):
    names = []
    for row in rows:
        names += [name for name in row if name not in names and not isinstance(row[name], list)]
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, names, extrasaction="ignore")
        writer.writeheader()
        writer.writerows([known(row) for row in rows])


def front(rows, error="error_l2"):
    """Rows that no other one beats in both time and error, fastest first."""
    best, lowest = [], math.inf
    for row in sorted(rows, key=lambda row: (row["seconds"], row[error])):
        if row[error] < lowest:
            best.append(row)
            lowest = row[error]
    return best


def seconds_for(rows, target, error="error_l2"):
    """Time in which a method gets to an error: between the two settings of its front beside it, along a line of logarithms."""
    ahead = None
    for row in front(rows, error):
        if row[error] <= target:
            if ahead is None or row[error] <= 0.0:
                return row["seconds"]
            part = math.log(ahead[error] / target) / math.log(ahead[error] / row[error])
            return ahead["seconds"] * (row["seconds"] / ahead["seconds"]) ** part
        ahead = row
    return math.nan


def fastest_for(rows, target, error="error_l2"):
    """The fastest row that is as good as that, or None."""
    good = [row for row in rows if row[error] <= target]
    return min(good, key=lambda row: row["seconds"]) if good else None


def methods_of(rows):
    return [name for name in STYLES if any(row["method"] == name for row in rows)]


def advice(rows):
    """Lines that say what to use."""
    for quantity in QUANTITIES:
        of = [row for row in rows if row["quantity"] == quantity and not math.isnan(row["error_l2"])]
        for target in TARGETS if of else ():
            best = fastest_for(of, target)
            if best:
                yield "%-14s error below %5.1f%%: %s, %s: %.3g s, error %.2g%%" % (
                    quantity, 100 * target, best["method"], best["setting"], best["seconds"], 100 * best["error_l2"])
            else:
                least = min(of, key=lambda row: row["error_l2"])
                yield "%-14s error below %5.1f%%: none; best is %s, %s: %.3g s, error %.2g%%" % (
                    quantity, 100 * target, least["method"], least["setting"], least["seconds"], 100 * least["error_l2"])


def around(values):
    """Logarithms of the ends of an axis, and the numbers on it: powers of ten, or more of them on a short one."""
    low, high = math.log10(min(values)), math.log10(max(values))
    margin = max(0.06 * (high - low), 0.12)
    low, high = low - margin, high + margin
    steps = (1,) if high - low > 2.5 else (1, 3) if high - low > 1.2 else (1, 2, 5)
    powers = range(math.floor(low), math.ceil(high) + 1)
    return low, high, [step * 10.0 ** power for power in powers for step in steps if low <= power + math.log10(step) <= high]


class Plot:
    """Error over seconds, both logarithmic: a colour a method, a line along its best settings, a band along the best of all."""

    def __init__(self, title, error_title):
        self.view = vtkContextView()
        self.view.GetRenderer().SetBackground(1, 1, 1)
        self.view.GetRenderWindow().SetSize(1600, 900)
        self.view.GetRenderWindow().SetMultiSamples(8)
        self.view.GetRenderWindow().SetOffScreenRendering(True)
        self.chart = vtkChartXY()
        self.view.GetScene().AddItem(self.chart)
        self.chart.SetTitle(title + "\n ")  # empty line between title and chart
        self.chart.GetTitleProperties().SetFontSize(26)
        self.chart.GetTitleProperties().SetBold(True)
        self.chart.SetShowLegend(True)
        legend = self.chart.GetLegend()
        legend.SetLabelSize(19)
        legend.SetInline(False)
        legend.SetHorizontalAlignment(vtkChartLegend.RIGHT)
        legend.SetVerticalAlignment(vtkChartLegend.TOP)
        self.axis(vtkAxis.BOTTOM, "Run time (s)")
        self.axis(vtkAxis.LEFT, error_title)
        self.tables = []

    def axis(self, which, title):
        axis = self.chart.GetAxis(which)
        axis.SetTitle(title)
        axis.GetTitleProperties().SetFontSize(23)
        axis.GetTitleProperties().SetBold(False)
        axis.GetLabelProperties().SetFontSize(20)
        axis.GetGridPen().SetColor(225, 225, 225)

    def limits(self, which, values):
        axis = self.chart.GetAxis(which)
        low, high, ticks = around(values)
        axis.SetBehavior(vtkAxis.FIXED)
        axis.SetUnscaledMinimum(10.0 ** low)
        axis.SetUnscaledMaximum(10.0 ** high)
        axis.LogScaleOn()
        positions, labels = vtkDoubleArray(), vtkStringArray()
        for tick in ticks:
            positions.InsertNextValue(math.log10(tick))  # position on the logarithmic axis
            labels.InsertNextValue("%g%%" % (100.0 * tick) if which == vtkAxis.LEFT else "%g" % tick)
        axis.SetCustomTickPositions(positions, labels)

    def table(self, rows, label, error):
        table = vtkTable()
        for name in ("seconds", label):
            column = vtkFloatArray()
            column.SetName(name)
            table.AddColumn(column)
        for row in rows:
            table.GetColumn(0).InsertNextValue(row["seconds"])
            table.GetColumn(1).InsertNextValue(row[error])
        self.tables.append(table)  # keeps a reference, because the chart does not
        return table

    def line(self, rows, label, error, color, width, alpha=255):
        line = self.chart.AddPlot(vtkChart.LINE)
        line.SetInputData(self.table(rows, label, error), 0, 1)
        line.SetColor(*color, alpha)
        line.SetWidth(width)
        line.SetLabel(label)
        return line

    def points(self, rows, label, error, color, marker, size):
        points = self.chart.AddPlot(vtkChart.POINTS)
        points.SetInputData(self.table(rows, label, error), 0, 1)
        points.SetColor(*color, 255)
        points.SetMarkerStyle(marker)
        points.SetMarkerSize(size)
        points.SetWidth(2.0)
        points.SetLabel(label)
        return points

    def save(self, path):
        self.view.GetRenderWindow().Render()
        grab = vtkWindowToImageFilter()
        grab.SetInput(self.view.GetRenderWindow())
        grab.ReadFrontBufferOff()
        writer = vtkPNGWriter()
        writer.SetFileName(path)
        writer.SetInputConnection(grab.GetOutputPort())
        writer.Write()


def plot(rows, path, title, error="error_l2", error_title=None):
    """Writes a PNG, the recommended settings crossed. Rows that have no such error, or none at all (0), are not in it."""
    rows = [row for row in rows if error in row and row[error] > 0.0 and row["seconds"] > 0.0]
    if not rows:
        return
    quantities = {row["quantity"] for row in rows}
    chart = Plot(title, error_title or "Relative error%s (L2)" % (" of fluence" if quantities == {"fluence"} else ""))
    for quantity, (suffix, band) in QUANTITIES.items():
        of = [row for row in rows if row["quantity"] == quantity]
        if len(methods_of(of)) > 1 and len(front(of, error)) > 1:
            chart.line(front(of, error), "best of all" + suffix, error, band, 12.0)
    for name in methods_of(rows):
        of = [row for row in rows if row["method"] == name]
        color, marker = STYLES[name]
        if len(front(of, error)) > 1:
            chart.line(front(of, error), name, error, color, 2.5).LegendVisibilityOff()
        chart.points(of, name + QUANTITIES[of[0]["quantity"]][0], error, color, marker, 13.0)
    chosen = [row for row in rows if row.get("recommended")]
    if chosen and error == "error_l2":
        chart.points(chosen, "recommended", error, (220, 0, 0), vtkPlotPoints.CROSS, 26.0).SetWidth(3.0)
    chart.limits(vtkAxis.BOTTOM, [row["seconds"] for row in rows])
    chart.limits(vtkAxis.LEFT, [row[error] for row in rows])
    chart.save(path)


def print_table(rows, error="error_l2"):
    best = front([row for row in rows if not math.isnan(row[error])], error)
    width = max([38] + [len(row["setting"]) for row in rows])
    print("%-34s %-*s %-12s %9s %9s %9s %9s %6s" % ("method", width, "setting", "grid", "seconds", "MiB", "error", "estimate", "front"))
    for row in rows:
        print("%-34s %-*s %-12s %9.3g %9.3g %9.2e %9.2e %6s" % (
            row["method"], width, row["setting"], row["grid"], row["seconds"], row["peak_bytes"] / 2 ** 20, row[error],
            row["estimated_error"], "recommended" if row["recommended"] else "*" if (row["pareto"] if error == "error_l2" else row in best) else ""))


def load():
    """The plugin, and its proxies as functions of this module."""
    LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def parse():
    parser = argparse.ArgumentParser(description="Error against run time of all solvers on a scene.")
    parser.add_argument("medium", help=".vti or .vdb")
    parser.add_argument("--lights", help="lights as LightRig makes them, .vtp")
    parser.add_argument("--sun", type=float, nargs=5, metavar=("ELEVATION", "AZIMUTH", "R", "G", "B"), help="degrees, W/length^2")
    parser.add_argument("--point", type=float, nargs=6, action="append", default=[], metavar=("X", "Y", "Z", "R", "G", "B"), help="W")
    parser.add_argument("--sky", type=float, nargs=3, default=[0, 0, 0], help="W/(length^2 sr)")
    parser.add_argument("--environment", help=".exr or .hdr")
    parser.add_argument("--reference", help=".vti with fluence, fluence_direct or both; default: a converged run")
    parser.add_argument("--monte-carlo-reference", choices=["never", "always", "auto"], default="auto", help="a reference of photons that are scattered until they end, which shares no solver with the methods; auto: where it can beat them")
    parser.add_argument("--save-reference", metavar="FILE.vti", help="keep the converged run for the next time")
    parser.add_argument("--extinction", type=float, default=1.0, help="per density, 1/length, where the medium has no sigma_a")
    parser.add_argument("--albedo", type=float, nargs=3, default=[0.99] * 3, help="where the medium has no sigma_a")
    parser.add_argument("--methods", nargs="+", choices=list(SWITCHES), default=["light propagation maps", "constant source, not accelerated", "as published", "photons"])
    parser.add_argument("--directions", type=int, nargs="+", default=[4, 9, 25, 64, 100])
    parser.add_argument("--coarsenings", type=int, nargs="+", default=[1, 2, 4])
    parser.add_argument("--photons", type=int, nargs="+", default=[10000, 100000, 1000000])
    parser.add_argument("--more", nargs="+", default=[], metavar="PROPERTY=VALUE", help="further properties of SolverComparison, as Terms=[4,9] StepSizes=[0.5,2] Previews=1")
    parser.add_argument("--mesh", help=".ply or .stl of which the medium was voxelised")
    parser.add_argument("--accept", type=float, default=0.01, help="error of the recommended setting")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--budget", type=float, default=300.0, help="seconds")
    parser.add_argument("--output", default=".")
    return parser.parse_args()


# For each method, the name of the property of SolverComparison that switches it on.
SWITCHES = {
    "light propagation maps": "LightPropagationMaps",
    "constant source, not accelerated": "ConstantSource",
    "as published": "AsPublished",
    "as published, sequential": "AsPublishedSequential",
    "discrete ordinates": "DiscreteOrdinates",
    "lattice Boltzmann": "LatticeBoltzmann",
    "photons": "Photons",
    "adaptive photons": "AdaptivePhotons",
    "photons as published": "PublishedPhotons",
    "Monte Carlo": "MonteCarlo",
    "photons, then maps": "PhotonsThenMaps",
    "picture": "Pictures",
}


def make_recommended(comparison):
    """The last of the filters with the recommended setting, on the inputs of a SolverComparison that has run."""
    known = set(GetSources())
    comparison.InvokeCommand("MakeRecommended")
    return GetActiveSource() if set(GetSources()) - known else None


def compare(methods, save_reference=None, **settings):
    """Rows and facts of a comparison of these methods.

    save_reference: file, .vti, for the light that was compared with."""
    switches = {switch: int(name in methods) for name, switch in SWITCHES.items()}
    comparison = SolverComparison(**switches, **settings)
    comparison.UpdatePipeline()
    result = rows_of(OutputPort(comparison, 0))
    if save_reference and result[0]:
        SaveData(save_reference, proxy=OutputPort(comparison, 1))
    Delete(comparison)
    return result


def medium_of(arguments):
    image = VDBReader(FileName=arguments.medium) if arguments.medium.endswith(".vdb") else XMLImageDataReader(FileName=[arguments.medium])
    image.UpdatePipeline()
    if image.CellData.GetArray("sigma_a") or image.PointData.GetArray("sigma_a"):
        return image
    return ParticipatingMedium(Input=image, ExtinctionScale=arguments.extinction, Albedo=arguments.albedo)


def lights_of(arguments):
    if arguments.lights:
        return XMLPolyDataReader(FileName=[arguments.lights])
    if not arguments.sun and not arguments.point:
        return None
    sun = arguments.sun or [0] * 5
    return LightRig(Sun=int(bool(arguments.sun)), SunElevation=sun[0], SunAzimuth=sun[1], SunPower=sun[2:],
                    PointLights=sum(arguments.point, []))


def main():
    arguments = parse()
    load()
    os.makedirs(arguments.output, exist_ok=True)
    inputs = {
        "Lights": lights_of(arguments),
        "Environment": EnvironmentReader(FileName=arguments.environment) if arguments.environment else None,
        "Reference": XMLImageDataReader(FileName=[arguments.reference]) if arguments.reference else None,
        "Mesh": OpenDataFile(arguments.mesh) if arguments.mesh else None,
    }
    rows, facts = compare(arguments.methods, arguments.save_reference, Input=medium_of(arguments), SkyColor=arguments.sky, Directions=arguments.directions,
                          Coarsenings=arguments.coarsenings, PhotonCounts=arguments.photons, Repeats=arguments.repeats,
                          TimeBudget=arguments.budget, AcceptedError=arguments.accept, **{name: json.loads(value) for name, value in (more.split("=", 1) for more in arguments.more)}, MonteCarloReference=["never", "always", "auto"].index(arguments.monte_carlo_reference), **{name: proxy for name, proxy in inputs.items() if proxy})
    if not rows:
        raise SystemExit("Nothing was compared: " + "; ".join(facts["left_out"] or ["see the error above"]))
    name = os.path.splitext(os.path.basename(arguments.medium))[0]
    path = os.path.join(arguments.output, name)
    write_csv(rows, path + ".csv")
    write_json(rows, path + ".jsonl", case=name)
    plot(rows, path + ".png", "Error against run time: " + name)
    print_table(rows)
    print("reference: " + "; ".join(facts["reference"]))
    print_left_out(facts["left_out"])
    for line in advice(rows):
        print(line)
    for row in rows:
        if row["recommended"]:
            print("recommended for %s: %s" % (row["quantity"], row["filters"]))


if __name__ == "__main__":
    main()
