#include "LightPropagation/PropagationSettings.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#include <string>

namespace tyndall
{
void CheckOrders(int maximumOrders, double tolerance)
{
  if (maximumOrders < 0)
  {
    throw InvalidInput("MaximumOrders is " + std::to_string(maximumOrders) +
      "; give a number of scattering orders, or 0 for as many as the tolerance needs.");
  }
  if (!(tolerance > 0.0))
  {
    throw InvalidInput("Tolerance is " + Text("%g", tolerance) + "; it must be positive.");
  }
}

void Check(const PropagationSettings& settings)
{
  if (settings.mapResolution < 1 || settings.mapResolution > 16)
  {
    throw InvalidInput(
      "MapResolution is " + std::to_string(settings.mapResolution) + "; it must be at least 1 and at most 16.");
  }
  if (settings.polarNodes < 0 || settings.polarNodes == 1 || settings.polarNodes > 64)
  {
    throw InvalidInput("PolarNodes is " + std::to_string(settings.polarNodes) +
      "; it must be 2 to 64 cosines of a half of all directions, or 0 for as many as the scene needs.");
  }
  if (settings.uncollidedDirections < -1)
  {
    throw InvalidInput("UncollidedDirections is " + std::to_string(settings.uncollidedDirections) +
      "; give a square number of directions per face, 0 for the same as DirectionsPerFace, or -1 for as many as cost a "
      "quarter more at most.");
  }
  CheckOrders(settings.maximumOrders, settings.tolerance);
  if (settings.source == PropagationSource::Linear && settings.acceleration == PropagationAcceleration::None)
  {
    throw InvalidInput(
      "Source is linear and Acceleration is none; the linear source is that of the accelerated solve: choose "
      "Acceleration automatic, or Source constant.");
  }
  if (!(settings.emissionError >= 0.0))
  {
    throw InvalidInput("EmissionError is " + Text("%g", settings.emissionError) +
      "; it must not be negative: 0 is for no rays of their own, 0.02 is usual, 0.005 accurate.");
  }
  if (settings.angularDegree < -1 || settings.angularDegree > HighestAngularDegree)
  {
    throw InvalidInput("AngularDegree is " + std::to_string(settings.angularDegree) +
      "; it must be from 0 (isotropic by the similarity relation) to 15, or -1: as the phase function asks for.");
  }
  if (settings.storedDirections < 1)
  {
    throw InvalidInput("StoredDirections is " + std::to_string(settings.storedDirections) + "; it must be at least 1.");
  }
}
}
