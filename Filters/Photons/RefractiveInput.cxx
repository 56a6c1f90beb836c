#include "Photons/RefractiveInput.h"

#include "Common/PhaseFunctionData.h"
#include "Photons/PhotonData.h"

#include "vtkCellData.h"
#include "vtkImageData.h"
#include "vtkPointData.h"

#include <utility>

namespace tyndall
{
namespace
{
constexpr const char* LevelsName = "octree_level";

/// Reads the octree level of each voxel, from `octree` or, if that is null, from `medium`; empty if there is no octree.
/// @throws InvalidInput if the voxels of the two images differ, or `octree` has no levels
std::vector<std::uint8_t> LevelsOf(vtkImageData* octree, vtkImageData* medium)
{
  if (!octree)
  {
    return ReadLevels(medium);
  }
  CheckSameVoxels(GridOf(octree), GridOf(medium), "The octree", "Make the octree of the same medium.");
  std::vector<std::uint8_t> levels = ReadLevels(octree);
  Require(!levels.empty(), "The octree's image has no cell array 'octree_level'. Make it with RefractionOctree.");
  return levels;
}

InputsKey KeyOf(vtkAlgorithm* filter, const std::shared_ptr<Device>& device, vtkImageData* medium, vtkImageData* octree,
  const MarchSettings& settings)
{
  constexpr const char* names[] = { "sigma_a", "sigma_s", "emission", "ior" };
  InputsKey key;
  key.device = device;
  key.Add(GridOf(medium));
  key.AddGhosts(medium);
  for (int number = SigmaA; number <= RefractiveIndex; ++number)
  {
    key.Add(ChosenArray(filter, number, medium, names[number]));
  }
  vtkImageData* const ofLevels = octree ? octree : medium;
  key.Add(GridOf(ofLevels));
  key.AddGhosts(ofLevels);
  key.Add(ofLevels->GetCellData()->GetArray(LevelsName));
  key.Add(ofLevels->GetPointData()->GetArray(LevelsName));
  AddPhase(key, medium);
  key.Add(
    { octree ? 1.0 : 0.0, 1.0 * settings.order, settings.stepSize, 1.0 * settings.meanDirection, 1.0 * settings.counts,
      1.0 * settings.batches, 1.0 * static_cast<int>(settings.sums), 1.0 * settings.leaveOut, 1.0 * settings.byBricks,
      1.0 * settings.maximumOrders, static_cast<double>(settings.seed), 1.0 * settings.errorBatches });
  return key;
}
}

namespace
{
RefractiveInput ReadAll(vtkAlgorithm* filter, vtkImageData* medium, vtkImageData* octree, MediumInput&& input)
{
  RefractiveInput read;
  read.input = std::move(input);
  read.ior = ReadChosenCells(filter, RefractiveIndex, medium, "ior", Need::Optional, { 1 });
  read.levels = LevelsOf(octree, medium);
  return read;
}
}

RefractiveInput ReadRefractiveMedium(vtkAlgorithm* filter, vtkImageData* medium, vtkImageData* octree)
{
  return ReadAll(filter, medium, octree, ReadMedium(filter, medium));
}

RefractiveInput ReadRefractiveMedium(
  vtkAlgorithm* filter, const Domain& domain, vtkImageData* medium, vtkImageData* octree)
{
  RefractiveInput read;
  MediumInput input = ReadMedium(filter, domain, medium);
  domain.Collective([&] { read = medium ? ReadAll(filter, medium, octree, std::move(input)) : std::move(read); });
  return read;
}

KeptMarcher::Found KeptMarcher::Find(vtkAlgorithm* filter, const std::shared_ptr<Device>& device, const Domain& domain,
  vtkImageData* medium, vtkImageData* octree, const MarchSettings& settings)
{
  Found found;
  found.marcher = std::move(this->Marcher);
  if (!domain.IsSerial())
  {
    found.marcher.reset();
    const RefractiveInput read = ReadRefractiveMedium(filter, domain, medium, octree);
    found.marcher =
      std::make_unique<PhotonMarcher>(*device, domain, read.input.medium, read.ior, settings, read.Levels());
    return found;
  }
  found.key = KeyOf(filter, device, medium, octree, settings);
  found.kept = found.marcher && found.key == this->Key;
  if (!found.kept)
  {
    found.marcher.reset(); // frees the device memory of the old marcher before the new one is prepared
    this->Made.Modified();
    const RefractiveInput read = ReadRefractiveMedium(filter, medium, octree);
    found.marcher = std::make_unique<PhotonMarcher>(
      *device, Domain(read.input.medium.grid), read.input.medium, read.ior, settings, read.Levels());
  }
  return found;
}

void KeptMarcher::Keep(Found&& found)
{
  this->Marcher = std::move(found.marcher);
  this->Key = std::move(found.key);
}

void KeptMarcher::ForgetIfRan(vtkAlgorithm* filter, std::initializer_list<int> ports)
{
  for (int port : ports)
  {
    if (this->Marcher && RanSince(filter, port, this->Made))
    {
      this->Marcher.reset();
    }
  }
}
}
