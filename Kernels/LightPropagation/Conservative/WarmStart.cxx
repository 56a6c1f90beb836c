#include "LightPropagation/Conservative/WarmStart.h"

#include "Device/Device.h"
#include "Distribution/SharedMedium.h"
#include "Numerics/Constants.h"
#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Largest ratio of the changes of the light in successive iterations that is passed to the next solve.
constexpr double SlowestRate = 1.0 - 1e-6;
}

WarmStart::WarmStart(const TransportParts& parts, const KeptLight* kept, const char* method)
  : Parts(parts)
  , TheDomain(parts.Problem.TheDomain())
  , Layout(parts.Layout)
  , Kept(kept)
{
  if (!kept)
  {
    return;
  }
  this->TheKind = this->Kind(method);
  const std::string ofRank = parts.Problem.Traits().scatters
    ? WhyNotBegun(*kept, this->TheKind, parts.Problem.Settings().maximumOrders)
    : "nothing is scattered";
  this->WhyNot = WhyNotBegunOnAny(this->TheDomain.Comm(), *kept, ofRank);
}

LightKind WarmStart::Kind(const char* method) const
{
  const Grid& grid = this->TheDomain.Whole();
  return { method, grid.size, grid.spacing, this->Layout.channels, this->Parts.Problem.Scattering().Degree(),
    static_cast<int>(this->Parts.Usual.Set().directions.size()), this->Parts.Problem.Settings().periodic,
    this->TheDomain.Own() };
}

std::vector<std::string> WarmStart::LeftOut() const
{
  return this->Keeps() ? std::vector<std::string>{ WordsOfWarmStart(this->WhyNot) } : std::vector<std::string>();
}

/// Sum of sigma_s times `values` over the voxels of all ranks, by channel.
/// @param values  [channel][voxel]
Rgb WarmStart::ScatteredOf(const std::vector<float>& values) const
{
  Rgb sums = {};
  const VolumeLayout& layout = this->Layout;
  for (int c = 0; c < layout.channels; ++c)
  {
    for (std::size_t i = 0; i < layout.grid.VoxelCount(); ++i)
    {
      sums[c] += static_cast<double>(this->Parts.Problem.Scattering().SigmaS(i, c)) * values[c * layout.Stride() + i];
    }
  }
  return this->TheDomain.Sum(sums);
}

void WarmStart::Prepare(const std::vector<float>& direct)
{
  const VolumeLayout& layout = this->Layout;
  this->First = this->ScatteredOf(direct);
  for (double& watts : this->First)
  {
    watts *= layout.grid.VoxelVolume();
  }
  if (!this->Begins())
  {
    return;
  }
  const MomentPlaces places = layout.Places(this->Parts.Functions());
  this->TheDomain.Collective([&] {
    this->Scaled = this->Kept->scattered;
    for (std::size_t i = 0; i < places.beams; ++i)
    {
      const int c = layout.ChannelOf(places, i);
      const double before = this->Kept->firstScattered[c];
      const double scale = before > 0.0 ? this->First[c] / before : 0.0;
      this->Scaled[i] = static_cast<float>(this->Scaled[i] * scale);
    }
    this->Path = Buffer<float>(this->Parts.TheDevice, this->Scaled, "the last light");
  });
  this->Power = this->ScatteredOf(this->Scaled);
}

void WarmStart::AddGuessTo(const Buffer<float>& source) const
{
  this->TheDomain.Collective([&] {
    if (!this->TheDomain.IsEmpty())
    {
      this->Parts.Scattering->AddFirstScattered({ &this->Path, nullptr, nullptr, nullptr }, source);
    }
  });
}

void WarmStart::TakeGuessFrom(const Buffer<float>& source)
{
  this->TheDomain.Collective([&] {
    for (float& value : this->Scaled)
    {
      value = -value;
    }
    this->Path.Write(this->Scaled.data());
  });
  this->AddGuessTo(source);
  this->Path = {};
  this->Scaled = {};
}

Rgb WarmStart::MagnitudeOf(const Buffer<float>& source, int functions, int parts) const
{
  const VolumeLayout& layout = this->Layout;
  Device& device = this->Parts.TheDevice;
  Rgb sums = {};
  this->TheDomain.Collective([&] {
    if (this->TheDomain.IsEmpty())
    {
      return;
    }
    const std::size_t lines = static_cast<std::size_t>(layout.grid.size[1]) * layout.grid.size[2];
    const std::size_t arrays = static_cast<std::size_t>(layout.channels) * parts;
    Buffer<float> tally(device, lines * arrays, "sums");
    cl::Kernel kernel = device.Kernel("sum_magnitudes", kernel_source::SourceIteration, SummingOption(device));
    With(kernel, layout.Places(functions), source, tally, cl_ulong(layout.Stride()));
    device.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(lines, arrays), GroupOfLargeItems(device, 2));
    const std::vector<float> values = tally.Read();
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      sums[i / lines / parts] += values[i] * 4.0 * Pi / parts * layout.grid.VoxelVolume();
    }
  });
  return this->TheDomain.Sum(sums);
}

KeptLight WarmStart::Leave(const std::vector<float>& base, const std::vector<float>& moments, const Rgb& rate) const
{
  const VolumeLayout& layout = this->Layout;
  KeptLight left;
  left.kind = this->TheKind;
  for (int c = 0; c < layout.channels && this->Parts.Problem.Settings().maximumOrders == 0; ++c)
  {
    // Keeps at least the ratio of successive changes that the previous solve kept: after a good initial guess the first
    // changes decrease faster than the last ones of a solve from zero.
    left.rate[c] = std::max(std::min(rate[c], SlowestRate), this->Begins() ? this->Rate(c) : 0.0);
  }
  left.firstScattered = this->First;
  this->TheDomain.Collective([&] {
    left.scattered.assign(layout.MomentFloats(this->Parts.Functions()), 0.0f);
    const std::vector<float> fluence = this->Parts.Fluence.Read();
    const auto volume = static_cast<float>(layout.grid.VoxelVolume());
    const std::size_t values = layout.Values();
    for (std::size_t i = 0; i < values; ++i)
    {
      left.scattered[i] = volume * (fluence[i] - base[i]);
    }
    if (!moments.empty())
    {
      const auto second = static_cast<std::ptrdiff_t>(values);
      std::copy(moments.begin() + second, moments.end(), left.scattered.begin() + second);
    }
  });
  left.fromDarkness = this->Begins() ? this->Kept->fromDarkness : std::vector<ConvergenceRow>();
  return left;
}
}
