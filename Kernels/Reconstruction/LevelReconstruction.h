#pragma once

#include "Reconstruction/LightPyramid.h"
#include "Reconstruction/Reconstruction.h"
#include "Reconstruction/WholeRows.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// What an estimator is told of photons, beside the light: 0 voxels where it needs none.
struct PhotonsOfVoxels
{
  PhotonsOfVoxels(const Reconstruction& task);

  HostMappedBuffer<float> counts, weights;
};

/// Photons' weights of some voxels.
struct WeightsOfVoxels
{
  WeightsOfVoxels() = default;
  explicit WeightsOfVoxels(const float* values, std::size_t voxels);

  double total = 0.0, lit = 0.0; ///< voxels
};

/// The weight of photons from a level to the next: where it is not given the mean weight of lit voxels, less than
/// marching rounds weights to, so that equal ones all reach the first step.
double WeightStepOf(const ReconstructionSettings& settings, const WeightsOfVoxels& weights);

/// The highest level that light is taken from, of `levels` above the grid.
int TopLevelOf(const ReconstructionSettings& settings, int levels);

/// Fields of the pyramids that an estimator looks at: of light and its directions, of photon counts, of their weights.
std::vector<int> FieldsOfPyramids(ReconstructionSettings::Estimator estimator, int channels, bool directions);

/// Takes the light of each voxel from one level of its pyramid (the estimators other than the conservative one). Done
/// one after the other the passes are the whole of it.
class LevelPasses
{
public:
  /// @param task    whose levels go up to task.levels; must stay, as photons and the result must
  /// @param result  its arrays have their sizes
  /// @param width   of kernels' rows (RowWidth of all of the grid)
  /// @param part    of a larger grid, in blocks
  LevelPasses(const Reconstruction& task, const PhotonsOfVoxels& photons, ReconstructedLight& result, int width,
    const PartOfPyramid& part = {});

  void Build(); ///< pyramids, as far as they are of the task's own grid
  /// Of a part of a grid: cells of a pyramid's shared level, and the same of all of the grid.
  std::vector<float> Shared(std::size_t pyramid) const { return this->Pyramids[pyramid].Read(this->Part.shared); }
  void BuildAbove(std::size_t pyramid, const std::vector<float>& cells);

  void Choose(double weightStep); ///< light, levels and directions of the result, before they are scaled
  void Conserve();                ///< scales the light as the task says

private:
  void Fill(std::size_t pyramid, const HostMappedBuffer<float>& array, int components, int first, const char* what);
  void InParts(const cl::Kernel& kernel) const;
  cl::Kernel Kernel(const char* name) const;

  const Reconstruction& Task;
  const PhotonsOfVoxels& Photons;
  ReconstructedLight& Result;
  const std::array<int, 3>& Size;
  bool HasDirections, Published, ConstantRadius;
  int Top;
  RowKernels Kernels;
  const PartOfPyramid Part;
  std::vector<LightPyramid> Pyramids; ///< those of FieldsOfPyramids
  HostMappedBuffer<float> Fluence;
};
}
