#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Light/LightField.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/SceneUnits.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "Medium/Traits.h"

#include <array>
#include <optional>

namespace tyndall
{
/// A medium for a rank whose block has no voxels: what is found there counts nowhere.
Medium VoxelOfVacuum(const Grid& whole);

/// A block's scene in the units and channels of all.
struct BlockScene
{
  /// All ranks make one together.
  /// @param has  voxels; without any the medium is not looked at
  /// @param medium, illumination  their arrays must stay
  /// @param memory  of this rank, for angular moments, where the settings leave open how many
  BlockScene(Communicator& communicator, bool has, const BlockPartition& partition, const Medium& medium,
    const Illumination& illumination, const PropagationSettings& settings, const DeviceMemory& memory);
  BlockScene(const BlockScene&) = delete;
  BlockScene& operator=(const BlockScene&) = delete;

  Grid WholeOf(Grid grid) const;                                             ///< the grid of all, in the unit of length
  void Undo(LightField& light) const;                                        ///< to W and the unit that it was given in
  const TruncatedScattering& Scattering() const { return *this->Truncated; } ///< as sweeps carry it

  Medium medium;
  Illumination illumination;
  MediumTraits traits;
  double lengthUnit, powerUnit = 1.0;
  int channels = 1;
  bool sharedExtinction = true;
  bool given = false; ///< uncollided light is, on any rank, by illumination.uncollided

private:
  void Truncate(Communicator& communicator, const BlockPartition& partition, const PropagationSettings& settings,
    const DeviceMemory& memory);

  std::optional<SceneInLengths> InLengths;
  std::optional<SceneInUnits> InUnits;
  std::optional<TruncatedScattering> Truncated;
};
}
