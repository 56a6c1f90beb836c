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
/// Bytes that a device has for arrays.
struct DeviceMemory
{
  std::size_t all = std::numeric_limits<std::size_t>::max();
  std::size_t one = std::numeric_limits<std::size_t>::max(); ///< of them
};
DeviceMemory MemoryOf(const Device& device);

/// Mean free paths through the box, in the mean of its voxels and edges.
/// @param grid  of all of the medium
/// @param extinction  1/length, added up over its voxels
double MeanThickness(const Grid& grid, double extinction);
/// Of all voxels, 1/length.
double SumOfExtinction(const Medium& medium, int channel);

/// What of a medium tells in how many angular moments its light is to be scattered. Of one in several parts, the
/// largest moments and the sums over all of them.
struct AngularDetail
{
  std::vector<double> moments; ///< by degree: the largest magnitude of any of its phase functions
  Rgb extinction = {};         ///< 1/length, added up over voxels; 0 where all scattering is isotropic
};
AngularDetail AngularDetailOf(const Medium& medium, int channels);

/// Degree of the angular moments to solve a medium with: the settings', or where they leave it open the highest whose
/// moment of the phase function is more than the tolerance, up to 3 (in slabs 9, in thin media that scatter forwards
/// 5), as far as there is memory; no more than the directions tell apart. 0 where scattering is isotropic, or so nearly
/// that the similarity relation does.
/// @param grid    of all of the medium
/// @param slab    plane-parallel: more moments cost little
/// @param voxels  that the memory is to hold
int AngularDegreeFor(const AngularDetail& detail, const Grid& grid, const PropagationSettings& settings, bool slab,
  std::size_t voxels, const DeviceMemory& memory);

/// Whether light goes through the box freely along one axis, and several times as far along another. Then what is
/// scattered along the long one gathers in few directions, and a source that is negative there, as moments of a peak
/// are here and there, is not made up for by that of others.
bool IsMuchThinnerAlongOneAxis(
  const AngularDetail& detail, const Grid& grid, int channels, const std::array<bool, 3>& periodic);
}
