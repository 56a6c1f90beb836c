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
/// One voxel of vacuum, which stands for the medium of a rank whose block has no voxels. Its results are not counted.
Medium VoxelOfVacuum(const Grid& whole);

/// Scene of a block, in units and channels that are the same on all ranks.
struct BlockScene
{
  /// Collective.
  /// @param has  the block has voxels; if not, the medium is not read
  /// @param medium, illumination  their arrays must outlive this
  /// @param memory  of this rank's device, which limits the degree of angular moments if the settings leave it open
  BlockScene(Communicator& communicator, bool has, const BlockPartition& partition, const Medium& medium,
    const Illumination& illumination, const PropagationSettings& settings, const DeviceMemory& memory);
  BlockScene(const BlockScene&) = delete;
  BlockScene& operator=(const BlockScene&) = delete;

  Grid WholeOf(Grid grid) const;      ///< `grid` in the scene's unit of length
  void Undo(LightField& light) const; ///< converts light back to W and the original unit of length
  const TruncatedScattering& Scattering() const
  {
    return *this->Truncated;
  } ///< delta-M-truncated scattering that the sweeps use

  Medium medium;
  Illumination illumination;
  MediumTraits traits;
  double lengthUnit, powerUnit = 1.0;
  int channels = 1;
  bool sharedExtinction = true;
  bool given = false; ///< any rank has illumination.uncollided

private:
  void Truncate(Communicator& communicator, const BlockPartition& partition, const PropagationSettings& settings,
    const DeviceMemory& memory);

  std::optional<SceneInLengths> InLengths;
  std::optional<SceneInUnits> InUnits;
  std::optional<TruncatedScattering> Truncated;
};
}
