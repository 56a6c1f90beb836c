#pragma once

#include "Medium/Medium.h"

#include <array>
#include <cmath>
#include <random>
#include <vector>

/// A medium whose voxels have nothing to do with each other, and the memory of its arrays. Moves, does not copy.
struct RandomMedium
{
  /// @param components  1 or 3, of both coefficients
  /// @param densest  upper bound of sigma_t, 1/length
  explicit RandomMedium(const std::array<int, 3>& size, int components = 1, float densest = 0.5f, unsigned seed = 1)
    : RandomMedium(tyndall::Grid{ size }, components, densest, seed)
  {
  }

  RandomMedium(const tyndall::Grid& grid, int components, float densest, unsigned seed = 1)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    this->medium.grid = grid;
    for (std::size_t i = 0; i < grid.VoxelCount() * static_cast<std::size_t>(components); ++i)
    {
      const float density = unit(random) < 0.1f ? 0.0f : densest * unit(random); // some voids
      const float albedo = unit(random);
      this->absorption.push_back(density * (1.0f - albedo));
      this->scattering.push_back(density * albedo);
    }
    this->medium.sigma_a = { this->absorption.data(), components };
    this->medium.sigma_s = { this->scattering.data(), components };
  }

  /// In place of that: sigma_t of up to `densest`, even in its logarithm.
  void SpreadOverDecades(double densest, double decades, double albedo, unsigned seed)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> power(-decades, 0.0);
    for (std::size_t i = 0; i < this->absorption.size(); ++i)
    {
      const double sigma_t = densest * std::pow(10.0, power(random));
      this->absorption[i] = static_cast<float>((1.0 - albedo) * sigma_t);
      this->scattering[i] = static_cast<float>(albedo * sigma_t);
    }
  }

  void Emit(float brightest)
  {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.0f, brightest);
    for (std::size_t i = 0; i < this->absorption.size(); ++i)
    {
      this->emission.push_back(unit(random));
    }
    this->medium.emission = { this->emission.data(), this->medium.sigma_a.components };
  }

  RandomMedium(RandomMedium&&) = default;

  tyndall::Medium medium;
  std::vector<float> absorption, scattering, emission;
};

/// A medium with the same coefficients everywhere, and the memory of its arrays.
struct EvenMedium
{
  EvenMedium(const tyndall::Grid& grid, float sigma_a, float sigma_s)
    : absorption(grid.VoxelCount(), sigma_a)
    , scattering(grid.VoxelCount(), sigma_s)
  {
    this->medium.grid = grid;
    this->medium.sigma_a.values = this->absorption.data();
    this->medium.sigma_s.values = this->scattering.data();
  }
  EvenMedium(EvenMedium&&) = default;

  tyndall::Medium medium;
  std::vector<float> absorption, scattering;
};
