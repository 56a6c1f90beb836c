#pragma once

#include "LightPropagation/Conservative/ConservativePropagation.h"

#include <cmath>
#include <random>
#include <vector>

inline tyndall::Light PointLamp(const std::array<double, 3>& position, const tyndall::Rgb& power = { 1.0, 1.0, 1.0 })
{
  tyndall::Light lamp;
  lamp.type = tyndall::LightType::Point;
  lamp.position = position;
  lamp.power = power;
  return lamp;
}

/// A medium that owns its arrays.
struct Scene
{
  tyndall::Medium medium;
  tyndall::Illumination light;
  tyndall::PropagationSettings settings;
  std::vector<float> sigma_a, sigma_s, emission;

  explicit Scene(std::array<int, 3> size, float absorption = 0.0f, float scattering = 0.0f)
  {
    this->medium.grid.size = size;
    this->sigma_a.assign(this->medium.grid.VoxelCount(), absorption);
    this->sigma_s.assign(this->medium.grid.VoxelCount(), scattering);
  }

  /// Densities spread evenly over `decades` powers of ten up to `thickest`, the same for the same seed.
  void Randomise(double thickest, double decades, double albedo, unsigned seed = 1)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> exponent(-decades, 0.0);
    for (std::size_t i = 0; i < this->sigma_a.size(); ++i)
    {
      const double sigma_t = thickest * std::pow(10.0, exponent(random));
      this->sigma_a[i] = static_cast<float>(sigma_t * (1.0 - albedo));
      this->sigma_s[i] = static_cast<float>(sigma_t * albedo);
    }
  }

  /// Gives every voxel an extinction by channel, with albedo 0.9.
  void SetExtinctions(const std::vector<float>& sigma)
  {
    this->sigma_a.clear();
    this->sigma_s.clear();
    for (std::size_t i = 0; i < this->medium.grid.VoxelCount(); ++i)
    {
      for (const float sigma_t : sigma)
      {
        this->sigma_a.push_back(0.1f * sigma_t);
        this->sigma_s.push_back(0.9f * sigma_t);
      }
    }
  }

  /// Lets the medium see its arrays as they are now.
  void Attach()
  {
    this->medium.sigma_a = { this->sigma_a.data(), this->ComponentsOf(this->sigma_a) };
    this->medium.sigma_s = { this->sigma_s.data(), this->ComponentsOf(this->sigma_s) };
    this->medium.emission = { this->emission.empty() ? nullptr : this->emission.data(),
      this->emission.empty() ? 1 : this->ComponentsOf(this->emission) };
  }

  tyndall::LightField Solve(
    tyndall::Device& device, const tyndall::Monitor& monitor = {}, tyndall::KeptLight* kept = nullptr)
  {
    this->Attach();
    return tyndall::SolveConservative(device, this->medium, this->light, this->settings, monitor, kept);
  }

  int ComponentsOf(const std::vector<float>& values) const
  {
    return static_cast<int>(values.size() / this->medium.grid.VoxelCount());
  }

  void ShineFromEverywhere(double radiance) { this->light.sky = { radiance, radiance, radiance }; }
  void ShineAlong(std::array<double, 3> direction, double irradiance = 1.0)
  {
    tyndall::Light sun;
    sun.direction = direction;
    sun.power = { irradiance, irradiance, irradiance };
    this->light.lights.push_back(sun);
  }
};
