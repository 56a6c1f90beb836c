#include "Photons/Marching/PublishedPhotons.h"

#include "Device/Buffer.h"
#include "Device/Clock.h"
#include "Device/Defines.h"
#include "Photons/Marching/PhotonPacking.h"
#include "Photons/Marching/PublishedPhotonsShared.h"
#include "Refraction/Index/IndexRange.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
constexpr int RoundsAtMost = 64; ///< of a photon through the volume, in sums of its edges
constexpr std::size_t PhotonsPerLaunch = 1 << 16;

int Components(const Field& field)
{
  return field.values ? field.components : 0;
}

/// Steps of a photon at most, each of which deposits once.
int StepLimit(const Grid& grid)
{
  return RoundsAtMost * (grid.size[0] + grid.size[1] + grid.size[2]);
}

/// A medium on the device, and the light of the photons that were marched through it.
class PublishedMarch
{
public:
  PublishedMarch(Device& device, const Medium& medium, const Field& ior, const std::uint8_t* levels, int tries)
    : TheDevice(device)
    , TheMedium(medium)
    , Voxels(medium.grid.VoxelCount())
    , Bends(IndexVaries(ior, medium.grid))
    , Options(Define("BENDS", this->Bends) + Define("LEVELS", levels != nullptr) + Define("TRIES", tries) +
        Define("A_CHANNELS", Components(medium.sigma_a)) + Define("S_CHANNELS", Components(medium.sigma_s)))
    , Info(this->Describe())
    , Index(this->FindIndex(ior))
    , SigmaA(this->Upload(medium.sigma_a))
    , SigmaS(this->Upload(medium.sigma_s))
    , Nodes(levels ? Buffer<cl_uchar>(device, levels, this->Voxels, "octree levels")
                   : Buffer<cl_uchar>(device, 0, "octree levels"))
  {
  }

  /// @return seconds that it took, from photons on the device to light there
  double March(const PackedPhotons& packed, const Monitor& monitor)
  {
    const Buffer<float> values(this->TheDevice, packed.values, "photons");
    this->Ends = Buffer<PublishedPhotonEnd>(this->TheDevice, packed.Count(), "ends of photons");
    Buffer<cl_ulong> light(this->TheDevice, this->Voxels, "packed light");
    this->Fluence = Buffer<float>(this->TheDevice, 3 * this->Voxels, "fluence");
    this->Direction = Buffer<float>(this->TheDevice, 3 * this->Voxels, "mean direction");
    light.Fill(0);
    this->TheDevice.Finish();

    const double start = ClockSeconds();
    cl::Kernel march = this->Kernel("march_published");
    for (std::size_t first = 0; first < packed.Count(); first += PhotonsPerLaunch)
    {
      const std::size_t count = std::min(PhotonsPerLaunch, packed.Count() - first);
      With(march, this->Info, this->Index, this->SigmaA, this->SigmaS, this->Nodes, values, cl_int(first), this->Ends,
        light);
      this->Launch(march, cl::NDRange(count));
      this->TheDevice.Finish();
      Report(monitor, static_cast<double>(first + count) / packed.Count());
    }
    const double volume = this->TheMedium.grid.VoxelVolume();
    cl::Kernel unpack = this->Kernel("unpack_light");
    With(unpack, static_cast<float>(packed.unit * std::cbrt(volume) / volume), light, this->Fluence, this->Direction);
    this->Launch(unpack, cl::NDRange(this->Voxels));
    this->TheDevice.Finish();
    return ClockSeconds() - start;
  }

  void Smooth()
  {
    this->Smooth(this->Fluence);
    this->Smooth(this->Direction);
  }

  /// W of all light in the voxels, by extinction where `extinguished`.
  Rgb Total(const std::vector<float>& fluence, bool scattered, bool extinguished) const
  {
    const double volume = this->TheMedium.grid.VoxelVolume();
    Rgb sum = {};
    for (std::size_t i = 0; i < fluence.size(); ++i)
    {
      const int c = static_cast<int>(i % 3);
      const double a = scattered ? 0.0 : this->TheMedium.sigma_a.At(i / 3, c);
      sum[c] +=
        fluence[i] * (extinguished ? volume * (a + this->TheMedium.sigma_s.At(i / 3, c)) : volume / std::cbrt(volume));
    }
    return sum;
  }

  std::vector<float> ReadFluence() const { return this->Fluence.Read(); }
  std::vector<float> ReadDirection() const { return this->Direction.Read(); }
  std::vector<PublishedPhotonEnd> ReadEnds() const { return this->Ends.Read(); }

private:
  PublishedMarchInfo Describe() const
  {
    const Grid& grid = this->TheMedium.grid;
    PublishedMarchInfo info = {};
    for (int a = 0; a < 3; ++a)
    {
      info.size[a] = grid.size[a];
      info.spacing[a] = static_cast<float>(grid.spacing[a]);
    }
    info.stepLimit = StepLimit(grid);
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

  cl::NDRange Range() const
  {
    return { static_cast<std::size_t>(this->Info.size[0]), static_cast<std::size_t>(this->Info.size[1]),
      static_cast<std::size_t>(this->Info.size[2]) };
  }

  Buffer<float> Upload(const Field& field)
  {
    const std::size_t count = this->Voxels * static_cast<std::size_t>(Components(field));
    return count > 0 ? Buffer<float>(this->TheDevice, field.values, count, "a coefficient")
                     : Buffer<float>(this->TheDevice, 0, "a coefficient");
  }

  /// Index and gradient; empty where rays are straight.
  Buffer<cl_float4> FindIndex(const Field& ior)
  {
    Buffer<cl_float4> index(this->TheDevice, this->Bends ? this->Voxels : 0, "index and gradient");
    if (this->Bends)
    {
      const Buffer<float> n(this->TheDevice, ior.values, this->Voxels, "ior");
      cl::Kernel kernel = this->Kernel("published_index");
      With(kernel, this->Info, n, index);
      this->Launch(kernel, this->Range());
      this->TheDevice.Finish();
    }
    return index;
  }

  void Smooth(Buffer<float>& values)
  {
    Buffer<float> other(this->TheDevice, values.Size(), "smoothed light");
    cl::Kernel kernel = this->Kernel("smooth_along");
    for (int axis = 0; axis < 3; ++axis)
    {
      With(kernel, cl_int(axis), this->Info, values, other);
      this->Launch(kernel, this->Range());
      values.Swap(other);
    }
    this->TheDevice.Finish();
  }

  Device& TheDevice;
  const Medium& TheMedium;
  std::size_t Voxels;
  bool Bends;
  std::string Options;
  PublishedMarchInfo Info;
  Buffer<cl_float4> Index;
  Buffer<float> SigmaA, SigmaS;
  Buffer<cl_uchar> Nodes;
  Buffer<PublishedPhotonEnd> Ends;
  Buffer<float> Fluence, Direction; ///< 3 per voxel
};

void Tally(const std::vector<PublishedPhotonEnd>& ends, double unit, PhotonLight& result, PackingLoss& loss)
{
  for (const PublishedPhotonEnd& end : ends)
  {
    result.deposits += static_cast<std::size_t>(end.deposits);
    result.steps += static_cast<std::size_t>(end.steps);
    loss.deposits += static_cast<std::size_t>(end.deposits);
    loss.givenUp += static_cast<std::size_t>(end.givenUp);
    for (int c = 0; c < 3; ++c)
    {
      loss.deposited[c] += end.deposited[c] * unit;
      Rgb& goes = end.face < 6 ? result.light.balance.escaped : result.light.balance.leftOver;
      goes[c] += end.power[c] * unit;
      if (end.face < 6)
      {
        result.light.facePowerOut[end.face][c] += end.power[c] * unit;
      }
    }
  }
}

/// A typical photon's power, W, as a power of two: colours in units of it are far from the ends of what RGBe holds.
double TypicalPower(const PackedPhotons& packed)
{
  const double mean =
    (packed.entered[0] + packed.entered[1] + packed.entered[2]) / (3.0 * std::max<std::size_t>(packed.Count(), 1));
  return mean > 0.0 ? std::exp2(std::round(std::log2(mean))) : 1.0;
}

/// Photons of three channels each, in units of a typical one's power.
PackedPhotons PackInTypicalPowers(const std::vector<Photon>& photons, const Grid& grid)
{
  PackedPhotons packed = Pack(photons, grid, true, StepLimit(grid));
  const double unit = TypicalPower(packed);
  for (std::size_t i = 0; i < packed.values.size(); ++i)
  {
    packed.values[i] *= i % 9 >= 6 ? static_cast<float>(packed.unit / unit) : 1.0f;
  }
  packed.unit = unit;
  return packed;
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
}

double PackingLoss::Relative() const
{
  const double in = this->deposited[0] + this->deposited[1] + this->deposited[2];
  return in > 0.0 ? 1.0 - (this->kept[0] + this->kept[1] + this->kept[2]) / in : 0.0;
}

PhotonLight MarchPublished(Device& device, const Medium& medium, const Field& ior, const std::uint8_t* levels,
  const std::vector<Photon>& photons, const PublishedSettings& settings, PackingLoss* loss, const Monitor& monitor)
{
  const double start = ClockSeconds();
  Check(medium);
  CheckIndex(ior, medium.grid);
  CheckLevels(levels, medium.grid);
  RequireAtomics(device);
  const PackedPhotons packed = PackInTypicalPowers(photons, medium.grid);
  PublishedMarch march(device, medium, ior, levels, settings.tries);

  PhotonLight result;
  PackingLoss packing;
  result.secondsMarching = march.March(packed, monitor);
  packing.kept = march.Total(march.ReadFluence(), false, false);
  if (settings.smooth)
  {
    march.Smooth();
  }
  result.light.channels = 3;
  result.light.device = device.Name();
  result.light.fluence = march.ReadFluence();
  result.meanDirection = march.ReadDirection();
  result.missed = packed.missed;
  result.light.balance.entered = packed.entered;
  result.light.balance.absorbed = march.Total(result.light.fluence, false, true);
  result.scattered = march.Total(result.light.fluence, true, true);
  result.light.leftOut = { "scattered light: fluence is what comes from the lights without being scattered" };
  Tally(march.ReadEnds(), packed.unit, result, packing);
  if (loss)
  {
    *loss = packing;
  }
  result.seconds = ClockSeconds() - start;
  return result;
}
}
