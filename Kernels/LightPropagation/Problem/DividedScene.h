#pragma once

#include "Distribution/BlockPartition.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <vector>

namespace tyndall
{
/// A scene in voxels of half the edge, with arrays of its own: the same medium, solved more exactly. An axis of a
/// single voxel that is periodic stays one: nothing varies along it.
class DividedScene
{
public:
  DividedScene(const Medium& medium, const Illumination& illumination, const std::array<bool, 3>& periodic);
  /// Of a part of a scene.
  /// @param whole  the grid of all
  DividedScene(
    const Medium& part, const Illumination& illumination, const std::array<bool, 3>& periodic, const Grid& whole);
  DividedScene(const DividedScene&) = delete;
  DividedScene& operator=(const DividedScene&) = delete;

  const Medium& TheMedium() const { return this->Divided; }
  const Illumination& Shining() const { return this->Light; }
  double Parts() const; ///< voxels that each is divided into
  /// The same blocks in divided voxels.
  /// @param given  of the whole
  BlockPartition BlocksOf(const BlockPartition& given) const;

  /// Light of the divided scene as that of the scene: means over its voxels, and over the cells of all of the box's
  /// faces.
  void Undo(LightField& light) const;

private:
  Field Repeated(const Field& field);
  void UndoCells(std::vector<float>& values) const;

  Grid Whole, Given; ///< of all, and of the part
  std::array<int, 3> Along;
  Medium Divided;
  Illumination Light;
  std::vector<std::vector<float>> Arrays; ///< that the scene sees
};
}
