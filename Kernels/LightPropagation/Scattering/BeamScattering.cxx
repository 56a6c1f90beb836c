#include "LightPropagation/Scattering/BeamScattering.h"

#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"
#include "Numerics/Vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace tyndall
{
namespace
{
/// Integral over the forward hemisphere of max(p - level, 0), for a phase function p.
double PartAbove(const PhaseFunction& function, double level)
{
  static const GaussLegendre rule(24);
  double sum = 0.0, far = 1.0;
  for (int stretch = 0; stretch < 40; ++stretch, far *= 0.5) // intervals that halve towards the peak
  {
    const double near = stretch == 39 ? 0.0 : 0.5 * far;
    for (std::size_t i = 0; i < rule.points.size(); ++i)
    {
      const double away = near + 0.5 * (rule.points[i] + 1.0) * (far - near);
      sum += Pi * (far - near) * rule.weights[i] * std::max(function.Value(1.0 - away) - level, 0.0);
    }
  }
  return sum;
}

/// Finds the level at which PartAbove(function, level), the integral of the excess of the phase function over this
/// level, is `part`.
double LevelOf(const PhaseFunction& function, double part)
{
  double low = 0.0, high = std::max(function.Value(1.0), 1e-30);
  for (int i = 0; i < 100 && part > 0.0; ++i)
  {
    const double level = low > 0.0 ? std::sqrt(low * high) : 1e-6 * high;
    (PartAbove(function, level) > part ? low : high) = level;
  }
  return high;
}

double Dot(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// First-scattered light of a beam along each direction of `set`, without the top of the forward peak that delta-M
/// treats as unscattered; normalised to a mean of 1.
/// @param peak  fraction of scattered light treated as unscattered
/// @param beam  direction of the beam
std::vector<double> WithoutPeak(
  const PhaseFunction& function, double peak, const DirectionSet& set, const std::array<double, 3>& beam)
{
  const double level = LevelOf(function, peak);
  std::vector<double> scattered;
  double sum = 0.0;
  for (const Direction& direction : set.directions)
  {
    const double cosine = std::clamp(Dot(direction.omega, beam), -1.0, 1.0);
    const double value = function.Value(cosine);
    scattered.push_back(cosine > 0.0 ? std::min(value, level) : value);
    sum += direction.weight * scattered.back() / (4.0 * Pi);
  }
  for (double& value : scattered)
  {
    value /= sum;
  }
  return scattered;
}

/// Multiplies the values at directions omega by a + t . omega such that their mean is unchanged and the mean of value
/// times omega becomes `flux`, unless a value would become negative: then t is limited.
void Tilt(std::vector<double>& values, const DirectionSet& set, const glm::dvec3& flux)
{
  constexpr double MostTilt = 0.98;
  glm::dvec3 mean(0.0);
  glm::dmat3 second(0.0);
  for (std::size_t d = 0; d < values.size(); ++d)
  {
    const glm::dvec3 omega = Vector(set.directions[d].omega);
    const double part = set.directions[d].weight * values[d] / (4.0 * Pi);
    mean += part * omega;
    second += part * glm::outerProduct(omega, omega);
  }
  glm::dvec3 tilt = glm::inverse(second - glm::outerProduct(flux, mean)) * (flux - mean);
  const double length = glm::length(tilt);
  tilt = std::isfinite(length) ? tilt * std::min(1.0, MostTilt / std::max(length, 1e-30)) : glm::dvec3(0.0);
  const double all = 1.0 + glm::dot(tilt, mean);
  for (std::size_t d = 0; d < values.size(); ++d)
  {
    values[d] *= (1.0 + glm::dot(tilt, Vector(set.directions[d].omega))) / all;
  }
}
}

std::vector<double> BeyondMoments(const PhaseFunction& function, const DeltaM& truncated, const DirectionSet& set,
  const AngularBasis& basis, const std::array<double, 3>& beam)
{
  std::vector<double> scattered = WithoutPeak(function, truncated.forward, set, beam);
  std::vector<std::vector<double>> functions;
  std::vector<double> moments(basis.Count(), 0.0);
  for (std::size_t d = 0; d < scattered.size(); ++d)
  {
    functions.push_back(basis.At(set.directions[d].omega));
    for (int i = 0; i < basis.Count(); ++i)
    {
      moments[i] += set.directions[d].weight * scattered[d] * functions[d][i] / (4.0 * Pi);
    }
  }
  for (std::size_t d = 0; d < scattered.size(); ++d)
  {
    for (int i = 0; i < basis.Count(); ++i)
    {
      scattered[d] -= moments[i] * functions[d][i];
    }
  }
  return scattered;
}

std::vector<double> BeyondSmoothMoments(const PhaseFunction& function, const DeltaM& truncated, const DirectionSet& set,
  const AngularBasis& basis, const std::array<double, 3>& beam)
{
  std::vector<double> scattered = WithoutPeak(function, truncated.forward, set, beam);
  Tilt(scattered, set, truncated.moments[1] * Vector(beam));
  const std::vector<double> there = basis.At(beam);
  for (std::size_t d = 0; d < scattered.size(); ++d)
  {
    const std::vector<double> here = basis.At(set.directions[d].omega);
    for (int i = 0; i < basis.Count(); ++i)
    {
      scattered[d] -= truncated.moments[AngularBasis::DegreeOf(i)] * here[i] * there[i];
    }
  }
  return scattered;
}

void BeamsInSource::Hold()
{
  if (this->Count > 0)
  {
    this->Held = Buffer<float>(this->TheDevice, this->Count, "the light of beams");
    this->TheDevice.Queue().enqueueCopyBuffer(
      this->Source.Handle(), this->Held.Handle(), this->First * sizeof(float), 0, this->Count * sizeof(float));
    this->Source.Fill(0.0f, this->First, this->Count);
  }
}

void BeamsInSource::GoOn()
{
  if (this->Held.Size() > 0)
  {
    this->TheDevice.Queue().enqueueCopyBuffer(
      this->Held.Handle(), this->Source.Handle(), 0, this->First * sizeof(float), this->Count * sizeof(float));
    this->Held = {};
  }
  else
  {
    this->Source.Fill(0.0f, this->First, this->Count);
  }
}

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
