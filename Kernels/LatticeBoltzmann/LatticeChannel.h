#pragma once

#include "Device/Monitor.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeScene.h"
#include "LatticeBoltzmann/Settling.h"
#include "Light/LightField.h"

#include <vector>

namespace tyndall
{
/// Mean directions times fluence, as LightField::netFlux has it.
std::vector<float> NetFluxOf(const UncollidedImage& image, const Grid& grid, int channels);

/// One channel: solved for, and added to the light of all.
class LatticeChannel
{
public:
  LatticeChannel(Device& device, const LatticeScene& scene, const Field& ior, const LatticeSettings& settings,
    const Uncollided& direct, int channel)
    : TheDevice(device)
    , Scene(scene)
    , Box(scene.medium.grid)
    , Settings(settings)
    , Direct(direct)
    , Voxels(scene, ior, settings, direct, channel)
    , Photons(device, this->Box, settings, this->Voxels)
    , Channel(static_cast<std::size_t>(channel))
  {
  }

  double Thickest() const { return this->Voxels.thickest; }
  Lattice& TheLattice() { return this->Photons; }
  const LatticeVoxels& TheVoxels() const { return this->Voxels; }
  void Solve(const Monitor& monitor);
  /// Takes uncollided light that has changed.
  void Shine();
  /// Steps on, from densities that other steps have left.
  void Settle(const StepsBefore& before, const Monitor& monitor);
  /// Scattered light beside the uncollided one, and where all power went.
  void AddTo(LightField& light);

private:
  Device& TheDevice;
  const LatticeScene Scene;
  const LatticeBox Box;
  const LatticeSettings& Settings;
  const Uncollided& Direct;
  LatticeVoxels Voxels;
  Lattice Photons;
  std::size_t Channel;
  std::vector<float> Fluence;
  std::vector<ConvergenceRow> Rows;
};
}
