#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "Light/LightField.h"

#include <optional>
#include <vector>

namespace tyndall
{
/// Lattice steps taken, and time spent, before LatticeChannel::Settle(); they count towards the limits of the settings.
struct StepsBefore
{
  int steps = 0;
  double seconds = 0.0;
};

/// Lattice solve of one colour channel on this rank's block. Collective.
class LatticeChannel
{
public:
  /// All arguments must outlive this.
  LatticeChannel(Device& device, const LatticeProblem& problem, const LatticeSettings& settings,
    const Uncollided& direct, int channel);

  /// Largest optical thickness of a voxel, sigma_t h, of all ranks.
  double Thickest() const { return this->Voxels.thickest; }
  Lattice& TheLattice() { return *this->Densities; } ///< requires a block that has voxels
  const LatticeVoxels& TheVoxels() const { return this->Voxels; }
  /// Whether no light is scattered or emitted, so that the lattice is dark. Known after Solve().
  bool IsDark() const { return this->Dark; }

  /// Solves for the steady state, or takes lattice steps, depending on the settings.
  void Solve(const Monitor& monitor);
  /// Recomputes the sources of the lattice after the uncollided light has changed.
  void UpdateSources();
  /// Takes lattice steps from the current densities until the tolerance or the limit of steps is met. On one rank only.
  void Settle(const StepsBefore& before, const Monitor& monitor);
  /// Adds fluence, net flux and powers of this rank's block, and the convergence rows, to `light`.
  void AddTo(LightField& light);

private:
  Device& TheDevice;
  const LatticeProblem& Problem;
  const LatticeSettings& Settings;
  const Uncollided& Direct;
  const int Channel;
  LatticeVoxels Voxels;
  std::optional<Lattice> Densities; ///< lattice of the block; unset if the block has no voxels
  bool Dark = false;
  std::vector<float> Fluence;
  std::vector<ConvergenceRow> Rows;
};
}
