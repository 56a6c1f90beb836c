#include "Viewing/Scene/SceneOnDevice.h"

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
}

SceneOnDevice::SceneOnDevice(
  Device& device, const Medium& medium, const SolvedLight& light, const Field& index, const ViewTraits& traits)
{
  const std::size_t voxels = medium.grid.VoxelCount();
  if (traits.ShowsMoments())
  {
    this->moments = Buffer<float>(device, light.scatteredMoments.values, voxels * light.scatteredMoments.components,
      "the moments of scattered light");
    this->straightOn = Buffer<float>(
      device, light.straightOn.values, voxels * light.straightOn.components, "what is scattered straight on");
  }
  const std::array<Field, 5> fields = ViewedFields(medium, light);
  const std::array<const char*, 5> names = { "sigma_a", "sigma_s", "emission", "fluence", "fluence_direct" };
  for (std::size_t i = 0; i < fields.size(); ++i)
  {
    this->arrays[i] =
      ViewedArray(device, fields[i].values, voxels * traits.components[i], traits.PacksOnce(), names[i]);
  }
  this->meanDirection = ViewedArray(
    device, light.meanDirection.values, traits.knowsFlow ? 3 * voxels : 0, traits.PacksOnce(), "mean_direction");
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
