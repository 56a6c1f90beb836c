#include "Viewing/Scene/SceneOnDevice.h"

#include "Device/HostThreads.h"
#include "Device/Sizes.h"

#include <algorithm>
#include <vector>

namespace tyndall
{
namespace
{
/// g of each voxel and channel, where any light has a direction.
std::vector<float> MeanCosines(const PhaseOfMedium& phase, const ViewTraits& traits)
{
  std::vector<float> g;
  const std::size_t count = traits.ReadsMeanCosines() ? traits.grid.VoxelCount() * traits.phase.channels : 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    g.push_back(phase.G().At(i / traits.phase.channels, static_cast<int>(i % traits.phase.channels)));
  }
  return g;
}

/// Calls fill(values) with the memory of an array on a CPU: what nobody writes takes none.
template <class Fill>
void WriteInPlace(Device& device, const Buffer<float>& buffer, const Fill& fill)
{
  device.AwaitFirstRuns();
  cl::CommandQueue& queue = device.Queue();
  void* const values = queue.enqueueMapBuffer(buffer.Handle(), CL_TRUE, CL_MAP_WRITE, 0, buffer.Size() * sizeof(float));
  fill(static_cast<float*>(values));
  queue.enqueueUnmapMemObject(buffer.Handle(), values);
}

/// An array of voxels, of which those that rays do not see may be anything.
Buffer<float> Upload(
  Device& device, const float* values, std::size_t components, const ViewTraits& traits, const char* what)
{
  Buffer<float> buffer(device, traits.grid.VoxelCount() * components, what);
  // Shadow rays and moments look at voxels one by one, seen or not.
  const bool whole = traits.bricks.all || traits.shadowRays || traits.ShowsMoments();
  if (whole || !device.IsCpu() || buffer.Size() == 0)
  {
    buffer.Write(values);
    return buffer;
  }
  const SeenBricks& bricks = traits.bricks;
  const std::array<int, 3>& size = traits.grid.size;
  WriteInPlace(device, buffer, [&](float* to) {
    InThreads(Count(size[1]) * Count(size[2]), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row)
      {
        const std::size_t y = row % Count(size[1]) / BrickEdge, z = row / Count(size[1]) / BrickEdge;
        const unsigned char* const sight = &bricks.sight[(z * Count(bricks.count[1]) + y) * Count(bricks.count[0])];
        for (int brick = 0; brick < bricks.count[0]; ++brick)
        {
          const std::size_t first = (row * Count(size[0]) + Count(brick * BrickEdge)) * components;
          const std::size_t voxels = Count(std::min<int>(BrickEdge, size[0] - brick * BrickEdge));
          if (sight[brick] != SeenBricks::Unseen)
          {
            std::copy_n(values + first, voxels * components, to + first);
          }
        }
      }
    });
  });
  return buffer;
}
}

SceneOnDevice::SceneOnDevice(
  Device& device, const Medium& medium, const SolvedLight& light, const Field& index, const ViewTraits& traits)
{
  const std::size_t voxels = medium.grid.VoxelCount();
  if (traits.ShowsMoments())
  {
    this->moments = Upload(device, light.scatteredMoments.values, Count(light.scatteredMoments.components), traits,
      "the moments of scattered light");
    this->straightOn = Upload(
      device, light.straightOn.values, Count(light.straightOn.components), traits, "what is scattered straight on");
  }
  const std::array<Field, 5> fields = ViewedFields(medium, light);
  const std::array<const char*, 5> names = { "sigma_a", "sigma_s", "emission", "fluence", "fluence_direct" };
  for (std::size_t i = 0; i < fields.size(); ++i)
  {
    this->arrays[i] = Upload(device, fields[i].values, Count(traits.components[i]), traits, names[i]);
  }
  this->meanDirection = Upload(device, light.meanDirection.values, traits.knowsFlow ? 3 : 0, traits, "mean_direction");
  this->phaseRows = Buffer<float>(device,
    traits.ReadsPhase() ? RowsOf(traits.phase, medium.phase) : std::vector<float>(), "the rows of the phase function");
  this->meanCosines = Buffer<float>(device, MeanCosines(medium.phase, traits), "g");
  const std::vector<float> even(traits.bends && !index.values ? voxels : 0, 1.0f);
  this->ior = Buffer<float>(device, index.values ? index.values : even.data(), traits.bends ? voxels : 0, "ior");
}

void SceneOnDevice::GiveBackWhatIsPacked()
{
  this->arrays = {};
  this->meanDirection = {};
  this->meanCosines = {};
  this->ior = {};
}
}
