#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/CoarseBlocks.h"
#include "Distribution/Domain.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
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

/// A scene refined to voxels of half the edge, with its own arrays: the same medium, for a more accurate solve. A
/// periodic axis of a single voxel is not refined, because nothing varies along it.
class DividedScene
{
public:
  DividedScene(const Medium& medium, const Illumination& illumination, const std::array<bool, 3>& periodic);
  /// Refines one part (block) of a scene.
  /// @param whole  grid of the whole scene
  DividedScene(
    const Medium& part, const Illumination& illumination, const std::array<bool, 3>& periodic, const Grid& whole);
  DividedScene(const DividedScene&) = delete;
  DividedScene& operator=(const DividedScene&) = delete;

  const Medium& TheMedium() const { return this->Divided; }
  const Illumination& Shining() const { return this->Light; }
  double Parts() const; ///< number of refined voxels per voxel
  /// The same partition, in refined voxels.
  /// @param given  partition of the whole scene
  BlockPartition BlocksOf(const BlockPartition& given) const;

  /// Averages the light of the refined scene to the voxels of the original scene, and to the cells of all of the box's
  /// faces.
  void Undo(LightField& light) const;

private:
  Field Repeated(const Field& field);
  void UndoCells(std::vector<float>& values) const;

  Grid Whole, Given; ///< grids of the whole scene and of the part, not refined
  std::array<int, 3> Along;
  Medium Divided;
  Illumination Light;
  std::vector<std::vector<float>> Arrays; ///< owned by this object; the refined scene refers to them
};
}
