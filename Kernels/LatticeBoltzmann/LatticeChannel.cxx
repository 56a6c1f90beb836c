#include "LatticeBoltzmann/LatticeChannel.h"

#include "LatticeBoltzmann/LatticeAccount.h"
#include "LatticeBoltzmann/Steady/SteadyInMemory.h"
#include "LatticeBoltzmann/Steady/SteadyLattice.h"

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
  if (this->Voxels.Given() == 0.0)
  {
    this->Fluence.assign(this->Box.Count(), 0.0f);
  }
  else if (this->Settings.Solves())
  {
    SteadyInMemory system(this->TheDevice, this->Box.known, this->Settings, this->Voxels, this->Photons);
    this->Fluence = SteadyLattice(this->Box, this->Settings, this->Voxels, system).Solve(monitor, this->Rows);
  }
  else
  {
    this->Settle({}, monitor);
  }
}

void LatticeChannel::Settle(const StepsBefore& before, const Monitor& monitor)
{
  this->Fluence =
    Settling(this->TheDevice, this->Photons, this->Box.known, this->Settings).Run(before, monitor, this->Rows);
}

void LatticeChannel::Shine()
{
  this->Voxels.Shine(this->Scene, this->Direct, static_cast<int>(this->Channel));
  this->Photons.Shine(this->Voxels.source);
}

void LatticeChannel::AddTo(LightField& light)
{
  LatticeAccount(
    this->Scene, this->Box, this->Settings, this->Direct, this->Voxels, this->Photons, static_cast<int>(this->Channel))
    .AddTo(light, this->Fluence);
  EnergyBalance& balance = light.balance;
  const std::size_t c = this->Channel;
  // What densities still gain in a step.
  balance.leftOver[c] = balance.entered[c] + balance.emitted[c] - balance.absorbed[c] - balance.escaped[c];
  AddRows(this->Rows, light);
}
}
