#include "Viewing/Rays/RayCasting.h"

#include "Device/Defines.h"
#include "Device/Errors.h"
#include "Device/Sizes.h"
#include "Numerics/Vectors.h"
#include "TyndallKernelSources.h"
#include "Viewing/Rays/ViewInfos.h"
#include "Viewing/Samples/Marching.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>

#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
constexpr std::size_t PixelsStartedAtOnce = 65536; ///< each takes 140 bytes
/// size of the first launch; its run time determines the size of the next
constexpr std::size_t RaysMarchedFirst = 4096;

/// Width and height of a packet in pixels, as in View.cl.
std::array<int, 2> PacketPixels(int width)
{
  return width == 16 ? std::array<int, 2>{ 4, 4 }
    : width == 8     ? std::array<int, 2>{ 4, 2 }
    : width == 4     ? std::array<int, 2>{ 2, 2 }
                     : std::array<int, 2>{ 1, 1 };
}
}

ViewInfo RayCasting::ViewOf(const Camera& camera, const ViewSettings& settings, const GridBlock* block) const
{
  ViewInfo view = ViewInfoOf(camera, settings, this->Traits, block);
  const std::array<int, 2> environment = this->Behind.EnvironmentSize();
  view.background = Float4(Vector(this->Behind.Colour(settings)), settings.showBackground ? 1.0 : 0.0);
  view.bricks = Int4(this->Samples.BrickCount());
  view.environment = Int4({ environment[0], environment[1], this->Behind.FacesOfGround() });
  for (int row = 0; row < 3; ++row)
  {
    view.toPicture[row] = Float4(Vector(this->Behind.ToPicture()[row]));
  }
  return view;
}

void RayCasting::Reserve(
  const ViewSettings& settings, const std::vector<float>& ends, bool ofBlock, const std::vector<float>& starts)
{
  const std::size_t pixels = static_cast<std::size_t>(settings.imageSize[0]) * settings.imageSize[1];
  if (this->Alpha.Size() != pixels)
  {
    Buffer<float> radiance(this->TheDevice, 3 * pixels, "the picture");
    Buffer<float> alpha(this->TheDevice, pixels, "the picture's alpha");
    Buffer<float> depth(this->TheDevice, pixels, "the picture's depth");
    this->Radiance.Swap(radiance); // after all allocations succeeded
    this->Alpha.Swap(alpha);
    this->Depth.Swap(depth);
  }
  const std::size_t passed = ofBlock ? 3 * pixels : 0;
  if (this->Passed.Size() != passed)
  {
    this->Passed = Buffer<float>(this->TheDevice, passed, "what the block lets through");
  }
  const std::size_t missing = ofBlock && this->Behind.HasSurfaceLight() ? 3 * pixels : 0;
  if (this->Missing.Size() != missing)
  {
    this->Missing = Buffer<float>(this->TheDevice, missing, "light at the surface");
  }
  if (!ends.empty() && ends.size() != pixels)
  {
    throw InvalidInput("There are ends of " + std::to_string(ends.size()) + " rays for a picture of " +
      std::to_string(pixels) + " pixels.");
  }
  if (this->Ends.Size() != ends.size())
  {
    this->Ends = Buffer<float>(this->TheDevice, ends.size(), "where rays end");
  }
  this->Ends.Write(ends.data());
  if (this->Starts.Size() != starts.size())
  {
    this->Starts = Buffer<float>(this->TheDevice, starts.size(), "what comes through other blocks");
  }
  this->Starts.Write(starts.data());
}

std::string RayCasting::Options(const ViewSettings& settings) const
{
  const ViewTraits& traits = this->Traits;
  // Largest optical length of a step; up to 2 the kernel uses a faster formula. Bent steps can be slightly longer.
  const double longest = traits.largestSigmaT * settings.stepSize *
    *std::max_element(traits.grid.spacing.begin(), traits.grid.spacing.end());
  return traits.PacketOptions() + Define("SKIP_BRICKS", traits.SkipsBricks(settings)) +
    Define("THIN_STEPS", longest <= (traits.bends ? 1.5 : 2.0)) + Define("GLOW", traits.GlowsApart()) +
    traits.PhaseOptions(traits.knowsFlow) + StepOption(LongestSteps(traits.grid, settings.stepSize)) +
    this->Samples.ShownOptions();
}

std::string RayCasting::BentOptions(const ViewSettings& settings) const
{
  const int surface = this->Traits.Reflects(settings) ? static_cast<int>(settings.surfaceReflection) : 0;
  return this->Options(settings) + Define("BENDS", this->Traits.bends) + Define("SURFACE", surface) +
    Define("TABLE", this->Traits.hasTable);
}

cl::Kernel RayCasting::Kernel(const ViewSettings& settings, bool ofBlock) const
{
  if (this->Traits.OnlyStraight())
  {
    return this->TheDevice.Kernel(
      "cast_rays", kernel_source::StraightView, this->Options(settings) + Define("BLOCK", ofBlock));
  }
  return this->TheDevice.Kernel("cast_bent_rays", kernel_source::BentView,
    this->BentOptions(settings) + Define("ENDS", this->Ends.Size() > 0) + Define("ROUNDS", 0));
}

const Buffer<cl_float4>& RayCasting::Environment() const
{
  return this->Samples.PackedFor() == Packing::Unscattered ? this->Behind.SharpEnvironment()
                                                           : this->Behind.Environment();
}

void RayCasting::Cast(
  const ViewSettings& settings, ViewInfo view, const OpticsInfo& optics, double from, double to, const Monitor& monitor)
{
  const PackedSamples& s = this->Samples;
  const Backdrop& b = this->Behind;
  const Buffer<cl_float4>& environment = this->Environment();
  const std::array<int, 2> packet = PacketPixels(this->Traits.packetWidth);
  cl::Kernel cast = this->Kernel(settings, view.block.whole.s[0] > 0);
  view.has = { { this->Ends.Size() > 0, this->Starts.Size() > 0, b.HasSurfaceLight(), 0 } };
  // Batches consist of whole work-groups; otherwise the next batch would render the last rows again.
  const int group = 4;
  const std::size_t across = RoundUp<std::size_t>(view.picture.s[0], group * packet[0]) / (group * packet[0]);
  const std::size_t rows = RoundUp<std::size_t>(view.picture.s[1], group * packet[1]) / (group * packet[1]);
  const double samples = LongestSteps(this->Traits.grid, settings.stepSize) * group * group * packet[0] * packet[1];
  const auto launch = [&](const Patch& part) {
    view.picture.s[2] = part.row * group;
    view.picture.s[3] = part.column * group;
    if (this->Traits.OnlyStraight())
    {
      With(cast, view, s.Samples(), s.Extinctions(), s.Flow(), s.Glow(), s.Cosines(), this->Scene.phaseRows, s.Bricks(),
        s.Records(), environment, b.Ground(), b.SurfaceLight(), this->Ends, this->Starts, this->Radiance, this->Alpha,
        this->Depth, this->Passed, this->Missing);
    }
    else
    {
      With(cast, view, optics, s.Samples(), s.Extinctions(), s.Flow(), s.Glow(), s.Cosines(), this->Scene.phaseRows,
        s.Bending(), b.Table(), s.Bricks(), environment, b.Ground(), this->Ends, this->Radiance, this->Alpha,
        this->Depth);
    }
    this->TheDevice.Queue().enqueueNDRangeKernel(
      cast, cl::NullRange, cl::NDRange(part.columns * group, part.rows * group), cl::NDRange(group, group));
  };
  InBatches(this->TheDevice, BatchesOfRows(rows, across, samples, from, to), monitor,
    [&](std::size_t first, std::size_t count) { InPatches(first, count, across, launch); });
}

void RayCasting::OfRounds(ViewInfo& view)
{
  view.held = view.size;
  view.size = view.block.whole;
}

/// Largest number of rays that are split off one ray while it is in a block.
std::size_t RayCasting::MostSplitOff(const ViewSettings& settings) const
{
  return (this->Traits.Reflects(settings) ? 1 : 0) + (this->Traits.hasTable ? 1 : 0);
}

std::size_t RayCasting::CountThatFits(const ViewSettings& settings) const
{
  const std::size_t limit = this->TheDevice.MemoryLimit(), taken = this->TheDevice.BytesInUse();
  const std::size_t kinds =
    1 + this->MostSplitOff(settings); // of rays of a pixel; each has room for all that it may split
  return std::max<std::size_t>((limit - std::min(taken, limit)) / (4 * kinds * kinds * sizeof(RayOnItsWay)), 1);
}

std::vector<RayOnItsWay> RayCasting::Start(
  const ViewSettings& settings, ViewInfo view, const OpticsInfo& optics, const PixelRows& asked) const
{
  const std::array<int, 2> packet = PacketPixels(this->Traits.packetWidth);
  cl::Kernel start = this->TheDevice.Kernel(
    "start_rays", kernel_source::RayRounds, this->BentOptions(settings) + Define("ENDS", 0) + Define("ROUNDS", 1));
  const std::size_t width = Count(view.picture.s[0]), end = Count(asked.end);
  const std::size_t rows =
    RoundUp<std::size_t>(std::max<std::size_t>(PixelsStartedAtOnce / width, 1), Count(packet[1]));
  Buffer<RayOnItsWay> started(this->TheDevice, std::min(rows, end - Count(asked.begin)) * width, "rays that set off");
  std::vector<RayOnItsWay> ofRows(started.Size()), all;
  for (std::size_t row = Count(asked.begin); row < end; row += rows)
  {
    const std::size_t count = std::min(rows, end - row);
    view.picture.s[2] = static_cast<int>(row);
    With(start, view, optics, this->Samples.Bending(), started);
    this->TheDevice.Queue().enqueueNDRangeKernel(start, cl::NullRange,
      cl::NDRange(RoundUp<std::size_t>(width, 4 * Count(packet[0])) / Count(packet[0]),
        RoundUp<std::size_t>(count, Count(packet[1])) / Count(packet[1])),
      cl::NDRange(4, 1));
    started.Read(ofRows.data(), count * width);
    std::copy_if(ofRows.begin(), ofRows.begin() + static_cast<std::ptrdiff_t>(count * width), std::back_inserter(all),
      [](const RayOnItsWay& ray) { return ray.pixel >= 0; });
  }
  return all;
}

std::vector<RayOnItsWay> RayCasting::March(const ViewSettings& settings, const ViewInfo& view, const OpticsInfo& optics,
  std::vector<RayOnItsWay>& rays, const Monitor& monitor) const
{
  const PackedSamples& s = this->Samples;
  const Backdrop& b = this->Behind;
  cl::Kernel march = this->TheDevice.Kernel(
    "march_rays", kernel_source::RayRounds, this->BentOptions(settings) + Define("ENDS", 0) + Define("ROUNDS", 1));
  const std::size_t width = Count(this->Traits.packetWidth);
  const Buffer<RayOnItsWay> onDevice(this->TheDevice, rays, "rays on their way");
  const Buffer<RayOnItsWay> born(
    this->TheDevice, this->MostSplitOff(settings) * rays.size(), "rays that are split off");
  Batches batches;
  batches.count = rays.size();
  batches.whole = 4 * width;
  batches.first = RaysMarchedFirst;
  batches.growth = 8.0;
  InBatches(this->TheDevice, batches, monitor, [&](std::size_t first, std::size_t count) {
    With(march, view, optics, s.Samples(), s.Extinctions(), s.Flow(), s.Glow(), s.Cosines(), this->Scene.phaseRows,
      s.Bending(), b.Table(), s.Bricks(), this->Environment(), b.Ground(), onDevice, born, cl_int(first),
      cl_int(count));
    this->TheDevice.Queue().enqueueNDRangeKernel(
      march, cl::NullRange, cl::NDRange(RoundUp<std::size_t>(count, 4 * width) / width), cl::NDRange(4));
  });
  onDevice.Read(rays.data());
  std::vector<RayOnItsWay> added = born.Read();
  added.erase(
    std::remove_if(added.begin(), added.end(), [](const RayOnItsWay& ray) { return ray.pixel < 0; }), added.end());
  return added;
}
}
