#pragma once

#include "Distribution/Domain.h"
#include "Medium/Medium.h"
#include "Photons/Photons.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// Forecast of how often photons are scattered, from the means of the coefficients over the domain (numerics.md, Eqs.
/// (99h), (99i)). It is within 30% in uniform cubes of optical thickness 20 and 100.
class ScatteringForecast
{
public:
  /// Collective.
  /// @param medium  medium of this rank's block
  ScatteringForecast(const Domain& domain, const Medium& medium);

  /// Expected number of scatterings of a photon until it leaves the box or is absorbed; mean over all photons, largest
  /// of the channels. Collective.
  /// @param share  this rank's photons
  double Scatterings(const Domain& domain, const std::vector<Photon>& share) const;

  /// Warning about a march of these photons; empty if they are scattered at most 1e5 times each. Collective.
  /// @param maximumOrders  MarchSettings::maximumOrders
  std::string Warning(const Domain& domain, const std::vector<Photon>& share, int maximumOrders) const;

private:
  double Scatterings(const Grid& whole, const Photon& photon, int channel) const;

  std::array<double, 3> Scattering, Transport, Absorption; ///< mean coefficients by channel, 1 / length
};
}
