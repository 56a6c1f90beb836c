#include "LatticeBoltzmann/LatticeProblem.h"

#include <utility>

namespace tyndall
{
namespace
{
constexpr int GhostLayers = 2;
}

LatticeProblem::LatticeProblem(const Domain& domain, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings)
  : Scene(domain, medium, illumination, AsPropagation(settings, 0))
  , Known(this->Scene.TheMedium())
  , KnownIndex(domain.IsEmpty() ? Field() : ior)
  , Shining(this->Scene.Shining())
{
  if (domain.IsSerial())
  {
    this->OwnBox.emplace(this->Known.grid, settings.periodic);
    return;
  }
  this->Ghosts.emplace(domain.Comm(), this->TheDomain().Partition(), settings.periodic, GhostLayers);
  this->OwnBox.emplace(*this->Ghosts);
  this->Known.grid = this->OwnBox->known;
  if (this->Known.phase.Varies())
  {
    this->Known.phase = this->Known.phase.WithG(this->WithGhosts(this->Known.phase.G()));
  }
  UncollidedImage& given = this->Shining.uncollided;
  for (Field* field : { &this->Known.sigma_a, &this->Known.sigma_s, &this->Known.emission, &this->KnownIndex,
         &given.fluence, &given.meanDirection })
  {
    *field = this->WithGhosts(*field);
  }
}

Field LatticeProblem::WithGhosts(const Field& own)
{
  this->GhostValues.emplace_back();
  return this->Ghosts->Spread(own, this->GhostValues.back());
}

std::vector<float> LatticeProblem::WithGhosts(std::vector<float> own, int components) const
{
  return this->Ghosts ? this->Ghosts->Spread(own, components) : std::move(own);
}

void LatticeProblem::Undo(LightField& light) const
{
  this->TheDomain().Collective([&] { this->Scene.Undo(light); });
}
}
