#include "LightPropagation/Distributed/IncidentLight.h"

#include <utility>

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
  const UncollidedDirections& finer, int channels)
  : OfScattered(whole, settings, DirectionsForVoxels(settings.directionsPerFace, whole.spacing),
      settings.staggeredRays ? RayStarts::Staggered : RayStarts::Middle)
  , Chosen(finer)
  , OfUnscattered(finer.perFace > 0 ? FinerDirections(whole, settings, finer.perFace, false) : nullptr)
  , Far(this->SplitFar(shining.environment))
  , AllLamps(WithPeaks(shining.lights, this->Far))
{
  this->MakeFineBoundary(whole, settings, shining, channels);
  const bool all = !this->AlongFine;
  this->AlongUsual = std::make_unique<const BoundaryLight>(whole, settings, this->OfScattered,
    all ? shining : tyndall::AlongUsual(finer, shining), all || finer.ofFacesAlone ? this->Far.smooth : Environment());
  if (this->SweepCarriesBoundarySource())
  {
    this->AlongUsual->CheckRays(channels);
  }
}

/// As TransportParts does.
SplitEnvironment IncidentLight::SplitFar(const Environment& environment) const
{
  return Split(
    environment, (this->OfUnscattered && !this->Chosen.ofFacesAlone ? *this->OfUnscattered : this->OfScattered).Set());
}

/// As TransportParts does.
void IncidentLight::MakeFineBoundary(
  const Grid& whole, const PropagationSettings& settings, const Illumination& shining, int channels)
{
  if (!this->OfUnscattered)
  {
    return;
  }
  const bool ofAll = !this->Chosen.ofFacesAlone;
  auto fine = std::make_unique<const BoundaryLight>(
    whole, settings, *this->OfUnscattered, AlongFiner(this->Chosen, shining), ofAll ? this->Far.smooth : Environment());
  if (!fine->Shines() || (!ofAll && fine->IsEven()))
  {
    return;
  }
  // Directions that nobody asked for are left where few of their rays would meet the faces.
  if (ofAll)
  {
    fine->CheckRays(channels);
  }
  else if (!BoundaryLight::HasEnoughRays(whole, settings, *this->OfUnscattered))
  {
    return;
  }
  this->AlongFine = std::move(fine);
}

std::vector<Light> IncidentLight::LampsOf(const Illumination& shining) const
{
  return WithPeaks(shining.lights, this->SplitFar(shining.environment));
}
}
