#include "LatticeBoltzmann/FindUncollided.h"

#include "Distribution/SharedMedium.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "LatticeBoltzmann/WhereLightIsLost.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"

#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
/// Settings for a single sweep: voxels are made wide along axes on which nothing varies, and the quadrature is adapted
/// to them.
PropagationSettings AsSweep(const LatticeSettings& settings)
{
  PropagationSettings of = AsPropagation(settings);
  of.source = PropagationSource::Automatic;
  return of;
}

/// Clears moments towards faces across a periodic axis of one voxel: the voxel is its own neighbour there.
void ClearAcrossSingleVoxels(const Grid& whole, const LatticeSettings& settings, std::vector<float>& moments)
{
  for (std::size_t i = 0; i < moments.size(); ++i)
  {
    const std::size_t axis = i % 6 / 2;
    const bool isSingle = settings.periodic[axis] && whole.size[axis] == 1;
    moments[i] = isSingle ? 0.0f : moments[i];
  }
}

/// The net flux of light, repeated for the channels of the problem if it has one channel.
std::vector<float> FluxByChannel(const LightField& light, int channels)
{
  std::vector<float> values;
  for (std::size_t i = 0; i < light.netFlux.size(); i += 3 * static_cast<std::size_t>(light.channels))
  {
    for (int c = 0; c < channels; ++c)
    {
      const float* flux = light.netFlux.data() + i + (light.channels > 1 ? 3 * c : 0);
      values.insert(values.end(), flux, flux + 3);
    }
  }
  return values;
}

/// The uncollided light of lamps and environment, by the first sweep of light propagation maps. Collective.
Uncollided BySweep(Device& device, const LatticeProblem& problem, const LatticeSettings& settings, bool firstMoments,
  const Monitor& monitor)
{
  const Domain& domain = problem.TheDomain();
  const std::size_t voxels = problem.OwnMedium().grid.VoxelCount();
  const int channels = problem.Channels();
  Medium dark = problem.OwnMedium(); // isotropic scattering: no delta-M truncation
  dark.emission = {};
  dark.phase = PhaseFunction();
  PropagationSettings once = AsSweep(settings);
  once.maximumOrders = 1;
  once.firstMoments = firstMoments;
  Illumination narrow = problem.TheIllumination();
  narrow.sky = {};
  narrow.faces = {};
  narrow.faceAlbedo = {};
  LightField light;
  light.channels = 1;
  light.fluenceDirect.resize(voxels);
  light.netFlux.resize(settings.netFlux ? 3 * voxels : 0);
  if (Shines(narrow))
  {
    light = SolveConservative(device, domain, dark, narrow, once, monitor);
  }
  Uncollided found;
  found.fluence = problem.WithGhosts(std::move(light.fluenceDirect), light.channels);
  found.image.fluence = { found.fluence.data(), light.channels };
  if (domain.Any(!light.firstMoments.empty()))
  {
    found.firstMoments = problem.WithGhosts(std::move(light.firstMoments), 6 * light.channels);
    ClearAcrossSingleVoxels(domain.Whole(), settings, found.firstMoments);
  }
  if (settings.netFlux)
  {
    found.netFlux = problem.WithGhosts(FluxByChannel(light, channels), 3 * channels);
  }
  if (IsFirstThatHas(domain.Comm(), domain.Partition()))
  {
    found.image.escaped = EscapedByChannel(light);
    const EnergyBalance& sums = light.balance;
    for (int c = 0; c < channels; ++c)
    {
      const int of = light.channels > 1 ? c : 0;
      found.lost[c] = sums.entered[of] - sums.absorbed[of] - sums.escaped[of] - sums.leftOver[of];
    }
  }
  return found;
}

/// Net flux in the layout of LightField::netFlux: mean directions times fluence.
std::vector<float> NetFluxOf(const UncollidedImage& image, std::size_t voxels, int channels)
{
  std::vector<float> flux;
  for (std::size_t i = 0; i < voxels; ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      for (int a = 0; a < 3; ++a)
      {
        const float along = image.meanDirection.values ? image.meanDirection.values[3 * i + a] : 0.0f;
        flux.push_back(along * image.fluence.At(i, c));
      }
    }
  }
  return flux;
}
}

void AddMomentsOfImage(
  Uncollided& found, const LatticeProblem& problem, const LatticeSettings& settings, bool firstMoments)
{
  const Medium& medium = problem.TheMedium();
  if (settings.netFlux)
  {
    found.netFlux = NetFluxOf(found.image, medium.grid.VoxelCount(), problem.Channels());
  }
  if (firstMoments)
  {
    found.firstMoments = EstimatedFirstMoments(found.image, medium, problem.Box());
    ClearAcrossSingleVoxels(problem.TheDomain().Whole(), settings, found.firstMoments);
  }
}

Uncollided FindUncollided(
  Device& device, const LatticeProblem& problem, const LatticeSettings& settings, const Monitor& monitor)
{
  const Domain& domain = problem.TheDomain();
  const bool moments = domain.Any(!domain.IsEmpty() && NeedsFirstMoments(problem.TheMedium(), settings));
  const UncollidedImage& given = problem.TheIllumination().uncollided;
  if (domain.Any(given.IsThere()))
  {
    Uncollided found;
    found.image = given;
    if (!IsFirstThatHas(domain.Comm(), domain.Partition()))
    {
      found.image.escaped = {}; // every rank has the powers of the whole grid
    }
    AddMomentsOfImage(found, problem, settings, moments);
    return found;
  }
  return BySweep(device, problem, settings, moments, monitor);
}
}
