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
/// Of the voxels in which least goes straight on: those that matter have as much.
std::vector<float> TablesOfAureole(const Medium& medium, const SolvedLight& light, const ViewTraits& traits)
{
  std::vector<float> tables;
  for (int c = 0; c < traits.aureoleChannels; ++c)
  {
    double least = 1.0;
    for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
    {
      least = medium.sigma_s.At(i, c) > 0.0f ? std::min<double>(least, light.straightOn.At(i, c)) : least;
    }
    const std::vector<float> table = AureoleTable(medium.phase.OfChannel(c), least, traits.momentDegree);
    tables.insert(tables.end(), table.begin(), table.end());
  }
  return tables;
}
}

SeenSources::SeenSources(Device& device, const Medium& medium, const SolvedLight& light,
  const std::vector<Light>& lamps, int rectangleSamples, const ViewTraits& traits)
  : TheDevice(device)
  , Traits(traits)
{
  const std::size_t voxels = medium.grid.VoxelCount();
  const std::vector<SmallLight> lights =
    traits.shadowRays ? SmallLights(lamps, medium.grid, rectangleSamples) : std::vector<SmallLight>();
  this->LightCount = static_cast<int>(lights.size());
  if (traits.aureoleChannels > 0)
  {
    this->AureoleTables = Buffer<float>(device, TablesOfAureole(medium, light, traits), "light scattered forwards");
  }
  this->OfLights = Buffer<float>(device, traits.shadowRays ? 6 * voxels : 0, "light found by shadow rays");
  this->OfMoments = Buffer<float>(device, traits.ShowsMoments() ? 3 * voxels : 0, "light scattered towards the eye");
  this->Lights = Buffer<SmallLight>(device, lights, "the lights");
}

ShadowInfo SeenSources::MakeShadowInfo(const Camera& camera) const
{
  const Grid& grid = this->Traits.grid;
  const double radius = std::cbrt(3.0 * grid.VoxelVolume() / (4.0 * Pi));
  ShadowInfo info = {};
  info.spacing = Float4(Vector(grid.spacing));
  info.eye = Float4(Vector(camera.position) - Vector(grid.origin), camera.parallelProjection ? 1.0 : 0.0);
  info.forward = Float4(Vector(Axes(camera)[2]));
  info.size = Int4(grid.size);
  info.phase = this->Traits.phase.parameters;
  info.nearestSquare = static_cast<float>(radius * radius / 3.0);
  info.lights = this->LightCount;
  return info;
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
  cl::Kernel see = this->TheDevice.Kernel("see_lights", kernel_source::ShadowRays,
    traits.PackingOptions() + traits.PhaseOptions(true) + StepOption(steps) +
      Define("AUREOLE", traits.aureoleChannels) + Define("STRAIGHT_ON", traits.straightOnChannels) +
      Define("BESIDE", traits.ShowsMoments()));
  const std::size_t across = RoundUp<std::size_t>(size[0], 4 * traits.packetWidth) / traits.packetWidth;
  const std::size_t rows = size[1];
  const double samplesOfRow = steps * this->LightCount * size[0];
  const auto launch = [&](const Patch& part) {
    info.firstSlice = part.row;
    info.firstRow = part.column;
    With(see, info, this->Lights, scene.arrays[1].Handle(), scene.meanCosines, scene.phaseRows, samples.Samples(),
      samples.Extinctions(), samples.Bricks(), scene.arrays[0].Handle(), scene.straightOn, this->AureoleTables,
      this->OfLights);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      see, cl::NullRange, cl::NDRange(across, part.columns, part.rows), cl::NDRange(4, 1, 1));
  };
  InBatches(this->TheDevice, BatchesOfRows(size[2], rows, samplesOfRow, 0.0, 0.5), monitor,
    [&](std::size_t first, std::size_t count) { InPatches(first, count, rows, launch); });
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
