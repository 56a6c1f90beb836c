#pragma once

#include "Device/Device.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace tyndall
{
/// Memory of a device, bytes.
struct DeviceMemory
{
  std::size_t all = std::numeric_limits<std::size_t>::max();
  std::size_t one = std::numeric_limits<std::size_t>::max(); ///< largest single array
};
DeviceMemory MemoryOf(const Device& device);

/// Mean optical thickness of the box, from the mean extinction and the mean edge.
/// @param grid  grid of the whole medium
/// @param extinction  sum of the extinction over its voxels, 1/length
double MeanThickness(const Grid& grid, double extinction);
/// Sum of the extinction over all voxels, 1/length.
double SumOfExtinction(const Medium& medium, int channel);

/// Properties of a medium that determine the degree of the angular moments of its light. For a medium in several parts:
/// maxima of the moments, sums of the extinction.
struct AngularDetail
{
  std::vector<double> moments; ///< by degree: the largest magnitude of any of its phase functions
  Rgb extinction = {};         ///< sum over voxels, 1/length; 0 if all scattering is isotropic
};
AngularDetail AngularDetailOf(const Medium& medium, int channels);

/// Degree of the angular moments to solve a medium with: that of the settings or, if they leave it open, the highest
/// whose phase-function moment exceeds the tolerance, up to 3 (9 in slabs, 5 in thin, forward-scattering media),
/// limited by memory and by the degree that the quadrature resolves. 0 if scattering is isotropic, or so nearly
/// isotropic that the similarity relation suffices.
/// @param grid    grid of the whole medium
/// @param slab    the medium is a plane-parallel slab, where more moments cost little
/// @param voxels  number of voxels that must fit in memory
int AngularDegreeFor(const AngularDetail& detail, const Grid& grid, const PropagationSettings& settings, bool slab,
  std::size_t voxels, const DeviceMemory& memory);

/// Whether the box is optically thin along one axis and several times thicker along another. Scattered light then
/// concentrates in few directions along the long axis, where a source that is negative in places (as truncated moments
/// of a peaked phase function are) is not compensated by other directions.
bool IsMuchThinnerAlongOneAxis(
  const AngularDetail& detail, const Grid& grid, int channels, const std::array<bool, 3>& periodic);
}
