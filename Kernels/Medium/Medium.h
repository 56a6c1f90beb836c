#pragma once

#include "Medium/Field.h"
#include "Medium/Grid.h"
#include "PhaseFunction/PhaseOfMedium.h"

#include <string>

namespace tyndall
{
constexpr double LargestExtinction = 1e37; ///< 1/length; the inverse of a larger value is not a normal float

/// A participating medium: what pbrt calls sigma_a, sigma_s, Le and the phase function, constant in each voxel.
struct Medium
{
  Grid grid;
  Field sigma_a;  ///< absorption coefficient, 1/length
  Field sigma_s;  ///< scattering coefficient, 1/length
  Field emission; ///< emitted radiance per unit length, W / (length^3 sr)
  PhaseOfMedium phase;

  /// Scattering and extinction coefficient of the isotropic medium with the same diffusion and absorption, by the
  /// similarity relation (numerics.md, Eq. (8)), 1/length.
  float TransportSigmaS(std::size_t voxel, int channel) const
  {
    return static_cast<float>(this->sigma_s.At(voxel, channel) * (1.0 - this->phase.MeanCosine(voxel, channel)));
  }
  float TransportSigmaT(std::size_t voxel, int channel) const
  {
    return this->sigma_a.At(voxel, channel) + this->TransportSigmaS(voxel, channel);
  }

  /// 3 if any coefficient is coloured, else 1.
  int Channels() const
  {
    const bool colour =
      this->sigma_a.HasColour() || this->sigma_s.HasColour() || this->emission.HasColour() || this->phase.HasColour();
    return colour ? 3 : 1;
  }
};

/// Whether any voxel is optically thicker than `meanFreePaths` along the grid's longest spacing, by TransportSigmaT.
bool AnyVoxelIsThickerThan(double meanFreePaths, const Medium& medium);

/// "(i, j, k)" of the voxel with array index `voxel`.
std::string VoxelName(const Grid& grid, std::size_t voxel);

/// @throws InvalidInput if the field has neither 1 nor 3 components
void CheckComponents(const Field& field, const char* name);

/// @throws InvalidInput if the grid is empty, or a spacing is outside [1e-30, 1e30] or more than 1e9 times another
void Check(const Grid& grid);

/// @throws InvalidInput if the grid is invalid as above, a coefficient is negative or not finite, sigma_a + sigma_s
///   exceeds LargestExtinction, or a mean cosine g is outside (-1, 1) (names the first such voxel)
void Check(const Medium& medium);
}
