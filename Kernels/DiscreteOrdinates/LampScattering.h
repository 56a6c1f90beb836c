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
/// Arrays that receive the first-collision source of a lamp.
struct LampTarget
{
  const Buffer<float>& source; ///< of all directions, relative to `scale`; added to
  Buffer<float>& scale;        ///< set to 1
  const Buffer<float>& direct; ///< W / length^2, uncollided fluence, added to
  const OrdinatesLight& light; ///< its fluence and flux are added to
};

/// First-collision source of uncollided light: the phase function between a ray and each direction, averaged over the
/// cell of the direction (numerics.md, Eq. (D12)). Power and mean cosine are exact, and no source is negative,
/// regardless of the terms used for later scatterings.
///
/// Rays start at the position of the lamp; for a rectangle at its centre, which is inaccurate close to it. In the voxel
/// that contains the lamp, first scattering is isotropic.
class LampScattering
{
public:
  /// @param groups  must outlive this
  LampScattering(Device& device, const Grid& grid, const OrdinateGroups& groups, const PhaseFunction& function);

  /// @param path  path integrals of the light of the lamp, W length
  void Add(const Light& lamp, const Buffer<float>& path, const Buffer<float>& sigma_s, const LampTarget& target) const;
  /// The same for light that has a mean direction in each voxel. The length of that vector is the fraction of the light
  /// along it; the rest is isotropic.
  /// @param ways  mean directions, 3 values per voxel
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
