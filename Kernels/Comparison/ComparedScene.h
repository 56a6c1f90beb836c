#pragma once

#include "Comparison/GridTransfer.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tyndall
{
/// The scene that all solvers are given. Refers to arrays that it does not own.
struct ComparedScene
{
  Medium medium;
  Illumination illumination;
  Field ior;                            ///< null values: 1 everywhere
  const std::uint8_t* levels = nullptr; ///< octree levels by voxel, for photons; null: none
  std::array<bool, 3> periodic = { false, false, false };

  bool BendsLight() const; ///< whether the refractive index varies
  bool Emits() const;      ///< whether any voxel emits
  /// Why photons cannot simulate this scene; empty if they can.
  /// @param all  including scattered light
  std::string WhyNotByPhotons(bool all) const;
};

/// A scene on a coarser or finer grid: coefficients are averaged over voxels, or repeated; the mean cosine is averaged
/// with weight sigma_s.
class RescaledScene
{
public:
  enum class To
  {
    Coarser,
    Finer
  };
  RescaledScene(const ComparedScene& scene, To to, const Factors& factors);
  RescaledScene(const RescaledScene&) = delete;

  const ComparedScene& Scene() const { return this->TheScene; }

private:
  std::vector<float> Rescaled(const Field& field, To to, const Factors& factors, const Grid& from) const;

  std::vector<float> SigmaA, SigmaS, Emission, G;
  ComparedScene TheScene;
};
}
