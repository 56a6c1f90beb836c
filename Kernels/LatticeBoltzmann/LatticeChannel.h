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
/// Steps that were taken before and count towards the limits.
struct StepsBefore
{
  int steps = 0;
  double seconds = 0.0;
};

/// Solve of one colour channel on this rank's block, whose result is added to the LightField of all channels.
/// Collective.
class LatticeChannel
{
public:
  /// All arguments must outlive this.
  LatticeChannel(Device& device, const LatticeProblem& problem, const LatticeSettings& settings,
    const Uncollided& direct, int channel);

  double Thickest() const { return this->Voxels.thickest; } ///< largest sigma_t h of all ranks
  Lattice& TheLattice() { return *this->Densities; }        ///< requires a block that has voxels
  const LatticeVoxels& TheVoxels() const { return this->Voxels; }

  /// Solves for the steady state or takes steps, depending on the settings.
  void Solve(const Monitor& monitor);
  /// Recomputes the sources after the uncollided light has changed.
  void UpdateSources();
  /// Continues stepping from the current densities. On one rank only.
  void Settle(const StepsBefore& before, const Monitor& monitor);
  /// Adds this rank's fluence, flux and powers, and the convergence rows.
  void AddTo(LightField& light);

private:
  Device& TheDevice;
  const LatticeProblem& Problem;
  const LatticeSettings& Settings;
  const Uncollided& Direct;
  const int Channel;
  LatticeVoxels Voxels;
  std::optional<Lattice> Densities; ///< of the block; none if it has no voxels
  std::vector<float> Fluence;
  std::vector<ConvergenceRow> Rows;
};
}
