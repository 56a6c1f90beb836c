#include "LightPropagation/Accuracy/CoarseScene.h"

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
  return Keep(arrays, blocks.Around(own, field.components), field.components);
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
      *field = Keep(this->Means, coarsening.Average(field->values, field->components), field->components);
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
}
