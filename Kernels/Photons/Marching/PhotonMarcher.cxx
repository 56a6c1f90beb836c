#include "Photons/Marching/PhotonMarcher.h"

#include "Device/Clock.h"
#include "Device/Errors.h"
#include "Device/Sizes.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/SharedMedium.h"
#include "LightPropagation/Convergence.h"
#include "Numerics/NumberText.h"
#include "Photons/Importance/PilotGathering.h"
#include "Photons/Marching/MarchedLight.h"
#include "Photons/Marching/MarchRun.h"
#include "Photons/Marching/PhotonPacking.h"
#include "Photons/Scattering/PhotonScattering.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
/// Width in voxels of the halo of the refractive index on which paths in a block depend (numerics.md, Eq. (99f)): three
/// voxels for the support of the spline, and the look-ahead of the path integrator. Beyond the halo, the index counts
/// as constant.
/// @param octree  whether steps follow the nodes of an octree
int ReachOfIndex(const MarchSettings& settings, bool octree)
{
  constexpr int OfSpline = 3;
  if (settings.order == 1)
  {
    return OfSpline;
  }
  const double steps = 0.5 * (settings.order == 2 ? LeapfrogLooksAhead : YoshidaLooksAhead) * settings.stepSize;
  const double ahead = octree && settings.order == 4 ? std::max(steps, 1.0 * (1 << YoshidaLevel)) : steps;
  return OfSpline + 1 + static_cast<int>(ahead); // one voxel more, for positions on the upper wall of a voxel
}

void RequireSame(const Domain& domain, const MarchSettings& settings)
{
  tyndall::RequireSame(domain.Comm(), "settings", true,
    { 1.0 * settings.order, settings.stepSize, 1.0 * settings.meanDirection, 1.0 * settings.counts,
      1.0 * settings.maximumOrders, 1.0 * settings.leaveOut, static_cast<double>(settings.seed),
      1.0 * settings.errorBatches, 1.0 * settings.batches });
}

/// Whether the domain is divided among ranks, so that photons pass from block to block. The same on all ranks.
bool IsDivided(const Domain& domain)
{
  const std::vector<VoxelBox>& blocks = domain.Partition().blocks;
  return std::any_of(blocks.begin(), blocks.end(),
    [&](const VoxelBox& block) { return block.VoxelCount() > 0 && block.size != domain.Whole().size; });
}
}

void Check(const MarchSettings& settings)
{
  constexpr double ShortestStep = 0.05; // in voxels; the digits of positions do not suffice for shorter steps
  constexpr double LongestStep = 1e4;
  Require(settings.order == 1 || settings.order == 2 || settings.order == 4,
    "The integrator's order is " + std::to_string(settings.order) + "; there are 1, 2 and 4.");
  Require(settings.stepSize >= ShortestStep && settings.stepSize <= LongestStep,
    "The step size is " + Text("%g", settings.stepSize) + " voxels; it must be " + Text("%g", ShortestStep) + " to " +
      Text("%g", LongestStep) + ".");
  Require(settings.maximumOrders >= 0,
    "MaximumOrders is " + std::to_string(settings.maximumOrders) +
      "; it must be 0 (until photons are absorbed or have left) or more.");
  Require(settings.errorBatches == 0 || (settings.errorBatches > 1 && settings.errorBatches <= MarchedBatchesAtMost),
    "A standard error from " + std::to_string(settings.errorBatches) +
      " batches of photons was asked for; it takes 2 to " + std::to_string(MarchedBatchesAtMost) + ", or 0 for none.");
  Require(settings.errorBatches == 0 || !(settings.batches || settings.counts),
    "The standard error is found from batches of its own. Ask for it, or for counts and for the light "
    "of each of the photons' batches, not for both.");
  Require(settings.maximumOrders == 1 || !settings.batches,
    "The light of each batch is kept apart as far as photons are not scattered. Take MaximumOrders 1 "
    "with batches, or none of them.");
}

class PhotonMarcher::Implementation
{
public:
  Implementation(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
    const MarchSettings& settings, const std::uint8_t* levels);

  /// Marches this rank's photons. Collective.
  /// @param turns  callbacks for a march in turns; null: photons are marched to their ends at once
  PhotonLight March(const std::vector<Photon>& share, MarchTurns* turns, const Monitor& monitor);
  std::vector<PhotonPath> Paths(const std::vector<Photon>& share, const std::vector<std::size_t>& chosen) const;
  /// Throws unless light is stored voxel by voxel.
  /// @param what  beginning of the error message: the feature that requires storage voxel by voxel
  /// @throws InvalidInput if light is stored by bricks
  void RequireVoxels(const char* what) const;

  const Domain TheDomain;
  const MarchSettings Settings;
  RoundsTraffic Handed; ///< messages that this rank sent in the last march
  std::unique_ptr<PilotGathering> Pilots;
  std::unique_ptr<const ScatteringForecast> Forecast; ///< null as Scattering

private:
  VoxelBox KnownOf(const VoxelBox& block, int reach) const;
  Field IndexAround(const Field& ior, int reach, std::vector<float>& values) const;
  void ShareNodes(const std::uint8_t* levels);
  void PrepareScattering(const Medium& medium, const Field& index, const std::uint8_t* levels);
  PhotonLight MarchThese(
    const std::vector<Photon>& share, const PhotonNumbers& numbers, MarchTurns* turns, const Monitor& monitor);
  PhotonLight MarchInBatches(const std::vector<Photon>& share, const PlaceOfShare& place, const Monitor& monitor);
  void FollowUncollided(
    const StartingPhotons& starting, MarchTurns* turns, PhotonLight& result, const Monitor& monitor);
  void AtOnce(
    const StartingPhotons& starting, const MarchSums& target, PhotonLight& result, const Monitor& monitor) const;
  void ByTurns(const StartingPhotons& starting, const MarchSums& target, PhotonLight& result, MarchTurns& turns,
    const Monitor& monitor) const;
  void AddScattered(const PackedPhotons& packed, PhotonLight& result, const Monitor& monitor) const;
  ScatteredPhotons FollowScattered(const PhotonScattering* in, PackedPhotons photons, const Monitor& monitor) const;

  Device& TheDevice;
  const bool Divided; ///< whether the domain is divided among ranks
  MarchTraits Traits; ///< traits of the medium in the domain
  /// Octree nodes of a divided domain; null: the domain is not divided, or steps use no octree
  std::unique_ptr<BrickedBytes> Nodes;
  std::unique_ptr<MarchMedium> Through; ///< medium of this rank's block; null if the rank has no voxels
  std::unique_ptr<MarchedLight> Light;  ///< sums of uncollided light; null if the rank has no voxels
  /// Scattering of all channels; null if photons are followed to their first collision only.
  std::unique_ptr<ScatteredChannels> Scattering;
  std::unique_ptr<Rounds> TheRounds; ///< exchange of photons between blocks; null outside a march
};

PhotonMarcher::Implementation::Implementation(Device& device, const Domain& domain, const Medium& medium,
  const Field& ior, const MarchSettings& settings, const std::uint8_t* levels)
  : TheDomain(domain)
  , Settings(settings)
  , TheDevice(device)
  , Divided(IsDivided(domain))
{
  const bool octree = domain.Any(levels != nullptr);
  FilledBricks filled;
  domain.Collective([&] {
    filled = CheckMarchedMedium(domain, medium, ior, levels, octree);
    Check(settings);
  });
  RequireSameMedium(domain, medium, ior);
  RequireSame(domain, settings);
  this->Traits = MarchTraitsOf(domain, medium, ior, filled);
  const bool bends = !settings.leaveOut || this->Traits.index.Varies();
  const int reach = bends ? ReachOfIndex(settings, octree) : 0;
  std::vector<float> around;
  const Field index = this->IndexAround(ior, reach, around);
  domain.Collective([&] {
    if (!domain.IsEmpty())
    {
      const MarchedPart block = { domain.Whole(), domain.Own(), this->KnownOf(domain.Own(), reach) };
      this->Through =
        std::make_unique<MarchMedium>(device, medium, index, settings, this->Traits, block, &filled, levels);
    }
  });
  if (octree && bends && this->Divided)
  {
    this->ShareNodes(levels);
  }
  domain.Collective([&] {
    if (this->Through)
    {
      this->Light = std::make_unique<MarchedLight>(*this->Through);
      this->Light->Share(1, 1); // throws if the device has no atomics or too little memory for the sums
    }
  });
  if (settings.maximumOrders != 1 && this->Traits.scatters)
  {
    this->PrepareScattering(medium, index, levels);
    this->Forecast = std::make_unique<const ScatteringForecast>(domain, medium);
  }
  this->Pilots = std::make_unique<PilotGathering>(this->TheDomain, this->Through.get(), this->Traits, this->Settings);
}

/// Box of voxels in which a rank needs the refractive index: its block, and a halo of `reach` voxels.
VoxelBox PhotonMarcher::Implementation::KnownOf(const VoxelBox& block, int reach) const
{
  return block.VoxelCount() > 0 ? Grown(block, reach, this->TheDomain.Whole()) : block;
}

/// Refractive index in this rank's block and its halo, gathered from all ranks. Null values if no path depends on the
/// index.
/// @param reach  halo in voxels; 0: no path depends on the index
/// @param values  storage of the gathered index, if the domain is divided
Field PhotonMarcher::Implementation::IndexAround(const Field& ior, int reach, std::vector<float>& values) const
{
  const Domain& domain = this->TheDomain;
  if (reach == 0 || !this->Divided)
  {
    return reach == 0 ? Field() : ior;
  }
  std::vector<VoxelBox> known;
  for (const VoxelBox& block : domain.Partition().blocks)
  {
    known.push_back(this->KnownOf(block, reach));
  }
  std::vector<float> own(domain.Own().VoxelCount(), 1.0f);
  if (ior.values)
  {
    std::copy_n(ior.values, own.size(), own.begin());
  }
  values = ValuesInBox(domain.Comm(), domain.Partition(), known, own, 1);
  return { values.empty() ? nullptr : values.data(), 1 };
}

/// Collects the octree nodes of the domain on every rank. Collective.
void PhotonMarcher::Implementation::ShareNodes(const std::uint8_t* levels)
{
  const Domain& domain = this->TheDomain;
  std::vector<std::uint8_t> own;
  domain.Collective([&] { own = this->Through ? this->Through->OwnNodes(levels) : own; });
  this->Nodes = std::make_unique<BrickedBytes>(BytesOfAll(domain.Comm(), domain.Partition(), own));
  domain.Collective([&] {
    if (this->Through)
    {
      this->Through->SetNodes(*this->Nodes);
    }
  });
}

void PhotonMarcher::Implementation::PrepareScattering(
  const Medium& medium, const Field& index, const std::uint8_t* levels)
{
  const Domain& domain = this->TheDomain;
  const bool has = !domain.IsEmpty(), varies = has && medium.phase.Varies();
  const auto cosine = [&](int c) { return has && !varies ? medium.phase.MeanCosine(0, c) : 0.0; };
  tyndall::RequireSame(domain.Comm(), "g", has, { varies ? 1.0 : 0.0, cosine(0), cosine(1), cosine(2) });
  const double part = -domain.Max(has ? -ScatteringStepPart(index, this->Through->block.known.size) : -1.0);
  const bool coloured = domain.Any(this->Traits.coloured || (has && medium.phase.HasColour()));
  domain.Collective([&] {
    this->Scattering = std::make_unique<ScatteredChannels>(this->TheDevice,
      ScatteredChannels::Block{
        this->Through.get(), medium, index, levels, this->Settings, part, coloured, this->Nodes.get() });
  });
}

void PhotonMarcher::Implementation::RequireVoxels(const char* what) const
{
  Require(!this->Through || !this->Through->bricks.AreThere(),
    std::string(what) + " voxel by voxel. Do not ask for light by bricks.");
}

void PhotonMarcher::Implementation::AtOnce(
  const StartingPhotons& starting, const MarchSums& target, PhotonLight& result, const Monitor& monitor) const
{
  std::unique_ptr<MarchRun> run;
  this->TheDomain.Collective([&] {
    run = this->Through ? std::make_unique<MarchRun>(*this->Through, target, starting.packed.channels) : nullptr;
  });
  this->TheRounds->UntilAllEnd<PhotonOnItsWay>(
    [&](int round, std::vector<PhotonOnItsWay>&& arrived, const Monitor& ofRound) {
      MarchRun::Outcome outcome;
      if (run)
      {
        outcome =
          round == 0 ? run->Start(starting.packed, starting.marks, ofRound) : run->Resume(std::move(arrived), ofRound);
      }
      Tally(starting.packed, outcome.ends, result);
      return std::move(outcome.gone);
    },
    monitor);
}

void PhotonMarcher::Implementation::ByTurns(const StartingPhotons& starting, const MarchSums& target,
  PhotonLight& result, MarchTurns& turns, const Monitor& monitor) const
{
  const std::array<int, 3>& size = this->TheDomain.Own().size;
  const std::size_t rows = Count(size[1]) * Count(size[2]);
  const Buffer<float> fluence(
    this->TheDevice, rows * Count(size[0]) * Count(result.light.channels), "fluence of photons on their way");
  const cl::Kernel show = this->Light->Show(starting.packed, target, result.light, fluence);
  const PhotonsOnDevice onDevice(this->TheDevice, starting.packed, starting.marks);
  turns.begin(starting.packed, result.light.channels);
  MarchInTurns(
    *this->Through, starting.packed, onDevice, target, turns,
    [&](const cl::CommandQueue& queue) -> const Buffer<float>& {
      queue.enqueueNDRangeKernel(show, cl::NullRange, cl::NDRange(rows));
      return fluence;
    },
    monitor);
  Tally(starting.packed, onDevice.ends.Read(), result);
}

/// Follows photons to their first collision, and converts their deposits to uncollided light. Collective.
void PhotonMarcher::Implementation::FollowUncollided(
  const StartingPhotons& starting, MarchTurns* turns, PhotonLight& result, const Monitor& monitor)
{
  MarchSums target;
  try
  {
    this->TheDomain.Collective([&] { target = this->Light ? this->Light->Prepare(starting.packed) : target; });
    if (turns)
    {
      this->ByTurns(starting, target, result, *turns, monitor);
    }
    else
    {
      this->AtOnce(starting, target, result, monitor);
    }
  }
  catch (...)
  {
    if (this->Light)
    {
      this->Light->Forget();
    }
    throw;
  }
  this->TheDomain.Collective([&] {
    if (this->Light)
    {
      this->Light->Finish(starting.packed, target, starting.weightUnit, result);
      SayWhatIsLeftOut(*this->Through, starting.packed, result.light);
    }
  });
  AddUpTallies(this->TheDomain, result);
}

/// Follows photons of one channel through scatterings. Returns their light in this rank's block, their energy balance
/// and the number of scatterings. Collective.
/// @param in  medium and phase function of the channel; null if this rank has no voxels
ScatteredPhotons PhotonMarcher::Implementation::FollowScattered(
  const PhotonScattering* in, PackedPhotons photons, const Monitor& monitor) const
{
  std::unique_ptr<ScatteringRun> run;
  this->TheRounds->UntilAllEnd<ScatteredOnItsWay>(
    [&](int round, std::vector<ScatteredOnItsWay>&& arrived, const Monitor& ofRound) {
      if (in && round == 0)
      {
        run = std::make_unique<ScatteringRun>(*in, std::move(photons));
        return run->Start(ofRound);
      }
      return in ? run->Resume(arrived, ofRound) : std::vector<ScatteredOnItsWay>();
    },
    monitor);
  ScatteredPhotons found;
  this->TheDomain.Collective([&] { found = run ? run->Finish() : found; });
  return found;
}

/// Adds the light of scattering orders above the first. Collective.
void PhotonMarcher::Implementation::AddScattered(
  const PackedPhotons& packed, PhotonLight& result, const Monitor& monitor) const
{
  if (this->Scattering)
  {
    this->Scattering->AddTo(
      result, packed, monitor, [this](const PhotonScattering* in, PackedPhotons photons, const Monitor& ofRun) {
        return this->FollowScattered(in, std::move(photons), ofRun);
      });
    AddUpScattered(this->TheDomain, result);
  }
  else if (this->Settings.maximumOrders != 1)
  {
    result.light.fluenceDirect = result.light.fluence; // all light is uncollided, since nothing scatters
  }
}

/// Marches a subset of all photons. Collective.
/// @param share    photons of the subset on this rank
/// @param numbers  index of each photon of `share` among all photons
PhotonLight PhotonMarcher::Implementation::MarchThese(
  const std::vector<Photon>& share, const PhotonNumbers& numbers, MarchTurns* turns, const Monitor& monitor)
{
  const double start = ClockSeconds();
  const StartingPhotons starting =
    SendToTheirBlocks(this->TheDomain, share, numbers, this->Traits.Channels(this->Settings) == 3,
      MarchEventLimit(this->TheDomain.Whole(), this->Settings), this->Settings);
  const PackedPhotons& packed = starting.packed;
  PhotonLight result;
  const int colours = this->Scattering && this->Scattering->HasColour() ? 3 : this->Traits.ColoursOf(packed);
  result.light.channels = std::max(packed.channels, colours);
  result.light.device = this->TheDevice.Name();
  result.light.balance.entered = packed.entered;
  result.missed = packed.missed;
  result.batches = static_cast<int>(this->TheDomain.Max(BatchesOf(share)));
  result.secondsMarching = -ClockSeconds();
  this->FollowUncollided(starting, turns, result, this->Scattering ? OfPart(monitor, 0.0, 0.05) : monitor);
  PutIntoColours(packed, colours, result);
  this->AddScattered(packed, result, OfPart(monitor, 0.05, 1.0));
  if (this->Settings.batches && packed.Batches() == 1)
  {
    result.batchFluence = result.light.fluence;
  }
  result.seconds = ClockSeconds() - start;
  return result;
}

PhotonLight PhotonMarcher::Implementation::MarchInBatches(
  const std::vector<Photon>& share, const PlaceOfShare& place, const Monitor& monitor)
{
  const auto batches = static_cast<std::size_t>(this->Settings.errorBatches);
  MarchedBatches all;
  for (std::size_t b = 0; b < batches; ++b)
  {
    const PhotonNumbers numbers = NumbersOfBatch(place.all, b, batches);
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
  PhotonLight result = std::move(all).Sum();
  result.light.errorLength = std::cbrt(this->TheDomain.Whole().VoxelVolume()); // noise differs from voxel to voxel
  return result;
}

PhotonLight PhotonMarcher::Implementation::March(
  const std::vector<Photon>& share, MarchTurns* turns, const Monitor& monitor)
{
  this->TheRounds = std::make_unique<Rounds>(this->TheDomain.Comm(), this->TheDomain.Partition());
  const PlaceOfShare place = PlaceAmong(this->TheDomain.Comm(), share.size());
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
  this->Handed = this->TheRounds->Traffic();
  JudgeBalance(result.light, this->TheDomain, Medium());
  return result;
}

std::vector<PhotonPath> PhotonMarcher::Implementation::Paths(
  const std::vector<Photon>& share, const std::vector<std::size_t>& chosen) const
{
  const Domain& domain = this->TheDomain;
  const PlaceOfShare place = PlaceAmong(domain.Comm(), share.size());
  return TracePaths(domain, this->Through.get(), ChosenOnEachRank(domain.Comm(), share, place, chosen), chosen,
    MarchEventLimit(domain.Whole(), this->Settings));
}

PhotonMarcher::PhotonMarcher(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const MarchSettings& settings, const std::uint8_t* levels)
  : Inside(std::make_unique<Implementation>(device, domain, medium, ior, settings, levels))
{
}

PhotonMarcher::~PhotonMarcher() = default;
PhotonMarcher::PhotonMarcher(PhotonMarcher&&) noexcept = default;

PhotonLight PhotonMarcher::March(const std::vector<Photon>& share, const Monitor& monitor)
{
  return this->Inside->March(share, nullptr, monitor);
}

std::string PhotonMarcher::Warning(const std::vector<Photon>& share) const
{
  const Implementation& inside = *this->Inside;
  return inside.Forecast ? inside.Forecast->Warning(inside.TheDomain, share, inside.Settings.maximumOrders) : "";
}

PhotonLight PhotonMarcher::MarchByTurns(const std::vector<Photon>& photons, MarchTurns& turns, const Monitor& monitor)
{
  const MarchSettings& settings = this->Inside->Settings;
  Require(settings.maximumOrders == 1 && !settings.batches && settings.errorBatches == 0,
    "Photons march in turns up to where they are first scattered, and without batches.");
  this->Inside->RequireVoxels("Photons march in turns");
  Require(this->Inside->TheDomain.IsSerial(), "Photons march in turns on one rank.");
  return this->Inside->March(photons, &turns, monitor);
}

std::vector<PhotonPath> PhotonMarcher::Paths(const std::vector<Photon>& share, const std::vector<std::size_t>& chosen)
{
  return this->Inside->Paths(share, chosen);
}

PilotLight PhotonMarcher::Gather(const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins,
  const std::array<int, 3>& cells, const Monitor& monitor)
{
  this->Inside->RequireVoxels("Pilot photons are gathered");
  return this->Inside->Pilots->Gather(photons, origins, cells, monitor);
}

const RoundsTraffic& PhotonMarcher::Traffic() const
{
  return this->Inside->Handed;
}
}
