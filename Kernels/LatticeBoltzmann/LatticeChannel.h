#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "LatticeBoltzmann/Settling.h"
#include "Light/LightField.h"

#include <optional>
#include <vector>

namespace tyndall
{
/// One channel of a lattice: this rank's block of it is solved, and added to the light of all channels. Collective.
class LatticeChannel
{
public:
  /// All that is given must outlive it.
  LatticeChannel(Device& device, const LatticeProblem& problem, const LatticeSettings& settings,
    const Uncollided& direct, int channel);

  double Thickest() const { return this->Voxels.thickest; } ///< sigma_t h, of all ranks
  Lattice& TheLattice() { return *this->Densities; }        ///< of a block that has voxels
  const LatticeVoxels& TheVoxels() const { return this->Voxels; }

  /// The steady state, or steps, as the settings say.
  void Solve(const Monitor& monitor);
  /// Takes uncollided light that has changed.
  void UpdateSources();
  /// Continues to step, from the densities that earlier steps left. On one rank.
  void Settle(const StepsBefore& before, const Monitor& monitor);
  /// Adds fluence, flux, powers of this rank's voxels and the rows of convergence.
  void AddTo(LightField& light);

private:
  Device& TheDevice;
  const LatticeProblem& Problem;
  const LatticeSettings& Settings;
  const Uncollided& Direct;
  const int Channel;
  LatticeVoxels Voxels;
  std::optional<Lattice> Densities; ///< of the block; none where it has no voxels
  std::vector<float> Fluence;
  std::vector<ConvergenceRow> Rows;
};
}
