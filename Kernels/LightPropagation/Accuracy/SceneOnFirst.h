#pragma once

#include "Distribution/CoarseBlocks.h"
#include "LightPropagation/Accuracy/PreviewLight.h"

#include <array>
#include <vector>

namespace tyndall
{
/// A scene on the coarse grid of blocks, whole on the first rank that has fine voxels. All ranks make one together, and
/// call Spread.
class SceneOnFirst
{
public:
  /// @param own  of this rank's coarse voxels, alike on all ranks in what it has; its medium is not looked at where
  ///   there are none
  /// @param fine  of this rank's block, whose phase function that of the whole is
  SceneOnFirst(const CoarseBlocks& blocks, const PreviewScene& own, const Medium& fine);
  SceneOnFirst(const SceneOnFirst&) = delete;
  SceneOnFirst& operator=(const SceneOnFirst&) = delete;

  bool IsHere() const { return this->Here; }
  /// On that rank.
  PreviewScene Whole() const { return { this->TheMedium, this->Light, this->Index }; }

  /// Light that the first rank found, to all: fluence and its direct part of their own coarse voxels, and what is told
  /// of all of it (balance, powers, convergence, words).
  void Spread(LightField& light) const;

private:
  Field Gathered(const Field& own, int components, std::vector<float>& values) const;

  const CoarseBlocks& Blocks;
  const bool Here;
  std::vector<VoxelBox> Boxes; ///< by rank: all coarse voxels, or none
  Medium TheMedium;
  Illumination Light;
  Field Index;
  std::array<std::vector<float>, 7> Arrays;
};
}
