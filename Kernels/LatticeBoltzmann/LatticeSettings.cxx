#include "LatticeBoltzmann/LatticeSettings.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#include <algorithm>

namespace tyndall
{
namespace
{
void SetLevel(LatticeSettings& settings, int directions, double tolerance)
{
  const LatticeSettings byDefault;
  SetUnlessChosen(settings.directions, byDefault.directions, directions);
  SetUnlessChosen(settings.tolerance, byDefault.tolerance, tolerance);
}
}

bool HasCubicVoxels(const Grid& grid)
{
  const auto [least, most] = std::minmax_element(grid.spacing.begin(), grid.spacing.end());
  return *most <= 1.001 * *least;
}

void Check(const LatticeSettings& settings)
{
  if (settings.directions != 6 && settings.directions != 18)
  {
    throw InvalidInput(
      "A lattice of " + std::to_string(settings.directions) + " directions was asked for; there are 6 and 18.");
  }
  if (settings.blockSize != 0 && (settings.blockSize < 2 || settings.blockSize > 8))
  {
    throw InvalidInput("BlockSize is " + std::to_string(settings.blockSize) +
      "; give 2 to 8 voxels, or 0 for a lattice that steps as a whole.");
  }
  if (settings.stepsPerExchange < 1)
  {
    throw InvalidInput("StepsPerExchange is " + std::to_string(settings.stepsPerExchange) + "; give 1 step or more.");
  }
  if (settings.maximumSteps < 0)
  {
    throw InvalidInput("MaximumOrders is " + std::to_string(settings.maximumSteps) +
      "; give a number of steps, or 0 for as many as the tolerance needs.");
  }
  if (settings.probes < 0)
  {
    throw InvalidInput(
      "Probes is " + std::to_string(settings.probes) + "; give a number of voxels to look at, or 0 for all.");
  }
  if (settings.stretches < 0)
  {
    throw InvalidInput("VoxelsPerTurn is " + std::to_string(settings.stretches) +
      "; give the voxels that photons cross in a turn, or 0 for all.");
  }
  if (!(settings.tolerance > 0.0))
  {
    throw InvalidInput("Tolerance is " + Text("%g", settings.tolerance) + "; it must be positive.");
  }
}

std::string NotInBlocks(const LatticeSettings& settings)
{
  const bool published = settings.scheme == LatticeScheme::Published;
  return published              ? "the scheme as published"
    : settings.blockSize > 0    ? "BlockSize"
    : settings.interleaves      ? "Interleaved"
    : settings.maximumSteps > 0 ? "MaximumOrders"
    : !settings.solvesSteady    ? "steps"
                                : "";
}

PropagationSettings AsPropagation(const LatticeSettings& settings, int angularDegree)
{
  PropagationSettings of;
  of.periodic = settings.periodic;
  of.maximumOrders = settings.maximumSteps;
  of.netFlux = settings.netFlux;
  of.leaveOut = settings.leaveOut;
  of.angularDegree = angularDegree;
  // with other options for the source, voxels of plane-parallel slabs may be widened; the lattice needs cubes
  of.source = PropagationSource::Constant;
  return of;
}

LatticeSettings AtQuality(Quality quality, LatticeSettings settings)
{
  switch (quality)
  {
    case Quality::Draft: SetLevel(settings, 6, 1e-2); break;
    case Quality::Default: break;
    case Quality::Fine: SetLevel(settings, 18, 1e-5); break;
    case Quality::Reference: SetLevel(settings, 18, 1e-6); break;
  }
  return settings;
}

std::vector<std::string> Words(const LatticeSettings& settings)
{
  return { "Lattice = " + std::to_string(settings.directions), "Tolerance = " + Text("%g", settings.tolerance) };
}
}
