#include "Photons/Marching/PhotonPacking.h"

#include "Device/Errors.h"
#include "Medium/Traits.h"
#include "Numerics/NumberText.h"
#include "Photons/Marching/MarchShared.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace tyndall
{
namespace
{
/// Photons are sorted by tiles. This is the base-2 logarithm of the number of tiles along an axis; in a grid of 128^3
/// voxels a tile is one to two voxels wide.
constexpr int TileBits = 8;
constexpr double SameColour = 1e-6;

void CheckPhoton(const Photon& photon, std::size_t number, bool batches)
{
  const std::string name = "Photon " + std::to_string(number);
  const auto isPower = [](float value) { return value >= 0.0f && !std::isinf(value); };
  float length = 0.0f;
  for (int a = 0; a < 3; ++a)
  {
    if (!std::isfinite(photon.position[a]) || !std::isfinite(photon.direction[a]))
    {
      throw InvalidInput(name + " has a position or direction that is not finite.");
    }
    if (!isPower(photon.power[a]))
    {
      throw InvalidInput(name + " has power " + Text("%g", photon.power[a]) + "; it must be finite and not negative.");
    }
    length = std::max(length, std::abs(photon.direction[a]));
  }
  if (length == 0.0f)
  {
    throw InvalidInput(name + " has direction (0, 0, 0); say where it goes.");
  }
  if (!isPower(photon.weight))
  {
    throw InvalidInput(
      name + " has weight " + Text("%g", photon.weight) + "; it must be finite and not negative, 1 as a rule.");
  }
  if (batches && (photon.batch < 0 || photon.batch >= MarchedBatchesAtMost))
  {
    throw InvalidInput(name + " is of batch " + std::to_string(photon.batch) + "; there are 0 to " +
      std::to_string(MarchedBatchesAtMost - 1) + ".");
  }
}

/// Checks all photons of a rank.
/// @throws InvalidInput for the first photon that is not valid
void CheckPhotons(const std::vector<Photon>& photons, bool batches)
{
  for (std::size_t i = 0; i < photons.size(); ++i)
  {
    CheckPhoton(photons[i], i, batches);
  }
}

/// The line along which a photon crosses the grid: start and direction in voxels, and the tile by which the photon is
/// sorted.
struct Ray
{
  std::array<float, 3> position, direction;
  std::uint32_t tile; ///< index of its tile on a space-filling curve (Morton), which keeps neighbours together
};

/// Inserts two zero bits after each bit of x.
std::uint32_t Spread(std::uint32_t x)
{
  std::uint32_t spread = 0;
  for (int bit = 0; bit < TileBits; ++bit)
  {
    spread |= (x >> bit & 1u) << 3 * bit;
  }
  return spread;
}

Ray RayOf(const Grid& grid, const Photon& photon, const std::array<double, 3>& position)
{
  Ray ray = {};
  const double length = std::hypot(photon.direction[0], photon.direction[1], photon.direction[2]);
  const double reach = 0.5 * std::hypot(grid.size[0], grid.size[1], grid.size[2]);
  for (int a = 0; a < 3; ++a)
  {
    const double omega = photon.direction[a] / length;
    ray.position[a] = static_cast<float>(position[a]);
    ray.direction[a] = static_cast<float>(omega);
    // Photons are sorted by a point on their line, half a diagonal of the grid ahead of them, because all photons of a
    // lamp in the volume start at the same point.
    const double middle = (position[a] + omega * reach + reach) / (grid.size[a] + 2.0 * reach);
    const int tiles = 1 << TileBits;
    ray.tile |= Spread(std::min(std::max(static_cast<int>(middle * tiles), 0), tiles - 1)) << a;
  }
  return ray;
}

/// Indices of the rays sorted by tile, stable within a tile: radix sort in two passes, each by half of the bits.
std::vector<std::uint32_t> Order(const std::vector<Ray>& rays)
{
  constexpr int Bits = 3 * TileBits / 2;
  std::vector<std::uint32_t> order(rays.size()), sorted(rays.size());
  std::iota(order.begin(), order.end(), 0u);
  for (const int shift : { 0, Bits })
  {
    std::vector<std::size_t> begin((1 << Bits) + 1, 0);
    const auto part = [&](std::uint32_t i) { return rays[i].tile >> shift & ((1u << Bits) - 1); };
    for (const std::uint32_t i : order)
    {
      ++begin[part(i) + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (const std::uint32_t i : order)
    {
      sorted[begin[part(i)]++] = i;
    }
    order.swap(sorted);
  }
  return order;
}

/// Groups photons by batch, in their present order within each batch.
/// @param begin  output: index of each batch's first photon, and one past the last photon
std::vector<std::uint32_t> ByBatch(const std::vector<std::uint32_t>& order, const std::vector<Photon>& photons,
  const std::vector<std::size_t>& numbers, int batches, std::vector<int>& begin)
{
  const auto batch = [&](std::uint32_t i) { return static_cast<std::size_t>(photons[numbers[i]].batch); };
  begin.assign(static_cast<std::size_t>(batches) + 1, 0);
  for (const std::uint32_t i : order)
  {
    ++begin[batch(i) + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<int> next = begin;
  std::vector<std::uint32_t> sorted(order.size());
  for (const std::uint32_t i : order)
  {
    sorted[static_cast<std::size_t>(next[batch(i)]++)] = i;
  }
  return sorted;
}

Rgb PowerOf(const Photon& photon)
{
  return { photon.power[0], photon.power[1], photon.power[2] };
}

/// Unit of power, W, in which the brightest photon has at most 2^31 units. Sums of whole units do not depend on the
/// order of addition.
double UnitOfPower(double brightest)
{
  return brightest > 0.0 ? std::exp2(std::ceil(std::log2(brightest)) - 31.0) : 1.0;
}

/// Photons whose lines meet the grid. Those that start outside have been moved to the point where they enter it.
struct IncomingPhotons
{
  std::vector<Ray> rays;
  std::vector<std::size_t> numbers; ///< index of each of these photons among all photons passed to ClipToVolume
};

IncomingPhotons ClipToVolume(const Grid& grid, const std::vector<Photon>& photons)
{
  IncomingPhotons met;
  met.rays.reserve(photons.size());
  met.numbers.reserve(photons.size());
  for (std::size_t i = 0; i < photons.size(); ++i)
  {
    std::array<double, 3> position, direction;
    for (int a = 0; a < 3; ++a)
    {
      position[a] = (photons[i].position[a] - grid.origin[a]) / grid.spacing[a];
      direction[a] = photons[i].direction[a] / grid.spacing[a];
    }
    if (MoveOnto(grid, position, direction))
    {
      met.rays.push_back(RayOf(grid, photons[i], position));
      met.numbers.push_back(i);
    }
  }
  return met;
}

/// Writes the photons to `packed` in the given order, and sums the entered power.
void FillInOrder(PackedPhotons& packed, const std::vector<Photon>& photons, const IncomingPhotons& met,
  const std::vector<std::uint32_t>& order)
{
  packed.numbers.resize(met.rays.size());
  packed.values.resize(met.rays.size() * packed.FloatsEach());
  float* values = packed.values.data();
  std::array<std::int64_t, 3> entered = {};
  for (std::size_t i = 0; i < met.rays.size(); ++i)
  {
    const Ray& ray = met.rays[order[i]];
    packed.numbers[i] = met.numbers[order[i]];
    values = std::copy(ray.position.begin(), ray.position.end(), values);
    values = std::copy(ray.direction.begin(), ray.direction.end(), values);
    const std::array<float, 3>& power = photons[packed.numbers[i]].power;
    for (int c = 0; c < packed.channels; ++c)
    {
      const double watts = packed.channels == 3 ? power[c] : (double(power[0]) + power[1] + power[2]) / 3.0;
      *values = static_cast<float>(watts / packed.unit);
      entered[c] += WholeUnits(*values++);
    }
  }
  packed.enteredUnits = entered;
  for (int c = 0; c < 3; ++c)
  {
    packed.entered[c] = static_cast<double>(entered[c]) * packed.unit;
  }
}

/// Totals over the photons of all ranks that decide how photons are packed.
struct PhotonTotals
{
  double brightest = 0.0;      ///< W, power of the brightest photon, sum of channels
  std::int64_t powerUnits = 0; ///< total power, with each photon's power rounded up to units of UnitOfPower
  Rgb firstColour = {};        ///< power of the first photon that has any; black if none has
  bool oneColour = true;       ///< whether all photons have the colour `firstColour`
  int batches = 1;             ///< number of batches that are summed separately
};

double BrightestOf(const std::vector<Photon>& photons)
{
  double brightest = 0.0;
  for (const Photon& photon : photons)
  {
    brightest = std::max(brightest, Sum(PowerOf(photon)));
  }
  return brightest;
}

/// Total power of the photons in units of UnitOfPower, with each photon's power rounded up.
/// @param brightest  W, power of the brightest photon of all ranks
std::int64_t PowerUnitsOf(const std::vector<Photon>& photons, double brightest)
{
  const double unit = UnitOfPower(brightest);
  std::int64_t sum = 0;
  for (const Photon& photon : photons)
  {
    sum += static_cast<std::int64_t>(std::ceil(Sum(PowerOf(photon)) / unit));
  }
  return sum;
}

Rgb FirstColourOf(const std::vector<Photon>& photons)
{
  const auto first =
    std::find_if(photons.begin(), photons.end(), [](const Photon& photon) { return PowerOf(photon) != Rgb{}; });
  return first == photons.end() ? Rgb{} : PowerOf(*first);
}

bool HaveColour(const std::vector<Photon>& photons, const Rgb& first)
{
  CommonColour common;
  common.Add(first);
  for (std::size_t i = 0; i < photons.size() && common.IsOne(); ++i)
  {
    common.Add(PowerOf(photons[i]));
  }
  return common.IsOne();
}

/// Creates PackedPhotons without photons: sets only channels, colour, unit of power and number of batches.
PackedPhotons PackingOf(const PhotonTotals& all, bool coloured, double depositsAtMost)
{
  PackedPhotons packed;
  CommonColour common;
  common.Add(all.firstColour);
  const Rgb relative = common.Relative();
  for (int c = 0; c < 3; ++c)
  {
    const double part = 3.0 * relative[c] / Sum(relative);
    packed.colour[c] = std::abs(part - 1.0) < SameColour ? 1.0 : part;
  }
  packed.grey = all.oneColour && packed.colour == Rgb{ 1.0, 1.0, 1.0 };
  packed.channels = all.oneColour && !coloured ? 1 : 3;
  packed.colour = packed.channels == 3 ? Rgb{ 1.0, 1.0, 1.0 } : packed.colour;
  const double total = static_cast<double>(all.powerUnits) * UnitOfPower(all.brightest);
  packed.unit = total > 0.0 ? std::exp2(std::ceil(std::log2(total * depositsAtMost / 0x1p62))) : 1.0;
  packed.batchBegin.assign(static_cast<std::size_t>(all.batches) + 1, 0);
  return packed;
}

/// Writes this rank's photons to the PackedPhotons that PackingOf created.
void FillPacking(PackedPhotons& packed, const std::vector<Photon>& photons, const Grid& grid)
{
  const IncomingPhotons met = ClipToVolume(grid, photons);
  packed.missed = photons.size() - met.numbers.size();
  std::vector<std::uint32_t> order = Order(met.rays);
  if (packed.Batches() > 1)
  {
    order = ByBatch(order, photons, met.numbers, packed.Batches(), packed.batchBegin);
  }
  else
  {
    packed.batchBegin = { 0, static_cast<int>(met.rays.size()) };
  }
  FillInOrder(packed, photons, met, order);
}

/// Base by which an integer is split into a high and a low half, stored in two doubles. Sums of such halves over ranks
/// have no rounding errors.
constexpr double Half = 0x1p31;

}

std::vector<std::int64_t> SumExactly(Communicator& communicator, const std::vector<std::int64_t>& numbers)
{
  if (communicator.Ranks() == 1)
  {
    return numbers;
  }
  std::vector<double> halves;
  for (const std::int64_t number : numbers)
  {
    const std::int64_t low = number % static_cast<std::int64_t>(Half);
    halves.push_back(static_cast<double>((number - low) / static_cast<std::int64_t>(Half)));
    halves.push_back(static_cast<double>(low));
  }
  halves = communicator.Sum(halves);
  std::vector<std::int64_t> sums;
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    sums.push_back(static_cast<std::int64_t>(halves[2 * i]) * static_cast<std::int64_t>(Half) +
      static_cast<std::int64_t>(halves[2 * i + 1]));
  }
  return sums;
}

int BatchesOf(const std::vector<Photon>& photons)
{
  std::int32_t last = 0;
  for (const Photon& photon : photons)
  {
    last = std::max(last, photon.batch);
  }
  return last + 1;
}

namespace
{
/// Colour of the first photon that has power, on the lowest rank that has such a photon; black if there is none.
/// Collective.
/// @param own  colour of this rank's first photon that has power; black if it has none
Rgb FirstOfAll(const Domain& domain, const Rgb& own)
{
  std::vector<double> colours(3 * static_cast<std::size_t>(domain.Comm().Ranks()), 0.0);
  std::copy(own.begin(), own.end(), colours.begin() + 3 * domain.Rank());
  colours = domain.Sum(colours);
  const auto first = std::find_if(colours.begin(), colours.end(), [](double power) { return power != 0.0; });
  Rgb colour = {};
  if (first != colours.end())
  {
    std::copy_n(colours.begin() + (first - colours.begin()) / 3 * 3, 3, colour.begin());
  }
  return colour;
}

PhotonTotals TotalsOf(const Domain& domain, const std::vector<Photon>& share, bool batches)
{
  PhotonTotals all;
  all.brightest = domain.Max(BrightestOf(share));
  all.batches = static_cast<int>(domain.Max(batches ? BatchesOf(share) : 1));
  all.powerUnits = SumExactly(domain.Comm(), { PowerUnitsOf(share, all.brightest) })[0];
  all.firstColour = FirstOfAll(domain, FirstColourOf(share));
  all.oneColour = !domain.Any(!HaveColour(share, all.firstColour));
  return all;
}

void AddUpEntered(const Domain& domain, PackedPhotons& packed)
{
  std::vector<std::int64_t> numbers(packed.enteredUnits.begin(), packed.enteredUnits.end());
  numbers.push_back(static_cast<std::int64_t>(packed.missed));
  numbers = SumExactly(domain.Comm(), numbers);
  packed.missed = static_cast<std::size_t>(numbers.back());
  for (std::size_t c = 0; c < 3; ++c)
  {
    packed.enteredUnits[c] = numbers[c];
    packed.entered[c] = static_cast<double>(numbers[c]) * packed.unit;
  }
}

/// Format in which a photon is sent to the rank where it starts.
struct SentPhoton
{
  float values[9] = {}; ///< position, direction and power, as in PackedPhotons::values
  int batch = 0;
  cl_ulong number = 0, mark = 0;
};

/// Sorts photons by the rank in whose block each starts.
std::vector<std::vector<SentPhoton>> ByBlocks(
  const BlockPartition& partition, const PackedPhotons& packed, const std::vector<cl_ulong>& marks)
{
  std::vector<std::vector<SentPhoton>> byRank(partition.blocks.size());
  int batch = 0;
  for (std::size_t i = 0; i < packed.Count(); ++i)
  {
    while (static_cast<int>(i) >= packed.batchBegin[static_cast<std::size_t>(batch) + 1])
    {
      ++batch;
    }
    const float* const values = packed.values.data() + i * static_cast<std::size_t>(packed.FloatsEach());
    int voxel[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      voxel[axis] = std::clamp(static_cast<int>(values[axis]), 0, partition.whole.size[axis] - 1);
    }
    const auto holds = [&](const VoxelBox& block) { return Holds(block, voxel); };
    const auto block = std::find_if(partition.blocks.begin(), partition.blocks.end(), holds);
    SentPhoton photon;
    std::copy_n(values, packed.FloatsEach(), photon.values);
    photon.batch = batch;
    photon.number = packed.numbers[i];
    photon.mark = marks.empty() ? 0 : marks[i];
    byRank[static_cast<std::size_t>(block - partition.blocks.begin())].push_back(photon);
  }
  return byRank;
}

std::vector<int> EveryRank(const Communicator& communicator)
{
  std::vector<int> ranks(static_cast<std::size_t>(communicator.Ranks()));
  std::iota(ranks.begin(), ranks.end(), 0);
  return ranks;
}

/// Replaces the packed photons by those that start on this rank, which were received from all ranks, and sorts them by
/// batch.
void Join(const std::vector<std::vector<SentPhoton>>& parcels, bool marked, StartingPhotons& starting)
{
  PackedPhotons& packed = starting.packed;
  packed.values.clear();
  packed.numbers.clear();
  starting.marks.clear();
  for (int batch = 0; batch < packed.Batches(); ++batch)
  {
    packed.batchBegin[static_cast<std::size_t>(batch)] = static_cast<int>(packed.numbers.size());
    for (const std::vector<SentPhoton>& parcel : parcels)
    {
      for (const SentPhoton& photon : parcel)
      {
        if (photon.batch != batch)
        {
          continue;
        }
        packed.values.insert(packed.values.end(), photon.values, photon.values + packed.FloatsEach());
        packed.numbers.push_back(photon.number);
        if (marked)
        {
          starting.marks.push_back(photon.mark);
        }
      }
    }
  }
  packed.batchBegin.back() = static_cast<int>(packed.numbers.size());
}

/// Computes the mark of each photon, a 64-bit integer that the photon adds to each voxel on its path. The upper bits
/// are a count of 1, the lower bits the photon's weight in units.
/// @param largest, count  largest weight, and number, of the photons of all ranks
/// @throws InvalidInput if there are more photons than the counter of a voxel can hold
void MarkForCounting(const std::vector<Photon>& share, float largest, std::size_t count, StartingPhotons& starting)
{
  // The count has the upper bits of a 64-bit number; the lower bits hold the sum of the photons' weights.
  constexpr std::size_t CountedAtMost = (std::size_t(1) << (64 - CountShift)) - 1;
  constexpr double WeightUnits = 65536.0; // the largest weight has this number of units
  Require(count <= CountedAtMost,
    "There are " + std::to_string(count) + " photons; voxels can count up to " + std::to_string(CountedAtMost) +
      ". March fewer at a time, or without counts.");
  const float unit = static_cast<float>(largest / WeightUnits);
  for (const std::size_t number : starting.packed.numbers)
  {
    const double units = unit > 0.0f ? share[number].weight / static_cast<double>(unit) : 0.0;
    starting.marks.push_back((cl_ulong(1) << CountShift) + static_cast<cl_ulong>(std::min(units + 0.5, WeightUnits)));
  }
  starting.weightUnit = unit;
}
}

bool MoveOnto(const Grid& grid, std::array<double, 3>& position, const std::array<double, 3>& direction)
{
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a)
  {
    const double size = grid.size[a];
    const double slack = 1e-6 * size; // tolerance for a photon on a face, which rounding may have moved outside
    if (direction[a] == 0.0)
    {
      if (position[a] < -slack || position[a] > size + slack)
      {
        return false;
      }
      continue;
    }
    const double t0 = ((direction[a] > 0.0 ? 0.0 : size) - position[a]) / direction[a];
    const double t1 = ((direction[a] > 0.0 ? size : 0.0) - position[a]) / direction[a];
    enter = std::max(enter, t0);
    leave = std::min(leave, t1 + slack / std::abs(direction[a]));
  }
  for (int a = 0; a < 3; ++a)
  {
    position[a] = std::min(std::max(position[a] + enter * direction[a], 0.0), static_cast<double>(grid.size[a]));
  }
  return enter <= leave;
}

PackedPhotons OneChannel(const PackedPhotons& packed, int channel, double colour, double larger)
{
  // A channel much fainter than the others has a proportionally smaller unit. Otherwise rounding its deposits to units
  // would lose a part of its power.
  const double own = packed.entered[static_cast<std::size_t>(channel)], all = Sum(packed.entered);
  const double scale = larger * (packed.channels == 3 && own > 0.0 ? std::exp2(std::ceil(std::log2(own / all))) : 1.0);
  PackedPhotons one;
  one.unit = packed.unit * scale;
  one.numbers = packed.numbers;
  one.batchBegin = packed.batchBegin;
  one.values.reserve(packed.Count() * 7);
  const auto each = static_cast<std::ptrdiff_t>(packed.FloatsEach());
  for (auto from = packed.values.begin(); from != packed.values.end(); from += each)
  {
    one.values.insert(one.values.end(), from, from + 6);
    one.values.push_back(static_cast<float>(from[6 + channel] * (colour / scale)));
    // Powers are not rounded to whole units here: for photons of equal power all rounding errors would have the same
    // sign and add up.
    one.entered[0] += one.unit * one.values.back();
  }
  return one;
}

PackedPhotons Pack(const std::vector<Photon>& photons, const Grid& grid, bool coloured, double depositsAtMost)
{
  CheckPhotons(photons, false);
  PackedPhotons packed = PackingOf(TotalsOf(Domain(grid), photons, false), coloured, depositsAtMost);
  FillPacking(packed, photons, grid);
  return packed;
}

PlaceOfShare PlaceAmong(Communicator& communicator, std::size_t share)
{
  std::vector<double> counts(static_cast<std::size_t>(communicator.Ranks()), 0.0);
  counts[static_cast<std::size_t>(communicator.Rank())] = static_cast<double>(share);
  counts = communicator.Sum(counts);
  const auto begin = counts.begin();
  return { static_cast<std::size_t>(std::accumulate(begin, begin + communicator.Rank(), 0.0)),
    static_cast<std::size_t>(std::accumulate(begin, counts.end(), 0.0)) };
}

StartingPhotons SendToTheirBlocks(const Domain& domain, const std::vector<Photon>& share, const PhotonNumbers& numbers,
  bool coloured, double depositsAtMost, const MarchSettings& settings)
{
  Communicator& communicator = domain.Comm();
  domain.Collective([&] { CheckPhotons(share, settings.batches); });
  const PhotonTotals totals = TotalsOf(domain, share, settings.batches);
  float heaviest = 0.0f;
  for (const Photon& photon : share)
  {
    heaviest = std::max(heaviest, photon.weight);
  }
  heaviest = static_cast<float>(domain.Max(heaviest));
  StartingPhotons starting;
  domain.Collective([&] {
    starting.packed = PackingOf(totals, coloured, depositsAtMost);
    FillPacking(starting.packed, share, domain.Whole());
  });
  AddUpEntered(domain, starting.packed);
  const std::size_t met = PlaceAmong(communicator, starting.packed.Count()).all;
  domain.Collective([&] {
    if (settings.counts)
    {
      MarkForCounting(share, heaviest, met, starting);
    }
    for (std::size_t& number : starting.packed.numbers)
    {
      number = numbers[number];
    }
  });
  if (domain.IsSerial())
  {
    return starting; // on one rank all photons start in its block
  }
  Join(communicator.Exchange<SentPhoton>(
         EveryRank(communicator), [&] { return ByBlocks(domain.Partition(), starting.packed, starting.marks); }),
    settings.counts, starting);
  return starting;
}

std::vector<Photon> ChosenOnEachRank(Communicator& communicator, const std::vector<Photon>& share,
  const PlaceOfShare& place, const std::vector<std::size_t>& chosen)
{
  std::vector<Photon> own;
  for (const std::size_t number : chosen)
  {
    if (number >= place.first && number < place.first + share.size())
    {
      own.push_back(share[number - place.first]);
    }
  }
  std::vector<Photon> all;
  for (const std::vector<Photon>& some : communicator.Exchange<Photon>(
         EveryRank(communicator), [&] { return std::vector<std::vector<Photon>>(communicator.Ranks(), own); }))
  {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

PackedPhotons ThoseIn(const VoxelBox& block, const Grid& whole, const PackedPhotons& packed)
{
  if (block.size == whole.size)
  {
    return packed;
  }
  StartingPhotons starting;
  starting.packed = packed;
  Join({ ByBlocks({ whole, { block, { { 0, 0, 0 }, whole.size } } }, packed, {})[0] }, false, starting);
  return starting.packed;
}
}
