#include "PhotonMarcher.h"

#include "../Device/Defines.h"
#include "Clock.h"
#include "IndexRange.h"
#include "PhotonPacking.h"
#include "TyndallKernelSources.h"

#include "../Device/Batches.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>

namespace tyndall
{
namespace
{
constexpr int RoundsAtMost = 64;     ///< of a photon through the volume, in sums of its edges
constexpr int Block = 512;           ///< neighbouring photons that one work-item takes one after the other
constexpr int PrivateSumsAtMost = 8; ///< beyond, adding up the copies costs more than atomics do
constexpr double SecondsPerLaunch = 0.1;
constexpr double EventsPerLaunch = 4e7; ///< of straight ways, which two cores follow in less
constexpr double FirstBent = 16384;     ///< photons on bent ways in the first launch
constexpr double ShortestStep = 0.05;   ///< voxels; below, rounding of positions counts
constexpr double LongestStep = 1e4;     ///< voxels
constexpr float DarkUnits = 1e-3f;      ///< power that no sum would show

// As index_grid, march_info, photon_end in the kernels.
struct GridOnDevice
{
  cl_int size[3];
};
struct MarchOnDevice
{
  GridOnDevice grid;
  cl_float spacing[3];
  cl_float stepSize, slowest, darkness;
  cl_int eventLimit;
  alignas(8) cl_ulong copy;
};
struct LightOnDevice
{
  GridOnDevice grid;
  cl_float diagonal, fluence, colour[3];
};
/// Its integers are followed by the power of each channel.
struct EndOnDevice
{
  cl_int face, crossings, steps;
};
constexpr int EndWords = 3;
constexpr int StillGoing = 6;

double DiagonalOf(const Grid& grid)
{
  return std::hypot(grid.spacing[0], grid.spacing[1], grid.spacing[2]);
}
}

void Check(const MarchSettings& settings)
{
  if (settings.order != 1 && settings.order != 2 && settings.order != 4)
  {
    throw InvalidInput("The integrator's order is " + std::to_string(settings.order) + "; there are 1, 2 and 4.");
  }
  if (!(settings.stepSize >= ShortestStep && settings.stepSize <= LongestStep))
  {
    throw InvalidInput("The step size is " + std::to_string(settings.stepSize) + " voxels; it must be " +
      std::to_string(ShortestStep) + " to " + std::to_string(LongestStep) + ".");
  }
}

class PhotonMarcher::Implementation
{
public:
  Implementation(
    Device& device, const Medium& medium, const Field& ior, const MarchSettings& settings, const std::uint8_t* levels)
    : TheDevice(device)
    , TheGrid(medium.grid)
    , Settings(settings)
    , MediumChannels(medium.sigma_a.components == 3 || medium.sigma_s.components == 3 ? 3 : 1)
    , Index(IndexRangeOf(ior, medium.grid))
    , Bends(this->Index.Varies())
    , HasLevels(levels && this->Bends)
    , AComponents(medium.sigma_a.values ? medium.sigma_a.components : 0)
    , SComponents(medium.sigma_s.values ? medium.sigma_s.components : 0)
    , Emits(medium.emission.values != nullptr)
  {
    this->SigmaA = this->Upload(medium.sigma_a.values, this->AComponents, "sigma_a");
    this->SigmaS = this->Upload(medium.sigma_s.values, this->SComponents, "sigma_s");
    this->PrepareMedium(ior, levels);
    this->ChooseWorkers();
  }

  PhotonLight March(const std::vector<Photon>& photons, const Monitor& monitor);
  std::vector<PhotonPath> Paths(const std::vector<Photon>& photons, const std::vector<std::size_t>& chosen);

private:
  Buffer<float> Upload(const float* values, int components, const char* what)
  {
    const std::size_t count = this->TheGrid.VoxelCount() * static_cast<std::size_t>(components);
    return count > 0 ? Buffer<float>(this->TheDevice, values, count, what) : Buffer<float>(this->TheDevice, 0, what);
  }

  std::array<std::size_t, 3> Padded(int by) const
  {
    std::array<std::size_t, 3> size;
    for (int a = 0; a < 3; ++a)
    {
      size[a] = static_cast<std::size_t>(this->TheGrid.size[a] + by);
    }
    return size;
  }
  static std::size_t Count(const std::array<std::size_t, 3>& size) { return size[0] * size[1] * size[2]; }
  static cl::NDRange Range(const std::array<std::size_t, 3>& size) { return { size[0], size[1], size[2] }; }

  GridOnDevice DescribeGrid() const
  {
    return { { this->TheGrid.size[0], this->TheGrid.size[1], this->TheGrid.size[2] } };
  }

  void Launch(const cl::Kernel& kernel, const cl::NDRange& range, const cl::NDRange& local = cl::NullRange)
  {
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, range, local);
  }

  void PrepareMedium(const Field& ior, const std::uint8_t* levels);
  void FindRanges(Buffer<float>& low, Buffer<float>& high);
  void ChooseWorkers();
  int Workers(int record);
  int EventLimit() const;
  MarchOnDevice Describe() const;
  void PrepareSums(int record);

  std::string MediumOptions(int channels) const
  {
    return Define("CHANNELS", channels) + Define("MEDIUM_CHANNELS", this->MediumChannels) +
      Define("DIRECTIONS", this->Settings.meanDirection) + Define("BENDS", this->Bends) +
      Define("ORDER", this->Settings.order) + Define("LEVELS", this->HasLevels) + " -cl-mad-enable";
  }
  std::string FinishOptions(int channels, int colours, int workers) const
  {
    return this->MediumOptions(channels) + Define("COLOURS", colours) + Define("WORKERS", workers) +
      Define("A_CHANNELS", this->AComponents) + Define("S_CHANNELS", this->SComponents);
  }
  cl::Kernel SumsKernel(const char* name, const std::string& options)
  {
    return this->TheDevice.Kernel(
      name, { kernel_source::Numerics, kernel_source::SquaredIndex, kernel_source::PhotonSums }, options);
  }
  cl::Kernel MarchKernel(const char* name, const std::string& options)
  {
    return this->TheDevice.Kernel(name,
      { kernel_source::Numerics, kernel_source::FixedPoint, kernel_source::SquaredIndex, kernel_source::PhotonLanes,
        kernel_source::PhotonLegs, kernel_source::PhotonMarch },
      options);
  }

  void MarchAll(
    const PackedPhotons& packed, const Buffer<float>& photons, const Buffer<cl_int>& ends, const Monitor& monitor);
  Batches BatchesOf(std::size_t photons) const;
  void Tally(const PackedPhotons& packed, const std::vector<cl_int>& ends, PhotonLight& result) const;
  void Finish(const PackedPhotons& packed, PhotonLight& result);
  void SayWhatIsLeftOut(const PackedPhotons& packed, LightField& light) const;
  std::vector<PhotonPath> Unpack(const PackedPhotons& packed, const std::vector<std::size_t>& chosen,
    const std::vector<cl_float4>& vertices, const std::vector<cl_int>& begin) const;

  std::size_t Copy() const { return Count(this->Padded(2)); }
  std::size_t RecordOf(const PackedPhotons& packed) const
  {
    return static_cast<std::size_t>(packed.channels + (this->Settings.meanDirection ? 3 : 0));
  }

  Device& TheDevice;
  Grid TheGrid;
  MarchSettings Settings;
  int MediumChannels;
  IndexRange Index;
  bool Bends;
  bool HasLevels;
  int AComponents, SComponents;
  bool Emits;
  bool Shared = false;
  Buffer<float> SigmaA, SigmaS;
  Buffer<float> Sigma;        ///< PhotonSums.cl, pack_extinction
  Buffer<float> Coefficients; ///< SquaredIndex.cl
  Buffer<cl_uchar> Nodes;     ///< PhotonSums.cl, pack_extinction
  Buffer<cl_long> Sums;       ///< zero between two runs
  int SumsWorkers = 0;
};

void PhotonMarcher::Implementation::FindRanges(Buffer<float>& low, Buffer<float>& high)
{
  const std::array<std::size_t, 3> size = this->Padded(4);
  Buffer<float> low2(this->TheDevice, Count(size), "range of the index");
  Buffer<float> high2(this->TheDevice, Count(size), "range of the index");
  cl::Kernel widen = this->SumsKernel("widen_range", this->FinishOptions(1, 1, 0));
  const int strides[3] = { 1, static_cast<int>(size[0]), static_cast<int>(size[0] * size[1]) };
  const Buffer<float>* from[2] = { &this->Coefficients, &this->Coefficients };
  for (int a = 0; a < 3; ++a)
  {
    Buffer<float>& toLow = a % 2 == 0 ? low : low2;
    Buffer<float>& toHigh = a % 2 == 0 ? high : high2;
    const std::size_t reach = 4 * static_cast<std::size_t>(strides[a]);
    With(widen, strides[a], *from[0], *from[1], toLow, toHigh);
    this->Launch(widen, Count(size) - reach);
    from[0] = &toLow;
    from[1] = &toHigh;
  }
  this->TheDevice.Finish();
}

void PhotonMarcher::Implementation::PrepareMedium(const Field& ior, const std::uint8_t* levels)
{
  Buffer<float> low(this->TheDevice, this->Bends ? Count(this->Padded(4)) : 0, "range of the index");
  Buffer<float> high(this->TheDevice, this->Bends ? Count(this->Padded(4)) : 0, "range of the index");
  this->Coefficients = Buffer<float>(this->TheDevice, this->Bends ? Count(this->Padded(4)) : 0, "squared index");
  if (this->Bends)
  {
    const Buffer<float> index = this->Upload(ior.values, 1, "ior");
    cl::Kernel coefficients = this->SumsKernel("squared_index_coefficients", this->FinishOptions(1, 1, 0));
    With(coefficients, this->DescribeGrid(), index, this->Coefficients);
    this->Launch(coefficients, Range(this->Padded(4)));
    this->FindRanges(low, high);
  }
  this->Sigma = Buffer<float>(
    this->TheDevice, Count(this->Padded(2)) * static_cast<std::size_t>(this->MediumChannels), "extinction");
  this->Nodes = Buffer<cl_uchar>(this->TheDevice, this->Bends ? this->Copy() : 0, "octree nodes");
  const Buffer<cl_uchar> given = this->HasLevels
    ? Buffer<cl_uchar>(this->TheDevice, levels, this->TheGrid.VoxelCount(), "octree levels")
    : Buffer<cl_uchar>(this->TheDevice, 0, "octree levels");
  cl::Kernel pack =
    this->SumsKernel("pack_extinction", this->FinishOptions(this->MediumChannels, this->MediumChannels, 0));
  With(pack, this->DescribeGrid(), static_cast<float>(DiagonalOf(this->TheGrid)), this->SigmaA, this->SigmaS, low, high,
    given, this->Sigma, this->Nodes);
  this->Launch(pack, Range(this->Padded(2)));
  this->TheDevice.Finish();
}

void PhotonMarcher::Implementation::ChooseWorkers()
{
  const bool atomics = this->TheDevice.HasExtension("cl_khr_int64_base_atomics");
  const bool few = this->TheDevice.IsCpu() && this->TheDevice.ComputeUnits() <= PrivateSumsAtMost;
  if (this->Settings.sums == MarchSettings::Sums::Shared && !atomics)
  {
    throw DeviceError(this->TheDevice.Name() +
      " has no 64-bit atomics (cl_khr_int64_base_atomics), which shared sums need. Choose private sums.");
  }
  this->Shared = this->Settings.sums == MarchSettings::Sums::Shared ||
    (this->Settings.sums == MarchSettings::Sums::Fitting && atomics && !few);
}

/// Work-items that have sums of their own; 0: all share them.
int PhotonMarcher::Implementation::Workers(int record)
{
  if (this->Shared)
  {
    return 0;
  }
  if (this->Settings.sums == MarchSettings::Sums::Unsafe)
  {
    return this->TheDevice.ComputeUnits();
  }
  const std::size_t bytes = Count(this->Padded(2)) * static_cast<std::size_t>(record) * sizeof(cl_long);
  const std::size_t held = this->Sums.Size() * sizeof(cl_long);
  const std::size_t free = this->TheDevice.MemoryLimit() - (this->TheDevice.BytesInUse() - held);
  const std::size_t fit = std::min(this->TheDevice.AllocationLimit(), free / 2) / bytes;
  return static_cast<int>(
    std::min(std::max<std::size_t>(fit, 1), static_cast<std::size_t>(this->TheDevice.ComputeUnits())));
}

int PhotonMarcher::Implementation::EventLimit() const
{
  const double edges = 1.0 * this->TheGrid.size[0] + this->TheGrid.size[1] + this->TheGrid.size[2];
  return static_cast<int>(std::min(1e9, RoundsAtMost * edges * std::max(1.0, 1.0 / this->Settings.stepSize)));
}

MarchOnDevice PhotonMarcher::Implementation::Describe() const
{
  MarchOnDevice info = {};
  info.grid = this->DescribeGrid();
  for (int a = 0; a < 3; ++a)
  {
    info.spacing[a] = static_cast<float>(this->TheGrid.spacing[a] / DiagonalOf(this->TheGrid));
  }
  info.stepSize = static_cast<float>(this->Settings.stepSize);
  info.slowest = 0.5f * this->Index.least / *std::max_element(info.spacing, info.spacing + 3);
  info.darkness = DarkUnits;
  info.eventLimit = this->EventLimit();
  info.copy = Count(this->Padded(2));
  return info;
}

void PhotonMarcher::Implementation::PrepareSums(int record)
{
  this->SumsWorkers = this->Workers(record);
  const bool many = this->SumsWorkers > 1 && this->Settings.sums != MarchSettings::Sums::Unsafe;
  const std::size_t needed =
    Count(this->Padded(2)) * static_cast<std::size_t>(record) * static_cast<std::size_t>(many ? this->SumsWorkers : 1);
  if (this->Sums.Size() != needed)
  {
    this->Sums = Buffer<cl_long>();
    this->Sums = Buffer<cl_long>(this->TheDevice, needed, "sums of the photons' light");
    this->Sums.Fill(0);
  }
}

void PhotonMarcher::Implementation::MarchAll(
  const PackedPhotons& packed, const Buffer<float>& photons, const Buffer<cl_int>& ends, const Monitor& monitor)
{
  const int width = this->TheDevice.IsCpu() ? std::min(std::max(this->TheDevice.FloatVectorWidth(), 4), 16) : 1;
  const int workers = this->SumsWorkers;
  const std::size_t record = this->RecordOf(packed);
  const std::size_t stride = this->Sums.Size() > this->Copy() * record ? this->Copy() * record : 0;
  cl::Kernel march = this->MarchKernel("march_photons",
    this->MediumOptions(packed.channels) + Define("REAL_WIDTH", width) + Define("ATOMICS", this->Shared) +
      Define("WORKERS", workers) + Define("BLOCK", Block) + Define("PATHS", 0));
  Buffer<cl_int> next(this->TheDevice, 1, "number of the next photon");
  InBatches(this->TheDevice, this->BatchesOf(packed.Count()), monitor, [&](std::size_t first, std::size_t count) {
    next.Fill(0);
    With(march, this->Describe(), this->Sigma, this->Coefficients, this->Nodes, photons, ends, this->Sums,
      cl_ulong(stride), next, cl_int(first), cl_int(count));
    if (workers > 0)
    {
      this->Launch(march, cl::NDRange(static_cast<std::size_t>(workers)), cl::NDRange(1));
    }
    else
    {
      this->Launch(march, cl::NDRange((count + width - 1) / width));
    }
  });
}

/// Straight ways cost what their voxels do; of bent ones the first tell. Few launches: at the end of each, work-items wait.
Batches PhotonMarcher::Implementation::BatchesOf(std::size_t photons) const
{
  const double edges = (this->TheGrid.size[0] + this->TheGrid.size[1] + this->TheGrid.size[2]) / 3.0;
  const double straight = EventsPerLaunch / edges;
  Batches batches;
  batches.count = photons;
  batches.whole = static_cast<std::size_t>(Block) * std::max(this->SumsWorkers, 1);
  batches.first = static_cast<std::size_t>(
    this->Bends ? std::min(straight, FirstBent * std::min(this->Settings.stepSize, 1.0)) : straight);
  batches.seconds = SecondsPerLaunch;
  batches.growth = 8.0;
  return batches;
}

void PhotonMarcher::Implementation::Tally(
  const PackedPhotons& packed, const std::vector<cl_int>& ends, PhotonLight& result) const
{
  EnergyBalance& balance = result.light.balance;
  const std::size_t words = EndWords + static_cast<std::size_t>(packed.channels);
  for (std::size_t i = 0; i < packed.Count(); ++i)
  {
    EndOnDevice end;
    std::memcpy(&end, ends.data() + i * words, sizeof(end));
    result.credits += static_cast<std::size_t>(end.crossings);
    result.steps += static_cast<std::size_t>(end.steps);
    for (int c = 0; c < packed.channels; ++c)
    {
      cl_float units;
      std::memcpy(&units, ends.data() + i * words + EndWords + c, sizeof(units));
      if (end.face < StillGoing)
      {
        result.light.facePowerOut[end.face][c] += units * packed.unit;
        balance.escaped[c] += units * packed.unit;
      }
      else
      {
        balance.leftOver[c] += units * packed.unit; // almost nothing of those that are dark
      }
    }
  }
}

void PhotonMarcher::Implementation::Finish(const PackedPhotons& packed, PhotonLight& result)
{
  LightField& light = result.light;
  const Grid& grid = this->TheGrid;
  const bool many = this->Sums.Size() > this->Copy() * this->RecordOf(packed);
  const std::size_t rows = static_cast<std::size_t>(grid.size[1]) * static_cast<std::size_t>(grid.size[2]);
  const double volume = grid.spacing[0] * grid.spacing[1] * grid.spacing[2];
  Buffer<float> fluence(this->TheDevice, grid.VoxelCount() * static_cast<std::size_t>(light.channels), "fluence");
  Buffer<float> direction(this->TheDevice, this->Settings.meanDirection ? 3 * grid.VoxelCount() : 0, "mean direction");
  Buffer<cl_long> taken(this->TheDevice, rows * 2 * static_cast<std::size_t>(packed.channels), "tallies");

  LightOnDevice info = {};
  info.grid = this->DescribeGrid();
  info.diagonal = static_cast<float>(DiagonalOf(grid));
  info.fluence = static_cast<float>(packed.unit * DiagonalOf(grid) / volume);
  std::copy(packed.colour.begin(), packed.colour.end(), info.colour);
  cl::Kernel finish = this->SumsKernel(
    "finish_light", this->FinishOptions(packed.channels, light.channels, many ? this->SumsWorkers : 1));
  With(finish, info, this->SigmaA, this->SigmaS, this->Sigma, this->Sums,
    cl_ulong(this->Copy() * this->RecordOf(packed)), fluence, direction, taken);
  this->Launch(finish, cl::NDRange(rows));
  this->TheDevice.Finish();
  result.secondsMarching += ClockSeconds();

  light.fluence = fluence.Read();
  result.meanDirection = direction.Read();
  const std::vector<cl_long> units = taken.Read();
  const std::size_t channels = static_cast<std::size_t>(packed.channels);
  for (std::size_t i = 0; i < units.size(); ++i)
  {
    const double watts = units[i] * packed.unit;
    light.balance.absorbed[i % channels] += watts;
    result.scattered[i % channels] += i / channels % 2 == 1 ? watts : 0.0;
  }
}

/// Tallies of the one channel, for the three that it stands for.
void Colour(const Rgb& colour, PhotonLight& result)
{
  EnergyBalance& balance = result.light.balance;
  const auto spread = [&](Rgb& watts) { watts = { watts[0] * colour[0], watts[0] * colour[1], watts[0] * colour[2] }; };
  for (Rgb* watts : { &balance.entered, &balance.absorbed, &balance.escaped, &balance.leftOver, &result.scattered })
  {
    spread(*watts);
  }
  std::for_each(result.light.facePowerOut.begin(), result.light.facePowerOut.end(), spread);
}

void PhotonMarcher::Implementation::SayWhatIsLeftOut(const PackedPhotons& packed, LightField& light) const
{
  const auto say = [&](bool condition, const char* text) {
    if (condition)
    {
      light.leftOut.push_back(text);
    }
  };
  say(true, "scattered light: fluence is what comes from the lights without being scattered");
  say(this->Emits, "emission: photons carry the light of lights only");
  say(!this->Bends, "refraction: the index is constant");
  say(this->Bends && !this->HasLevels, "octree: none was given, paths go by steps of the same length");
  say(packed.channels == 1, "colours: one channel stands for all");
  say(packed.channels == 3 && this->MediumChannels == 1, "coloured extinction: the medium is grey");
  say(!this->Settings.meanDirection, "mean direction: it was not asked for");
}

PhotonLight PhotonMarcher::Implementation::March(const std::vector<Photon>& photons, const Monitor& monitor)
{
  const double start = ClockSeconds();
  const PackedPhotons packed = Pack(photons, this->TheGrid, this->MediumChannels == 3, this->EventLimit());
  PhotonLight result;
  result.missed = packed.missed;
  result.light.channels = packed.channels == 1 && packed.colour == Rgb{ 1.0, 1.0, 1.0 } ? 1 : 3;
  result.light.device = this->TheDevice.Name();
  result.light.balance.entered = packed.entered;
  this->PrepareSums(static_cast<int>(this->RecordOf(packed)));

  const std::size_t words = EndWords + static_cast<std::size_t>(packed.channels);
  const Buffer<float> values(this->TheDevice, packed.values, "photons");
  const Buffer<cl_int> ends(this->TheDevice, packed.Count() * words, "ends of photons");
  result.secondsMarching = -ClockSeconds();
  try
  {
    this->MarchAll(packed, values, ends, monitor);
  }
  catch (...)
  {
    this->Sums = Buffer<cl_long>(); // they are not zero
    throw;
  }
  this->Finish(packed, result);
  this->Tally(packed, ends.Read(), result);
  if (packed.channels == 1 && result.light.channels == 3)
  {
    Colour(packed.colour, result);
  }
  this->SayWhatIsLeftOut(packed, result.light);
  result.light.fluenceDirect = result.light.fluence;
  result.seconds = ClockSeconds() - start;
  return result;
}

std::vector<PhotonPath> PhotonMarcher::Implementation::Paths(
  const std::vector<Photon>& photons, const std::vector<std::size_t>& chosen)
{
  std::vector<Photon> some;
  for (const std::size_t i : chosen)
  {
    some.push_back(photons.at(i));
  }
  const PackedPhotons packed = Pack(some, this->TheGrid, true, this->EventLimit());
  if (packed.Count() == 0)
  {
    return {};
  }
  cl::Kernel trace = this->MarchKernel("trace_paths",
    this->MediumOptions(3) + Define("REAL_WIDTH", 1) + Define("ATOMICS", 0) + Define("WORKERS", 0) +
      Define("PATHS", 1));
  const Buffer<float> values(this->TheDevice, packed.values, "photons");
  const Buffer<cl_int> ends(this->TheDevice, packed.Count() * (EndWords + 3), "ends of photons");
  Buffer<cl_int> offsets(this->TheDevice, packed.Count(), "offsets of paths");
  const Buffer<cl_int> counts(this->TheDevice, packed.Count(), "lengths of paths");
  const auto run = [&](bool counting, const Buffer<cl_float4>& vertices) {
    With(trace, this->Describe(), this->Sigma, this->Coefficients, this->Nodes, values, ends, cl_int(counting), offsets,
      vertices, counts);
    this->Launch(trace, cl::NDRange(packed.Count()), cl::NDRange(1));
    this->TheDevice.Finish();
  };
  run(true, Buffer<cl_float4>(this->TheDevice, 0, "paths"));
  const std::vector<cl_int> lengths = counts.Read();
  std::vector<cl_int> begin(lengths.size() + 1, 0);
  std::partial_sum(lengths.begin(), lengths.end(), begin.begin() + 1);
  offsets.Write(begin.data());
  const Buffer<cl_float4> vertices(this->TheDevice, static_cast<std::size_t>(begin.back()), "paths");
  run(false, vertices);
  return this->Unpack(packed, chosen, vertices.Read(), begin);
}

std::vector<PhotonPath> PhotonMarcher::Implementation::Unpack(const PackedPhotons& packed,
  const std::vector<std::size_t>& chosen, const std::vector<cl_float4>& vertices,
  const std::vector<cl_int>& begin) const
{
  std::vector<PhotonPath> paths(packed.Count());
  for (std::size_t i = 0; i < paths.size(); ++i)
  {
    paths[i].photon = chosen[packed.numbers[i]];
    for (cl_int v = begin[i]; v < begin[i + 1]; ++v)
    {
      std::array<double, 3> point;
      for (int a = 0; a < 3; ++a)
      {
        point[a] = this->TheGrid.origin[a] + vertices[v].s[a] * this->TheGrid.spacing[a];
      }
      paths[i].points.push_back(point);
      paths[i].left.push_back(vertices[v].s[3]);
    }
  }
  std::sort(paths.begin(), paths.end(), [](const PhotonPath& a, const PhotonPath& b) { return a.photon < b.photon; });
  return paths;
}

PhotonMarcher::PhotonMarcher(
  Device& device, const Medium& medium, const Field& ior, const MarchSettings& settings, const std::uint8_t* levels)
{
  tyndall::Check(medium);
  tyndall::Check(settings);
  CheckIndex(ior, medium.grid);
  CheckLevels(levels, medium.grid);
  this->Inside = std::make_unique<Implementation>(device, medium, ior, settings, levels);
}

PhotonMarcher::~PhotonMarcher() = default;
PhotonMarcher::PhotonMarcher(PhotonMarcher&&) noexcept = default;

PhotonLight PhotonMarcher::March(const std::vector<Photon>& photons, const Monitor& monitor)
{
  return this->Inside->March(photons, monitor);
}

std::vector<PhotonPath> PhotonMarcher::Paths(const std::vector<Photon>& photons, const std::vector<std::size_t>& chosen)
{
  return this->Inside->Paths(photons, chosen);
}

std::vector<std::size_t> ChooseEvenly(std::size_t size, std::size_t count)
{
  std::vector<std::size_t> chosen;
  count = std::min(count, size);
  for (std::size_t i = 0; i < count; ++i)
  {
    chosen.push_back(static_cast<std::size_t>((i + 0.5) / count * size));
  }
  return chosen;
}
}
