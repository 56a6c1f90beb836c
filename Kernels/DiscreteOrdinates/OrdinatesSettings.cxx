#include "DiscreteOrdinates/OrdinatesSettings.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#include <string>

namespace tyndall
{
void Check(const OrdinatesSettings& settings)
{
  if (settings.spiralDirections < 0)
  {
    throw InvalidInput("SpiralDirections is " + std::to_string(settings.spiralDirections) +
      "; give 16 at least, or 0 for the directions of a cube.");
  }
  if (settings.terms < 1)
  {
    throw InvalidInput("Terms is " + std::to_string(settings.terms) + "; it must be at least 1.");
  }
  if (settings.maximumOrders < 0)
  {
    throw InvalidInput("MaximumOrders is " + std::to_string(settings.maximumOrders) +
      "; give a number of scattering orders, or 0 for as many as the tolerance needs.");
  }
  if (!(settings.tolerance > 0.0))
  {
    throw InvalidInput("Tolerance is " + Text("%g", settings.tolerance) + "; it must be positive.");
  }
}

bool IsPublished(const OrdinatesSettings& settings)
{
  return settings.scheme == OrdinatesScheme::Published;
}

PropagationSettings AsPropagation(const OrdinatesSettings& settings)
{
  PropagationSettings as;
  as.directionsPerFace = settings.directionsPerFace;
  as.adaptDirections = !IsPublished(settings) && settings.spiralDirections == 0;
  as.source = IsPublished(settings) ? PropagationSource::Constant : PropagationSource::Automatic;
  as.maximumOrders = settings.maximumOrders;
  as.tolerance = settings.tolerance;
  as.periodic = settings.periodic;
  as.netFlux = settings.netFlux;
  as.leaveOut = settings.leaveOut;
  as.angularDegree = 0; // scattering is by direction, not in moments
  return as;
}
}
