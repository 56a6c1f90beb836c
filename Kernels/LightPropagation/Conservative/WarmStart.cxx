#include "LightPropagation/Conservative/WarmStart.h"

#include "Device/GroupSize.h"
#include "Distribution/KeptInBlocks.h"
#include "Numerics/Constants.h"
#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
namespace
{
constexpr double SlowestRate = 1.0 - 1e-6; ///< that is told the next solve
}

WarmStart::WarmStart(TransportParts& parts, const KeptLight* kept, const char* method)
  : WarmStart({ parts.TheDevice, parts.Layout, parts.Problem.Scattering(), *parts.Scattering, parts.Problem.Settings(),
                parts.Fluence, parts.Problem.Traits().scatters, parts.Functions(),
                static_cast<int>(parts.Usual.Set().directions.size()), parts.Layout.grid },
      kept, method)
{
}

WarmStart::WarmStart(const Scene& scene, const KeptLight* kept, const char* method)
  : The(scene)
  , Kept(kept)
{
  if (!kept)
  {
    return;
  }
  this->TheKind = this->Kind(method);
  this->WhyNot =
    scene.scatters ? WhyNotBegun(*kept, this->TheKind, scene.settings.maximumOrders) : "nothing is scattered";
  if (scene.others)
  {
    this->WhyNot = WhyNotBegunOnAny(*scene.others, *kept, this->WhyNot);
  }
}

/// What may fail on one rank (Communicator.h).
void WarmStart::Collective(const std::function<void()>& work) const
{
  this->The.others ? this->The.others->Collective(work) : work();
}

Rgb WarmStart::SumOverRanks(const Rgb& own) const
{
  if (!this->The.others)
  {
    return own;
  }
  const std::vector<double> sums = this->The.others->Sum({ own[0], own[1], own[2] });
  return { sums[0], sums[1], sums[2] };
}

LightKind WarmStart::Kind(const char* method) const
{
  const Grid& grid = this->The.whole;
  return { method, grid.size, grid.spacing, this->The.layout.channels, this->The.medium.Degree(), this->The.directions,
    this->The.settings.periodic, this->The.block };
}

std::vector<std::string> WarmStart::LeftOut() const
{
  return this->Keeps() ? std::vector<std::string>{ WordsOfWarmStart(this->WhyNot) } : std::vector<std::string>();
}

/// W by channel: sigma_s times values, summed over the voxels of all ranks; [channel][stride].
Rgb WarmStart::ScatteredOf(const std::vector<float>& values) const
{
  Rgb sums = {};
  const VolumeLayout& layout = this->The.layout;
  for (int c = 0; c < layout.channels; ++c)
  {
    for (std::size_t i = 0; i < layout.grid.VoxelCount(); ++i)
    {
      sums[c] += static_cast<double>(this->The.medium.SigmaS(i, c)) * values[c * layout.Stride() + i];
    }
  }
  return this->SumOverRanks(sums);
}

void WarmStart::Prepare(const std::vector<float>& direct)
{
  const VolumeLayout& layout = this->The.layout;
  this->First = this->ScatteredOf(direct);
  for (double& watts : this->First)
  {
    watts *= layout.grid.VoxelVolume();
  }
  if (!this->Begins())
  {
    return;
  }
  const MomentPlaces places = layout.Places(this->The.functions);
  this->Collective([&] {
    this->Scaled = this->Kept->scattered;
    for (std::size_t i = 0; i < places.beams; ++i)
    {
      const int c = layout.ChannelOf(places, i);
      const double before = this->Kept->firstScattered[c];
      const double scale = before > 0.0 ? this->First[c] / before : 0.0;
      this->Scaled[i] = static_cast<float>(this->Scaled[i] * scale);
    }
    this->Path = Buffer<float>(this->The.device, this->Scaled, "the last light");
  });
  this->Power = this->ScatteredOf(this->Scaled);
}

void WarmStart::AddGuessTo(const Buffer<float>& source) const
{
  this->Collective([&] {
    if (this->Has())
    {
      this->The.scattering.AddFirstScattered({ &this->Path, nullptr, nullptr, nullptr }, source);
    }
  });
}

void WarmStart::TakeGuessFrom(const Buffer<float>& source)
{
  this->Collective([&] {
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

Rgb WarmStart::MagnitudeOf(const Buffer<float>& source) const
{
  const VolumeLayout& layout = this->The.layout;
  Device& device = this->The.device;
  Rgb sums = {};
  this->Collective([&] {
    if (!this->Has())
    {
      return;
    }
    const std::size_t lines = static_cast<std::size_t>(layout.grid.size[1]) * layout.grid.size[2];
    Buffer<float> tally(device, lines * layout.channels, "sums");
    cl::Kernel kernel = device.Kernel("sum_magnitudes", kernel_source::WarmStart);
    With(kernel, layout.Places(this->The.functions), source, tally, cl_ulong(layout.Stride()));
    device.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(lines, layout.channels), GroupOfLargeItems(device, 2));
    const std::vector<float> values = tally.Read();
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      sums[i / lines] += values[i] * 4.0 * Pi * layout.grid.VoxelVolume();
    }
  });
  return this->SumOverRanks(sums);
}

KeptLight WarmStart::Leave(const std::vector<float>& base, const std::vector<float>& moments, const Rgb& rate) const
{
  const VolumeLayout& layout = this->The.layout;
  KeptLight left;
  left.kind = this->TheKind;
  for (int c = 0; c < layout.channels && this->The.settings.maximumOrders == 0; ++c)
  {
    // The error of a good guess falls faster at first than that of darkness does at last.
    left.rate[c] = std::max(std::min(rate[c], SlowestRate), this->Begins() ? this->Rate(c) : 0.0);
  }
  left.firstScattered = this->First;
  this->Collective([&] {
    left.scattered.assign(layout.MomentFloats(this->The.functions), 0.0f);
    const std::vector<float> fluence = this->The.fluence.Read();
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
