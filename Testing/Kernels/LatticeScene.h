#pragma once

#include "DeviceTest.h"
#include "MediumScene.h"

#include "LatticeBoltzmann/LatticeBoltzmann.h"

#include <array>
#include <string>
#include <vector>

/// Solves scenes on a lattice.
class LatticeTest : public DeviceTest
{
protected:
  tyndall::LightField Solve(Scene& scene, const tyndall::LatticeSettings& settings = {},
    const std::vector<float>& ior = {}, const tyndall::Monitor& monitor = {})
  {
    scene.Attach();
    return tyndall::SolveLatticeBoltzmann(this->GetDevice(), tyndall::Domain(scene.medium.grid), scene.medium,
      { ior.empty() ? nullptr : ior.data(), 1 }, scene.light, settings, monitor);
  }

  /// Mean powers of the place of a pulse's light, of equal voxels of albedo 1, after some steps.
  struct Spread
  {
    std::array<double, 4> square = {}, fourth = {}; ///< along x, y, z, and the diagonal of x and y
  };
  Spread SpreadOfPulse(const tyndall::LatticeSettings& of, double thickness, int steps)
  {
    constexpr int Edge = 35, Middle = Edge / 2;
    Scene scene({ Edge, Edge, Edge }, 0.0f, static_cast<float>(thickness));
    // A source that shines evenly: its light's variance is the mean over the time since it began.
    scene.emission.assign(scene.sigma_s.size(), 0.0f);
    scene.emission[(Middle * Edge + Middle) * Edge + Middle] = 1.0f;
    tyndall::LatticeSettings settings = of;
    settings.maximumSteps = steps;
    const tyndall::LightField light = this->Solve(scene, settings);
    Spread spread;
    double all = 0.0;
    for (std::size_t i = 0; i < light.fluence.size(); ++i)
    {
      const double x = static_cast<int>(i % Edge) - Middle, y = static_cast<int>(i / Edge % Edge) - Middle,
                   z = static_cast<int>(i / Edge / Edge) - Middle;
      all += light.fluence[i];
      const double places[4] = { x, y, z, std::sqrt(0.5) * (x + y) };
      for (int a = 0; a < 4; ++a)
      {
        spread.square[a] += light.fluence[i] * std::pow(places[a], 2);
        spread.fourth[a] += light.fluence[i] * std::pow(places[a], 4);
      }
    }
    for (int a = 0; a < 4; ++a)
    {
      spread.square[a] /= all;
      spread.fourth[a] /= all;
    }
    return spread;
  }

  /// Growth of a pulse's variance along each axis and the diagonal, over that of a diffusion coefficient in voxels.
  std::array<double, 4> GrowthOver(double diffusion, const tyndall::LatticeSettings& settings, double thickness)
  {
    const int third = std::max(static_cast<int>(1.5 / diffusion), 6);
    std::array<Spread, 3> spread;
    for (int part = 0; part < 3; ++part)
    {
      spread[part] = this->SpreadOfPulse(settings, thickness, (part + 1) * third);
    }
    std::array<double, 4> growth = {};
    for (int a = 0; a < 4; ++a)
    {
      // Variance times time is D T^2, less what light lacked before it was scattered, in proportion to T.
      const double grows = third * (3.0 * spread[2].square[a] - 4.0 * spread[1].square[a] + spread[0].square[a]);
      growth[a] = grows / (2.0 * diffusion * third * third);
    }
    return growth;
  }

  static bool Says(const std::vector<std::string>& sentences, const std::string& words)
  {
    for (const std::string& sentence : sentences)
    {
      if (sentence.find(words) != std::string::npos)
      {
        return true;
      }
    }
    return false;
  }
};
