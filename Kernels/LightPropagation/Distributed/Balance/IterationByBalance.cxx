#include "LightPropagation/Distributed/Balance/IterationByBalance.h"

#include "LightPropagation/Convergence.h"
#include "LightPropagation/Distributed/Balance/AccelerationInBlocks.h"

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
  AccelerationInBlocks acceleration({ block.TheDevice, block.Others, block.Partition, block.Scene, block.Settings,
    block.Layout, block.OnDevice, this->Incident.Usual(), this->Incident.UsualBoundary(), this->Incident.Lamps(),
    [&block](const SweepRequest& request) { return block.MakeSweep(request); },
    [this](const Light& lamp, const Deposit& to, const Monitor& ofLamp) {
      return this->Uncollided.AddLamp(lamp, to, ofLamp);
    },
    block.Source, block.Path, block.Fluence, block.Flux, block.Faces.get(), result.ledger, warm, shines });
  const Monitor ofLamps =
    OfPart(monitor, [&block](double done) { return ProgressOf(block.Settings, 1.0, UncollidedPart * done); });
  const bool nearFaces = !this->Incident.Lamps().empty() && acceleration.NeedsFirstMoments();
  const SweepTally ofUncollided =
    nearFaces ? acceleration.AddBeams(ofLamps) : this->Uncollided.AddAll(nullptr, nullptr, ofLamps);
  result.ledger.Count(ofUncollided);
  for (int c = 0; c < 3; ++c)
  {
    result.ledger.LeaveOver(c, ofUncollided.onTheWay[c]);
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
  if (block.Faces)
  {
    result.leftByCell = acceleration.LeftByCell();
  }
  return result;
}
}
