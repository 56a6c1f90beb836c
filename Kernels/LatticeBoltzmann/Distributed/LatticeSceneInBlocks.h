#pragma once

#include "Device/Device.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/Halo.h"
#include "LatticeBoltzmann/Distributed/MediumAround.h"
#include "LatticeBoltzmann/LatticeScene.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Light/LightField.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Field.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// As AsPropagation; light diffuses, whatever its angles.
PropagationSettings AsPropagationInBlocks(const LatticeSettings& settings);

/// What a lattice over ranks is solved of, in the units and channels of all: a rank's block and the voxels around it.
struct LatticeSceneInBlocks
{
  /// All ranks make one together. What is given must stay.
  /// @param medium, ior, illumination  of the rank's block; looked at by nobody where that has no voxels
  LatticeSceneInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
    const Medium& medium, const Field& ior, const Illumination& illumination, const LatticeSettings& settings);
  LatticeSceneInBlocks(const LatticeSceneInBlocks&) = delete;
  LatticeSceneInBlocks& operator=(const LatticeSceneInBlocks&) = delete;

  LatticeScene OfKnown() const { return { this->scene.medium, this->scene.illumination, this->scene.channels }; }
  LatticeBox Box() const; ///< the rank's block among the known voxels

  const bool has; ///< voxels
  const Halo around;
  const MediumAround known;
  const BlockScene scene;
  const BlockPartition partition; ///< in the units of the scene
};

/// FinishLight (LatticeLight.h) of a rank's light: balance and face powers of all ranks, in the user's units. All ranks
/// call it.
/// @param illumination  as given
/// @param lost  Uncollided::lost of this rank
void FinishLight(LightField& light, const Device& device, Communicator& communicator, const LatticeSceneInBlocks& scene,
  const Illumination& illumination, const LatticeSettings& settings, double thickest, const Rgb& lost = {});
}
