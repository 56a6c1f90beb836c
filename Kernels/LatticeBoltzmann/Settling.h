#pragma once

#include "Device/Monitor.h"
#include "LatticeBoltzmann/Lattice.h"
#include "Light/LightField.h"

#include <vector>

namespace tyndall
{
/// Steps until little changes, or as many as were asked for.
class Settling
{
public:
  Settling(Device& device, Lattice& lattice, const Grid& grid, const LatticeSettings& settings);

  /// @param done  steps that were done before, which count
  /// @return fluence of the last step
  std::vector<float> Run(int done, const Monitor& monitor, std::vector<ConvergenceRow>& rows);

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
