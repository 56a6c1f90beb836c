#pragma once

#include "Medium/Field.h"
#include "Medium/Grid.h"
#include "PhaseFunction/PhaseOfMedium.h"

#include <string>

namespace tyndall
{
/// Largest sigma_t, 1/length; the inverse of a larger value is not a normal float.
constexpr double LargestExtinction = 1e37;

/// A participating medium on a grid, constant in each voxel: sigma_a, sigma_s, emission and phase function.
struct Medium
{
  Grid grid;
  Field sigma_a;  ///< absorption coefficient, 1/length
  Field sigma_s;  ///< scattering coefficient, 1/length
  Field emission; ///< emitted radiance per unit length, W / (length^3 sr)
  PhaseOfMedium phase;

  /// Scattering coefficient, 1/length, of the isotropic medium with the same diffusion and absorption (similarity
  /// relation, numerics.md, Eq. (8)).
  float TransportSigmaS(std::size_t voxel, int channel) const
  {
    return static_cast<float>(this->sigma_s.At(voxel, channel) * (1.0 - this->phase.MeanCosine(voxel, channel)));
  }
  /// Extinction coefficient, 1/length, of the isotropic medium whose scattering coefficient is TransportSigmaS.
  float TransportSigmaT(std::size_t voxel, int channel) const
  {
    return this->sigma_a.At(voxel, channel) + this->TransportSigmaS(voxel, channel);
  }

  /// Number of channels of the medium: 3 if any coefficient or the phase function is coloured, else 1.
  int Channels() const
  {
    const bool colour =
      this->sigma_a.HasColour() || this->sigma_s.HasColour() || this->emission.HasColour() || this->phase.HasColour();
    return colour ? 3 : 1;
  }
};

/// Whether any voxel is optically thicker than `meanFreePaths`. Its thickness is TransportSigmaT times the grid's
/// longest spacing.
bool AnyVoxelIsThickerThan(double meanFreePaths, const Medium& medium);

/// Text "(i, j, k)" for the voxel at array index `voxel`.
std::string VoxelName(const Grid& grid, std::size_t voxel);

/// Checks the number of components of a field called `name`.
/// @throws InvalidInput if the field has neither 1 nor 3 components
void CheckComponents(const Field& field, const char* name);

/// Checks size and spacing of a grid.
/// @throws InvalidInput if the grid is empty, or a spacing is outside [1e-30, 1e30] or more than 1e9 times another
void Check(const Grid& grid);

/// Checks a medium.
/// @throws InvalidInput if the grid is invalid (Check(grid)), a coefficient is negative or not finite, sigma_a +
///   sigma_s exceeds LargestExtinction, or a mean cosine g is outside (-1, 1) (names the first such voxel)
void Check(const Medium& medium);
}
