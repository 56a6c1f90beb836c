#include "Photons/Marching/PhotonPacking.h"

#include "Device/Errors.h"
#include "Medium/Traits.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>

namespace tyndall
{
namespace
{
/// Log2 of the tiles along an axis, by which photons are sorted: a voxel or two of a grid of 128^3.
constexpr int TileBits = 8;
constexpr double SameColour = 1e-6;

void CheckPhoton(const Photon& photon, std::size_t number)
{
  const std::string name = "Photon " + std::to_string(number);
  float length = 0.0f;
  for (int a = 0; a < 3; ++a)
  {
    if (!std::isfinite(photon.position[a]) || !std::isfinite(photon.direction[a]))
    {
      throw InvalidInput(name + " has a position or direction that is not finite.");
    }
    if (!(photon.power[a] >= 0.0f) || std::isinf(photon.power[a]))
    {
      throw InvalidInput(name + " has power " + Text("%g", photon.power[a]) + "; it must be finite and not negative.");
    }
    length = std::max(length, std::abs(photon.direction[a]));
  }
  if (length == 0.0f)
  {
    throw InvalidInput(name + " has direction (0, 0, 0); say where it goes.");
  }
  if (!(photon.weight >= 0.0f) || std::isinf(photon.weight))
  {
    throw InvalidInput(
      name + " has weight " + Text("%g", photon.weight) + "; it must be finite and not negative, 1 as a rule.");
  }
}

/// Positions and directions, in voxels, of photons that meet the grid.
struct Ray
{
  std::array<float, 3> position, direction;
  std::uint32_t tile; ///< index on a space-filling curve that keeps neighbours together (Morton)
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
    // Photons are sorted by the midpoints of their paths: those of a lamp in the volume all start at one point.
    const double middle = (position[a] + omega * reach + reach) / (grid.size[a] + 2.0 * reach);
    const int tiles = 1 << TileBits;
    ray.tile |= Spread(std::min(std::max(static_cast<int>(middle * tiles), 0), tiles - 1)) << a;
  }
  return ray;
}

/// Indices of the rays sorted by tile, stable within a tile. Radix sort, by halves of the bits.
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

/// Groups photons by batch, in their present order; `begin` receives the index of each batch's first photon, and the
/// end.
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

void CheckBatch(const Photon& photon, std::size_t number)
{
  if (photon.batch < 0 || photon.batch >= MarchedBatchesAtMost)
  {
    throw InvalidInput("Photon " + std::to_string(number) + " is of batch " + std::to_string(photon.batch) +
      "; there are 0 to " + std::to_string(MarchedBatchesAtMost - 1) + ".");
  }
}

Rgb PowerOf(const Photon& photon)
{
  return { photon.power[0], photon.power[1], photon.power[2] };
}

/// The unit of power, of which the brightest photon has at most 2^31: sums of whole units do not depend on the order of
/// addition.
double UnitOfPower(double brightest)
{
  return brightest > 0.0 ? std::exp2(std::ceil(std::log2(brightest)) - 31.0) : 1.0;
}

/// Photons that meet the grid.
struct IncomingPhotons
{
  std::vector<Ray> rays;
  std::vector<std::size_t> numbers; ///< index of each among the photons given
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

/// Writes the photons to `packed` in this order, and sums the entered power.
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
}

bool MoveOnto(const Grid& grid, std::array<double, 3>& position, const std::array<double, 3>& direction)
{
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a)
  {
    const double size = grid.size[a];
    const double slack = 1e-6 * size; // a position on a face may have been rounded
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

int BatchesOf(const std::vector<Photon>& photons)
{
  std::int32_t last = 0;
  for (const Photon& photon : photons)
  {
    last = std::max(last, photon.batch);
  }
  return last + 1;
}

std::size_t PackedPhotons::LargestBatch() const
{
  int largest = 0;
  for (std::size_t b = 1; b < this->batchBegin.size(); ++b)
  {
    largest = std::max(largest, this->batchBegin[b] - this->batchBegin[b - 1]);
  }
  return static_cast<std::size_t>(largest);
}

double BrightestOf(const std::vector<Photon>& photons)
{
  double brightest = 0.0;
  for (const Photon& photon : photons)
  {
    brightest = std::max(brightest, Sum(PowerOf(photon)));
  }
  return brightest;
}

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

void CheckPhotons(const std::vector<Photon>& photons, bool batches)
{
  for (std::size_t i = 0; i < photons.size(); ++i)
  {
    CheckPhoton(photons[i], i);
    if (batches)
    {
      CheckBatch(photons[i], i);
    }
  }
}

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

PackedPhotons Pack(
  const std::vector<Photon>& photons, const Grid& grid, bool coloured, double depositsAtMost, bool batches)
{
  CheckPhotons(photons, batches);
  PhotonTotals all;
  all.brightest = BrightestOf(photons);
  all.powerUnits = PowerUnitsOf(photons, all.brightest);
  all.firstColour = FirstColourOf(photons);
  all.oneColour = HaveColour(photons, all.firstColour);
  all.batches = batches ? BatchesOf(photons) : 1;
  PackedPhotons packed = PackingOf(all, coloured, depositsAtMost);
  FillPacking(packed, photons, grid);
  return packed;
}

PackedPhotons OneChannel(const PackedPhotons& packed, int channel, double colour, double larger)
{
  PackedPhotons one;
  one.unit = packed.unit * larger;
  one.numbers = packed.numbers;
  one.batchBegin = packed.batchBegin;
  one.values.reserve(packed.Count() * 7);
  const auto each = static_cast<std::ptrdiff_t>(packed.FloatsEach());
  for (auto from = packed.values.begin(); from != packed.values.end(); from += each)
  {
    one.values.insert(one.values.end(), from, from + 6);
    one.values.push_back(static_cast<float>(from[6 + channel] * (colour / larger)));
    // Not rounded to units: photons of equal power would all be rounded in the same direction.
    one.entered[0] += one.unit * one.values.back();
  }
  return one;
}
}
