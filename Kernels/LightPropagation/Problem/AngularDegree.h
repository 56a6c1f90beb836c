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
/// Free memory of a device, bytes; the default is unlimited.
struct DeviceMemory
{
  std::size_t all = std::numeric_limits<std::size_t>::max();
  std::size_t one = std::numeric_limits<std::size_t>::max(); ///< size of the largest single array, bytes
};
/// Returns the free memory of a device.
DeviceMemory MemoryOf(const Device& device);

/// Mean optical thickness of the box: mean extinction of its voxels times mean length of its edges.
/// @param grid  grid of the domain
/// @param extinction  sum of the extinction over all voxels of the domain, 1/length
double MeanThickness(const Grid& grid, double extinction);
/// Sum of sigma_a + sigma_s over all voxels of a medium, 1/length.
double SumOfExtinction(const Medium& medium, int channel);

/// Properties of a medium that determine the degree of its light's angular moments. For a domain of several subdomains:
/// maxima of `moments`, sums of `extinction`.
struct AngularDetail
{
  std::vector<double> moments; ///< largest magnitude of a phase function's moment, by degree
  /// Sum of the extinction over voxels, 1/length, by channel; 0 if all scattering is isotropic.
  Rgb extinction = {};
};
AngularDetail AngularDetailOf(const Medium& medium, int channels);

/// Degree of the angular moments with which a medium is solved: that of the settings or, if they leave it open, the
/// highest degree whose phase-function moment exceeds the tolerance. It is at most 3 (9 in slabs; 6 in thin,
/// forward-scattering media), and limited by memory and by the degree that the quadrature resolves. It is 0 if
/// scattering is isotropic, or so nearly isotropic that the similarity relation suffices.
/// @param grid    grid of the domain
/// @param slab    whether the medium is a plane-parallel slab, where more moments cost little
/// @param voxels  number of voxels that must fit in memory
int AngularDegreeFor(const AngularDetail& detail, const Grid& grid, const PropagationSettings& settings, bool slab,
  std::size_t voxels, const DeviceMemory& memory);

/// Whether the box is optically thin along one axis and several times thicker along another (numerics.md, Eq. (8c)).
/// Scattered light then concentrates in few directions along the long axis. A source that is negative in some
/// directions, as from truncated moments of a peaked phase function, is then not compensated by light of other
/// directions.
bool IsMuchThinnerAlongOneAxis(
  const AngularDetail& detail, const Grid& grid, int channels, const std::array<bool, 3>& periodic);
}
