#include "LatticeBoltzmann/LatticeChannel.h"

#include "LatticeBoltzmann/SteadyLattice.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
std::vector<float> NetFluxOf(const UncollidedImage& image, const Grid& grid, int channels)
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
    this->Settle({}, monitor);
  }
}

void LatticeChannel::Settle(const StepsBefore& before, const Monitor& monitor)
{
  this->Fluence =
    Settling(this->TheDevice, this->Photons, this->Problem.TheGrid(), this->Settings).Run(before, monitor, this->Rows);
}

void LatticeChannel::Shine()
{
  this->Voxels.Shine(this->Problem, this->Direct, static_cast<int>(this->Channel));
  this->Photons.Shine(this->Voxels.source);
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
    // Of what begins in a voxel, what is absorbed before it is in the lattice's light.
    const double own = this->Voxels.source[i] * (1.0 / this->Voxels.begins[i] - 1.0);
    const double absorbed = lost * this->Fluence[i] + own;
    // Where much is absorbed in a step, fluence is the mean over that.
    const double scattered = tau > 1e-6 ? absorbed / tau : this->Fluence[i];
    light.fluence[i * light.channels + this->Channel] = static_cast<float>(direct + scattered);
    light.fluenceDirect[i * light.channels + this->Channel] = static_cast<float>(direct);
    light.balance.absorbed[this->Channel] += area * (absorbed + tau * direct);
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
    power += area * this->Voxels.leaves[face];
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
  const Medium& medium = this->Problem.TheMedium();
  const std::size_t voxels = medium.grid.VoxelCount();
  for (std::size_t i = 0; i < voxels; ++i)
  {
    const double tau = medium.grid.spacing[0] * medium.sigma_a.At(i, static_cast<int>(this->Channel));
    const double mean = tau > 1e-6 ? this->Voxels.lost[i] / tau : 1.0; // as fluence
    for (std::size_t a = 0; a < 3; ++a)
    {
      const std::size_t to = 3 * (i * light.channels + this->Channel) + a;
      light.netFlux[to] = static_cast<float>(this->Direct.netFlux[to] + mean * flux[a * voxels + i]);
    }
  }
  this->AddCrossing(light);
}

/// What crosses a face at once goes from where it is first scattered to the face, and half of the way through the voxel
/// beyond.
void LatticeChannel::AddCrossing(LightField& light) const
{
  const Grid& grid = this->Problem.TheGrid();
  const auto add = [&](std::size_t voxel, std::size_t axis, double flux) {
    light.netFlux[3 * (voxel * light.channels + this->Channel) + axis] += static_cast<float>(flux);
  };
  for (std::size_t at = 0; at < this->Voxels.crossing.size(); ++at)
  {
    const double crosses = this->Voxels.crossing[at];
    const std::size_t voxel = at / 6, face = at % 6, beyond = VoxelBeyond(grid, this->Settings.periodic, voxel, face);
    if (crosses > 0.0)
    {
      const double out = face % 2 == 0 ? -crosses : crosses;
      const double nearer = this->Direct.Nearer(voxel, static_cast<int>(this->Channel), face);
      add(voxel, face / 2, (0.5 - nearer) * out);
      if (beyond != Outside)
      {
        add(beyond, face / 2, 0.5 * out);
      }
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
}
