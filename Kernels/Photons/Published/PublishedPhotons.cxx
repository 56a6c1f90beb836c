#include "Photons/Published/PublishedPhotons.h"

#include "Device/Clock.h"
#include "Device/Errors.h"
#include "Device/Sizes.h"
#include "Distribution/BoxExchange.h"
#include "Distribution/Halo.h"
#include "Distribution/SharedMedium.h"
#include "Photons/Marching/MarchedLight.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Marching/PhotonPacking.h"
#include "Photons/Published/PublishedPhotonsShared.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

namespace tyndall
{
inline const int* WhereIs(const PublishedPhoton& photon)
{
  return photon.voxel;
}

namespace
{
constexpr int Tries = 10; ///< maximum number of compare-and-swap attempts for a deposit, which is lost if all fail

/// Maximum distance in voxels between successive deposits of a step. The next voxel is usually a neighbour. Where the
/// line runs along an edge of voxels, rounding may select the voxel behind this neighbour.
constexpr int VoxelsPassed = 2;

constexpr std::size_t PhotonsPerLaunch = 1 << 16;

/// Settings of the march with which photons are packed: always three power channels, and a step size of one voxel, from
/// which the maximum number of steps is computed.
MarchSettings PackingSettings()
{
  MarchSettings settings;
  settings.leaveOut = false;
  return settings;
}

/// Unit of power, W, of the published photon march: the mean power of a photon in a channel, rounded to a power of two.
/// In this unit, powers are far from the smallest and the largest exponent of RGBE, the format of the voxels' light.
/// @param entered  power of all photons by channel, W
/// @param photons  number of photons
double TypicalPower(const Rgb& entered, std::size_t photons)
{
  const double mean = Sum(entered) / (3.0 * static_cast<double>(std::max<std::size_t>(photons, 1)));
  return mean > 0.0 ? std::exp2(std::round(std::log2(mean))) : 1.0;
}

/// Converts packed photons to the format of the published photon march.
/// @param larger  ratio of the photons' new unit of power to packed.unit
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

/// Adds the final state of a photon to the energy balance, the face powers and the counts of all photons.
/// @param unit  the photons' unit of power (TypicalPower), W
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

/// Replaces this rank's losses by their sums over all ranks. Collective.
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

/// A rank's block of a medium on its device, and the light of photons marched through it by the published scheme.
class PublishedMarch
{
public:
  /// Width in voxels of the halo of the refractive index: one voxel for interpolation, one for the differences that
  /// give the gradient.
  static constexpr int Reach = 2;

  /// @param medium  coefficients in the block's voxels; referenced, not copied
  /// @param ior     refractive index in `part.known`, the block and a halo of Reach voxels; null: rays are straight
  /// @param levels  octree levels of the block's voxels, of the domain's octree; null: no octree
  /// @param stepLimit  maximum number of steps of a photon
  PublishedMarch(Device& device, const Medium& medium, const float* ior, const std::uint8_t* levels,
    const MarchedPart& part, int stepLimit)
    : TheDevice(device)
    , TheMedium(medium)
    , Voxels(medium.grid.VoxelCount())
    , Options(Define("BENDS", ior != nullptr) + Define("LEVELS", levels != nullptr) + Define("TRIES", Tries) +
        Define("A_CHANNELS", Components(medium.sigma_a)) + Define("S_CHANNELS", Components(medium.sigma_s)))
    , Info(Describe(part, stepLimit))
    , Index(this->FindIndex(ior, part))
    , SigmaA(this->Upload(medium.sigma_a))
    , SigmaS(this->Upload(medium.sigma_s))
    , Nodes(device, levels, levels ? this->Voxels : 0, "octree levels")
    , Packed(device, this->Voxels, "packed light")
  {
    this->Packed.Fill(0);
    device.Finish();
  }

  /// Marches photons to their ends or out of the block, and updates the state of each: position, power, exit face, and
  /// numbers of steps and deposits.
  /// @param photons  photons that start in the block or enter it
  /// @throws Aborted
  void March(std::vector<PublishedPhoton>& photons, const Monitor& monitor)
  {
    cl::Kernel march = this->Kernel("march_published");
    for (std::size_t first = 0; first < photons.size(); first += PhotonsPerLaunch)
    {
      const std::size_t count = std::min(PhotonsPerLaunch, photons.size() - first);
      const Buffer<PublishedPhoton> some(this->TheDevice, photons.data() + first, count, "photons");
      With(march, this->Info, this->Index, this->SigmaA, this->SigmaS, this->Nodes, some, this->Packed);
      this->Launch(march, cl::NDRange(count));
      some.Read(photons.data() + first, count);
      Report(monitor, static_cast<double>(first + count) / static_cast<double>(photons.size()));
    }
  }

  /// Unpacks fluence and mean direction into `result`, three values per voxel.
  /// @param unit  the photons' unit of power (TypicalPower), W
  void Unpack(double unit, PhotonLight& result)
  {
    const double volume = this->TheMedium.grid.VoxelVolume();
    const Buffer<float> fluence(this->TheDevice, 3 * this->Voxels, "fluence");
    const Buffer<float> direction(this->TheDevice, 3 * this->Voxels, "mean direction");
    cl::Kernel unpack = this->Kernel("unpack_light");
    With(unpack, static_cast<float>(unit * std::cbrt(volume) / volume), this->Packed, fluence, direction);
    this->Launch(unpack, cl::NDRange(this->Voxels));
    result.light.fluence = fluence.Read();
    result.meanDirection = direction.Read();
  }

  /// Applies the 3x3x3 Gaussian filter of the published scheme to values in a box, 3 per voxel; beyond the box, the
  /// value of the nearest voxel is used.
  std::vector<float> Smoothed(const VoxelBox& box, const std::vector<float>& values)
  {
    Buffer<float> from(this->TheDevice, values, "light"), to(this->TheDevice, values.size(), "smoothed light");
    cl::Kernel kernel = this->Kernel("smooth_along");
    for (int axis = 0; axis < 3; ++axis)
    {
      With(kernel, cl_int(axis), SizeForKernels(box.size), from, to);
      this->Launch(kernel, RangeOf(box.size));
      from.Swap(to);
    }
    return from.Read();
  }

private:
  static int Components(const Field& field) { return field.values ? field.components : 0; }
  static IndexGrid SizeForKernels(const std::array<int, 3>& size) { return { { size[0], size[1], size[2] } }; }
  static cl::NDRange RangeOf(const std::array<int, 3>& size)
  {
    return { Count(size[0]), Count(size[1]), Count(size[2]) };
  }

  static PublishedMarchInfo Describe(const MarchedPart& part, int stepLimit)
  {
    PublishedMarchInfo info = {};
    info.whole = SizeForKernels(part.whole.size);
    info.own = SizeForKernels(part.own.size);
    info.known = SizeForKernels(part.known.size);
    for (int a = 0; a < 3; ++a)
    {
      info.first[a] = part.own.first[a];
      info.knownFirst[a] = part.known.first[a];
      info.spacing[a] = static_cast<float>(part.whole.spacing[a]);
    }
    info.stepLimit = stepLimit;
    return info;
  }

  cl::Kernel Kernel(const char* name)
  {
    return this->TheDevice.Kernel(name, kernel_source::PublishedPhotons, this->Options);
  }

  void Launch(const cl::Kernel& kernel, const cl::NDRange& range)
  {
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, range, cl::NullRange);
  }

  Buffer<float> Upload(const Field& field)
  {
    return { this->TheDevice, field.values, this->Voxels * Count(Components(field)), "a coefficient" };
  }

  Buffer<cl_float4> FindIndex(const float* ior, const MarchedPart& part)
  {
    const std::size_t known = ior ? part.known.VoxelCount() : 0;
    Buffer<cl_float4> index(this->TheDevice, known, "index and gradient");
    if (known > 0)
    {
      const Buffer<float> n(this->TheDevice, ior, known, "ior");
      cl::Kernel kernel = this->Kernel("published_index");
      With(kernel, this->Info, n, index);
      this->Launch(kernel, RangeOf(part.known.size));
      this->TheDevice.Finish(); // the kernel must have read the buffer n before the destructor releases it
    }
    return index;
  }

  Device& TheDevice;
  const Medium& TheMedium;
  const std::size_t Voxels;
  const std::string Options;
  const PublishedMarchInfo Info;
  /// The index n and its gradient in the voxels of the region `known` (the block and a halo); empty if rays are
  /// straight.
  Buffer<cl_float4> Index;
  Buffer<float> SigmaA, SigmaS;
  Buffer<cl_uchar> Nodes;
  Buffer<cl_ulong> Packed; ///< light of each voxel, packed into 64 bits
};

/// Marches this rank's photons through its block of the domain by the published scheme.
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
      if (!this->TheDevice.HasExtension("cl_khr_int64_base_atomics"))
      {
        throw DeviceError(this->TheDevice.Name() +
          " has no 64-bit atomics (cl_khr_int64_base_atomics), which the published scheme needs. "
          "Choose the conservative scheme, or another device.");
      }
    });
    RequireSameMedium(this->TheDomain, this->TheMedium, ior);
    RequireSame(this->TheDomain.Comm(), "settings", true, { this->Settings.smooth ? 1.0 : 0.0 });
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
            MarchEventLimit(this->TheDomain.Whole(), PackingSettings()));
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

  /// Follows photons to their ends. Collective. @param unit  the photons' unit of power (TypicalPower), W
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

  /// Unpacks the light of the block into `result`, without the Gaussian filter, and stores the power that it contains,
  /// summed over the block's voxels, in loss.kept. Collective.
  void Gain(double unit, PhotonLight& result, PackingLoss& loss)
  {
    this->TheDomain.Collective([&] {
      if (this->Through)
      {
        this->Through->Unpack(unit, result);
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

  /// Sum over the block's voxels of the fluence of each channel times a weight.
  /// @param weight  function of voxel and channel
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
  std::unique_ptr<PublishedMarch> Through; ///< medium and light of the block; null if the rank has no voxels
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
