#include "LatticeBoltzmann/Distributed/InterleavedInBlocks.h"

#include "Device/Clock.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/SharedMedium.h"
#include "LatticeBoltzmann/Interleaved/InterleavedLattice.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "LatticeBoltzmann/WhereLightIsLost.h"
#include "Light/LeftOut.h"
#include "Photons/Distributed/PhotonShares.h"

#include <algorithm>

namespace tyndall
{
InterleavedInBlocks::InterleavedInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Field& ior, const Illumination& illumination, const LatticeSettings& settings)
  : TheDevice(device)
  , Comm(communicator)
  , Partition(partition)
  , TheMedium(medium)
  , Index(ior)
  , Shining(illumination)
  , Settings(settings)
{
}

void InterleavedInBlocks::Begin(const PackedPhotons& packed, int channels)
{
  this->Comm.Collective(
    [&] { this->ToCome.emplace(packed, channels, this->Partition.whole, this->Partition.blocks[this->Comm.Rank()]); });
  Illumination lit = this->Shining;
  lit.uncollided = this->ToCome->Image();
  this->Scene.emplace(this->TheDevice, this->Comm, this->Partition, this->TheMedium, this->Index, lit, this->Settings);
  const LatticeScene ofKnown = this->Scene->OfKnown();
  this->Light.fluence.assign(ofKnown.medium.grid.VoxelCount() * static_cast<std::size_t>(ofKnown.channels), 0.0f);
  this->Light.image.fluence = { this->Light.fluence.data(), ofKnown.channels };
  for (int c = 0; c < ofKnown.channels; ++c)
  {
    Channel channel;
    channel.lattice =
      std::make_unique<ChannelInBlocks>(this->TheDevice, this->Comm, *this->Scene, this->Settings, this->Light, c);
    this->Comm.Collective([&] {
      if (const Lattice* lattice = channel.lattice->TheLattice())
      {
        const LatticeVoxels& voxels = channel.lattice->TheVoxels();
        channel.takes =
          PhotonChannelMap(*this->ToCome, ofKnown.shining.uncollided, this->Scene->Box().Known(0), ofKnown.channels, c);
        channel.scatters = lattice->Placed(
          ScattersOf(ofKnown.medium, c, channel.takes.fluence, voxels.begins), "how voxels scatter photons");
        channel.glows = lattice->Placed(voxels.source, "what voxels emit");
      }
    });
    this->Channels.push_back(std::move(channel));
  }
}

void InterleavedInBlocks::Step()
{
  const int steps = StepsOfTurn(this->Settings, this->Steps);
  for (Channel& channel : this->Channels)
  {
    channel.lattice->Step(steps);
  }
  this->Steps += steps;
}

/// On this rank. @param fluence  of all voxels that it steps
void InterleavedInBlocks::ShineBy(const Buffer<float>& fluence)
{
  for (Channel& channel : this->Channels)
  {
    if (Lattice* lattice = channel.lattice->TheLattice())
    {
      lattice->ShineBy(channel.scatters, channel.glows, fluence, this->ToCome->channels, channel.takes.from);
    }
  }
}

void InterleavedInBlocks::Take(const Buffer<float>& fluence)
{
  if (this->Settings.blockSize == 0)
  {
    this->Comm.Collective([&] { this->ShineBy(fluence); });
    return;
  }
  std::vector<float> values;
  std::vector<VoxelBox> stepped;
  this->Comm.Collective([&] {
    values = fluence.Size() > 0 ? fluence.Read() : values;
    for (int rank = 0; rank < this->Comm.Ranks(); ++rank)
    {
      stepped.push_back(this->Scene->Stepped(this->Settings, rank));
    }
  });
  values = ValuesInBox(this->Comm, this->Partition, stepped, values, this->ToCome->channels);
  this->Comm.Collective([&] {
    if (!values.empty())
    {
      this->ShineBy(Buffer<float>(this->TheDevice, values, "fluence of photons on their way"));
      this->TheDevice.Finish(); // the buffer goes
    }
  });
}

/// The light of photons that have all come to their ends, as the scene has it.
void InterleavedInBlocks::TakeAll(const PhotonLight& photons)
{
  const LatticeScene ofKnown = this->Scene->OfKnown();
  const auto all = static_cast<std::size_t>(ofKnown.channels), given = static_cast<std::size_t>(photons.light.channels);
  std::vector<float> own(this->Scene->Box().Count() * all);
  for (std::size_t c = 0; c < all; ++c)
  {
    const PhotonChannelMap& takes = this->Channels[c].takes;
    const std::size_t from = std::min(static_cast<std::size_t>(takes.from), given - 1);
    for (std::size_t i = 0; i < own.size() / all; ++i)
    {
      own[i * all + c] = static_cast<float>(takes.fluence * photons.light.fluence[i * given + from]);
    }
    for (std::size_t face = 0; face < 6 && IsFirstThatHas(this->Comm, this->Partition); ++face)
    {
      this->Light.image.escaped[face][c] = takes.power * photons.light.facePowerOut[face][from];
    }
  }
  const std::vector<float> known = this->Scene->around.Spread(own, ofKnown.channels);
  std::copy(known.begin(), known.end(), this->Light.fluence.begin()); // the image sees these
  const bool needs = OnAnyRank(this->Comm, this->Scene->has && NeedsFirstMoments(ofKnown.medium, this->Settings));
  if (OnAnyRank(this->Comm, !photons.meanDirection.empty()))
  {
    this->Directions = this->Scene->around.Spread(photons.meanDirection, 3);
    this->Light.image.meanDirection = { this->Directions.data(), 3 };
  }
  this->Comm.Collective([&] {
    if (needs)
    {
      this->Light.firstMoments = EstimatedFirstMoments(this->Light.image, ofKnown.medium, {});
    }
    if (this->Settings.netFlux)
    {
      this->Light.netFlux = NetFluxOf(this->Light.image, ofKnown.medium.grid, ofKnown.channels);
    }
    for (Channel& channel : this->Channels)
    {
      channel.scatters = Buffer<float>();
      channel.glows = Buffer<float>();
      channel.lattice->Shine();
    }
  });
}

LightField InterleavedInBlocks::Solve(
  PhotonMarcherInBlocks& marcher, const std::vector<Photon>& share, const Monitor& monitor)
{
  TurnsInBlocks turns;
  turns.stretches = this->Settings.stretches;
  turns.begin = [this](const PackedPhotons& packed, int channels) { this->Begin(packed, channels); };
  turns.meanwhile = [this] { this->Step(); };
  turns.take = [this](const Buffer<float>& fluence) { this->Take(fluence); };
  const double start = ClockSeconds();
  const PhotonLight found = marcher.MarchByTurns(share, turns, OfPart(monitor, 0.0, 0.3));
  this->TakeAll(found);
  const double marched = (ClockSeconds() - start) / static_cast<double>(this->Channels.size()); // rows add them up
  LightField light = BeginLight(this->Scene->Box().Count(), this->Scene->OfKnown().channels, this->Settings);
  double thickest = 0.0;
  for (std::size_t c = 0; c < this->Channels.size(); ++c)
  {
    ChannelInBlocks& channel = *this->Channels[c].lattice;
    const double all = static_cast<double>(this->Channels.size());
    channel.Settle({ this->Steps, marched }, OfPart(monitor, 0.3 + 0.7 * c / all, 0.3 + 0.7 * (c + 1) / all));
    channel.AddTo(light);
    thickest = std::max(thickest, channel.Thickest());
  }
  FinishLight(light, this->TheDevice, this->Comm, *this->Scene, this->Shining, this->Settings, thickest);
  DoubtPhotons(found, PlaceAmong(this->Comm, share.size()).all, light);
  if (this->Settings.sideBySide)
  {
    light.leftOut.emplace_back(left_out::NotSideBySide);
  }
  return light;
}
}
