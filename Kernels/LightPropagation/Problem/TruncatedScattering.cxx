#include "LightPropagation/Problem/TruncatedScattering.h"

#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double Thickest = 1.0; ///< optical thickness of a voxel up to which its degree is above 0
constexpr int Columns = 1024;    ///< tabulated mean cosines; moments are interpolated linearly between them

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
  // The shortest edge decides: angular detail is resolved along it first.
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

/// Highest degree at which the voxel is not optically thick.
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
}
