#pragma once

#include "Distribution/BlockPartition.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <vector>

namespace tyndall
{
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
