#pragma once

#include "Photons/Emission/SampleSequence.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// Number that stands for the environment and the sky in lists of lights; the lights of the illumination are numbered
/// from 0.
constexpr int EnvironmentLight = -1;

/// Relative density of photon origins, as one square image for each light. For directional lights the image covers the
/// photon plane. Lights without a photon plane have an image over the first two coordinates of the samples from which
/// their photons are computed.
struct ImportanceMap
{
  int size = 0; ///< cells along an edge of each square image
  /// Light to which each square image belongs: its index in the illumination, or EnvironmentLight
  std::vector<int> lights;
  std::vector<float> density; ///< size*size values per light, columns fastest; > 0, in any unit

  int SquareOf(int light) const; ///< index of the square image of a light; -1 if it has none
  std::size_t Cells() const { return static_cast<std::size_t>(this->size) * static_cast<std::size_t>(this->size); }
};

/// Checks an importance map.
/// @throws InvalidInput if a density is negative, 0 (light that starts in its cell would be missing) or not finite
///   (names light, column and row), or if there is not one density per cell
void Check(const ImportanceMap& map);

/// Importance sampling by the square image that an ImportanceMap has for one light: maps the unit square onto itself so
/// that uniform points are distributed by the image's density (Pfeuti 2009, section 3.2.3).
class ImportanceSampler
{
public:
  /// Builds the sampler of one square image of the map.
  /// @param density  size*size relative densities, not all zero
  /// @param most     upper limit of the density relative to uniform sampling, at least 1: the excess of a cell is
  /// distributed among the other cells in proportion to their densities
  ImportanceSampler(const float* density, int size, double most);

  /// A point in the unit square, and the probability density there.
  struct Place
  {
    double u, v, density;
  };
  Place At(double u, double v) const;

  double DensityOf(int column, int row) const; ///< probability density in a cell; its mean over the cells is 1

private:
  int Size;
  DensityTable Table;
};
}
