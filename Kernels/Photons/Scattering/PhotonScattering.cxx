#include "Photons/Scattering/PhotonScattering.h"

#include "Device/Batches.h"
#include "Device/Defines.h"
#include "Device/HostMappedBuffer.h"
#include "Device/HostMemory.h"
#include "Photons/Marching/MarchLaunch.h"
#include "Photons/Scattering/ScatterShared.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int Block = 16; ///< photons that a work-item takes one after the other
constexpr double SecondsPerLaunch = 0.1;

/// Scattering and absorption over a diagonal, of the padded grid; 0 in the padding.
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

/// Steps across a jump of n^2 that are too long lose photons in the denser side: of the largest jump between
/// neighbours, over the lesser n^2, a step is to see half (numerics.md, Eq. (99d)).
double StepPartFor(const Field& ior, const Grid& grid)
{
  constexpr double Seen = 0.5, Least = 0.1;
  double jump = 0.0;
  const std::array<std::size_t, 3> stride = { 1, static_cast<std::size_t>(grid.size[0]),
    static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1]) };
  for (std::size_t i = 0; i < grid.VoxelCount() && ior.values; ++i)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      if (i / stride[a] % static_cast<std::size_t>(grid.size[a]) + 1 < static_cast<std::size_t>(grid.size[a]))
      {
        const double here = std::pow(ior.At(i, 0), 2), there = std::pow(ior.At(i + stride[a], 0), 2);
        jump = std::max(jump, std::abs(here - there) / std::min(here, there));
      }
    }
  }
  return std::clamp(Seen / std::max(jump, 1e-9), Least, 1.0);
}
}

/// What a run holds.
struct PhotonScattering::Work
{
  Settings settings;
  PackedPhotons packed;
  MarchShares shares;
  int numbers = 1; ///< of a record of the sums
  Buffer<float> photons;
  Buffer<cl_ulong> streams;
  Buffer<ScatterEnd> ends;
  Buffer<cl_long> sums;
  ScatteredPhotons found;
};

PhotonScattering::PhotonScattering(const MarchMedium& through, const Medium& medium, const Field& ior)
  : Through(through)
  , StepPart(StepPartFor(ior, medium.grid))
  , Optical(through.device, OpticalOf(through, medium), "how voxels scatter")
  , Phase(through.device, medium)
{
}

ScatteredPhotons PhotonScattering::Follow(PackedPhotons photons, const Settings& settings, const Monitor& monitor)
{
  Device& device = this->Through.device;
  Work work;
  work.settings = settings;
  work.packed = std::move(photons);
  work.numbers = this->Through.settings.meanDirection ? 4 : 1;
  const std::size_t records = this->Through.PaddedCount();
  work.shares = ShareSums(this->Through, records, work.numbers, 1, 0);
  work.photons = Buffer<float>(device, work.packed.values, "photons");
  std::vector<cl_ulong> streams;
  for (const std::size_t number : work.packed.numbers)
  {
    streams.push_back(settings.numbers.empty() ? number : settings.numbers[number]);
  }
  work.streams = Buffer<cl_ulong>(device, streams, "numbers of photons");
  work.ends = Buffer<ScatterEnd>(device, work.packed.Count(), "ends of photons");
  work.sums = Buffer<cl_long>(device,
    records * static_cast<std::size_t>(work.numbers) * static_cast<std::size_t>(work.shares.copies),
    "sums of the photons' light");
  work.sums.Fill(0);
  work.found.entered = work.packed.entered[0];
  this->FollowAll(work, monitor);
  this->TakeLight(work);
  TakeEnds(work);
  return std::move(work.found);
}

void PhotonScattering::FollowAll(Work& work, const Monitor& monitor)
{
  Device& device = this->Through.device;
  const int workers = work.shares.atomics ? 0 : std::max(work.shares.workers, 1);
  cl::Kernel kernel = device.Kernel("scatter_photons", kernel_source::ScatterPhotons,
    this->Through.Options() + this->Phase.Options() + Define("CHANNELS", 1) + Define("DIRECTIONS", 1) +
      Define("ORDER", this->Through.settings.order) + Define("REAL_WIDTH", 1) + Define("ATOMICS", work.shares.atomics) +
      Define("WORKERS", workers) + Define("BLOCK", Block) + Define("GATHERS", work.numbers > 1));
  MarchInfo info = this->Through.Describe();
  info.stepSize *= static_cast<float>(this->StepPart);
  info.eventLimit = static_cast<int>(std::min(1e9, info.eventLimit / this->StepPart));
  const ScatterInfo how = { work.settings.seed, work.settings.mostScatterings };
  Buffer<cl_int> next(device, 1, "number of the next photon");
  Batches launches;
  launches.count = work.packed.Count();
  launches.first = launches.whole = static_cast<std::size_t>(Block) * static_cast<std::size_t>(std::max(workers, 1));
  launches.seconds = SecondsPerLaunch;
  launches.growth = 8.0;
  const std::size_t stride = this->Through.PaddedCount() * static_cast<std::size_t>(work.numbers);
  InBatches(device, launches, monitor, [&](std::size_t first, std::size_t count) {
    next.Fill(0);
    With(kernel, info, how, this->Through.sigma, this->Through.coefficients, this->Through.nodes, this->Optical,
      this->Phase.Values(), work.photons, work.streams, work.ends, work.sums, cl_ulong(stride), next, cl_int(first),
      cl_int(count));
    const std::size_t items = workers > 0 ? static_cast<std::size_t>(workers) : count;
    this->Through.Launch(kernel, cl::NDRange(items), workers > 0 ? cl::NDRange(1) : cl::NullRange);
  });
}

/// From the sums.
void PhotonScattering::TakeLight(Work& work)
{
  Device& device = this->Through.device;
  const Grid& grid = this->Through.grid;
  const std::size_t voxels = grid.VoxelCount(), rows = voxels / static_cast<std::size_t>(grid.size[0]);
  const bool directions = work.numbers > 1;
  std::vector<float>& fluence = work.found.fluence = Zeros(voxels);
  std::vector<float>& flow = work.found.flow = Zeros(directions ? 3 * voxels : 0);
  const HostMappedBuffer<float> toFluence(device, fluence.data(), fluence.size(), "fluence");
  const HostMappedBuffer<float> toDirection(device, flow.data(), flow.size(), "mean direction");
  const Buffer<float> none(device, 0, "what is not asked for");
  const Buffer<cl_long> taken(device, 2 * rows, "tallies");
  cl::Kernel finish = this->Through.SumsKernel("finish_light", 1,
    Define("DIRECTIONS", directions) + Define("COUNTS", 0) + Define("COUNT_SHIFT", 0) + Define("COLOURS", 1) +
      Define("COPIES", work.shares.copies) + Define("BATCHES", 1) + Define("CARRIES", 1));
  With(finish, this->Through.DescribeSums(work.packed), this->Through.sigmaA, this->Through.sigmaS, work.sums,
    cl_ulong(this->Through.PaddedCount() * static_cast<std::size_t>(work.numbers)), toFluence.Handle(),
    toDirection.Handle(), none, none, none, taken);
  this->Through.Launch(finish, cl::NDRange(rows));
  toFluence.Fetch();
  toDirection.Fetch();
  const std::vector<cl_long> units = taken.Read();
  for (std::size_t row = 0; row < rows; ++row)
  {
    work.found.absorbed += units[2 * row] * work.packed.unit;
  }
  for (std::size_t i = 0; i < flow.size(); ++i)
  {
    flow[i] *= fluence[i / 3];
  }
}

void PhotonScattering::TakeEnds(Work& work)
{
  const double unit = work.packed.unit;
  for (const ScatterEnd& end : work.ends.Read())
  {
    work.found.absorbed += unit * end.absorbedAtFirst;
    work.found.exchanged += unit * end.exchanged;
    work.found.scatterings += static_cast<std::uint64_t>(end.scatterings);
    if (end.face < StillGoing)
    {
      work.found.escaped[end.face] += unit * end.power;
    }
    else
    {
      work.found.leftOver += unit * end.power;
    }
  }
}
}
