#include "LatticeBoltzmann/Settling.h"

#include "Device/Batches.h"
#include "Device/Clock.h"
#include "Device/Errors.h"
#include "Numerics/ChooseEvenly.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr int StepsPerLook = 16;   ///< least number of steps between two readings of the probes
constexpr int MostSteps = 200000;  ///< limit if the tolerance is not met
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

/// Relative change of the fluence at the probes since the last call.
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
  if (!std::isfinite(all))
  {
    throw InvalidInput(
      "Steps as published have grown beyond all floats: sigma_t times a voxel's edge is above 1. Choose "
      "the conservative scheme, or smaller voxels.");
  }
  return all > 0.0 ? changed / all : 0.0;
}

/// Estimated relative error, from the rate at which changes decrease.
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
  // Reading the probes costs about a step; blocks are read after whole exchanges.
  const int exchange = this->Settings.blockSize > 0 ? this->Settings.stepsPerExchange : 1;
  const int look = (StepsPerLook + exchange - 1) / exchange * exchange;
  double residual = 1.0, done = 0.0;
  if (before.steps > 0)
  {
    this->Change(); // the next change is measured from here, not from zero
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
}
