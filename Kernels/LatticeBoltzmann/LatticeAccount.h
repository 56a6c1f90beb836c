#pragma once

#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "Light/LightField.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// Fluence, flux and energy balance of one channel, computed from the lattice densities of this rank's own voxels.
class LatticeAccount
{
public:
  /// All arguments must outlive this.
  /// @param direct, voxels  by known voxel
  LatticeAccount(const LatticeProblem& problem, const LatticeSettings& settings, const Uncollided& direct,
    const LatticeVoxels& voxels, Lattice& lattice, int channel)
    : TheMedium(problem.TheMedium())
    , Box(problem.Box())
    , Settings(settings)
    , Direct(direct)
    , Voxels(voxels)
    , Photons(lattice)
    , Channel(static_cast<std::size_t>(channel))
  {
  }

  /// Adds scattered and uncollided light, face powers, and all terms of the energy balance but leftOver.
  /// @param fluence  lattice fluence by own voxel
  void AddTo(LightField& light, const std::vector<float>& fluence) const;

private:
  std::size_t Place(const LightField& light, std::size_t voxel) const
  {
    return voxel * static_cast<std::size_t>(light.channels) + this->Channel;
  }
  double Edge() const { return this->TheMedium.grid.spacing[0]; }
  double CountVoxels(LightField& light, const std::vector<float>& fluence) const;
  double CountFaces(LightField& light) const;
  void AddFlux(LightField& light) const;
  double FluxOfCrossing(std::size_t known, std::size_t face) const;

  const Medium& TheMedium;
  const LatticeBox& Box;
  const LatticeSettings& Settings;
  const Uncollided& Direct;
  const LatticeVoxels& Voxels;
  Lattice& Photons;
  const std::size_t Channel;
};
}
