// Whether light of a point spreads alike in all directions on a lattice.

#include "LatticeTables.h"
#include "Report.h"

#include "LatticeBoltzmann/LatticeBoltzmann.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace bench
{
using namespace tyndall;

namespace
{
/// The voxel in the middle of an even medium shines.
struct Point
{
  int edge;
  Medium medium;
  std::vector<float> sigma_a, sigma_s, emission;

  Point(int voxels, double thickness, double albedo)
    : edge(voxels)
  {
    this->medium.grid.size = { voxels, voxels, voxels };
    const std::size_t count = this->medium.grid.VoxelCount();
    this->sigma_a.assign(count, static_cast<float>(thickness * (1.0 - albedo)));
    this->sigma_s.assign(count, static_cast<float>(thickness * albedo));
    this->emission.assign(count, 0.0f);
    this->emission[count / 2] = 1.0f;
    this->medium.sigma_a = { this->sigma_a.data() };
    this->medium.sigma_s = { this->sigma_s.data() };
    this->medium.emission = { this->emission.data() };
  }
  Point(const Point&) = delete;

  /// Fluence at a distance, voxels, towards (x, y, z), each 0 or 1: along the logarithm of fluence times distance,
  /// which is straight where light diffuses.
  double At(const std::vector<float>& fluence, double distance, const std::array<int, 3>& towards) const
  {
    const int middle = this->edge / 2, step = (towards[2] * this->edge + towards[1]) * this->edge + towards[0];
    const double length = std::sqrt(towards[0] + towards[1] + towards[2]);
    const auto scaled = [&](int steps) {
      const auto voxel =
        static_cast<std::size_t>(((middle * this->edge + middle) * this->edge + middle) + steps * step);
      return std::log(steps * length * fluence[voxel]);
    };
    const int near = static_cast<int>(distance / length);
    const double part = distance / length - near;
    return std::exp((1.0 - part) * scaled(near) + part * scaled(near + 1)) / distance;
  }
};

struct PointScene
{
  double thickness; ///< of a voxel
  double albedo;
  int steps; ///< 0: steady
};

void PrintPoint(Device& device, bool quick, Table& table, int directions, const PointScene& of)
{
  const Point point(quick ? 25 : 65, of.thickness, of.albedo);
  LatticeSettings settings;
  settings.directions = directions;
  settings.maximumSteps = of.steps;
  settings.tolerance = 1e-7; // far off there is little light
  const LightField light = SolveLatticeBoltzmann(device, Domain(point.medium.grid), point.medium, {}, {}, settings);
  const std::string scene = "isotropy, sigma_t h " + Text("%g", of.thickness) + ", albedo " + Text("%g", of.albedo) +
    (of.steps == 0 ? ", steady" : ", after " + std::to_string(of.steps) + " steps");
  const std::string method = std::to_string(directions) + " directions";
  for (const double distance : quick ? std::vector<double>{ 4.0 } : std::vector<double>{ 2.0, 4.0, 8.0, 12.0, 16.0 })
  {
    const double axis = point.At(light.fluence, distance, { 1, 0, 0 });
    const double face = point.At(light.fluence, distance, { 1, 1, 0 }) / axis;
    const double space = point.At(light.fluence, distance, { 1, 1, 1 }) / axis;
    JsonLine()
      .Add("bench", "lattice")
      .Add("case", scene)
      .Add("method", method)
      .Add("grid", GridText(point.edge))
      .Add("distance_voxels", distance)
      .Add("face_diagonal_over_axis", face)
      .Add("space_diagonal_over_axis", space)
      .Print();
    table.Add({ scene, method, Text("%g", distance), Text("%.3f", face), Text("%.3f", space) });
  }
}
}

void PrintIsotropy(Device& device, bool quick)
{
  Table table({ "scene", "method", "voxels away", "face diagonal", "space diagonal" });
  for (const PointScene& scene :
    { PointScene{ 0.5, 0.9, 0 }, PointScene{ 2.0, 0.99, 0 }, PointScene{ 0.5, 1.0, quick ? 16 : 64 } })
  {
    for (const int directions : { 18, 6 })
    {
      PrintPoint(device, quick, table, directions, scene);
    }
  }
  table.Print("Light of a voxel that shines: fluence along diagonals over that along axes at equal distance");
}
}
