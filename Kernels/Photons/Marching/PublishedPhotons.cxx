#include "Photons/Marching/PublishedPhotons.h"

#include "Device/Defines.h"
#include "Photons/Marching/PublishedPhotonsShared.h"

#include "Photons/Marching/PhotonPacking.h"
#include "TyndallKernelSources.h"

#include "Device/Buffer.h"
#include "Device/Clock.h"
#include "Refraction/Index/IndexRange.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
constexpr int RoundsAtMost = 64;
constexpr std::size_t PhotonsPerLaunch = 1 << 16;

class PublishedMarch
{
public:
  PublishedMarch(Device& device, const Medium& medium, const PublishedSettings& settings, bool bends, bool levels)
    : TheDevice(device)
    , TheMedium(medium)
    , Voxels(medium.grid.VoxelCount())
    , Options(Define("BENDS", bends) + Define("LEVELS", levels) + Define("TRIES", settings.tries) +
        Define("A_CHANNELS", Components(medium.sigma_a)) + Define("S_CHANNELS", Components(medium.sigma_s)))
  {
    int edges = 0;
    for (int a = 0; a < 3; ++a)
    {
      this->Info.size[a] = medium.grid.size[a];
      this->Info.spacing[a] = static_cast<float>(medium.grid.spacing[a]);
      edges += medium.grid.size[a];
    }
    this->Info.stepLimit = RoundsAtMost * edges;
  }

  int DepositsAtMost() const { return this->Info.stepLimit; }

  cl::Kernel Kernel(const char* name)
  {
    return this->TheDevice.Kernel(name, kernel_source::PublishedPhotons, this->Options);
  }

  Buffer<cl_float4> Index(const Field& ior, bool bends)
  {
    Buffer<cl_float4> index(this->TheDevice, bends ? this->Voxels : 0, "index and gradient");
    if (bends)
    {
      const Buffer<float> n(this->TheDevice, ior.values, this->Voxels, "ior");
      cl::Kernel kernel = this->Kernel("published_index");
      With(kernel, this->Info, n, index);
      this->Launch(kernel, this->Range());
      this->TheDevice.Finish();
    }
    return index;
  }

  Buffer<float> Upload(const Field& field)
  {
    const std::size_t count = this->Voxels * static_cast<std::size_t>(Components(field));
    return count > 0 ? Buffer<float>(this->TheDevice, field.values, count, "a coefficient")
                     : Buffer<float>(this->TheDevice, 0, "a coefficient");
  }

  cl::NDRange Range() const
  {
    return { static_cast<std::size_t>(this->Info.size[0]), static_cast<std::size_t>(this->Info.size[1]),
      static_cast<std::size_t>(this->Info.size[2]) };
  }

  void Launch(const cl::Kernel& kernel, const cl::NDRange& range)
  {
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, range, cl::NullRange);
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

  /// W of all light in the voxels, by extinction where `extinguished`.
  Rgb Total(const std::vector<float>& fluence, bool scattered, bool extinguished) const
  {
    const Grid& grid = this->TheMedium.grid;
    const double volume = grid.spacing[0] * grid.spacing[1] * grid.spacing[2];
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

  static int Components(const Field& field) { return field.values ? field.components : 0; }

  PublishedMarchInfo Info = {};

private:
  Device& TheDevice;
  const Medium& TheMedium;
  std::size_t Voxels;
  std::string Options;
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
double UnitOf(const PackedPhotons& packed)
{
  const double mean =
    (packed.entered[0] + packed.entered[1] + packed.entered[2]) / (3.0 * std::max<std::size_t>(packed.Count(), 1));
  return mean > 0.0 ? std::exp2(std::round(std::log2(mean))) : 1.0;
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
  if (!device.HasExtension("cl_khr_int64_base_atomics"))
  {
    throw DeviceError(device.Name() +
      " has no 64-bit atomics (cl_khr_int64_base_atomics), which the published scheme needs. "
      "Choose the conservative scheme, or another device.");
  }
  const bool bends = IndexVaries(ior, medium.grid);
  PublishedMarch march(device, medium, settings, bends, levels != nullptr);
  PackedPhotons packed = Pack(photons, medium.grid, true, march.DepositsAtMost());
  const double unit = UnitOf(packed);
  for (std::size_t i = 0; i < packed.values.size(); ++i)
  {
    packed.values[i] *= i % 9 >= 6 ? static_cast<float>(packed.unit / unit) : 1.0f;
  }

  const Buffer<cl_float4> index = march.Index(ior, bends);
  const Buffer<float> sigma_a = march.Upload(medium.sigma_a), sigma_s = march.Upload(medium.sigma_s);
  const Buffer<cl_uchar> nodes = levels ? Buffer<cl_uchar>(device, levels, medium.grid.VoxelCount(), "octree levels")
                                        : Buffer<cl_uchar>(device, 0, "octree levels");
  const Buffer<float> values(device, packed.values, "photons");
  const Buffer<PublishedPhotonEnd> ends(device, packed.Count(), "ends of photons");
  Buffer<cl_ulong> light(device, medium.grid.VoxelCount(), "packed light");
  Buffer<float> fluence(device, 3 * medium.grid.VoxelCount(), "fluence");
  Buffer<float> direction(device, 3 * medium.grid.VoxelCount(), "mean direction");
  light.Fill(0);
  device.Finish();

  PhotonLight result;
  result.secondsMarching = -ClockSeconds();
  cl::Kernel kernel = march.Kernel("march_published");
  for (std::size_t first = 0; first < packed.Count(); first += PhotonsPerLaunch)
  {
    const std::size_t count = std::min(PhotonsPerLaunch, packed.Count() - first);
    With(kernel, march.Info, index, sigma_a, sigma_s, nodes, values, cl_int(first), ends, light);
    march.Launch(kernel, cl::NDRange(count));
    device.Finish();
    Report(monitor, static_cast<double>(first + count) / packed.Count());
  }
  const std::array<double, 3>& h = medium.grid.spacing;
  const double volume = h[0] * h[1] * h[2];
  cl::Kernel unpack = march.Kernel("unpack_light");
  With(unpack, static_cast<float>(unit * std::cbrt(volume) / volume), light, fluence, direction);
  march.Launch(unpack, cl::NDRange(medium.grid.VoxelCount()));
  device.Finish();
  result.secondsMarching += ClockSeconds();

  PackingLoss packing;
  packing.kept = march.Total(fluence.Read(), false, false);
  if (settings.smooth)
  {
    march.Smooth(fluence);
    march.Smooth(direction);
  }
  result.light.channels = 3;
  result.light.device = device.Name();
  result.light.fluence = fluence.Read();
  result.meanDirection = direction.Read();
  result.missed = packed.missed;
  result.light.balance.entered = packed.entered;
  result.light.balance.absorbed = march.Total(result.light.fluence, false, true);
  result.scattered = march.Total(result.light.fluence, true, true);
  result.light.leftOut = { "scattered light: fluence is what comes from the lights without being scattered" };
  Tally(ends.Read(), unit, result, packing);
  if (loss)
  {
    *loss = packing;
  }
  result.seconds = ClockSeconds() - start;
  return result;
}
}
