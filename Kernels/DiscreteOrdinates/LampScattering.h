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
/// Arrays that receive the first-collision source and the uncollided light of a lamp.
struct LampTarget
{
  /// Source of all directions, W / (length^3 sr), to which the first-collision source is added. On entry the source of
  /// a voxel is its element of this array times `scale`.
  const Buffer<float>& source;
  Buffer<float>& scale;        ///< factor of `source` by voxel; on return 1, because `source` has been multiplied by it
  const Buffer<float>& direct; ///< uncollided fluence, W / length^2; the lamp's is added to it
  const OrdinatesLight& light; ///< sums over scattering orders, to which the lamp's fluence and net flux are added
};

/// First-collision source of uncollided light. Along each direction it is proportional to the phase function for
/// scattering from the ray into that direction, averaged over the direction's solid angle (numerics.md, Eq. (D12)).
/// Scattered power and its mean cosine are exact, and no source is negative, however few terms the phase function has
/// for later scatterings.
///
/// Rays start at the position of the lamp; for a rectangle at its centre, which is inaccurate close to it. In the voxel
/// that contains the lamp, first scattering is isotropic.
class LampScattering
{
public:
  /// @param groups  must outlive this
  LampScattering(Device& device, const Grid& grid, const OrdinateGroups& groups, const PhaseFunction& function);

  /// Adds the uncollided light and the first-collision source of a lamp to `target`.
  /// @param path  path integrals of the lamp's light, W length
  void Add(const Light& lamp, const Buffer<float>& path, const Buffer<float>& sigma_s, const LampTarget& target) const;
  /// Adds uncollided light that has a mean direction in each voxel, and its first-collision source, to `target`.
  /// @param ways  mean directions, [voxel][x, y, z]; the length of a vector, 0 to 1, is the fraction of the light along
  ///   it, and the rest is isotropic
  void AddAlong(
    const Buffer<float>& ways, const Buffer<float>& path, const Buffer<float>& sigma_s, const LampTarget& target) const;

private:
  cl::Kernel Kernel(const char* name, bool ways) const;
  std::vector<float> PartsAlong(const std::array<double, 3>& ray) const;

  Device& TheDevice;
  Grid TheGrid;
  const OrdinateGroups& Groups;
  double MeanCosine;
  /// Phase function averaged over the solid angle of one direction, 1/sr, at equidistant angles from 0 to pi.
  std::vector<float> ByAngle;
  Buffer<float> Omegas, Table;
};
}
