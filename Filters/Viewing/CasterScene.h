#pragma once

#include "BlocksOfRanks.h"
#include "Common/InputsKey.h"
#include "Distribution/Communicator.h"
#include "Lights/Lights.h"
#include "ViewedInputs.h"
#include "Viewing/MediumRayCaster.h"

#include "vtkTimeStamp.h"

#include <memory>
#include <string>
#include <vector>

class vtkImageData;
class vtkMediumRayCaster;

namespace tyndall
{
/// Medium, light and illumination on the device, ready for rendering.
struct CasterScene
{
  InputsKey key;
  vtkTimeStamp made;
  Grid grid;
  bool lightsAlone = false;        ///< there is no fluence, so shadow rays are needed
  std::vector<std::string> doubts; ///< warnings not issued yet
  std::vector<VoxelBox> held;      ///< by rank, the voxels that the rank's ray caster holds
  std::unique_ptr<MediumRayCaster> caster;
};

/// @param ior  refractive index of each voxel; of a block, in the voxels that `ofScene` says
/// @param ofScene  the block of the scene that the medium is, rendered as part of the whole; null if it is no block
std::unique_ptr<CasterScene> MakeScene(const ViewedInputs& viewed, const Field& ior, const Illumination& illumination,
  const InputsKey& key, ViewSettings settings, const BlockOfScene* ofScene);

/// What each rank knows when ranks with one piece of the medium each prepare their scenes.
struct RankPieces
{
  vtkMediumRayCaster* filter;
  Communicator& communicator;
  const BlocksOfRanks& blocks;
  vtkImageData* image; ///< this rank's piece
  const Illumination& illumination;
  ViewSettings settings;

  bool HasOwn() const { return this->blocks.HasOwn(); }
};

/// Prepares the scene of this rank's block: its voxels and a halo, which is fetched from the neighbours if the input
/// has none. Collective.
/// @param held  set to the voxels that each rank's ray caster holds, by rank
/// @return null if this rank has no block
/// @throws on all ranks, if on one
std::unique_ptr<CasterScene> MakeSceneOfBlock(
  const RankPieces& pieces, const InputsKey& key, std::vector<VoxelBox>& held);
}
