#include "LightPropagation/Distributed/Balance/IterationByBalance.h"

#include "LightPropagation/Convergence.h"
#include "LightPropagation/Scattering/MomentScattering.h"

namespace tyndall
{
IterationByBalance::IterationByBalance(
  BlockOnDevice& block, const IncidentLight& incident, UncollidedOverRanks& uncollided, const KeptLight* kept)
  : Block(block)
  , Incident(incident)
  , Uncollided(uncollided)
  , Kept(kept)
{
}

IterationResult IterationByBalance::Run(const Monitor& monitor)
{
  BlockOnDevice& block = this->Block;
  IterationResult result;
  const bool shines = this->Uncollided.LoadSource(result.ledger);
  WarmStart warm(SceneOf(block, this->Incident), this->Kept, "diffusion acceleration");
  AccelerationInBlocks acceleration({ block.TheDevice, block.Comm, block.Partition, block.Scene, block.Settings,
    block.Layout, block.OnDevice, this->Incident.Usual(), this->Incident.UsualBoundary(), this->Incident.Lamps(),
    *block.Scattering, block.Angular.get(), block.Functions(),
    [&block](const SweepRequest& request) { return block.MakeSweep(request); },
    [this](std::size_t lamp, const Deposit& to, const Monitor& ofLamp) {
      return this->Uncollided.AddLamp(lamp, to, ofLamp);
    },
    block.Source, block.Path, block.Fluence, block.Flux, block.Faces.get(), result.ledger, warm, shines });
  const Monitor ofLamps =
    OfPart(monitor, [&block](double done) { return ProgressOf(block.Settings, 1.0, UncollidedPart * done); });
  this->MakeShown(result);
  const bool nearFaces = !this->Incident.Lamps().empty() && acceleration.NeedsFirstMoments();
  const SweepTally ofUncollided = nearFaces
    ? this->AddNearFaces(acceleration, result.shown, ofLamps)
    : this->Uncollided.AddAll(block.StoresMoments() ? &result.shown : nullptr, nullptr, ofLamps);
  result.ledger.Count(ofUncollided);
  for (int c = 0; c < 3; ++c)
  {
    result.ledger.SetUnaccounted(c, ofUncollided.onTheWay[c]);
  }
  result.convergence = acceleration.Run(monitor);
  result.fluenceDirect = acceleration.Direct();
  result.surfaceRadiance = acceleration.FindSurfaceRadiance();
  result.leftOut = warm.LeftOut();
  result.warm = warm.Begins();
  if (warm.Keeps())
  {
    result.kept = acceleration.Leave();
  }
  if (block.StoresMoments())
  {
    this->FindShown(acceleration, result.shown);
  }
  if (block.Faces)
  {
    result.leftByCell = acceleration.LeftByCell();
  }
  return result;
}

/// What is not shown of the source of a next sweep: what the medium emits, and later what lamps' light is scattered
/// first.
void IterationByBalance::MakeShown(IterationResult& result)
{
  const BlockOnDevice& block = this->Block;
  block.Comm.Collective([&] {
    if (block.StoresMoments())
    {
      result.shown = Buffer<float>(block.TheDevice, block.Layout.MomentFloats(block.Functions()), "the light shown");
      result.shown.Fill(0.0f);
      this->Uncollided.WriteEmission(result.shown);
    }
  });
}

/// Lamps whose light is scattered near thick voxels' faces.
SweepTally IterationByBalance::AddNearFaces(
  AccelerationInBlocks& acceleration, const Buffer<float>& shown, const Monitor& monitor)
{
  const BlockOnDevice& block = this->Block;
  SweepTally tally = acceleration.AddBeams(monitor);
  block.Comm.Collective([&] {
    if (block.StoresMoments() && block.Has)
    {
      block.Scattering->AddFirstScattered(block.WholeDeposit(), shown);
    }
  });
  Add(tally, this->Uncollided.AddVacuum(nullptr, monitor));
  if (block.Scene.given)
  {
    Add(tally, this->Uncollided.AddGiven(monitor));
  }
  return tally;
}

void IterationByBalance::FindShown(AccelerationInBlocks& acceleration, const Buffer<float>& shown)
{
  const BlockOnDevice& block = this->Block;
  acceleration.ScatterFound();
  block.Comm.Collective([&] {
    if (block.Has)
    {
      const std::size_t values = block.Layout.Places(block.Functions()).beams;
      AddToShown(block.TheDevice, values, block.Source, shown, -1.0f);
    }
  });
}
}
