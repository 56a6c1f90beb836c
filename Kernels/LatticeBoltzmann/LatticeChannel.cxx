#include "LatticeBoltzmann/LatticeChannel.h"

#include "Device/Batches.h"
#include "Device/Clock.h"
#include "Device/Errors.h"
#include "LatticeBoltzmann/FindUncollided.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/Steady/SteadyLattice.h"
#include "Numerics/ChooseEvenly.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tyndall
{
namespace
{
/// Steps a lattice until the estimated error of the fluence is below the tolerance, or for a given number of steps.
class Settling
{
public:
  /// @param lattice  lattice of all voxels of `grid`; all arguments must outlive this object
  Settling(Device& device, Lattice& lattice, const Grid& grid, const LatticeSettings& settings);

  /// Takes the steps.
  /// @param before  steps taken and time spent before, which count towards the limits of the settings
  /// @param rows  receives one convergence row for each comparison of the fluence at the probes (evenly spread voxels)
  /// @return fluence after the last step
  /// @throws InvalidInput if densities have overflowed (explicit collisions in optically thick voxels)
  std::vector<float> Run(const StepsBefore& before, const Monitor& monitor, std::vector<ConvergenceRow>& rows);

private:
  void Step(int steps, double done, const Monitor& monitor);
  double Change();
  double Estimate(double change);

  Device& TheDevice;
  Lattice& TheLattice;
  const LatticeSettings& Settings;
  Buffer<cl_int> Probes;   ///< voxels whose fluence is compared between checks; empty: all voxels
  std::vector<float> Last; ///< fluence at the probes when they were last read
  double LastChange = 0.0;
};

namespace
{
constexpr int StepsPerLook = 16;   ///< least number of steps between two readings of the fluence at the probes
constexpr int MostSteps = 200000;  ///< largest number of steps if the settings set no limit
constexpr double Slowest = 0.9999; ///< largest ratio of successive changes from which an error can be estimated
}

Settling::Settling(Device& device, Lattice& lattice, const Grid& grid, const LatticeSettings& settings)
  : TheDevice(device)
  , TheLattice(lattice)
  , Settings(settings)
{
  const auto probes = static_cast<std::size_t>(settings.probes);
  if (probes > 0 && probes < grid.VoxelCount())
  {
    const std::vector<std::size_t> chosen = ChooseEvenly(grid.VoxelCount(), probes);
    this->Probes = Buffer<cl_int>(device, std::vector<cl_int>(chosen.begin(), chosen.end()), "probes");
  }
}

/// Queues steps in batches of about 50 ms.
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

/// Relative change of the fluence at the probes since the previous call.
double Settling::Change()
{
  double changed = 0.0, all = 0.0;
  const std::vector<float> now =
    this->Probes.Size() > 0 ? this->TheLattice.FluenceAt(this->Probes) : this->TheLattice.Fluence();
  this->Last.resize(now.size(), 0.0f);
  for (std::size_t i = 0; i < now.size(); ++i)
  {
    changed += std::abs(static_cast<double>(now[i]) - this->Last[i]);
    all += std::abs(now[i]);
  }
  this->Last = now;
  Require(std::isfinite(all),
    "Steps as published have grown beyond all floats: sigma_t times a voxel's edge is above 1. Choose "
    "the conservative scheme, or smaller voxels.");
  return all > 0.0 ? changed / all : 0.0;
}

/// Estimates the relative error of the fluence from the ratio of successive changes, as a geometric series.
double Settling::Estimate(double change)
{
  const double ratio = this->LastChange > 0.0 ? std::min(change / this->LastChange, Slowest) : 1.0;
  const bool compares = this->LastChange > 0.0;
  this->LastChange = change;
  return change == 0.0 ? 0.0 : compares ? std::min(change * ratio / (1.0 - ratio), 1.0) : 1.0;
}

std::vector<float> Settling::Run(const StepsBefore& before, const Monitor& monitor, std::vector<ConvergenceRow>& rows)
{
  const double start = ClockSeconds() - before.seconds;
  const bool asked = this->Settings.maximumSteps > 0;
  const int most = asked ? this->Settings.maximumSteps : MostSteps;
  // Reads the probes every `look` steps, because reading costs about as much as a step. With blocks, `look` is a
  // multiple of the steps between exchanges.
  const int exchange = this->Settings.blockSize > 0 ? this->Settings.stepsPerExchange : 1;
  const int look = (StepsPerLook + exchange - 1) / exchange * exchange;
  double residual = 1.0, done = 0.0;
  if (before.steps > 0)
  {
    this->Change(); // reads the probes, so that the next change is measured from the current fluence
  }
  for (int step = before.steps; step < most && (asked || residual > this->Settings.tolerance);)
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
  return this->TheLattice.Fluence();
}

/// Computes fluence, net flux and energy balance of one channel from the lattice densities of this rank's own voxels.
class LatticeAccount
{
public:
  /// All arguments must outlive this object.
  /// @param direct, voxels  uncollided light and coefficients, by own and ghost voxel
  LatticeAccount(const LatticeProblem& problem, const LatticeSettings& settings, const Uncollided& direct,
    const LatticeVoxels& voxels, Lattice& lattice, int channel)
    : TheMedium(problem.TheMedium())
    , Box(problem.Box())
    , Settings(settings)
    , Direct(direct)
    , Voxels(voxels)
    , Photons(lattice)
    , Channel(static_cast<std::size_t>(channel))
  {
  }

  /// Adds scattered and uncollided fluence, net flux, face powers, and all terms of the energy balance but leftOver
  /// (power still in transport), to `light`.
  /// @param fluence  lattice fluence by own voxel
  void AddTo(LightField& light, const std::vector<float>& fluence) const;

private:
  std::size_t Place(const LightField& light, std::size_t voxel) const
  {
    return voxel * static_cast<std::size_t>(light.channels) + this->Channel;
  }
  double Edge() const { return this->TheMedium.grid.spacing[0]; }
  double CountVoxels(LightField& light, const std::vector<float>& fluence) const;
  double CountFaces(LightField& light) const;
  void AddFlux(LightField& light) const;
  double FluxOfCrossing(std::size_t known, std::size_t face) const;

  const Medium& TheMedium;
  const LatticeBox& Box;
  const LatticeSettings& Settings;
  const Uncollided& Direct;
  const LatticeVoxels& Voxels;
  Lattice& Photons;
  const std::size_t Channel;
};

/// Adds fluence, absorbed power and emitted power to `light`. @return power of uncollided light that collides in
/// voxels, W
double LatticeAccount::CountVoxels(LightField& light, const std::vector<float>& fluence) const
{
  const Medium& medium = this->TheMedium;
  const int channel = static_cast<int>(this->Channel);
  const double edge = this->Edge(), area = edge * edge;
  double entered = 0.0;
  for (std::size_t i = 0; i < this->Box.Count(); ++i)
  {
    const std::size_t known = this->Box.Known(i);
    const double tau = edge * medium.sigma_a.At(known, channel);
    const double direct = this->Direct.image.fluence.At(known, channel), lost = this->Voxels.lost[known];
    // Power per area that the source emits and the medium absorbs in the same step, before it enters the fluence of the
    // lattice (Eq. (L4a)).
    const double own = this->Voxels.source[known] * (1.0 / this->Voxels.begins[known] - 1.0);
    const double absorbed = lost * fluence[i] + own;
    // Fluence of scattered light, averaged over a step (Eq. (L4)).
    const double scattered = tau > 1e-6 ? absorbed / tau : fluence[i];
    light.fluence[this->Place(light, i)] = static_cast<float>(direct + scattered);
    light.fluenceDirect[this->Place(light, i)] = static_cast<float>(direct);
    light.balance.absorbed[this->Channel] += area * (absorbed + tau * direct);
    light.balance.emitted[this->Channel] += area * edge * 4.0 * Pi * medium.emission.At(known, channel);
    entered += area * direct * (tau + edge * medium.sigma_s.At(known, channel));
  }
  return entered;
}

/// Adds escaped power to `light`. @return power incident through the faces, including light that escapes uncollided, W
double LatticeAccount::CountFaces(LightField& light) const
{
  const std::size_t voxels = this->Box.Count();
  const double area = this->Edge() * this->Edge();
  const std::vector<float> through = this->Photons.Leaving();
  const std::vector<float> inwards =
    // By reciprocity, the light that would leave each voxel at fluence 1 is also the light that enters it if the
    // fluence outside is 1.
    this->Photons.LeavingOfOne();
  double entered = 0.0;
  for (std::size_t face = 0; face < 6; ++face)
  {
    double power = this->Direct.image.escaped[face][this->Channel];
    entered += power;
    for (std::size_t i = 0; i < voxels; ++i)
    {
      const std::size_t known = this->Box.Known(i);
      // Reflecting links return a fraction of the incident light, which is counted as incident and as escaped.
      const double squared = this->Voxels.bends ? this->Voxels.squared[known] : 1.0;
      const double entering = area * this->Voxels.incoming[face] * squared * inwards[face * voxels + i];
      const double passed = 2.0 * this->Voxels.passes[known] / (this->Voxels.passes[known] + 1.0);
      power += area * through[face * voxels + i] + entering * (1.0 / passed - 1.0);
      entered += entering / passed;
      if (!this->Voxels.crossing.empty() && this->Box.Beyond(known, face) == Outside)
      {
        power += area * this->Voxels.crossing[6 * known + face];
      }
    }
    light.facePowerOut[face][this->Channel] += power;
    light.balance.escaped[this->Channel] += power;
  }
  return entered;
}

void LatticeAccount::AddFlux(LightField& light) const
{
  const std::vector<float> flux = this->Photons.NetFlux();
  const std::size_t voxels = this->Box.Count();
  for (std::size_t i = 0; i < voxels; ++i)
  {
    const std::size_t known = this->Box.Known(i);
    const double tau = this->Edge() * this->TheMedium.sigma_a.At(known, static_cast<int>(this->Channel));
    // The densities yield the net flux at the end of a step. This factor converts it to the mean over the step, for
    // which the fluence is computed, too.
    const double mean = tau > 1e-6 ? this->Voxels.lost[known] / tau : 1.0;
    for (std::size_t a = 0; a < 3; ++a)
    {
      float& sum = light.netFlux[3 * this->Place(light, i) + a];
      sum = static_cast<float>(this->Direct.netFlux[3 * this->Place(light, known) + a] + mean * flux[a * voxels + i]);
      for (std::size_t face = 2 * a; face < 2 * a + 2 && !this->Voxels.crossing.empty(); ++face)
      {
        sum += static_cast<float>(this->FluxOfCrossing(known, face));
      }
    }
  }
}

/// Net flux in a voxel due to the first-collision source that LatticeVoxels::crossing moves across a face to the
/// neighbour (Eq. (L13)): this source counts as light that travels from the mean position of collisions to the face,
/// and from the face to the neighbour's centre.
double LatticeAccount::FluxOfCrossing(std::size_t known, std::size_t face) const
{
  const std::size_t beyond = this->Box.Beyond(known, face);
  const double out = face % 2 == 0 ? -1.0 : 1.0, crosses = this->Voxels.crossing[6 * known + face];
  const double comes = beyond == Outside ? 0.0 : this->Voxels.crossing[6 * beyond + (face ^ 1)];
  const double nearer =
    crosses > 0.0 ? NearerOfNormalBeam(this->TheMedium, known, static_cast<int>(this->Channel)) : 0.0;
  return (0.5 - nearer) * out * crosses - 0.5 * out * comes;
}

void LatticeAccount::AddTo(LightField& light, const std::vector<float>& fluence) const
{
  if (this->Settings.netFlux)
  {
    this->AddFlux(light);
  }
  light.balance.entered[this->Channel] += this->CountVoxels(light, fluence) + this->CountFaces(light);
}
}

namespace
{
/// Adds the convergence rows of one channel to the rows of all channels.
void AddRows(const std::vector<ConvergenceRow>& rows, LightField& light)
{
  light.convergence.resize(std::max(light.convergence.size(), rows.size()));
  for (std::size_t row = 0; row < rows.size(); ++row)
  {
    ConvergenceRow& sum = light.convergence[row];
    sum.iteration = rows[row].iteration;
    sum.seconds += rows[row].seconds;
    sum.residual = std::max(sum.residual, rows[row].residual);
    sum.change = std::max(sum.change, rows[row].change);
  }
}
}

LatticeChannel::LatticeChannel(
  Device& device, const LatticeProblem& problem, const LatticeSettings& settings, const Uncollided& direct, int channel)
  : TheDevice(device)
  , Problem(problem)
  , Settings(settings)
  , Direct(direct)
  , Channel(channel)
  , Voxels(problem, settings, direct, channel)
{
  problem.TheDomain().Collective([&] {
    if (problem.Box().Count() > 0)
    {
      this->Densities.emplace(device, problem.Box(), settings, this->Voxels);
    }
  });
}

void LatticeChannel::Solve(const Monitor& monitor)
{
  const LatticeBox& box = this->Problem.Box();
  this->Dark = this->Problem.TheDomain().Sum(this->Voxels.Given()) == 0.0;
  if (this->Dark && this->Settings.leaveOut)
  {
    this->Fluence.assign(box.Count(), 0.0f);
  }
  else if (this->Settings.Solves())
  {
    const Lattice* const densities = this->Densities ? &*this->Densities : nullptr;
    SteadyLattice steady(this->TheDevice, this->Problem, this->Settings, this->Voxels, densities);
    this->Fluence = steady.Solve(monitor, this->Rows);
  }
  else
  {
    this->Settle({}, monitor);
  }
}

void LatticeChannel::Settle(const StepsBefore& before, const Monitor& monitor)
{
  Settling settling(this->TheDevice, *this->Densities, this->Problem.Box().known, this->Settings);
  this->Fluence = settling.Run(before, monitor, this->Rows);
}

void LatticeChannel::UpdateSources()
{
  this->Voxels.LoadSources(this->Direct);
  this->Densities->SetSource(this->Voxels.source);
}

void LatticeChannel::AddTo(LightField& light)
{
  this->Problem.TheDomain().Collective([&] {
    if (this->Densities)
    {
      LatticeAccount(this->Problem, this->Settings, this->Direct, this->Voxels, *this->Densities, this->Channel)
        .AddTo(light, this->Fluence);
    }
  });
  AddRows(this->Rows, light);
}
}
