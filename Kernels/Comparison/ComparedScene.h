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

/// Transfer of fields between grids whose voxel sizes differ by integer factors, and the scene of a comparison.
namespace tyndall
{
/// Factors along each axis that make voxels `factor` times as large; 1 along axes with a single voxel.
/// @return no value if `factor` does not divide the size of an axis
std::optional<Factors> CoarseningBy(int factor, const Grid& grid);

Grid Coarsened(const Grid& fine, const Factors& factors);

/// Number of voxels of `fine` per voxel of `coarse` along each axis; no value if the numbers are not integers, or the
/// boxes differ by more than a thousandth of a voxel.
std::optional<Factors> FactorsBetween(const Grid& fine, const Grid& coarse);

/// Means of values over coarse voxels; NaN if a fine value is NaN.
/// @param values  `components` per voxel of `fine`, x fastest
/// @param factors  fine voxels per coarse voxel along each axis
std::vector<float> Averaged(const float* values, int components, const Grid& fine, const Factors& factors);

/// The scene that all solvers of a comparison solve. Does not own its arrays.
struct ComparedScene
{
  Medium medium;
  Illumination illumination;
  Field ior;                            ///< refractive index; null: 1 everywhere
  const std::uint8_t* levels = nullptr; ///< octree level of each voxel, for photons; null: no octree
  std::array<bool, 3> periodic = { false, false, false };

  bool BendsLight() const; ///< whether the refractive index varies
  bool Emits() const;      ///< whether any voxel emits
  /// Reason why photons cannot simulate this scene; empty if they can.
  /// @param all  whether scattered light is wanted as well as uncollided light
  std::string WhyNotByPhotons(bool all) const;
};
}
