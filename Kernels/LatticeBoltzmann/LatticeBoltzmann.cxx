#include "LatticeBoltzmann/LatticeBoltzmann.h"

#include "LatticeBoltzmann/Interleaved/InterleavedLattice.h"
#include "LatticeBoltzmann/LatticeChannel.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "LatticeBoltzmann/WhereLightIsLost.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Photons/Marching/PhotonMarcher.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
/// That which is given, or else that of lamps and environment along the maps' rays. Nothing is truncated: the medium
/// counts as scattering evenly.
Uncollided FindUncollided(
  Device& device, const PropagationProblem& problem, const LatticeSettings& settings, const Monitor& monitor)
{
  Uncollided found;
  found.image = problem.Shining().uncollided;
  if (found.image.IsThere())
  {
    found.netFlux = settings.netFlux ? NetFluxOf(found.image, problem.TheGrid(), problem.Channels()) : found.netFlux;
    if (NeedsFirstMoments(problem.TheMedium(), settings))
    {
      found.firstMoments = EstimatedFirstMoments(found.image, problem.TheMedium(), settings.periodic);
    }
    return found;
  }
  Medium dark = problem.TheMedium();
  dark.emission = {};
  dark.phase = PhaseFunction();
  PropagationSettings once = AsPropagation(settings);
  once.source = PropagationSource::Automatic;
  once.maximumOrders = 1;
  once.firstMoments = NeedsFirstMoments(problem.TheMedium(), settings);
  Illumination narrow = problem.Shining(); // what is diffuse comes in on the lattice itself
  narrow.sky = {};
  narrow.faces = {};
  narrow.faceAlbedo = {};
  if (!Shines(narrow))
  {
    found.fluence.assign(problem.TheGrid().VoxelCount(), 0.0f);
    found.image.fluence = { found.fluence.data(), 1 };
    found.netFlux = settings.netFlux ? NetFluxOf(found.image, problem.TheGrid(), problem.Channels()) : found.netFlux;
    return found;
  }
  LightField light = SolveConservative(device, dark, narrow, once, monitor);
  found.fluence = std::move(light.fluenceDirect);
  found.firstMoments = std::move(light.firstMoments);
  found.image.fluence = { found.fluence.data(), light.channels };
  found.image.escaped = EscapedByChannel(light);
  for (int c = 0; c < problem.Channels(); ++c)
  {
    const EnergyBalance& sums = light.balance;
    const int of = light.channels > 1 ? c : 0;
    found.lost[c] = sums.entered[of] - sums.absorbed[of] - sums.escaped[of] - sums.leftOver[of];
  }
  for (std::size_t i = 0; settings.netFlux && i < problem.TheGrid().VoxelCount(); ++i)
  {
    for (int c = 0; c < problem.Channels(); ++c)
    {
      const float* flux = light.netFlux.data() + 3 * (i * light.channels + (light.channels > 1 ? c : 0));
      found.netFlux.insert(found.netFlux.end(), flux, flux + 3);
    }
  }
  return found;
}

}

LightField SolveLatticeBoltzmann(Device& device, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings, const Monitor& monitor)
{
  CheckLattice(medium, ior, settings);
  const PropagationProblem problem(medium, illumination, AsPropagation(settings));
  const Uncollided uncollided = FindUncollided(device, problem, settings, OfPart(monitor, 0.0, 0.1));
  LightField light = BeginLight(problem.TheGrid().VoxelCount(), problem.Channels(), settings);
  double thickest = 0.0;
  for (int c = 0; c < light.channels; ++c)
  {
    LatticeChannel channel(device, SceneOf(problem), ior, settings, uncollided, c);
    const double all = light.channels;
    channel.Solve(OfPart(monitor, 0.1 + 0.9 * c / all, 0.1 + 0.9 * (c + 1) / all));
    channel.AddTo(light);
    thickest = std::max(thickest, channel.Thickest());
  }
  CountLost(uncollided.lost, light.balance);
  FinishLight(light, device, problem, illumination, settings, thickest);
  return light;
}

LightField SolveLatticeBoltzmann(Device& device, const Medium& medium, const Field& ior,
  const std::vector<Photon>& photons, const Illumination& illumination, const LatticeSettings& settings,
  const Monitor& monitor)
{
  CheckLattice(medium, ior, settings);
  CheckPhotonsGoNotRound(settings);
  MarchSettings march;
  march.meanDirection = settings.netFlux || NeedsFirstMoments(medium, settings);
  PhotonMarcher marcher(device, medium, ior, march);
  if (settings.interleaves)
  {
    return InterleavedLattice(device, medium, ior, illumination, settings).Solve(marcher, photons, monitor);
  }
  const PhotonLight found = marcher.March(photons, OfPart(monitor, 0.0, 0.5));
  Illumination lit = illumination;
  lit.uncollided = ImageOf(found);
  LightField light = SolveLatticeBoltzmann(device, medium, ior, lit, settings, OfPart(monitor, 0.5, 1.0));
  DoubtPhotons(found, photons.size(), light);
  return light;
}
}
