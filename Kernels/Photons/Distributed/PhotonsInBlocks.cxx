#include "Photons/Distributed/PhotonsInBlocks.h"

#include "Device/Clock.h"
#include "Device/Errors.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/SharedMedium.h"
#include "Photons/Distributed/BlockMarch.h"
#include "Photons/Marching/MarchedLight.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int PhotonsTag = 29998; ///< not one of those that BoxExchange.cxx takes

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
  const auto each = static_cast<std::ptrdiff_t>(packed.FloatsEach());
  auto values = packed.values.begin();
  for (std::size_t i = 0; i < packed.Count(); ++i, values += each)
  {
    int voxel[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      voxel[axis] = std::clamp(static_cast<int>(values[axis]), 0, whole.size[axis] - 1);
    }
    if (Holds(block, voxel))
    {
      own.values.insert(own.values.end(), values, values + each);
      own.numbers.push_back(packed.numbers[i]);
    }
  }
  own.batchBegin = { 0, static_cast<int>(own.Count()) };
  return own;
}

void RequireSame(Communicator& communicator, const MarchSettings& settings)
{
  tyndall::RequireSame(communicator, "settings", true,
    { 1.0 * settings.order, settings.stepSize, 1.0 * settings.meanDirection, 1.0 * settings.counts,
      1.0 * settings.maximumOrders, 1.0 * settings.leaveOut });
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
  if (settings.maximumOrders != 1)
  {
    return "scattered photons (MaximumOrders other than 1)";
  }
  if (octree)
  {
    return "the steps of an octree";
  }
  if (settings.batches || settings.errorBatches > 0)
  {
    return "light by batches of photons (standard errors)";
  }
  return settings.sums == MarchSettings::Sums::Unsafe ? "Unsafe sums" : std::string();
}

namespace
{
/// One rank's part of a march.
class RankOfMarch
{
public:
  RankOfMarch(Device& device, Communicator& communicator, const BlockPartition& partition,
    const MarchSettings& settings, const std::vector<Photon>& photons)
    : TheDevice(device)
    , Others(communicator)
    , Partition(partition)
    , Settings(settings)
    , Photons(photons)
    , Own(BlockOf(partition, communicator.Rank()))
    , Has(this->Own.VoxelCount() > 0)
  {
    const VoxelBox touched = Grown(this->Own, 1, partition.whole);
    for (int rank = 0; rank < static_cast<int>(partition.blocks.size()) && this->Has; ++rank)
    {
      if (rank != communicator.Rank() && Common(partition.blocks[rank], touched).VoxelCount() > 0)
      {
        this->Neighbours.push_back(rank);
      }
    }
  }

  void CheckInput(const Medium& medium, const Field& ior) const;
  void Prepare(const Medium& medium, const Field& ior);
  PhotonLight March(const Monitor& monitor);
  const PhotonTraffic& Traffic() const { return this->Handed; }

private:
  MarchTraits TraitsOfAllRanks(const Medium& medium, const Field& ior);
  VoxelBox KnownOf(int rank, bool bends) const;
  std::vector<float> IndexAround(const Field& ior, bool bends);
  std::vector<PhotonOnItsWay> HandOn(const std::vector<PhotonOnItsWay>& gone);
  void Follow(const CountedPhotons& counted, PhotonLight& result, const Monitor& monitor);
  void AddUp(PhotonLight& result);

  Device& TheDevice;
  Communicator& Others;
  const BlockPartition& Partition;
  const MarchSettings& Settings;
  const std::vector<Photon>& Photons;
  const VoxelBox Own;
  const bool Has; ///< voxels
  std::vector<int> Neighbours;
  MarchTraits Traits;
  PackedPhotons Packed;                 ///< those that set off here, in units and channels of all
  std::unique_ptr<MarchMedium> Through; ///< null without voxels
  std::unique_ptr<MarchedLight> Light;  ///< likewise
  MarchSums Target;
  PhotonTraffic Handed;
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
  this->Traits = this->TraitsOfAllRanks(medium, ior);
  const bool bends = !this->Settings.leaveOut || this->Traits.index.Varies();
  const std::vector<float> index = this->IndexAround(ior, bends);
  this->Others.Together([&] {
    const Grid& whole = this->Partition.whole;
    const bool coloured = this->Traits.Channels(this->Settings) == 3;
    this->Packed =
      ThoseIn(this->Own, whole, Pack(this->Photons, whole, coloured, MarchEventLimit(whole, this->Settings)));
    if (this->Has)
    {
      const MarchedPart block = { whole, this->Own, this->KnownOf(this->Others.Rank(), bends) };
      this->Through = std::make_unique<MarchMedium>(this->TheDevice, medium,
        Field{ index.empty() ? nullptr : index.data(), 1 }, this->Settings, this->Traits, block);
      this->Light = std::make_unique<MarchedLight>(*this->Through);
      this->Target = this->Light->Prepare(this->Packed);
    }
  });
  RequireSame(this->Others, this->Photons);
}

/// Those that have come, for those that have gone.
std::vector<PhotonOnItsWay> RankOfMarch::HandOn(const std::vector<PhotonOnItsWay>& gone)
{
  std::vector<std::vector<PhotonOnItsWay>> parcels(this->Neighbours.size());
  for (const PhotonOnItsWay& photon : gone)
  {
    const auto holds = [&](int rank) { return Holds(this->Partition.blocks[rank], photon.voxel); };
    const auto to = std::find_if(this->Neighbours.begin(), this->Neighbours.end(), holds);
    parcels.at(static_cast<std::size_t>(to - this->Neighbours.begin())).push_back(photon);
  }
  for (std::size_t i = 0; i < parcels.size(); ++i)
  {
    this->Others.Send(this->Neighbours[i], PhotonsTag, parcels[i]);
  }
  this->Handed.photons += gone.size();
  this->Handed.bytes += gone.size() * sizeof(PhotonOnItsWay);
  std::vector<PhotonOnItsWay> arrived;
  for (const int rank : this->Neighbours)
  {
    const std::vector<PhotonOnItsWay> parcel = this->Others.Receive<PhotonOnItsWay>(rank, PhotonsTag);
    arrived.insert(arrived.end(), parcel.begin(), parcel.end());
  }
  return arrived;
}

/// Until no photon is left anywhere.
void RankOfMarch::Follow(const CountedPhotons& counted, PhotonLight& result, const Monitor& monitor)
{
  std::unique_ptr<BlockMarch> march;
  std::vector<PhotonOnItsWay> arrived;
  double done = 0.0;
  for (bool left = true; left; ++this->Handed.rounds)
  {
    BlockMarch::Outcome outcome;
    this->Others.Together([&] {
      const Monitor ofRound = OfPart(monitor, done, 0.5 * (1.0 + done));
      if (this->Has && this->Handed.rounds == 0)
      {
        march = std::make_unique<BlockMarch>(*this->Through, this->Target, this->Packed);
        outcome = march->Start(this->Packed, counted.marks, ofRound);
      }
      else if (this->Has)
      {
        outcome = march->Resume(arrived, ofRound);
      }
      Report(monitor, done = 0.5 * (1.0 + done));
    });
    Tally(this->Packed, outcome.ends, result);
    arrived = this->HandOn(outcome.gone);
    left = this->Others.Largest({ arrived.empty() ? 0.0 : 1.0 })[0] > 0.0;
  }
}

/// Tallies of this rank to those of all.
void RankOfMarch::AddUp(PhotonLight& result)
{
  EnergyBalance& balance = result.light.balance;
  std::vector<Rgb*> powers = { &balance.absorbed, &balance.escaped, &balance.leftOver, &result.scattered };
  for (Rgb& face : result.light.facePowerOut)
  {
    powers.push_back(&face);
  }
  std::vector<double> values = { static_cast<double>(result.deposits), static_cast<double>(result.steps) };
  for (const Rgb* power : powers)
  {
    values.insert(values.end(), power->begin(), power->end());
  }
  values = this->Others.Sum(values);
  result.deposits = static_cast<std::size_t>(values[0]);
  result.steps = static_cast<std::size_t>(values[1]);
  auto value = values.cbegin() + 2;
  for (Rgb* power : powers)
  {
    std::copy_n(value, 3, power->begin());
    value += 3;
  }
}

PhotonLight RankOfMarch::March(const Monitor& monitor)
{
  PhotonLight result;
  const int colours = this->Traits.ColoursOf(this->Packed);
  result.light.channels = std::max(this->Packed.channels, colours);
  result.light.device = this->TheDevice.Name();
  result.light.balance.entered = this->Packed.entered;
  result.missed = this->Packed.missed;
  result.batches = BatchesOf(this->Photons);
  CountedPhotons counted;
  this->Others.Together([&] { counted = CountedPhotons(this->Photons, this->Packed, this->Settings.counts); });
  result.secondsMarching = -ClockSeconds();
  this->Follow(counted, result, monitor);
  this->Others.Together([&] {
    if (this->Has)
    {
      this->Light->Finish(this->Packed, this->Target, counted.weightUnit, result);
      SayWhatIsLeftOut(*this->Through, this->Packed, result.light);
    }
  });
  this->AddUp(result);
  PutIntoColours(this->Packed, colours, result);
  return result;
}
}

PhotonLight MarchInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Field& ior, const MarchSettings& settings, const std::vector<Photon>& photons,
  const Monitor& monitor, PhotonTraffic* traffic)
{
  const double start = ClockSeconds();
  RankOfMarch rank(device, communicator, partition, settings, photons);
  communicator.Together([&] { rank.CheckInput(medium, ior); });
  RequireSame(communicator, partition);
  RequireSame(communicator, settings);
  rank.Prepare(medium, ior);
  PhotonLight result = rank.March(monitor);
  result.seconds = ClockSeconds() - start;
  if (traffic)
  {
    *traffic = rank.Traffic();
  }
  return result;
}
}
