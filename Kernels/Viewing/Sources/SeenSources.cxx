#include "Viewing/Sources/SeenSources.h"

#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"
#include "TyndallKernelSources.h"
#include "Viewing/Samples/Marching.h"
#include "Viewing/Sources/Aureole.h"
#include "Viewing/Sources/SmallLights.h"

#include <algorithm>
#include <cmath>

#include <glm/vec3.hpp>

namespace tyndall
{
namespace
{
/// Aureole tables of each channel, for the smallest straightOn of the scattering voxels; the voxels that matter have
/// this value.
std::vector<float> TablesOfAureole(const Medium& medium, const ViewTraits& traits)
{
  std::vector<float> tables;
  for (int c = 0; c < traits.aureoleChannels; ++c)
  {
    const std::vector<float> table = AureoleTable(medium.phase.OfChannel(c), traits.straightOn[c], traits.momentDegree);
    tables.insert(tables.end(), table.begin(), table.end());
  }
  return tables;
}
}

SeenSources::SeenSources(Device& device, const Medium& medium, const std::vector<Light>& lamps, int rectangleSamples,
  const ViewTraits& traits, const BlockOfScene* block)
  : TheDevice(device)
  , Traits(traits)
  , Block(block)
{
  const std::size_t voxels = medium.grid.VoxelCount();
  this->Small = traits.shadowRays ? SmallLights(lamps, block ? block->block.whole : medium.grid, rectangleSamples)
                                  : std::vector<SmallLight>();
  this->LightCount = static_cast<int>(this->Small.size());
  if (traits.aureoleChannels > 0)
  {
    this->AureoleTables = Buffer<float>(device, TablesOfAureole(medium, traits), "light scattered forwards");
  }
  this->OfLights = Buffer<float>(device, traits.shadowRays ? 6 * voxels : 0, "light found by shadow rays");
  this->OfMoments = Buffer<float>(device, traits.ShowsMoments() ? 3 * voxels : 0, "light scattered towards the eye");
  this->Lights = Buffer<SmallLight>(device, this->Small, "the lights");
}

ShadowInfo SeenSources::InfoOfVoxels() const
{
  const Grid& grid = this->Traits.grid;
  const double radius = std::cbrt(3.0 * grid.VoxelVolume() / (4.0 * Pi));
  ShadowInfo info = {};
  info.spacing = Float4(Vector(grid.spacing));
  info.size = Int4(grid.size);
  info.block = this->Block ? BlockInfoOf(this->Block->block) : BlockInfo{};
  info.phase = this->Traits.phase.parameters;
  info.components = this->Traits.Components();
  info.nearestSquare = static_cast<float>(radius * radius / 3.0);
  info.lights = this->LightCount;
  return info;
}

ShadowInfo SeenSources::MakeShadowInfo(const Camera& camera) const
{
  const Grid& whole = this->Block ? this->Block->block.whole : this->Traits.grid;
  ShadowInfo info = this->InfoOfVoxels();
  info.eye = Float4(Vector(camera.position) - Vector(whole.origin), camera.parallelProjection ? 1.0 : 0.0);
  info.forward = Float4(Vector(Axes(camera)[2]));
  return info;
}

std::string SeenSources::Options(double steps, bool given) const
{
  const ViewTraits& traits = this->Traits;
  return traits.PacketOptions() + traits.PhaseOptions(true) + StepOption(steps) +
    Define("AUREOLE", traits.aureoleChannels) + Define("BESIDE", traits.ShowsMoments()) + Define("GIVEN", given);
}

void SeenSources::SeeLights(const Camera& camera, double stepSize, const SceneOnDevice& scene,
  const PackedSamples& samples, const Monitor& monitor)
{
  const ViewTraits& traits = this->Traits;
  const std::array<int, 3>& size = traits.grid.size;
  ShadowInfo info = this->MakeShadowInfo(camera);
  info.bricks = Int4(samples.BrickCount());
  info.step = static_cast<float>(stepSize);
  const double steps = LongestSteps(traits.grid, stepSize);
  cl::Kernel see = this->TheDevice.Kernel("see_lights", kernel_source::ShadowRays, this->Options(steps, false));
  const std::size_t across = RoundUp<std::size_t>(size[0], 4 * traits.packetWidth) / traits.packetWidth;
  const std::size_t rows = size[1];
  const double samplesOfRow = steps * this->LightCount * size[0];
  const auto launch = [&](const Patch& part) {
    info.firstSlice = part.row;
    info.firstRow = part.column;
    With(see, info, this->Lights, scene.arrays[1].Handle(), scene.meanCosines, scene.phaseRows, samples.Samples(),
      samples.Extinctions(), samples.Bricks(), scene.arrays[0].Handle(), scene.straightOn, this->AureoleTables,
      this->OfMoments, this->OfLights);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      see, cl::NullRange, cl::NDRange(across, part.columns, part.rows), cl::NDRange(4, 1, 1));
  };
  InBatches(this->TheDevice, BatchesOfRows(size[2], rows, samplesOfRow, 0.0, 0.5), monitor,
    [&](std::size_t first, std::size_t count) { InPatches(first, count, rows, launch); });
}

std::vector<float> SeenSources::DepthsTowards(
  int light, const VoxelBox& asked, double stepSize, const PackedSamples& samples, const Monitor& monitor)
{
  const std::array<int, 3>& size = asked.size;
  ShadowInfo info = this->InfoOfVoxels();
  info.bricks = Int4(samples.BrickCount());
  info.step = static_cast<float>(stepSize);
  info.asked = Int4(asked.first);
  info.askedSize = Int4(size);
  info.firstLight = light;
  const double steps = LongestSteps(this->Traits.grid, stepSize);
  cl::Kernel find = this->TheDevice.Kernel("find_depths", kernel_source::ShadowRays, this->Options(steps, true));
  const Buffer<float> depths(this->TheDevice, 3 * asked.VoxelCount(), "optical lengths towards a light");
  const int width = this->Traits.packetWidth;
  const std::size_t across = RoundUp<std::size_t>(size[0], 4 * width) / Count(width);
  const std::size_t rows = Count(size[1]);
  const auto launch = [&](const Patch& part) {
    info.firstSlice = part.row;
    info.firstRow = part.column;
    With(find, info, this->Lights, samples.Samples(), samples.Extinctions(), samples.Bricks(), depths);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      find, cl::NullRange, cl::NDRange(across, part.columns, part.rows), cl::NDRange(4, 1, 1));
  };
  InBatches(this->TheDevice, BatchesOfRows(Count(size[2]), rows, steps * size[0], 0.0, 1.0), monitor,
    [&](std::size_t first, std::size_t count) { InPatches(first, count, rows, launch); });
  return depths.Read();
}

void SeenSources::SeeLight(int light, const Camera& camera, const VoxelBox& part, const std::vector<float>& depths,
  const SceneOnDevice& scene, const PackedSamples& samples)
{
  ShadowInfo info = this->MakeShadowInfo(camera);
  info.bricks = Int4(samples.BrickCount());
  info.firstLight = light;
  info.lights = light + 1;
  info.firstSlice = part.first[2] - this->Block->block.first[2];
  info.firstRow = part.first[1] - this->Block->block.first[1];
  cl::Kernel see = this->TheDevice.Kernel("see_lights", kernel_source::ShadowRays, this->Options(1.0, true));
  const Buffer<float> given(this->TheDevice, depths, "optical lengths towards a light");
  With(see, info, this->Lights, scene.arrays[1].Handle(), scene.meanCosines, scene.phaseRows, samples.Samples(),
    samples.Extinctions(), samples.Bricks(), scene.arrays[0].Handle(), scene.straightOn, this->AureoleTables, given,
    this->OfLights);
  const int width = this->Traits.packetWidth;
  this->TheDevice.Queue().enqueueNDRangeKernel(see, cl::NullRange,
    cl::NDRange(RoundUp<std::size_t>(part.size[0], 4 * width) / Count(width), Count(part.size[1]), Count(part.size[2])),
    cl::NDRange(4, 1, 1));
  this->TheDevice.Finish();
}

void SeenSources::SeeMoments(const Camera& camera, const SceneOnDevice& scene)
{
  const ShadowInfo info = this->MakeShadowInfo(camera);
  cl::Kernel see = this->TheDevice.Kernel("see_moments", kernel_source::SeenMoments,
    Define("DEGREE", this->Traits.momentDegree) + Define("MOMENT_CHANNELS", this->Traits.momentChannels));
  With(see, info, scene.moments, this->OfMoments);
  this->TheDevice.Queue().enqueueNDRangeKernel(see, cl::NullRange,
    cl::NDRange(RoundUp<std::size_t>(info.size.s[0], 8), info.size.s[1], info.size.s[2]), cl::NDRange(8, 1, 1));
}
}
