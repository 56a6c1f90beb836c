#include "LightPropagation/Distributed/IncidentLight.h"

namespace tyndall
{
namespace
{
std::vector<Light> WithPeaks(std::vector<Light> lamps, const SplitEnvironment& far)
{
  lamps.insert(lamps.end(), far.peaks.begin(), far.peaks.end());
  return lamps;
}
}

IncidentLight::IncidentLight(const Grid& whole, const PropagationSettings& settings, const Illumination& shining,
  const UncollidedDirections& finer, int channels, bool scatters)
  : OfScattered(whole, settings, DirectionsForVoxels(settings.directionsPerFace, whole.spacing),
      settings.staggeredRays ? RayStarts::Staggered : RayStarts::Middle)
  , OfUnscattered(finer.perFace > 0 ? FinerDirections(whole, settings, finer.perFace, false) : nullptr)
  , Corrects(finer.correctsEscape && scatters && !Reflects(shining))
  , Far(Split(shining.environment, this->SetOfUnscattered()))
  , AlongUsual(whole, settings, this->OfScattered, shining, this->Far.smooth)
  , AllLamps(WithPeaks(shining.lights, this->Far))
{
  this->MakeFineBoundary(whole, settings, shining, channels);
}

const DirectionSet& IncidentLight::SetOfUnscattered() const
{
  return (this->OfUnscattered ? *this->OfUnscattered : this->OfScattered).Set();
}

/// As TransportParts does.
void IncidentLight::MakeFineBoundary(
  const Grid& whole, const PropagationSettings& settings, const Illumination& shining, int channels)
{
  if (!this->AlongUsual.Shines())
  {
    return;
  }
  if (this->OfUnscattered)
  {
    auto fine = std::make_unique<const BoundaryLight>(whole, settings, *this->OfUnscattered, shining, this->Far.smooth);
    // Directions that nobody asked for are left where few of their rays would meet the faces.
    const bool asked = settings.uncollidedDirections >= 0;
    if (asked)
    {
      fine->CheckRays(channels);
    }
    if (asked || fine->HasEnoughRays(channels))
    {
      this->AlongFine = std::move(fine);
    }
  }
  if (!this->AlongFine)
  {
    this->AlongUsual.CheckRays(channels);
  }
}

std::vector<Light> IncidentLight::LampsOf(const Illumination& shining) const
{
  return WithPeaks(shining.lights, Split(shining.environment, this->SetOfUnscattered()));
}
}
