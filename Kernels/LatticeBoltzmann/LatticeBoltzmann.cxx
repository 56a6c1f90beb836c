#include "LatticeBoltzmann/LatticeBoltzmann.h"

#include "Device/Batches.h"
#include "Device/Clock.h"
#include "Device/Errors.h"
#include "LatticeBoltzmann/CubicVoxels.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/SteadyLattice.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
constexpr int StepsPerLook = 16;   ///< after which it is looked at how much changes, at least
constexpr int MostSteps = 200000;  ///< where the tolerance is not met
constexpr double Slowest = 0.9999; ///< of changes from look to look: beyond, their rest is not known

void CheckCubes(const Grid& grid)
{
  if (!HasCubicVoxels(grid))
  {
    throw InvalidInput("The lattice's voxels have to be cubes; their edges are " + Text("%.6g", grid.spacing[0]) +
      ", " + Text("%.6g", grid.spacing[1]) + ", " + Text("%.6g", grid.spacing[2]) + ". Resample the image.");
  }
}

void CheckIndex(const Field& ior, const Grid& grid)
{
  for (std::size_t i = 0; ior.values && i < grid.VoxelCount(); ++i)
  {
    if (const double n = ior.At(i, 0); !(n >= 1e-6 && n <= 1e6))
    {
      throw InvalidInput("The refractive index of voxel " + VoxelName(grid, i) + " is " + Text("%.6g", n) +
        "; it must be positive (1e-6 to 1e6).");
    }
  }
}

PropagationSettings AsPropagation(const LatticeSettings& settings)
{
  PropagationSettings of;
  of.periodic = settings.periodic;
  of.netFlux = settings.netFlux;
  of.source = PropagationSource::Constant; // voxels stay cubes in slabs, too
  return of;
}

/// Light that is not scattered, as an image and with its arrays.
struct Uncollided
{
  std::vector<float> fluence, netFlux;
  UncollidedImage image;
};

/// Mean directions times fluence, as LightField::netFlux has it.
std::vector<float> FluxOf(const UncollidedImage& image, const Grid& grid, int channels)
{
  std::vector<float> flux;
  for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      for (int a = 0; a < 3; ++a)
      {
        const float along = image.meanDirection.values ? image.meanDirection.values[3 * i + a] : 0.0f;
        flux.push_back(along * image.fluence.At(i, c));
      }
    }
  }
  return flux;
}

/// That which is given, or else that of lamps and environment along the maps' rays. Nothing is truncated: the medium
/// counts as scattering evenly.
Uncollided FindUncollided(
  Device& device, const PropagationProblem& problem, const LatticeSettings& settings, const Monitor& monitor)
{
  Uncollided found;
  found.image = problem.Shining().uncollided;
  if (found.image.IsThere())
  {
    found.netFlux = settings.netFlux ? FluxOf(found.image, problem.TheGrid(), problem.Channels()) : found.netFlux;
    return found;
  }
  Medium dark = problem.TheMedium();
  dark.emission = {};
  dark.phase = PhaseFunction();
  PropagationSettings once = AsPropagation(settings);
  once.source = PropagationSource::Automatic;
  once.maximumOrders = 1;
  Illumination narrow = problem.Shining(); // what is diffuse comes in on the lattice itself
  narrow.sky = {};
  narrow.faces = {};
  narrow.faceAlbedo = {};
  if (!Shines(narrow))
  {
    found.fluence.assign(problem.TheGrid().VoxelCount(), 0.0f);
    found.image.fluence = { found.fluence.data(), 1 };
    found.netFlux = settings.netFlux ? FluxOf(found.image, problem.TheGrid(), problem.Channels()) : found.netFlux;
    return found;
  }
  LightField light = SolveConservative(device, dark, narrow, once, monitor);
  found.fluence = std::move(light.fluenceDirect);
  found.image.fluence = { found.fluence.data(), light.channels };
  found.image.escaped = light.facePowerOut;
  for (std::size_t i = 0; settings.netFlux && i < problem.TheGrid().VoxelCount(); ++i)
  {
    for (int c = 0; c < problem.Channels(); ++c)
    {
      const float* flux = light.netFlux.data() + 3 * (i * light.channels + (light.channels > 1 ? c : 0));
      found.netFlux.insert(found.netFlux.end(), flux, flux + 3);
    }
  }
  return found;
}

/// Steps until little changes, or as many as were asked for.
class Settling
{
public:
  Settling(Device& device, Lattice& lattice, const LatticeSettings& settings)
    : TheDevice(device)
    , TheLattice(lattice)
    , Settings(settings)
  {
  }

  /// @return fluence of the last step
  std::vector<float> Run(const Monitor& monitor, std::vector<ConvergenceRow>& rows);

private:
  double Change();
  double Estimate(double change);
  void Step(int steps, double done, const Monitor& monitor);

  Device& TheDevice;
  Lattice& TheLattice;
  const LatticeSettings& Settings;
  std::vector<float> Last; ///< fluence when it was looked at last
  double LastChange = 0.0;
};

/// Of fluence since it was looked at last, relative.
double Settling::Change()
{
  const std::vector<float> now = this->TheLattice.Fluence();
  this->Last.resize(now.size(), 0.0f);
  double change = 0.0, all = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i)
  {
    change += std::abs(static_cast<double>(now[i]) - this->Last[i]);
    all += std::abs(now[i]);
  }
  this->Last = now;
  if (!std::isfinite(all))
  {
    throw InvalidInput(
      "Steps as published have grown beyond all floats: sigma_t times a voxel's edge is above 1. Choose "
      "the conservative scheme, or smaller voxels.");
  }
  return all > 0.0 ? change / all : 0.0;
}

/// What is still to come, from how changes fall.
double Settling::Estimate(double change)
{
  const double ratio = this->LastChange > 0.0 ? std::min(change / this->LastChange, Slowest) : 1.0;
  const bool compares = this->LastChange > 0.0;
  this->LastChange = change;
  return change == 0.0 ? 0.0 : compares ? std::min(change * ratio / (1.0 - ratio), 1.0) : 1.0;
}

/// Queued in parts of about 50 ms.
void Settling::Step(int steps, double done, const Monitor& monitor)
{
  Batches batches;
  batches.count = static_cast<std::size_t>(steps);
  batches.whole = this->Settings.blockSize > 0 ? static_cast<std::size_t>(this->Settings.stepsPerExchange) : 1;
  batches.first = batches.whole;
  batches.from = batches.to = done;
  InBatches(this->TheDevice, batches, monitor, [&](std::size_t begin, std::size_t size) {
    this->TheLattice.Step(static_cast<int>(size), static_cast<int>(begin + size) == steps);
  });
}

std::vector<float> Settling::Run(const Monitor& monitor, std::vector<ConvergenceRow>& rows)
{
  const double start = ClockSeconds();
  const bool asked = this->Settings.maximumSteps > 0;
  const int most = asked ? this->Settings.maximumSteps : MostSteps;
  // A look costs about as much as a step; blocks are looked at after whole exchanges.
  const int exchange = this->Settings.blockSize > 0 ? this->Settings.stepsPerExchange : 1;
  const int look = (StepsPerLook + exchange - 1) / exchange * exchange;
  double residual = 1.0, done = 0.0;
  for (int step = 0; step < most && (asked || residual > this->Settings.tolerance);)
  {
    const int steps = std::min(look, most - step);
    this->Step(steps, done, monitor);
    step += steps;
    ConvergenceRow row;
    row.change = this->Change();
    residual = this->Estimate(row.change);
    row.iteration = step;
    row.seconds = ClockSeconds() - start;
    row.residual = residual;
    rows.push_back(row);
    done = asked
      ? static_cast<double>(step) / most
      : std::clamp(std::log(std::max(residual, 1e-30)) / std::log(std::min(this->Settings.tolerance, 0.9)), done, 1.0);
    Report(monitor, done);
  }
  return this->Last;
}

/// One channel: solved for, and added to the light of all.
class LatticeChannel
{
public:
  LatticeChannel(Device& device, const PropagationProblem& problem, const Field& ior, const LatticeSettings& settings,
    const Uncollided& direct, int channel)
    : TheDevice(device)
    , Problem(problem)
    , Settings(settings)
    , Direct(direct)
    , Voxels(problem, ior, settings, direct.image, channel)
    , Photons(device, problem.TheGrid(), settings, this->Voxels)
    , Channel(static_cast<std::size_t>(channel))
  {
  }

  double Thickest() const { return this->Voxels.thickest; }
  void Solve(const Monitor& monitor);
  void AddTo(LightField& light);

private:
  double CountVoxels(LightField& light) const;
  double CountFaces(LightField& light);
  void AddFlux(LightField& light);
  void AddRows(LightField& light) const;

  Device& TheDevice;
  const PropagationProblem& Problem;
  const LatticeSettings& Settings;
  const Uncollided& Direct;
  LatticeVoxels Voxels;
  Lattice Photons;
  std::size_t Channel;
  std::vector<float> Fluence;
  std::vector<ConvergenceRow> Rows;
};

void LatticeChannel::Solve(const Monitor& monitor)
{
  const Grid& grid = this->Problem.TheGrid();
  if (this->Voxels.Given() == 0.0)
  {
    this->Fluence.assign(grid.VoxelCount(), 0.0f);
  }
  else if (this->Settings.Solves())
  {
    SteadyLattice steady(this->TheDevice, grid, this->Settings, this->Voxels, this->Photons);
    this->Fluence = steady.Solve(monitor, this->Rows);
  }
  else
  {
    this->Fluence = Settling(this->TheDevice, this->Photons, this->Settings).Run(monitor, this->Rows);
  }
}

/// Fluence, and what voxels absorb and emit. @return W that entered as light that collides or is absorbed
double LatticeChannel::CountVoxels(LightField& light) const
{
  const Medium& medium = this->Problem.TheMedium();
  const int channel = static_cast<int>(this->Channel);
  const double edge = medium.grid.spacing[0], area = edge * edge;
  double entered = 0.0;
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    const double tau = edge * medium.sigma_a.At(i, channel);
    const double direct = this->Direct.image.fluence.At(i, channel), lost = this->Voxels.lost[i];
    // Where much is absorbed in a step, fluence is the mean over that.
    const double mean = tau > 1e-6 ? lost / tau : 1.0;
    light.fluence[i * light.channels + this->Channel] = static_cast<float>(direct + mean * this->Fluence[i]);
    light.fluenceDirect[i * light.channels + this->Channel] = static_cast<float>(direct);
    light.balance.absorbed[this->Channel] += area * (lost * this->Fluence[i] + tau * direct);
    light.balance.emitted[this->Channel] += area * edge * 4.0 * Pi * medium.emission.At(i, channel);
    entered += area * direct * (tau + edge * medium.sigma_s.At(i, channel));
  }
  return entered;
}

/// What leaves through the faces. @return W that came in through them, or left without having met anything
double LatticeChannel::CountFaces(LightField& light)
{
  const std::size_t voxels = this->Problem.TheGrid().VoxelCount();
  const double edge = this->Problem.TheGrid().spacing[0], area = edge * edge;
  const std::vector<float> through = this->Photons.Leaving();
  const std::vector<float> inwards = this->Photons.LeavingOfOne(); // light of fluence 1 outside comes in the same way
  double entered = 0.0;
  for (std::size_t face = 0; face < 6; ++face)
  {
    double power = this->Direct.image.escaped[face][this->Channel];
    entered += power;
    for (std::size_t i = 0; i < voxels; ++i)
    {
      // Of what comes in through links that give back a part, that leaves at once.
      const double squared = this->Voxels.bends ? this->Voxels.squared[i] : 1.0;
      const double entering = area * this->Voxels.incoming[face] * squared * inwards[face * voxels + i];
      const double passed = 2.0 * this->Voxels.passes[i] / (this->Voxels.passes[i] + 1.0);
      power += area * through[face * voxels + i] + entering * (1.0 / passed - 1.0);
      entered += entering / passed;
    }
    light.facePowerOut[face][this->Channel] = power;
    light.balance.escaped[this->Channel] += power;
  }
  return entered;
}

void LatticeChannel::AddFlux(LightField& light)
{
  const std::vector<float> flux = this->Photons.NetFlux();
  const std::size_t voxels = this->Problem.TheGrid().VoxelCount();
  for (std::size_t i = 0; i < voxels; ++i)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      const std::size_t to = 3 * (i * light.channels + this->Channel) + a;
      light.netFlux[to] = this->Direct.netFlux[to] + flux[a * voxels + i];
    }
  }
}

void LatticeChannel::AddRows(LightField& light) const
{
  light.convergence.resize(std::max(light.convergence.size(), this->Rows.size()));
  for (std::size_t row = 0; row < this->Rows.size(); ++row)
  {
    ConvergenceRow& sum = light.convergence[row];
    sum.iteration = this->Rows[row].iteration;
    sum.seconds += this->Rows[row].seconds;
    sum.residual = std::max(sum.residual, this->Rows[row].residual);
    sum.change = std::max(sum.change, this->Rows[row].change);
  }
}

/// Scattered light beside the uncollided one, and where all power went.
void LatticeChannel::AddTo(LightField& light)
{
  EnergyBalance& balance = light.balance;
  const std::size_t c = this->Channel;
  if (this->Settings.netFlux)
  {
    this->AddFlux(light);
  }
  balance.entered[c] = this->CountVoxels(light);
  balance.entered[c] += this->CountFaces(light);
  // What densities still gain in a step.
  balance.leftOver[c] = balance.entered[c] + balance.emitted[c] - balance.absorbed[c] - balance.escaped[c];
  this->AddRows(light);
}

/// What is said of the light beside its numbers.
void Describe(LightField& light, const PropagationProblem& problem, const LatticeSettings& settings, double thickest)
{
  if (!problem.TheMedium().phase.IsIsotropic() && problem.Traits().scatters)
  {
    light.leftOut.emplace_back(
      "anisotropy: diffuses as isotropic scattering with sigma_s (1 - g) (similarity relation)");
  }
  if (!settings.netFlux)
  {
    light.leftOut.emplace_back(left_out::NetFlux);
  }
  if (settings.scheme == LatticeScheme::Published && thickest > 1.0)
  {
    light.doubts.push_back(
      "As published, collisions are positive only where sigma_t times a voxel's edge is at most 1; "
      "here it is up to " +
      Text("%.3g", thickest) + ", and light may swing and grow. Choose the conservative scheme, or smaller voxels.");
  }
}

void Judge(LightField& light, const Illumination& illumination, const LatticeSettings& settings)
{
  PropagationSettings judged = AsPropagation(settings);
  judged.maximumOrders = settings.maximumSteps;
  judged.tolerance = settings.tolerance;
  JudgeConvergence(judged, light);
  if (Reflects(illumination))
  {
    light.doubts.emplace_back(
      "FaceAlbedo gives back diffuse light only, not what leaves without having been scattered.");
  }
  light.faceAlbedo = illumination.faceAlbedo;
}
}

LightField SolveLatticeBoltzmann(Device& device, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings, const Monitor& monitor)
{
  Check(settings);
  const PropagationProblem problem(medium, illumination, AsPropagation(settings));
  CheckCubes(medium.grid);
  CheckIndex(ior, medium.grid);
  const Uncollided uncollided = FindUncollided(device, problem, settings, OfPart(monitor, 0.0, 0.1));
  LightField light;
  light.channels = problem.Channels();
  light.fluence.resize(medium.grid.VoxelCount() * static_cast<std::size_t>(light.channels));
  light.fluenceDirect = light.fluence;
  light.netFlux.resize(settings.netFlux ? 3 * light.fluence.size() : 0);
  double thickest = 0.0;
  for (int c = 0; c < light.channels; ++c)
  {
    LatticeChannel channel(device, problem, ior, settings, uncollided, c);
    const double all = light.channels;
    channel.Solve(OfPart(monitor, 0.1 + 0.9 * c / all, 0.1 + 0.9 * (c + 1) / all));
    channel.AddTo(light);
    thickest = std::max(thickest, channel.Thickest());
  }
  light.scatteredRadiance.resize(light.fluence.size());
  std::transform(light.fluence.begin(), light.fluence.end(), light.scatteredRadiance.begin(),
    [](float fluence) { return static_cast<float>(fluence / (4.0 * Pi)); });
  light.storedDirections = { { 0.0, 0.0, 0.0 } };
  light.device = device.Name();
  Describe(light, problem, settings, thickest);
  problem.Undo(light);
  Judge(light, illumination, settings);
  return light;
}
}
