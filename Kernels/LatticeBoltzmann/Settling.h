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

/// Steps until little changes, or as many as were asked for.
class Settling
{
public:
  Settling(Device& device, Lattice& lattice, const Grid& grid, const LatticeSettings& settings);

  /// @return fluence of the last step
  std::vector<float> Run(const StepsBefore& before, const Monitor& monitor, std::vector<ConvergenceRow>& rows);

private:
  double Change();
  double Estimate(double change);
  void Step(int steps, double done, const Monitor& monitor);

  Device& TheDevice;
  Lattice& TheLattice;
  const LatticeSettings& Settings;
  Buffer<cl_int> Places;   ///< voxels that are looked at; empty: all
  std::vector<float> Last; ///< their fluence when it was looked at last
  double LastChange = 0.0;
};
}
