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
/// What every solver is given. Seen, not owned.
struct ComparedScene
{
  Medium medium;
  Illumination illumination;
  Field ior;                            ///< null values: 1 everywhere
  const std::uint8_t* levels = nullptr; ///< of an octree, for photons; null: none
  std::array<bool, 3> periodic = { false, false, false };

  bool BendsLight() const; ///< whether the index is not the same everywhere
  bool Emits() const;      ///< whether any voxel emits
  /// Why photons cannot make the light of this scene; empty: they can.
  /// @param all  scattered light, too
  std::string WhyNotByPhotons(bool all) const;
};

/// The same scene on a coarser or a finer grid: coefficients are means over the voxels, or repeated; the mean cosine is
/// weighted by sigma_s.
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
