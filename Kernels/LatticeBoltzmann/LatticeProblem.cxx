#include "LatticeBoltzmann/LatticeProblem.h"

#include "Distribution/Halo.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/Problem/PropagationProblem.h"

#include <utility>

namespace tyndall
{
namespace
{
constexpr int GhostLayers = 2;

Medium OwnMedium(const Domain& domain, const Medium& medium)
{
  Medium own = domain.IsEmpty() ? Medium() : medium;
  own.grid = domain.OwnGrid();
  return own;
}

Illumination WithUncollided(Illumination illumination, const UncollidedImage& uncollided)
{
  illumination.uncollided = uncollided;
  return illumination;
}
}

/// Coefficients of a block and its ghost voxels, and the given uncollided light, if any. Collective.
struct CoefficientsWithGhosts
{
  CoefficientsWithGhosts(const Halo& halo, const Medium& own, const Field& ior, const UncollidedImage& image)
    : medium(own)
    , uncollided(image)
  {
    this->medium.grid = halo.KnownGrid();
    this->medium.sigma_a = halo.Spread(own.sigma_a, this->Absorption);
    this->medium.sigma_s = halo.Spread(own.sigma_s, this->Scattering);
    this->medium.emission = halo.Spread(own.emission, this->Emission);
    if (own.phase.Varies())
    {
      this->medium.phase = own.phase.WithG(halo.Spread(own.phase.G(), this->G));
    }
    this->index = halo.Spread(ior, this->Index);
    this->uncollided.fluence = halo.Spread(image.fluence, this->Fluence);
    this->uncollided.meanDirection = halo.Spread(image.meanDirection, this->Directions);
  }
  CoefficientsWithGhosts(const CoefficientsWithGhosts&) = delete; // fields refer to this object's arrays
  CoefficientsWithGhosts& operator=(const CoefficientsWithGhosts&) = delete;

  Medium medium;
  Field index;
  UncollidedImage uncollided;

private:
  std::vector<float> Absorption, Scattering, Emission, G, Index, Fluence, Directions;
};

struct LatticeProblem::Serial
{
  PropagationProblem problem;
  Field index;
};

struct LatticeProblem::Block
{
  Block(Device& device, const Domain& domain, const Medium& medium, const Field& ior, const Illumination& illumination,
    const LatticeSettings& settings)
    : halo(domain.Comm(), domain.Partition(), settings.periodic, GhostLayers)
    , given(halo, OwnMedium(domain, medium), domain.IsEmpty() ? Field() : ior,
        domain.IsEmpty() ? UncollidedImage() : illumination.uncollided)
    , scene(domain.Comm(), !domain.IsEmpty(), domain.Partition(), this->given.medium,
        WithUncollided(illumination, this->given.uncollided), AsPropagation(settings, 0), MemoryOf(device))
  {
  }

  const Halo halo;
  const CoefficientsWithGhosts given;
  const BlockScene scene;
};

LatticeProblem::LatticeProblem(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings)
{
  if (domain.IsSerial())
  {
    this->OfGrid.reset(new Serial{ { medium, illumination, AsPropagation(settings) }, ior });
    const Grid& grid = this->OfGrid->problem.TheGrid();
    this->Solved = std::make_unique<Domain>(grid);
    this->OwnBox = std::make_unique<LatticeBox>(grid, settings.periodic);
    return;
  }
  this->OfBlock = std::make_unique<Block>(device, domain, medium, ior, illumination, settings);
  BlockPartition partition = domain.Partition();
  partition.whole = this->OfBlock->scene.WholeOf(partition.whole);
  this->Solved = std::make_unique<Domain>(domain.Comm(), std::move(partition));
  LatticeBox box(this->OfBlock->halo);
  box.known = this->OfBlock->scene.medium.grid;
  this->OwnBox = std::make_unique<LatticeBox>(std::move(box));
}

LatticeProblem::~LatticeProblem() = default;

const Medium& LatticeProblem::TheMedium() const
{
  return this->OfGrid ? this->OfGrid->problem.TheMedium() : this->OfBlock->scene.medium;
}

const Field& LatticeProblem::Index() const
{
  return this->OfGrid ? this->OfGrid->index : this->OfBlock->given.index;
}

const Illumination& LatticeProblem::TheIllumination() const
{
  return this->OfGrid ? this->OfGrid->problem.Shining() : this->OfBlock->scene.illumination;
}

int LatticeProblem::Channels() const
{
  return this->OfGrid ? this->OfGrid->problem.Channels() : this->OfBlock->scene.channels;
}

bool LatticeProblem::IsAnisotropic() const
{
  const MediumTraits& traits = this->OfGrid ? this->OfGrid->problem.Traits() : this->OfBlock->scene.traits;
  return this->Solved->Any(!this->Solved->IsEmpty() && !this->TheMedium().phase.IsIsotropic()) && traits.scatters;
}

std::vector<float> LatticeProblem::WithGhosts(std::vector<float> own, int components) const
{
  return this->OfBlock ? this->OfBlock->halo.Spread(own, components) : std::move(own);
}

void LatticeProblem::Undo(LightField& light) const
{
  this->Solved->Collective(
    [&] { this->OfGrid ? this->OfGrid->problem.Undo(light) : this->OfBlock->scene.Undo(light); });
}
}
