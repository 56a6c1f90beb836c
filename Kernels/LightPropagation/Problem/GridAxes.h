#pragma once

#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

#include <array>

namespace tyndall
{
/// Permutes the axes of a plane-parallel slab so that its layers are stacked along x. Rows of voxels are then as long
/// as the slab; rows of one voxel would use only a tenth of each SIMD operation, and a slab of 1024 layers would take
/// twenty times as long. Axes are permuted cyclically, so arrays over the voxels, and over the cells of one face, stay
/// unchanged in memory.
class AxisPermutation
{
public:
  /// Finds the permutation. There is one only for slabs with layers along y or z (UnvaryingAxes), and only without an
  /// environment, because its pixels have a fixed up direction. Otherwise the object converts to false.
  AxisPermutation(const Grid& grid, const Illumination& illumination, const PropagationSettings& settings);

  explicit operator bool() const { return this->Along != 0; }

  Medium Of(const Medium& medium) const; ///< permuted medium, which refers to the arrays of `medium`
  /// The permuted lights, faces and sky.
  Illumination Of(const Illumination& illumination) const;
  PropagationSettings Of(const PropagationSettings& settings) const;

  /// Converts the light of the permuted scene back to the original axes. @param grid  grid of the original scene
  void Undo(LightField& light, const Grid& grid) const;

private:
  template <class Value>
  std::array<Value, 3> Turned(const std::array<Value, 3>& given) const;
  template <class Value>
  std::array<Value, 3> TurnedBack(const std::array<Value, 3>& turned) const;
  /// Index in the permuted scene of a face of the original scene.
  int FaceWhenTurned(int face) const { return (face / 2 + 3 - this->Along) % 3 * 2 + face % 2; }
  void TurnBackCells(std::vector<float>& values, const Grid& grid) const;
  void TurnBackMoments(LightField& light, const Grid& grid) const;

  int Along = 0; ///< axis of the layers in the original scene; 0: no permutation
};

/// Periodic axes on which the grid has one voxel, so that nothing varies along them. A scene with two such axes is a
/// plane-parallel slab.
class UnvaryingAxes
{
public:
  /// Finds the unvarying axes of a scene. There are none if a lamp is inside or near the box, or if the source is
  /// constant as in the published scheme.
  UnvaryingAxes(const Grid& grid, const Illumination& illumination, const PropagationSettings& settings);

  bool IsSlab() const { return this->Single[0] + this->Single[1] + this->Single[2] == 2; }

  /// Copy of `grid` whose voxels are widened along the unvarying axes to ten times the edge along the other axes. Light
  /// does not depend on this width; with a smaller one rays would wrap around many times, with a larger one more sweeps
  /// are needed.
  Grid Widened(const Grid& grid) const;

private:
  std::array<bool, 3> Single = {};
};

/// Number of directions per cube face with which a scene is solved: that of the settings, with these exceptions:
///  - in a slab at least 144 (cheap, since mirror images are merged), with an even number of rows;
///  - with one or two periodic axes an even number of rows: with an odd number, some directions are parallel to these
///    axes, and their light never enters or leaves. For an optical thickness of 0.01, the reflectance would be 11% too
///    low.
/// No exceptions if adaptDirections is false.
int DirectionsPerFaceFor(const PropagationSettings& settings, const UnvaryingAxes& unvarying);
}
