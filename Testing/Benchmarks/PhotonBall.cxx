// A ball of glass that scatters, in fog, under a sun: photons that bend all the way, and solvers that scatter straight.

#include "PhotonRuns.h"
#include "PhotonTables.h"

#include "../Kernels/PhotonScene.h"

#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace bench
{
using namespace tyndall;

namespace
{
constexpr double Radius = 0.5; ///< of a box from -1 to 1

/// Parts of the box: the ball without its border, what lies in its shadow, where its light is gathered, and the rest.
enum Region
{
  Inside,
  Behind,
  Elsewhere,
  Border,
  Regions
};

Region RegionOf(const Grid& grid, std::size_t voxel)
{
  std::array<double, 3> x;
  std::size_t rest = voxel;
  for (int a = 0; a < 3; ++a)
  {
    x[a] = grid.origin[a] + (rest % grid.size[a] + 0.5) * grid.spacing[a];
    rest /= static_cast<std::size_t>(grid.size[a]);
  }
  const double r = std::hypot(x[0], x[1], x[2]), margin = 3.0 * grid.spacing[0];
  if (r < Radius + margin)
  {
    return r < Radius - margin ? Inside : Border;
  }
  return x[2] < 0.0 && std::hypot(x[0], x[1]) < Radius ? Behind : Elsewhere;
}

PhotonScene ScatteringBall(int edge, double index, double tau, double g)
{
  PhotonScene scene(edge, 1.0);
  scene.SetBall(Radius, index, 1.0);
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    std::size_t rest = i;
    double square = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      const double x =
        scene.medium.grid.origin[a] + (rest % scene.medium.grid.size[a] + 0.5) * scene.medium.grid.spacing[a];
      square += x * x;
      rest /= static_cast<std::size_t>(scene.medium.grid.size[a]);
    }
    const double sigma = square < Radius * Radius ? 0.5 * tau / Radius : 0.2;
    scene.sigma_s[i] = static_cast<float>(0.95 * sigma);
    scene.sigma_a[i] = static_cast<float>(0.05 * sigma);
  }
  return scene;
}

/// Root of the sum of squared differences over that of the reference, and the ratio of sums, of a region.
struct Agreement
{
  double error = 0.0, ratio = 0.0;
};

Agreement Compare(
  const Grid& grid, const std::vector<float>& values, const std::vector<float>& reference, Region region)
{
  double difference = 0.0, square = 0.0, sum = 0.0, expected = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    if (RegionOf(grid, i) == region)
    {
      difference += std::pow(static_cast<double>(values[i]) - reference[i], 2);
      square += std::pow(static_cast<double>(reference[i]), 2);
      sum += values[i];
      expected += reference[i];
    }
  }
  return { std::sqrt(difference / square), sum / expected };
}

void CompareOne(const PhotonBench& bench, Table& table, double index, double tau, double g)
{
  const int edge = bench.quick ? 16 : 40;
  PhotonScene scene = ScatteringBall(edge, index, tau, g);
  const Medium& medium = scene.Medium();
  const Grid& grid = medium.grid;
  Illumination sun;
  sun.lights.emplace_back();
  sun.lights.back().direction = { 0.0, 0.0, -1.0 };
  sun.lights.back().power = { 1.0, 1.0, 1.0 };
  EmissionSettings emission;
  emission.photonCount = bench.quick ? 20000 : 2000000;
  const std::vector<Photon> photons = EmitPhotons(grid, sun, emission).photons;
  MarchSettings march;
  const PhotonLight uncollided =
    PhotonMarcher(bench.device, Domain(medium.grid), medium, scene.Index(), march).March(photons);
  march.maximumOrders = 0;
  march.errorBatches = 8;
  const PhotonLight reference =
    PhotonMarcher(bench.device, Domain(medium.grid), medium, scene.Index(), march).March(photons);
  Illumination given;
  given.uncollided.fluence = { uncollided.light.fluence.data(), uncollided.light.channels };
  given.uncollided.meanDirection = { uncollided.meanDirection.data(), 3 };
  given.uncollided.escaped = uncollided.light.facePowerOut;
  const std::pair<const char*, std::function<LightField()>> methods[] = {
    { "uncollided light alone", [&] { return uncollided.light; } },
    { "maps, photons' light handed on",
      [&] { return SolveConservative(bench.device, medium, given, PropagationSettings()); } },
    { "ordinates, photons' light handed on",
      [&] { return SolveDiscreteOrdinates(bench.device, Domain(medium.grid), medium, given, OrdinatesSettings()); } },
    { "lattice, photons' light handed on",
      [&] {
        return SolveLatticeBoltzmann(
          bench.device, Domain(medium.grid), medium, scene.Index(), given, LatticeSettings());
      } },
    { "maps, straight light of their own",
      [&] { return SolveConservative(bench.device, medium, sun, PropagationSettings()); } },
  };
  const std::string scenes = Text("n %g", index) + Text(", thickness %g", tau) + Text(", g %g", g);
  std::vector<float> noisy = reference.light.fluence;
  std::transform(noisy.begin(), noisy.end(), reference.light.fluenceError.begin(), noisy.begin(),
    [](float fluence, float error) { return fluence + error; });
  std::vector<std::string> own = { scenes, "standard error of the reference" };
  for (int region = Inside; region <= Elsewhere; ++region)
  {
    own.push_back(Text("%.3f", Compare(grid, noisy, reference.light.fluence, static_cast<Region>(region)).error));
  }
  own.push_back(Text("%.2f", reference.seconds));
  table.Add(own);
  for (const auto& [name, solve] : methods)
  {
    const double start = bench.device.Now();
    const LightField light = solve();
    const double seconds = bench.device.Now() - start;
    std::vector<std::string> row = { scenes, name };
    JsonLine line = PhotonLine("scattering ball", name, grid);
    line.Add("scene", scenes).Add("seconds", seconds).Add("reference_seconds", reference.seconds);
    const char* const names[] = { "inside", "behind", "elsewhere" };
    for (int region = Inside; region <= Elsewhere; ++region)
    {
      const Agreement found = Compare(grid, light.fluence, reference.light.fluence, static_cast<Region>(region));
      const std::string error = std::string("error_") + names[region], ratio = std::string("ratio_") + names[region];
      line.Add(error.c_str(), found.error).Add(ratio.c_str(), found.ratio);
      row.push_back(Text("%.3f", found.error) + Text(" (%.3f)", found.ratio));
    }
    line.Print();
    row.push_back(Text("%.2f", seconds));
    table.Add(row);
  }
}
}

void ScatterInABall(const PhotonBench& bench)
{
  Table table({ "ball", "", "inside", "behind", "elsewhere", "s" });
  for (const double index : { 1.0, 1.2, 1.5 })
  {
    for (const double tau : { 1.0, 5.0 })
    {
      CompareOne(bench, table, index, tau, 0.0);
    }
  }
  CompareOne(bench, table, 1.5, 5.0, 0.8);
  table.Print("Scattering ball of glass in fog, under a sun: error of fluence (and its sum) over that of photons that "
              "bend and scatter till they end");
}
}
