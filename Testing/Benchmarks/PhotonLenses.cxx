#include "PhotonRuns.h"
#include "PhotonTables.h"

#include "../Kernels/PhotonScene.h"
#include "../Kernels/Prism.h"

namespace bench
{
using namespace tyndall;

namespace
{
using Point = std::array<double, 3>;

/// Corners up to that which is first nearest to a point.
std::size_t CornersTo(const PhotonPath& path, const Point& target)
{
  const auto distance = [&](std::size_t i) {
    const Point& p = path.points[i];
    return std::hypot(p[0] - target[0], p[1] - target[1], p[2] - target[2]);
  };
  std::size_t i = 1;
  while (i + 1 < path.points.size() && (distance(i) > 1.0 || distance(i + 1) < distance(i)))
  {
    ++i;
  }
  return i + 1;
}

/// The largest distance from the exact path, and the path's corners.
struct Followed
{
  double error = 0.0;
  std::size_t corners = 0;
};

Followed FollowLuneburg(Device& device, PhotonScene& scene)
{
  Followed worst;
  for (const double b : { 0.3, 0.5, 0.7 })
  {
    const PhotonPath path = scene.Path(device, { -std::sqrt(1.0 - b * b), b, 0.0 }, { 1.0, 0.0, 0.0 });
    worst.error = std::max(worst.error, luneburg::WorstCorner(path, b));
    worst.corners = std::max(worst.corners, path.points.size());
  }
  return worst;
}

Followed FollowFishEye(Device& device, PhotonScene& scene)
{
  const double angle = 110.0 / 180.0 * optics::Pi;
  const PhotonPath path = scene.Path(device, { 1.0, 0.0, 0.0 }, { std::cos(angle), std::sin(angle), 0.0 });
  const std::size_t corners = CornersTo(path, { -1.0, 0.0, 0.0 });
  return { fisheye::WorstCorner(path, std::cos(angle) / std::sin(angle), corners), corners };
}

/// Errors by step and order of the integrator; in brackets the order that one sees, from the row before.
void Refine(const PhotonBench& bench, const char* name, const char* title, PhotonScene& scene,
  Followed (*follow)(Device&, PhotonScene&))
{
  Table table({ "step, voxels", "corners", "order 1", "order 2", "order 4" });
  const std::vector<double> steps =
    bench.quick ? std::vector<double>{ 4.0, 2.0 } : std::vector<double>{ 16.0, 8.0, 4.0, 2.0, 1.0, 0.5 };
  std::array<double, 3> before = {};
  for (std::size_t s = 0; s < steps.size(); ++s)
  {
    std::vector<std::string> row = { Text("%g", steps[s]), "" };
    for (int o = 0; o < 3; ++o)
    {
      scene.settings.order = 1 << o;
      scene.settings.stepSize = steps[s];
      const Followed followed = follow(bench.device, scene);
      const double seen = s > 0 ? ObservedOrder(before[o], followed.error, steps[s - 1] / steps[s]) : std::nan("");
      before[o] = followed.error;
      row[1] = std::to_string(followed.corners);
      row.push_back(Text("%.1e", followed.error) + (s > 0 ? Text(" (%.1f)", seen) : ""));
      PhotonLine(name, "order " + std::to_string(1 << o), scene.medium.grid)
        .Add("step", steps[s])
        .Add("iterations", static_cast<double>(followed.corners))
        .Add("error_max", followed.error)
        .Add("order", seen)
        .Print();
    }
    table.Add(row);
  }
  table.Print(title);
}

void RefineLensInAir(const PhotonBench& bench)
{
  const std::vector<double> steps =
    bench.quick ? std::vector<double>{ 2.0 } : std::vector<double>{ 2.0, 1.0, 0.5, 0.25 };
  std::vector<std::string> headings = { "grid", "order" };
  for (const double step : steps)
  {
    headings.push_back(Text("%g voxels", step));
  }
  Table table(headings);
  for (const int edge : bench.quick ? std::vector<int>{ 32 } : std::vector<int>{ 64, 128, 256 })
  {
    PhotonScene scene(edge, 1.1);
    scene.SetIndex(luneburg::Index);
    for (const int order : { 2, 4 })
    {
      std::vector<std::string> row = { std::to_string(edge) + "^3", std::to_string(order) };
      for (const double step : steps)
      {
        scene.settings.order = order;
        scene.settings.stepSize = step;
        const double error = luneburg::MissInAir(bench.device, scene);
        PhotonLine("luneburg in air", "order " + std::to_string(order), scene.medium.grid)
          .Add("step", step)
          .Add("error_max", error)
          .Print();
        row.push_back(Text("%.1e", error));
      }
      table.Add(row);
    }
  }
  table.Print(
    "Luneburg lens in air: largest distance from the far pole. What finer steps leave is the grid's: its voxels round\n"
    "the index's kink off at the surface; of 128^3, two voxels a step are 64 steps");
}
}

void FollowLenses(const PhotonBench& bench)
{
  const int edge = bench.quick ? 32 : 128;
  PhotonScene luneburgLens(edge, 1.1);
  luneburgLens.SetIndex(luneburg::Endless);
  Refine(bench, "luneburg",
    "Luneburg lens of radius 1, without air: largest distance of a path's corners from the exact path (observed order)",
    luneburgLens, FollowLuneburg);
  PhotonScene eye(edge, 2.0);
  eye.SetIndex(fisheye::Index);
  Refine(bench, "fish-eye",
    "Maxwell's fish-eye: largest distance of a path's corners from the circle to the antipode (observed order)", eye,
    FollowFishEye);
  RefineLensInAir(bench);
}

void TurnByPrism(const PhotonBench& bench)
{
  Table table({ "grid", "samples", "order", "incidence", "turn", "mean error", "largest error" });
  for (const int edge : bench.quick ? std::vector<int>{ 32 } : std::vector<int>{ 64, 128, 256 })
  {
    for (const int samples : bench.quick ? std::vector<int>{ 4 } : std::vector<int>{ 4, 16 })
    {
      PhotonScene scene = prism::Scene(bench.device, edge, samples);
      for (const int order : { 2, 4 })
      {
        scene.settings.order = order;
        PhotonMarcher marcher = scene.Marcher(bench.device);
        for (const double incidence : prism::Incidences())
        {
          const prism::Error error = prism::ErrorOf(prism::Turns(marcher, incidence), incidence);
          const double degrees = 180.0 / optics::Pi;
          const double turn = optics::PrismTurn(prism::Index, prism::Apex, incidence);
          PhotonLine("prism", "order " + std::to_string(order), scene.medium.grid)
            .Add("samples", samples)
            .Add("incidence", degrees * incidence)
            .Add("turn", degrees * turn)
            .Add("error_mean", degrees * error.ofMean)
            .Add("error_max", degrees * error.largest)
            .Print();
          table.Add({ std::to_string(edge) + "^3", std::to_string(samples), std::to_string(order),
            Text("%.1f", degrees * incidence), Text("%.2f", degrees * turn), Text("%+.3f", degrees * error.ofMean),
            Text("%.3f", degrees * error.largest) });
        }
      }
    }
  }
  table.Print(
    "Prism of 60 degrees, n = 1.5, voxelised with so many samples an edge of a voxel: angles by which 32 rays are\n"
    "turned against Snell's law at both faces, degrees (the middle incidence is that of least deviation)");
}
}
