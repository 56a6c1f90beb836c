#include "LightPropagation/Sweep/SweepPlan.h"

#include "Device/Sizes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace tyndall
{
namespace
{
constexpr double SecondsPerLaunch = 0.08;
/// Time per ray and voxel on a slow core, s; only determines the size of launches
constexpr double SecondsPerRay = 1e-9;
/// Magnitude below which an angular function (of mean square 1) is taken as zero
constexpr double ZeroFunction = 1e-6;
/// Maximum number of groups of bundles that march concurrently in the same sense. Each group follows two slabs (ranges
/// of planes) behind the previous group, so that two groups never cross the same planes at the same time.
constexpr int MostGroups = 4;

/// Coefficients of (1 - exp(-t)) / t = 1 + t (MeanLength[0] + t (MeanLength[1] + ...)), a minimax polynomial with an
/// error of 2e-8 for 0 <= t < Thin.
constexpr double MeanLength[MeanLengthTerms] = { -0.499999036, 0.166648826, -0.0415578957, 0.0080387554,
  -0.00101435666 };
constexpr double Thin = 0.75;

template <class T>
cl_int Int(T value)
{
  return static_cast<cl_int>(value);
}

/// Number of floats in a padded row. It is an odd number of vectors, so that rows do not map to the same cache sets.
/// Only a few sizes are used, because kernels are compiled for each size, which takes seconds.
int RowFloats(int width, int vector)
{
  int vectors = ShortestRow / vector;
  while (vectors * vector < width)
  {
    vectors *= 2;
  }
  return (vectors + 1) * vector;
}

/// Splits bundles of rays into bundles of 1, 2, 4 or 8 members (directions), the numbers for which the kernels are
/// compiled.
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

bool IsSwapped(const Member& member)
{
  return member.uFromU == 0;
}

/// Sorts the members of each bundle such that members whose directions differ only in the signs of u and v are
/// adjacent.
void SortIntoFrames(std::vector<Bundle>& bundles)
{
  for (Bundle& bundle : bundles)
  {
    std::stable_partition(
      bundle.members.begin(), bundle.members.end(), [](const Member& member) { return !IsSwapped(member); });
  }
}

/// Maximum length of a ray's path through one plane of voxels.
double LongestWay(const std::vector<Bundle>& bundles)
{
  double longest = 0.0;
  for (const Bundle& bundle : bundles)
  {
    longest = std::max(longest, bundle.length);
  }
  return longest;
}
}

SweepDescription Describe(const SweepVolume& volume, const std::array<bool, 3>& periodic)
{
  return { volume.grid, volume.box, periodic, volume.channels, volume.deposit.flux != nullptr,
    volume.deposit.partialCurrents != nullptr, volume.angular, volume.moments, volume.faceIn != nullptr,
    volume.octantSource != nullptr };
}

SweepPlan::SweepPlan(const Device& device, const SweepDescription& sweep, const AxisBundles& rays)
  : SweepDescription(sweep)
  , axes(AcrossAxis(rays.axis))
  , bundles(InPowersOfTwo(rays.bundles))
  , order(sweep.angular ? sweep.angular->degree : 0, AcrossAxis(rays.axis).u, AcrossAxis(rays.axis).v)
{
  this->box = sweep.box.VoxelCount() > 0 ? sweep.box : VoxelBox{ { 0, 0, 0 }, sweep.grid.size };
  if (this->angular)
  {
    SortIntoFrames(this->bundles);
  }
  for (const Bundle& bundle : this->bundles)
  {
    for (const Member& member : bundle.members)
    {
      this->forward = this->forward || member.direction >= 0;
      this->backward = this->backward || member.opposite >= 0;
    }
  }
  this->LayLaps();
  this->LayPlane(device);
  this->LayBundles();
  if (this->angular)
  {
    this->LayMoments();
    this->LayFrames();
  }
  this->LayUnits(device.ComputeUnits());
  this->LaySchedule();
  this->LayRounds();
}

/// Determines the number of laps around a short periodic axis in which rays start. Rays that start in its few planes
/// would all move sideways in the same planes, so they start in several laps, each with a fraction of the power
/// (numerics.md, section 4.6).
void SweepPlan::LayLaps()
{
  this->laps = PlanesOfPattern(this->Planes(), this->periodic[this->axes.axis]) / this->Planes();
  for (Bundle& bundle : this->bundles)
  {
    bundle.power /= this->laps;
  }
}

void SweepPlan::LayPlane(const Device& device)
{
  this->vector = device.KernelWidth(4, 16, 4);
  const std::array<int, 3>& n = this->box.size;
  const std::array<int, 3>& first = this->box.first;
  const std::array<int, 3> step = { 1, this->grid.size[0], this->grid.size[0] * this->grid.size[1] };
  const int width = RoundUp(n[this->axes.u], this->vector);
  this->row = RowFloats(width, this->vector);
  this->plane.sizeU = n[this->axes.u];
  this->plane.sizeV = n[this->axes.v];
  this->plane.sizeP = n[this->axes.axis];
  this->plane.firstU = first[this->axes.u];
  this->plane.firstV = first[this->axes.v];
  this->plane.firstP = first[this->axes.axis];
  this->plane.stepU = step[this->axes.u];
  this->plane.stepV = step[this->axes.v];
  this->plane.stepP = step[this->axes.axis];
  this->plane.width = width;
  this->plane.currents = this->partialCurrents;
  // Number of quantities per channel: source, path integral and beams; also net flux, partial currents and octant
  // sources if used.
  const int ofChannel = 2 + (this->angular ? this->angular->Beams() : 0) + (this->netFlux ? 3 : 0) +
    (this->partialCurrents ? CurrentFaces : 0) + (this->octantSource ? WaysAside : 0);
  this->plane.quantities = PlaneSource + ofChannel * this->channels;
  this->plane.block = this->axes.u == 0 ? 1 : this->vector;
  this->plane.chained = this->PlanesChained(device);
  this->plane.tile = this->plane.chained > 1 ? RowsOfChain : 0;
  this->plane.together = std::max(this->plane.block, this->plane.chained);
  // At most BundlesTogether bundles cross a tile of rows in one call. If there are no more bundles, rows are packed
  // (copied to scratch) just before the bundles cross them, and are then still in the cache.
  const bool inOneTurn = this->plane.tile > 0 && this->bundles.size() <= BundlesTogether;
  this->rowsKept = inOneTurn && this->plane.block == 1 && this->plane.sizeV > RowsOfChainKept ? RowsOfChainKept : 0;
  this->plane.vacuum = static_cast<float>(std::max(1e-30 / LongestWay(this->bundles), 1e-37));
  this->plane.thin = static_cast<float>(Thin / this->LongestSegment());
  std::copy(MeanLength, MeanLength + MeanLengthTerms, this->plane.meanLength);
}

/// Number of planes in a chain. If a bundle's rays in a plane exceed a core's cache, it crosses several planes
/// together, row by row, so that rays are read from memory and written to it only once for all of these planes.
int SweepPlan::PlanesChained(const Device& device) const
{
  const int ofRow = this->plane.width + this->vector; // floats of a row that are used
  const std::size_t rays = static_cast<std::size_t>(MaxMembers) * this->channels * ofRow * this->plane.sizeV;
  const bool alone = this->angular || this->faceIn || this->periodic[this->axes.u] || this->periodic[this->axes.v];
  return !alone && sizeof(float) * rays > device.CacheBytes() ? MostChained : 1;
}

void SweepPlan::LayMoments()
{
  if (this->box.size[0] != this->moments.sizeX)
  {
    throw std::logic_error("angular moments are swept in whole rows");
  }
  this->momentsInPlace = this->axes.u == 0;
  const int groups = (this->plane.width + MomentGroup - 1) / MomentGroup;
  this->momentRow = this->channels * groups * (this->moments.functions - 1) * MomentGroup;
}

/// Length of the longest segment of a ray in a voxel; for a periodic axis an upper bound, the longest path through a
/// plane.
double SweepPlan::LongestSegment() const
{
  if (this->periodic[this->axes.axis])
  {
    return LongestWay(this->bundles);
  }
  double longest = 0.0;
  for (const CrossingInfo& crossing : this->Crossings(0, this->CrossingPlanes()))
  {
    longest = std::max<double>(longest, *std::max_element(crossing.length, crossing.length + crossing.stages));
  }
  return longest;
}

void SweepPlan::LayBundles()
{
  for (const Bundle& bundle : this->bundles)
  {
    const std::size_t rays = bundle.members.size() * this->channels;
    this->bundleRows.push_back(this->Describe(bundle));
    this->eachWay.maps += rays * this->row * (this->plane.sizeV + 2);
    this->eachWay.outside += rays * this->row;
    this->eachWay.radiance += rays;
  }
  this->eachWay.maps += this->vector; // padding after the last row
  this->eachWay.outside += this->vector;
}

/// Describes a bundle to the kernels. Its arrays are placed behind those of the bundles that were described before.
BundleInfo SweepPlan::Describe(const Bundle& bundle) const
{
  const std::array<double, 3>& spacing = this->grid.spacing;
  const double cosine = spacing[this->axes.axis] / bundle.length;
  const auto sine = [&](double tangent, int aside) {
    return static_cast<float>(tangent * spacing[aside] / spacing[this->axes.axis] * cosine);
  };
  const auto planes = [this](double tangent) {
    const double all = this->plane.sizeP;
    return static_cast<float>(tangent * all > 1.0 ? 1.0 / tangent : all);
  };
  BundleInfo description = { Int(bundle.members.size()), Int(this->eachWay.maps), Int(this->eachWay.radiance),
    Int(this->eachWay.outside), static_cast<float>(bundle.power), static_cast<float>(cosine),
    sine(bundle.tangentU, this->axes.u), sine(bundle.tangentV, this->axes.v), planes(bundle.tangentU),
    planes(bundle.tangentV), {}, 0, {}, 0, 0 };
  for (std::size_t m = 0; m < bundle.members.size(); ++m)
  {
    const Member& member = bundle.members[m];
    const cl_int move[4] = { member.uFromU, member.uFromV, member.vFromU, member.vFromV };
    std::copy(move, move + 4, description.move[m]);
  }
  return description;
}

/// Determines the frames of each bundle (sets of members whose directions differ only in signs). For both senses of
/// marching, computes the values of the angular functions in their directions, and the index of each bundle's first
/// value.
void SweepPlan::LayFrames()
{
  for (std::size_t b = 0; b < this->bundles.size(); ++b)
  {
    const std::vector<Member>& members = this->bundles[b].members;
    BundleInfo& info = this->bundleRows[b];
    for (std::size_t m = 0; m < members.size(); ++m)
    {
      if (m == 0 || IsSwapped(members[m]) != IsSwapped(members[m - 1]))
      {
        info.firstOfFrame[info.frames++] = Int(m);
      }
    }
    info.firstOfFrame[info.frames] = Int(members.size());
    info.coefficients = Int(this->eachWay.coefficients);
    info.parities = this->ParitiesOf(this->bundles[b]);
    this->eachWay.coefficients += info.frames * this->angular->Functions() + members.size() * this->angular->Beams();
  }
  for (int way = 0; way < 2; ++way)
  {
    for (std::size_t b = 0; b < this->bundles.size(); ++b)
    {
      this->LayCoefficients(b, way);
    }
  }
}

/// Parities (even or odd along u and v) of the angular functions that a bundle needs: bit i is set if the functions of
/// parity i, in the order of FunctionOrder, are not all zero in its directions.
int SweepPlan::ParitiesOf(const Bundle& bundle) const
{
  int parities = 0;
  for (const Member& member : bundle.members)
  {
    for (const int direction : { member.direction, member.opposite })
    {
      for (std::size_t k = 0; direction >= 0 && k < this->order.functions.size(); ++k)
      {
        const int function = this->order.functions[k];
        const std::array<bool, 3> odd = AngularBasis::IsOdd(function);
        const bool counts = std::abs(this->angular->functions[direction][function]) > ZeroFunction;
        parities |= counts ? 1 << ((odd[this->axes.u] ? 1 : 0) + (odd[this->axes.v] ? 2 : 0)) : 0;
      }
    }
  }
  return parities;
}

/// Appends to `coefficients`, for bundle b: the values of the angular functions in the direction of each frame,
/// reflected to positive u and v; then the angular distributions of the beams' light (AngularValues::beams) in the
/// direction of each member.
void SweepPlan::LayCoefficients(std::size_t b, int way)
{
  const auto directionOf = [way](const Member& member) { return way == 0 ? member.direction : member.opposite; };
  const std::vector<Member>& members = this->bundles[b].members;
  const BundleInfo& info = this->bundleRows[b];
  for (int f = 0; f < info.frames; ++f)
  {
    std::vector<float> ofFrame(this->order.functions.size(), 0.0f);
    for (int m = info.firstOfFrame[f]; m < info.firstOfFrame[f + 1]; ++m)
    {
      const Member& member = members[m];
      const bool negativeU = member.uFromU + member.uFromV < 0, negativeV = member.vFromU + member.vFromV < 0;
      for (std::size_t k = 0; k < ofFrame.size() && directionOf(member) >= 0; ++k)
      {
        const int function = this->order.functions[k];
        const std::array<bool, 3> odd = AngularBasis::IsOdd(function);
        const bool turns = (odd[this->axes.u] && negativeU) != (odd[this->axes.v] && negativeV);
        const double value = this->angular->functions[directionOf(member)][function];
        ofFrame[k] = static_cast<float>(turns ? -value : value);
      }
    }
    this->coefficients.insert(this->coefficients.end(), ofFrame.begin(), ofFrame.end());
  }
  for (const Member& member : members)
  {
    for (int beam = 0; beam < this->angular->Beams(); ++beam)
    {
      const int direction = directionOf(member);
      this->coefficients.push_back(direction < 0 ? 0.0f : static_cast<float>(this->angular->beams[direction][beam]));
    }
  }
}

/// Creates the units of work (one work-item each) that run concurrently: for each sense of marching, enough groups of
/// bundles to occupy all cores.
void SweepPlan::LayUnits(int computeUnits)
{
  const int ways = (this->forward ? 1 : 0) + (this->backward ? 1 : 0);
  const int groups =
    std::clamp(computeUnits / std::max(ways, 1), 1, std::min<int>(MostGroups, Int(this->bundles.size())));
  std::size_t rays = 0;
  for (const Bundle& bundle : this->bundles)
  {
    rays += bundle.members.size();
  }
  std::size_t done = 0;
  int first = 0;
  for (int g = 0; g < groups; ++g)
  {
    int end = first;
    while (end < Int(this->bundles.size()) && (done * groups < rays * (g + 1) || g == groups - 1))
    {
      done += this->bundles[end].members.size();
      ++end;
    }
    for (int way = 0; way < 2; ++way)
    {
      if (way == 0 ? this->forward : this->backward)
      {
        this->units.push_back(
          { way, first, end - first, Int(this->units.size() * this->ScratchFloats()), this->PlanesBefore(way) });
      }
    }
    first = end;
  }
}

int SweepPlan::PlanesBefore(int way) const
{
  const int axis = this->axes.axis;
  return way == 0 ? this->box.first[axis] : this->grid.size[axis] - this->box.first[axis] - this->box.size[axis];
}

int SweepPlan::CrossingPlanes() const
{
  return this->PatternPlanes() + std::max(this->PlanesBefore(0), this->PlanesBefore(1));
}

std::size_t SweepPlan::ScratchFloats() const
{
  // Scratch memory of the bundles. With angular moments, it holds the data kept from one tile of rows to the next;
  // otherwise, the ring buffers of rows between the stages of crossing a plane. One more row of rays is for fractional
  // moves, in which only a fraction of a ray's power moves.
  const std::size_t raysOfRow = static_cast<std::size_t>(MaxMembers) * this->channels * this->row;
  const std::size_t together = std::min<std::size_t>(this->bundles.size(), BundlesTogether);
  const std::size_t kept = this->angular
    ? together * BUNDLE_FLOATS(this->channels, this->row)
    : together * RINGS_OF(static_cast<std::size_t>(this->plane.chained)) * RingRows * raysOfRow;
  // With incident radiance per cell of the faces, one more row holds the rays that enter through the faces normal to v.
  const std::size_t ring = kept + (this->faceIn ? 2 : 1) * (raysOfRow + this->vector);
  const std::size_t rows = static_cast<std::size_t>(this->plane.together) * this->plane.sizeV;
  // Scratch is reserved for all rows of a plane even if rowsKept is set, because kernels compiled for light per cell of
  // the faces ignore rowsKept.
  const std::size_t planes = this->plane.quantities * rows * this->row;
  // Rows of the moments of the source and of the path integral that are packed (copied to scratch)
  const std::size_t packed = this->momentsInPlace ? 0 : 2 * rows * this->momentRow;
  return ring + planes + rows + packed + 3 * this->vector;
}

/// Borders between slabs, the ranges of planes that a unit of work crosses in one launch. The number of slabs is even
/// and so large that launches stay short; with several groups of bundles it is at least eight per group. Except for the
/// middle border, no border separates planes that are packed or chained together (PlaneInfo::together). Borders are
/// symmetric about the middle, because units of work of opposite senses wait for each other.
std::vector<int> SweepPlan::SlabBorders(int groups)
{
  const int planes = this->Planes();
  const double perPlane =
    static_cast<double>(this->plane.sizeU) * this->plane.sizeV * this->RaysPerUnit() * this->channels * SecondsPerRay;
  int slabs = std::max(static_cast<int>(std::ceil(perPlane * planes / SecondsPerLaunch)), groups > 1 ? 8 * groups : 2);
  slabs = std::max(2, RoundUp(std::min(slabs, planes), 2));
  this->secondsPerLaunch = perPlane * planes / slabs;
  const int step = planes >= 4 * this->plane.together ? this->plane.together : 1;
  std::vector<int> borders(slabs + 1);
  for (int s = 0; 2 * s <= slabs; ++s)
  {
    const int even = static_cast<int>(static_cast<long>(planes) * s / slabs);
    borders[s] = std::min(planes / 2, RoundUp(even, step));
    borders[slabs - s] = planes - borders[s];
  }
  return borders;
}

/// Schedules slabs (ranges of planes) such that units of work that run concurrently never share planes: each group of
/// bundles follows two slabs behind the previous one, and forward and backward units of work, which approach each
/// other, are in slabs of different parity.
void SweepPlan::LaySchedule()
{
  const int planes = this->Planes();
  const int groups = this->units.back().backward || !this->backward || !this->forward
    ? Int(this->units.size()) / ((this->forward ? 1 : 0) + (this->backward ? 1 : 0))
    : 1;
  const std::vector<int> borders = this->SlabBorders(groups);
  const int slabs = Int(borders.size()) - 1;
  this->launches = slabs + 2 * (groups - 1);
  for (int launch = 0; launch < this->launches; ++launch)
  {
    int group = 0;
    int firstBundle = this->units.front().firstBundle;
    for (const UnitInfo& unit : this->units)
    {
      group += unit.firstBundle != firstBundle ? 1 : 0;
      firstBundle = unit.firstBundle;
      const int slab = launch - 2 * group;
      cl_int2 range = { { 0, 0 } };
      if (slab >= 0 && slab < slabs)
      {
        range = unit.backward ? cl_int2{ { planes - borders[slabs - slab], planes - borders[slabs - 1 - slab] } }
                              : cl_int2{ { borders[slab], borders[slab + 1] } };
      }
      this->schedule.push_back(range);
    }
  }
}

void SweepPlan::LayRounds()
{
  const std::size_t count = this->units.size();
  this->roundSchedule.assign(count * count, cl_int2{ { 0, 0 } });
  for (std::size_t u = 0; u < count; ++u)
  {
    this->roundSchedule[u * count + u] = { { 0, Int(this->PatternPlanes()) } };
  }
}

/// Number of rays per voxel in the unit of work with the most rays.
int SweepPlan::RaysPerUnit() const
{
  std::size_t most = 0;
  for (const UnitInfo& unit : this->units)
  {
    std::size_t rays = 0;
    for (int b = unit.firstBundle; b < unit.firstBundle + unit.bundles; ++b)
    {
      rays += this->bundles[b].members.size();
    }
    most = std::max(most, rays);
  }
  return Int(most);
}

std::vector<CrossingInfo> SweepPlan::Crossings(int firstPlane, int planes) const
{
  std::vector<CrossingInfo> rows;
  for (int k = 0; k < planes; ++k)
  {
    for (const Bundle& bundle : this->bundles)
    {
      const PlaneCrossing crossing = bundle.Crossing(firstPlane + k);
      CrossingInfo onDevice = {};
      onDevice.stages = crossing.count;
      for (int s = 0; s < crossing.count; ++s)
      {
        onDevice.moveU[s] = crossing.segments[s].moveU;
        onDevice.moveV[s] = crossing.segments[s].moveV;
        onDevice.part[s] = static_cast<float>(crossing.segments[s].part);
        onDevice.length[s] = static_cast<float>(crossing.segments[s].length);
      }
      rows.push_back(onDevice);
    }
  }
  return rows;
}

void SweepPlan::LetRaysGoOn()
{
  this->plane.thin = static_cast<float>(Thin / LongestWay(this->bundles));
}

SweepInfo SweepPlan::Info() const
{
  SweepInfo info = {};
  info.eachWay = this->eachWay;
  info.periodicU = this->periodic[this->axes.u];
  info.periodicV = this->periodic[this->axes.v];
  info.bundles = Int(this->bundles.size());
  info.patternPlanes = this->PatternPlanes();
  info.axis = this->axes.axis;
  info.planes = this->plane;
  info.moments = this->moments;
  info.momentsInPlace = this->momentsInPlace;
  info.packedMoments = this->momentRow;
  std::partial_sum(this->order.counts.begin(), this->order.counts.end(), info.parityEnds);
  return info;
}

std::vector<cl_int> SweepPlan::FunctionPlaces() const
{
  std::vector<cl_int> places;
  for (const int function : this->order.functions)
  {
    places.push_back(std::max(function - 1, 0) * MomentGroup);
  }
  places.resize(std::max<std::size_t>(places.size(), 1), 0);
  return places;
}

std::vector<OwnLightInfo> SweepPlan::OwnLight(int lapPlanes) const
{
  std::vector<OwnLightInfo> rows;
  for (const UnitInfo& unit : this->units)
  {
    for (int k = 0; k < this->PatternPlanes(); ++k)
    {
      rows.push_back(this->OwnLightOf(unit, lapPlanes + unit.planesBefore + k));
    }
  }
  return rows;
}

/// Path integral that a unit source in a voxel causes within that voxel (numerics.md, Eq. (26)): the sum over segments
/// of power (l - p1) / sigma_t, where l is the segment's length and p1 its mean transmitted length. For thin voxels
/// each term is -power l^2 (MeanLength[0] + sigma_t l (MeanLength[1] + ...)), a polynomial in sigma_t /
/// PlaneInfo::thin.
OwnLightInfo SweepPlan::OwnLightOf(const UnitInfo& unit, int ofPlane) const
{
  double sum = 0.0;
  std::array<double, MeanLengthTerms> terms = {};
  for (int b = unit.firstBundle; b < unit.firstBundle + unit.bundles; ++b)
  {
    const Bundle& bundle = this->bundles[b];
    const double power = bundle.power * static_cast<double>(bundle.members.size());
    const PlaneCrossing crossing = bundle.Crossing(ofPlane);
    for (int s = 0; s < crossing.count; ++s)
    {
      const double length = crossing.segments[s].length;
      double factor = -power * length * length;
      sum += power * length;
      for (int i = 0; i < MeanLengthTerms; ++i, factor *= length * this->plane.thin)
      {
        terms[i] += factor * MeanLength[i];
      }
    }
  }
  OwnLightInfo own = { static_cast<float>(sum), {} };
  std::copy(terms.begin(), terms.end(), own.terms);
  return own;
}
}
