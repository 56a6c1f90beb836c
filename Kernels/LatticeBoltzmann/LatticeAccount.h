#pragma once

#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeScene.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "Light/LightField.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// Rows of one channel to those of all.
void AddRows(const std::vector<ConvergenceRow>& rows, LightField& light);

/// Where the light of one channel of a lattice is and where its power went: of the lattice's own voxels.
class LatticeAccount
{
public:
  /// All of it must stay.
  /// @param direct, voxels  by known voxel
  LatticeAccount(const LatticeScene& scene, const LatticeBox& box, const LatticeSettings& settings,
    const Uncollided& direct, const LatticeVoxels& voxels, Lattice& lattice, int channel)
    : Scene(scene)
    , Box(box)
    , Settings(settings)
    , Direct(direct)
    , Voxels(voxels)
    , Photons(lattice)
    , Channel(static_cast<std::size_t>(channel))
  {
  }

  /// Adds scattered light beside the uncollided one, face powers, and all of the balance but what is left over.
  /// @param fluence  of the lattice, by its voxels
  void AddTo(LightField& light, const std::vector<float>& fluence) const;

private:
  std::size_t Place(const LightField& light, std::size_t voxel) const
  {
    return voxel * static_cast<std::size_t>(light.channels) + this->Channel;
  }
  double Edge() const { return this->Scene.medium.grid.spacing[0]; }
  double CountVoxels(LightField& light, const std::vector<float>& fluence) const;
  double CountFaces(LightField& light) const;
  void AddFlux(LightField& light) const;
  double FluxOfCrossing(std::size_t known, std::size_t face) const;

  const LatticeScene Scene;
  const LatticeBox& Box;
  const LatticeSettings& Settings;
  const Uncollided& Direct;
  const LatticeVoxels& Voxels;
  Lattice& Photons;
  const std::size_t Channel;
};
}
