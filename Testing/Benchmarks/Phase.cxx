// Separable phase functions and discrete ordinates (Gong et al.): what N terms cost in light, and what they save in
// time.
//
//   TyndallBenchPhase [--quick] [rank] [speed] [degrees]
//
//   rank     N terms of the phase function: error of the matrix beside theory, of fluence beside the whole matrix'
//   speed    factorised against unfactorised: 64^3, 128 and 256 directions, 5 orders, grey (the paper: 1.5 against 0.2
//            pictures a second)
//   degrees  light propagation maps in angular moments of degree 1, 3, 5, 7, in nanoseconds an update beside isotropic

#include "Measure.h"
#include "Program.h"
#include "Report.h"

#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "PhaseFunction/SeparablePhaseFunction.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace bench;
using namespace tyndall;

namespace
{
/// A round cloud with random density in a box of side 1, the sun askew above it.
struct Cloud
{
  Medium medium;
  Illumination light;
  std::vector<float> sigma_a, sigma_s;

  Cloud(int edge, double tau, double albedo, double g)
  {
    this->medium.grid.size = { edge, edge, edge };
    this->medium.grid.spacing = { 1.0 / edge, 1.0 / edge, 1.0 / edge };
    std::mt19937 random(7);
    std::uniform_real_distribution<double> density(0.5, 1.5);
    for (int i = 0; i < edge * edge * edge; ++i)
    {
      const std::array<int, 3> at = this->medium.grid.VoxelAt(i);
      double away = 0.0;
      for (int a = 0; a < 3; ++a)
      {
        away += std::pow((at[a] + 0.5) / edge - 0.5, 2);
      }
      const double sigma_t = away < 0.2 ? tau * density(random) : 0.0;
      this->sigma_a.push_back(static_cast<float>(sigma_t * (1.0 - albedo)));
      this->sigma_s.push_back(static_cast<float>(sigma_t * albedo));
    }
    this->medium.sigma_a = { this->sigma_a.data() };
    this->medium.sigma_s = { this->sigma_s.data() };
    this->medium.phase = PhaseFunction::HenyeyGreenstein(g);
    tyndall::Light sun;
    sun.direction = { 0.4, 0.2, -1.0 };
    this->light.lights.push_back(sun);
  }
};

struct Timed
{
  double seconds = 0.0, coreSeconds = 0.0, bytes = 0.0;
  LightField light;
};

/// Several runs after one that compiles; a single one is counted at once: it is long.
Timed Measure(Device& device, const Cloud& cloud, const OrdinatesSettings& settings, int repetitions)
{
  std::vector<double> wall, core;
  Timed timed;
  device.ResetPeak();
  for (int i = repetitions > 1 ? -1 : 0; i < repetitions; ++i)
  {
    const double start = WallSeconds(), coreStart = CoreSeconds();
    timed.light = SolveDiscreteOrdinates(device, Domain(cloud.medium.grid), cloud.medium, cloud.light, settings);
    if (i >= 0)
    {
      wall.push_back(WallSeconds() - start);
      core.push_back(CoreSeconds() - coreStart);
    }
  }
  timed.seconds = Median(wall);
  timed.coreSeconds = Median(core);
  timed.bytes = static_cast<double>(device.PeakBytes());
  return timed;
}

double RelativeRms(const std::vector<float>& values, const std::vector<float>& reference)
{
  double squares = 0.0, all = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i)
  {
    squares += std::pow(static_cast<double>(values[i]) - reference[i], 2);
    all += std::pow(static_cast<double>(reference[i]), 2);
  }
  return std::sqrt(squares / all);
}

/// How much more fluence there is in all, relative: negative where the cloud is too dark.
double TooBright(const std::vector<float>& values, const std::vector<float>& reference)
{
  double sum = 0.0, all = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i)
  {
    sum += values[i];
    all += reference[i];
  }
  return sum / all - 1.0;
}

struct Way
{
  std::string name;
  OrdinatesScheme scheme;
  OrdinatesScattering scattering;
};

OrdinatesSettings SettingsOf(const Way& way, int directions, int terms, int orders)
{
  OrdinatesSettings settings;
  settings.scheme = way.scheme;
  settings.scattering = way.scattering;
  settings.spiralDirections = directions;
  settings.terms = terms;
  settings.maximumOrders = orders;
  return settings;
}

/// Relative Frobenius error of N terms of Henyey and Greenstein's matrix of point values.
double MatrixError(double g, int directions, int terms)
{
  SeparableSettings settings;
  settings.terms = terms;
  settings.factorisation = PhaseFactorisation::SingularValues;
  settings.repaired = false;
  return SeparablePhaseFunction(PhaseFunction::HenyeyGreenstein(g), SpiralDirections(directions), settings)
    .ErrorsByTerms()
    .back()
    .frobenius;
}

void PrintRank(Device& device, bool quick)
{
  const int edge = quick ? 8 : 32, directions = quick ? 64 : 256, orders = quick ? 4 : 40;
  Table table({ "g", "terms of", "N", "matrix", "theory", "fluence", "too bright", "s" });
  for (double g : { 0.5, 0.85 })
  {
    const Cloud cloud(edge, 8.0, 0.99, g);
    for (OrdinatesScheme scheme : { OrdinatesScheme::Conservative, OrdinatesScheme::Published })
    {
      const bool published = scheme == OrdinatesScheme::Published;
      const std::string suffix = published ? ", as published" : "";
      const Timed whole =
        Measure(device, cloud, SettingsOf({ "", scheme, OrdinatesScattering::Matrix }, directions, 25, orders), 1);
      for (OrdinatesScattering how : { OrdinatesScattering::SingularValues, OrdinatesScattering::SphericalHarmonics })
      {
        const bool harmonics = how == OrdinatesScattering::SphericalHarmonics;
        if (published && harmonics)
        {
          continue;
        }
        const std::string name = (harmonics ? "spherical harmonics" : "singular values") + suffix;
        for (int terms : { 4, 9, 16, 24, 25, 49 })
        {
          const Timed run =
            Measure(device, cloud, SettingsOf({ name, scheme, how }, directions, terms, orders), quick ? 1 : 3);
          const double matrix = MatrixError(g, directions, terms);
          const double theory = TheoreticalError(PhaseFunction::HenyeyGreenstein(g).Moments(300), terms);
          const double error = RelativeRms(run.light.fluence, whole.light.fluence);
          const double bright = TooBright(run.light.fluence, whole.light.fluence);
          JsonLine()
            .Add("bench", "phase")
            .Add("case", "rank, g " + Text("%g", g) + ", N " + std::to_string(terms))
            .Add("method", name)
            .Add("grid", GridText(edge))
            .Add("seconds", run.seconds)
            .Add("peak_bytes", run.bytes)
            .Add("error_l2", error)
            .Add("too_bright", bright)
            .Add("matrix_error", matrix)
            .Add("theory", theory)
            .Add("balance", run.light.balance.RelativeError(1))
            .Add("ratio", whole.seconds / run.seconds)
            .Add("against", "the whole matrix" + suffix)
            .Print();
          table.Add({ Text("%g", g), name, std::to_string(terms), Text("%.4f", matrix), Text("%.4f", theory),
            Text("%.5f", error), Text("%+.5f", bright), Text("%.3f", run.seconds) });
        }
      }
    }
  }
  table.Print("Relative error of N terms: of the matrix, in theory, of fluence against the whole matrix (" +
    std::to_string(directions) + " directions, " + GridText(edge) + ")");
}

void PrintSpeed(Device& device, bool quick)
{
  const int edge = quick ? 12 : 64, orders = 5;
  const std::vector<Way> ways = {
    { "unfactorised, a pass a direction (as published)", OrdinatesScheme::Published, OrdinatesScattering::Matrix },
    { "24 singular values (as published)", OrdinatesScheme::Published, OrdinatesScattering::SingularValues },
    { "unfactorised, in blocks", OrdinatesScheme::Conservative, OrdinatesScattering::Matrix },
    { "24 singular values", OrdinatesScheme::Conservative, OrdinatesScattering::SingularValues },
    { "25 spherical harmonics", OrdinatesScheme::Conservative, OrdinatesScattering::SphericalHarmonics },
  };
  Table table({ "directions", "method", "s", "ns an update", "solves a second", "unfactorised/this" });
  const Cloud cloud(edge, 8.0, 0.9, 0.5);
  for (int directions : { 128, 256 })
  {
    double unfactorised[2] = {}; // by scheme
    for (const Way& way : ways)
    {
      const bool matrix = way.scattering == OrdinatesScattering::Matrix;
      const int terms = way.scattering == OrdinatesScattering::SphericalHarmonics ? 25 : 24;
      const Timed run = Measure(device, cloud, SettingsOf(way, directions, terms, orders), quick || matrix ? 1 : 5);
      double& against = unfactorised[static_cast<int>(way.scheme)];
      against = matrix ? run.seconds : against;
      const double updates = static_cast<double>(edge) * edge * edge * directions * orders;
      JsonLine line;
      line.Add("bench", "phase")
        .Add("case", "speed, " + std::to_string(directions) + " directions")
        .Add("method", way.name)
        .Add("grid", GridText(edge))
        .Add("seconds", run.seconds)
        .Add("core_seconds", run.coreSeconds)
        .Add("peak_bytes", run.bytes)
        .Add("ns_per_update", 1e9 * run.seconds / updates)
        .Add("solves_per_second", 1.0 / run.seconds)
        .Add("iterations", static_cast<double>(run.light.convergence.size()));
      if (!matrix)
      {
        line.Add("ratio", against / run.seconds).Add("against", "unfactorised, same scheme");
        line.Add("ratio_published", unfactorised[0] / run.seconds);
      }
      line.Print();
      table.Add(
        { std::to_string(directions), way.name, Text("%.3f", run.seconds), Text("%.2f", 1e9 * run.seconds / updates),
          Text("%.2f", 1.0 / run.seconds), Text("%.1f", against / run.seconds) });
    }
  }
  table.Print("Factorised against unfactorised, " + GridText(edge) +
    ", 5 orders, grey; the paper: 1.5 against 0.2 pictures a second, ratio 7.5");
}

/// The medians of several solves of each degree in turn, so that a machine that changes its speed changes all of them.
/// Core seconds count: they are what a sweep works, whoever else uses the machine.
std::vector<Timed> MeasureDegrees(Device& device, const Cloud& cloud, const PropagationSettings& usual,
  const std::vector<int>& degrees, int repetitions)
{
  std::vector<std::vector<double>> wall(degrees.size()), core(degrees.size());
  std::vector<Timed> timed(degrees.size());
  for (int i = -1; i < repetitions; ++i) // the first compiles
  {
    for (std::size_t k = 0; k < degrees.size(); ++k)
    {
      PropagationSettings settings = usual;
      settings.angularDegree = degrees[k];
      device.ResetPeak();
      const double start = WallSeconds(), coreStart = CoreSeconds();
      timed[k].light = SolveConservative(device, cloud.medium, cloud.light, settings);
      if (i >= 0)
      {
        wall[k].push_back(WallSeconds() - start);
        core[k].push_back(CoreSeconds() - coreStart);
      }
      timed[k].bytes = static_cast<double>(device.PeakBytes());
    }
  }
  for (std::size_t k = 0; k < degrees.size(); ++k)
  {
    timed[k].seconds = Median(wall[k]);
    timed[k].coreSeconds = Median(core[k]);
  }
  return timed;
}

/// What light propagation maps cost with angular moments.
void PrintDegrees(Device& device, bool quick)
{
  const int orders = 5;
  Table table({ "grid", "directions", "degree", "s", "ns an update", "of isotropic", "asked" });
  const std::vector<std::array<int, 2>> scenes = quick
    ? std::vector<std::array<int, 2>>{ { 12, 25 } }
    : std::vector<std::array<int, 2>>{ { 64, 25 }, { 64, 64 }, { 128, 25 } };
  const std::vector<int> degrees = { 0, 1, 3, 5, 7 };
  const std::vector<double> asked = { 1.0, 1.5, 3.0, 5.0, 8.0 };
  for (const auto& [edge, perFace] : scenes)
  {
    const Cloud cloud(edge, 0.25 * edge, 0.9, 0.85); // degrees are lower in voxels thicker than a mean free path
    PropagationSettings settings;
    settings.directionsPerFace = perFace;
    settings.maximumOrders = orders;
    settings.storeMoments = false;
    const std::vector<Timed> runs = MeasureDegrees(device, cloud, settings, degrees, quick ? 1 : 5);
    const double updates = static_cast<double>(edge) * edge * edge * perFace * 6.0 * orders;
    for (std::size_t k = 0; k < degrees.size(); ++k)
    {
      const Timed& run = runs[k];
      const double ratio = run.coreSeconds / runs[0].coreSeconds;
      const std::string name = degrees[k] == 0 ? "isotropic" : "degree " + std::to_string(degrees[k]);
      JsonLine()
        .Add("bench", "phase")
        .Add("case", "degrees, " + std::to_string(6 * perFace) + " directions")
        .Add("method", "light propagation maps, " + name)
        .Add("grid", GridText(edge))
        .Add("seconds", run.seconds)
        .Add("core_seconds", run.coreSeconds)
        .Add("peak_bytes", run.bytes)
        .Add("ns_per_update", 1e9 * run.seconds / updates)
        .Add("iterations", static_cast<double>(run.light.convergence.size()))
        .Add("ratio", ratio)
        .Add("against", "isotropic")
        .Print();
      table.Add({ GridText(edge), std::to_string(6 * perFace), name, Text("%.3f", run.seconds),
        Text("%.2f", 1e9 * run.seconds / updates), Text("%.2f", ratio), Text("%g", asked[k]) });
    }
  }
  table.Print(
    "Light propagation maps in angular moments beside isotropic, 5 orders, lamps' light and all; ratios of core "
    "seconds");
}
}

int main(int argc, char* argv[])
{
  return RunOnDevice(argc, argv, [](Device& device, const Arguments& arguments) {
    if (arguments.Asks("speed"))
    {
      PrintSpeed(device, arguments.quick);
    }
    if (arguments.Asks("degrees"))
    {
      PrintDegrees(device, arguments.quick);
    }
    if (arguments.Asks("rank"))
    {
      PrintRank(device, arguments.quick);
    }
  });
}
