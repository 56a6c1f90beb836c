#include "Photons/Marching/PhotonMarcher.h"

#include "Device/Clock.h"
#include "Device/Defines.h"
#include "Device/HostMappedBuffer.h"
#include "Device/HostMemory.h"
#include "Device/Sizes.h"
#include "Light/ChannelReduction.h"
#include "Light/LeftOut.h"
#include "Photons/Importance/PilotGathering.h"
#include "Photons/Marching/MarchedBatches.h"
#include "Photons/Marching/MarchLaunch.h"
#include "Photons/Marching/PhotonPaths.h"
#include "Photons/Scattering/ScatteredChannels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

namespace tyndall
{
namespace
{
// A voxel's count of photons stands above the sum of their weights, in the same 64 bits.
constexpr int CountShift = 40;
constexpr std::size_t CountedAtMost = (std::size_t(1) << (64 - CountShift)) - 1;
constexpr double WeightUnits = 65536.0; ///< of the largest weight

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

/// Weight of one of the units that voxels sum up.
float WeightUnit(const std::vector<Photon>& photons)
{
  float largest = 0.0f;
  for (const Photon& photon : photons)
  {
    largest = std::max(largest, photon.weight);
  }
  return static_cast<float>(largest / WeightUnits);
}

/// One photon and its weight, of each.
std::vector<cl_ulong> Marks(const std::vector<Photon>& photons, const PackedPhotons& packed, float unit)
{
  std::vector<cl_ulong> marks;
  marks.reserve(packed.Count());
  for (const std::size_t number : packed.numbers)
  {
    const double units = unit > 0.0f ? photons[number].weight / static_cast<double>(unit) : 0.0;
    marks.push_back((cl_ulong(1) << CountShift) + static_cast<cl_ulong>(std::min(units + 0.5, WeightUnits)));
  }
  return marks;
}

void CheckCounted(std::size_t photons)
{
  if (photons > CountedAtMost)
  {
    throw InvalidInput("There are " + std::to_string(photons) + " photons; voxels can count up to " +
      std::to_string(CountedAtMost) + ". March fewer at a time, or without counts.");
  }
}
}

class PhotonMarcher::Implementation
{
public:
  Implementation(
    Device& device, const Medium& medium, const Field& ior, const MarchSettings& settings, const std::uint8_t* levels)
    : medium(device, medium, ior, settings, levels)
    , pilots(this->medium)
  {
    this->Share(1, 1); // says what the device lacks
    if (settings.maximumOrders != 1 && this->medium.traits.scatters)
    {
      this->Scattering = std::make_unique<ScatteredChannels>(device, this->medium, medium, ior, levels);
    }
  }

  /// What a march in turns is given, and gives.
  struct Turns
  {
    const MarchTurns& how;
    TurnTimes& times;
  };
  PhotonLight March(const std::vector<Photon>& photons, const PhotonNumbers& numbers, const Monitor& monitor,
    const Turns* turns = nullptr);
  /// @throws InvalidInput where light is kept by bricks
  void RequireVoxels(const char* what) const
  {
    if (this->medium.bricks.AreThere())
    {
      throw InvalidInput(std::string(what) + " voxel by voxel. Do not ask for light by bricks.");
    }
  }
  PhotonLight MarchInBatches(const std::vector<Photon>& photons, const Monitor& monitor);

  MarchMedium medium;
  PilotGathering pilots;

private:
  MarchShares Share(int numbers, int batches) const
  {
    return ShareSums(this->medium, this->medium.Records(), numbers, batches, this->Sums.Size() * sizeof(cl_long));
  }
  MarchSums PrepareSums(const PackedPhotons& packed);
  cl::Kernel SumsKernel(
    const char* name, const PackedPhotons& packed, const MarchSums& target, const LightField& light) const;
  void MarchTo(const MarchSums& target, const PackedPhotons& packed, const PhotonsOnDevice& photons,
    const LightField& light, const Turns* turns, const Monitor& monitor);
  void Tally(const PackedPhotons& packed, const std::vector<cl_int>& ends, PhotonLight& result) const;
  void FinishVoxels(const PackedPhotons& packed, const MarchSums& target, float weightUnit, PhotonLight& result,
    const Buffer<cl_long>& taken) const;
  void FinishBricks(
    const PackedPhotons& packed, const MarchSums& target, PhotonLight& result, const Buffer<cl_long>& taken) const;
  void Finish(const PackedPhotons& packed, const MarchSums& target, float weightUnit, PhotonLight& result);
  void SayWhatIsLeftOut(const PackedPhotons& packed, LightField& light) const;

  Buffer<cl_long> Sums;                          ///< zero between two runs
  std::unique_ptr<ScatteredChannels> Scattering; ///< null: photons are followed to where they are first scattered
};

MarchSums PhotonMarcher::Implementation::PrepareSums(const PackedPhotons& packed)
{
  const MarchSettings& settings = this->medium.settings;
  MarchSums target;
  target.records = this->medium.Records();
  target.directions = settings.meanDirection;
  target.counts = settings.counts;
  target.numbers = packed.channels + (settings.meanDirection ? 3 : 0) + (settings.counts ? 1 : 0);
  target.shares = this->Share(target.numbers, packed.Batches());
  const std::size_t needed =
    target.records * static_cast<std::size_t>(target.numbers) * static_cast<std::size_t>(target.shares.copies);
  if (this->Sums.Size() != needed)
  {
    this->Sums = Buffer<cl_long>();
    this->Sums = Buffer<cl_long>(this->medium.device, needed, "sums of the photons' light");
    this->Sums.Fill(0);
  }
  target.sums = &this->Sums;
  return target;
}

/// Of whole units, whose sums do not depend on the order of the photons.
void PhotonMarcher::Implementation::Tally(
  const PackedPhotons& packed, const std::vector<cl_int>& ends, PhotonLight& result) const
{
  EnergyBalance& balance = result.light.balance;
  const std::size_t words = EndWords + static_cast<std::size_t>(packed.channels);
  std::array<std::array<std::int64_t, 3>, StillGoing + 1> out = {};
  for (std::size_t i = 0; i < packed.Count(); ++i)
  {
    PhotonEnd end;
    std::memcpy(&end, ends.data() + i * words, sizeof(end));
    result.deposits += static_cast<std::size_t>(end.crossings);
    result.steps += static_cast<std::size_t>(end.steps);
    for (int c = 0; c < packed.channels; ++c)
    {
      cl_float units;
      std::memcpy(&units, ends.data() + i * words + EndWords + c, sizeof(units));
      out[std::min<int>(end.face, StillGoing)][c] += WholeUnits(units); // almost nothing of those that are dark
    }
  }
  for (int c = 0; c < 3; ++c)
  {
    for (int face = 0; face < StillGoing; ++face)
    {
      result.light.facePowerOut[face][c] = static_cast<double>(out[face][c]) * packed.unit;
      balance.escaped[c] += result.light.facePowerOut[face][c];
    }
    balance.leftOver[c] = static_cast<double>(out[StillGoing][c]) * packed.unit;
  }
}

cl::Kernel PhotonMarcher::Implementation::SumsKernel(
  const char* name, const PackedPhotons& packed, const MarchSums& target, const LightField& light) const
{
  return this->medium.SumsKernel(name, packed.channels,
    Define("DIRECTIONS", target.directions) + Define("COUNTS", target.counts) + Define("COUNT_SHIFT", CountShift) +
      Define("COLOURS", light.channels) + Define("COPIES", target.shares.copies) +
      Define("BATCHES", target.shares.batches));
}

/// All at once, or in turns between which the light so far is shown.
void PhotonMarcher::Implementation::MarchTo(const MarchSums& target, const PackedPhotons& packed,
  const PhotonsOnDevice& photons, const LightField& light, const Turns* turns, const Monitor& monitor)
{
  if (!turns)
  {
    MarchPhotons(this->medium, packed, photons, target, monitor);
    return;
  }
  const std::size_t voxels = this->medium.grid.VoxelCount();
  const Buffer<float> fluence(
    this->medium.device, voxels * static_cast<std::size_t>(light.channels), "fluence of photons on their way");
  cl::Kernel show = this->SumsKernel("show_light", packed, target, light);
  With(show, this->medium.DescribeSums(packed), this->medium.sigmaA, this->medium.sigmaS, this->Sums,
    cl_ulong(target.records * static_cast<std::size_t>(target.numbers)), fluence);
  turns->how.begin(packed, light.channels);
  turns->times = MarchInTurns(
    this->medium, packed, photons, target, turns->how,
    [&](const cl::CommandQueue& queue) -> const Buffer<float>& {
      queue.enqueueNDRangeKernel(
        show, cl::NullRange, cl::NDRange(voxels / static_cast<std::size_t>(this->medium.grid.size[0])));
      return fluence;
    },
    monitor);
}

void PhotonMarcher::Implementation::FinishVoxels(const PackedPhotons& packed, const MarchSums& target, float weightUnit,
  PhotonLight& result, const Buffer<cl_long>& taken) const
{
  LightField& light = result.light;
  Device& device = this->medium.device;
  const Grid& grid = this->medium.grid;
  const std::size_t voxels = grid.VoxelCount(), rows = voxels / static_cast<std::size_t>(grid.size[0]);
  const std::size_t batches = static_cast<std::size_t>(target.shares.batches);
  const std::size_t colours = static_cast<std::size_t>(light.channels);
  MakeZeros({ { &light.fluence, voxels * colours }, { &result.meanDirection, target.directions ? 3 * voxels : 0 },
    { &result.photonCount, target.counts ? voxels : 0 }, { &result.photonWeight, target.counts ? voxels : 0 },
    { &result.batchFluence, batches > 1 ? batches * voxels * colours : 0 } });
  const auto lend = [&](std::vector<float>& values, const char* what) {
    return HostMappedBuffer<float>(device, values.data(), values.size(), what);
  };
  const HostMappedBuffer<float> fluence = lend(light.fluence, "fluence");
  const HostMappedBuffer<float> direction = lend(result.meanDirection, "mean direction");
  const HostMappedBuffer<float> count = lend(result.photonCount, "photon count");
  const HostMappedBuffer<float> weight = lend(result.photonWeight, "photon weight");
  const HostMappedBuffer<float> batchFluence = lend(result.batchFluence, "fluence by batches");

  const LightSumsInfo info = this->medium.DescribeSums(packed, weightUnit);
  cl::Kernel finish = this->SumsKernel("finish_light", packed, target, light);
  With(finish, info, this->medium.sigmaA, this->medium.sigmaS, this->Sums,
    cl_ulong(target.records * static_cast<std::size_t>(target.numbers)), fluence.Handle(), direction.Handle(),
    count.Handle(), weight.Handle(), batchFluence.Handle(), taken);
  this->medium.Launch(finish, cl::NDRange(rows));
  for (const HostMappedBuffer<float>* array : { &fluence, &direction, &count, &weight, &batchFluence })
  {
    array->Fetch();
  }
}

void PhotonMarcher::Implementation::FinishBricks(
  const PackedPhotons& packed, const MarchSums& target, PhotonLight& result, const Buffer<cl_long>& taken) const
{
  LightField& light = result.light;
  const MarchMedium& through = this->medium;
  Device& device = through.device;
  const Grid& grid = through.grid;
  const std::size_t colours = static_cast<std::size_t>(light.channels), voxels = grid.VoxelCount();
  const Buffer<float> ofRecords(device, target.records * colours, "fluence of bricks");
  const Buffer<float> directions(device, target.directions ? 3 * target.records : 0, "mean direction of bricks");
  const LightSumsInfo info = through.DescribeSums(packed);
  cl::Kernel finish = this->SumsKernel("finish_bricks", packed, target, light);
  With(finish, info, through.bricks.First(), through.sigmaA, through.sigmaS, this->Sums,
    cl_ulong(target.records * static_cast<std::size_t>(target.numbers)), ofRecords, directions, taken);
  through.Launch(finish, cl::NDRange(through.bricks.Count()));
  MakeZeros({ { &light.fluence, voxels * colours }, { &result.meanDirection, target.directions ? 3 * voxels : 0 } });
  const HostMappedBuffer<float> fluence(device, light.fluence.data(), light.fluence.size(), "fluence");
  const HostMappedBuffer<float> direction(
    device, result.meanDirection.data(), result.meanDirection.size(), "mean direction");
  cl::Kernel spread = this->SumsKernel("spread_bricks", packed, target, light);
  With(spread, info, through.bricks.First(), ofRecords, directions, fluence.Handle(), direction.Handle());
  through.Launch(spread, cl::NDRange(Count(grid.size[1]), Count(grid.size[2])));
  fluence.Fetch();
  direction.Fetch();
}

void PhotonMarcher::Implementation::Finish(
  const PackedPhotons& packed, const MarchSums& target, float weightUnit, PhotonLight& result)
{
  LightField& light = result.light;
  const bool byBricks = this->medium.bricks.AreThere();
  const std::size_t channels = static_cast<std::size_t>(packed.channels);
  const std::size_t rows = this->medium.grid.VoxelCount() / Count(this->medium.grid.size[0]);
  const Buffer<cl_long> taken(
    this->medium.device, (byBricks ? this->medium.bricks.Count() : rows) * 2 * channels, "tallies");
  if (byBricks)
  {
    this->FinishBricks(packed, target, result, taken);
  }
  else
  {
    this->FinishVoxels(packed, target, weightUnit, result, taken);
  }
  result.secondsMarching += ClockSeconds();

  const std::vector<cl_long> units = taken.Read();
  for (std::size_t i = 0; i < units.size(); ++i)
  {
    const double watts = units[i] * packed.unit;
    light.balance.absorbed[i % channels] += watts;
    result.scattered[i % channels] += i / channels % 2 == 1 ? watts : 0.0;
  }
}

void PhotonMarcher::Implementation::SayWhatIsLeftOut(const PackedPhotons& packed, LightField& light) const
{
  const auto say = [&](bool condition, const char* text) {
    if (condition)
    {
      light.leftOut.push_back(text);
    }
  };
  say(this->medium.settings.maximumOrders == 1,
    "scattered light: fluence is what comes from the lights without being scattered");
  const MarchMedium& through = this->medium;
  const bool leaveOut = through.settings.leaveOut;
  say(through.traits.emits, "emission: photons carry the light of lights only");
  say(!through.bends, left_out::ConstantIndex);
  say(through.bends && !through.hasLevels, "octree: none was given, paths go by steps of the same length");
  say(packed.channels == 1, packed.grey ? left_out::Grey : left_out::OneColour);
  say(packed.channels == 3 && through.channels == 1, left_out::GreyExtinction);
  say(leaveOut && !through.traits.scatters, left_out::NoScattering);
  say(leaveOut && !through.traits.absorbs, left_out::NoAbsorption);
  say(through.bricks.AreThere(), "light voxel by voxel in empty space: it is kept by bricks of 8x8x8 voxels there");
  say(!through.settings.meanDirection, "mean direction: it was not asked for");
}

namespace
{
/// Of each row of so many photons one, by chance. Not every so manieth: samplers spread photons by the digits of their
/// numbers (every sixteenth has the same four last binary ones, which are Hammersley's first), and all of a batch would
/// be of one part of the light.
PhotonNumbers NumbersOfBatch(std::size_t photons, std::size_t batch, std::size_t batches)
{
  std::mt19937 random; // the same whatever the batch, and on every machine
  PhotonNumbers numbers;
  for (std::size_t row = 0; row < photons; row += batches)
  {
    const std::size_t number = row + (batch + random()) % batches;
    if (number < photons)
    {
      numbers.push_back(number);
    }
  }
  return numbers;
}
}

PhotonLight PhotonMarcher::Implementation::MarchInBatches(const std::vector<Photon>& photons, const Monitor& monitor)
{
  const auto batches = static_cast<std::size_t>(this->medium.settings.errorBatches);
  MarchedBatches all;
  for (std::size_t b = 0; b < batches; ++b)
  {
    const PhotonNumbers numbers = NumbersOfBatch(photons.size(), b, batches);
    std::vector<Photon> some;
    for (const std::size_t number : numbers)
    {
      some.push_back(photons[number]);
    }
    const double parts = static_cast<double>(batches);
    all.Add(this->March(some, numbers, OfPart(monitor, b / parts, (b + 1) / parts)));
  }
  return std::move(all).Sum();
}

PhotonLight PhotonMarcher::Implementation::March(
  const std::vector<Photon>& photons, const PhotonNumbers& numbers, const Monitor& monitor, const Turns* turns)
{
  const double start = ClockSeconds();
  const MarchSettings& settings = this->medium.settings;
  const PackedPhotons packed =
    Pack(photons, this->medium.grid, this->medium.channels == 3, this->medium.EventLimit(), settings.batches);
  const float weightUnit = settings.counts ? WeightUnit(photons) : 0.0f;
  if (settings.counts)
  {
    CheckCounted(packed.Count());
  }
  PhotonLight result;
  result.missed = packed.missed;
  result.batches = BatchesOf(photons);
  const int colours = this->Scattering && this->Scattering->HasColour() ? 3 : this->medium.ColoursOf(packed);
  result.light.channels = std::max(packed.channels, colours);
  result.light.device = this->medium.device.Name();
  result.light.balance.entered = packed.entered;

  const MarchSums target = this->PrepareSums(packed);
  const PhotonsOnDevice onDevice(
    this->medium.device, packed, settings.counts ? Marks(photons, packed, weightUnit) : std::vector<cl_ulong>());
  result.secondsMarching = -ClockSeconds();
  try
  {
    this->MarchTo(
      target, packed, onDevice, result.light, turns, this->Scattering ? OfPart(monitor, 0.0, 0.05) : monitor);
  }
  catch (...)
  {
    this->Sums = Buffer<cl_long>(); // they are not zero
    throw;
  }
  this->Finish(packed, target, weightUnit, result);
  this->Tally(packed, onDevice.ends.Read(), result);
  if (packed.channels == 1 && result.light.channels == 3)
  {
    Colour(packed.colour, result);
  }
  if (colours < result.light.channels)
  {
    KeepOneChannel(result.light);
    KeepOneChannel(result.batchFluence);
    result.scattered = { result.scattered[0], 0.0, 0.0 };
  }
  if (this->Scattering)
  {
    this->Scattering->AddTo(result, packed, numbers, OfPart(monitor, 0.05, 1.0));
  }
  else if (settings.maximumOrders != 1)
  {
    result.light.fluenceDirect = result.light.fluence; // nothing scatters
  }
  this->SayWhatIsLeftOut(packed, result.light);
  if (settings.batches && packed.Batches() == 1)
  {
    result.batchFluence = result.light.fluence;
  }
  result.seconds = ClockSeconds() - start;
  return result;
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
  const bool batches = this->Inside->medium.settings.errorBatches > 0;
  return batches ? this->Inside->MarchInBatches(photons, monitor) : this->Inside->March(photons, {}, monitor);
}

PhotonLight PhotonMarcher::MarchByTurns(
  const std::vector<Photon>& photons, const MarchTurns& turns, TurnTimes& times, const Monitor& monitor)
{
  const MarchSettings& settings = this->Inside->medium.settings;
  if (settings.maximumOrders != 1 || settings.batches)
  {
    throw InvalidInput("Photons march in turns up to where they are first scattered, and without batches.");
  }
  this->Inside->RequireVoxels("Photons march in turns");
  const Implementation::Turns inTurns = { turns, times };
  return this->Inside->March(photons, {}, monitor, &inTurns);
}

std::vector<PhotonPath> PhotonMarcher::Paths(const std::vector<Photon>& photons, const std::vector<std::size_t>& chosen)
{
  return TracePaths(this->Inside->medium, photons, chosen);
}

PilotLight PhotonMarcher::Gather(const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins,
  const std::array<int, 3>& cells, const Monitor& monitor)
{
  this->Inside->RequireVoxels("Pilot photons are gathered");
  return this->Inside->pilots.Gather(photons, origins, cells, monitor);
}
}
