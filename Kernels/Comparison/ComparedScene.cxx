#include "Comparison/ComparedScene.h"

#include "Medium/Coarsening.h"

#include <algorithm>

namespace tyndall
{
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
