#include "LightPropagation/Accuracy/ResampledScene.h"

#include "Medium/BoxFaces.h"
#include "Medium/Coarsening.h"

#include <utility>

namespace tyndall
{
namespace
{
/// Arrays to which fields refer; a deque, so that values are not moved when arrays are added.
using Arrays = std::deque<std::vector<float>>;

Field Keep(Arrays& arrays, std::vector<float>&& values, int components)
{
  arrays.push_back(std::move(values));
  return { arrays.back().data(), components };
}

/// Gathers the values of a field in all fine voxels that overlap this rank's coarse voxels. Collective.
/// @param arrays  receives the values
Field Gather(const CoarseBlocks& blocks, const Field& field, Arrays& arrays)
{
  if (!field.values)
  {
    return field;
  }
  const std::size_t voxels = blocks.Fine().blocks[blocks.Comm().Rank()].VoxelCount();
  const std::vector<float> own(field.values, field.values + voxels * static_cast<std::size_t>(field.components));
  Field gathered = field;
  gathered.values = Keep(arrays, blocks.Around(own, field.components), field.components).values;
  return gathered;
}
}

CoarseScene::CoarseScene(const CoarseBlocks& blocks, const SceneBlock& fine)
  : TheDomain(fine.domain.WithBlocks(blocks.Coarse()))
  , Averaged(fine.medium)
  , Light(fine.illumination)
{
  const bool isEmpty = fine.domain.IsEmpty();
  if (fine.domain.Any(fine.index.values != nullptr))
  {
    const std::size_t voxels = isEmpty || !fine.index.values ? 0 : fine.domain.Own().VoxelCount();
    this->Index = Keep(this->Means, blocks.Average({ fine.index.values, fine.index.values + voxels }, 1), 1);
  }
  Arrays gathered;
  UncollidedImage& given = this->Light.uncollided;
  if (blocks.Straddle() && !isEmpty)
  {
    this->Averaged.grid = blocks.Own().Fine();
    for (Field* field : { &this->Averaged.sigma_a, &this->Averaged.sigma_s, &this->Averaged.emission, &given.fluence,
           &given.meanDirection })
    {
      *field = Gather(blocks, *field, gathered);
    }
    if (fine.medium.phase.Varies())
    {
      this->Averaged.phase = fine.medium.phase.WithG(Gather(blocks, fine.medium.phase.G(), gathered));
    }
  }
  if (!blocks.HasOwn())
  {
    this->Averaged = Medium();
    given.fluence = given.meanDirection = {};
  }
  blocks.Comm().Collective([&] {
    if (blocks.HasOwn())
    {
      const Medium around = this->Averaged;
      this->AverageMedium(blocks.Own());
      if (given.IsThere())
      {
        this->AverageGivenLight(around, blocks.Own());
      }
    }
  });
}

void CoarseScene::AverageMedium(const Coarsening& coarsening)
{
  this->Averaged.grid = coarsening.Coarse();
  if (const Field g = this->Averaged.phase.G(); g.values)
  {
    std::vector<float> averages = coarsening.Average(g, this->Averaged.sigma_s);
    const auto components = static_cast<int>(averages.size() / coarsening.Coarse().VoxelCount());
    this->Averaged.phase = this->Averaged.phase.WithG(Keep(this->Means, std::move(averages), components));
  }
  for (Field* field : { &this->Averaged.sigma_a, &this->Averaged.sigma_s, &this->Averaged.emission })
  {
    if (field->values)
    {
      std::vector<float> means = coarsening.Average(field->values, field->components);
      field->values = Keep(this->Means, std::move(means), field->components).values;
    }
  }
}

void CoarseScene::AverageGivenLight(const Medium& fine, const Coarsening& coarsening)
{
  UncollidedImage& image = this->Light.uncollided;
  const Field fluence = image.fluence;
  if (image.meanDirection.values)
  {
    image.meanDirection = this->AveragedDirections(image.meanDirection, fluence, coarsening);
  }
  image.fluence = this->AveragedFluence(fine, fluence, coarsening);
}

/// Mean fluence of each coarse voxel, weighted by sigma_t of its fine voxels, so that the medium removes the same power
/// from the light as on the fine grid.
Field CoarseScene::AveragedFluence(const Medium& fine, const Field& fluence, const Coarsening& coarsening)
{
  const int channels = fluence.HasColour() || fine.Channels() == 3 ? 3 : 1;
  std::vector<float> extinctions, lost, all;
  for (std::size_t i = 0; i < fine.grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      extinctions.push_back(fine.sigma_a.At(i, c) + fine.sigma_s.At(i, c));
      all.push_back(fluence.At(i, c));
      lost.push_back(extinctions.back() * all.back());
    }
  }
  std::vector<float> averages = coarsening.Average(all.data(), channels);
  const std::vector<float> meanLost = coarsening.Average(lost.data(), channels);
  const std::vector<float> meanExtinction = coarsening.Average(extinctions.data(), channels);
  for (std::size_t i = 0; i < averages.size(); ++i)
  {
    averages[i] = meanExtinction[i] > 0.0f ? meanLost[i] / meanExtinction[i] : averages[i];
  }
  return Keep(this->Means, std::move(averages), channels);
}

/// Mean direction of light in each coarse voxel: the mean over its fine voxels, weighted by fluence.
Field CoarseScene::AveragedDirections(const Field& mean, const Field& fluence, const Coarsening& coarsening)
{
  const std::size_t voxels = coarsening.Fine().VoxelCount();
  std::vector<float> flux(3 * voxels), light(voxels);
  for (std::size_t i = 0; i < voxels; ++i)
  {
    light[i] = (fluence.At(i, 0) + fluence.At(i, 1) + fluence.At(i, 2)) / 3.0f;
    for (int a = 0; a < 3; ++a)
    {
      flux[3 * i + a] = light[i] * mean.At(i, a);
    }
  }
  std::vector<float> directions = coarsening.Average(flux.data(), 3);
  const std::vector<float> of = coarsening.Average(light.data(), 1);
  for (std::size_t i = 0; i < directions.size(); ++i)
  {
    directions[i] = of[i / 3] > 0.0f ? directions[i] / of[i / 3] : 0.0f;
  }
  return Keep(this->Means, std::move(directions), 3);
}

Grid Refined(const Grid& coarse, const Factors& factors)
{
  Grid fine = coarse;
  for (int axis = 0; axis < 3; ++axis)
  {
    fine.size[axis] = coarse.size[axis] * factors[axis];
    fine.spacing[axis] = coarse.spacing[axis] / factors[axis];
  }
  return fine;
}

std::vector<float> Repeated(const float* values, int components, const Grid& coarse, const Factors& factors)
{
  const Grid fine = Refined(coarse, factors);
  std::vector<float> repeated;
  repeated.reserve(fine.VoxelCount() * components);
  ForGridVoxels(fine.size, [&](std::size_t, int x, int y, int z) {
    const float* const from = values + coarse.IndexOf({ x / factors[0], y / factors[1], z / factors[2] }) * components;
    repeated.insert(repeated.end(), from, from + components);
  });
  return repeated;
}

Factors DividedScene::Halves(const Grid& whole, const std::array<bool, 3>& periodic)
{
  Factors parts = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    parts[axis] = whole.size[axis] == 1 && periodic[axis] ? 1 : 2;
  }
  return parts;
}

DividedScene::DividedScene(const SceneBlock& scene, const Factors& parts)
  : Whole(scene.domain.Whole())
  , Given(scene.medium.grid)
  , Along(parts)
  , TheDomain(scene.domain)
  , Divided(scene.medium)
  , Light(scene.illumination)
{
  BlockPartition blocks = { Refined(this->Whole, parts), scene.domain.Partition().blocks };
  for (VoxelBox& block : blocks.blocks)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      block.first[axis] *= parts[axis];
      block.size[axis] *= parts[axis];
    }
  }
  this->TheDomain = scene.domain.WithBlocks(std::move(blocks));
  this->Divided.grid = Refined(this->Given, parts);
  for (Field* field : { &this->Divided.sigma_a, &this->Divided.sigma_s, &this->Divided.emission,
         &this->Light.uncollided.fluence, &this->Light.uncollided.meanDirection })
  {
    *field = this->Repeated(*field);
  }
  if (scene.medium.phase.Varies())
  {
    this->Divided.phase = scene.medium.phase.WithG(this->Repeated(scene.medium.phase.G()));
  }
}

Field DividedScene::Repeated(const Field& field)
{
  Field repeated = field;
  if (field.values)
  {
    std::vector<float> values = tyndall::Repeated(field.values, field.components, this->Given, this->Along);
    repeated.values = Keep(this->Arrays, std::move(values), field.components).values;
  }
  return repeated;
}

void DividedScene::UndoCells(std::vector<float>& values) const
{
  const Grid fine = Refined(this->Whole, this->Along);
  const std::size_t components = values.size() / BoxFaceCellCount(fine);
  if (components == 0)
  {
    return;
  }
  std::vector<float> sums(BoxFaceCellCount(this->Whole) * components, 0.0f);
  ForBoxFaceCells(fine, [&](const BoxFaceCell& cell) {
    const PlaneAxes axes = AcrossAxis(cell.face / 2);
    const BoxFaceLayout layout = LayoutOfFace(this->Whole, cell.face);
    const int partsU = this->Along[axes.u], partsV = this->Along[axes.v];
    const std::size_t parent =
      layout.first + cell.u / partsU * layout.step[axes.u] + cell.v / partsV * layout.step[axes.v];
    const float part = 1.0f / static_cast<float>(partsU * partsV);
    for (std::size_t k = 0; k < components; ++k)
    {
      sums[parent * components + k] += part * values[cell.number * components + k];
    }
  });
  values = std::move(sums);
}

void DividedScene::Undo(LightField& light) const
{
  const Coarsening back(this->Divided.grid, this->Given);
  const std::size_t voxels = this->Divided.grid.VoxelCount();
  for (std::vector<float>* values : { &light.fluence, &light.fluenceDirect, &light.netFlux, &light.scatteredRadiance,
         &light.scatteredMoments, &light.straightOn })
  {
    if (!values->empty())
    {
      *values = back.Average(values->data(), static_cast<int>(values->size() / voxels));
    }
  }
  this->UndoCells(light.surfaceRadiance);
  this->UndoCells(light.facePower);
}
}
