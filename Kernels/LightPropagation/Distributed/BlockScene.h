#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Light/LightField.h"
#include "LightPropagation/Problem/SceneUnits.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "Medium/Traits.h"

#include <optional>

namespace tyndall
{
/// All ranks call it together.
/// @throws InvalidInput  on each, where they differ in what all must have alike of a scene
/// @param has  voxels; without any the medium is not looked at
void RequireSame(Communicator& communicator, bool has, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings);

/// A block's scene in the units and channels of all.
struct BlockScene
{
  /// All ranks make one together.
  /// @param has  voxels; without any the medium is not looked at
  /// @param whole  the grid of all
  /// @param medium, illumination  their arrays must stay
  BlockScene(Communicator& communicator, bool has, const Grid& whole, const Medium& medium,
    const Illumination& illumination, const PropagationSettings& settings);
  BlockScene(const BlockScene&) = delete;
  BlockScene& operator=(const BlockScene&) = delete;

  Grid WholeOf(Grid grid) const;      ///< the grid of all, in the unit of length
  void Undo(LightField& light) const; ///< to W and the unit that it was given in

  Medium medium;
  Illumination illumination;
  MediumTraits traits;
  double lengthUnit, powerUnit = 1.0;
  int channels = 1;
  bool sharedExtinction = true;

private:
  std::optional<SceneInLengths> InLengths;
  std::optional<SceneInUnits> InUnits;
};
}
