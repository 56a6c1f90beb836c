#include "LightPropagation/Conservative/Acceleration/IterationByBalance.h"

#include "LightPropagation/Convergence.h"
#include "LightPropagation/Scattering/MomentScattering.h"

#include <utility>

namespace tyndall
{
IterationByBalance::IterationByBalance(TransportParts& parts, const KeptLight* kept)
  : Parts(parts)
  , Lamps(parts.LampSources())
  , Kept(kept)
{
}

IterationResult IterationByBalance::Run(const Monitor& monitor)
{
  TransportParts& parts = this->Parts;
  const PropagationSettings& settings = parts.Problem.Settings();
  IterationResult result;
  parts.CountEmission(result.ledger);
  WarmStart warm(parts, this->Kept, "diffusion acceleration");
  AccelerationInBlocks acceleration(
    parts,
    [this](std::size_t lamp, const Deposit& to, const Monitor& ofLamp) {
      return this->Parts.AddUncollided(*this->Lamps[lamp], to, ofLamp);
    },
    result.ledger, warm);
  const Monitor ofLamps =
    OfPart(monitor, [&settings](double done) { return ProgressOf(settings, 1.0, UncollidedPart * done); });
  this->MakeShown(result);
  const SweepTally ofUncollided = this->AddUncollided(acceleration, result.shown, ofLamps);
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
  if (parts.StoresMoments())
  {
    this->FindShown(acceleration, result.shown);
  }
  if (parts.Faces)
  {
    result.leftByCell = acceleration.LeftByCell();
  }
  return result;
}

/// What is not shown of the source of a next sweep: what the medium emits, and later what lamps' light is scattered
/// first.
void IterationByBalance::MakeShown(IterationResult& result)
{
  const TransportParts& parts = this->Parts;
  parts.TheDomain().Collective([&] {
    if (parts.StoresMoments())
    {
      result.shown = Buffer<float>(parts.TheDevice, parts.Layout.MomentFloats(parts.Functions()), "the light shown");
      result.shown.Fill(0.0f);
      parts.LoadEmission(result.shown);
    }
  });
}

/// Of lamps, near the faces of thick voxels where it matters there, then of all other sources.
SweepTally IterationByBalance::AddUncollided(
  AccelerationInBlocks& acceleration, const Buffer<float>& shown, const Monitor& monitor)
{
  TransportParts& parts = this->Parts;
  SweepTally tally;
  if (!this->Lamps.empty() && acceleration.NeedsFirstMoments())
  {
    tally = acceleration.AddBeams(monitor);
  }
  else
  {
    for (const std::unique_ptr<UncollidedSource>& lamp : this->Lamps)
    {
      Add(tally, parts.AddUncollided(*lamp, parts.WholeDeposit(), monitor));
    }
  }
  parts.TheDomain().Collective([&] {
    if (parts.StoresMoments() && !parts.IsEmpty())
    {
      parts.Scattering->AddFirstScattered(parts.WholeDeposit(), shown);
    }
  });
  TransportParts::Sources others = parts.VacuumSources();
  for (std::unique_ptr<UncollidedSource>& other : parts.OtherSources())
  {
    others.push_back(std::move(other));
  }
  for (const std::unique_ptr<UncollidedSource>& other : others)
  {
    Add(tally, parts.AddUncollided(*other, parts.WholeDeposit(), monitor));
  }
  return tally;
}

void IterationByBalance::FindShown(AccelerationInBlocks& acceleration, const Buffer<float>& shown)
{
  const TransportParts& parts = this->Parts;
  acceleration.ScatterFound();
  parts.TheDomain().Collective([&] {
    if (!parts.IsEmpty())
    {
      AddToShown(parts.TheDevice, parts.Layout.Places(parts.Functions()).beams, parts.Source, shown, -1.0f);
    }
  });
}
}
