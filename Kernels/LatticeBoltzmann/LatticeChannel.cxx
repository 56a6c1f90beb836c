#include "LatticeBoltzmann/LatticeChannel.h"

#include "LatticeBoltzmann/LatticeAccount.h"
#include "LatticeBoltzmann/Steady/SteadyLattice.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Adds the convergence rows of one channel to those of all channels.
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
  if (this->Problem.TheDomain().Sum(this->Voxels.Given()) == 0.0)
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
