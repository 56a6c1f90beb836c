#include "Photons/Distributed/PhotonsInBlocks.h"

#include "Device/Clock.h"
#include "Device/Errors.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/SharedMedium.h"
#include "LightPropagation/Convergence.h"
#include "Numerics/ChooseEvenly.h"
#include "Photons/Distributed/BlockInput.h"
#include "Photons/Distributed/BlockMarch.h"
#include "Photons/Distributed/PathsInBlocks.h"
#include "Photons/Distributed/PhotonShares.h"
#include "Photons/Distributed/PhotonTallies.h"
#include "Photons/Distributed/PilotsInBlocks.h"
#include "Photons/Marching/MarchedBatches.h"
#include "Photons/Marching/MarchedLight.h"
#include "Photons/Scattering/ScatteredChannels.h"
#include "Photons/Scattering/ScatteringRun.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory>
#include <numeric>
#include <utility>

namespace tyndall
{
namespace
{
/// Voxels round a block whose index has a part in the ways of photons in it (numerics.md, Eq. (99f)): three of each
/// spline's, and those of the places that the integrator looks at before it goes there. Beyond, the index counts as
/// constant.
/// @param octree  whether steps are those of an octree
int ReachOfIndex(const MarchSettings& settings, bool octree)
{
  constexpr int OfSpline = 3;
  if (settings.order == 1)
  {
    return OfSpline;
  }
  const double steps = 0.5 * (settings.order == 2 ? LeapfrogLooksAhead : YoshidaLooksAhead) * settings.stepSize;
  const double ahead = octree && settings.order == 4 ? std::max(steps, 1.0 * (1 << YoshidaLevel)) : steps;
  return OfSpline + 1 + static_cast<int>(ahead); // also from a voxel's upper wall
}

void RequireSame(Communicator& communicator, const MarchSettings& settings)
{
  tyndall::RequireSame(communicator, "settings", true,
    { 1.0 * settings.order, settings.stepSize, 1.0 * settings.meanDirection, 1.0 * settings.counts,
      1.0 * settings.maximumOrders, 1.0 * settings.leaveOut, static_cast<double>(settings.seed),
      1.0 * settings.errorBatches, 1.0 * settings.batches });
}
}

std::string NotInBlocks(const MarchSettings& settings)
{
  return settings.sums == MarchSettings::Sums::Unsafe ? "Unsafe sums" : std::string();
}

/// One rank's part of a march.
class PhotonMarcherInBlocks::Rank
{
public:
  Rank(Device& device, Communicator& communicator, const BlockPartition& partition, const MarchSettings& settings)
    : Settings(settings)
    , TheDevice(device)
    , Comm(communicator)
    , Partition(partition)
    , Own(BlockOf(partition, communicator.Rank()))
    , Has(this->Own.VoxelCount() > 0)
  {
  }

  /// @param octree  whether any rank has levels
  void CheckInput(const Medium& medium, const Field& ior, const std::uint8_t* levels, bool octree) const;
  void Prepare(const Medium& medium, const Field& ior, const std::uint8_t* levels, bool octree);
  /// @param turns  null: at once
  PhotonLight March(const std::vector<Photon>& share, const TurnsInBlocks* turns, const Monitor& monitor);
  std::vector<PhotonPath> Paths(const std::vector<Photon>& share, std::size_t count);
  PilotLight Gather(const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins,
    const std::array<int, 3>& cells, const Monitor& monitor);

  const MarchSettings Settings;
  RoundsTraffic Handed; ///< of the last march

private:
  MarchTraits TraitsOfAllRanks(const Medium& medium, const Field& ior);
  VoxelBox KnownOf(int rank, int reach) const;
  std::vector<float> IndexAround(const Field& ior, int reach);
  void ShareNodes(const std::uint8_t* levels);
  void PrepareScattering(const Medium& medium, const Field& index);
  PhotonLight MarchThese(
    const std::vector<Photon>& share, const PhotonNumbers& numbers, const TurnsInBlocks* turns, const Monitor& monitor);
  PhotonLight MarchInBatches(const std::vector<Photon>& share, const PlaceOfShare& place, const Monitor& monitor);
  void Follow(const StartingPhotons& starting, const TurnsInBlocks* turns, PhotonLight& result, const Monitor& monitor);
  void FollowAtOnce(const StartingPhotons& starting, BlockMarch* march, PhotonLight& result, const Monitor& monitor);
  void FollowByTurns(const StartingPhotons& starting, const TurnsInBlocks& turns, const MarchSums& target,
    BlockMarch* march, PhotonLight& result, const Monitor& monitor);
  void AddScattered(const PackedPhotons& packed, PhotonLight& result, const Monitor& monitor);
  ScatteredPhotons FollowScattered(const PhotonScattering* in, PackedPhotons photons,
    const PhotonScattering::Settings& settings, const Monitor& monitor);

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  const VoxelBox Own;
  const bool Has; ///< voxels
  MarchTraits Traits;
  std::unique_ptr<BrickedBytes> Nodes;           ///< of the whole octree; null: there is none
  std::unique_ptr<tyndall::Rounds> Rounds;       ///< of a march
  std::unique_ptr<MarchMedium> Through;          ///< null without voxels
  std::unique_ptr<MarchedLight> Light;           ///< likewise
  std::unique_ptr<ScatteredChannels> Scattering; ///< null: photons are followed to where they are first scattered
};

void PhotonMarcherInBlocks::Rank::CheckInput(
  const Medium& medium, const Field& ior, const std::uint8_t* levels, bool octree) const
{
  CheckMarchedBlock(this->Comm, this->Partition, medium, ior, levels, octree);
  Check(this->Settings);
  const std::string refused = NotInBlocks(this->Settings);
  Require(refused.empty(), "A medium that is spread over ranks is not marched through with " + refused + ".");
}

MarchTraits PhotonMarcherInBlocks::Rank::TraitsOfAllRanks(const Medium& medium, const Field& ior)
{
  MarchTraits traits = this->Has ? MarchTraitsOf(medium, ior, FindFilledBricks(medium)) : MarchTraits();
  static_cast<MediumTraits&>(traits) = TraitsOfAll(this->Comm, traits);
  traits.coloured = OnAnyRank(this->Comm, traits.coloured);
  traits.index = IndexRangeOfAll(this->Comm, this->Has, traits.index);
  return traits;
}

/// The voxels whose index a rank needs.
VoxelBox PhotonMarcherInBlocks::Rank::KnownOf(int rank, int reach) const
{
  const VoxelBox& block = this->Partition.blocks[rank];
  return block.VoxelCount() > 0 ? Grown(block, reach, this->Partition.whole) : block;
}

/// The index of these, from all ranks. Empty where nothing depends on it.
/// @param reach  0: nothing does
std::vector<float> PhotonMarcherInBlocks::Rank::IndexAround(const Field& ior, int reach)
{
  if (reach == 0)
  {
    return {};
  }
  std::vector<VoxelBox> known;
  for (int rank = 0; rank < this->Comm.Ranks(); ++rank)
  {
    known.push_back(this->KnownOf(rank, reach));
  }
  std::vector<float> own(this->Has ? this->Own.VoxelCount() : 0, 1.0f);
  if (this->Has && ior.values)
  {
    std::copy_n(ior.values, own.size(), own.begin());
  }
  return ValuesInBox(this->Comm, this->Partition, known, own, 1);
}

/// The nodes of all ranks' octree levels, on each.
void PhotonMarcherInBlocks::Rank::ShareNodes(const std::uint8_t* levels)
{
  std::vector<std::uint8_t> own;
  this->Comm.Collective([&] { own = this->Has ? this->Through->OwnNodes(levels) : own; });
  this->Nodes = std::make_unique<BrickedBytes>(BytesOfAll(this->Comm, this->Partition, own));
  this->Comm.Collective([&] {
    if (this->Has)
    {
      this->Through->SetNodes(*this->Nodes);
    }
  });
}

void PhotonMarcherInBlocks::Rank::Prepare(
  const Medium& medium, const Field& ior, const std::uint8_t* levels, bool octree)
{
  this->Traits = this->TraitsOfAllRanks(medium, ior);
  const bool bends = !this->Settings.leaveOut || this->Traits.index.Varies();
  const int reach = bends ? ReachOfIndex(this->Settings, octree) : 0;
  const std::vector<float> index = this->IndexAround(ior, reach);
  const Field known = { index.empty() ? nullptr : index.data(), 1 };
  this->Comm.Collective([&] {
    if (this->Has)
    {
      const MarchedPart block = { this->Partition.whole, this->Own, this->KnownOf(this->Comm.Rank(), reach) };
      this->Through =
        std::make_unique<MarchMedium>(this->TheDevice, medium, known, this->Settings, this->Traits, block, octree);
    }
  });
  if (octree && bends)
  {
    this->ShareNodes(levels);
  }
  this->Comm.Collective([&] { this->Light = this->Has ? std::make_unique<MarchedLight>(*this->Through) : nullptr; });
  if (this->Settings.maximumOrders != 1 && this->Traits.scatters)
  {
    this->PrepareScattering(medium, known);
  }
}

void PhotonMarcherInBlocks::Rank::PrepareScattering(const Medium& medium, const Field& index)
{
  const bool varies = this->Has && medium.phase.Varies();
  const auto cosine = [&](int c) { return this->Has && !varies ? medium.phase.MeanCosine(0, c) : 0.0; };
  tyndall::RequireSame(this->Comm, "g", this->Has, { varies ? 1.0 : 0.0, cosine(0), cosine(1), cosine(2) });
  const double part = this->Through ? ScatteringStepPart(index, this->Through->block.known.size) : 1.0;
  const std::vector<double> largest = this->Comm.Largest({ -part, this->Has && medium.phase.HasColour() ? 1.0 : 0.0 });
  const bool coloured = this->Traits.coloured || largest[1] > 0.0;
  this->Comm.Collective([&] {
    this->Scattering = std::make_unique<ScatteredChannels>(this->TheDevice,
      ScatteredChannels::Block{
        this->Through.get(), medium, index, this->Settings, -largest[0], coloured, this->Nodes.get() });
  });
}

void PhotonMarcherInBlocks::Rank::FollowAtOnce(
  const StartingPhotons& starting, BlockMarch* march, PhotonLight& result, const Monitor& monitor)
{
  this->Rounds->UntilAllEnd<PhotonOnItsWay>(
    [&](int round, std::vector<PhotonOnItsWay>&& arrived, const Monitor& ofRound) {
      BlockMarch::Outcome outcome;
      if (march)
      {
        outcome = round == 0 ? march->Start(starting.packed, starting.marks, ofRound)
                             : march->Resume(std::move(arrived), ofRound);
      }
      Tally(starting.packed, outcome.ends, result);
      return std::move(outcome.gone);
    },
    monitor);
}

void PhotonMarcherInBlocks::Rank::FollowByTurns(const StartingPhotons& starting, const TurnsInBlocks& turns,
  const MarchSums& target, BlockMarch* march, PhotonLight& result, const Monitor& monitor)
{
  Buffer<float> fluence;
  cl::Kernel show;
  this->Comm.Collective([&] {
    if (march)
    {
      fluence = Buffer<float>(this->TheDevice, this->Own.VoxelCount() * static_cast<std::size_t>(result.light.channels),
        "fluence of photons on their way");
      show = this->Light->Show(starting.packed, target, result.light, fluence);
    }
  });
  turns.begin(starting.packed, result.light.channels);
  WaitingPhotons photons(this->Comm, *this->Rounds, this->Own, march, starting,
    [&](const std::vector<cl_int>& ends) { Tally(starting.packed, ends, result); });
  photons.ToTheirEnds(
    turns, MarchEventLimit(this->Partition.whole, this->Settings),
    [&]() -> const Buffer<float>& {
      if (march)
      {
        const auto rows = static_cast<std::size_t>(this->Own.size[1]) * static_cast<std::size_t>(this->Own.size[2]);
        this->TheDevice.Queue().enqueueNDRangeKernel(show, cl::NullRange, cl::NDRange(rows));
      }
      return fluence;
    },
    monitor);
}

/// Up to where they are first scattered.
void PhotonMarcherInBlocks::Rank::Follow(
  const StartingPhotons& starting, const TurnsInBlocks* turns, PhotonLight& result, const Monitor& monitor)
{
  const PackedPhotons& packed = starting.packed;
  MarchSums target;
  std::unique_ptr<BlockMarch> march;
  this->Comm.Collective([&] {
    if (this->Has)
    {
      target = this->Light->Prepare(packed);
      march = std::make_unique<BlockMarch>(*this->Through, target, packed);
    }
  });
  if (turns)
  {
    this->FollowByTurns(starting, *turns, target, march.get(), result, monitor);
  }
  else
  {
    this->FollowAtOnce(starting, march.get(), result, monitor);
  }
  this->Comm.Collective([&] {
    if (this->Has)
    {
      this->Light->Finish(packed, target, starting.weightUnit, result);
      SayWhatIsLeftOut(*this->Through, packed, result.light);
    }
  });
  AddUpTallies(this->Comm, result);
}

/// This rank's share of one channel's scattered light and tallies.
ScatteredPhotons PhotonMarcherInBlocks::Rank::FollowScattered(
  const PhotonScattering* in, PackedPhotons photons, const PhotonScattering::Settings& settings, const Monitor& monitor)
{
  std::unique_ptr<ScatteringRun> run;
  this->Rounds->UntilAllEnd<ScatteredOnItsWay>(
    [&](int round, std::vector<ScatteredOnItsWay>&& arrived, const Monitor& ofRound) {
      if (in && round == 0)
      {
        run = std::make_unique<ScatteringRun>(*in, std::move(photons), settings);
        return run->Start(ofRound);
      }
      return in ? run->Resume(arrived, ofRound) : std::vector<ScatteredOnItsWay>();
    },
    monitor);
  ScatteredPhotons found;
  this->Comm.Collective([&] { found = run ? run->Finish() : found; });
  return found;
}

/// What more orders than one ask for.
void PhotonMarcherInBlocks::Rank::AddScattered(const PackedPhotons& packed, PhotonLight& result, const Monitor& monitor)
{
  if (this->Scattering)
  {
    this->Scattering->AddTo(result, packed, {}, monitor,
      [this](const PhotonScattering* in, PackedPhotons photons, const PhotonScattering::Settings& settings,
        const Monitor& ofRun) { return this->FollowScattered(in, std::move(photons), settings, ofRun); });
    AddUpScattered(this->Comm, result);
  }
  else if (this->Settings.maximumOrders != 1)
  {
    result.light.fluenceDirect = result.light.fluence; // nothing scatters
  }
}

/// @param numbers  of the photons among all
PhotonLight PhotonMarcherInBlocks::Rank::MarchThese(
  const std::vector<Photon>& share, const PhotonNumbers& numbers, const TurnsInBlocks* turns, const Monitor& monitor)
{
  const StartingPhotons starting =
    SendToTheirBlocks(this->Comm, this->Partition, share, numbers, this->Traits, this->Settings);
  const PackedPhotons& packed = starting.packed;
  PhotonLight result;
  const int colours = this->Scattering && this->Scattering->HasColour() ? 3 : this->Traits.ColoursOf(packed);
  result.light.channels = std::max(packed.channels, colours);
  result.light.device = this->TheDevice.Name();
  result.light.balance.entered = packed.entered;
  result.missed = packed.missed;
  result.batches = static_cast<int>(this->Comm.Largest({ 1.0 * BatchesOf(share) })[0]);
  result.secondsMarching = -ClockSeconds();
  this->Follow(starting, turns, result, this->Scattering ? OfPart(monitor, 0.0, 0.05) : monitor);
  PutIntoColours(packed, colours, result);
  this->AddScattered(packed, result, OfPart(monitor, 0.05, 1.0));
  if (this->Settings.batches && packed.Batches() == 1)
  {
    result.batchFluence = result.light.fluence;
  }
  return result;
}

PhotonLight PhotonMarcherInBlocks::Rank::MarchInBatches(
  const std::vector<Photon>& share, const PlaceOfShare& place, const Monitor& monitor)
{
  const auto batches = static_cast<std::size_t>(this->Settings.errorBatches);
  MarchedBatches all;
  for (std::size_t b = 0; b < batches; ++b)
  {
    PhotonNumbers numbers = NumbersOfBatch(place.all, b, batches);
    const auto begin = std::lower_bound(numbers.begin(), numbers.end(), place.first);
    const PhotonNumbers own(begin, std::lower_bound(begin, numbers.end(), place.first + share.size()));
    std::vector<Photon> some;
    for (const std::size_t number : own)
    {
      some.push_back(share[number - place.first]);
    }
    const double parts = static_cast<double>(batches);
    all.Add(this->MarchThese(some, own, nullptr, OfPart(monitor, b / parts, (b + 1) / parts)));
  }
  return std::move(all).Sum();
}

PhotonLight PhotonMarcherInBlocks::Rank::March(
  const std::vector<Photon>& share, const TurnsInBlocks* turns, const Monitor& monitor)
{
  const double start = ClockSeconds();
  this->Rounds = std::make_unique<tyndall::Rounds>(this->Comm, this->Partition);
  const PlaceOfShare place = PlaceAmong(this->Comm, share.size());
  PhotonLight result;
  if (this->Settings.errorBatches > 0)
  {
    result = this->MarchInBatches(share, place, monitor);
  }
  else
  {
    PhotonNumbers numbers(share.size());
    std::iota(numbers.begin(), numbers.end(), place.first);
    result = this->MarchThese(share, numbers, turns, monitor);
  }
  this->Handed = this->Rounds->Traffic();
  JudgeBalance(result.light, Medium()); // the same on all ranks
  result.seconds = ClockSeconds() - start;
  return result;
}

std::vector<PhotonPath> PhotonMarcherInBlocks::Rank::Paths(const std::vector<Photon>& share, std::size_t count)
{
  const PlaceOfShare place = PlaceAmong(this->Comm, share.size());
  const std::vector<std::size_t> chosen = ChooseEvenly(place.all, count);
  const std::vector<Photon> some = ChosenOnEachRank(this->Comm, share, place, chosen);
  PathsInBlocks paths(this->Comm, this->Partition, this->Through.get());
  return paths.Trace(some, chosen, MarchEventLimit(this->Partition.whole, this->Settings));
}

PilotLight PhotonMarcherInBlocks::Rank::Gather(const std::vector<Photon>& photons,
  const std::vector<std::array<int, 2>>& origins, const std::array<int, 3>& cells, const Monitor& monitor)
{
  return GatherInBlocks({ this->Comm, this->Partition, this->Through.get(), this->Traits, this->Settings }, photons,
    origins, cells, monitor);
}

PhotonMarcherInBlocks::PhotonMarcherInBlocks(Device& device, Communicator& communicator,
  const BlockPartition& partition, const Medium& medium, const Field& ior, const MarchSettings& settings,
  const std::uint8_t* levels)
  : Inside(std::make_unique<Rank>(device, communicator, partition, settings))
{
  const bool octree = OnAnyRank(communicator, levels);
  communicator.Collective([&] { this->Inside->CheckInput(medium, ior, levels, octree); });
  RequireSameInput(communicator, partition, medium, ior);
  RequireSame(communicator, settings);
  this->Inside->Prepare(medium, ior, levels, octree);
}

PhotonMarcherInBlocks::~PhotonMarcherInBlocks() = default;

PhotonLight PhotonMarcherInBlocks::March(const std::vector<Photon>& share, const Monitor& monitor)
{
  return this->Inside->March(share, nullptr, monitor);
}

PhotonLight PhotonMarcherInBlocks::MarchByTurns(
  const std::vector<Photon>& share, const TurnsInBlocks& turns, const Monitor& monitor)
{
  const MarchSettings& settings = this->Inside->Settings;
  Require(settings.maximumOrders == 1 && !settings.batches && settings.errorBatches == 0,
    "Photons march in turns up to where they are first scattered, and without batches.");
  return this->Inside->March(share, &turns, monitor);
}

std::vector<PhotonPath> PhotonMarcherInBlocks::Paths(const std::vector<Photon>& share, std::size_t count)
{
  return this->Inside->Paths(share, count);
}

PilotLight PhotonMarcherInBlocks::Gather(const std::vector<Photon>& photons,
  const std::vector<std::array<int, 2>>& origins, const std::array<int, 3>& cells, const Monitor& monitor)
{
  return this->Inside->Gather(photons, origins, cells, monitor);
}

const RoundsTraffic& PhotonMarcherInBlocks::Traffic() const
{
  return this->Inside->Handed;
}
}
