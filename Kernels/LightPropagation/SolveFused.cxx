#include "FusedSolver.h"
#include "PowerUnit.h"
#include "UnvaryingAxes.h"

namespace tyndall
{
namespace
{
LightField SolveInUnit(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor)
{
  const MediumTraits traits = TraitsOf(medium, 1.0 - medium.g);
  const SceneChannels channels(medium, traits, illumination);
  return SolveChannels(settings.leaveOut, channels, medium, illumination,
    [&](const Medium& ofChannels, const Illumination& light, int count) {
      return FusedSolver(device, ofChannels, traits, light, settings, count).Run(monitor);
    });
}

LightField SolveInOwnUnit(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor)
{
  const double unit = PowerUnitOf(medium, illumination);
  if (unit == 1.0)
  {
    return SolveInUnit(device, medium, illumination, settings, monitor);
  }
  const SceneInUnits scene(medium, illumination, unit);
  LightField light = SolveInUnit(device, scene.medium, scene.illumination, settings, monitor);
  ToWatts(light, unit);
  return light;
}

LightField SolveInOwnLengths(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor)
{
  const double unit = LengthUnitOf(medium.grid);
  if (unit == 1.0)
  {
    return SolveInOwnUnit(device, medium, illumination, settings, monitor);
  }
  const SceneInLengths scene(medium, illumination, unit);
  LightField light = SolveInOwnUnit(device, scene.medium, scene.illumination, settings, monitor);
  MultiplyPowers(light, unit * unit);
  return light;
}
}

LightField SolveFused(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor)
{
  Check(medium);
  Check(illumination);
  Check(settings);
  const UnvaryingAxes unvarying(medium.grid, illumination, settings);
  Medium wide = medium;
  wide.grid = unvarying.Widened(medium.grid);
  PropagationSettings adapted = settings;
  adapted.directionsPerFace = DirectionsPerFaceFor(settings, unvarying);
  LightField light = SolveInOwnLengths(device, wide, illumination, adapted, monitor);
  light.directionsPerFace = adapted.directionsPerFace;
  if (adapted.directionsPerFace != settings.directionsPerFace)
  {
    light.leftOut.push_back(left_out::DirectionsAlongSlab(adapted.directionsPerFace));
  }
  MultiplyPowers(light, medium.grid.VoxelVolume() / wide.grid.VoxelVolume());
  return light;
}
}
