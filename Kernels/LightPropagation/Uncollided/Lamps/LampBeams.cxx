#include "LightPropagation/Uncollided/Lamps/LampBeams.h"

#include "Device/Device.h"
#include "Distribution/Halo.h"
#include "Distribution/Rounds.h"
#include "LightPropagation/Uncollided/Lamps/LampOnGrid.h"
#include "LightPropagation/Uncollided/Lamps/LampPyramids.h"
#include "LightPropagation/Uncollided/Lamps/LampSums.h"
#include "Medium/BoxFaces.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

namespace tyndall
{
static const int* WhereIs(const BeamOnItsWay& beam)
{
  return beam.voxel;
}

namespace
{
/// Number of rows of beams per launch. A launch with rows of a thousand voxels then takes well below a tenth of a
/// second.
constexpr int RowsPerLaunch = 256;
/// If rows have fewer than this number of beams, a launch traces proportionally more than RowsPerLaunch rows
constexpr int BeamsOfRow = 64;
constexpr std::size_t BeamsPerLaunch = 1 << 14; ///< beams per launch when they are traced in a block
/// Width of the halo, voxels: a beam traced in a block may extend one voxel beyond it, and by rounding one more.
constexpr int Reach = 2;

/// Maximum number of passes along periodic axes; each pass traces a range of layers (LampPyramids.h)
constexpr int PassesAtMost = 9;
/// Number of passes after which the remaining light of a box that is periodic along all axes is distributed uniformly.
constexpr int EvenFrom = 3;
constexpr double LeftAtMost = 5e-5; ///< passes end when at most this fraction of the power is in transit

/// Function that traces the beams of a pass and adds their energy balance to the argument `shares` of FollowInPasses().
/// @param factor  multiplies the initial power of the beams
using FollowPass = std::function<void(const Pass& pass, double factor, const Monitor& monitor)>;

/// Traces a lamp's light around periodic axes in passes (numerics.md, section 5.3): beams that are still in the box at
/// the end of a pass are replaced by fewer beams, which share their power.
/// @param shares  energy balance of the lamp's beams over all passes so far, as fractions of the traced power; updated
///   by `follow`
/// @return fraction of the traced power to be distributed uniformly over a box that is periodic along all axes; else 0
double FollowInPasses(const Grid& grid, const std::array<bool, 3>& periodic, LampShares& shares,
  const FollowPass& follow, const Monitor& monitor)
{
  Pass pass = FirstPass(grid);
  follow(pass, 1.0, OfPart(monitor, 0.0, 0.5));
  const bool endless = periodic[0] && periodic[1] && periodic[2];
  const int most = endless ? EvenFrom : PassesAtMost;
  for (int done = 1; done < most && shares.onTheWay > LeftAtMost * shares.shone; ++done)
  {
    const Monitor ofPass = OfPart(monitor, 1.0 - std::exp2(-done), 1.0 - std::exp2(-done - 1));
    const double wanted = std::exchange(shares.onTheWay, 0.0);
    pass = pass.Next();
    // Traces the new beams only up to the layer where the pass begins, to determine the power that they have left
    // there.
    follow({ pass.begin, pass.end, true }, 1.0, {});
    const double found = std::exchange(shares.onTheWay, 0.0);
    if (!(found > 0.0))
    {
      shares.onTheWay = wanted;
      break;
    }
    follow(pass, wanted / found, ofPass);
  }
  return endless ? std::exchange(shares.onTheWay, 0.0) : 0.0;
}

/// Voxel of the grid nearest to a beam's start, which decides which rank traces the beam first. An approximation
/// suffices: a rank computes the first step of a beam that it receives even if that starts in a neighbouring block.
std::array<int, 3> FirstVoxel(const BeamRow& row, int beam, const Grid& grid, const std::array<bool, 3>& periodic)
{
  const double begins[] = { row.startU + static_cast<double>(beam) * row.openU, row.startV };
  std::array<double, 3> place = {};
  place[row.axis] = row.up ? std::floor(row.from + 1e-6) : std::ceil(row.from - 1e-6) - 1.0;
  for (int k = 0; k < 2; ++k)
  {
    const int aside = (row.axis + 1 + k) % 3;
    place[aside] = std::floor(begins[k]);
    place[aside] -= periodic[aside] ? std::floor(place[aside] / grid.size[aside]) * grid.size[aside] : 0.0;
  }
  std::array<int, 3> voxel = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    voxel[axis] = static_cast<int>(std::clamp(place[axis], 0.0, grid.size[axis] - 1.0));
  }
  return voxel;
}

/// Extinction sigma_t of a volume's voxels and of their halo, 1/length. Collective.
Buffer<float> WithHalo(Device& device, const Domain& domain, const SweepVolume& volume, const Halo& halo)
{
  std::vector<float> own(volume.grid.VoxelCount());
  domain.Collective([&] {
    if (!domain.IsEmpty())
    {
      const std::vector<float> all = volume.sigma_t->Read();
      std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(volume.sigma_t_first), own.size(), own.begin());
    }
  });
  const std::vector<float> stored = halo.Spread(own, 1);
  Buffer<float> values;
  domain.Collective([&] { values = Buffer<float>(device, stored, "sigma_t around a block"); });
  return values;
}

/// Tracer of the beams of one lamp on one rank, from all points that represent the lamp.
class LampBeams
{
public:
  LampBeams(Device& device, const Domain& domain, const SweepVolume& volume, const Light& light,
    const std::array<bool, 3>& periodic);

  SweepTally Run(const Monitor& monitor);

private:
  using Rows = std::vector<BeamRow>;
  using Beams = std::vector<BeamOnItsWay>;

  const VoxelBox& Box() const { return this->Stored.Known(); }
  void FollowPoints(const Pass& pass, double factor, const Monitor& monitor);
  void FollowRows(const Rows& rows, LampShares& found, const Monitor& monitor);
  void FollowInRounds(const Rows& rows, LampShares& found, const Monitor& monitor);
  Beams Starting(const Rows& rows) const;
  Beams FollowInBlock(
    const Rows& rows, const Buffer<BeamRow>& onDevice, const Beams& beams, LampShares& found, const Monitor& monitor);
  void Launch(const Buffer<float>& sigmaT, std::size_t sigmaFirst, const Buffer<BeamRow>& rows,
    const Buffer<BeamOnItsWay>& beams, std::size_t first, std::size_t count, const Buffer<float>& sums);
  std::size_t RowsTogether(const BeamRow& row) const;
  std::size_t BeamsTogether(const BeamRow& row) const;
  void AddToOwners();
  std::vector<cl_long> CellsOfAll() const;
  LampFactors AddToDeposit(double even);

  Device& TheDevice;
  const Domain& TheDomain;
  const SweepVolume& Volume;
  const LampOnGrid Lamp;
  const Halo Stored;     ///< voxels in which this rank sums deposits while beams are traced: its block and the halo
  tyndall::Rounds Ranks; ///< exchange of beams between blocks
  /// Extinction sigma_t of the stored voxels; empty on a single rank, which uses the volume's own array
  Buffer<float> SigmaT;
  std::unique_ptr<LampSums> Sums;
  cl::Kernel Kernel;
  LampShares Shares; ///< energy balance of the beams of all ranks, over all passes
};

LampBeams::LampBeams(Device& device, const Domain& domain, const SweepVolume& volume, const Light& light,
  const std::array<bool, 3>& periodic)
  : TheDevice(device)
  , TheDomain(domain)
  , Volume(volume)
  , Lamp(light, domain.Whole(), periodic)
  , Stored(domain.Comm(), domain.Partition(), periodic, domain.IsSerial() ? 0 : Reach)
  , Ranks(domain.Comm(), domain.Partition(), 1, periodic)
{
  const bool serial = domain.IsSerial();
  if (!serial)
  {
    this->SigmaT = WithHalo(device, domain, volume, this->Stored);
  }
  domain.Collective([&] {
    const std::size_t stride = serial ? volume.stride : this->Box().VoxelCount();
    this->Sums = std::make_unique<LampSums>(device, this->Lamp, volume.deposit, stride, domain.Whole());
    this->Kernel = this->Lamp.Kernel(device, "follow_lamp", kernel_source::LampBeams, volume.deposit, !serial);
  });
}

SweepTally LampBeams::Run(const Monitor& monitor)
{
  const FollowPass follow = [this](const Pass& pass, double factor, const Monitor& ofPass) {
    this->FollowPoints(pass, factor, ofPass);
  };
  const double even = FollowInPasses(this->TheDomain.Whole(), this->Stored.Periodic(), this->Shares, follow, monitor);
  if (!this->TheDomain.IsSerial())
  {
    this->AddToOwners();
  }
  const LampFactors factors = this->AddToDeposit(even);
  return this->Shares.Times(this->Lamp.TheLight().power, this->Volume.channels, factors);
}

void LampBeams::FollowPoints(const Pass& pass, double factor, const Monitor& monitor)
{
  const std::vector<LampPoint>& points = this->Lamp.PointsOf(pass);
  const double all = static_cast<double>(points.size());
  LampShares found; // energy balance of this rank's beams
  for (std::size_t p = 0, next; p < points.size(); p = next)
  {
    const Rows rows = this->Lamp.Rows(pass, factor, p, next);
    const Monitor ofRows = OfPart(monitor, p / all, next / all);
    this->TheDomain.IsSerial() ? this->FollowRows(rows, found, ofRows) : this->FollowInRounds(rows, found, ofRows);
  }
  this->Shares.Add(found.SumOver(this->TheDomain));
}

/// Runs the kernel follow_lamp of LampBeams.cl for some rows of beams or, on several ranks, for some beams.
void LampBeams::Launch(const Buffer<float>& sigmaT, std::size_t sigmaFirst, const Buffer<BeamRow>& rows,
  const Buffer<BeamOnItsWay>& beams, std::size_t first, std::size_t count, const Buffer<float>& sums)
{
  With(this->Kernel, this->Lamp.Describe(this->Box(), this->TheDomain.Own()), sigmaT, cl_ulong(sigmaFirst),
    this->Sums->Sums(), cl_ulong(this->Sums->Stride()), this->Sums->Cells(), rows, beams, cl_int(first), cl_int(count),
    sums);
  this->TheDevice.Queue().enqueueNDRangeKernel(this->Kernel, cl::NullRange,
    cl::NDRange(LampOnGrid::HasAtomics(this->TheDevice) ? count : 1), GroupOfLargeItems(this->TheDevice));
  this->TheDevice.Finish();
}

/// Traces rows of beams through the whole domain.
void LampBeams::FollowRows(const Rows& rows, LampShares& found, const Monitor& monitor)
{
  if (rows.empty())
  {
    return;
  }
  const Buffer<BeamRow> onDevice(this->TheDevice, rows, "the beams of a lamp");
  const Buffer<float> sums(this->TheDevice, rows.size() * LampRowSums, "sums");
  for (std::size_t first = 0, count; first < rows.size(); first += count)
  {
    count = std::min(this->RowsTogether(rows[first]), rows.size() - first);
    this->Launch(*this->Volume.sigma_t, this->Volume.sigma_t_first, onDevice, {}, first, count, sums);
    Report(monitor, static_cast<double>(first + count) / static_cast<double>(rows.size()));
  }
  const std::vector<float> tallies = sums.Read();
  for (std::size_t r = 0; r < rows.size(); ++r)
  {
    found.Count(rows[r], tallies.data() + r * LampRowSums);
  }
}

/// Traces rows of beams from block to block until no rank has any beams left. Collective.
void LampBeams::FollowInRounds(const Rows& rows, LampShares& found, const Monitor& monitor)
{
  Buffer<BeamRow> onDevice;
  this->Ranks.UntilAllEnd<BeamOnItsWay>(
    [&](int round, Beams&& arrived, const Monitor& ofRound) {
      if (round == 0)
      {
        arrived = this->Starting(rows);
        onDevice = Buffer<BeamRow>(this->TheDevice, rows, "the beams of a lamp");
      }
      return this->FollowInBlock(rows, onDevice, arrived, found, ofRound);
    },
    monitor);
}

/// Beams that start in this rank's block.
LampBeams::Beams LampBeams::Starting(const Rows& rows) const
{
  Beams own;
  for (std::size_t r = 0; r < rows.size(); ++r)
  {
    for (int b = 0; b < rows[r].count; ++b)
    {
      const std::array<int, 3> voxel = FirstVoxel(rows[r], b, this->TheDomain.Whole(), this->Stored.Periodic());
      if (Holds(this->TheDomain.Own(), voxel.data()))
      {
        own.push_back({ static_cast<cl_int>(r), b, 0, 0, 0, 0.0f, 0.0f, {}, 0.0f, {}, 0 });
      }
    }
  }
  return own;
}

/// Traces beams through this rank's block.
/// @return beams that have left this block for another
LampBeams::Beams LampBeams::FollowInBlock(
  const Rows& rows, const Buffer<BeamRow>& onDevice, const Beams& beams, LampShares& found, const Monitor& monitor)
{
  Beams gone;
  for (std::size_t first = 0, count; first < beams.size(); first += count)
  {
    count = std::min(this->BeamsTogether(rows[beams[first].row]), beams.size() - first);
    const Buffer<BeamOnItsWay> some(this->TheDevice, beams.data() + first, count, "beams");
    const Buffer<float> sums(this->TheDevice, count * LampRowSums, "sums");
    this->Launch(this->SigmaT, 0, onDevice, some, 0, count, sums);
    const Beams after = some.Read();
    const std::vector<float> tallies = sums.Read();
    for (std::size_t b = 0; b < count; ++b)
    {
      found.Count(rows[after[b].row], tallies.data() + b * LampRowSums);
      if (!after[b].ended)
      {
        gone.push_back(after[b]);
      }
    }
    Report(monitor, static_cast<double>(first + count) / static_cast<double>(beams.size()));
  }
  return gone;
}

/// Number of rows of beams per launch, fewer if beams travel far around a periodic axis.
std::size_t LampBeams::RowsTogether(const BeamRow& row) const
{
  const double layers = this->Stored.Periodic()[row.axis] ? static_cast<double>(row.count) * row.layers : 1.0;
  const double most = static_cast<double>(RowsPerLaunch) * std::max(BeamsOfRow / row.count, 1);
  return static_cast<std::size_t>(std::clamp(LampOnGrid::LayersPerLaunch / layers, 1.0, most));
}

/// Number of beams per launch, fewer if beams travel far around a periodic axis within the block.
std::size_t LampBeams::BeamsTogether(const BeamRow& row) const
{
  const bool all = this->TheDomain.Own().size[row.axis] == this->TheDomain.Whole().size[row.axis];
  const double layers = all && this->Stored.Periodic()[row.axis] ? row.layers : 1.0;
  const double most = static_cast<double>(BeamsPerLaunch);
  return static_cast<std::size_t>(std::clamp(LampOnGrid::LayersPerLaunch / layers, 1.0, most));
}

/// Replaces the sums of all stored voxels, to which only this rank's beams have contributed, by sums of this rank's own
/// voxels, to which the beams of all ranks have contributed. Collective.
void LampBeams::AddToOwners()
{
  std::vector<cl_long> found, own;
  this->TheDomain.Collective([&] { found = this->Sums->Sums().Read(); });
  // A rank without voxels may have a deposit with fewer arrays than the other ranks; the maximum counts the arrays of
  // the other ranks.
  const int parts = static_cast<int>(this->TheDomain.Max(LampSums::Parts(this->Lamp, this->Volume.deposit)));
  const std::size_t count = this->Box().VoxelCount();
  for (int part = 0; part < parts; ++part)
  {
    const auto begin = found.begin() + static_cast<std::ptrdiff_t>(part * count);
    const std::vector<std::int64_t> inBlock =
      this->Stored.Gather({ begin, begin + static_cast<std::ptrdiff_t>(count) });
    own.insert(own.end(), inBlock.begin(), inBlock.end());
    own.resize((part + 1) * this->Volume.stride, 0);
  }
  const std::vector<cl_long> cells = this->CellsOfAll();
  this->TheDomain.Collective([&] {
    this->Sums = std::make_unique<LampSums>(
      this->TheDevice, this->Lamp, this->Volume.deposit, this->Volume.stride, this->TheDomain.Whole());
    this->Sums->Sums().Write(own.data());
    if (!cells.empty())
    {
      this->Sums->Cells().Write(cells.data());
    }
  });
}

/// Escaped power per cell of the domain's faces, in fixed point (LampPowerUnits), summed over ranks; empty if it is
/// not summed. Collective.
std::vector<cl_long> LampBeams::CellsOfAll() const
{
  if (!this->Volume.deposit.faceOut)
  {
    return {};
  }
  std::vector<double> values;
  this->TheDomain.Collective([&] {
    const std::vector<cl_long> own = this->Sums->Cells().Read();
    values.assign(own.begin(), own.end());
  });
  values = this->TheDomain.Sum(values);
  return { values.begin(), values.end() };
}

/// Adds the sums of this rank's voxels to the deposit. Collective.
/// @param even  fraction of the traced power to be distributed uniformly
LampFactors LampBeams::AddToDeposit(double even)
{
  const Domain& domain = this->TheDomain;
  double taken = 0.0, extinction = 0.0;
  domain.Collective([&] {
    taken = this->Sums->FitToVacuum(this->Volume, this->Lamp, domain.Own());
    extinction = even > 0.0 ? Extinction(this->Volume) : 0.0;
  });
  taken = domain.Sum(taken);
  extinction = domain.Sum(extinction);
  const LampFactors factors = this->Lamp.Factors(this->Shares, taken, even);
  domain.Collective([&] {
    this->Sums->AddTo(this->Volume, this->Lamp, factors.taken);
    if (this->Volume.deposit.faceOut)
    {
      const std::size_t faceFirst = this->Volume.firstChannel * BoxFaceCellCount(domain.Whole());
      this->Sums->AddCellsTo(this->Volume, faceFirst, this->Lamp, factors.out);
    }
    this->Sums->SpreadEvenly(this->Volume, this->Lamp, factors.out * even, extinction);
    this->TheDevice.Finish(); // the kernels must end before the sums are released
  });
  this->Shares.onTheWay += extinction > 0.0 ? 0.0 : even; // the power remains in transit if no voxel removes it
  return factors;
}
}

SweepTally DepositLamp(Device& device, const Domain& domain, const SweepVolume& volume, const Light& light,
  const std::array<bool, 3>& periodic, const Monitor& monitor)
{
  return LampBeams(device, domain, volume, light, periodic).Run(monitor);
}
}
