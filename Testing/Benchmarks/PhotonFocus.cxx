#include "PhotonRuns.h"
#include "PhotonTables.h"

#include "../Kernels/Caustic.h"

namespace bench
{
using namespace tyndall;
using namespace caustic;

namespace
{
constexpr double Reach = 0.2; ///< of the paraxial beam

struct NamedAxis
{
  const char* name;
  Axis axis;
};

struct Foci
{
  double paths = 0.0, waist = 0.0, brightest = 0.0;
};

/// The paraxial focus from paths and from fluence, less what aberration takes of a beam as wide as `Reach`.
Foci FindFoci(const PhotonBench& bench, PhotonMarcher& marcher, const Grid& grid, const Axis& axis)
{
  const std::size_t count = bench.quick ? 50000 : 1000000;
  const std::vector<float> fluence = marcher.March(Beam(grid, axis, count, Reach)).light.fluence;
  return { ParaxialFocus(marcher, axis), Waist(grid, axis, fluence) + Focus - ExpectedWaist(Reach),
    BrightStretch(grid, axis, fluence) };
}

void AddFoci(
  const PhotonBench& bench, Table& table, PhotonScene& scene, const NamedAxis& along, int filterSize, int samples)
{
  scene.settings.meanDirection = false;
  PhotonMarcher marcher = scene.Marcher(bench.device);
  const Grid& grid = scene.medium.grid;
  const double voxel = grid.spacing[0] / Radius;
  const Foci foci = FindFoci(bench, marcher, grid, along.axis);
  const double expected = optics::SmoothedBallFocus(caustic::Index, filterSize / 6.0 * voxel);
  PhotonLine("focus", along.name, grid)
    .Add("samples", samples)
    .Add("border_voxels", filterSize / 6.0)
    .Add("border_radii", filterSize / 6.0 * voxel)
    .Add("focus_expected", expected)
    .Add("focus_paths", foci.paths)
    .Add("focus_waist", foci.waist)
    .Add("focus_brightest", foci.brightest)
    .Add("error_paths", foci.paths - Focus)
    .Add("error_waist", foci.waist - Focus)
    .Print();
  table.Add({ std::to_string(grid.size[0]) + "^3", along.name, std::to_string(samples), Text("%.2f", filterSize / 6.0),
    Text("%.4f", filterSize / 6.0 * voxel), Text("%.4f", expected), Text("%.4f", foci.paths),
    Text("%+.1f %%", 100.0 * (foci.paths - Focus)), Text("%.4f", foci.waist),
    Text("%+.1f %%", 100.0 * (foci.waist - Focus)), Text("%.4f", foci.brightest) });
}

void CompareFoci(const PhotonBench& bench)
{
  const NamedAxis axes[] = { { "askew", Askew() }, { "along z", AxisAlong(0.0, 0.0, 1.0) } };
  const std::vector<int> edges = bench.quick ? std::vector<int>{ 32 } : std::vector<int>{ 64, 128, 256 };
  Table table({ "grid", "light", "samples", "border, voxels", "border, R", "smoothed ball", "from paths", "off by, R",
    "from waist", "off by, R", "brightest" });
  for (const int samples : bench.quick ? std::vector<int>{ 4 } : std::vector<int>{ 4, 16 })
  {
    for (const int edge : edges)
    {
      PhotonScene scene = BallScene(bench.device, edge, 9, samples);
      for (const NamedAxis& along : axes)
      {
        AddFoci(bench, table, scene, along, 9, samples);
      }
    }
  }
  for (const int filterSize : bench.quick ? std::vector<int>{ 3 } : std::vector<int>{ 33, 17, 5, 3, 1 })
  {
    PhotonScene scene = BallScene(bench.device, edges.back(), filterSize);
    AddFoci(bench, table, scene, axes[0], filterSize, 4);
  }
  table.Print("Ball of glass, n = 1.5, parallel light: distance of the paraxial focus from the centre in radii; the "
              "ball lens has 1.5.\n"
              "From paths: rays at 0.15 and 0.3 R, aberration extrapolated away; from the waist of a beam of 0.2 R in "
              "fluence, less\n"
              "its aberration of " +
    Text("%.4f", Focus - ExpectedWaist(Reach)) +
    "; the middle of the stretch of that beam's axis that is brighter than half");
}

void CompareProfiles(const PhotonBench& bench)
{
  const Axis axis = AxisAlong(0.0, 0.0, 1.0);
  const std::vector<int> edges = bench.quick ? std::vector<int>{ 32 } : std::vector<int>{ 64, 128, 256 };
  const std::size_t rich = bench.quick ? 100000 : 4000000;
  const std::vector<std::size_t> counts =
    bench.quick ? std::vector<std::size_t>{ 1000 } : std::vector<std::size_t>{ 4000, 16000, 64000, 256000 };
  std::vector<std::string> headings = { "grid", "" };
  for (const std::size_t count : counts)
  {
    headings.push_back(std::to_string(count));
  }
  headings.push_back("from geometrical optics");
  Table table(headings);
  for (const int edge : edges)
  {
    PhotonScene scene = BallScene(bench.device, edge);
    scene.settings.meanDirection = false;
    PhotonMarcher marcher = scene.Marcher(bench.device);
    const Grid& grid = scene.medium.grid;
    const auto profile = [&](std::size_t count, std::uint64_t seed) {
      const std::vector<Photon> photons = Beam(grid, axis, count, 2.0, Sampler::Hammersley, seed);
      return Profile(grid, axis, marcher.March(photons).light.fluence);
    };
    const std::vector<double> reference = profile(rich, 0);
    std::vector<std::string> row = { std::to_string(edge) + "^3", "" };
    const auto add = [&](std::size_t count, const char* against, double error) {
      PhotonLine("profile", "conservative", grid)
        .Add("photons", static_cast<double>(count))
        .Add("error_l1", error)
        .Add("against", against)
        .Print();
      row.push_back(Text("%.4f", error));
    };
    for (const std::size_t count : counts)
    {
      add(count, "rich run", Difference(profile(count, 1), reference));
    }
    add(rich, "geometrical optics", Difference(reference, ExpectedProfile()));
    table.Add(row);
  }
  table.Print("Brightness in the plane through the focus, rings of R / 8: part of the light that is elsewhere, by "
              "photons on the\n"
              "grid's face against " +
    std::to_string(rich) + " of them, and of these against geometrical optics at a sharp border");
}
}

void FocusLight(const PhotonBench& bench)
{
  CompareFoci(bench);
  CompareProfiles(bench);
}
}
