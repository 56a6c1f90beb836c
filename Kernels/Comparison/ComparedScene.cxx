#include "Comparison/ComparedScene.h"

#include "Medium/Coarsening.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
std::optional<Factors> CoarseningBy(int factor, const Grid& grid)
{
  Factors factors;
  for (int axis = 0; axis < 3; ++axis)
  {
    factors[axis] = grid.size[axis] == 1 ? 1 : factor;
    if (grid.size[axis] % factors[axis] != 0)
    {
      return std::nullopt;
    }
  }
  return factors;
}

Grid Coarsened(const Grid& fine, const Factors& factors)
{
  Grid coarse = fine;
  for (int axis = 0; axis < 3; ++axis)
  {
    coarse.size[axis] = fine.size[axis] / factors[axis];
    coarse.spacing[axis] = fine.spacing[axis] * factors[axis];
  }
  return coarse;
}

std::optional<Factors> FactorsBetween(const Grid& fine, const Grid& coarse)
{
  constexpr double part = 1e-3;
  Factors factors;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = std::abs(fine.origin[axis] - coarse.origin[axis]);
    const double high = std::abs(fine.origin[axis] + fine.Length(axis) - coarse.origin[axis] - coarse.Length(axis));
    if (fine.size[axis] % coarse.size[axis] != 0 || std::max(low, high) > part * fine.spacing[axis])
    {
      return std::nullopt;
    }
    factors[axis] = fine.size[axis] / coarse.size[axis];
  }
  return factors;
}

std::vector<float> Averaged(const float* values, int components, const Grid& fine, const Factors& factors)
{
  return Coarsening(fine, Coarsened(fine, factors)).Average(values, components);
}

bool ComparedScene::BendsLight() const
{
  const float* const ior = this->ior.values;
  return ior && std::any_of(ior, ior + this->medium.grid.VoxelCount(), [=](float index) { return index != ior[0]; });
}

bool ComparedScene::Emits() const
{
  const Field& emission = this->medium.emission;
  const std::size_t count = this->medium.grid.VoxelCount() * static_cast<std::size_t>(emission.components);
  return emission.values &&
    std::any_of(emission.values, emission.values + count, [](float value) { return value > 0.0f; });
}

std::string ComparedScene::WhyNotByPhotons(bool all) const
{
  const bool goesRound = this->periodic[0] || this->periodic[1] || this->periodic[2];
  return !Shines(this->illumination)      ? "photons are made of lights, and nothing shines on this medium"
    : this->Emits()                       ? "photons are made of lights, and this medium emits"
    : goesRound                           ? "photons do not return on the other side of periodic axes"
    : all && Reflects(this->illumination) ? "photons do not come back from faces that give back light"
                                          : "";
}
}
