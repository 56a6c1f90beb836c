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
#include <string>

#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
/// Columns and rows of pixels in a packet, as in View.cl.
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
  view.environment = Int4({ environment[0], environment[1], 0 });
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
    this->Radiance.Swap(radiance); // all or none, where one does not fit
    this->Alpha.Swap(alpha);
    this->Depth.Swap(depth);
  }
  const std::size_t passed = ofBlock ? 3 * pixels : 0;
  if (this->Passed.Size() != passed)
  {
    this->Passed = Buffer<float>(this->TheDevice, passed, "what the block lets through");
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
  // Longest optical length of a step; the kernel has a shorter way to cross it up to 2. Bent steps can be a little
  // longer.
  const double longest = traits.largestSigmaT * settings.stepSize *
    *std::max_element(traits.grid.spacing.begin(), traits.grid.spacing.end());
  return traits.PacketOptions() + Define("SKIP_BRICKS", traits.SkipsBricks(settings)) +
    Define("ENVIRONMENT", this->Behind.HasEnvironment()) + Define("GROUND", this->Behind.FacesOfGround()) +
    Define("THIN_STEPS", longest <= (traits.bends ? 1.5 : 2.0)) + Define("GLOW", traits.GlowsApart()) +
    traits.PhaseOptions(traits.knowsFlow) + StepOption(LongestSteps(traits.grid, settings.stepSize)) +
    Define("ENDS", this->Ends.Size() > 0) + this->Samples.ShownOptions();
}

cl::Kernel RayCasting::Kernel(const ViewSettings& settings, bool ofBlock) const
{
  if (this->Traits.OnlyStraight())
  {
    return this->TheDevice.Kernel("cast_rays", kernel_source::StraightView,
      this->Options(settings) + Define("SURFACE_LIGHT", this->Behind.HasSurfaceLight()) + Define("BLOCK", ofBlock) +
        Define("STARTS", this->Starts.Size() > 0));
  }
  const int surface = this->Traits.Reflects(settings) ? static_cast<int>(settings.surfaceReflection) : 0;
  return this->TheDevice.Kernel("cast_bent_rays", kernel_source::BentView,
    this->Options(settings) + Define("BENDS", this->Traits.bends) + Define("SURFACE", surface) +
      Define("TABLE", this->Traits.hasTable));
}

void RayCasting::Cast(
  const ViewSettings& settings, ViewInfo view, const OpticsInfo& optics, double from, double to, const Monitor& monitor)
{
  const PackedSamples& s = this->Samples;
  const Backdrop& b = this->Behind;
  const Buffer<cl_float4>& environment = s.PackedFor() == Packing::Unscattered ? b.SharpEnvironment() : b.Environment();
  const std::array<int, 2> packet = PacketPixels(this->Traits.packetWidth);
  cl::Kernel cast = this->Kernel(settings, view.whole.s[0] > 0);
  // Batches of whole work-groups: else the last rows of one would be cast again by the next.
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
        this->Depth, this->Passed);
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
}
