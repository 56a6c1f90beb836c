#pragma once

#include "Distribution/CoarseBlocks.h"
#include "LightPropagation/Accuracy/PreviewLight.h"

#include <array>
#include <vector>

namespace tyndall
{
/// A decomposed scene on the coarse grid, gathered on the first rank that has fine voxels. Constructor and Spread are
/// collective.
class SceneOnFirst
{
public:
  /// @param own  scene of this rank's coarse voxels, with the same kinds of fields on all ranks; not read on a rank
  ///   without coarse voxels
  /// @param fine  medium of this rank's block, which provides the phase function of the domain
  SceneOnFirst(const CoarseBlocks& blocks, const PreviewScene& own, const Medium& fine);
  SceneOnFirst(const SceneOnFirst&) = delete;
  SceneOnFirst& operator=(const SceneOnFirst&) = delete;

  bool IsHere() const { return this->Here; }
  /// The gathered scene; valid on that rank only.
  PreviewScene Whole() const { return { this->TheMedium, this->Light, this->Index }; }

  /// Distributes the light that the first rank computed: fluence and its uncollided part to the owners of the coarse
  /// voxels, and global data (balance, powers, convergence, messages) to all ranks.
  void Spread(LightField& light) const;

private:
  Field Gathered(const Field& own, int components, std::vector<float>& values) const;

  const CoarseBlocks& Blocks;
  const bool Here;
  std::vector<VoxelBox> Boxes; ///< by rank: all coarse voxels on one rank, none on the rest
  Medium TheMedium;
  Illumination Light;
  Field Index;
  std::array<std::vector<float>, 7> Arrays;
};
}
