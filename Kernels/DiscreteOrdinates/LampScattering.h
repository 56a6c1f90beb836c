#pragma once

#include "Device/Buffer.h"
#include "DiscreteOrdinates/AngularScattering.h"
#include "DiscreteOrdinates/OrdinateGroups.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "PhaseFunction/PhaseFunction.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Destination of the first-collision source of a lamp.
struct LampTarget
{
  const Buffer<float>& source; ///< of all directions, over `scale`; added to
  Buffer<float>& scale;        ///< becomes 1
  const Buffer<float>& direct; ///< W / length^2, uncollided fluence, added to
  const OrdinatesLight& light; ///< its fluence and flux are added to
};

/// The first scattering of uncollided light, by the phase function itself between a ray and each direction, averaged
/// over the direction's cell (numerics.md, Eq. (D12)). Power and mean cosine are right, and no source is negative,
/// whatever the terms of later scatterings are.
///
/// Rays come from the lamp's place; of a rectangle from its middle, which is off near it. In the voxel that the lamp is
/// in, light is scattered evenly.
class LampScattering
{
public:
  /// @param groups  must stay
  LampScattering(Device& device, const Grid& grid, const OrdinateGroups& groups, const PhaseFunction& function);

  /// @param path  W length, of the lamp's light in each voxel
  void Add(const Light& lamp, const Buffer<float>& path, const Buffer<float>& sigma_s, const LampTarget& target) const;
  /// The same for light along a mean direction of each voxel, to the part of its length; the rest is isotropic.
  /// @param ways  mean directions, 3 a voxel
  void AddAlong(
    const Buffer<float>& ways, const Buffer<float>& path, const Buffer<float>& sigma_s, const LampTarget& target) const;

private:
  cl::Kernel Kernel(const char* name, bool ways) const;
  std::vector<float> PartsAlong(const std::array<double, 3>& ray) const;

  Device& TheDevice;
  Grid TheGrid;
  const OrdinateGroups& Groups;
  double MeanCosine;
  std::vector<float> ByAngle; ///< the phase function from 0 to pi, 1/sr
  Buffer<float> Omegas, Table;
};
}
