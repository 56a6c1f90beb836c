#include "Photons/Scattering/PhotonScattering.h"

#include "Device/Defines.h"
#include "Device/HostMappedBuffer.h"
#include "Device/HostMemory.h"
#include "Device/Sizes.h"
#include "Photons/Marching/MarchLaunch.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
/// sigma_s and sigma_a times the voxel diagonal in the padded grid; 0 in the padding.
std::vector<float> OpticalOf(const MarchMedium& through, const Medium& medium)
{
  const std::array<int, 3>& size = medium.grid.size;
  std::vector<float> values(2 * through.PaddedCount(), 0.0f);
  const double diagonal = through.Diagonal();
  std::size_t voxel = 0;
  for (int z = 0; z < size[2]; ++z)
  {
    for (int y = 0; y < size[1]; ++y)
    {
      for (int x = 0; x < size[0]; ++x, ++voxel)
      {
        const std::size_t at = (static_cast<std::size_t>(z + 1) * (size[1] + 2) + y + 1) * (size[0] + 2) + x + 1;
        values[2 * at] = static_cast<float>(std::min(diagonal * medium.sigma_s.At(voxel, 0), 1e30));
        values[2 * at + 1] = static_cast<float>(std::min(diagonal * medium.sigma_a.At(voxel, 0), 1e30));
      }
    }
  }
  return values;
}
}

double ScatteringStepPart(const Field& ior, const std::array<int, 3>& size)
{
  constexpr double Seen = 0.5, Least = 0.1; // of the largest jump between neighbours, over the lesser n^2, by a step
  double jump = 0.0;
  const std::array<std::size_t, 3> stride = { 1, static_cast<std::size_t>(size[0]),
    static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) };
  const std::size_t voxels = ior.values ? stride[2] * static_cast<std::size_t>(size[2]) : 0;
  for (std::size_t i = 0; i < voxels; ++i)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      if (i / stride[a] % static_cast<std::size_t>(size[a]) + 1 < static_cast<std::size_t>(size[a]))
      {
        const double here = std::pow(ior.At(i, 0), 2), there = std::pow(ior.At(i + stride[a], 0), 2);
        jump = std::max(jump, std::abs(here - there) / std::min(here, there));
      }
    }
  }
  return std::clamp(Seen / std::max(jump, 1e-9), Least, 1.0);
}

PhotonScattering::PhotonScattering(const MarchMedium& through, const Medium& medium, double stepPart)
  : Through(through)
  , StepPart(stepPart)
  , Optical(through.device, OpticalOf(through, medium), "how voxels scatter")
  , Phase(through.device, medium)
{
}

namespace
{
constexpr int Block = 16; ///< number of photons that a work-item takes at a time

/// Indices of the photons, the keys of their random numbers.
std::vector<cl_ulong> StreamsOf(const PackedPhotons& packed)
{
  return { packed.numbers.begin(), packed.numbers.end() };
}
}

ScatteringRun::ScatteringRun(
  const PhotonScattering& in, PackedPhotons photons, const PhotonScattering::Settings& settings)
  : In(in)
  , Settings(settings)
  , Packed(std::move(photons))
  , Numbers(in.Through.settings.meanDirection ? 4 : 1)
  , Shares(ShareSums(in.Through, in.Through.PaddedCount(), Numbers, 1, 0))
  , Photons(in.Through.device, Packed.values, "photons")
  , Streams(in.Through.device, StreamsOf(Packed), "numbers of photons")
  , Sums(in.Through.device,
      in.Through.PaddedCount() * static_cast<std::size_t>(Numbers) * static_cast<std::size_t>(Shares.copies),
      "sums of the photons' light")
  , Kernel(this->MakeKernel())
{
  this->Sums.Fill(0);
  this->Found.entered = this->Packed.entered[0];
}

int ScatteringRun::Workers() const
{
  return this->Shares.atomics ? 0 : std::max(this->Shares.workers, 1);
}

cl::Kernel ScatteringRun::MakeKernel() const
{
  const MarchMedium& through = this->In.Through;
  const bool block = through.IsBlock();
  return through.device.Kernel(block ? "scatter_in_block" : "scatter_photons", kernel_source::ScatterPhotons,
    through.Options() + this->In.Phase.Options() + Define("CHANNELS", 1) + Define("DIRECTIONS", 1) +
      Define("ORDER", through.settings.order) + Define("REAL_WIDTH", 1) + Define("ATOMICS", this->Shares.atomics) +
      Define("WORKERS", this->Workers()) + Define("BLOCK", Block) + Define("GATHERS", this->Numbers > 1) +
      Define("BLOCKS", block));
}

std::vector<ScatteredOnItsWay> ScatteringRun::Start(const Monitor& monitor)
{
  const Buffer<ScatteredOnItsWay> none(this->In.Through.device, 0, "photons from other blocks");
  return this->Launch(none, this->Packed.Count(), false, monitor);
}

std::vector<ScatteredOnItsWay> ScatteringRun::Resume(
  const std::vector<ScatteredOnItsWay>& arrived, const Monitor& monitor)
{
  const Buffer<ScatteredOnItsWay> onDevice(this->In.Through.device, arrived, "photons from other blocks");
  return this->Launch(onDevice, arrived.size(), true, monitor);
}

Batches ScatteringRun::LaunchesOf(std::size_t photons) const
{
  Batches launches;
  launches.count = photons;
  launches.first = launches.whole = static_cast<std::size_t>(Block) * Count(std::max(this->Workers(), 1));
  launches.seconds = SecondsPerLaunch;
  launches.growth = 8.0;
  if (this->In.Through.IsBlock())
  {
    launches.most = std::max(MarchedBetweenBlocks, launches.whole);
  }
  return launches;
}

std::vector<ScatteredOnItsWay> ScatteringRun::Launch(
  const Buffer<ScatteredOnItsWay>& arrived, std::size_t all, bool resumes, const Monitor& monitor)
{
  std::vector<ScatteredOnItsWay> into;
  if (all == 0)
  {
    return into;
  }
  const MarchMedium& through = this->In.Through;
  MarchInfo info = through.Describe();
  info.stepSize *= static_cast<float>(this->In.StepPart);
  info.eventLimit = static_cast<int>(std::min(1e9, info.eventLimit / this->In.StepPart));
  const ScatterInfo how = { this->Settings.seed, this->Settings.mostScatterings };
  const cl_ulong stride = through.PaddedCount() * Count(this->Numbers);
  const Batches launches = this->LaunchesOf(all);
  const Buffer<ScatterEnd> ends(through.device, all, "ends of photons");
  GonePhotons<ScatteredOnItsWay> gone(through.device, through.IsBlock() ? std::min(all, launches.most) : 0);
  Buffer<cl_int> next(through.device, 1, "number of the next photon");
  InBatches(through.device, launches, monitor, [&](std::size_t first, std::size_t count) {
    next.Fill(0);
    gone.Empty();
    cl_uint argument = 9;
    SetFrom(this->Kernel, 0, info, how, through.sigma, through.coefficients, through.nodes, this->In.Optical,
      this->In.Phase.Values(), this->Photons, this->Streams);
    if (through.IsBlock())
    {
      SetFrom(this->Kernel, argument, arrived, gone.Room(), gone.Number(), cl_int(resumes));
      argument += 4;
    }
    SetFrom(this->Kernel, argument, ends, this->Sums, stride, next, cl_int(first), cl_int(count));
    const auto workers = static_cast<std::size_t>(this->Workers());
    through.Launch(
      this->Kernel, cl::NDRange(workers > 0 ? workers : count), workers > 0 ? cl::NDRange(1) : cl::NullRange);
    gone.AppendTo(into);
  });
  this->TakeEnds(ends.Read());
  return into;
}

ScatteredPhotons ScatteringRun::Finish()
{
  this->TakeLight();
  return std::move(this->Found);
}

/// Converts the sums to light.
void ScatteringRun::TakeLight()
{
  const MarchMedium& through = this->In.Through;
  Device& device = through.device;
  const Grid& grid = through.grid;
  const std::size_t voxels = grid.VoxelCount(), rows = voxels / static_cast<std::size_t>(grid.size[0]);
  const bool directions = this->Numbers > 1;
  std::vector<float>& fluence = this->Found.fluence = Zeros(voxels);
  std::vector<float>& flow = this->Found.flow = Zeros(directions ? 3 * voxels : 0);
  const HostMappedBuffer<float> toFluence(device, fluence.data(), fluence.size(), "fluence");
  const HostMappedBuffer<float> toDirection(device, flow.data(), flow.size(), "mean direction");
  const Buffer<float> none(device, 0, "what is not asked for");
  const Buffer<cl_long> taken(device, 2 * rows, "tallies");
  cl::Kernel finish = through.SumsKernel("finish_light", 1,
    Define("DIRECTIONS", directions) + Define("COUNTS", 0) + Define("COLOURS", 1) + Define("CARRIES", 1));
  With(finish, through.DescribeSums(this->Packed, this->Shares), through.sigmaA, through.sigmaS, this->Sums,
    cl_ulong(through.PaddedCount() * static_cast<std::size_t>(this->Numbers)), toFluence.Handle(), toDirection.Handle(),
    none, none, none, taken);
  through.Launch(finish, cl::NDRange(rows));
  toFluence.Fetch();
  toDirection.Fetch();
  const std::vector<cl_long> units = taken.Read();
  for (std::size_t row = 0; row < rows; ++row)
  {
    this->Found.absorbed += units[2 * row] * this->Packed.unit;
  }
  for (std::size_t i = 0; i < flow.size(); ++i)
  {
    flow[i] *= fluence[i / 3];
  }
}

/// Photons that continue elsewhere are not counted yet.
void ScatteringRun::TakeEnds(const std::vector<ScatterEnd>& ends)
{
  const double unit = this->Packed.unit;
  for (const ScatterEnd& end : ends)
  {
    if (end.face == Elsewhere)
    {
      continue;
    }
    this->Found.absorbed += unit * end.absorbedAtFirst;
    this->Found.exchanged += unit * end.exchanged;
    this->Found.scatterings += static_cast<std::uint64_t>(end.scatterings);
    if (end.face < StillGoing)
    {
      this->Found.escaped[end.face] += unit * end.power;
    }
    else
    {
      this->Found.leftOver += unit * end.power;
    }
  }
}
}
