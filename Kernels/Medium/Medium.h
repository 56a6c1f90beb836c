#pragma once

#include "Medium/Field.h"
#include "Medium/Grid.h"
#include "PhaseFunction/PhaseOfMedium.h"

#include <string>

namespace tyndall
{
constexpr double LargestExtinction = 1e37; ///< 1/length; the inverse of more is not a normal float

/// A participating medium: what pbrt calls sigma_a, sigma_s, Le and the phase function, constant in each voxel.
struct Medium
{
  Grid grid;
  Field sigma_a;  ///< absorption coefficient, 1/length
  Field sigma_s;  ///< scattering coefficient, 1/length
  Field emission; ///< emitted radiance per unit length, W / (length^3 sr)
  PhaseOfMedium phase;

  /// Scattering and extinction of the isotropic medium that stands for this one by the similarity relation
  /// (numerics.md, Eq. (8)): same diffusion, same absorption. 1/length
  float TransportSigmaS(std::size_t voxel, int channel) const
  {
    return static_cast<float>(this->sigma_s.At(voxel, channel) * (1.0 - this->phase.MeanCosine(voxel, channel)));
  }
  float TransportSigmaT(std::size_t voxel, int channel) const
  {
    return this->sigma_a.At(voxel, channel) + this->TransportSigmaS(voxel, channel);
  }

  /// 3 where any quantity is coloured, else 1.
  int Channels() const
  {
    const bool colour =
      this->sigma_a.HasColour() || this->sigma_s.HasColour() || this->emission.HasColour() || this->phase.HasColour();
    return colour ? 3 : 1;
  }
};

/// Whether any voxel is thicker than `meanFreePaths` along the grid's longest spacing, by TransportSigmaT.
bool AnyVoxelIsThickerThan(double meanFreePaths, const Medium& medium);

/// "(i, j, k)" of the voxel that is `voxel`th in an array.
std::string VoxelName(const Grid& grid, std::size_t voxel);

/// @throws InvalidInput where a field has neither 1 nor 3 components
void CheckComponents(const Field& field, const char* name);

/// @throws InvalidInput where the grid is empty, has a spacing that is not from 1e-30 to 1e30, or one that is more than
///   1e9 times another
void Check(const Grid& grid);

/// @throws InvalidInput where the grid is not as above, where a coefficient is
///   negative or not finite, or sigma_a and sigma_s add up to more than LargestExtinction, or where a voxel's mean
///   cosine g is outside (-1, 1) (names the first such voxel)
void Check(const Medium& medium);
}
