#pragma once

#include "LightPropagation/Accuracy/ResampledScene.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Medium/Medium.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Transfer of fields between grids whose voxel sizes differ by integer factors.
namespace tyndall
{
/// Factors for voxels `factor` times as large; axes with a single voxel are not coarsened.
/// @return nothing if `factor` does not divide the size of an axis
std::optional<Factors> CoarseningBy(int factor, const Grid& grid);

Grid Coarsened(const Grid& fine, const Factors& factors);

/// Voxels of `fine` per voxel of `coarse` along each axis; nothing if they are not integers, or the boxes differ by
/// more than a thousandth of a voxel.
std::optional<Factors> FactorsBetween(const Grid& fine, const Grid& coarse);

/// Means over coarse voxels; NaN if a fine value is.
/// @param values  `components` per voxel of `fine`, x fastest
std::vector<float> Averaged(const float* values, int components, const Grid& fine, const Factors& factors);

/// The scene that all solvers are given. Refers to arrays that it does not own.
struct ComparedScene
{
  Medium medium;
  Illumination illumination;
  Field ior;                            ///< null values: 1 everywhere
  const std::uint8_t* levels = nullptr; ///< octree levels by voxel, for photons; null: none
  std::array<bool, 3> periodic = { false, false, false };

  bool BendsLight() const; ///< whether the refractive index varies
  bool Emits() const;      ///< whether any voxel emits
  /// Why photons cannot simulate this scene; empty if they can.
  /// @param all  including scattered light
  std::string WhyNotByPhotons(bool all) const;
};
}
