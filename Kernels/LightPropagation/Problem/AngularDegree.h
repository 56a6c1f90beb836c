#pragma once

#include "Device/Device.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

#include <cstddef>
#include <limits>

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
double MeanThickness(const Medium& medium);

/// Degree of the angular moments to solve a medium with: the settings', or where they leave it open the highest whose
/// moment of the phase function is more than the tolerance, up to 3 (in slabs 9, in thin media that scatter forwards
/// 5), as far as there is memory; no more than the directions tell apart. 0 where scattering is isotropic, or so nearly
/// that the similarity relation does.
/// @param slab  plane-parallel: more moments cost little
int AngularDegreeFor(const Medium& medium, const PropagationSettings& settings, bool slab, const DeviceMemory& memory);

/// Whether light goes through the box freely along one axis, and several times as far along another. Then what is
/// scattered along the long one gathers in few directions, and a source that is negative there, as moments of a peak
/// are here and there, is not made up for by that of others.
bool IsMuchThinnerAlongOneAxis(const Medium& medium, int channels, const std::array<bool, 3>& periodic);
}
