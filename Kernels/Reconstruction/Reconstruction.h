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

/// The validated light of this rank's box (the block and its halo, PyramidBlocks), and the settings of the
/// reconstruction.
class Reconstruction
{
public:
  /// Copies the halo's light from other ranks and checks all values. Collective.
  /// @param given  light of the rank's block; channels, batches and presence of directions are the same on all ranks
  /// @param directions  whether there are mean directions
  Reconstruction(Device& device, const Domain& domain, const NoisyLight& given, bool directions,
    const ReconstructionSettings& settings, const Monitor& monitor);

  /// Factor for each channel by which the light is scaled to conserve its total. Collective.
  /// @param result  light of the box; its bias is set
  std::array<float, 3> Conserve(ReconstructedLight& result) const;

  /// MakeRoom allocates a result for the box; Crop reduces it to the block.
  ReconstructedLight MakeRoom() const;
  void Crop(ReconstructedLight& result) const;

  /// Runs `step` on ranks that have voxels; errors are collective. Collective.
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

  /// Number of quantities that are smoothed together.
  int Fields() const { return this->light.channels + (this->directions ? 3 : 0); }
  bool IsConservative() const { return this->settings.estimator == ReconstructionSettings::Estimator::Conservative; }

  Device& device;
  const Domain& domain;
  const ReconstructionSettings& settings;
  const Monitor& monitor;
  const bool directions;
  const int levels;                 ///< number of pyramid levels above the whole grid
  const int top;                    ///< the highest level that light is taken from
  const PyramidBlocks blocks;       ///< decomposition of the pyramid
  float largest = 0.0f;             ///< largest value of the light on any rank
  std::array<double, 3> total = {}; ///< total of the light over the domain, per channel

private:
  std::array<std::vector<float>, 4> Storage; ///< memory of `light`, if the box is larger than the block

public:
  const NoisyLight light; ///< light of the box; null where the estimator needs no array

private:
  NoisyLight Gathered(const NoisyLight& given);
  void Check(const NoisyLight& given);
};

/// Computes the mean light of all batches; the detail of each pyramid level is kept as far as the batches agree on it
/// (Estimator::Conservative). Collective.
/// @param result  its arrays must have the size of the box (Reconstruction::MakeRoom)
void ReconstructConservative(const Reconstruction& task, ReconstructedLight& result);

/// Computes the light of each voxel from one level of its pyramid (all other estimators). Collective.
/// @param ownWeights  mean photon weight of each voxel of the block, if the estimator needs it
/// @param result      its arrays must have the size of the box (Reconstruction::MakeRoom)
void ReconstructFromLevels(const Reconstruction& task, const float* ownWeights, ReconstructedLight& result);
}
