#include "Photons/Published/PublishedPhotons.h"

#include "Device/Clock.h"
#include "Device/Errors.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/Halo.h"
#include "Distribution/SharedMedium.h"
#include "Photons/Marching/MarchedLight.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Marching/PhotonPacking.h"
#include "Photons/Published/PublishedMarch.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numeric>
#include <utility>

namespace tyndall
{
namespace
{
/// Maximum distance in voxels between successive deposits of a step: its line goes from voxel to voxel or, if it runs
/// along an edge, by rounding past one.
constexpr int VoxelsPassed = 2;

/// Settings for packing the photons: three channels, and a step limit as for steps of one voxel.
MarchSettings PackingSettings()
{
  MarchSettings settings;
  settings.leaveOut = false;
  return settings;
}

/// Power of a typical photon, W, rounded to a power of two: in this unit, colours are far from the limits of RGBe.
double TypicalPower(const Rgb& entered, std::size_t photons)
{
  const double mean = Sum(entered) / (3.0 * static_cast<double>(std::max<std::size_t>(photons, 1)));
  return mean > 0.0 ? std::exp2(std::round(std::log2(mean))) : 1.0;
}

/// Photons at their start.
/// @param larger  ratio of the new unit of power to the present one
std::vector<PublishedPhoton> PhotonsOf(const PackedPhotons& packed, double larger)
{
  std::vector<PublishedPhoton> photons(packed.Count());
  const float* value = packed.values.data();
  for (PublishedPhoton& photon : photons)
  {
    std::copy_n(value, 3, photon.from.position);
    std::copy_n(value + 3, 3, photon.from.velocity);
    for (int c = 0; c < 3; ++c)
    {
      photon.from.power[c] = value[6 + c] / static_cast<float>(larger);
    }
    value += packed.FloatsEach();
  }
  return photons;
}

void RequireAtomics(const Device& device)
{
  if (!device.HasExtension("cl_khr_int64_base_atomics"))
  {
    throw DeviceError(device.Name() +
      " has no 64-bit atomics (cl_khr_int64_base_atomics), which the published scheme needs. "
      "Choose the conservative scheme, or another device.");
  }
}

/// Adds the fate of an ended photon to the tallies.
void Tally(const PublishedPhoton& photon, double unit, PhotonLight& result, PackingLoss& loss)
{
  result.deposits += static_cast<std::size_t>(photon.deposits);
  result.steps += static_cast<std::size_t>(photon.steps);
  loss.deposits += static_cast<std::size_t>(photon.deposits);
  loss.givenUp += static_cast<std::size_t>(photon.givenUp);
  const bool left = photon.face < PublishedGivenUp;
  for (int c = 0; c < 3; ++c)
  {
    loss.deposited[c] += photon.deposited[c] * unit;
    const double power = photon.to.power[c] * unit;
    (left ? result.light.balance.escaped : result.light.balance.leftOver)[c] += power;
    if (left)
    {
      result.light.facePowerOut[photon.face][c] += power;
    }
  }
}

/// Sums the losses over all ranks.
void AddUp(const Domain& domain, PackingLoss& loss)
{
  std::vector<double> values(loss.deposited.begin(), loss.deposited.end());
  values.insert(values.end(), loss.kept.begin(), loss.kept.end());
  values.push_back(static_cast<double>(loss.deposits));
  values.push_back(static_cast<double>(loss.givenUp));
  values = domain.Sum(values);
  std::copy_n(values.begin(), 3, loss.deposited.begin());
  std::copy_n(values.begin() + 3, 3, loss.kept.begin());
  loss.deposits = static_cast<std::size_t>(values[6]);
  loss.givenUp = static_cast<std::size_t>(values[7]);
}

/// One rank's part of a march.
class PublishedOfBlock
{
public:
  PublishedOfBlock(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
    const std::uint8_t* levels, const PublishedSettings& settings)
    : TheDevice(device)
    , TheDomain(domain)
    , TheMedium(medium)
    , Settings(settings)
  {
    this->Check(ior, levels);
    this->Prepare(ior, levels);
  }

  PhotonLight March(const std::vector<Photon>& share, PackingLoss& loss, RoundsTraffic& traffic, const Monitor& monitor)
  {
    const double start = ClockSeconds();
    const StartingPhotons starting = this->Starting(share);
    const double unit =
      TypicalPower(starting.packed.entered, PlaceAmong(this->TheDomain.Comm(), starting.packed.Count()).all);
    PhotonLight result;
    result.light.channels = 3;
    result.light.device = this->TheDevice.Name();
    result.missed = starting.packed.missed;
    result.light.balance.entered = starting.packed.entered;
    result.light.leftOut = { "scattered light: fluence is what comes from the lights without being scattered" };
    const double marching = ClockSeconds();
    traffic = this->Follow(starting.packed, unit, result, loss, monitor);
    this->Gain(unit, result, loss);
    result.secondsMarching = ClockSeconds() - marching;
    this->Finish(result);
    AddUpTallies(this->TheDomain, result);
    AddUp(this->TheDomain, loss);
    result.seconds = ClockSeconds() - start;
    return result;
  }

private:
  void Check(const Field& ior, const std::uint8_t* levels) const
  {
    const bool octree = this->TheDomain.Any(levels != nullptr);
    this->TheDomain.Collective([&] {
      CheckMarchedMedium(this->TheDomain, this->TheMedium, ior, levels, octree);
      RequireAtomics(this->TheDevice);
    });
    RequireSameMedium(this->TheDomain, this->TheMedium, ior);
    RequireSame(
      this->TheDomain.Comm(), "settings", true, { 1.0 * this->Settings.tries, this->Settings.smooth ? 1.0 : 0.0 });
  }

  void Prepare(const Field& ior, const std::uint8_t* levels)
  {
    const IndexRange own = !this->TheDomain.IsEmpty() ? IndexRangeOf(ior, this->TheMedium.grid) : IndexRange();
    const bool bends = IndexRangeOfAll(this->TheDomain, own).Varies();
    const Halo around(this->TheDomain.Comm(), this->TheDomain.Partition(), {}, PublishedMarch::Reach);
    std::vector<float> index;
    this->TheDomain.Collective([&] {
      index.assign(bends ? this->TheDomain.Own().VoxelCount() : 0, 1.0f);
      if (ior.values)
      {
        std::copy_n(ior.values, index.size(), index.begin());
      }
    });
    index = bends ? around.Spread(index, 1) : std::vector<float>();
    this->TheDomain.Collective([&] {
      if (!this->TheDomain.IsEmpty())
      {
        this->Through =
          std::make_unique<PublishedMarch>(this->TheDevice, this->TheMedium, bends ? index.data() : nullptr, levels,
            MarchedPart{ this->TheDomain.Whole(), this->TheDomain.Own(), around.Known() },
            MarchEventLimit(this->TheDomain.Whole(), PackingSettings()), this->Settings.tries);
      }
    });
  }

  StartingPhotons Starting(const std::vector<Photon>& share)
  {
    PhotonNumbers numbers(share.size());
    std::iota(numbers.begin(), numbers.end(), PlaceAmong(this->TheDomain.Comm(), share.size()).first);
    return SendToTheirBlocks(this->TheDomain, share, numbers, true,
      MarchEventLimit(this->TheDomain.Whole(), PackingSettings()), PackingSettings());
  }

  /// Follows photons to their ends. @param unit  W of one unit of power during the march
  RoundsTraffic Follow(
    const PackedPhotons& packed, double unit, PhotonLight& result, PackingLoss& loss, const Monitor& monitor)
  {
    Rounds rounds(this->TheDomain.Comm(), this->TheDomain.Partition(), VoxelsPassed);
    rounds.UntilAllEnd<PublishedPhoton>(
      [&](int round, std::vector<PublishedPhoton>&& arrived, const Monitor& ofRound) {
        std::vector<PublishedPhoton> going = round == 0 ? PhotonsOf(packed, unit / packed.unit) : std::move(arrived);
        if (this->Through)
        {
          this->Through->March(going, ofRound);
        }
        const auto ended = std::stable_partition(
          going.begin(), going.end(), [](const PublishedPhoton& photon) { return photon.face == PublishedElsewhere; });
        std::for_each(ended, going.end(), [&](const PublishedPhoton& photon) { Tally(photon, unit, result, loss); });
        going.erase(ended, going.end());
        return going;
      },
      monitor);
    return rounds.Traffic();
  }

  /// Reads the light of the block, not smoothed, into `result`.
  void Gain(double unit, PhotonLight& result, PackingLoss& loss)
  {
    this->TheDomain.Collective([&] {
      if (this->Through)
      {
        PublishedMarch::Light light = this->Through->Unpack(unit);
        result.light.fluence = std::move(light.fluence);
        result.meanDirection = std::move(light.direction);
      }
    });
    const double volume = this->TheDomain.Whole().VoxelVolume();
    loss.kept = this->Total(result, [&](std::size_t, int) { return volume / std::cbrt(volume); });
  }

  void Finish(PhotonLight& result)
  {
    if (this->Settings.smooth)
    {
      const Halo around(this->TheDomain.Comm(), this->TheDomain.Partition(), {}, 1);
      this->Smooth(around, result.light.fluence);
      this->Smooth(around, result.meanDirection);
    }
    const double volume = this->TheDomain.Whole().VoxelVolume();
    const Field &a = this->TheMedium.sigma_a, &s = this->TheMedium.sigma_s;
    result.light.balance.absorbed =
      this->Total(result, [&](std::size_t voxel, int c) { return volume * (a.At(voxel, c) + s.At(voxel, c)); });
    result.scattered = this->Total(result, [&](std::size_t voxel, int c) { return volume * s.At(voxel, c); });
  }

  void Smooth(const Halo& around, std::vector<float>& values)
  {
    const std::vector<float> known = around.Spread(values, 3);
    this->TheDomain.Collective([&] {
      if (this->Through)
      {
        values = PartOf(this->Through->Smoothed(around.Known(), known), around.Known(), this->TheDomain.Own(), 3);
      }
    });
  }

  /// Weighted sum of the block's fluence. @param weight  weight of a voxel and channel
  template <class Weight>
  static Rgb Total(const PhotonLight& result, const Weight& weight)
  {
    Rgb sum = {};
    for (std::size_t i = 0; i < result.light.fluence.size(); ++i)
    {
      const int c = static_cast<int>(i % 3);
      sum[c] += result.light.fluence[i] * weight(i / 3, c);
    }
    return sum;
  }

  Device& TheDevice;
  const Domain& TheDomain;
  const Medium& TheMedium;
  const PublishedSettings& Settings;
  std::unique_ptr<PublishedMarch> Through; ///< null if the rank has no voxels
};
}

double PackingLoss::Relative() const
{
  const double in = Sum(this->deposited);
  return in > 0.0 ? 1.0 - Sum(this->kept) / in : 0.0;
}

PhotonLight MarchPublished(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const std::uint8_t* levels, const std::vector<Photon>& share, const PublishedSettings& settings, PackingLoss* loss,
  const Monitor& monitor, RoundsTraffic* traffic)
{
  PublishedOfBlock march(device, domain, medium, ior, levels, settings);
  PackingLoss packing;
  RoundsTraffic handed;
  PhotonLight result = march.March(share, packing, handed, monitor);
  if (loss)
  {
    *loss = packing;
  }
  if (traffic)
  {
    *traffic = handed;
  }
  return result;
}
}
