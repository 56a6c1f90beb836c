#include "LatticeBoltzmann/FindUncollided.h"

#include "Distribution/SharedMedium.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
/// Decrease of fluence along an axis is attributed to attenuation only if light travels along that axis, since light
/// also decreases at shadow edges. Therefore the estimated first moment of collisions along the axis (their mean
/// distance from the voxel's centre) is multiplied by a weight that depends on the component of the mean direction
/// along it. The weight is 0 up to a component of SaysNothing, and grows linearly to 1 at SaysAll, so that rounding
/// errors cannot switch it on or off.
constexpr double SaysNothing = 0.15, SaysAll = 0.25;

/// Mean of exp(-k x) over x from 0 to 1.
double MeanOf(double k)
{
  return k > 1e-6 ? -std::expm1(-k) / k : 1.0 - 0.5 * k;
}

/// Optical thickness of a voxel along an axis.
double ThicknessOf(const Medium& medium, std::size_t voxel, std::size_t axis, int channel)
{
  return medium.grid.spacing[axis] * (medium.sigma_a.At(voxel, channel) + medium.sigma_s.At(voxel, channel));
}

/// How far the mean position of collisions is displaced upstream from a voxel's centre, in voxels, for light that
/// decays as exp(-k x).
double NearerBy(double k)
{
  return k > 1e-2 ? std::min(0.5 - 1.0 / k + 1.0 / std::expm1(k), 0.5) : k / 12.0;
}

/// Solves exp(-k) MeanOf(ratio k) / MeanOf(k) = passes for k in [0, most], by bisection (numerics.md, Eq. (L14)): the
/// optical thickness of the next voxel downstream is `ratio` times that of this voxel, and its fluence `passes` times
/// that of this voxel.
double FallOff(double passes, double ratio, double most)
{
  double low = 0.0, high = most;
  for (int i = 0; i < 40 && passes < 1.0; ++i)
  {
    const double k = 0.5 * (low + high);
    (std::exp(-k) * MeanOf(ratio * k) > passes * MeanOf(k) ? low : high) = k;
  }
  return low;
}

/// Positions of collisions of uncollided light in one channel, estimated from fluence and mean direction by voxel.
class LostLight
{
public:
  LostLight(const UncollidedImage& image, const Medium& medium, const LatticeBox& box, int channel)
    : Image(image)
    , TheMedium(medium)
    , Box(box)
    , Channel(channel)
  {
  }

  /// How far the mean position of collisions is displaced upstream along an axis from a voxel's centre, in voxels.
  double Nearer(std::size_t voxel, std::size_t axis) const
  {
    const double along = this->Image.meanDirection.At(voxel, static_cast<int>(axis));
    const double says = std::clamp((std::abs(along) - SaysNothing) / (SaysAll - SaysNothing), 0.0, 1.0);
    return says > 0.0 && this->Thickness(voxel, axis) > 0.0 ? says * this->NearerBySlope(voxel, axis, along) : 0.0;
  }

  double Fluence(std::size_t voxel) const { return this->Image.fluence.At(voxel, this->Channel); }

private:
  /// Result of Nearer() for a mean direction that is clearly along the axis, from the decay of fluence to the next
  /// voxel.
  /// @param along  component of the mean direction along the axis
  double NearerBySlope(std::size_t voxel, std::size_t axis, double along) const
  {
    const double thickness = this->Thickness(voxel, axis);
    const double most = thickness / std::abs(along);
    const std::size_t ahead = along > 0.0 ? 1 : 0; // 1 if the high face across the axis is downstream
    const std::size_t next = this->Box.Beyond(voxel, 2 * axis + ahead);
    if (next != Outside)
    {
      const double here = this->Fluence(voxel);
      return NearerBy(FallOff(this->Fluence(next) / here, this->Thickness(next, axis) / thickness, most));
    }
    const std::size_t last = this->Box.Beyond(voxel, 2 * axis + 1 - ahead);
    if (last != Outside)
    {
      // The last voxel of the box has no voxel downstream. Its k is computed from the decrease from the voxel upstream
      // to this one, and is multiplied by the ratio of their thicknesses.
      const double before = this->Thickness(last, axis), there = this->Fluence(last);
      const double ratio = before > 0.0 ? thickness / before : 0.0;
      // without light upstream no decrease is assumed
      const double passes = there > 0.0 ? this->Fluence(voxel) / there : 1.0;
      return before > 0.0 ? NearerBy(std::min(ratio * FallOff(passes, ratio, before / std::abs(along)), most))
                          : NearerBy(most);
    }
    return NearerBy(most);
  }

  double Thickness(std::size_t voxel, std::size_t axis) const
  {
    return ThicknessOf(this->TheMedium, voxel, axis, this->Channel);
  }

  const UncollidedImage& Image;
  const Medium& TheMedium;
  const LatticeBox& Box;
  int Channel;
};

/// Estimates the first moments of collisions (LightField::firstMoments) of uncollided light that is given by voxel
/// (numerics.md, Eq. (L14)). The light is assumed to decay as exp(-k x) along its mean direction; k follows from the
/// fluence of the next voxel downstream. Empty if the image has no mean directions.
std::vector<float> EstimatedFirstMoments(const UncollidedImage& image, const Medium& medium, const LatticeBox& box)
{
  if (!image.meanDirection.values)
  {
    return {};
  }
  const auto channels = static_cast<std::size_t>(image.fluence.components);
  std::vector<float> moments(6 * channels * medium.grid.VoxelCount(), 0.0f);
  for (std::size_t c = 0; c < channels; ++c)
  {
    const LostLight light(image, medium, box, static_cast<int>(c));
    for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
    {
      const double fluence = light.Fluence(i);
      for (std::size_t axis = 0; axis < 3 && fluence > 0.0; ++axis)
      {
        const bool forwards = image.meanDirection.At(i, static_cast<int>(axis)) > 0.0f;
        const std::size_t face = 2 * axis + (forwards ? 0 : 1);
        moments[6 * (i * channels + c) + face] = static_cast<float>(fluence * light.Nearer(i, axis));
      }
    }
  }
  return moments;
}
}

double Uncollided::Nearer(std::size_t voxel, int channel, std::size_t face) const
{
  const auto channels = static_cast<std::size_t>(this->image.fluence.components);
  const std::size_t of = channels > 1 ? static_cast<std::size_t>(channel) : 0;
  const double fluence = this->image.fluence.At(voxel, channel);
  const double moment = this->firstMoments.empty() ? 0.0 : this->firstMoments[6 * (voxel * channels + of) + face];
  return fluence > 0.0 ? std::min(moment / fluence, 0.5) : 0.0;
}

double NearerOfNormalBeam(const Medium& medium, std::size_t voxel, int channel)
{
  return NearerBy(ThicknessOf(medium, voxel, 0, channel));
}

namespace
{
/// Settings of light propagation maps for uncollided light. The source option is Automatic: unlike Constant, it widens
/// voxels along periodic axes of one voxel, and adapts the quadrature to such a grid (UnvaryingAxes).
PropagationSettings AsSweep(const LatticeSettings& settings)
{
  PropagationSettings of = AsPropagation(settings);
  of.source = PropagationSource::Automatic;
  return of;
}

/// Sets the first moments along a periodic axis of one voxel to 0: the voxel is its own neighbour along that axis, so
/// light that is moved across its face remains in it.
void ClearAcrossSingleVoxels(const Grid& whole, const LatticeSettings& settings, std::vector<float>& moments)
{
  for (std::size_t i = 0; i < moments.size(); ++i)
  {
    const std::size_t axis = i % 6 / 2;
    const bool isSingle = settings.periodic[axis] && whole.size[axis] == 1;
    moments[i] = isSingle ? 0.0f : moments[i];
  }
}

/// Net flux of `light` for the channels of the problem; if `light` has one channel, it is repeated.
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

/// Computes the uncollided light of lamps and environment by light propagation maps, which are stopped after the first
/// order. Collective.
Uncollided BySweep(Device& device, const LatticeProblem& problem, const LatticeSettings& settings, bool firstMoments,
  const Monitor& monitor)
{
  const Domain& domain = problem.TheDomain();
  const std::size_t voxels = problem.OwnMedium().grid.VoxelCount();
  const int channels = problem.Channels();
  // a copy that neither emits nor scatters anisotropically: with an isotropic phase function, delta-M does not truncate
  // a forward peak
  Medium dark = problem.OwnMedium();
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
    const Rgb lost = sums.entered - sums.absorbed - sums.escaped - sums.leftOver;
    for (int c = 0; c < channels; ++c)
    {
      found.lost[c] = lost[light.channels > 1 ? c : 0];
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
      found.image.escaped = {}; // powers are those of the whole grid, which every rank holds: only one rank counts them
    }
    AddMomentsOfImage(found, problem, settings, moments);
    return found;
  }
  return BySweep(device, problem, settings, moments, monitor);
}
}
