#pragma once

#include "Distribution/Halo.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "Lights/UncollidedImage.h"
#include "Medium/Medium.h"

#include <vector>

namespace tyndall
{
/// A rank's block, or another box of voxels that are known to it, among the voxels known around it. Beyond all its
/// faces across periodic axes others lie.
LatticeBox BoxOf(const Halo& around);
LatticeBox BoxOf(const Halo& around, VoxelBox box);

/// A block's medium and index, and uncollided light that is given, with those of the voxels around it.
struct MediumAround
{
  /// All ranks make one together.
  MediumAround(const Halo& voxels, const Medium& own, const Field& ior, const UncollidedImage& image);
  MediumAround(const MediumAround&) = delete;
  MediumAround& operator=(const MediumAround&) = delete;

  Medium medium;
  Field index;
  UncollidedImage uncollided;

private:
  std::vector<float> Absorption, Scattering, Emission, G, Index, Fluence, Directions;
};
}
