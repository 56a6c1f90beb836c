// Photons that are scattered many times: scatterings a second, beside a plain program in C++ for the same cubes.

#include "Measure.h"
#include "PhotonRuns.h"
#include "PhotonTables.h"

#include "../Kernels/ScatteredScene.h"

#include <array>
#include <cmath>
#include <random>
#include <string>

namespace bench
{
using namespace tyndall;

namespace
{
struct ScatteringCube
{
  std::string name;
  double tau, albedo, g;
};

const ScatteringCube Cubes[] = { { "thickness 5, albedo 0.9", 5.0, 0.9, 0.0 },
  { "thickness 50, albedo 0.999", 50.0, 0.999, 0.0 }, { "thickness 5, albedo 0.9, g 0.85", 5.0, 0.9, 0.85 } };

/// What one photon after the other does in a unit cube of voxels, in double precision and on one core: optical depth
/// spent from wall to wall, absorption by weight, Russian roulette, power times path into the voxels.
class PlainWalk
{
public:
  PlainWalk(int edge, const ScatteringCube& cube)
    : Edge(edge)
    , G(cube.g)
    , SigmaS(static_cast<std::size_t>(edge) * edge * edge, cube.tau * cube.albedo)
    , SigmaA(SigmaS.size(), cube.tau * (1.0 - cube.albedo))
    , Path(SigmaS.size(), 0.0)
  {
  }

  void Follow(const Photon& photon)
  {
    this->Power = photon.power[0];
    const double dim = 0.05 * this->Power;
    for (int a = 0; a < 3; ++a)
    {
      this->Place[a] = photon.position[a] * this->Edge;
      this->Way[a] = photon.direction[a];
    }
    while (this->ToNextScattering())
    {
      ++this->Scatterings;
      if (this->Power < dim)
      {
        this->Power = this->Draw() * 2.0 * dim < this->Power ? 2.0 * dim : 0.0;
      }
      if (this->Power == 0.0)
      {
        return;
      }
      this->Turn();
    }
    this->Escaped += this->Power;
  }

  double Scatterings = 0.0, Escaped = 0.0;

private:
  double Draw() { return std::uniform_real_distribution<double>(0.0, 1.0)(this->Random); }

  /// Time, in voxels' edges, to the wall ahead along each axis, and from wall to wall.
  void SetOut(std::array<int, 3>& voxel, std::array<double, 3>& wall, std::array<double, 3>& across) const
  {
    for (int a = 0; a < 3; ++a)
    {
      voxel[a] = std::min(std::max(static_cast<int>(this->Place[a]), 0), this->Edge - 1);
      across[a] = this->Way[a] != 0.0 ? 1.0 / std::abs(this->Way[a]) : 1e30;
      const double to = this->Way[a] > 0.0 ? voxel[a] + 1.0 - this->Place[a] : this->Place[a] - voxel[a];
      wall[a] = std::max(to, 0.0) * across[a];
    }
  }

  /// @return whether it is scattered, and not out
  bool ToNextScattering()
  {
    std::array<int, 3> voxel;
    std::array<double, 3> wall, across;
    this->SetOut(voxel, wall, across);
    const double edge = 1.0 / this->Edge;
    double left = -std::log(1.0 - this->Draw()), now = 0.0;
    for (;;)
    {
      const int a = wall[0] < wall[1] ? (wall[0] < wall[2] ? 0 : 2) : (wall[1] < wall[2] ? 1 : 2);
      const std::size_t at = (static_cast<std::size_t>(voxel[2]) * this->Edge + voxel[1]) * this->Edge + voxel[0];
      const double length = (wall[a] - now) * edge, depth = this->SigmaS[at] * length;
      const bool collides = depth >= left;
      const double way = collides ? left / this->SigmaS[at] : length, tau = this->SigmaA[at] * way;
      const double rest = this->Power * std::exp(-tau);
      this->Path[at] += tau > 1e-9 ? (this->Power - rest) / this->SigmaA[at] : this->Power * way;
      this->Power = rest;
      now = collides ? now + way / edge : wall[a];
      if (!collides)
      {
        left -= depth;
        voxel[a] += this->Way[a] > 0.0 ? 1 : -1;
        wall[a] += across[a];
      }
      if (collides || voxel[a] < 0 || voxel[a] >= this->Edge)
      {
        for (int i = 0; i < 3; ++i)
        {
          this->Place[i] += now * this->Way[i];
        }
        return collides;
      }
    }
  }

  void Turn()
  {
    const double s = 2.0 * this->Draw() - 1.0, turn = 2.0 * Pi * this->Draw(), g = this->G;
    const double t = (1.0 - g * g) / (1.0 + g * s);
    const double cosine = g == 0.0 ? s : (1.0 + g * g - t * t) / (2.0 * g);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const std::array<double, 3> w = this->Way;
    const double sign = std::copysign(1.0, w[2]), a = -1.0 / (sign + w[2]), b = w[0] * w[1] * a;
    const double x = sine * std::cos(turn), y = sine * std::sin(turn);
    this->Way = { x * (1.0 + sign * w[0] * w[0] * a) + y * b + cosine * w[0],
      x * sign * b + y * (sign + w[1] * w[1] * a) + cosine * w[1], -x * sign * w[0] - y * w[1] + cosine * w[2] };
    const double length =
      std::sqrt(this->Way[0] * this->Way[0] + this->Way[1] * this->Way[1] + this->Way[2] * this->Way[2]);
    for (double& component : this->Way)
    {
      component /= length;
    }
  }

  int Edge;
  double G;
  std::vector<double> SigmaS, SigmaA, Path;
  std::mt19937_64 Random{ 1 };
  std::array<double, 3> Place = {}, Way = {};
  double Power = 0.0;
};

struct Rate
{
  double scatterings = 0.0; ///< a photon
  double perSecond = 0.0;   ///< scatterings a second and core
  double escaped = 0.0;     ///< part of the power
};

Rate RateOfKernel(const PhotonBench& bench, const ScatteringCube& cube, int edge, std::size_t count)
{
  PhotonScene scene = UnitCube(edge, cube.tau, cube.albedo, cube.g);
  scene.settings.meanDirection = false;
  const std::vector<Photon> photons = RandomPhotons(scene.medium.grid).ThroughFace(4, count);
  PhotonMarcher marcher = scene.Marcher(bench.device);
  PhotonLight light;
  const PhotonTimes times = Repeat(bench.device, bench.quick ? 1 : 5, [&] {
    light = marcher.March(photons);
    return light.seconds;
  });
  const double scatterings = static_cast<double>(light.scatterings);
  return { scatterings / static_cast<double>(count), scatterings / (times.coreSeconds * bench.device.ComputeUnits()),
    light.light.balance.escaped[0] };
}

Rate RateOfControl(const PhotonBench& bench, const ScatteringCube& cube, int edge, std::size_t count)
{
  PhotonScene scene = UnitCube(edge, cube.tau, cube.albedo, cube.g);
  const std::vector<Photon> photons = RandomPhotons(scene.medium.grid).ThroughFace(4, count);
  std::vector<double> seconds;
  Rate rate;
  for (int run = 0; run < (bench.quick ? 1 : 3); ++run)
  {
    PlainWalk walk(edge, cube);
    const double start = CoreSeconds();
    for (const Photon& photon : photons)
    {
      walk.Follow(photon);
    }
    seconds.push_back(CoreSeconds() - start);
    rate = { walk.Scatterings / static_cast<double>(count), walk.Scatterings, walk.Escaped };
  }
  rate.perSecond /= Median(seconds);
  return rate;
}
}

void ScatterPhotons(const PhotonBench& bench)
{
  const int edge = 16;
  Table table({ "cube", "", "scatterings a photon", "a second and core", "control", "ratio", "escaped", "control" });
  for (const ScatteringCube& cube : Cubes)
  {
    const std::size_t count = (bench.quick ? 2000 : 200000) / (cube.tau > 20.0 ? 10 : 1);
    const Rate kernel = RateOfKernel(bench, cube, edge, count), control = RateOfControl(bench, cube, edge, count);
    PhotonLine("scattering", cube.name, UnitCube(edge, 1.0, 1.0).medium.grid)
      .Add("scatterings_per_second_and_core", kernel.perSecond)
      .Add("control", control.perSecond)
      .Add("ratio", kernel.perSecond / control.perSecond)
      .Add("against", "plain C++")
      .Add("escaped", kernel.escaped)
      .Add("escaped_control", control.escaped)
      .Add("load", LoadAverage())
      .Print();
    table.Add({ cube.name, "", Text("%.2f", kernel.scatterings), Text("%.2e", kernel.perSecond),
      Text("%.2e", control.perSecond), Text("%.2f", kernel.perSecond / control.perSecond), Text("%.4f", kernel.escaped),
      Text("%.4f", control.escaped) });
  }
  table.Print(
    "Photons scattered until they end, 16^3 voxels, diffuse light on a face; control: one photon after the other "
    "in double precision, one core");
}
}
