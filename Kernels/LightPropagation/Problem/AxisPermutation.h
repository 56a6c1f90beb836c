#pragma once

#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

#include <array>

namespace tyndall
{
/// A plane-parallel slab with its layers along x: rows of voxels are then as long as the slab, where rows of one voxel
/// fill a tenth of a vector, and a slab of 1024 layers along z takes twenty times as long. Axes are renamed in their
/// cyclic order, so arrays over the voxels, and over the cells of one face, stay as they are.
class AxisPermutation
{
public:
  /// Of slabs along y and z (UnvaryingAxes.h) that no environment shines on: its pixels know only one up.
  AxisPermutation(const Grid& grid, const Illumination& illumination, const PropagationSettings& settings);

  explicit operator bool() const { return this->Along != 0; }

  Medium Of(const Medium& medium) const; ///< sees the same arrays
  Illumination Of(const Illumination& illumination) const;
  PropagationSettings Of(const PropagationSettings& settings) const;

  /// The light of the turned scene as that of the scene as it stands.
  void Undo(LightField& light, const Grid& grid) const;

private:
  template <class Value>
  std::array<Value, 3> Turned(const std::array<Value, 3>& given) const;
  template <class Value>
  std::array<Value, 3> TurnedBack(const std::array<Value, 3>& turned) const;
  int FaceWhenTurned(int face) const;
  void TurnBackCells(std::vector<float>& values, const Grid& grid) const;
  void TurnBackMoments(LightField& light, const Grid& grid) const;

  int Along = 0; ///< axis of the layers
};
}
