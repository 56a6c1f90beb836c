#pragma once

#include "Device/ExactValues.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/Steady/SteadySystem.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"
#include "Medium/Grid.h"

#include <cstddef>

namespace tyndall
{
/// The equations of a steady lattice that lies in one device's memory; its diffusion is solved by multigrid.
class SteadyInMemory : public SteadySystem
{
public:
  /// @param lattice  whose densities are written; all must stay
  SteadyInMemory(Device& device, const Grid& grid, const LatticeSettings& settings, const LatticeVoxels& voxels,
    const Lattice& lattice);

  Values Sweep(const Values& even, double shines, bool writes, const Monitor& monitor) override;
  Values Diffuse(const Values& residual, double unit) override;

private:
  void Load();
  void LoadDiffusion();

  Device& TheDevice;
  const Grid TheGrid;
  const LatticeSettings& Settings;
  const LatticeVoxels& Voxels;
  const Lattice& Densities;
  std::size_t Count;
  ExactValues Straight, Even, Behind, Share, Arriving, Correction;
  Buffer<float> Passes, Squared, Endless;
  MultigridSolver Diffusion;
  double Work = 0.0;
};
}
