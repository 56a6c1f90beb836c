// How far diffusion on a lattice is from transport: cubes against photons that are scattered until they end.

#include "LatticeTables.h"
#include "Measure.h"
#include "Report.h"

#include "Comparison/ComparedScene.h"
#include "LatticeBoltzmann/LatticeBoltzmann.h"
#include "Numerics/Constants.h"
#include "Photons/Emission/PhotonEmitter.h"
#include "Photons/Marching/PhotonMarcher.h"
#include "Reference/CubeReference.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace bench
{
using namespace tyndall;

namespace
{
enum class Lit
{
  Diffusely, ///< through face -z
  BySun      ///< along -z
};

/// A cube of side 1, the same everywhere, 1 W on one face.
struct Cube
{
  Lit lit;
  double tau, albedo;
  Medium medium;
  Illumination light;
  std::vector<float> sigma_a, sigma_s;

  Cube(Lit by, double thickness, double white, int edge)
    : lit(by)
    , tau(thickness)
    , albedo(white)
  {
    this->medium.grid.size = { edge, edge, edge };
    this->medium.grid.spacing.fill(1.0 / edge);
    const std::size_t voxels = this->medium.grid.VoxelCount();
    this->sigma_a.assign(voxels, static_cast<float>(thickness * (1.0 - white)));
    this->sigma_s.assign(voxels, static_cast<float>(thickness * white));
    this->medium.sigma_a = { this->sigma_a.data() };
    this->medium.sigma_s = { this->sigma_s.data() };
    if (by == Lit::BySun)
    {
      Light sun;
      sun.direction = { 0.0, 0.0, -1.0 };
      this->light.lights.push_back(sun);
    }
    else
    {
      this->light.faces[4].fill(1.0 / Pi);
    }
  }
  Cube(const Cube&) = delete;

  std::size_t LitFace() const { return this->lit == Lit::BySun ? 5 : 4; }
};

/// Parts of what enters that leave through the lit face, through that across, and stay.
using Powers = std::array<double, 3>;

Powers PowersOf(const Cube& cube, const LightField& light)
{
  const double entered = light.balance.entered[0];
  return { light.facePowerOut[cube.LitFace()][0] / entered, light.facePowerOut[9 - cube.LitFace()][0] / entered,
    light.balance.absorbed[0] / entered };
}

/// What is compared with.
struct Truth
{
  std::vector<float> fluence;
  Grid grid;
  Powers powers = {};
  std::string powersFrom = "the same photons";
  double noise = 0.0; ///< of fluence: sum of standard errors over that of fluence
  double seconds = 0.0;
};

constexpr double FirstPower = 1e-3; ///< parts below have too few photons

bool IsTabulated(const Cube& cube)
{
  return cube.lit == Lit::Diffusely && (cube.tau == 1.0 || cube.tau == 10.0) &&
    (cube.albedo == 0.5 || cube.albedo == 0.9 || cube.albedo == 1.0);
}

Truth ByPhotons(Device& device, const Cube& cube, std::size_t count)
{
  MarchSettings marching;
  marching.maximumOrders = 0;
  marching.meanDirection = false;
  marching.errorBatches = 16;
  EmissionSettings emission;
  emission.photonCount = count;
  Truth truth;
  const double start = WallSeconds();
  const EmittedPhotons emitted = EmitPhotons(cube.medium.grid, cube.light, emission);
  LightField light =
    PhotonMarcher(device, Domain(cube.medium.grid), cube.medium, {}, marching).March(emitted.photons).light;
  truth.seconds = WallSeconds() - start;
  truth.grid = cube.medium.grid;
  truth.powers = PowersOf(cube, light);
  double errors = 0.0, all = 0.0;
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    errors += light.fluenceError[i];
    all += light.fluence[i];
  }
  truth.noise = errors / all;
  truth.fluence = std::move(light.fluence);
  if (IsTabulated(cube))
  {
    const CubePowers known = CubePowersOf(cube.tau, cube.albedo);
    truth.powers = { known.part[0], known.part[1], known.part[3] };
    truth.powersFrom = "Data/Reference/cube_RTSA.csv";
  }
  return truth;
}

struct Difference
{
  double fluence = 0.0, bias = 0.0; ///< sum of absolute differences, and difference of sums, over the true sum
  Powers powers = {};               ///< relative; NaN where there is next to none
};

Difference DifferenceOf(const Cube& cube, const LightField& light, const Truth& truth)
{
  const Factors factors = *FactorsBetween(cube.medium.grid, truth.grid);
  const std::vector<float> fluence = Averaged(light.fluence.data(), 1, cube.medium.grid, factors);
  Difference found;
  double all = 0.0;
  for (std::size_t i = 0; i < fluence.size(); ++i)
  {
    found.fluence += std::abs(static_cast<double>(fluence[i]) - truth.fluence[i]);
    found.bias += static_cast<double>(fluence[i]) - truth.fluence[i];
    all += truth.fluence[i];
  }
  found.fluence /= all;
  found.bias /= all;
  const Powers powers = PowersOf(cube, light);
  for (std::size_t i = 0; i < powers.size(); ++i)
  {
    found.powers[i] = truth.powers[i] > FirstPower ? powers[i] / truth.powers[i] - 1.0 : std::nan("");
  }
  return found;
}

/// After one that compiles.
LightField Timed(Device& device, const Cube& cube, double& seconds)
{
  LatticeSettings settings;
  SolveLatticeBoltzmann(device, Domain(cube.medium.grid), cube.medium, {}, cube.light, settings);
  const double start = WallSeconds();
  LightField light = SolveLatticeBoltzmann(device, Domain(cube.medium.grid), cube.medium, {}, cube.light, settings);
  seconds = WallSeconds() - start;
  return light;
}

std::string Percent(double part)
{
  return Text("%.1f%%", 100.0 * part);
}

void Compare(Device& device, const Cube& cube, const Truth& truth, Table& table)
{
  double seconds = 0.0;
  const LightField light = Timed(device, cube, seconds);
  const Difference found = DifferenceOf(cube, light, truth);
  const int edge = cube.medium.grid.size[0];
  const std::string lit = cube.lit == Lit::BySun ? "sun" : "diffuse";
  JsonLine()
    .Add("bench", "lattice")
    .Add("case", "diffusion, " + lit + ", thickness " + Text("%g", cube.tau) + ", albedo " + Text("%g", cube.albedo))
    .Add("method", "lattice, 18 directions, steady")
    .Add("grid", GridText(edge))
    .Add("seconds", seconds)
    .Add("sigma_t_h", cube.tau / edge)
    .Add("error_l1", found.fluence)
    .Add("bias", found.bias)
    .Add("error_reflected", found.powers[0])
    .Add("error_transmitted", found.powers[1])
    .Add("error_absorbed", found.powers[2])
    .Add("powers_against", truth.powersFrom)
    .Add("against", "photons that are scattered until they end")
    .Add("against_noise_l1", truth.noise)
    .Add("against_seconds", truth.seconds)
    .Add("load", LoadAverage())
    .Print();
  table.Add({ lit + ", " + Text("%g", cube.tau), Text("%g", cube.albedo), GridText(edge), Text("%.3g", cube.tau / edge),
    Percent(found.fluence), Percent(found.bias), Percent(found.powers[0]), Percent(found.powers[1]),
    Percent(found.powers[2]), Percent(truth.noise), Text("%.2f", seconds), Text("%.1f", truth.seconds) });
}
}

void PrintDiffusion(Device& device, bool quick)
{
  const std::vector<double> thicknesses =
    quick ? std::vector<double>{ 3.0 } : std::vector<double>{ 1.0, 3.0, 10.0, 30.0, 100.0 };
  const std::vector<double> albedos =
    quick ? std::vector<double>{ 0.9 } : std::vector<double>{ 0.5, 0.9, 0.99, 0.999, 1.0 };
  const std::vector<int> edges = quick ? std::vector<int>{ 8 } : std::vector<int>{ 32, 64 };
  const std::size_t photons = quick ? 20000 : 2000000;
  Table table({ "lit, thickness", "albedo", "grid", "sigma_t h", "fluence", "bias", "reflected", "transmitted",
    "absorbed", "noise", "s", "s of photons" });
  for (const Lit lit : { Lit::Diffusely, Lit::BySun })
  {
    for (const double tau : thicknesses)
    {
      for (const double albedo : albedos)
      {
        const Truth truth = ByPhotons(device, Cube(lit, tau, albedo, quick ? 8 : 16), photons);
        for (const int edge : edges)
        {
          Compare(device, Cube(lit, tau, albedo, edge), truth, table);
        }
      }
    }
  }
  table.Print("Cubes lit through one face: lattice of 18 directions against photons, relative errors (fluence: L1 over "
              "voxels; noise: that of photons; -: less than 0.1% of what enters)");
}
}
