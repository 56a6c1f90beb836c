// Plane-parallel slabs, periodic across: light reflected and transmitted against reference values, as voxels and
// directions become more. How to read it: with more cells the answer for a set of directions converges ("order", from
// three grids); what is left then is the directions' error ("limit": Richardson's extrapolation, less the reference).
//
//   TyndallBenchSlab [--quick] [order] [forward]
//
//   order    what is said above, isotropic scattering
//   forward  g from -0.5 to 0.99, in angular moments and by similarity, beside other people's programs (ForwardSlabs.h)

#include "ForwardSlabs.h"
#include "Measure.h"
#include "Program.h"
#include "Report.h"

#include "../Kernels/RandomMedium.h"

#include "Device/Device.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Published/SequentialPropagation.h"
#include "Reference/SlabReference.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>

using namespace bench;
using namespace tyndall;

namespace
{
constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();

struct Method
{
  std::string name;
  /// Only diffuse light, and few directions: it takes a thousand orders to get round, and shows its point.
  bool asPublished;
  std::function<LightField(const Medium&, const Illumination&, const PropagationSettings&)> solve;
};

struct Row
{
  int cells = 0;
  double reflected = 0.0, transmitted = 0.0; ///< over what came in
  double seconds = 0.0;
  int orders = 0;
  double balance = 0.0;
};

struct Series
{
  SlabReference slab;
  bool beam = false;
  int perFace = 0;
  std::string method;
  std::vector<Row> rows;

  double Reflected() const { return this->beam ? this->slab.beamR : this->slab.diffuseR; }
  double Transmitted() const { return this->beam ? this->slab.beamT : this->slab.diffuseT; }
  std::string Name() const
  {
    char text[100];
    std::snprintf(
      text, sizeof(text), "tau %g, albedo %g, %s", this->slab.tau, this->slab.albedo, this->beam ? "beam" : "diffuse");
    return text;
  }
};

Row Solve(const Method& method, const Series& series, int cells)
{
  const double sigma_t = series.slab.tau / cells;
  const EvenMedium slab(Grid{ { 1, 1, cells } }, static_cast<float>(sigma_t * (1.0 - series.slab.albedo)),
    static_cast<float>(sigma_t * series.slab.albedo));
  PropagationSettings settings;
  settings.periodic = { true, true, false };
  settings.tolerance = 1e-6;
  settings.directionsPerFace = series.perFace;
  Illumination light;
  if (series.beam)
  {
    Light sun;
    sun.direction = { 0.0, 0.0, 1.0 };
    light.lights = { sun };
  }
  else
  {
    light.faces[4] = { 1.0, 1.0, 1.0 };
  }
  const double start = WallSeconds();
  const LightField field = method.solve(slab.medium, light, settings);
  const double in = field.balance.entered[0];
  return { cells, field.facePowerOut[4][0] / in, field.facePowerOut[5][0] / in, WallSeconds() - start,
    static_cast<int>(field.convergence.size()), field.balance.RelativeError(field.channels) };
}

/// The last of three grids, each twice as fine as the one before.
struct Richardson
{
  double order = Unknown;
  double limit = Unknown;
};

Richardson Extrapolate(const std::vector<Row>& rows, std::size_t last, double Row::*quantity)
{
  if (last < 2)
  {
    return {};
  }
  const double coarse = rows[last - 2].*quantity;
  const double middle = rows[last - 1].*quantity;
  const double fine = rows[last].*quantity;
  const double ratio = (coarse - middle) / (middle - fine);
  const bool rounding = std::abs(middle - fine) < 1e-5; // and what the tolerance leaves
  return !(ratio > 1.0) || rounding ? Richardson{}
                                    : Richardson{ std::log2(ratio), fine + (fine - middle) / (ratio - 1.0) };
}

void Print(const Series& series, std::size_t i)
{
  const Row& row = series.rows[i];
  const Richardson reflected = Extrapolate(series.rows, i, &Row::reflected);
  const Richardson transmitted = Extrapolate(series.rows, i, &Row::transmitted);
  JsonLine()
    .Add("bench", "slab")
    .Add("case", series.Name())
    .Add("method", series.method)
    .Add("grid", "1x1x" + std::to_string(row.cells))
    .Add("directions_per_face", series.perFace)
    .Add("seconds", row.seconds)
    .Add("iterations", row.orders)
    .Add("balance", row.balance)
    .Add("reflectance", row.reflected)
    .Add("transmittance", row.transmitted)
    .Add("error_reflectance", row.reflected - series.Reflected())
    .Add("error_transmittance", row.transmitted - series.Transmitted())
    .Add("order_reflectance", reflected.order)
    .Add("order_transmittance", transmitted.order)
    .Add("limit_error_reflectance", reflected.limit - series.Reflected())
    .Add("limit_error_transmittance", transmitted.limit - series.Transmitted())
    .Print();
}

/// Errors by number of cells, and what they tend to.
void AddTo(Table& table, const Series& series)
{
  const std::size_t last = series.rows.size() - 1;
  const auto cells = [&](double Row::*quantity, double reference, const char* name) {
    std::vector<std::string> row = { series.Name(), series.method, std::to_string(series.perFace), name };
    for (const Row& result : series.rows)
    {
      row.push_back(Text("%+.1e", result.*quantity - reference));
    }
    const Richardson richardson = Extrapolate(series.rows, last, quantity);
    row.push_back(Text("%.2f", richardson.order));
    row.push_back(Text("%+.1e", richardson.limit - reference));
    row.push_back(std::to_string(series.rows[last].orders));
    row.push_back(Text("%.4f", series.rows[last].seconds));
    table.Add(row);
  };
  cells(&Row::reflected, series.Reflected(), "R");
  cells(&Row::transmitted, series.Transmitted(), "T");
}

Series Refine(const Method& method, Series series, const std::vector<int>& grids)
{
  for (const int cells : grids)
  {
    series.rows.push_back(Solve(method, series, cells));
    Print(series, series.rows.size() - 1);
  }
  return series;
}

std::vector<SlabReference> Slabs(bool quick)
{
  if (quick)
  {
    return { SlabOf(1.0, 0.9) };
  }
  return { SlabOf(0.1, 0.5), SlabOf(1.0, 0.5), SlabOf(1.0, 0.9), SlabOf(1.0, 0.999), SlabOf(5.0, 0.99),
    SlabOf(1.0, 1.0), SlabOf(10.0, 0.9) };
}

void RunAll(Device& device, bool quick)
{
  const std::vector<Method> methods = {
    { "in the cosine alone", false,
      [&](const Medium& medium, const Illumination& light, const PropagationSettings& settings) {
        return SolveConservative(device, medium, light, settings);
      } },
    { "along rays", false,
      [&](const Medium& medium, const Illumination& light, PropagationSettings settings) {
        settings.angularDegree = 0; // of isotropic scattering the same, but solved in three dimensions
        return SolveConservative(device, medium, light, settings);
      } },
    { "sequential as published", true,
      [](const Medium& medium, const Illumination& light, const PropagationSettings& settings) {
        return SolveSequential(medium, light, settings);
      } },
  };
  const std::vector<int> grids = quick ? std::vector<int>{ 8, 16, 32 } : std::vector<int>{ 8, 16, 32, 64 };
  std::vector<std::string> headings = { "slab", "method", "directions", "" };
  for (const int cells : grids)
  {
    headings.push_back(std::to_string(cells) + " cells");
  }
  headings.insert(headings.end(), { "order", "limit", "orders", "seconds" });
  Table table(headings);
  for (const SlabReference& slab : Slabs(quick))
  {
    for (const bool beam : { false, true })
    {
      for (const Method& method : methods)
      {
        for (const int perFace : quick ? std::vector<int>{ 25 } : std::vector<int>{ 25, 49, 100 })
        {
          if (method.asPublished && (beam || perFace > 25 || slab.tau < 1.0))
          {
            continue;
          }
          AddTo(table, Refine(method, { slab, beam, perFace, method.name, {} }, grids));
        }
      }
    }
  }
  table.Print(
    "Slabs of 1x1xN cells: error of reflectance (R) and transmittance (T), their order in the cells' size, the error\n"
    "they tend to, scattering orders to a tolerance of 1e-6 and seconds of the finest grid");
}
}

int main(int argc, char* argv[])
{
  return RunOnDevice(argc, argv, [](Device& device, const Arguments& arguments) {
    if (arguments.Asks("order"))
    {
      RunAll(device, arguments.quick);
    }
    if (arguments.Asks("forward"))
    {
      PrintForwardSlabs(device, arguments.quick);
    }
  });
}
