#include "LightPropagation/Accuracy/ResampledScene.h"

#include "Medium/BoxFaces.h"
#include "Medium/Coarsening.h"

#include <utility>

namespace tyndall
{
namespace
{
using Arrays = std::deque<std::vector<float>>; ///< whose values do not move

Field Keep(Arrays& arrays, std::vector<float>&& values, int components)
{
  arrays.push_back(std::move(values));
  return { arrays.back().data(), components };
}

/// Values of a field in all fine voxels that overlap the coarse voxels of this rank. Collective.
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

std::array<int, 3> PartsOf(const Grid& whole, const std::array<bool, 3>& periodic)
{
  std::array<int, 3> parts = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    parts[axis] = whole.size[axis] == 1 && periodic[axis] ? 1 : 2;
  }
  return parts;
}

Grid Divide(Grid grid, const std::array<int, 3>& parts)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.size[axis] *= parts[axis];
    grid.spacing[axis] /= parts[axis];
  }
  return grid;
}
}

CoarseScene::CoarseScene(const CoarseBlocks& blocks, const SceneBlock& fine)
  : TheDomain(blocks.Comm(), blocks.Coarse())
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

/// Means weighted by sigma_t of the fine voxels, so that the medium takes the same power.
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

/// Means weighted by the fluence.
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

DividedScene::DividedScene(const Medium& medium, const Illumination& illumination, const std::array<bool, 3>& periodic)
  : DividedScene(medium, illumination, periodic, medium.grid)
{
}

DividedScene::DividedScene(
  const Medium& part, const Illumination& illumination, const std::array<bool, 3>& periodic, const Grid& whole)
  : Whole(whole)
  , Given(part.grid)
  , Along(PartsOf(whole, periodic))
  , Divided(part)
  , Light(illumination)
{
  this->Divided.grid = Divide(part.grid, this->Along);
  for (Field* field : { &this->Divided.sigma_a, &this->Divided.sigma_s, &this->Divided.emission,
         &this->Light.uncollided.fluence, &this->Light.uncollided.meanDirection })
  {
    *field = this->Repeated(*field);
  }
  if (part.phase.Varies())
  {
    this->Divided.phase = part.phase.WithG(this->Repeated(part.phase.G()));
  }
}

BlockPartition DividedScene::BlocksOf(const BlockPartition& given) const
{
  BlockPartition divided = { Divide(given.whole, this->Along), given.blocks };
  for (VoxelBox& block : divided.blocks)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      block.first[axis] *= this->Along[axis];
      block.size[axis] *= this->Along[axis];
    }
  }
  return divided;
}

double DividedScene::Parts() const
{
  return this->Along[0] * this->Along[1] * this->Along[2];
}

Field DividedScene::Repeated(const Field& field)
{
  if (!field.values)
  {
    return field;
  }
  const Grid& fine = this->Divided.grid;
  const std::array<int, 3>& parts = this->Along;
  std::vector<float> values;
  values.reserve(fine.VoxelCount() * field.components);
  for (int z = 0; z < fine.size[2]; ++z)
  {
    for (int y = 0; y < fine.size[1]; ++y)
    {
      for (int x = 0; x < fine.size[0]; ++x)
      {
        const float* const from =
          field.values + this->Given.IndexOf({ x / parts[0], y / parts[1], z / parts[2] }) * field.components;
        values.insert(values.end(), from, from + field.components);
      }
    }
  }
  this->Arrays.push_back(std::move(values));
  Field repeated = field;
  repeated.values = this->Arrays.back().data();
  return repeated;
}

void DividedScene::UndoCells(std::vector<float>& values) const
{
  const Grid fine = Divide(this->Whole, this->Along);
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
