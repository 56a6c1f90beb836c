#include "Photons/Importance/PilotGathering.h"

#include "Device/Clock.h"
#include "Device/Sizes.h"
#include "Distribution/Rounds.h"
#include "Photons/Marching/MarchedLight.h"
#include "Photons/Marching/MarchRun.h"
#include "Photons/Marching/PhotonPacking.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int LargestOrigin = 65535;
/// Number of integers in the record of a coarse cell that describe the origins of its photons: number of photons, sums
/// of their columns and rows, and sums of the squares of columns and rows.
constexpr int OriginNumbers = 5;

std::array<int, 3> CellsOf(const std::array<int, 3>& asked, const Grid& grid)
{
  std::array<int, 3> cells;
  for (int a = 0; a < 3; ++a)
  {
    Require(asked[a] >= 1,
      "Pilot light is asked for in " + std::to_string(asked[0]) + " x " + std::to_string(asked[1]) + " x " +
        std::to_string(asked[2]) + " cells; there must be at least one along each axis.");
    cells[a] = std::min(asked[a], grid.size[a]);
  }
  return cells;
}

/// Number of voxels in cell `i` of `cells` along an axis of `size` voxels: voxel v is in cell v * cells / size.
double VoxelsIn(int i, int cells, int size)
{
  const auto first = [&](std::int64_t cell) { return (cell * size + cells - 1) / cells; };
  return static_cast<double>(first(i + 1) - first(i));
}

/// Computes mean and standard deviation of values from their count, sum and sum of squares.
void PutMoments(std::int64_t count, std::int64_t sum, std::int64_t squares, float& mean, float& deviation)
{
  const double n = static_cast<double>(std::max<std::int64_t>(count, 1)), s = static_cast<double>(sum);
  mean = static_cast<float>(s / n);
  deviation = static_cast<float>(std::sqrt(std::max((static_cast<double>(squares) - s * s / n) / n, 0.0)));
}

/// Checks the origins of pilot photons.
/// @throws InvalidInput if the numbers of origins and photons differ, or an origin is out of range
void CheckOrigins(const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins)
{
  Require(origins.size() == photons.size(),
    "There are " + std::to_string(photons.size()) + " pilot photons and " + std::to_string(origins.size()) +
      " origins; give one for each.");
  for (std::size_t i = 0; i < origins.size(); ++i)
  {
    for (const int place : origins[i])
    {
      if (place < 0 || place > LargestOrigin)
      {
        throw InvalidInput("Photon " + std::to_string(i) + " sets out from column " + std::to_string(origins[i][0]) +
          ", row " + std::to_string(origins[i][1]) + "; there are 0 to " + std::to_string(LargestOrigin) + ".");
      }
    }
  }
}

/// One 64-bit integer per photon for the kernel option CELLS of PhotonMarch.cl: column and row of the photon's origin
/// on the photon plane.
std::vector<cl_ulong> MarksOfOrigins(const std::vector<std::array<int, 2>>& origins, const PackedPhotons& packed)
{
  std::vector<cl_ulong> marks;
  marks.reserve(packed.Count());
  for (const std::size_t number : packed.numbers)
  {
    marks.push_back(static_cast<cl_ulong>(origins[number][0] | static_cast<std::int64_t>(origins[number][1]) << 16));
  }
  return marks;
}

/// Creates a PilotLight of zeros for a grid of voxels.
/// @param cells  requested numbers of cells along each axis; reduced to the number of voxels if larger
/// @throws InvalidInput if the number of cells along an axis is 0
PilotLight DarkPilotLight(const Grid& voxels, const std::array<int, 3>& cells, int channels)
{
  PilotLight light;
  light.grid.size = CellsOf(cells, voxels);
  light.grid.origin = voxels.origin;
  for (int a = 0; a < 3; ++a)
  {
    light.grid.spacing[a] = voxels.Length(a) / light.grid.size[a];
  }
  light.channels = channels;
  const std::size_t count = light.grid.VoxelCount();
  light.fluence.resize(count * static_cast<std::size_t>(light.channels));
  light.count.resize(count);
  light.originMean.resize(2 * count);
  light.originDeviation.resize(2 * count);
  return light;
}

/// Sums over the copies of the coarse cells' deposits, which are stored in a buffer one copy after another.
/// @param size  number of integers in one copy
std::vector<std::int64_t> SumOfCopies(const Buffer<cl_long>& memory, std::size_t size)
{
  const std::vector<cl_long> read = memory.Read();
  std::vector<std::int64_t> sums(read.begin(), read.end());
  for (std::size_t i = size; i < sums.size(); ++i)
  {
    sums[i % size] += sums[i];
  }
  sums.resize(size);
  return sums;
}

/// Converts the sums of all coarse cells to pilot light.
/// @param unit  value of one fixed-point unit of power times path length, W length
void PutCells(const std::vector<std::int64_t>& sums, const Grid& voxels, const PackedPhotons& packed, double unit,
  PilotLight& light)
{
  const std::size_t numbers = static_cast<std::size_t>(packed.channels + OriginNumbers);
  const std::size_t colours = static_cast<std::size_t>(light.channels);
  const std::array<int, 3>& cells = light.grid.size;
  for (std::size_t i = 0; i < light.grid.VoxelCount(); ++i)
  {
    const std::int64_t* record = sums.data() + i * numbers;
    const int place[3] = { static_cast<int>(i) % cells[0], static_cast<int>(i) / cells[0] % cells[1],
      static_cast<int>(i) / cells[0] / cells[1] };
    double volume = voxels.VoxelVolume();
    for (int a = 0; a < 3; ++a)
    {
      volume *= VoxelsIn(place[a], cells[a], voxels.size[a]);
    }
    for (std::size_t c = 0; c < colours; ++c)
    {
      const double path = static_cast<double>(record[packed.channels == 1 ? 0 : c]) * unit;
      light.fluence[i * colours + c] = static_cast<float>(path / volume * packed.colour[c]);
    }
    record += packed.channels;
    light.count[i] = static_cast<float>(record[0]);
    for (int a = 0; a < 2; ++a)
    {
      PutMoments(
        record[0], record[1 + a], record[3 + a], light.originMean[2 * i + a], light.originDeviation[2 * i + a]);
    }
  }
}

}

PilotLight PilotGathering::Gather(const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins,
  const std::array<int, 3>& cells, const Monitor& monitor)
{
  const double start = ClockSeconds();
  const Domain& domain = this->TheDomain;
  const Grid& whole = domain.Whole();
  PackedPhotons all, own;
  PilotLight light;
  MarchSums into;
  Buffer<cl_long> memory;
  std::unique_ptr<MarchRun> run;
  domain.Collective([&] {
    CheckOrigins(photons, origins);
    all = Pack(photons, whole, this->Traits.Channels(this->Settings) == 3, MarchEventLimit(whole, this->Settings));
    light = DarkPilotLight(whole, cells, this->Traits.ColoursOf(all));
    into.records = light.grid.VoxelCount();
    into.numbers = all.channels + OriginNumbers;
    if (!this->Through)
    {
      return;
    }
    if (this->Cells != light.grid.size)
    {
      this->CellOfVoxel = this->Through->Cells(light.grid.size);
      this->Cells = light.grid.size;
    }
    own = ThoseIn(domain.Own(), whole, all);
    into.cells = &this->CellOfVoxel;
    into.shares = ShareSums(*this->Through, into.records, into.numbers, 1, 0);
    memory = Buffer<cl_long>(
      this->Through->device, into.Stride() * Count(into.shares.copies), "sums of the pilot photons' light");
    memory.Fill(0);
    into.sums = &memory;
    run = std::make_unique<MarchRun>(*this->Through, into, own.channels);
  });
  Rounds rounds(domain.Comm(), domain.Partition());
  rounds.UntilAllEnd<PhotonOnItsWay>(
    [&](int round, std::vector<PhotonOnItsWay>&& arrived, const Monitor& ofRound) {
      if (!run)
      {
        return std::vector<PhotonOnItsWay>();
      }
      return round == 0 ? run->Start(own, MarksOfOrigins(origins, own), ofRound).gone
                        : run->Resume(std::move(arrived), ofRound).gone;
    },
    monitor);
  std::vector<std::int64_t> sums(into.Stride(), 0);
  domain.Collective([&] { sums = run ? SumOfCopies(memory, into.Stride()) : sums; });
  const double diagonal = std::hypot(whole.spacing[0], whole.spacing[1], whole.spacing[2]);
  PutCells(SumExactly(domain.Comm(), sums), whole, all, all.unit * diagonal, light);
  light.leftOut = LeftOutOf(this->Traits, this->Settings, all);
  light.seconds = ClockSeconds() - start;
  return light;
}
}
