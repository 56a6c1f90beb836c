#include "LightPropagation/Distributed/UncollidedOverRanks.h"

#include "LightPropagation/Uncollided/UncollidedBoundary.h"
#include "LightPropagation/Uncollided/UncollidedLamp.h"
#include "Medium/VoxelSums.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <exception>
#include <optional>

namespace tyndall
{
UncollidedOverRanks::UncollidedOverRanks(BlockOnDevice& block, const IncidentLight& incident)
  : Block(block)
  , Incident(incident)
{
  if (block.Scene.given && block.Has)
  {
    this->Given =
      std::make_unique<GivenLight>(block.Scene.illumination.uncollided, block.Scene.medium, block.Scene.Scattering());
  }
  if (block.Angular)
  {
    this->OfLamp = Buffer<float>(block.TheDevice, block.Layout.Floats(), "the light of a lamp");
  }
}

bool UncollidedOverRanks::LoadSource(EnergyLedger& ledger)
{
  const BlockScene& scene = this->Block.Scene;
  if (scene.traits.emits)
  {
    this->FindVacuum();
    const Rgb emitted = this->LoadEmission();
    for (int c = 0; c < 3; ++c)
    {
      ledger.Emit(c, emitted[c]);
    }
  }
  if (!scene.given)
  {
    return scene.traits.emits;
  }
  bool any = false;
  this->Block.Comm.Collective([&] { any = this->AddStraightOn(this->Block.Source); });
  return OnAnyRank(this->Block.Comm, any || scene.traits.emits);
}

/// @return W, of all ranks
Rgb UncollidedOverRanks::LoadEmission()
{
  const VolumeLayout& layout = this->Block.Layout;
  std::vector<double> emitted(3, 0.0);
  if (this->Block.Has)
  {
    const Field& emission = this->Block.Scene.medium.emission;
    this->WriteEmission(this->Block.Source);
    for (int c = 0; c < layout.channels; ++c)
    {
      emitted[c] = 4.0 * Pi * layout.grid.VoxelVolume() *
        SumOverVoxels(layout.grid, [&](std::size_t i) { return emission.At(i, c); });
    }
  }
  emitted = this->Block.Comm.Sum(emitted);
  return { emitted[0], emitted[1], emitted[2] };
}

void UncollidedOverRanks::WriteEmission(Buffer<float>& source) const
{
  if (!this->Block.Has || !this->Block.Scene.traits.emits)
  {
    return;
  }
  const std::vector<float> values = this->EmissionOf(false);
  source.Write(values.data(), values.size() - SweepPadding);
}

/// @param emptyVoxels  of those that are swept apart, else of the others; W / (length^3 sr)
std::vector<float> UncollidedOverRanks::EmissionOf(bool emptyVoxels) const
{
  const BlockScene& scene = this->Block.Scene;
  const VolumeLayout& layout = this->Block.Layout;
  return Planar(layout, layout.channels, [&](std::size_t i, int c) {
    const bool apart = this->OfVacuum && VacuumEmission::IsEmpty(scene.Scattering().SigmaT(i, c), layout.grid);
    return apart == emptyVoxels ? scene.medium.emission.At(i, c) : 0.0f;
  });
}

/// As TransportParts does; all ranks call it.
void UncollidedOverRanks::FindVacuum()
{
  const BlockOnDevice& block = this->Block;
  const Grid& whole = block.Partition.whole;
  if (!VacuumEmission::IsApart(whole, block.Settings))
  {
    return;
  }
  bool any = false;
  block.Comm.Collective([&] {
    this->OfVacuum = VacuumEmission::DirectionsFor(whole, block.Settings);
    const std::vector<float> own = block.Has ? this->EmissionOf(true) : std::vector<float>();
    any = std::any_of(own.begin(), own.end(), [](float value) { return value > 0.0f; });
  });
  if (!OnAnyRank(block.Comm, any))
  {
    this->OfVacuum.reset();
  }
}

bool UncollidedOverRanks::AddStraightOn(const Buffer<float>& source) const
{
  return this->Given &&
    this->Given->AddStraightOn(this->Block.TheDevice, this->Block.Layout, this->Block.Basis(), source);
}

std::size_t UncollidedOverRanks::Count() const
{
  return this->Incident.Lamps().size() + (this->Incident.FineBoundary() ? 1 : 0) + (this->OfVacuum ? 1 : 0);
}

SweepTally UncollidedOverRanks::AddAll(const Buffer<float>* shown, OctantSources* atFaces, const Monitor& monitor)
{
  const double all = static_cast<double>(this->Count());
  const std::size_t lamps = this->Incident.Lamps().size();
  SweepTally tally;
  for (std::size_t i = 0; i < lamps; ++i)
  {
    const Monitor ofLamp = OfPart(monitor, i / all, (i + 1) / all);
    Add(tally, this->OnAllRanks([&] { return this->AddLampAt(i, atFaces, ofLamp); }));
  }
  this->Block.Comm.Collective([&] {
    if (this->Block.Has && shown)
    {
      this->Block.Scattering->AddFirstScattered(this->Block.WholeDeposit(), *shown);
    }
  });
  if (const BoundaryLight* const boundary = this->Incident.FineBoundary())
  {
    Deposit deposit = this->Block.WholeDeposit();
    deposit.partialCurrents = atFaces ? &atFaces->Currents() : nullptr;
    Add(tally, this->AddBoundary(*boundary, deposit, OfPart(monitor, lamps / all, (lamps + 1.0) / all)));
    this->Block.Comm.Collective([&] {
      if (atFaces)
      {
        atFaces->TakeIncoming(*this->Incident.Fine());
      }
    });
  }
  if (this->OfVacuum)
  {
    Add(tally, this->AddVacuum(atFaces, OfPart(monitor, (all - 1.0) / all, 1.0)));
  }
  if (this->Block.Scene.given)
  {
    Add(tally, this->AddGiven(monitor));
  }
  return tally;
}

SweepTally UncollidedOverRanks::AddVacuum(OctantSources* atFaces, const Monitor& monitor)
{
  if (!this->OfVacuum)
  {
    return {};
  }
  Deposit deposit = this->Block.WholeDeposit();
  deposit.partialCurrents = atFaces ? &atFaces->Currents() : nullptr;
  std::optional<VacuumEmission> emission;
  this->Block.Comm.Collective([&] { emission.emplace(*this->OfVacuum, this->EmissionOf(true)); });
  const SweepTally tally = this->OnAllRanks([&] { return emission->AddTo(this->VolumeOf(deposit), monitor); });
  this->Block.Comm.Collective([&] {
    if (atFaces)
    {
      atFaces->TakeIncoming(*this->OfVacuum);
    }
  });
  return tally;
}

/// What goes wrong on one rank does on all: light is swept by all together.
/// @param add  throws on one rank alone after the last step that all take together, and not before: what may fail there
///   stands in Collective
SweepTally UncollidedOverRanks::OnAllRanks(const std::function<SweepTally()>& add)
{
  SweepTally tally;
  std::exception_ptr error;
  try
  {
    tally = add();
  }
  catch (...)
  {
    error = std::current_exception();
  }
  this->Block.Comm.Collective([&] {
    if (error)
    {
      std::rethrow_exception(error);
    }
  });
  return tally;
}

UncollidedVolume UncollidedOverRanks::VolumeOf(const Deposit& deposit)
{
  BlockOnDevice& block = this->Block;
  const SweepMaker sweeps = [&block](const SweepRequest& request) { return block.MakeSweep(request); };
  UncollidedVolume volume = { block.TheDevice, block.Layout, block.OnDevice.SigmaT(), block.Settings.periodic, sweeps,
    deposit };
  volume.whole = &block.Partition.whole;
  volume.basis = block.Basis();
  volume.fetchBeyond = [&block](const Buffer<float>& byFaces) { return block.Across.Fetch(byFaces); };
  volume.together = [&block](const std::function<void()>& work) { block.Comm.Collective(work); };
  volume.followLamp = [this, &block](const SweepVolume& ofChannels, const Light& lamp, const Monitor& ofLamp) {
    if (!this->NearLamps)
    {
      this->NearLamps = std::make_unique<LampsInBlocks>(
        block.TheDevice, block.Comm, block.Partition, block.Settings.periodic, block.Layout, block.OnDevice.SigmaT());
    }
    return this->NearLamps->Deposit(ofChannels, lamp, ofLamp);
  };
  return volume;
}

SweepTally UncollidedOverRanks::AddLamp(std::size_t lamp, const Deposit& deposit, const Monitor& monitor)
{
  return this->OnAllRanks([&] { return this->FollowLamp(lamp, deposit, monitor); });
}

/// With a beam of its own where it has one.
SweepTally UncollidedOverRanks::FollowLamp(std::size_t lamp, const Deposit& deposit, const Monitor& monitor)
{
  UncollidedVolume volume = this->VolumeOf(deposit);
  const SweptMoments* const angular = this->Block.Angular.get();
  this->Block.Comm.Collective([&] { // without voxels there are no moments
    if (angular)
    {
      this->OfLamp.Fill(0.0f);
      volume.beamPath = &this->OfLamp;
    }
  });
  const SweepTally tally = UncollidedLamp(this->Incident.Lamps()[lamp]).AddTo(volume, monitor);
  const int beam = angular ? angular->BeamOf(lamp) : -1;
  if (beam >= 0)
  {
    this->Block.Scattering->AddBeam(this->OfLamp, this->Block.Source, beam);
  }
  return tally;
}

/// To the block's arrays.
SweepTally UncollidedOverRanks::AddLampAt(std::size_t lamp, OctantSources* atFaces, const Monitor& monitor)
{
  Deposit deposit = this->Block.WholeDeposit();
  if (!atFaces)
  {
    return this->FollowLamp(lamp, deposit, monitor);
  }
  deposit.path = &atFaces->LampPath();
  deposit.firstMoments = &atFaces->LampMoments();
  const SweepTally tally = this->FollowLamp(lamp, deposit, monitor);
  atFaces->TakeLamp(this->Block.Path);
  return tally;
}

SweepTally UncollidedOverRanks::AddBoundary(const BoundaryLight& light, const Deposit& deposit, const Monitor& monitor)
{
  const UncollidedBoundary boundary(this->Block.Settings, light);
  return this->OnAllRanks([&] { return boundary.AddTo(this->VolumeOf(deposit), monitor); });
}

/// What came in is what all ranks' voxels take and what left, which each is told.
SweepTally UncollidedOverRanks::AddGiven(const Monitor& monitor)
{
  SweepTally own;
  this->Block.Comm.Collective([&] {
    if (this->Given)
    {
      own = this->Given->AddTo(this->VolumeOf(this->Block.WholeDeposit()), monitor);
    }
  });
  SweepTally all;
  std::vector<double> taken, left;
  for (int c = 0; c < 3; ++c)
  {
    taken.push_back(own.in[0][c]);
    for (int face = 0; face < 6; ++face)
    {
      taken.back() -= own.out[face][c];
      left.push_back(own.out[face][c]);
    }
  }
  taken = this->Block.Comm.Sum(taken);
  left = this->Block.Comm.Largest(left);
  for (int c = 0; c < 3; ++c)
  {
    all.in[0][c] = taken[c];
    for (int face = 0; face < 6; ++face)
    {
      all.out[face][c] = left[6 * c + face];
      all.in[0][c] += all.out[face][c];
    }
  }
  return all;
}

/// Along the finer directions and the usual ones.
UncollidedOverRanks::EvenSky UncollidedOverRanks::FindEvenSky(const Monitor& monitor)
{
  BlockOnDevice& block = this->Block;
  Illumination evenly;
  evenly.sky = { 1.0, 1.0, 1.0 };
  const auto along = [&](const SweptDirections& directions, const Monitor& ofThese) {
    Buffer<float> path;
    block.Comm.Collective([&] {
      path = Buffer<float>(block.TheDevice, block.Layout.MomentFloats(block.Functions()), "uncollided light");
      path.Fill(0.0f);
    });
    const BoundaryLight light(block.Partition.whole, block.Settings, directions, evenly, {});
    this->AddBoundary(light, { &path }, ofThese);
    return path.Read();
  };
  return { along(*this->Incident.Fine(), OfPart(monitor, 0.0, 0.8)),
    along(this->Incident.Usual(), OfPart(monitor, 0.8, 1.0)) };
}
}
