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
  /// @param fine  of this rank's block, with the same kinds of fields on all ranks
  CoarseScene(const CoarseBlocks& blocks, const SceneBlock& fine);
  CoarseScene(const SceneBlock& fine, const Grid& coarse)
    : CoarseScene(CoarseBlocks(fine.domain.Comm(), fine.domain.Partition(), coarse), fine)
  {
  }
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

/// Fine voxels per coarse voxel along each axis, at least 1.
using Factors = std::array<int, 3>;
Grid Refined(const Grid& coarse, const Factors& factors);
/// Copies each coarse value to all of its fine voxels.
/// @param values  `components` per voxel of `coarse`, x fastest
std::vector<float> Repeated(const float* values, int components, const Grid& coarse, const Factors& factors);

/// A scene on a finer grid, with its own arrays: the same medium, for a more accurate solve.
class DividedScene
{
public:
  /// @param scene  its fields, but not its index, are repeated; must outlive this
  /// @param parts  of an edge of the voxels
  DividedScene(const SceneBlock& scene, const Factors& parts);
  DividedScene(const DividedScene&) = delete;
  DividedScene& operator=(const DividedScene&) = delete;

  /// Halves each edge, except along periodic axes of a single voxel, on which nothing varies.
  static Factors Halves(const Grid& whole, const std::array<bool, 3>& periodic);

  SceneBlock Scene() const { return { this->TheDomain, this->Divided, this->Light }; }

  /// Averages the light of the refined scene to the voxels of the original scene, and to the cells of all of the box's
  /// faces.
  void Undo(LightField& light) const;

private:
  Field Repeated(const Field& field);
  void UndoCells(std::vector<float>& values) const;

  Grid Whole, Given; ///< grids of the whole scene and of this rank's block, not refined
  Factors Along;
  Domain TheDomain;
  Medium Divided;
  Illumination Light;
  std::deque<std::vector<float>> Arrays; ///< the fields refer to them
};
}
