#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/CoarseBlocks.h"
#include "Distribution/Domain.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <deque>
#include <vector>

namespace tyndall
{
/// One rank's part of a scene: the domain, and the fields over the voxels of this rank's subdomain. Medium and
/// illumination must outlive this object.
struct SceneBlock
{
  Domain domain;
  const Medium& medium;
  const Illumination& illumination;
  Field index = {}; ///< a further quantity by voxel, such as the refractive index; may have no values
  /// Light of the last solve of this scene, with which the next one starts and which it replaces (WarmStart); null, on
  /// all ranks: none is kept.
  KeptLight* kept = nullptr;
};

/// A scene averaged to a coarser grid over the same box. Coefficients are means over the coarse voxels, g is weighted
/// by sigma_s. Uncollided light that is given per voxel is averaged such that the medium removes the same power from
/// it.
class CoarseScene
{
public:
  /// Averages a scene. Collective.
  /// @param fine  scene on the fine grid, with values in the same fields on all ranks
  CoarseScene(const CoarseBlocks& blocks, const SceneBlock& fine);
  CoarseScene(const SceneBlock& fine, const Grid& coarse)
    : CoarseScene(CoarseBlocks(fine.domain.Comm(), fine.domain.Partition(), coarse), fine)
  {
  }
  CoarseScene(const CoarseScene&) = delete;
  CoarseScene& operator=(const CoarseScene&) = delete;

  /// This rank's coarse voxels. On a rank without coarse voxels the arrays of medium and light are empty.
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
  std::deque<std::vector<float>> Means; ///< arrays to which the fields of the coarse scene refer
};

/// Number of fine voxels per coarse voxel along each axis, at least 1.
using Factors = std::array<int, 3>;
/// Grid over the same box with `factors` voxels per voxel of `coarse` along each axis.
Grid Refined(const Grid& coarse, const Factors& factors);
/// Copies each coarse value to all of its fine voxels.
/// @param values  values by voxel of `coarse`, x fastest, `components` each
std::vector<float> Repeated(const float* values, int components, const Grid& coarse, const Factors& factors);

/// A scene on a finer grid over the same box, with the same medium, for a more accurate solve.
class DividedScene
{
public:
  /// @param scene  scene to refine; each fine voxel gets the values of the voxel that contains it, but
  ///   SceneBlock::index is dropped. Must outlive this object
  /// @param parts  number of fine voxels per voxel along each axis
  DividedScene(const SceneBlock& scene, const Factors& parts);
  DividedScene(const DividedScene&) = delete;
  DividedScene& operator=(const DividedScene&) = delete;

  /// Factors that halve each edge of a voxel, except along periodic axes of a single voxel, along which nothing varies.
  static Factors Halves(const Grid& whole, const std::array<bool, 3>& periodic);

  SceneBlock Scene() const { return { this->TheDomain, this->Divided, this->Light }; }

  /// Averages the light of the refined scene over the voxels of the original scene, and over the face cells of its box.
  void Undo(LightField& light) const;

private:
  Field Repeated(const Field& field);
  void UndoCells(std::vector<float>& values) const;

  Grid Whole, Given; ///< original grids of the domain and of this rank's subdomain
  Factors Along;
  Domain TheDomain;
  Medium Divided;
  Illumination Light;
  std::deque<std::vector<float>> Arrays; ///< arrays to which the fields of the fine scene refer
};
}
