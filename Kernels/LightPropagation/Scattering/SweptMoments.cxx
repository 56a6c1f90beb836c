#include "LightPropagation/Scattering/SweptMoments.h"

#include "LightPropagation/Scattering/BeamScattering.h"

#include <algorithm>

namespace tyndall
{
namespace
{
constexpr std::size_t MostBeams = 4; ///< largest number of beams with separate first-collision sources

/// Indices of the brightest directional lamps, which become beams; none if the phase function varies between voxels or
/// channels.
std::vector<int> BrightestBeams(const PhaseOfMedium& phase, const std::vector<Light>& lamps)
{
  std::vector<int> beams;
  for (std::size_t i = 0; i < lamps.size() && !phase.Varies() && !phase.HasColour(); ++i)
  {
    if (lamps[i].type == LightType::Directional && Sum(lamps[i].power) > 0.0)
    {
      beams.push_back(static_cast<int>(i));
    }
  }
  const auto brighter = [&](int a, int b) { return Sum(lamps[a].power) > Sum(lamps[b].power); };
  std::stable_sort(beams.begin(), beams.end(), brighter);
  beams.resize(std::min<std::size_t>(beams.size(), MostBeams));
  return beams;
}
}

SweptMoments::SweptMoments(const SweptDirections& directions, const PhaseOfMedium& phase,
  const TruncatedScattering& scattering, const std::vector<Light>& lamps)
  : TheBasis(directions.Set(), scattering.Degree())
  , OfDirections(directions.Values(this->TheBasis))
  , LampOfBeam(BrightestBeams(phase, lamps))
{
  std::vector<std::vector<double>> ofBeams;
  for (const int lamp : this->LampOfBeam)
  {
    const auto beyond = scattering.IsNowhereNegative() ? BeyondSmoothMoments : BeyondMoments;
    ofBeams.push_back(beyond(
      phase.OfChannel(0), scattering.OfThinVoxels(), directions.Set(), this->TheBasis, DirectionOf(lamps[lamp])));
  }
  for (std::size_t d = 0; d < directions.Set().directions.size(); ++d)
  {
    this->OfDirections.beams.emplace_back();
    for (const std::vector<double>& ofBeam : ofBeams)
    {
      this->OfDirections.beams.back().push_back(directions.Mean(static_cast<int>(d), ofBeam));
    }
  }
}

int SweptMoments::BeamOf(std::size_t lamp) const
{
  const auto found = std::find(this->LampOfBeam.begin(), this->LampOfBeam.end(), static_cast<int>(lamp));
  return found == this->LampOfBeam.end() ? -1 : static_cast<int>(found - this->LampOfBeam.begin());
}
}
