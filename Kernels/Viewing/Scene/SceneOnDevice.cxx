#include "Viewing/Scene/SceneOnDevice.h"

#include <vector>

namespace tyndall
{
namespace
{
/// Mean cosine g of each voxel and channel; empty if the phase function is not evaluated or g does not vary.
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

SceneOnDevice::SceneOnDevice(Device& device, const Medium& medium, const SolvedLight& light, const Field& index,
  const ViewTraits& traits, const BlockOfScene* block)
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
  this->ior = Buffer<float>(device, 0, "ior");
  if (!traits.bends)
  {
    return;
  }
  const std::size_t known = block ? block->known.VoxelCount() : voxels;
  const std::vector<float> even(index.values ? 0 : known, 1.0f);
  const Field given = { index.values ? index.values : even.data(), 1 };
  if (block)
  {
    this->knownIor = Buffer<float>(device, given.values, known, "ior");
    this->ior = Buffer<float>(device, HeldIndex(given, *block, medium.grid.size), "ior");
  }
  else
  {
    this->ior = Buffer<float>(device, given.values, known, "ior");
  }
}

void SceneOnDevice::GiveBackWhatIsPacked()
{
  this->arrays = {};
  this->meanDirection = {};
  this->meanCosines = {};
  this->ior = {};
  this->knownIor = {};
}
}
