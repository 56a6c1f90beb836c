#pragma once

#include "Device/Monitor.h"
#include "LatticeBoltzmann/Lattice.h"
#include "Light/LightField.h"

#include <vector>

namespace tyndall
{
/// Steps that were taken before and count towards the limits.
struct StepsBefore
{
  int steps = 0;
  double seconds = 0.0;
};

/// Steps a lattice until the estimated error of the fluence is below the tolerance, or for a given number of steps.
class Settling
{
public:
  /// @param lattice  covers all voxels of `grid`; all arguments must outlive this
  Settling(Device& device, Lattice& lattice, const Grid& grid, const LatticeSettings& settings);

  /// @param rows  receives one convergence row per check of the probes
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
}
