#include "Viewing/Rays/RayCasting.h"

#include "Device/Device.h"
#include "Device/Errors.h"
#include "Device/Sizes.h"
#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"
#include "TyndallKernelSources.h"
#include "Viewing/Samples/Marching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
constexpr int RoundsAtMost = 16; ///< limit of a ray's path length: this many times the sum of the box's edges
/// Length, in voxels, of a bent ray's piece between two checks of whether the refractive index around it is constant.
constexpr double BentStretch = 4.0;
constexpr double SurfacePrecision = 1.0e-3; ///< accuracy, in voxels, of the point at which the surface splits a ray
/// Number of rays that are created in one launch, 140 bytes each.
constexpr std::size_t PixelsStartedAtOnce = 65536;
/// Number of rays in the first launch of march_rays; its run time determines the number of rays in the next launch.
constexpr std::size_t RaysMarchedFirst = 4096;

/// Largest depth of the box's corners along the view axis, relative to the eye.
double FarDepth(const Grid& grid, const glm::dvec3& eye, const glm::dvec3& forward)
{
  double farDepth = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec3 at(
      corner & 1 ? grid.Length(0) : 0.0, corner & 2 ? grid.Length(1) : 0.0, corner & 4 ? grid.Length(2) : 0.0);
    farDepth = std::max(farDepth, glm::dot(at - eye, forward));
  }
  return farDepth;
}

/// Width and height in pixels of a packet of `width` rays, as in View.cl.
std::array<int, 2> PacketPixels(int width)
{
  return width == 16 ? std::array<int, 2>{ 4, 4 }
    : width == 8     ? std::array<int, 2>{ 4, 2 }
    : width == 4     ? std::array<int, 2>{ 2, 2 }
                     : std::array<int, 2>{ 1, 1 };
}
}

/// Kernel parameters of the picture, its camera and the phase function.
/// @param block  description of the block, if the medium is a block of a larger grid; null: it is the whole domain
ViewInfo RayCasting::ViewOf(const Camera& camera, const GridBlock* block) const
{
  const ViewTraits& traits = this->Traits;
  const ViewSettings& settings = this->Settings;
  const Grid& grid = block ? block->whole : traits.grid;
  const auto axes = Axes(camera);
  CheckDistance(camera, grid);
  const glm::dvec3 inverseSpacing = 1.0 / Vector(grid.spacing);
  const glm::dvec3 eye = Vector(camera.position) - Vector(grid.origin);
  const glm::dvec3 forward = Vector(axes[2]);
  const double halfHeight = camera.parallelProjection ? camera.parallelScale : std::tan(camera.viewAngle * Pi / 360.0);
  const double aspect =
    camera.aspect > 0.0 ? camera.aspect : static_cast<double>(settings.imageSize[0]) / settings.imageSize[1];
  ViewInfo view = {};
  view.eye = Float4(eye * inverseSpacing, camera.parallelProjection ? 1.0 : 0.0);
  view.forward = Float4(forward, 0.0);
  view.right = Float4(halfHeight * aspect * Vector(axes[0]), camera.shift[0]);
  view.up = Float4(halfHeight * Vector(axes[1]), camera.shift[1]);
  view.inverseSpacing = Float4(inverseSpacing, 0.0);
  // Largest optical length of a step. Bent steps can be slightly longer than stepSize.
  const double longest = traits.largestSigmaT * settings.stepSize *
    *std::max_element(traits.grid.spacing.begin(), traits.grid.spacing.end());
  view.marching = Float4({ settings.stepSize, settings.minimumTransmittance, FarDepth(grid, eye, forward) },
    longest <= (traits.bends ? 1.5 : 2.0) ? 1.0 : 0.0);
  view.picture = Int4({ settings.imageSize[0], settings.imageSize[1], 0 });
  view.size = Int4(traits.grid.size);
  if (block)
  {
    view.block = BlockInfoOf(*block);
  }
  // Bent rays travel from block to block, so their positions refer to the whole grid.
  if (block && !traits.OnlyStraight())
  {
    view.held = view.size;
    view.size = view.block.whole;
  }
  view.bricks = Int4(this->Samples.BrickCount());
  view.has.s[3] = traits.SkipsBricks(settings);
  view.phase = traits.phase.parameters;
  return view;
}

/// Kernel parameters of the surface, the table and bent rays.
OpticsInfo RayCasting::OpticsOf() const
{
  const ViewTraits& traits = this->Traits;
  const ViewSettings& settings = this->Settings;
  const BlockOfScene* const ofWhole = this->Part;
  const Grid& grid = traits.grid;
  const double index = traits.SurfaceIndex(settings);
  const int face = std::max(settings.tableFace, 0);
  const std::array<int, 3>& size = ofWhole ? ofWhole->block.whole.size : grid.size;
  const double edges = 1.0 * size[0] + size[1] + size[2];
  const double halvings = std::log2(settings.stepSize / SurfacePrecision);
  OpticsInfo optics = {};
  optics.spacing = Float4(Vector(grid.spacing), 0.0);
  optics.surface = Float4({ index * index, settings.surfaceReflectance, VoxelsBesideSurface }, 0.0);
  optics.table = Float4(Vector(settings.tableColor), settings.tableReflectance);
  optics.face = { { face / 2, face % 2, FaceSize(grid, face)[0], traits.hasTable } };
  optics.flip = { { face / 2 == 0 ? -1.0f : 1.0f, face / 2 == 1 ? -1.0f : 1.0f, face / 2 == 2 ? -1.0f : 1.0f, 0.0f } };
  optics.limits = Int4({ static_cast<int>(std::min(1e9, std::ceil(RoundsAtMost * edges / settings.stepSize))),
    static_cast<int>(std::clamp(BentStretch / settings.stepSize, 1.0, 1e3)),
    static_cast<int>(std::ceil(std::max(halvings, 1.0))) });
  optics.limits.s[3] = traits.Reflects(settings) ? static_cast<int>(settings.surfaceReflection) : 0;
  if (ofWhole)
  {
    optics.knownFirst = Int4(ofWhole->known.first);
    optics.knownSize = Int4(ofWhole->known.size);
  }
  return optics;
}

RayPass RayCasting::PassOf(const Camera& camera, const GridBlock* block, bool sharp) const
{
  RayPass pass = { this->ViewOf(camera, block), this->OpticsOf() };
  this->Behind.Describe(this->Settings, sharp, pass.view);
  if (this->Traits.ShowsMoments() && sharp == this->Behind.IsSky())
  {
    // A picture made of angular moments has two passes. Only the pass for scattered light shows a sky, and only the
    // pass for unscattered light shows a background colour.
    pass.view.background = { { 0.0f, 0.0f, 0.0f, pass.view.background.s[3] } };
  }
  if (sharp)
  {
    // This is the pass for unscattered light. The light that the table reflects diffusely is already in the pass for
    // scattered light.
    pass.optics.table.s[0] = pass.optics.table.s[1] = pass.optics.table.s[2] = 0.0f;
  }
  return pass;
}

std::string RayCasting::Options(const std::string& ofKernel) const
{
  const ViewTraits& traits = this->Traits;
  return traits.PacketOptions() + Define("GLOW", traits.GlowsApart()) + traits.PhaseOptions(traits.knowsFlow) +
    StepOption(LongestSteps(traits.grid, this->Settings.stepSize)) + this->Samples.ShownOptions() + ofKernel;
}

std::string RayCasting::BentOptions(bool rounds) const
{
  return this->Options(Define("BENDS", this->Traits.bends) + Define("ROUNDS", rounds));
}

cl::Kernel RayCasting::Kernel(bool ofBlock) const
{
  return this->Traits.OnlyStraight()
    ? this->TheDevice.Kernel("cast_rays", kernel_source::StraightView, this->Options(Define("BLOCK", ofBlock)))
    : this->TheDevice.Kernel("cast_bent_rays", kernel_source::BentView, this->BentOptions(false));
}

/// Allocates the picture, and uploads the depths at which rays end and the transmittances of the blocks in front.
/// Buffers that have the right size are reused.
/// @param values  number of floats of the picture
/// @param ends    depth at which an opaque surface ends each pixel's ray; empty: no ray ends
/// @param starts  transmittance of the blocks in front, 3 per pixel; empty: 1
void RayCasting::Reserve(std::size_t values, const std::vector<float>& ends, const std::vector<float>& starts)
{
  if (this->Pixels.Size() != values)
  {
    this->Pixels = Buffer<float>(this->TheDevice, values, "the picture");
  }
  std::vector<float> limits = ends;
  limits.insert(limits.end(), starts.begin(), starts.end());
  if (this->Limits.Size() != limits.size())
  {
    this->Limits = Buffer<float>(this->TheDevice, limits.size(), "where rays end");
  }
  this->Limits.Write(limits.data());
}

/// Reads the picture from the device.
/// @param missing  whether the picture includes the correction for light at the surface, Picture::missing
Picture RayCasting::Read(const ViewInfo& view, bool missing) const
{
  Picture picture;
  picture.width = view.picture.s[0];
  picture.height = view.picture.s[1];
  picture.farDepth = view.marching.s[2];
  this->Pixels.ReadInPlace([&](const float* next) {
    const auto take = [&](int each) {
      const float* const begin = next;
      next += Count(each) * Count(picture.width) * Count(picture.height);
      return std::vector<float>(begin, next);
    };
    picture.radiance = take(3);
    picture.alpha = take(1);
    picture.depth = take(1);
    picture.transmittance = view.block.whole.s[0] > 0 ? take(3) : std::vector<float>();
    picture.sceneTransmittance = picture.transmittance;
    picture.missing = missing ? take(3) : std::vector<float>();
  });
  return picture;
}

Picture RayCasting::Cast(RayPass pass, const std::vector<float>& ends, const std::vector<float>& starts, double from,
  double to, const Monitor& monitor)
{
  ViewInfo& view = pass.view;
  const bool ofBlock = view.block.whole.s[0] > 0, hasMissing = ofBlock && this->Behind.HasSurfaceLight();
  const std::size_t pixels = Count(view.picture.s[0]) * Count(view.picture.s[1]);
  Require(ends.empty() || ends.size() == pixels,
    "There are ends of " + std::to_string(ends.size()) + " rays for a picture of " + std::to_string(pixels) +
      " pixels.");
  // Floats per pixel: 3 radiance, 1 alpha, 1 depth; for a block also 3 transmittance; 3 surface light (View.cl).
  this->Reserve((5 + (ofBlock ? 3 : 0) + (hasMissing ? 3 : 0)) * pixels, ends, starts);
  view.has.s[0] = !ends.empty();
  view.has.s[1] = !starts.empty();
  view.has.s[2] = this->Behind.HasSurfaceLight();
  const PackedSamples& s = this->Samples;
  const std::array<int, 2> packet = PacketPixels(this->Traits.packetWidth);
  cl::Kernel cast = this->Kernel(ofBlock);
  // Batches consist of complete work-groups of 4 x 4 packets. Otherwise the device would fill up the last work-group
  // with rows that the next batch renders again.
  const int group = 4;
  const std::size_t across = RoundUp<std::size_t>(view.picture.s[0], group * packet[0]) / (group * packet[0]);
  const std::size_t rows = RoundUp<std::size_t>(view.picture.s[1], group * packet[1]) / (group * packet[1]);
  const double samples =
    LongestSteps(this->Traits.grid, this->Settings.stepSize) * group * group * packet[0] * packet[1];
  const auto launch = [&](const Patch& part) {
    view.picture.s[2] = part.row * group;
    view.picture.s[3] = part.column * group;
    if (this->Traits.OnlyStraight())
    {
      With(cast, view, s.Samples(), s.Extinctions(), s.Flow(), s.Glow(), s.Cosines(), this->Scene.phaseRows, s.Bricks(),
        s.Records(), this->Behind.Tables(), this->Limits, this->Pixels);
    }
    else
    {
      With(cast, pass, s.Samples(), s.Extinctions(), s.Flow(), s.Glow(), s.Cosines(), this->Scene.phaseRows,
        s.Bending(), s.Bricks(), this->Behind.Tables(), this->Limits, this->Pixels);
    }
    this->TheDevice.Queue().enqueueNDRangeKernel(
      cast, cl::NullRange, cl::NDRange(part.columns * group, part.rows * group), cl::NDRange(group, group));
  };
  InBatches(this->TheDevice, BatchesOfRows(rows, across, samples, from, to), monitor,
    [&](std::size_t first, std::size_t count) { InPatches(first, count, across, launch); });
  return this->Read(view, hasMissing);
}

/// Largest number of rays that the surface and the table split off one ray while it is in a block.
std::size_t RayCasting::MostSplitOff() const
{
  return (this->Traits.Reflects(this->Settings) ? 1 : 0) + (this->Traits.hasTable ? 1 : 0);
}

std::size_t RayCasting::CountThatFits() const
{
  const std::size_t limit = this->TheDevice.MemoryLimit(), taken = this->TheDevice.BytesInUse();
  // Rays per pixel: the primary ray and those split off it. While one of them is marched, it needs space for as many
  // more that may be split off, so the memory per pixel is proportional to kinds^2.
  const std::size_t kinds = 1 + this->MostSplitOff();
  return std::max<std::size_t>((limit - std::min(taken, limit)) / (4 * kinds * kinds * sizeof(RayOnItsWay)), 1);
}

std::vector<RayOnItsWay> RayCasting::Start(RayPass pass, const PixelRows& asked) const
{
  ViewInfo& view = pass.view;
  const std::array<int, 2> packet = PacketPixels(this->Traits.packetWidth);
  cl::Kernel start = this->TheDevice.Kernel("start_rays", kernel_source::RayRounds, this->BentOptions(true));
  const std::size_t width = Count(view.picture.s[0]), end = Count(asked.end);
  const std::size_t rows =
    RoundUp<std::size_t>(std::max<std::size_t>(PixelsStartedAtOnce / width, 1), Count(packet[1]));
  Buffer<RayOnItsWay> started(this->TheDevice, std::min(rows, end - Count(asked.begin)) * width, "rays that set off");
  std::vector<RayOnItsWay> ofRows(started.Size()), all;
  for (std::size_t row = Count(asked.begin); row < end; row += rows)
  {
    const std::size_t count = std::min(rows, end - row);
    view.picture.s[2] = static_cast<int>(row);
    With(start, pass, this->Samples.Bending(), started);
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

std::vector<RayOnItsWay> RayCasting::March(RayPass pass, std::vector<RayOnItsWay>& rays, const Monitor& monitor) const
{
  ViewInfo& view = pass.view;
  const PackedSamples& s = this->Samples;
  cl::Kernel march = this->TheDevice.Kernel("march_rays", kernel_source::RayRounds, this->BentOptions(true));
  const std::size_t width = Count(this->Traits.packetWidth);
  const Buffer<RayOnItsWay> onDevice(this->TheDevice, rays, "rays on their way");
  const Buffer<RayOnItsWay> born(this->TheDevice, this->MostSplitOff() * rays.size(), "rays that are split off");
  Batches batches;
  batches.count = rays.size();
  batches.whole = 4 * width;
  batches.first = RaysMarchedFirst;
  batches.growth = 8.0;
  InBatches(this->TheDevice, batches, monitor, [&](std::size_t first, std::size_t count) {
    view.range = Int4({ static_cast<int>(first), static_cast<int>(first + count), 0 });
    With(march, pass, s.Samples(), s.Extinctions(), s.Flow(), s.Glow(), s.Cosines(), this->Scene.phaseRows, s.Bending(),
      s.Bricks(), this->Behind.Tables(), onDevice, born);
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
