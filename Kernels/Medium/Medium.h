#pragma once

#include "Medium/Grid.h"

#include <string>

namespace tyndall
{
constexpr double LargestExtinction = 1e37; ///< 1/length; the inverse of more is not a normal float

/// One quantity over a grid's voxels, seen, not owned: `components` floats per voxel (1, or 3 for RGB interleaved).
struct Field
{
  const float* values = nullptr; ///< null: the quantity is zero everywhere
  int components = 1;
  int standsForAll = -1; ///< the component of three that is seen in every channel; -1: each in its own

  bool HasColour() const { return this->components == 3 && this->standsForAll < 0; }
  float At(std::size_t voxel, int channel) const
  {
    const int component = this->components != 3 ? 0 : this->standsForAll >= 0 ? this->standsForAll : channel;
    return this->values ? this->values[voxel * this->components + component] : 0.0f;
  }
};

/// A participating medium: what pbrt calls sigma_a, sigma_s, Le and the phase function, constant in each voxel.
struct Medium
{
  Grid grid;
  Field sigma_a;  ///< absorption coefficient, 1/length
  Field sigma_s;  ///< scattering coefficient, 1/length
  Field emission; ///< emitted radiance per unit length, W / (length^3 sr)
  double g = 0.0; ///< mean cosine of the phase function (Henyey-Greenstein), in (-1, 1)

  /// Scattering and extinction of the isotropic medium that stands for this one by the similarity relation
  /// (numerics.md, Eq. (8)): same diffusion, same absorption. 1/length
  float TransportSigmaS(std::size_t voxel, int channel) const
  {
    return static_cast<float>(this->sigma_s.At(voxel, channel) * (1.0 - this->g));
  }
  float TransportSigmaT(std::size_t voxel, int channel) const
  {
    return this->sigma_a.At(voxel, channel) + this->TransportSigmaS(voxel, channel);
  }

  /// 3 where any quantity is coloured, else 1.
  int Channels() const
  {
    return this->sigma_a.HasColour() || this->sigma_s.HasColour() || this->emission.HasColour() ? 3 : 1;
  }
};

/// "(i, j, k)" of the voxel that is `voxel`th in an array.
std::string VoxelName(const Grid& grid, std::size_t voxel);

/// @throws InvalidInput where a field has neither 1 nor 3 components
void CheckComponents(const Field& field, const char* name);

/// @throws InvalidInput where the grid is empty, has a spacing that is not from 1e-30 to 1e30, or one that is more than
///   1e9 times another
void Check(const Grid& grid);

/// @throws InvalidInput where the grid is not as above, where a coefficient is
///   negative or not finite, or sigma_a and sigma_s add up to more than LargestExtinction (names the first such voxel),
///   or where g is outside (-1, 1)
void Check(const Medium& medium);
}
