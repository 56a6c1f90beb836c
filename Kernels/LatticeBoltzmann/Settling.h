#pragma once

#include "Device/Monitor.h"
#include "LatticeBoltzmann/Lattice.h"
#include "Light/LightField.h"

#include <vector>

namespace tyndall
{
/// Steps that were done already, which count.
struct StepsBefore
{
  int steps = 0;
  double seconds = 0.0;
};

/// Steps a lattice until fluence changes by less than the tolerance, or as often as was asked for.
class Settling
{
public:
  /// @param lattice  of all voxels of `grid`; all must outlive this
  Settling(Device& device, Lattice& lattice, const Grid& grid, const LatticeSettings& settings);

  /// @param rows  of convergence, one for each look at the probes
  /// @return fluence of the last step
  /// @throws InvalidInput where densities have overflowed (explicit collisions of optically thick voxels)
  std::vector<float> Run(const StepsBefore& before, const Monitor& monitor, std::vector<ConvergenceRow>& rows);

private:
  void Step(int steps, double done, const Monitor& monitor);
  double Change();
  double Estimate(double change);

  Device& TheDevice;
  Lattice& TheLattice;
  const LatticeSettings& Settings;
  Buffer<cl_int> Probes;   ///< voxels whose fluence is compared; empty: all
  std::vector<float> Last; ///< fluence at the probes when they were last read
  double LastChange = 0.0;
};
}
