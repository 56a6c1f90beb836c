#include "LightPropagation/Problem/TruncatedScattering.h"

#include "LightPropagation/Angular/AngularBasis.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Number of directions per cube face that are tested as incident directions, in addition to those of the quadrature.
constexpr int FromPerFace = 144;

/// Whether `omega` lies in one particular part of the sphere, of which the 48 rotations and reflections of the cube
/// make the whole sphere. A quadrature, and its functions of each degree, have the same symmetry.
bool IsInOnePart(const std::array<double, 3>& omega)
{
  constexpr double Rounding = 1e-12;
  return omega[0] >= omega[1] - Rounding && omega[1] >= omega[2] - Rounding && omega[2] >= -Rounding;
}

std::vector<std::array<double, 3>> ComingFrom(const DirectionSet& set)
{
  // The incident direction along an axis is included, since beams are often parallel to an axis
  std::vector<std::array<double, 3>> from = { { 1.0, 0.0, 0.0 } };
  for (const DirectionSet& one : { set, EquiangularDirections(FromPerFace) })
  {
    for (const Direction& direction : one.directions)
    {
      if (IsInOnePart(direction.omega))
      {
        from.push_back(direction.omega);
      }
    }
  }
  return from;
}

/// Maximum optical thickness, along the shortest edge and without the forward peak, of a voxel that scatters in moments
/// above degree 0.
constexpr double Thickest = 1.0;
/// Number of intervals between the mean cosines g, -1 to 1, for which truncated phase functions are tabulated; between
/// them they are interpolated linearly.
constexpr int Columns = 1024;

std::vector<DeltaM> TruncationsOf(const PhaseFunction& function, int degree, const DirectionKernel* nowhereNegative)
{
  std::vector<DeltaM> truncations = Truncations(function, degree);
  for (DeltaM& truncated : truncations)
  {
    truncated = nowhereNegative ? WithoutNegatives(truncated, *nowhereNegative) : truncated;
  }
  return truncations;
}
}

DirectionKernel::DirectionKernel(const DirectionSet& set, int degree)
  : Degrees(degree + 1)
{
  const AngularBasis basis(set, degree);
  std::vector<std::vector<double>> functions;
  for (const Direction& direction : set.directions)
  {
    functions.push_back(basis.At(direction.omega));
  }
  for (const std::array<double, 3>& omega : ComingFrom(set))
  {
    const std::vector<double> there = basis.At(omega);
    for (const std::vector<double>& here : functions)
    {
      std::vector<double> parts(this->Degrees, 0.0);
      for (int i = 0; i < basis.Count(); ++i)
      {
        parts[AngularBasis::DegreeOf(i)] += here[i] * there[i];
      }
      this->Parts.insert(this->Parts.end(), parts.begin(), parts.end());
    }
  }
}

double DirectionKernel::Least(const std::vector<double>& moments) const
{
  double least = 1.0;
  for (std::size_t pair = 0; pair < this->Parts.size(); pair += this->Degrees)
  {
    double sum = 0.0;
    for (std::size_t l = 0; l < moments.size(); ++l)
    {
      sum += moments[l] * this->Parts[pair + l];
    }
    least = std::min(least, sum);
  }
  return least;
}

DeltaM WithoutNegatives(const DeltaM& truncated, const DirectionKernel& kernel)
{
  if (truncated.moments.size() < 2 || kernel.Least(truncated.moments) >= LeastPart)
  {
    return truncated;
  }
  const double g = truncated.forward + (1.0 - truncated.forward) * truncated.moments[1];
  const double forward = g < 0.0 ? 0.0 : truncated.forward; // g < 0: no forward peak to remove
  const auto damped = [&](double s) {
    std::vector<double> moments = truncated.moments;
    for (std::size_t l = 0; l < moments.size(); ++l)
    {
      const double whole = truncated.forward + (1.0 - truncated.forward) * moments[l];
      moments[l] = (whole - forward) / (1.0 - forward) * std::exp(-s * static_cast<double>(l * (l + 1)));
    }
    return moments;
  };
  DeltaM positive = truncated;
  positive.moments = damped(LeastDamping([&](double s) { return kernel.Least(damped(s)); }));
  positive.forward = (g - positive.moments[1]) / (1.0 - positive.moments[1]);
  return positive;
}

TruncatedScattering::TruncatedScattering(
  const Medium& medium, int degree, int channels, const DirectionKernel* nowhereNegative)
  : TheMedium(medium)
  , MostDegree(degree)
  , Channels(channels)
  , NowhereNegative(nowhereNegative != nullptr)
{
  if (degree == 0)
  {
    return;
  }
  for (int i = 1; medium.phase.Varies() && i < Columns; ++i)
  {
    this->OfG.push_back(
      TruncationsOf(medium.phase.OfChannel(0).WithMeanCosine(2.0 * i / Columns - 1.0), degree, nowhereNegative));
  }
  for (int c = 0; c < 3 && !medium.phase.Varies(); ++c)
  {
    this->OfChannel[c] = TruncationsOf(medium.phase.OfChannel(c), degree, nowhereNegative);
  }
  // Each voxel has the highest degree at which it is not optically thick along its shortest edge.
  const double shortest = *std::min_element(medium.grid.spacing.begin(), medium.grid.spacing.end());
  this->Degrees.resize(medium.grid.VoxelCount() * channels);
  this->MostDegree = 0;
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      const int fitting = this->FittingDegree(i, c, shortest);
      this->Degrees[i * channels + c] = static_cast<std::uint8_t>(fitting);
      this->MostDegree = std::max(this->MostDegree, medium.sigma_s.At(i, c) > 0.0f ? fitting : 0);
    }
  }
}

std::vector<std::string> TruncatedScattering::LeftOut() const
{
  const PhaseOfMedium& phase = this->TheMedium.phase;
  if (this->MostDegree == 0)
  {
    const std::string g = phase.Varies() ? "that of each voxel" : Text("%g", phase.MeanCosine(0, 0));
    return phase.IsIsotropic()
      ? std::vector<std::string>()
      : std::vector<std::string>{ "anisotropy: solved as isotropic scattering with sigma_s (1 - g), g = " + g +
          " (similarity relation)" };
  }
  std::vector<std::string> words = { "angular moments above degree " + std::to_string(this->MostDegree) +
    ": what is scattered beyond them goes straight on (delta-M)" };
  if (this->IsNowhereNegative())
  {
    words.emplace_back("detail within these moments: smoothed such that no source is negative, in a box that is thin "
                       "along one axis and long along another");
  }
  return words;
}

/// Highest degree at which the voxel is not optically thick along its shortest edge, of length `shortest`.
int TruncatedScattering::FittingDegree(std::size_t voxel, int channel, double shortest) const
{
  const double absorbs = this->TheMedium.sigma_a.At(voxel, channel);
  const double scatters = this->TheMedium.sigma_s.At(voxel, channel);
  int degree = static_cast<int>((this->OfG.empty() ? this->OfChannel[channel] : this->OfG.front()).size()) - 1;
  while (degree > 0 && shortest * (absorbs + scatters * (1.0 - this->Forward(voxel, channel, degree))) > Thickest)
  {
    --degree;
  }
  return degree;
}

template <class Value>
double TruncatedScattering::Of(std::size_t voxel, int channel, int degree, const Value& value) const
{
  if (this->OfG.empty())
  {
    return value(this->OfChannel[channel][degree]);
  }
  const double g = this->TheMedium.phase.MeanCosine(voxel, channel);
  const double column = std::clamp(0.5 * (g + 1.0) * Columns - 1.0, 0.0, Columns - 2.001);
  const auto below = static_cast<std::size_t>(column);
  const double low = value(this->OfG[below][degree]);
  return low + (column - static_cast<double>(below)) * (value(this->OfG[below + 1][degree]) - low);
}

double TruncatedScattering::Forward(std::size_t voxel, int channel, int degree) const
{
  return this->Of(voxel, channel, degree, [](const DeltaM& truncated) { return truncated.forward; });
}

float TruncatedScattering::SigmaS(std::size_t voxel, int channel) const
{
  const int degree = this->DegreeOf(voxel, channel);
  return degree == 0
    ? this->TheMedium.TransportSigmaS(voxel, channel)
    : static_cast<float>(this->TheMedium.sigma_s.At(voxel, channel) * (1.0 - this->Forward(voxel, channel, degree)));
}

float TruncatedScattering::StraightOn(std::size_t voxel, int channel) const
{
  if (!(this->TheMedium.sigma_s.At(voxel, channel) > 0.0f))
  {
    return 0.0f;
  }
  const int degree = this->DegreeOf(voxel, channel);
  return static_cast<float>(
    degree == 0 ? this->TheMedium.phase.MeanCosine(voxel, channel) : this->Forward(voxel, channel, degree));
}

float TruncatedScattering::SigmaS(std::size_t voxel, int channel, int l) const
{
  const int degree = this->DegreeOf(voxel, channel);
  if (l == 0 || l > degree)
  {
    return l == 0 ? this->SigmaS(voxel, channel) : 0.0f;
  }
  const double moment = this->Of(voxel, channel, degree, [l](const DeltaM& truncated) { return truncated.moments[l]; });
  return static_cast<float>(this->SigmaS(voxel, channel) * moment);
}

MediumOnDevice::MediumOnDevice(Device& device, const Medium& medium, const TruncatedScattering& scattering,
  const VolumeLayout& layout, const Needs& needs)
{
  const int extinctions = layout.sharedExtinction ? 1 : layout.channels;
  const auto load = [&](int channels, const char* what, auto&& value) {
    return PlanarOnDevice(device, layout, channels, value, what);
  };
  this->Extinction = load(extinctions, "sigma_t", [&](std::size_t i, int c) { return scattering.SigmaT(i, c); });
  if (needs.sigma_s)
  {
    this->Scattering = load(layout.channels, "sigma_s", [&](std::size_t i, int c) { return scattering.SigmaS(i, c); });
  }
  if (needs.sigma_a)
  {
    this->Absorption = load(layout.channels, "sigma_a", [&](std::size_t i, int c) { return medium.sigma_a.At(i, c); });
  }
  if (scattering.Degree() > 0)
  {
    this->OfDegrees = load(layout.channels * (scattering.Degree() + 1), "sigma_s",
      [&](std::size_t i, int part) { return scattering.SigmaS(i, part % layout.channels, part / layout.channels); });
    this->Transport = load(extinctions, "sigma_t", [&](std::size_t i, int c) { return medium.TransportSigmaT(i, c); });
  }
}
}
