#include "Photons/Distributed/PhotonsInBlocks.h"

#include "Device/Clock.h"
#include "Device/Errors.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/SharedMedium.h"
#include "Photons/Distributed/BlockMarch.h"
#include "Photons/Marching/MarchedBatches.h"
#include "Photons/Marching/MarchedLight.h"
#include "Photons/Scattering/ScatteredChannels.h"
#include "Photons/Scattering/ScatteringRun.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

namespace tyndall
{
namespace
{
/// Voxels round a block whose index has a part in the ways of photons in it (numerics.md, Eq. (99f)): three of each
/// spline's, and those of the places that the integrator looks at before it goes there, where a jump of the index may
/// have made a photon some times as fast as its step was meant for. Beyond, the index counts as constant.
int ReachOfIndex(const MarchSettings& settings)
{
  const double ahead = settings.order == 1 ? 0.0 : settings.order == 2 ? 1.5 : 3.0; // steps
  return 3 + static_cast<int>(std::ceil(ahead * settings.stepSize));
}

/// None where there are fewer blocks than ranks, which is yet to be refused.
VoxelBox BlockOf(const BlockPartition& partition, int rank)
{
  return rank < static_cast<int>(partition.blocks.size()) ? partition.blocks[rank] : VoxelBox();
}

/// Of the packed photons those that set off in a block, by the voxel that kernels take them to be in.
PackedPhotons ThoseIn(const VoxelBox& block, const Grid& whole, const PackedPhotons& packed)
{
  PackedPhotons own = packed;
  own.values.clear();
  own.numbers.clear();
  own.batchBegin.assign(packed.batchBegin.size(), 0);
  const auto each = static_cast<std::ptrdiff_t>(packed.FloatsEach());
  auto values = packed.values.begin();
  std::size_t batch = 0;
  for (std::size_t i = 0; i < packed.Count(); ++i, values += each)
  {
    while (static_cast<int>(i) >= packed.batchBegin[batch + 1])
    {
      ++batch;
    }
    int voxel[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      voxel[axis] = std::clamp(static_cast<int>(values[axis]), 0, whole.size[axis] - 1);
    }
    if (Holds(block, voxel))
    {
      own.values.insert(own.values.end(), values, values + each);
      own.numbers.push_back(packed.numbers[i]);
      ++own.batchBegin[batch + 1];
    }
  }
  std::partial_sum(own.batchBegin.begin(), own.batchBegin.end(), own.batchBegin.begin());
  return own;
}

void RequireSame(Communicator& communicator, const MarchSettings& settings)
{
  tyndall::RequireSame(communicator, "settings", true,
    { 1.0 * settings.order, settings.stepSize, 1.0 * settings.meanDirection, 1.0 * settings.counts,
      1.0 * settings.maximumOrders, 1.0 * settings.leaveOut, static_cast<double>(settings.seed),
      1.0 * settings.errorBatches, 1.0 * settings.batches });
}

void RequireSame(Communicator& communicator, const std::vector<Photon>& photons)
{
  std::vector<double> sums(10, 0.0);
  sums[0] = static_cast<double>(photons.size());
  for (const Photon& photon : photons)
  {
    for (int i = 0; i < 3; ++i)
    {
      sums[1 + i] += photon.position[i];
      sums[4 + i] += photon.direction[i];
      sums[7 + i] += photon.power[i];
    }
  }
  tyndall::RequireSame(communicator, "the photons", true, sums);
}
}

std::string NotInBlocks(const MarchSettings& settings, bool octree)
{
  if (octree)
  {
    return "the steps of an octree";
  }
  return settings.sums == MarchSettings::Sums::Unsafe ? "Unsafe sums" : std::string();
}

namespace
{
/// One rank's part of a march.
class RankOfMarch
{
public:
  RankOfMarch(
    Device& device, Communicator& communicator, const BlockPartition& partition, const MarchSettings& settings)
    : TheDevice(device)
    , Others(communicator)
    , Partition(partition)
    , Settings(settings)
    , Own(BlockOf(partition, communicator.Rank()))
    , Has(this->Own.VoxelCount() > 0)
  {
  }

  void CheckInput(const Medium& medium, const Field& ior) const;
  void Prepare(const Medium& medium, const Field& ior);
  PhotonLight March(const std::vector<Photon>& photons, const PhotonNumbers& numbers, const Monitor& monitor);
  PhotonLight MarchInBatches(const std::vector<Photon>& photons, const Monitor& monitor);
  const PhotonTraffic& Traffic() const { return this->Rounds->Traffic(); }

private:
  MarchTraits TraitsOfAllRanks(const Medium& medium, const Field& ior);
  VoxelBox KnownOf(int rank, bool bends) const;
  std::vector<float> IndexAround(const Field& ior, bool bends);
  void PrepareScattering(const Medium& medium, const Field& index);
  void Pack(const std::vector<Photon>& photons);
  void Follow(const CountedPhotons& counted, PhotonLight& result, const Monitor& monitor);
  ScatteredPhotons FollowScattered(const PhotonScattering* in, PackedPhotons photons,
    const PhotonScattering::Settings& settings, const Monitor& monitor);
  void AddScattered(PhotonLight& result, const PhotonNumbers& numbers, const Monitor& monitor);
  void SumUp(const std::vector<Rgb*>& powers, const std::vector<double*>& numbers);
  void AddUp(PhotonLight& result);
  void AddUpScattered(PhotonLight& result);

  Device& TheDevice;
  Communicator& Others;
  const BlockPartition& Partition;
  const MarchSettings& Settings;
  const VoxelBox Own;
  const bool Has; ///< voxels
  std::unique_ptr<PhotonRounds> Rounds;
  MarchTraits Traits;
  PackedPhotons Packed;                          ///< those that set off here, in units and channels of all
  std::unique_ptr<MarchMedium> Through;          ///< null without voxels
  std::unique_ptr<MarchedLight> Light;           ///< likewise
  std::unique_ptr<ScatteredChannels> Scattering; ///< null: photons are followed to where they are first scattered
  MarchSums Target;
};

void RankOfMarch::CheckInput(const Medium& medium, const Field& ior) const
{
  this->Partition.Check();
  Require(
    static_cast<int>(this->Partition.blocks.size()) == this->Others.Ranks(), "There is not a block for each rank.");
  Check(this->Settings);
  if (this->Has)
  {
    Check(medium);
    Require(medium.grid.size == this->Own.size,
      "The medium of rank " + std::to_string(this->Others.Rank()) + " does not have the size of its block.");
    CheckIndex(ior, medium.grid);
  }
  const std::string refused = NotInBlocks(this->Settings, false);
  Require(refused.empty(), "A medium that is spread over ranks is not marched through with " + refused + ".");
}

MarchTraits RankOfMarch::TraitsOfAllRanks(const Medium& medium, const Field& ior)
{
  MarchTraits traits = this->Has ? MarchTraitsOf(medium, ior) : MarchTraits();
  static_cast<MediumTraits&>(traits) = TraitsOfAll(this->Others, traits);
  const float endless = std::numeric_limits<float>::infinity();
  const std::vector<double> largest = this->Others.Largest({ traits.coloured ? 1.0 : 0.0,
    this->Has ? -traits.index.least : -endless, this->Has ? traits.index.largest : -endless });
  traits.coloured = largest[0] > 0.0;
  traits.index = { static_cast<float>(-largest[1]), static_cast<float>(largest[2]) };
  return traits;
}

/// The voxels whose index a rank needs.
VoxelBox RankOfMarch::KnownOf(int rank, bool bends) const
{
  const VoxelBox& block = this->Partition.blocks[rank];
  return bends && block.VoxelCount() > 0 ? Grown(block, ReachOfIndex(this->Settings), this->Partition.whole) : block;
}

/// The index of these, from all ranks. Empty where it is 1 everywhere, or constant.
std::vector<float> RankOfMarch::IndexAround(const Field& ior, bool bends)
{
  if (!bends)
  {
    return {};
  }
  std::vector<VoxelBox> known;
  for (int rank = 0; rank < this->Others.Ranks(); ++rank)
  {
    known.push_back(this->KnownOf(rank, bends));
  }
  std::vector<float> own(this->Has ? this->Own.VoxelCount() : 0, 1.0f);
  if (this->Has && ior.values)
  {
    std::copy_n(ior.values, own.size(), own.begin());
  }
  return ValuesInBox(this->Others, this->Partition, known, own, 1);
}

void RankOfMarch::Prepare(const Medium& medium, const Field& ior)
{
  this->Rounds = std::make_unique<PhotonRounds>(this->Others, this->Partition);
  this->Traits = this->TraitsOfAllRanks(medium, ior);
  const bool bends = !this->Settings.leaveOut || this->Traits.index.Varies();
  const std::vector<float> index = this->IndexAround(ior, bends);
  const Field known = { index.empty() ? nullptr : index.data(), 1 };
  this->Others.Together([&] {
    if (this->Has)
    {
      const MarchedPart block = { this->Partition.whole, this->Own, this->KnownOf(this->Others.Rank(), bends) };
      this->Through =
        std::make_unique<MarchMedium>(this->TheDevice, medium, known, this->Settings, this->Traits, block);
      this->Light = std::make_unique<MarchedLight>(*this->Through);
    }
  });
  if (this->Settings.maximumOrders != 1 && this->Traits.scatters)
  {
    this->PrepareScattering(medium, known);
  }
}

void RankOfMarch::PrepareScattering(const Medium& medium, const Field& index)
{
  const bool varies = this->Has && medium.phase.Varies();
  const auto cosine = [&](int c) { return this->Has && !varies ? medium.phase.MeanCosine(0, c) : 0.0; };
  tyndall::RequireSame(
    this->Others, "g", this->Has, { varies ? 1.0 : 0.0, cosine(0), cosine(1), cosine(2) });
  const double part = this->Through ? ScatteringStepPart(index, this->Through->block.known.size) : 1.0;
  const std::vector<double> largest =
    this->Others.Largest({ -part, this->Has && medium.phase.HasColour() ? 1.0 : 0.0 });
  const bool coloured = this->Traits.coloured || largest[1] > 0.0;
  this->Others.Together([&] {
    this->Scattering = std::make_unique<ScatteredChannels>(this->TheDevice,
      ScatteredChannels::Block{ this->Through.get(), medium, index, this->Settings, -largest[0], coloured });
  });
}

/// Those that set off here, and where their light goes.
void RankOfMarch::Pack(const std::vector<Photon>& photons)
{
  this->Others.Together([&] {
    const Grid& whole = this->Partition.whole;
    const bool coloured = this->Traits.Channels(this->Settings) == 3;
    this->Packed = ThoseIn(this->Own, whole,
      tyndall::Pack(
        photons, whole, coloured, MarchEventLimit(whole, this->Settings), this->Settings.batches));
    if (this->Light)
    {
      this->Target = this->Light->Prepare(this->Packed);
    }
  });
}

/// Up to where they are first scattered.
void RankOfMarch::Follow(const CountedPhotons& counted, PhotonLight& result, const Monitor& monitor)
{
  std::unique_ptr<BlockMarch> march;
  this->Rounds->UntilAllEnd<PhotonOnItsWay>(
    [&](int round, std::vector<PhotonOnItsWay>&& arrived, const Monitor& ofRound) {
      BlockMarch::Outcome outcome;
      if (this->Has && round == 0)
      {
        march = std::make_unique<BlockMarch>(*this->Through, this->Target, this->Packed);
        outcome = march->Start(this->Packed, counted.marks, ofRound);
      }
      else if (this->Has)
      {
        outcome = march->Resume(std::move(arrived), ofRound);
      }
      Tally(this->Packed, outcome.ends, result);
      return std::move(outcome.gone);
    },
    monitor);
}

/// This rank's share of one channel's scattered light and tallies.
ScatteredPhotons RankOfMarch::FollowScattered(const PhotonScattering* in, PackedPhotons photons,
  const PhotonScattering::Settings& settings, const Monitor& monitor)
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
  this->Others.Together([&] { found = run ? run->Finish() : found; });
  return found;
}

/// Powers and numbers of this rank to the sums of all.
void RankOfMarch::SumUp(const std::vector<Rgb*>& powers, const std::vector<double*>& numbers)
{
  std::vector<double> values;
  for (const Rgb* power : powers)
  {
    values.insert(values.end(), power->begin(), power->end());
  }
  std::transform(numbers.begin(), numbers.end(), std::back_inserter(values), [](const double* number) { return *number; });
  values = this->Others.Sum(values);
  auto value = values.cbegin();
  for (Rgb* power : powers)
  {
    std::copy_n(value, 3, power->begin());
    value += 3;
  }
  for (double* number : numbers)
  {
    *number = *value++;
  }
}

void RankOfMarch::AddUp(PhotonLight& result)
{
  EnergyBalance& balance = result.light.balance;
  std::vector<Rgb*> powers = { &balance.absorbed, &balance.escaped, &balance.leftOver, &result.scattered };
  for (Rgb& face : result.light.facePowerOut)
  {
    powers.push_back(&face);
  }
  double deposits = static_cast<double>(result.deposits), steps = static_cast<double>(result.steps);
  this->SumUp(powers, { &deposits, &steps });
  result.deposits = static_cast<std::size_t>(deposits);
  result.steps = static_cast<std::size_t>(steps);
}

void RankOfMarch::AddUpScattered(PhotonLight& result)
{
  EnergyBalance& balance = result.light.balance;
  std::vector<Rgb*> powers = { &balance.entered, &balance.absorbed, &balance.escaped, &balance.leftOver,
    &result.exchanged };
  for (Rgb& face : result.light.facePowerOut)
  {
    powers.push_back(&face);
  }
  double scatterings = static_cast<double>(result.scatterings);
  this->SumUp(powers, { &scatterings });
  result.scatterings = static_cast<std::uint64_t>(scatterings);
}

PhotonLight RankOfMarch::March(
  const std::vector<Photon>& photons, const PhotonNumbers& numbers, const Monitor& monitor)
{
  this->Pack(photons);
  PhotonLight result;
  const int colours =
    this->Scattering && this->Scattering->HasColour() ? 3 : this->Traits.ColoursOf(this->Packed);
  result.light.channels = std::max(this->Packed.channels, colours);
  result.light.device = this->TheDevice.Name();
  result.light.balance.entered = this->Packed.entered;
  result.missed = this->Packed.missed;
  result.batches = BatchesOf(photons);
  CountedPhotons counted;
  this->Others.Together([&] { counted = CountedPhotons(photons, this->Packed, this->Settings.counts); });
  result.secondsMarching = -ClockSeconds();
  this->Follow(counted, result, this->Scattering ? OfPart(monitor, 0.0, 0.05) : monitor);
  this->Others.Together([&] {
    if (this->Has)
    {
      this->Light->Finish(this->Packed, this->Target, counted.weightUnit, result);
      SayWhatIsLeftOut(*this->Through, this->Packed, result.light);
    }
  });
  this->AddUp(result);
  PutIntoColours(this->Packed, colours, result);
  this->AddScattered(result, numbers, OfPart(monitor, 0.05, 1.0));
  if (this->Settings.batches && this->Packed.Batches() == 1)
  {
    result.batchFluence = result.light.fluence;
  }
  return result;
}

/// What more orders than one ask for.
void RankOfMarch::AddScattered(PhotonLight& result, const PhotonNumbers& numbers, const Monitor& monitor)
{
  if (this->Scattering)
  {
    this->Scattering->AddTo(result, this->Packed, numbers, monitor,
      [this](const PhotonScattering* in, PackedPhotons photons, const PhotonScattering::Settings& settings,
        const Monitor& ofRun) { return this->FollowScattered(in, std::move(photons), settings, ofRun); });
    this->AddUpScattered(result);
  }
  else if (this->Settings.maximumOrders != 1)
  {
    result.light.fluenceDirect = result.light.fluence; // nothing scatters
  }
}

PhotonLight RankOfMarch::MarchInBatches(const std::vector<Photon>& photons, const Monitor& monitor)
{
  const auto batches = static_cast<std::size_t>(this->Settings.errorBatches);
  MarchedBatches all;
  for (std::size_t b = 0; b < batches; ++b)
  {
    const PhotonNumbers numbers = NumbersOfBatch(photons.size(), b, batches);
    std::vector<Photon> some;
    for (const std::size_t number : numbers)
    {
      some.push_back(photons[number]);
    }
    const double parts = static_cast<double>(batches);
    all.Add(this->March(some, numbers, OfPart(monitor, b / parts, (b + 1) / parts)));
  }
  return std::move(all).Sum();
}
}

PhotonLight MarchInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Field& ior, const MarchSettings& settings, const std::vector<Photon>& photons,
  const Monitor& monitor, PhotonTraffic* traffic)
{
  const double start = ClockSeconds();
  RankOfMarch rank(device, communicator, partition, settings);
  communicator.Together([&] { rank.CheckInput(medium, ior); });
  RequireSame(communicator, partition);
  RequireSame(communicator, settings);
  RequireSame(communicator, photons);
  rank.Prepare(medium, ior);
  PhotonLight result =
    settings.errorBatches > 0 ? rank.MarchInBatches(photons, monitor) : rank.March(photons, {}, monitor);
  result.seconds = ClockSeconds() - start;
  if (traffic)
  {
    *traffic = rank.Traffic();
  }
  return result;
}
}
