#pragma once

#include "Distribution/CoarseBlocks.h"
#include "LightPropagation/Problem/CoarseScene.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <optional>
#include <vector>

namespace tyndall
{
/// A scene that is spread over ranks by blocks, on the coarse grid of these: of each rank the part of CoarseScene that
/// is its coarse voxels'. One rank has the whole.
class CoarseSceneInBlocks
{
public:
  /// All ranks make one together.
  /// @param medium, illumination  of this rank's block, alike on all ranks in what they have; must stay
  CoarseSceneInBlocks(const CoarseBlocks& blocks, const Medium& medium, const Illumination& illumination);
  CoarseSceneInBlocks(const CoarseSceneInBlocks&) = delete;
  CoarseSceneInBlocks& operator=(const CoarseSceneInBlocks&) = delete;

  const Medium& TheMedium() const { return this->Coarse ? this->Coarse->TheMedium() : this->Nothing; }
  const Illumination& Shining() const { return this->Coarse ? this->Coarse->Shining() : this->Light; }

private:
  Field Around(const CoarseBlocks& blocks, const Field& field);

  Medium Nothing; ///< of a rank without coarse voxels
  Illumination Light;
  std::vector<std::vector<float>> Arrays; ///< of fine voxels of several ranks, while they are averaged
  std::optional<CoarseScene> Coarse;
};
}
