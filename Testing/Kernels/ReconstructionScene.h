#pragma once

#include "Reconstruction/PhotonReconstruction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

/// Noisy light that owns its arrays: a truth that is known, and independent noise in each batch.
struct ReconstructionScene
{
  tyndall::Grid grid;
  int channels = 1, batches = 2;
  std::vector<float> fluence, direction, count, weight, batchFluence;

  explicit ReconstructionScene(std::array<int, 3> size, int channelCount = 1, int batchCount = 2)
    : channels(channelCount)
    , batches(batchCount)
  {
    this->grid.size = size;
    this->batchFluence.resize(this->Values() * static_cast<std::size_t>(batchCount));
    this->count.assign(this->grid.VoxelCount(), 1.0f);
    this->weight.assign(this->grid.VoxelCount(), 1.0f);
    for (std::size_t i = 0; i < this->grid.VoxelCount(); ++i)
    {
      this->direction.insert(this->direction.end(), { 0.6f, 0.0f, -0.3f });
    }
  }

  /// Of a value of batchFluence: the fluence that it is of, and its batch.
  std::size_t ValueOf(std::size_t i) const
  {
    const auto width = static_cast<std::size_t>(this->channels), sets = static_cast<std::size_t>(this->batches);
    return i / (width * sets) * width + i % width;
  }
  std::size_t BatchOf(std::size_t i) const
  {
    return i / static_cast<std::size_t>(this->channels) % static_cast<std::size_t>(this->batches);
  }

  std::size_t Values() const { return this->grid.VoxelCount() * static_cast<std::size_t>(this->channels); }

  /// truth(value) times 1 + noise * uniform of mean 0 and deviation 1, in every batch; fluence is their mean.
  ReconstructionScene& Light(const std::function<double(std::size_t)>& truth, double noise, unsigned seed = 1)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> spread(-std::sqrt(3.0), std::sqrt(3.0));
    for (std::size_t i = 0; i < this->batchFluence.size(); ++i)
    {
      this->batchFluence[i] = static_cast<float>(truth(this->ValueOf(i)) * (1.0 + noise * spread(random)));
    }
    return this->Average();
  }

  /// The same, but noise is that of photons along z: one for each column of a batch, and smaller than 1 by the chance
  /// that `photons` of them cross it.
  ReconstructionScene& LightAlongRays(
    const std::function<double(std::size_t)>& truth, double photons, unsigned seed = 1)
  {
    std::mt19937 random(seed);
    std::poisson_distribution<int> crossing(photons);
    const std::size_t columns =
      static_cast<std::size_t>(this->grid.size[0]) * static_cast<std::size_t>(this->grid.size[1]);
    std::vector<double> noise(columns * static_cast<std::size_t>(this->batches));
    std::generate(noise.begin(), noise.end(), [&] { return crossing(random) / photons; });
    for (std::size_t i = 0; i < this->batchFluence.size(); ++i)
    {
      const std::size_t value = this->ValueOf(i), voxel = value / static_cast<std::size_t>(this->channels);
      this->batchFluence[i] = static_cast<float>(truth(value) * noise[this->BatchOf(i) * columns + voxel % columns]);
    }
    return this->Average();
  }

  ReconstructionScene& Average()
  {
    this->fluence.assign(this->Values(), 0.0f);
    for (std::size_t i = 0; i < this->batchFluence.size(); ++i)
    {
      this->fluence[this->ValueOf(i)] += this->batchFluence[i] / this->batches;
    }
    return *this;
  }

  tyndall::NoisyLight Seen() const
  {
    tyndall::NoisyLight light;
    light.grid = this->grid;
    light.channels = this->channels;
    light.batches = this->batches;
    light.fluence = this->fluence.data();
    light.batchFluence = this->batchFluence.data();
    light.photonCount = this->count.data();
    light.photonWeight = this->weight.data();
    light.meanDirection = this->direction.empty() ? nullptr : this->direction.data();
    return light;
  }

  std::array<int, 3> Place(std::size_t voxel) const { return this->grid.VoxelAt(voxel); }
};

inline tyndall::ReconstructionSettings By(tyndall::ReconstructionSettings::Estimator estimator)
{
  tyndall::ReconstructionSettings settings;
  settings.estimator = estimator;
  return settings;
}

/// Total of a channel.
inline double Total(const std::vector<float>& values, int channels, int channel)
{
  double sum = 0.0;
  for (std::size_t i = static_cast<std::size_t>(channel); i < values.size(); i += static_cast<std::size_t>(channels))
  {
    sum += values[i];
  }
  return sum;
}
