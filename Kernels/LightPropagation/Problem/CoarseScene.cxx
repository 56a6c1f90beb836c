#include "LightPropagation/Problem/CoarseScene.h"

namespace tyndall
{
namespace
{
/// sigma_t of a voxel and channel, [voxel][channel].
std::vector<float> Extinctions(const Medium& medium, int channels)
{
  std::vector<float> values;
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      values.push_back(medium.sigma_a.At(i, c) + medium.sigma_s.At(i, c));
    }
  }
  return values;
}
}

CoarseScene::CoarseScene(const Medium& medium, const Illumination& illumination, const Coarsening& coarsening)
  : Averaged(medium)
  , Light(illumination)
{
  this->AverageMedium(coarsening);
  if (illumination.uncollided.IsThere())
  {
    this->AverageGivenLight(medium, coarsening);
  }
}

void CoarseScene::AverageMedium(const Coarsening& coarsening)
{
  this->Averaged.grid = coarsening.Coarse();
  if (const Field g = this->Averaged.phase.G(); g.values)
  {
    this->G = coarsening.Average(g, this->Averaged.sigma_s);
    const auto components = static_cast<int>(this->G.size() / coarsening.Coarse().VoxelCount());
    this->Averaged.phase = this->Averaged.phase.WithG({ this->G.data(), components });
  }
  int next = 0;
  for (Field* field : { &this->Averaged.sigma_a, &this->Averaged.sigma_s, &this->Averaged.emission })
  {
    if (field->values)
    {
      this->Coefficients[next] = coarsening.Average(field->values, field->components);
      field->values = this->Coefficients[next].data();
      ++next;
    }
  }
}

void CoarseScene::AverageGivenLight(const Medium& medium, const Coarsening& coarsening)
{
  UncollidedImage& image = this->Light.uncollided;
  const Field fluence = image.fluence, mean = image.meanDirection;
  if (mean.values)
  {
    this->AverageDirections(mean, fluence, coarsening);
    image.meanDirection = { this->Directions.data(), 3 };
  }
  const int channels = fluence.HasColour() || medium.Channels() == 3 ? 3 : 1;
  this->AverageFluence(fluence, Extinctions(medium, channels), channels, coarsening);
  image.fluence = { this->Fluence.data(), channels };
}

void CoarseScene::AverageFluence(
  const Field& fluence, const std::vector<float>& extinctions, int channels, const Coarsening& coarsening)
{
  std::vector<float> lost(extinctions.size()), all(extinctions.size());
  for (std::size_t i = 0; i < lost.size(); ++i)
  {
    all[i] = fluence.At(i / channels, static_cast<int>(i % channels));
    lost[i] = extinctions[i] * all[i];
  }
  this->Fluence = coarsening.Average(all.data(), channels);
  const std::vector<float> meanLost = coarsening.Average(lost.data(), channels);
  const std::vector<float> meanExtinction = coarsening.Average(extinctions.data(), channels);
  for (std::size_t i = 0; i < this->Fluence.size(); ++i)
  {
    this->Fluence[i] = meanExtinction[i] > 0.0f ? meanLost[i] / meanExtinction[i] : this->Fluence[i];
  }
}

void CoarseScene::AverageDirections(const Field& mean, const Field& fluence, const Coarsening& coarsening)
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
  this->Directions = coarsening.Average(flux.data(), 3);
  const std::vector<float> of = coarsening.Average(light.data(), 1);
  for (std::size_t i = 0; i < this->Directions.size(); ++i)
  {
    this->Directions[i] = of[i / 3] > 0.0f ? this->Directions[i] / of[i / 3] : 0.0f;
  }
}
}
