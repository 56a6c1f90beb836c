#include "Photons/Marching/PhotonShares.h"

#include "Photons/Marching/MarchedLight.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

namespace tyndall
{
namespace
{
/// Integers are sent as two doubles, a high and a low half, whose sums are exact.
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

namespace
{
/// The colour on the first rank that has one.
Rgb FirstOfAll(Communicator& communicator, const Rgb& own)
{
  std::vector<double> colours(3 * static_cast<std::size_t>(communicator.Ranks()), 0.0);
  std::copy(own.begin(), own.end(), colours.begin() + 3 * communicator.Rank());
  colours = communicator.Sum(colours);
  const auto first = std::find_if(colours.begin(), colours.end(), [](double power) { return power != 0.0; });
  Rgb colour = {};
  if (first != colours.end())
  {
    std::copy_n(colours.begin() + (first - colours.begin()) / 3 * 3, 3, colour.begin());
  }
  return colour;
}

/// Checks the photons of each rank, and computes the totals of all.
PhotonTotals TotalsOf(Communicator& communicator, const std::vector<Photon>& share, bool batches)
{
  PhotonTotals all;
  const std::vector<double> largest =
    communicator.Largest({ BrightestOf(share), batches ? 1.0 * BatchesOf(share) : 1.0 });
  all.brightest = largest[0];
  all.batches = static_cast<int>(largest[1]);
  all.powerUnits = SumExactly(communicator, { PowerUnitsOf(share, all.brightest) })[0];
  all.firstColour = FirstOfAll(communicator, FirstColourOf(share));
  all.oneColour = communicator.Largest({ HaveColour(share, all.firstColour) ? 0.0 : 1.0 })[0] == 0.0;
  return all;
}

void AddUpEntered(Communicator& communicator, PackedPhotons& packed)
{
  std::vector<std::int64_t> numbers(packed.enteredUnits.begin(), packed.enteredUnits.end());
  numbers.push_back(static_cast<std::int64_t>(packed.missed));
  numbers = SumExactly(communicator, numbers);
  packed.missed = static_cast<std::size_t>(numbers.back());
  for (std::size_t c = 0; c < 3; ++c)
  {
    packed.enteredUnits[c] = numbers[c];
    packed.entered[c] = static_cast<double>(numbers[c]) * packed.unit;
  }
}

/// One photon of a packing.
struct PlacedPhoton
{
  std::size_t place = 0;
  int batch = 0;
};

/// Sorts photons by the block in which each starts.
std::vector<std::vector<PlacedPhoton>> ByBlocks(const BlockPartition& partition, const PackedPhotons& packed)
{
  std::vector<std::vector<PlacedPhoton>> byRank(partition.blocks.size());
  int batch = 0;
  for (std::size_t i = 0; i < packed.Count(); ++i)
  {
    while (static_cast<int>(i) >= packed.batchBegin[static_cast<std::size_t>(batch) + 1])
    {
      ++batch;
    }
    const float* const position = packed.values.data() + i * static_cast<std::size_t>(packed.FloatsEach());
    int voxel[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      voxel[axis] = std::clamp(static_cast<int>(position[axis]), 0, partition.whole.size[axis] - 1);
    }
    const auto holds = [&](const VoxelBox& block) { return Holds(block, voxel); };
    const auto block = std::find_if(partition.blocks.begin(), partition.blocks.end(), holds);
    byRank[static_cast<std::size_t>(block - partition.blocks.begin())].push_back({ i, batch });
  }
  return byRank;
}

/// Appends the number of values, then the values.
template <class T>
void Append(const std::vector<T>& values, std::vector<char>& bytes)
{
  const std::size_t count = values.size();
  const auto add = [&bytes](const void* from, std::size_t size) {
    const char* const first = static_cast<const char*>(from);
    bytes.insert(bytes.end(), first, first + size);
  };
  add(&count, sizeof(count));
  add(values.data(), count * sizeof(T));
}

/// Reads values written by Append from position `begin`, which advances to their end.
template <class T>
std::vector<T> TakeFrom(const std::vector<char>& bytes, std::size_t& begin)
{
  std::size_t count = 0;
  std::memcpy(&count, bytes.data() + begin, sizeof(count));
  std::vector<T> values(count);
  begin += sizeof(count);
  if (count > 0)
  {
    std::memcpy(values.data(), bytes.data() + begin, count * sizeof(T));
  }
  begin += count * sizeof(T);
  return values;
}

/// Photons for one rank, in the format in which they are sent.
struct Parcel
{
  std::vector<float> values;
  std::vector<cl_ulong> numbers, marks;
  std::vector<int> batches;

  Parcel(const PackedPhotons& packed, const std::vector<cl_ulong>& marksOfAll, const std::vector<PlacedPhoton>& some)
  {
    const auto each = static_cast<std::ptrdiff_t>(packed.FloatsEach());
    for (const PlacedPhoton& photon : some)
    {
      const auto from = packed.values.begin() + static_cast<std::ptrdiff_t>(photon.place) * each;
      this->values.insert(this->values.end(), from, from + each);
      this->numbers.push_back(packed.numbers[photon.place]);
      this->batches.push_back(photon.batch);
      if (!marksOfAll.empty())
      {
        this->marks.push_back(marksOfAll[photon.place]);
      }
    }
  }
  explicit Parcel(const std::vector<char>& bytes)
  {
    std::size_t begin = 0;
    this->values = TakeFrom<float>(bytes, begin);
    this->numbers = TakeFrom<cl_ulong>(bytes, begin);
    this->marks = TakeFrom<cl_ulong>(bytes, begin);
    this->batches = TakeFrom<int>(bytes, begin);
  }
  std::vector<char> Bytes() const
  {
    std::vector<char> bytes;
    Append(this->values, bytes);
    Append(this->numbers, bytes);
    Append(this->marks, bytes);
    Append(this->batches, bytes);
    return bytes;
  }
};

std::vector<int> EveryRank(const Communicator& communicator)
{
  std::vector<int> ranks(static_cast<std::size_t>(communicator.Ranks()));
  std::iota(ranks.begin(), ranks.end(), 0);
  return ranks;
}

/// Joins the received photons, batch by batch.
void Join(const std::vector<Parcel>& parcels, StartingPhotons& starting)
{
  PackedPhotons& packed = starting.packed;
  const auto each = static_cast<std::ptrdiff_t>(packed.FloatsEach());
  packed.values.clear();
  packed.numbers.clear();
  starting.marks.clear();
  for (int batch = 0; batch < packed.Batches(); ++batch)
  {
    packed.batchBegin[static_cast<std::size_t>(batch)] = static_cast<int>(packed.numbers.size());
    for (const Parcel& parcel : parcels)
    {
      for (std::size_t i = 0; i < parcel.numbers.size(); ++i)
      {
        if (parcel.batches[i] != batch)
        {
          continue;
        }
        const auto from = parcel.values.begin() + static_cast<std::ptrdiff_t>(i) * each;
        packed.values.insert(packed.values.end(), from, from + each);
        packed.numbers.push_back(parcel.numbers[i]);
        if (!parcel.marks.empty())
        {
          starting.marks.push_back(parcel.marks[i]);
        }
      }
    }
  }
  packed.batchBegin.back() = static_cast<int>(packed.numbers.size());
}
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
  const MarchTraits& traits, const MarchSettings& settings)
{
  Communicator& communicator = domain.Comm();
  const BlockPartition& partition = domain.Partition();
  communicator.Collective([&] { CheckPhotons(share, settings.batches); });
  const PhotonTotals totals = TotalsOf(communicator, share, settings.batches);
  const auto largestWeight = static_cast<float>(communicator.Largest({ CountedPhotons::LargestWeight(share) })[0]);
  StartingPhotons starting;
  communicator.Collective([&] {
    starting.packed = PackingOf(totals, traits.Channels(settings) == 3, MarchEventLimit(partition.whole, settings));
    FillPacking(starting.packed, share, partition.whole);
  });
  AddUpEntered(communicator, starting.packed);
  const std::size_t met = PlaceAmong(communicator, starting.packed.Count()).all;
  communicator.Collective([&] {
    CountedPhotons counted;
    if (settings.counts)
    {
      counted = CountedPhotons(share, starting.packed, largestWeight, met);
    }
    starting.weightUnit = counted.weightUnit;
    starting.marks = std::move(counted.marks);
    for (std::size_t& number : starting.packed.numbers)
    {
      number = numbers[number];
    }
  });
  if (domain.IsSerial())
  {
    return starting; // photons are already where they start
  }
  std::vector<std::vector<char>> arrived = communicator.Exchange<char>(EveryRank(communicator), [&] {
    std::vector<std::vector<char>> parcels;
    for (const std::vector<PlacedPhoton>& some : ByBlocks(partition, starting.packed))
    {
      parcels.push_back(Parcel(starting.packed, starting.marks, some).Bytes());
    }
    return parcels;
  });
  std::vector<Parcel> parcels;
  for (std::vector<char>& bytes : arrived)
  {
    parcels.emplace_back(std::exchange(bytes, {})); // possibly all photons: avoids holding them twice
  }
  Join(parcels, starting);
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
  std::vector<PlacedPhoton> own = ByBlocks({ whole, { block, { { 0, 0, 0 }, whole.size } } }, packed)[0];
  StartingPhotons starting;
  starting.packed = packed;
  Join({ Parcel(packed, {}, own) }, starting);
  return starting.packed;
}
}
