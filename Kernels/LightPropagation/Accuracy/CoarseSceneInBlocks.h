#pragma once

#include "Distribution/CoarseBlocks.h"
#include "LightPropagation/Problem/CoarseScene.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <optional>
#include <vector>

namespace tyndall
{
/// A decomposed scene averaged to the coarse grid of its blocks: on each rank the part of CoarseScene for its coarse
/// voxels. A single rank has the whole scene.
class CoarseSceneInBlocks
{
public:
  /// Collective.
  /// @param medium, illumination  of this rank's block, with the same kinds of fields on all ranks; must outlive this
  CoarseSceneInBlocks(const CoarseBlocks& blocks, const Medium& medium, const Illumination& illumination);
  CoarseSceneInBlocks(const CoarseSceneInBlocks&) = delete;
  CoarseSceneInBlocks& operator=(const CoarseSceneInBlocks&) = delete;

  const Medium& TheMedium() const { return this->Coarse ? this->Coarse->TheMedium() : this->Nothing; }
  const Illumination& Shining() const { return this->Coarse ? this->Coarse->Shining() : this->Light; }

private:
  Field Around(const CoarseBlocks& blocks, const Field& field);

  Medium Nothing; ///< medium of a rank without coarse voxels
  Illumination Light;
  std::vector<std::vector<float>> Arrays; ///< fine voxels gathered from several ranks for averaging
  std::optional<CoarseScene> Coarse;
};
}
