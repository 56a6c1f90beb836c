#include "LightPropagation/Sweep/OnGpu/SweepOnGpu.h"

#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"
#include "LightPropagation/Sweep/SweepBorder.h"
#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
constexpr std::size_t GroupU = 32, GroupV = 4; ///< work-items along u, whose voxels mostly lie together, and along v
constexpr double SecondsPerRay = 1e-10;        ///< through a voxel: only says how often to wait
constexpr int MostAtOnce = 4;                  ///< part of the memory that ways at once may take: a quarter
}

class SweepOnGpu::Implementation
{
public:
  Implementation(
    Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t, const SweepRequest& request, Ways ways);

  SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor);

private:
  void LayPlan(const SweepPlan& plan);
  void LayLane(const SweepPlan& plan, int way, int firstBundle, int firstCrossing);
  void LayFunctions(const SweepPlan& plan, int way);
  void ChooseWays(Ways ways);
  void MakeBuffers();
  int Functions() const { return this->Angular ? this->Angular->Functions() : 1; }
  int Beams() const { return this->Angular ? this->Angular->Beams() : 0; }
  std::size_t DepositFloats() const
  {
    return this->Functions() + (this->To.flux ? 3 : 0) + (this->To.partialCurrents ? 6 : 0);
  }

  SweepTally ApplyGroup(const SweepVolume& volume, const SweepBoundary& boundary, const Monitor& monitor);
  bool Enter(const SweepBoundary& boundary, int group, SweepTally& tally);
  std::string Options(bool shines) const;
  PlaneLaunch LaunchOf(const SweepVolume& volume, int firstLane) const;
  void Launch(const std::string& options, const SweepVolume& volume, int firstLane, const Monitor& monitor);
  void AddUpEnds(int firstLane);
  void AddUpSides();
  void AddLanes(const SweepVolume& volume);
  void AddMomentsOfLanes(const SweepVolume& volume);
  void CountOut(SweepTally& tally) const;

  Device& TheDevice;
  VolumeLayout Layout;
  const Buffer<float>& SigmaT;
  Deposit To;
  VoxelBox Box;
  bool SameBoundary;
  const AngularValues* Angular;
  const Buffer<float>* OctantSource;
  int Channels; ///< that are swept together

  /// One of each entry of the request's rays, that has any.
  std::vector<SweepPlan> Plans;
  std::vector<SweepLane> Lanes;
  std::vector<std::size_t> FirstEnd; ///< of lanes, in Ends
  std::vector<BundleInfo> BundleRows;
  std::vector<CrossingInfo> CrossingRows;
  std::vector<float> FunctionRows; ///< [ray][function, then beam]
  int Together = 1;                ///< lanes that go at once: all or one
  std::size_t MapFloats = 0, EscapedFloats = 0, EndRows = 0;
  int Rays = 0;

  Buffer<SweepLane> LanesThere;
  Buffer<BundleInfo> Bundles;
  Buffer<CrossingInfo> Crossings;
  Buffer<float> Along;    ///< FunctionRows
  Buffer<float> Directed; ///< as maps: what shines along the rays
  Buffer<float> Maps[2];
  Buffer<cl_float4> Entering;         ///< [ray][channel] W through u's, v's face, and where rays start
  Buffer<float> Path, Flux, Currents; ///< of lanes that go at once
  Buffer<float> Escaped;              ///< see SweepLane
  Buffer<float> Sides;                ///< of each of its rows the sum
  Buffer<float> Ends;                 ///< of the maps' rows behind the last plane: [lane][ray][channel][v]
  std::map<int, std::pair<std::vector<cl_float4>, std::array<Rgb, 6>>> KeptEntering; ///< by group, with power
};

bool SweepOnGpu::Can(const SweepRequest& request, const std::array<bool, 3>& periodic)
{
  return !periodic[0] && !periodic[1] && !periodic[2] && !request.faceIn && !request.deposit.faceOut;
}

SweepOnGpu::Implementation::Implementation(
  Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t, const SweepRequest& request, Ways ways)
  : TheDevice(device)
  , Layout(layout)
  , SigmaT(sigma_t)
  , To(request.deposit)
  , Box(request.box)
  , SameBoundary(request.sameBoundary)
  , Angular(request.angular)
  , OctantSource(request.octantSource)
  , Channels(layout.Groups().front().count)
{
  if (!Can(request, {}))
  {
    throw std::logic_error("SweepOnGpu cannot do this sweep");
  }
  this->To.flux = this->Angular ? nullptr : this->To.flux; // it is among the moments
  for (const AxisBundles& along : request.rays)
  {
    if (along.bundles.empty())
    {
      continue;
    }
    this->Plans.emplace_back(device, layout.grid, this->Box, along.axis, along.bundles, this->Channels,
      std::array<bool, 3>{}, this->To.flux != nullptr, this->To.partialCurrents != nullptr, this->Angular,
      layout.Places(this->Functions()), false, false);
  }
  for (const SweepPlan& plan : this->Plans)
  {
    this->LayPlan(plan);
  }
  this->ChooseWays(ways);
  this->MakeBuffers();
}

/// Its bundles and crossings behind those that have their place, and a lane for each way.
void SweepOnGpu::Implementation::LayPlan(const SweepPlan& plan)
{
  const int firstBundle = static_cast<int>(this->BundleRows.size());
  const int firstCrossing = static_cast<int>(this->CrossingRows.size());
  this->BundleRows.insert(this->BundleRows.end(), plan.bundleRows.begin(), plan.bundleRows.end());
  const std::vector<CrossingInfo> crossings = plan.Crossings(0, plan.CrossingPlanes());
  this->CrossingRows.insert(this->CrossingRows.end(), crossings.begin(), crossings.end());
  for (int way = 0; way < 2; ++way)
  {
    if (way == 0 ? plan.forward : plan.backward)
    {
      this->LayLane(plan, way, firstBundle, firstCrossing);
    }
  }
}

/// One more lane, but for where its maps and deposits are.
void SweepOnGpu::Implementation::LayLane(const SweepPlan& plan, int way, int firstBundle, int firstCrossing)
{
  SweepLane lane = {};
  lane.planes = plan.plane;
  lane.axis = plan.axes.axis;
  lane.backward = way;
  lane.firstBundle = firstBundle;
  lane.bundles = static_cast<int>(plan.bundles.size());
  lane.crossings = firstCrossing + plan.PlanesBefore(way) * lane.bundles;
  lane.firstRay = this->Rays;
  lane.rays = static_cast<int>(plan.radianceEachWay) / this->Channels;
  lane.escaped = this->EscapedFloats;
  lane.positions = std::max(plan.plane.sizeU, plan.plane.sizeV);
  this->Rays += lane.rays;
  this->LayFunctions(plan, way);
  this->EscapedFloats += std::size_t{ 4 } * plan.plane.sizeP * this->Channels * lane.positions;
  this->FirstEnd.push_back(this->EndRows);
  this->EndRows += Count(lane.rays) * this->Channels * plan.plane.sizeV;
  this->Lanes.push_back(lane);
}

/// The angular functions and beams along the rays of a lane.
void SweepOnGpu::Implementation::LayFunctions(const SweepPlan& plan, int way)
{
  for (const Bundle& bundle : plan.bundles)
  {
    for (const Member& member : bundle.members)
    {
      const int direction = way == 0 ? member.direction : member.opposite;
      for (int k = 0; this->Angular && k < this->Functions() + this->Beams(); ++k)
      {
        const double value = direction < 0 ? 0.0
          : k < this->Functions()          ? this->Angular->functions[direction][k]
                                           : this->Angular->beams[direction][k - this->Functions()];
        this->FunctionRows.push_back(static_cast<float>(value));
      }
    }
  }
}

/// All at once, where what they find has room beside each other; else one by one. Of a part of the grid one by one:
/// what is not swept would have to be cleared.
void SweepOnGpu::Implementation::ChooseWays(Ways ways)
{
  const std::size_t bytes =
    sizeof(float) * this->DepositFloats() * this->Lanes.size() * this->Channels * this->Layout.Stride();
  const std::size_t left = this->TheDevice.MemoryLimit() - this->TheDevice.BytesInUse();
  const bool atOnce = ways == Ways::Automatic && this->Box.VoxelCount() == 0 && bytes <= left / MostAtOnce;
  this->Together = atOnce ? static_cast<int>(this->Lanes.size()) : 1;
  std::size_t floats = 0;
  for (std::size_t i = 0; i < this->Lanes.size(); ++i)
  {
    SweepLane& lane = this->Lanes[i];
    lane.map = atOnce ? floats : 0;
    lane.deposit = atOnce ? i * this->Channels * this->Layout.Stride() : 0;
    lane.path = this->Functions() * lane.deposit;
    const std::size_t maps = Count(lane.rays) * this->Channels * lane.planes.sizeU * lane.planes.sizeV;
    floats = atOnce ? floats + maps : std::max(floats, maps);
  }
  this->MapFloats = floats;
}

void SweepOnGpu::Implementation::MakeBuffers()
{
  Device& device = this->TheDevice;
  this->LanesThere = Buffer<SweepLane>(device, this->Lanes, "the rays' ways");
  this->Bundles = Buffer<BundleInfo>(device, this->BundleRows, "the bundles of rays");
  this->Crossings = Buffer<CrossingInfo>(device, this->CrossingRows, "the ray pattern");
  if (this->Angular)
  {
    this->Along = Buffer<float>(device, this->FunctionRows, "the angular functions");
    this->Directed = Buffer<float>(device, this->MapFloats, "what shines along the rays");
  }
  for (Buffer<float>& maps : this->Maps)
  {
    maps = Buffer<float>(device, this->MapFloats, "the light propagation maps");
  }
  this->Entering = Buffer<cl_float4>(device, Count(this->Rays) * this->Channels, "the light that comes in");
  this->Escaped = Buffer<float>(device, this->EscapedFloats, "the power that leaves sideways");
  this->Escaped.Fill(0.0f); // rows of the shorter faces stay so at their ends
  std::size_t rows = 0;
  for (const SweepLane& lane : this->Lanes)
  {
    rows += std::size_t{ 4 } * lane.planes.sizeP * this->Channels;
  }
  this->Sides = Buffer<float>(device, rows, "sums");
  this->Ends = Buffer<float>(device, this->EndRows, "sums");
  if (this->Together > 1)
  {
    const std::size_t values = this->Lanes.size() * this->Channels * this->Layout.Stride();
    this->Path = Buffer<float>(device, values * this->Functions(), "the light of each way");
    this->Path.Fill(0.0f); // beyond the voxels it stays
    if (this->To.flux)
    {
      this->Flux = Buffer<float>(device, 3 * values, "the net flux of each way");
      this->Flux.Fill(0.0f);
    }
    if (this->To.partialCurrents)
    {
      this->Currents = Buffer<float>(device, 6 * values, "the partial currents of each way");
      this->Currents.Fill(0.0f);
    }
  }
}

SweepTally SweepOnGpu::Implementation::Apply(
  const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor)
{
  SweepTally tally;
  const std::vector<ChannelGroup> groups = this->Layout.Groups();
  for (std::size_t g = 0; g < groups.size() && !this->Lanes.empty(); ++g)
  {
    SweepVolume volume = GroupVolume(this->Layout, groups[g], this->SigmaT, this->To);
    volume.source = source;
    const int first = groups[g].first;
    const SweepBoundary ofChannels = boundary && first > 0
      ? SweepBoundary([&](int direction, int face) { return OfGroup(boundary(direction, face), first); })
      : boundary;
    const double all = static_cast<double>(groups.size());
    const double before = static_cast<double>(g);
    const Monitor ofGroup = OfPart(monitor, [=](double done) { return (before + done) / all; });
    Add(tally, this->ApplyGroup(volume, ofChannels, ofGroup), first);
  }
  return tally;
}

SweepTally SweepOnGpu::Implementation::ApplyGroup(
  const SweepVolume& volume, const SweepBoundary& boundary, const Monitor& monitor)
{
  SweepTally tally;
  if (!this->Enter(boundary, volume.firstChannel, tally) && !volume.source)
  {
    return tally; // nothing to carry
  }
  const std::string options = this->Options(volume.source != nullptr);
  const int lanes = static_cast<int>(this->Lanes.size());
  for (int lane = 0; lane < lanes; lane += this->Together)
  {
    const double from = static_cast<double>(lane) / lanes, part = static_cast<double>(this->Together) / lanes;
    this->Launch(options, volume, lane, OfPart(monitor, [=](double done) { return from + part * done; }));
    this->AddUpEnds(lane);
  }
  this->AddUpSides();
  if (this->Together > 1)
  {
    this->AddLanes(volume);
  }
  this->CountOut(tally);
  return tally;
}

/// @return whether any light comes in
bool SweepOnGpu::Implementation::Enter(const SweepBoundary& boundary, int group, SweepTally& tally)
{
  if (!boundary)
  {
    this->Entering.Fill(cl_float4{});
    return false;
  }
  auto& [entering, power] = this->KeptEntering[group];
  if (entering.empty())
  {
    for (const SweepPlan& plan : this->Plans)
    {
      const SweepBorder border(plan, boundary, SweepBorder::Holds::RaysAlone);
      for (int way = 0; way < 2; ++way)
      {
        if (way == 0 ? plan.forward : plan.backward)
        {
          const auto begin = border.rays.begin() + way * plan.radianceEachWay;
          entering.insert(entering.end(), begin, begin + plan.radianceEachWay);
        }
      }
      for (int face = 0; face < 6; ++face)
      {
        for (int c = 0; c < 3; ++c)
        {
          power[face][c] += border.powerIn[face][c];
        }
      }
    }
  }
  this->Entering.Write(entering.data());
  tally.in = power;
  const bool lit = !std::all_of(power.begin(), power.end(), IsBlack);
  if (!this->SameBoundary)
  {
    this->KeptEntering.erase(group);
  }
  return lit;
}

std::string SweepOnGpu::Implementation::Options(bool shines) const
{
  return Define("CHANNELS", this->Channels) + Define("SOURCE", shines) + Define("NET_FLUX", this->To.flux != nullptr) +
    Define("CURRENTS", this->To.partialCurrents != nullptr) + Define("OCTANT_SOURCE", this->OctantSource && shines) +
    Define("DEGREE", this->Angular ? this->Angular->degree : 0) + Define("BEAMS", this->Beams()) +
    Define("ADDS", this->Together == 1);
}

PlaneLaunch SweepOnGpu::Implementation::LaunchOf(const SweepVolume& volume, int firstLane) const
{
  PlaneLaunch launch = {};
  launch.sigmaFirst = volume.sigma_t_first;
  launch.sourceFirst = volume.source ? volume.first : 0;
  launch.putFirst = this->Together == 1 ? volume.first : 0;
  launch.stride = volume.stride;
  launch.firstLane = firstLane;
  launch.firstChannel = volume.firstChannel;
  launch.moments = this->Layout.Places(this->Functions());
  return launch;
}

/// From where rays start to where they leave their axis.
void SweepOnGpu::Implementation::Launch(
  const std::string& options, const SweepVolume& volume, int firstLane, const Monitor& monitor)
{
  int sizeU = 0, sizeV = 0, sizeP = 0, rays = 0;
  std::size_t floats = 0;
  for (int i = firstLane; i < firstLane + this->Together; ++i)
  {
    const SweepLane& lane = this->Lanes[i];
    sizeU = std::max(sizeU, lane.planes.sizeU);
    sizeV = std::max(sizeV, lane.planes.sizeV);
    sizeP = std::max(sizeP, lane.planes.sizeP);
    rays += lane.rays;
    floats = std::max(floats, Count(lane.rays) * this->Channels * lane.planes.sizeU * lane.planes.sizeV);
  }
  cl::CommandQueue& queue = this->TheDevice.Queue();
  cl::Kernel start =
    this->TheDevice.Kernel("start_rays", kernel_source::SweepOnGpu, Define("CHANNELS", this->Channels));
  With(start, cl_int(firstLane), this->LanesThere, this->Entering, this->Maps[0]);
  queue.enqueueNDRangeKernel(start, cl::NullRange, cl::NDRange(floats, this->Together));

  const bool adds = this->Together == 1;
  const Buffer<float>& path = adds ? *this->To.path : this->Path;
  const Buffer<float>& flux = !this->To.flux ? path : adds ? *this->To.flux : this->Flux;
  const Buffer<float>& currents = !this->To.partialCurrents ? path : adds ? *this->To.partialCurrents : this->Currents;
  const Buffer<float>& source = volume.source ? *volume.source : this->SigmaT; // never read where there is none
  const Buffer<float>& octants = this->OctantSource ? *this->OctantSource : source;
  const Buffer<float>& directed = this->Angular ? this->Directed : this->Maps[0];
  const Buffer<float>& functions = this->Angular ? this->Along : this->Maps[0];
  const bool findsDirected = this->Angular && volume.source;
  cl::Kernel kernel = this->TheDevice.Kernel("cross_plane", kernel_source::SweepOnGpu, options);
  cl::Kernel find;
  if (findsDirected)
  {
    find = this->TheDevice.Kernel("find_directed", kernel_source::SweepOnGpu, options);
  }
  PlaneLaunch launch = this->LaunchOf(volume, firstLane);
  const cl::NDRange all(RoundUp(Count(sizeU), GroupU), RoundUp(Count(sizeV), GroupV), this->Together);
  const double seconds = SecondsPerRay * sizeU * sizeV * rays * this->Channels;
  for (launch.plane = 0; launch.plane < sizeP; ++launch.plane)
  {
    if (findsDirected)
    {
      With(find, launch, this->LanesThere, source, functions, directed);
      queue.enqueueNDRangeKernel(find, cl::NullRange, all, cl::NDRange(GroupU, GroupV, 1));
    }
    With(kernel, launch, this->LanesThere, this->SigmaT, source, octants, path, flux, currents,
      this->Maps[launch.plane % 2], this->Maps[1 - launch.plane % 2], this->Entering, this->Bundles, this->Crossings,
      directed, functions, this->Escaped);
    queue.enqueueNDRangeKernel(kernel, cl::NullRange, all, cl::NDRange(GroupU, GroupV, 1));
    this->TheDevice.Queued(seconds);
    Report(monitor, (launch.plane + 1.0) / sizeP);
  }
}

/// What is in the maps behind the last plane has left.
void SweepOnGpu::Implementation::AddUpEnds(int firstLane)
{
  cl::Kernel kernel = this->TheDevice.Kernel("sum_rows", kernel_source::SweepOnGpu, Define("CHANNELS", this->Channels));
  for (int i = firstLane; i < firstLane + this->Together; ++i)
  {
    const SweepLane& lane = this->Lanes[i];
    With(kernel, this->Maps[lane.planes.sizeP % 2], lane.map, cl_int(lane.planes.sizeU), this->Ends,
      cl_ulong(this->FirstEnd[i]));
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(Count(lane.rays) * this->Channels * lane.planes.sizeV));
  }
}

void SweepOnGpu::Implementation::AddUpSides()
{
  cl::Kernel kernel = this->TheDevice.Kernel("sum_rows", kernel_source::SweepOnGpu, Define("CHANNELS", this->Channels));
  std::size_t first = 0;
  for (const SweepLane& lane : this->Lanes)
  {
    const std::size_t rows = std::size_t{ 4 } * lane.planes.sizeP * this->Channels;
    With(kernel, this->Escaped, lane.escaped, lane.positions, this->Sides, cl_ulong(first));
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(rows));
    first += rows;
  }
}

void SweepOnGpu::Implementation::AddLanes(const SweepVolume& volume)
{
  cl::Kernel kernel =
    this->TheDevice.Kernel("add_lanes", kernel_source::SweepOnGpu, Define("CHANNELS", this->Channels));
  const auto add = [&](const Buffer<float>& ofLanes, const Buffer<float>* to, std::size_t components) {
    if (!to)
    {
      return;
    }
    const std::size_t values = components * this->Channels * this->Layout.Stride();
    With(kernel, ofLanes, cl_int(this->Lanes.size()), cl_ulong(values), *to, cl_ulong(components * volume.first));
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(values));
  };
  if (this->Angular)
  {
    this->AddMomentsOfLanes(volume);
  }
  else
  {
    add(this->Path, this->To.path, 1);
  }
  add(this->Flux, this->To.flux, 3);
  add(this->Currents, this->To.partialCurrents, 6);
}

void SweepOnGpu::Implementation::AddMomentsOfLanes(const SweepVolume& volume)
{
  cl::Kernel kernel = this->TheDevice.Kernel("add_moments_of_lanes", kernel_source::SweepOnGpu, this->Options(false));
  With(
    kernel, this->LaunchOf(volume, 0), this->Path, cl_int(this->Lanes.size()), *this->To.path, cl_ulong(volume.first));
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange,
    cl::NDRange(this->Layout.grid.VoxelCount(), static_cast<std::size_t>(this->Functions()) * this->Channels));
}

void SweepOnGpu::Implementation::CountOut(SweepTally& tally) const
{
  const std::vector<float> sides = this->Sides.Read(), ends = this->Ends.Read();
  std::size_t row = 0;
  for (std::size_t i = 0; i < this->Lanes.size(); ++i)
  {
    const SweepLane& lane = this->Lanes[i];
    const PlaneAxes axes = AcrossAxis(lane.axis);
    const std::array<int, 4> faces = { 2 * axes.u, 2 * axes.u + 1, 2 * axes.v, 2 * axes.v + 1 };
    for (int r = 0; r < 4 * lane.planes.sizeP * this->Channels; ++r, ++row)
    {
      tally.out[faces[r / this->Channels % 4]][r % this->Channels] += sides[row];
    }
    for (int r = 0; r < lane.rays * this->Channels * lane.planes.sizeV; ++r)
    {
      const int channel = r / lane.planes.sizeV % this->Channels;
      tally.out[2 * lane.axis + 1 - lane.backward][channel] += ends[this->FirstEnd[i] + r];
    }
  }
}

SweepOnGpu::SweepOnGpu(
  Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t, const SweepRequest& request, Ways ways)
  : Inner(std::make_unique<Implementation>(device, layout, sigma_t, request, ways))
{
}

SweepOnGpu::~SweepOnGpu() = default;

SweepTally SweepOnGpu::Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor)
{
  return this->Inner->Apply(source, boundary, monitor);
}
}
