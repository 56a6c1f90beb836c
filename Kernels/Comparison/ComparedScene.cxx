#include "Comparison/ComparedScene.h"

#include "Medium/Coarsening.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Calls visit(fine voxel, coarse voxel) for all fine voxels in their order.
template <class Visit>
void ForAllPairs(const Grid& fine, const Factors& factors, const Visit& visit)
{
  const Grid coarse = Coarsened(fine, factors);
  std::size_t voxel = 0;
  for (int k = 0; k < fine.size[2]; ++k)
  {
    for (int j = 0; j < fine.size[1]; ++j)
    {
      const std::size_t row = coarse.IndexOf({ 0, j / factors[1], k / factors[2] });
      for (int i = 0; i < fine.size[0]; ++i, ++voxel)
      {
        visit(voxel, row + static_cast<std::size_t>(i / factors[0]));
      }
    }
  }
}
}

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

Grid Refined(const Grid& coarse, const Factors& factors)
{
  Grid fine = coarse;
  for (int axis = 0; axis < 3; ++axis)
  {
    fine.size[axis] = coarse.size[axis] * factors[axis];
    fine.spacing[axis] = coarse.spacing[axis] / factors[axis];
  }
  return fine;
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

std::vector<float> Repeated(const float* values, int components, const Grid& coarse, const Factors& factors)
{
  const Grid fine = Refined(coarse, factors);
  const std::size_t channels = static_cast<std::size_t>(components);
  std::vector<float> repeated(fine.VoxelCount() * channels);
  ForAllPairs(fine, factors, [&](std::size_t to, std::size_t from) {
    std::copy_n(values + from * channels, channels, repeated.begin() + static_cast<std::ptrdiff_t>(to * channels));
  });
  return repeated;
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

std::vector<float> RescaledScene::Rescaled(const Field& field, To to, const Factors& factors, const Grid& from) const
{
  return !field.values  ? std::vector<float>()
    : to == To::Coarser ? Averaged(field.values, field.components, from, factors)
                        : Repeated(field.values, field.components, from, factors);
}

RescaledScene::RescaledScene(const ComparedScene& scene, To to, const Factors& factors)
  : TheScene(scene)
{
  Medium& medium = this->TheScene.medium;
  const Grid& from = scene.medium.grid;
  const auto rescale = [&](Field& field, std::vector<float>& values) {
    values = this->Rescaled(field, to, factors, from);
    field.values = values.empty() ? nullptr : values.data();
  };
  if (medium.phase.Varies())
  {
    const Field& g = medium.phase.G();
    const bool coarser = to == To::Coarser;
    this->G = coarser ? Coarsening(from, Coarsened(from, factors)).Average(g, medium.sigma_s)
                      : this->Rescaled(g, to, factors, from);
    const bool colour = g.HasColour() || medium.sigma_s.HasColour();
    medium.phase =
      medium.phase.WithG({ this->G.data(), coarser ? (colour ? 3 : 1) : g.components, coarser ? -1 : g.standsForAll });
  }
  rescale(medium.sigma_a, this->SigmaA);
  rescale(medium.sigma_s, this->SigmaS);
  rescale(medium.emission, this->Emission);
  medium.grid = to == To::Coarser ? Coarsened(from, factors) : Refined(from, factors);
  this->TheScene.ior = {}; // photons are marched only through the scene's own voxels
  this->TheScene.levels = nullptr;
}
}
