#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/PyramidBlocks.h"
#include "Reconstruction/PhotonReconstruction.h"

#include <array>
#include <vector>

namespace tyndall
{
bool NeedsCounts(ReconstructionSettings::Estimator estimator);  ///< of photons
bool NeedsWeights(ReconstructionSettings::Estimator estimator); ///< of photons

/// Light that was checked, of this rank's box (PyramidBlocks), and what reconstructs it.
class Reconstruction
{
public:
  /// Gathers the light of the box, and checks its values. Collective.
  /// @param given  of the rank's block; channels, batches and whether there are directions the same on all ranks
  /// @param directions  whether there are directions
  Reconstruction(Device& device, const Domain& domain, const NoisyLight& given, bool directions,
    const ReconstructionSettings& settings, const Monitor& monitor);

  /// What the block's light is scaled by in each channel. Collective.
  /// @param result  of the box; its bias is set
  std::array<float, 3> Conserve(ReconstructedLight& result) const;

  /// A result whose arrays have the sizes of the box, and one that has become that of the block.
  ReconstructedLight MakeRoom() const;
  void Crop(ReconstructedLight& result) const;

  /// Runs `step` on ranks that have voxels. Collective.
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

  /// Quantities that are smoothed together.
  int Fields() const { return this->light.channels + (this->directions ? 3 : 0); }
  bool IsConservative() const { return this->settings.estimator == ReconstructionSettings::Estimator::Conservative; }

  Device& device;
  const Domain& domain;
  const ReconstructionSettings& settings;
  const Monitor& monitor;
  const bool directions;
  const int levels;                 ///< of the pyramid above the whole grid
  const int top;                    ///< the highest of them that light is taken from
  const PyramidBlocks blocks;       ///< of the pyramid
  float largest = 0.0f;             ///< value of the light on any rank
  std::array<double, 3> total = {}; ///< of the light over the domain, by channel

private:
  std::array<std::vector<float>, 4> Storage; ///< of `light`, where a box is larger than its block

public:
  const NoisyLight light; ///< of the box; null what the estimator does not need

private:
  NoisyLight Gathered(const NoisyLight& given);
  void Check(const NoisyLight& given);
};
}
