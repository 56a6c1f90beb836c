#pragma once

#include "Distribution/CoarseBlocks.h"
#include "Distribution/Domain.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <deque>
#include <vector>

namespace tyndall
{
/// A scene as one rank holds it. Medium and illumination must outlive it; fields over voxels are of the rank's block.
struct SceneBlock
{
  Domain domain;
  const Medium& medium;
  const Illumination& illumination;
  Field index = {}; ///< another quantity by voxel, such as the refractive index; may have no values
};

/// A scene averaged to a coarser grid over the same box, with its own arrays. Coefficients are means over the coarse
/// voxels, g weighted by sigma_s. Uncollided light that is given by voxel is averaged so that the power the medium
/// takes from it is conserved.
class CoarseScene
{
public:
  /// Collective.
  /// @param blocks  must outlive this
  /// @param fine  of this rank's block, with the same kinds of fields on all ranks; its domain must outlive this
  CoarseScene(const CoarseBlocks& blocks, const SceneBlock& fine);
  CoarseScene(const CoarseScene&) = delete;
  CoarseScene& operator=(const CoarseScene&) = delete;

  /// This rank's coarse voxels; the medium and light by voxel of a rank without coarse voxels have no values.
  SceneBlock Scene() const { return { this->TheDomain, this->Averaged, this->Light, this->Index }; }

private:
  void AverageMedium(const Coarsening& coarsening);
  void AverageGivenLight(const Medium& fine, const Coarsening& coarsening);
  Field AveragedFluence(const Medium& fine, const Field& fluence, const Coarsening& coarsening);
  Field AveragedDirections(const Field& mean, const Field& fluence, const Coarsening& coarsening);

  Domain TheDomain;
  Medium Averaged;
  Illumination Light;
  Field Index;
  std::deque<std::vector<float>> Means; ///< the fields refer to them
};
}
