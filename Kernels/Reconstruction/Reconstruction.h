#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/PyramidBlocks.h"
#include "Reconstruction/PhotonReconstruction.h"

#include <array>
#include <vector>

namespace tyndall
{
bool NeedsCounts(ReconstructionSettings::Estimator estimator);  ///< whether the estimator needs photon counts
bool NeedsWeights(ReconstructionSettings::Estimator estimator); ///< whether the estimator needs photon weights

/// Task of the reconstruction on one rank: the settings, and the checked light of the rank's box. The box is the rank's
/// block and the halo on which the result in the block depends (PyramidBlocks).
class Reconstruction
{
public:
  /// Copies the halo's light from other ranks, and checks all values. Collective.
  /// @param given  light of this rank's block; channels, batches and presence of directions are the same on all ranks
  /// @param directions  whether the light has mean directions
  Reconstruction(Device& device, const Domain& domain, const NoisyLight& given, bool directions,
    const ReconstructionSettings& settings, const Monitor& monitor);

  /// Computes the factor of each channel by which the light is scaled to conserve its total, and sets the result's
  /// bias. Collective.
  /// @param result  light of this rank's box (block and halo)
  std::array<float, 3> Conserve(ReconstructedLight& result) const;

  /// Allocates a result with arrays of the size of the box (block and halo).
  ReconstructedLight MakeRoom() const;
  void Crop(ReconstructedLight& result) const; ///< reduces the result's arrays from the box to the block

  /// Runs `step` on ranks that have voxels; an error on one rank is raised on all. Collective.
  template <class Step>
  void OnVoxels(const Step& step) const
  {
    this->domain.Collective([&] {
      if (!this->domain.IsEmpty())
      {
        step();
      }
    });
  }

  /// Number of quantities that are smoothed together: channels and components of the flux.
  int Fields() const { return this->light.channels + (this->directions ? 3 : 0); }
  bool IsConservative() const { return this->settings.estimator == ReconstructionSettings::Estimator::Conservative; }

  Device& device;
  const Domain& domain;
  const ReconstructionSettings& settings;
  const Monitor& monitor;
  const bool directions;
  const int levels;                 ///< number of pyramid levels above the grid of the domain
  const int top;                    ///< highest pyramid level from which light is taken
  const PyramidBlocks blocks;       ///< decomposition of the pyramid among ranks
  float largest = 0.0f;             ///< largest value of the light on any rank
  std::array<double, 3> total = {}; ///< total of the light over the domain, for each channel

private:
  /// Memory of the arrays of `light`. Empty if the box is the block: `light` then refers to the caller's arrays.
  std::array<std::vector<float>, 4> Storage;

public:
  const NoisyLight light; ///< light of the box (block and halo); arrays that the estimator does not need are null

private:
  NoisyLight Gathered(const NoisyLight& given);
  void Check(const NoisyLight& given);
};

/// Computes light by the conservative estimator. The detail of a pyramid level is the level minus the interpolation of
/// the next coarser one. The estimator keeps each detail of the batches' mean light as far as the batches agree on it.
/// Collective.
/// @param result  arrays must have the size of the box (Reconstruction::MakeRoom)
void ReconstructConservative(const Reconstruction& task, ReconstructedLight& result);

/// Computes the light of each voxel from one level of its pyramid (all estimators except the conservative one).
/// Collective.
/// @param ownWeights  mean photon weight in each voxel of the block, if the estimator needs it
/// @param result      arrays must have the size of the box (Reconstruction::MakeRoom)
void ReconstructFromLevels(const Reconstruction& task, const float* ownWeights, ReconstructedLight& result);
}
