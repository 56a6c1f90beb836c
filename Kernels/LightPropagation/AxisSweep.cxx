#include "AxisSweep.h"

#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace tyndall
{
namespace
{
constexpr int MaxMembers = 8;
constexpr int RingRows = 4;
constexpr double SecondsPerLaunch = 0.08;
constexpr double SecondsPerRay = 1e-9; ///< a ray through a plane of voxels on a slow core: only sizes the launches
constexpr int PlanesPerRound = 128; ///< at least, when rays go round a periodic axis: a short one several times
constexpr double NothingLeft = 1e-7; ///< of what was on the way after the first time: not worth going round again

/// (1 - exp(-t)) / t = 1 + t (MeanLength[0] + t (MeanLength[1] + ...)), to 2e-8 for 0 <= t < Thin: a minimax polynomial.
constexpr int MeanLengthTerms = 5;
constexpr double MeanLength[MeanLengthTerms] = { -0.499999036, 0.166648826, -0.0415578957, 0.0080387554,
  -0.00101435666 };
constexpr double Thin = 0.75;

// As bundle_info, crossing_info, unit_info, plane_layout in SweepLayout.cl and Sweep.cl.
struct BundleOnDevice
{
  cl_int members, map, border, outside;
  cl_float power, cosine, sineU, sineV;
  cl_int move[MaxMembers][4];
};
using BundleMaps = cl_int2; ///< members, first float of the maps
struct CrossingOnDevice
{
  cl_int stages, moveU[3], moveV[3];
  cl_float length[3];
};
struct UnitOnDevice
{
  cl_int backward, firstBundle, bundles, scratch;
};
struct LayoutOnDevice
{
  cl_int sizeU, sizeV, sizeP, stepU, stepV, stepP, width, block;
  cl_float vacuum, thin, meanLength[MeanLengthTerms];
};
struct OwnLightOnDevice
{
  cl_float length, terms[MeanLengthTerms];
};

int RoundUp(int value, int multiple)
{
  return (value + multiple - 1) / multiple * multiple;
}

/// Floats of a padded row: an odd number of vectors, so that rows do not fall on the same cache lines, and one of few
/// numbers, since kernels are compiled for each.
int RowFloats(int width, int vector)
{
  int vectors = 2;
  while (vectors * vector < width)
  {
    vectors *= 2;
  }
  return (vectors + 1) * vector;
}

/// Bundles of 1, 2, 4 or 8 members: what the kernels are compiled for.
std::vector<Bundle> InPowersOfTwo(const std::vector<Bundle>& bundles)
{
  std::vector<Bundle> parts;
  for (const Bundle& bundle : bundles)
  {
    std::size_t first = 0;
    while (first < bundle.members.size())
    {
      std::size_t count = MaxMembers;
      while (count > bundle.members.size() - first)
      {
        count /= 2;
      }
      Bundle part = bundle;
      part.members.assign(bundle.members.begin() + first, bundle.members.begin() + first + count);
      parts.push_back(part);
      first += count;
    }
  }
  return parts;
}

template <class T>
cl_int Int(T value)
{
  return static_cast<cl_int>(value);
}
}

struct AxisSweep::Implementation
{
  Device& TheDevice;
  Grid TheGrid;
  PlaneAxes Axes;
  std::vector<Bundle> Bundles;
  int Channels;
  std::array<bool, 3> Periodic;
  bool Forward = false;
  bool Backward = false;

  int Vector = 8;
  int Row = 0;
  LayoutOnDevice Layout = {};
  std::vector<BundleOnDevice> BundleRows;
  std::vector<UnitOnDevice> Units;
  std::vector<cl_int2> Schedule; ///< [launch][unit]
  int Launches = 0;
  int Laps = 1; ///< times that a sweep's rays start anew on a short periodic axis, so that their pattern has room
  std::vector<cl_int2> RoundSchedule; ///< for going round a periodic axis, one unit at a time
  std::size_t MapsEachWay = 0;
  std::size_t OutsideEachWay = 0;
  std::size_t RadianceEachWay = 0;

  Buffer<float> Maps, Outside, Radiance, Scratch, Tally, Sums;
  Buffer<BundleOnDevice> BundleBuffer;
  Buffer<BundleMaps> MapBuffer;
  Buffer<UnitOnDevice> UnitBuffer;
  Buffer<cl_int2> ScheduleBuffer, RoundScheduleBuffer;
  Buffer<CrossingOnDevice> FirstCrossings;
  Buffer<OwnLightOnDevice> FirstOwnLight;

  Implementation(Device& device, const Grid& grid, int axis, std::vector<Bundle> bundles, int channels,
    const std::array<bool, 3>& periodic)
    : TheDevice(device)
    , TheGrid(grid)
    , Axes(AcrossAxis(axis))
    , Bundles(InPowersOfTwo(bundles))
    , Channels(channels)
    , Periodic(periodic)
  {
    for (const Bundle& bundle : this->Bundles)
    {
      for (const Member& member : bundle.members)
      {
        this->Forward = this->Forward || member.direction >= 0;
        this->Backward = this->Backward || member.opposite >= 0;
      }
    }
    this->Vector = device.FloatVectorWidth() >= 16 ? 16 : device.FloatVectorWidth() >= 8 ? 8 : 4;
    this->LayLaps();
    this->LayPlane();
    this->LayBundles();
    this->LayUnits();
    this->LaySchedule();
    this->LayRounds();
    this->Allocate();
  }

  int Planes() const { return this->TheGrid.size[this->Axes.axis]; }

  int PatternPlanes() const { return this->Planes() * this->Laps; } ///< that the rays of a sweep start in

  /// On a periodic axis of few planes the rays that start in them would all cross in one and the same way. Let them start
  /// in several laps instead, each with its part of the power.
  void LayLaps()
  {
    if (this->Periodic[this->Axes.axis])
    {
      this->Laps = (PlanesPerRound + this->Planes() - 1) / this->Planes();
    }
    for (Bundle& bundle : this->Bundles)
    {
      bundle.power /= this->Laps;
    }
  }

  void LayPlane()
  {
    const std::array<int, 3>& n = this->TheGrid.size;
    const std::array<int, 3> step = { 1, n[0], n[0] * n[1] };
    const int width = RoundUp(n[this->Axes.u], this->Vector);
    this->Row = RowFloats(width, this->Vector);
    this->Layout = { n[this->Axes.u], n[this->Axes.v], n[this->Axes.axis], step[this->Axes.u], step[this->Axes.v],
      step[this->Axes.axis], width, this->Axes.u == 0 ? 1 : this->Vector,
      static_cast<float>(std::max(1e-30 / this->LongestWay(), 1e-37)), static_cast<float>(Thin / this->LongestSegment()),
      {} };
    std::copy(MeanLength, MeanLength + MeanLengthTerms, this->Layout.meanLength);
  }

  void LayBundles()
  {
    for (const Bundle& bundle : this->Bundles)
    {
      const int members = Int(bundle.members.size());
      const double cosine = this->TheGrid.spacing[this->Axes.axis] / bundle.length;
      const auto sine = [&](double tangent, int aside) {
        return tangent * this->TheGrid.spacing[aside] / this->TheGrid.spacing[this->Axes.axis] * cosine;
      };
      BundleOnDevice row = { members, Int(this->MapsEachWay), Int(this->RadianceEachWay), Int(this->OutsideEachWay),
        static_cast<float>(bundle.power), static_cast<float>(cosine),
        static_cast<float>(sine(bundle.tangentU, this->Axes.u)), static_cast<float>(sine(bundle.tangentV, this->Axes.v)),
        {} };
      for (int m = 0; m < members; ++m)
      {
        const Member& member = bundle.members[m];
        const cl_int move[4] = { member.uFromU, member.uFromV, member.vFromU, member.vFromV };
        std::copy(move, move + 4, row.move[m]);
      }
      this->BundleRows.push_back(row);
      const std::size_t rowBlock = static_cast<std::size_t>(members) * this->Channels * this->Row;
      this->MapsEachWay += rowBlock * (this->Layout.sizeV + 2);
      this->OutsideEachWay += rowBlock;
      this->RadianceEachWay += static_cast<std::size_t>(members) * this->Channels;
    }
    this->MapsEachWay += this->Vector; // the last row's border
    this->OutsideEachWay += this->Vector;
  }

  /// Units that march at the same time: both ways, each in as many groups of bundles as keep the cores busy.
  void LayUnits()
  {
    const int ways = (this->Forward ? 1 : 0) + (this->Backward ? 1 : 0);
    const int groups = std::clamp(this->TheDevice.ComputeUnits() / std::max(ways, 1), 1,
      std::min<int>(4, static_cast<int>(this->Bundles.size())));
    std::size_t rays = 0;
    for (const Bundle& bundle : this->Bundles)
    {
      rays += bundle.members.size();
    }
    std::size_t done = 0;
    int first = 0;
    for (int g = 0; g < groups; ++g)
    {
      int end = first;
      while (end < Int(this->Bundles.size()) && (done * groups < rays * (g + 1) || g == groups - 1))
      {
        done += this->Bundles[end].members.size();
        ++end;
      }
      for (int way = 0; way < 2; ++way)
      {
        if (way == 0 ? this->Forward : this->Backward)
        {
          this->Units.push_back({ way, first, end - first, 0 });
        }
      }
      first = end;
    }
    for (std::size_t u = 0; u < this->Units.size(); ++u)
    {
      this->Units[u].scratch = Int(u * this->ScratchFloats());
    }
  }

  int QuantitiesPerPlane(bool netFlux) const { return 3 + this->Channels * (netFlux ? 5 : 2); }

  std::size_t ScratchFloats() const
  {
    const std::size_t ring = std::size_t{ 2 } * RingRows * MaxMembers * this->Channels * this->Row + this->Vector;
    const std::size_t planes =
      static_cast<std::size_t>(this->QuantitiesPerPlane(true)) * this->Layout.block * this->Layout.sizeV * this->Row;
    const std::size_t thinRows = static_cast<std::size_t>(this->Layout.block) * this->Layout.sizeV;
    return ring + planes + thinRows + 2 * this->Vector;
  }

  /// Cut the axis into slabs such that units never meet: a group enters two slabs behind the one before it, and forward
  /// and backward units, which come towards each other, are in slabs of different parity.
  void LaySchedule()
  {
    const int planes = this->Planes();
    const double perPlane = static_cast<double>(this->Layout.sizeU) * this->Layout.sizeV * this->RaysPerUnit() *
      this->Channels * SecondsPerRay;
    const int groups = this->Units.back().backward || !this->Backward || !this->Forward
      ? Int(this->Units.size()) / ((this->Forward ? 1 : 0) + (this->Backward ? 1 : 0))
      : 1;
    int slabs = std::max(static_cast<int>(std::ceil(perPlane * planes / SecondsPerLaunch)), groups > 1 ? 8 * groups : 2);
    slabs = std::max(2, RoundUp(std::min(slabs, planes), 2));
    std::vector<int> border(slabs + 1);
    for (int s = 0; s <= slabs; ++s)
    {
      const int even = static_cast<int>(static_cast<long>(planes) * s / slabs);
      border[s] = s == slabs ? planes : std::min(planes, RoundUp(even, planes >= 4 * this->Layout.block ? this->Layout.block : 1));
    }
    this->Launches = slabs + 2 * (groups - 1);
    for (int launch = 0; launch < this->Launches; ++launch)
    {
      int group = 0;
      int firstBundle = this->Units.front().firstBundle;
      for (const UnitOnDevice& unit : this->Units)
      {
        group += unit.firstBundle != firstBundle ? 1 : 0;
        firstBundle = unit.firstBundle;
        const int slab = launch - 2 * group;
        cl_int2 range = { { 0, 0 } };
        if (slab >= 0 && slab < slabs)
        {
          range = unit.backward ? cl_int2{ { planes - border[slabs - slab], planes - border[slabs - 1 - slab] } }
                                : cl_int2{ { border[slab], border[slab + 1] } };
        }
        this->Schedule.push_back(range);
      }
    }
  }

  void LayRounds()
  {
    const std::size_t units = this->Units.size();
    this->RoundSchedule.assign(units * units, cl_int2{ { 0, 0 } });
    for (std::size_t u = 0; u < units; ++u)
    {
      this->RoundSchedule[u * units + u] = { { 0, Int(this->PatternPlanes()) } };
    }
  }

  int RaysPerUnit() const
  {
    std::size_t most = 0;
    for (const UnitOnDevice& unit : this->Units)
    {
      std::size_t rays = 0;
      for (int b = unit.firstBundle; b < unit.firstBundle + unit.bundles; ++b)
      {
        rays += this->Bundles[b].members.size();
      }
      most = std::max(most, rays);
    }
    return Int(most);
  }

  void Allocate()
  {
    Device& device = this->TheDevice;
    this->Maps = Buffer<float>(device, 2 * this->MapsEachWay, "the light propagation maps");
    this->Outside = Buffer<float>(device, 2 * this->OutsideEachWay, "the light that comes in sideways");
    this->Radiance = Buffer<float>(device, 2 * this->RadianceEachWay, "the light that comes in sideways");
    this->Scratch = Buffer<float>(device, this->Units.size() * this->ScratchFloats(), "the planes being crossed");
    this->Tally =
      Buffer<float>(device, this->Units.size() * this->PatternPlanes() * 4 * this->Channels, "the power that leaves sideways");
    this->Sums = Buffer<float>(device, this->Bundles.size() * this->Layout.sizeV * this->Channels, "sums");
    this->BundleBuffer = Buffer<BundleOnDevice>(device, this->BundleRows, "the bundles of rays");
    std::vector<BundleMaps> maps;
    for (const BundleOnDevice& bundle : this->BundleRows)
    {
      maps.push_back({ { bundle.members, bundle.map } });
    }
    this->MapBuffer = Buffer<BundleMaps>(device, maps, "the bundles of rays");
    this->UnitBuffer = Buffer<UnitOnDevice>(device, this->Units, "the units of work");
    this->ScheduleBuffer = Buffer<cl_int2>(device, this->Schedule, "the schedule");
    this->RoundScheduleBuffer = Buffer<cl_int2>(device, this->RoundSchedule, "the schedule");
    this->FirstCrossings = Buffer<CrossingOnDevice>(device, this->Crossings(0, this->PatternPlanes()), "the ray pattern");
    this->FirstOwnLight = Buffer<OwnLightOnDevice>(device, this->OwnLight(), "the ray pattern");
    this->Scratch.Fill(0.0f);
    this->Maps.Fill(0.0f);
  }

  /// [plane][bundle], planes counted on from `firstPlane`.
  std::vector<CrossingOnDevice> Crossings(int firstPlane, int planes) const
  {
    std::vector<CrossingOnDevice> rows;
    for (int k = 0; k < planes; ++k)
    {
      for (const Bundle& bundle : this->Bundles)
      {
        const PlaneCrossing crossing = bundle.Crossing(firstPlane + k);
        CrossingOnDevice row = {};
        row.stages = crossing.count;
        for (int s = 0; s < crossing.count; ++s)
        {
          row.moveU[s] = crossing.segments[s].moveU;
          row.moveV[s] = crossing.segments[s].moveV;
          row.length[s] = static_cast<float>(crossing.segments[s].length);
        }
        rows.push_back(row);
      }
    }
    return rows;
  }

  /// [unit][plane]: (l - p1) / sigma = -l^2 (MeanLength[0] + sigma l (MeanLength[1] + ...)), summed over segments.
  std::vector<OwnLightOnDevice> OwnLight() const
  {
    std::vector<OwnLightOnDevice> rows;
    for (const UnitOnDevice& unit : this->Units)
    {
      for (int k = 0; k < this->PatternPlanes(); ++k)
      {
        std::array<double, MeanLengthTerms> terms = {};
        double sum = 0.0;
        for (int b = unit.firstBundle; b < unit.firstBundle + unit.bundles; ++b)
        {
          const Bundle& bundle = this->Bundles[b];
          const double power = bundle.power * static_cast<double>(bundle.members.size());
          const PlaneCrossing crossing = bundle.Crossing(k);
          for (int s = 0; s < crossing.count; ++s)
          {
            const double length = crossing.segments[s].length;
            sum += power * length;
            double term = -power * length * length;
            for (int i = 0; i < MeanLengthTerms; ++i, term *= length * this->Layout.thin)
            {
              terms[i] += term * MeanLength[i];
            }
          }
        }
        OwnLightOnDevice row = { static_cast<float>(sum), {} };
        std::copy(terms.begin(), terms.end(), row.terms);
        rows.push_back(row);
      }
    }
    return rows;
  }

  cl::Kernel SweepKernel(bool source, bool border, bool flux)
  {
    std::string options = "-DREAL_WIDTH=" + std::to_string(this->Vector) + " -DCHANNELS=" + std::to_string(this->Channels) +
      " -DROW=" + std::to_string(this->Row) + " -DSOURCE=" + std::to_string(source) + " -DBORDER=" +
      std::to_string(border) + " -DNET_FLUX=" + std::to_string(flux) + " -DPERIODIC_U=" +
      std::to_string(this->Periodic[this->Axes.u]) + " -DPERIODIC_V=" + std::to_string(this->Periodic[this->Axes.v]);
    std::string bundles;
    for (int members = 1; members <= MaxMembers; members *= 2)
    {
      const auto has = [&](const BundleOnDevice& bundle) { return bundle.members == members; };
      if (std::any_of(this->BundleRows.begin(), this->BundleRows.end(), has))
      {
        options += " -DMEMBERS_" + std::to_string(members);
        bundles += "#define MEMBERS " + std::to_string(members) + "\n" + std::string(kernel_source::SweepBundle) +
          "#undef MEMBERS\n";
      }
    }
    return this->TheDevice.Kernel("sweep",
      { kernel_source::Numerics, kernel_source::SweepLayout, bundles, kernel_source::Sweep }, options);
  }

  /// Through a plane.
  double LongestWay() const
  {
    double longest = 0.0;
    for (const Bundle& bundle : this->Bundles)
    {
      longest = std::max(longest, bundle.length);
    }
    return longest;
  }

  /// Through a voxel; of rays that go round it is not known before.
  double LongestSegment() const
  {
    if (this->Periodic[this->Axes.axis])
    {
      return this->LongestWay();
    }
    double longest = 0.0;
    for (const CrossingOnDevice& crossing : this->Crossings(0, this->PatternPlanes()))
    {
      longest = std::max<double>(longest, *std::max_element(crossing.length, crossing.length + crossing.stages));
    }
    return longest;
  }

  int FaceOf(int aside, int move) const { return 2 * aside + (move > 0 ? 0 : 1); } ///< a ray that moves up comes in below

  /// Write what comes in into the maps, the rows outside and the columns beside, and add up its power.
  void Enter(const Boundary& boundary, SweepTally& tally)
  {
    std::vector<float> maps(2 * this->MapsEachWay, 0.0f);
    std::vector<float> outside(2 * this->OutsideEachWay, 0.0f);
    std::vector<float> radiance(2 * this->RadianceEachWay, 0.0f);
    for (std::size_t b = 0; b < this->Bundles.size(); ++b)
    {
      const std::array<double, 2> crossings = this->SidewaysCrossings(this->Bundles[b]);
      for (int way = 0; way < 2; ++way)
      {
        for (int m = 0; m < this->BundleRows[b].members; ++m)
        {
          this->EnterMember(boundary, b, way, m, crossings, maps, outside, radiance, tally);
        }
      }
    }
    this->Maps.Write(maps.data());
    this->Outside.Write(outside.data());
    this->Radiance.Write(radiance.data());
  }

  void EnterMember(const Boundary& boundary, std::size_t b, int way, int m, const std::array<double, 2>& crossings,
    std::vector<float>& maps, std::vector<float>& outside, std::vector<float>& radiance, SweepTally& tally)
  {
    const Bundle& bundle = this->Bundles[b];
    const BundleOnDevice& row = this->BundleRows[b];
    const Member& member = bundle.members[m];
    const int direction = way == 0 ? member.direction : member.opposite;
    if (direction < 0)
    {
      return;
    }
    const bool swapped = member.uFromU == 0;
    const int faceU = this->FaceOf(this->Axes.u, member.uFromU + member.uFromV);
    const int faceV = this->FaceOf(this->Axes.v, member.vFromU + member.vFromV);
    const int faceP = 2 * this->Axes.axis + way;
    const auto power = [&](int face) {
      Rgb values = boundary(direction, face);
      for (double& value : values)
      {
        value *= this->Periodic[face / 2] ? 0.0 : static_cast<float>(bundle.power);
      }
      return values;
    };
    const Rgb fromU = power(faceU);
    const Rgb fromV = power(faceV);
    const Rgb fromP = power(faceP);
    const int rows = this->Layout.sizeV + 2;
    for (int c = 0; c < this->Channels; ++c)
    {
      const std::size_t rowInBlock = static_cast<std::size_t>(m * this->Channels + c) * this->Row + this->Vector;
      const std::size_t block = static_cast<std::size_t>(row.members) * this->Channels * this->Row;
      for (int v = 0; v < rows; ++v)
      {
        float* map = maps.data() + way * this->MapsEachWay + row.map + v * block + rowInBlock;
        std::fill(map, map + this->Layout.sizeU, static_cast<float>(fromP[c]));
        std::fill(map + this->Layout.sizeU, map + this->Layout.width, static_cast<float>(fromU[c]));
      }
      float* beyond = outside.data() + way * this->OutsideEachWay + row.outside + rowInBlock;
      std::fill(beyond - 1, beyond + this->Layout.width + 1, static_cast<float>(fromV[c]));
      radiance[way * this->RadianceEachWay + row.border + m * this->Channels + c] = static_cast<float>(fromU[c]);

      const double u = this->Layout.sizeU;
      const double v = this->Layout.sizeV;
      tally.in[faceP][c] += static_cast<float>(fromP[c]) * u * v;
      this->EnterSideways(bundle, crossings, swapped, static_cast<float>(fromU[c]), static_cast<float>(fromV[c]),
        tally.in[faceU][c], tally.in[faceV][c]);
    }
  }

  /// Rays come in where others left: one a row for each move along u, one a column for each move along v. A ray that moves
  /// both ways at once comes in through v's face where it starts beyond a row, else through u's.
  void EnterSideways(const Bundle& bundle, const std::array<double, 2>& crossings, bool swapped, float fromU, float fromV,
    double& inU, double& inV) const
  {
    const double u = this->Layout.sizeU;
    const double v = this->Layout.sizeV;
    const double movesU = crossings[swapped ? 1 : 0];
    const double movesV = crossings[swapped ? 0 : 1];
    inU += movesU * v * fromU;
    inV += movesV * u * fromV;
    const bool openU = !this->Periodic[this->Axes.u];
    const bool openV = !this->Periodic[this->Axes.v];
    const double together = this->DiagonalCrossings(bundle);
    if (openU && openV)
    {
      inU -= together * fromU; // the corner is one voxel, and takes the row's light
    }
  }

  /// Moves of a bundle along its own u and v over all planes.
  std::array<double, 2> SidewaysCrossings(const Bundle& bundle) const
  {
    std::array<double, 2> moves = {};
    for (int k = 0; k < this->PatternPlanes(); ++k)
    {
      const PlaneCrossing crossing = bundle.Crossing(k);
      for (int s = 1; s < crossing.count; ++s)
      {
        moves[0] += crossing.segments[s].moveU;
        moves[1] += crossing.segments[s].moveV;
      }
    }
    return moves;
  }

  double DiagonalCrossings(const Bundle& bundle) const
  {
    double moves = 0.0;
    for (int k = 0; k < this->PatternPlanes(); ++k)
    {
      const PlaneCrossing crossing = bundle.Crossing(k);
      for (int s = 1; s < crossing.count; ++s)
      {
        moves += crossing.segments[s].moveU * crossing.segments[s].moveV;
      }
    }
    return moves;
  }

  void EnterNothing()
  {
    if (!this->Periodic[this->Axes.axis]) // else they hold what is on the way from the sweep before
    {
      this->Maps.Fill(0.0f);
    }
    this->Outside.Fill(0.0f);
    this->Radiance.Fill(0.0f);
    this->Scratch.Fill(0.0f); // the columns beside the rows hold what came in last time
  }

  /// From where rays start to where they leave the axis for the first time, or the last lap ends.
  void Launch(const SweepVolume& volume, bool source, bool border, SweepTally& tally, const Monitor& monitor)
  {
    if (this->Laps == 1)
    {
      this->Launch(volume, source, border, this->FirstCrossings, this->ScheduleBuffer, this->Launches, tally, monitor);
    }
    else
    {
      this->Launch(volume, source, border, this->FirstCrossings, this->RoundScheduleBuffer, Int(this->Units.size()),
        tally, monitor);
    }
  }

  /// Rays that left a periodic axis come back on the other side, until next to nothing is on the way.
  void GoRound(const SweepVolume& volume, int mostPlanes, SweepTally& tally, const Monitor& monitor)
  {
    const auto onTheWay = [this]() {
      const Rgb up = this->PowerInMaps(0);
      const Rgb down = this->PowerInMaps(1);
      return Rgb{ up[0] + down[0], up[1] + down[1], up[2] + down[2] };
    };
    const auto sum = [](const Rgb& rgb) { return rgb[0] + rgb[1] + rgb[2]; };
    this->Outside.Fill(0.0f);
    this->Scratch.Fill(0.0f);
    tally.onTheWay = onTheWay();
    const double atFirst = sum(tally.onTheWay);
    for (int gone = this->PatternPlanes(); gone < mostPlanes && sum(tally.onTheWay) > NothingLeft * atFirst;
         gone += this->PatternPlanes())
    {
      const Buffer<CrossingOnDevice> crossings(
        this->TheDevice, this->Crossings(gone, this->PatternPlanes()), "the ray pattern");
      this->Launch(
        volume, false, false, crossings, this->RoundScheduleBuffer, Int(this->Units.size()), tally, monitor);
      tally.onTheWay = onTheWay();
    }
  }

  void Launch(const SweepVolume& volume, bool source, bool border, const Buffer<CrossingOnDevice>& crossings,
    const Buffer<cl_int2>& schedule, int launches, SweepTally& tally, const Monitor& monitor)
  {
    Device& device = this->TheDevice;
    this->Tally.Fill(0.0f);
    cl::Kernel kernel = this->SweepKernel(source, border, volume.flux != nullptr);
    const Buffer<float>& flux = volume.flux ? *volume.flux : *volume.path;
    for (int launch = 0; launch < launches; ++launch)
    {
      With(kernel, *volume.sigma_t, cl_ulong(volume.sigma_t_first), *volume.source, *volume.path, flux,
        cl_ulong(volume.first), cl_ulong(volume.stride), this->Maps, cl_ulong(this->MapsEachWay), this->Outside,
        cl_uint(this->OutsideEachWay), this->Radiance, cl_uint(this->RadianceEachWay), this->Scratch, this->UnitBuffer,
        this->BundleBuffer, Int(this->Bundles.size()), crossings, this->FirstOwnLight,
        Int(this->PatternPlanes()), schedule, launch,
        this->Tally, this->Layout, Int(this->Axes.axis));
      device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(this->Units.size()), cl::NDRange(1));
      device.Finish();
      Report(monitor, (launch + 1.0) / launches);
    }
    this->CountSideways(tally);
  }

  void CountSideways(SweepTally& tally) const
  {
    const std::vector<float> left = this->Tally.Read();
    const std::array<int, 4> faces = { 2 * this->Axes.u, 2 * this->Axes.u + 1, 2 * this->Axes.v, 2 * this->Axes.v + 1 };
    for (std::size_t i = 0; i < left.size(); ++i)
    {
      tally.out[faces[i / this->Channels % 4]][i % this->Channels] += left[i];
    }
  }

  /// Power in the maps of one way.
  Rgb PowerInMaps(int way)
  {
    cl::Kernel kernel = this->TheDevice.Kernel("map_power", { kernel_source::Numerics, kernel_source::Collect });
    With(kernel, this->Maps, cl_ulong(way * this->MapsEachWay), this->MapBuffer, this->Layout.sizeV, Int(this->Channels),
      Int(this->Row), Int(this->Vector), this->Layout.sizeU, this->Sums);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(this->Layout.sizeV, this->Bundles.size()), cl::NDRange(1, 1));
    Rgb power = {};
    const std::vector<float> sums = this->Sums.Read();
    for (std::size_t i = 0; i < sums.size(); ++i)
    {
      power[i % this->Channels] += sums[i];
    }
    return power;
  }
};

AxisSweep::AxisSweep(Device& device, const Grid& grid, int axis, std::vector<Bundle> bundles, int channels,
  const std::array<bool, 3>& periodic)
  : Inner(std::make_unique<Implementation>(device, grid, axis, std::move(bundles), channels, periodic))
{
}

AxisSweep::~AxisSweep() = default;

int AxisSweep::DirectionCount() const
{
  int count = 0;
  for (const Bundle& bundle : this->Inner->Bundles)
  {
    for (const Member& member : bundle.members)
    {
      count += (member.direction >= 0 ? 1 : 0) + (member.opposite >= 0 ? 1 : 0);
    }
  }
  return count;
}

SweepTally AxisSweep::Run(const SweepVolume& volume, const Boundary& boundary, bool hasSource, int mostPlanes,
  const Monitor& monitor)
{
  Implementation& self = *this->Inner;
  SweepTally tally;
  if (boundary)
  {
    self.Enter(boundary, tally);
  }
  else
  {
    self.EnterNothing();
  }
  self.Launch(volume, hasSource, static_cast<bool>(boundary), tally, monitor);

  const int axis = self.Axes.axis;
  if (self.Periodic[axis])
  {
    self.GoRound(volume, mostPlanes, tally, monitor);
    return tally;
  }
  for (int way = 0; way < 2; ++way)
  {
    const Rgb power = self.PowerInMaps(way);
    for (int c = 0; c < self.Channels; ++c)
    {
      tally.out[2 * axis + 1 - way][c] += power[c];
    }
  }
  return tally;
}
}
