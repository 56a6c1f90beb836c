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
/// Medium, light and illumination as they are on the device, ready for pictures.
struct CasterScene
{
  InputsKey key;
  vtkTimeStamp made;
  Grid grid;
  bool lightsAlone = false;        ///< there is no fluence, so shadow rays are needed
  std::vector<std::string> doubts; ///< not said yet
  std::vector<VoxelBox> held;      ///< by rank, the voxels of casters of blocks
  std::unique_ptr<MediumRayCaster> caster;
};

/// @param ior      refractive index of each voxel; of a block of those that it says
/// @param ofScene  where the medium is a block whose pictures are those of the whole: that block
std::unique_ptr<CasterScene> MakeScene(const ViewedInputs& viewed, const Field& ior, const Illumination& illumination,
  const InputsKey& key, ViewSettings settings, const BlockOfScene* ofScene);

/// What ranks with a piece of the medium each know when they make their scenes.
struct RankPieces
{
  vtkMediumRayCaster* filter;
  Communicator& communicator;
  const BlocksOfRanks& blocks;
  vtkImageData* image; ///< the piece
  const Illumination& illumination;
  ViewSettings settings;

  bool HasOwn() const { return this->blocks.HasOwn(); }
};

/// What this rank's block is seen by: its voxels and layers of its neighbours', from them, where it has not been given
/// these. All ranks call it.
/// @param held  becomes, by rank, the voxels of the casters
/// @return null where it has no block
/// @throws  on all ranks what one of them throws
std::unique_ptr<CasterScene> MakeSceneOfBlock(
  const RankPieces& pieces, const InputsKey& key, std::vector<VoxelBox>& held);
}
