#include "LightPropagation/Sweep/OnGpu/SweepOnGpu.h"

#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "LightPropagation/Sweep/OnGpu/GpuLanes.h"
#include "LightPropagation/Sweep/OnGpu/LaneArrays.h"
#include "LightPropagation/Sweep/OnGpu/LaneFaces.h"
#include "LightPropagation/Sweep/OnGpu/LanePowers.h"
#include "LightPropagation/Sweep/OnGpu/LaneSlices.h"
#include "LightPropagation/Sweep/OnGpu/PlaneKernels.h"
#include "LightPropagation/Sweep/SweepBorder.h"
#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int MostAtOnce = 4; ///< concurrent ways may use 1 / this of the memory

/// Lanes with all ways concurrently, if their arrays fit in memory together. Ways run one by one if only a part of the
/// grid is swept, since the remainder would have to be cleared, and if the volume is in host memory.
GpuLanes ChooseLanes(const Device& device, const VolumeLayout& layout, const std::array<bool, 3>& periodic,
  const SweepRequest& request, SweepOnGpu::Ways ways)
{
  const bool mayAtOnce = ways == SweepOnGpu::Ways::Automatic && request.box.VoxelCount() == 0 && !device.Streams();
  GpuLanes lanes(device, layout, request, periodic, mayAtOnce);
  const std::size_t left = device.MemoryLimit() - device.BytesInUse();
  const bool fit = sizeof(float) * lanes.ArrayFloats(layout.Stride()) <= left / MostAtOnce;
  return fit || !mayAtOnce ? std::move(lanes) : GpuLanes(device, layout, request, periodic, false);
}
}

class SweepOnGpu::Implementation
{
public:
  Implementation(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
    const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace, Ways ways);

  SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor);
  void Forget(std::optional<int> group = {});

private:
  /// How the lanes of a batch cross planes.
  struct Crossing
  {
    bool shines;                                 ///< the medium has a source
    const Buffer<cl_float4>* entering;           ///< light incident on the sides
    const Buffer<CrossingInfo>* round = nullptr; ///< crossings of rays that wrap around; null: rays that start
  };

  /// Rays under way round a periodic axis between sweeps, for a batch and a group of channels.
  struct OnTheWay
  {
    Buffer<float> maps[2];
    int current = 0;
  };

  void MakeBuffers();
  void MakeSlices();
  void BeginLost(const LaneBatch& batch);
  bool ShineByCells() const { return this->Faces && this->Faces->Shine(); }
  LaneFaces::Rays RaysOf(const Crossing& how) const;
  int Beams() const { return this->Angular ? this->Angular->Beams() : 0; }

  SweepTally ApplyGroup(const SweepVolume& volume, const SweepBoundary& boundary, const Monitor& monitor);
  bool Enter(const SweepBoundary& boundary, int group, SweepTally& tally);
  void CrossOnce(const LaneBatch& batch, const SweepVolume& volume, SweepTally& tally, const Monitor& monitor);
  void GoRound(const LaneBatch& batch, const SweepVolume& volume, SweepTally& tally, const Monitor& monitor);
  OnTheWay& RaysOnTheWay(const LaneBatch& batch, int group);
  std::string Options(const LaneBatch& batch, bool shines) const;
  PlaneLaunch LaunchOf(const LaneBatch& batch, const SweepVolume& volume) const;
  void StartRays(const LaneBatch& batch);
  int Cross(const LaneBatch& batch, const SweepVolume& volume, const Crossing& how,
    const std::array<const Buffer<float>*, 2>& maps, const Monitor& monitor);
  int CrossPlanes(const LaneBatch& batch, const SweepVolume& volume, const Crossing& how,
    const std::array<const Buffer<float>*, 2>& maps, const Monitor& monitor);
  PlaneKernels KernelsOf(const LaneBatch& batch, bool shines) const;
  PlaneArrays Whole(const LaneBatch& batch, const SweepVolume& volume) const;
  void AddArrays(const LaneBatch& batch, const SweepVolume& volume);

  Device& TheDevice;
  VolumeLayout Layout;
  const Buffer<float>& SigmaT;
  Deposit To;
  int MostPlanes;
  bool SameBoundary;
  const AngularValues* Angular;
  const Buffer<float>* OctantSource;
  SweepWorkspace& Workspace;
  GpuLanes The;

  std::vector<std::unique_ptr<LaneSlices>> Slices; ///< by lane, for a volume in host memory; null: swept in place
  Buffer<SweepLane> Lanes;
  Buffer<BundleInfo> Bundles;
  Buffer<CrossingInfo> Crossings;
  Buffer<float> Along;                            ///< GpuLanes::functions
  Buffer<float> Directed;                         ///< source in the rays' directions, laid out as maps
  Buffer<float> Maps[2];                          ///< maps of open axes
  std::map<std::pair<int, int>, OnTheWay> Rounds; ///< by a batch's first lane, and group
  /// [ray][channel] incident power, W: through u's, v's face, and where rays start
  Buffer<cl_float4> Entering;
  Buffer<cl_float4> Nothing; ///< zero incident power
  LaneArrays OfLanes;
  LanePowers Powers;
  std::optional<LaneFaces> Faces; ///< if light is given or counted by cells
  /// Cached incident light and its power by face, by group
  std::map<int, std::pair<std::vector<cl_float4>, std::array<Rgb, 6>>> KeptEntering;
};

SweepOnGpu::Implementation::Implementation(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
  const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace, Ways ways)
  : TheDevice(device)
  , Layout(layout)
  , SigmaT(sigma_t)
  , To(request.angular ? Deposit{ request.deposit.path, nullptr, request.deposit.partialCurrents } : request.deposit)
  , MostPlanes(request.mostPlanes)
  , SameBoundary(request.sameBoundary)
  , Angular(request.angular)
  , OctantSource(request.octantSource)
  , Workspace(workspace)
  , The(ChooseLanes(device, layout, periodic, request, ways))
  , OfLanes(device, this->The, layout, this->To)
  , Powers(device, this->The)
{
  this->MakeBuffers();
  if (request.faceIn || request.deposit.faceOut)
  {
    this->Faces.emplace(device, this->The, layout.grid, request);
  }
  this->MakeSlices();
  this->Lanes = Buffer<SweepLane>(device, this->The.lanes, "the rays' ways");
}

void SweepOnGpu::Implementation::MakeBuffers()
{
  Device& device = this->TheDevice;
  const auto ofRays = [&device](std::size_t floats, const char* what) {
    return Buffer<float>(device, floats, what, CL_MEM_READ_WRITE, Residence::Device);
  };
  this->Bundles = Buffer<BundleInfo>(device, this->The.bundles, "the bundles of rays");
  this->Crossings = Buffer<CrossingInfo>(device, this->The.crossings, "the ray pattern");
  const std::size_t open = this->The.mostMapsOpen, around = this->The.mostMapsAround;
  if (this->Angular)
  {
    this->Along = Buffer<float>(device, this->The.functions, "the angular functions");
    this->Directed = ofRays(std::max(open, around), "what shines along the rays");
  }
  for (Buffer<float>& maps : this->Maps)
  {
    maps = ofRays(std::max<std::size_t>(open, 1), "the light propagation maps");
  }
  this->Entering = Buffer<cl_float4>(device, Count(this->The.rays) * this->The.channels, "the light that comes in");
  if (around > 0)
  {
    this->Nothing = Buffer<cl_float4>(device, this->Entering.Size(), "the light that comes in");
    this->Nothing.Fill(cl_float4{});
  }
}

/// Creates the slices of a volume in host memory. Call after everything that must be on the device has been allocated.
void SweepOnGpu::Implementation::MakeSlices()
{
  if (!this->TheDevice.Streams())
  {
    return;
  }
  for (const LaneBatch& batch : this->The.batches)
  {
    for (const ChannelGroup& group : this->Layout.Groups())
    {
      if (batch.around)
      {
        this->RaysOnTheWay(batch, group.first);
      }
    }
  }
  for (std::size_t i = 0; i < this->The.lanes.size(); ++i)
  {
    this->Slices.push_back(LaneSlices::Make(this->TheDevice, this->The.PlanOf(i), this->The.lanes[i], this->Workspace));
  }
}

SweepTally SweepOnGpu::Implementation::Apply(
  const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor)
{
  SweepTally tally;
  const std::vector<ChannelGroup> groups = this->Layout.Groups();
  for (std::size_t g = 0; g < groups.size() && !this->The.lanes.empty(); ++g)
  {
    SweepVolume volume = GroupVolume(this->Layout, groups[g], this->SigmaT, this->To);
    volume.source = source;
    const int first = groups[g].first;
    const SweepBoundary ofChannels = OfGroup(boundary, first);
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
  const bool lit = this->Enter(boundary, volume.firstChannel, tally);
  if (boundary) // rays under way are discarded, as in SweepInMemory
  {
    this->Forget(volume.firstChannel);
  }
  const double lanes = static_cast<double>(this->The.lanes.size());
  for (const LaneBatch& batch : this->The.batches)
  {
    const double from = batch.first / lanes, part = batch.count / lanes;
    const Monitor ofBatch = OfPart(monitor, [=](double done) { return from + part * done; });
    if (batch.around)
    {
      this->GoRound(batch, volume, tally, ofBatch);
    }
    else if (lit || volume.source || this->ShineByCells()) // otherwise there is no light to carry
    {
      this->CrossOnce(batch, volume, tally, ofBatch);
    }
  }
  return tally;
}

/// @return whether any light is incident
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
    for (const SweepPlan& plan : this->The.plans)
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

/// Carries rays from where they start to the end of their axis.
void SweepOnGpu::Implementation::CrossOnce(
  const LaneBatch& batch, const SweepVolume& volume, SweepTally& tally, const Monitor& monitor)
{
  const Crossing how = { volume.source != nullptr, &this->Entering };
  this->StartRays(batch);
  if (this->ShineByCells())
  {
    this->Faces->EnterStart(batch, this->RaysOf(how), volume.faceFirst, this->Maps[0]);
  }
  this->Cross(batch, volume, how, { &this->Maps[0], &this->Maps[1] }, monitor);
  this->Powers.AddUp(
    batch, [this](const SweepLane& lane) -> const Buffer<float>& { return this->Maps[lane.planes.sizeP % 2]; });
  this->AddArrays(batch, volume);
  this->Powers.CountSides(batch, tally);
  this->Powers.CountEnds(batch, tally);
}

/// Carries rays through all laps in which they start and, with those of the previous sweep, on round the axis until
/// almost no power is under way (numerics.md, section 4.6).
void SweepOnGpu::Implementation::GoRound(
  const LaneBatch& batch, const SweepVolume& volume, SweepTally& tally, const Monitor& monitor)
{
  this->BeginLost(batch);
  OnTheWay& rays = this->RaysOnTheWay(batch, volume.firstChannel);
  Rgb onTheWay = {};
  const auto cross = [&](const Crossing& how) {
    const int planes =
      this->Cross(batch, volume, how, { &rays.maps[rays.current], &rays.maps[1 - rays.current] }, monitor);
    rays.current = (rays.current + planes) % 2;
    this->Powers.AddUp(batch, [&rays](const SweepLane&) -> const Buffer<float>& { return rays.maps[rays.current]; });
    this->Powers.CountSides(batch, tally);
    onTheWay = this->Powers.OfEnds(batch);
    return planes;
  };
  const int planes = cross({ volume.source != nullptr, &this->Entering });
  const double atFirst = Sum(onTheWay);
  for (int gone = planes; gone < this->MostPlanes && Sum(onTheWay) > NothingLeft * atFirst; gone += planes)
  {
    const Buffer<CrossingInfo> crossings(
      this->TheDevice, this->The.plans[batch.plan].Crossings(gone, planes), "the ray pattern");
    cross({ false, &this->Nothing, &crossings });
  }
  this->AddArrays(batch, volume);
  for (int c = 0; c < this->The.channels; ++c)
  {
    tally.onTheWay[c] += onTheWay[c];
  }
}

/// Clears the rounding errors and the own paths of lanes that wrap around.
void SweepOnGpu::Implementation::BeginLost(const LaneBatch& batch)
{
  if (batch.hasArrays)
  {
    this->OfLanes.Clear(batch);
    return;
  }
  this->Workspace.ReserveLost(this->TheDevice, this->To.path->Size());
  this->Workspace.lost.Fill(0.0f);
}

SweepOnGpu::Implementation::OnTheWay& SweepOnGpu::Implementation::RaysOnTheWay(const LaneBatch& batch, int group)
{
  OnTheWay& rays = this->Rounds[{ batch.first, group }];
  if (rays.maps[0].Size() == 0)
  {
    for (Buffer<float>& maps : rays.maps)
    {
      maps =
        Buffer<float>(this->TheDevice, batch.maps, "the light propagation maps", CL_MEM_READ_WRITE, Residence::Device);
      maps.Fill(0.0f);
    }
  }
  return rays;
}

/// @param group  group of channels; none: all
void SweepOnGpu::Implementation::Forget(std::optional<int> group)
{
  for (auto& [key, rays] : this->Rounds)
  {
    if (key.second == group.value_or(key.second))
    {
      rays.maps[rays.current].Fill(0.0f);
    }
  }
}

std::string SweepOnGpu::Implementation::Options(const LaneBatch& batch, bool shines) const
{
  return Define("CHANNELS", this->The.channels) + Define("SOURCE", shines) +
    Define("NET_FLUX", this->To.flux != nullptr) + Define("CURRENTS", this->To.partialCurrents != nullptr) +
    Define("OCTANT_SOURCE", this->OctantSource && shines) +
    Define("DEGREE", this->Angular ? this->Angular->degree : 0) + Define("BEAMS", this->Beams()) +
    Define("ADDS", !batch.hasArrays) + Define("AROUND", batch.around) + Define("SIDES", this->Faces ? 2 : 0);
}

PlaneLaunch SweepOnGpu::Implementation::LaunchOf(const LaneBatch& batch, const SweepVolume& volume) const
{
  PlaneLaunch launch = {};
  launch.sigmaFirst = volume.sigma_t_first;
  launch.sourceFirst = volume.source ? volume.first : 0;
  launch.putFirst = batch.hasArrays ? 0 : volume.first;
  launch.stride = volume.stride;
  launch.firstLane = batch.first;
  launch.firstChannel = volume.firstChannel;
  launch.moments = this->Layout.Places(this->The.functionCount);
  return launch;
}

void SweepOnGpu::Implementation::StartRays(const LaneBatch& batch)
{
  std::size_t floats = 0;
  for (int i = batch.first; i < batch.first + batch.count; ++i)
  {
    const SweepLane& lane = this->The.lanes[i];
    floats = std::max(floats, Count(lane.rays) * this->The.channels * lane.planes.sizeU * lane.planes.sizeV);
  }
  cl::Kernel start = this->TheDevice.Kernel("start_rays", kernel_source::LaneSums, this->The.Options());
  With(start, cl_int(batch.first), this->Lanes, this->Entering, this->Maps[0]);
  this->TheDevice.Queue().enqueueNDRangeKernel(start, cl::NullRange, cl::NDRange(floats, batch.count));
}

/// Crosses all planes once.
/// @param maps  maps that rays are read from and written to, alternately
/// @return number of planes
int SweepOnGpu::Implementation::Cross(const LaneBatch& batch, const SweepVolume& volume, const Crossing& how,
  const std::array<const Buffer<float>*, 2>& maps, const Monitor& monitor)
{
  if (this->Faces)
  {
    this->Faces->EnterSides(batch, this->RaysOf(how), volume.faceFirst);
  }
  const int planes = this->CrossPlanes(batch, volume, how, maps, monitor);
  if (this->Faces)
  {
    this->Faces->Leave(batch, this->RaysOf(how), volume.faceFirst, maps);
  }
  return planes;
}

int SweepOnGpu::Implementation::CrossPlanes(const LaneBatch& batch, const SweepVolume& volume, const Crossing& how,
  const std::array<const Buffer<float>*, 2>& maps, const Monitor& monitor)
{
  int planes = 0;
  for (int i = batch.first; i < batch.first + batch.count; ++i)
  {
    planes = std::max(planes, this->The.lanes[i].patternPlanes);
  }
  PlaneKernels kernels = this->KernelsOf(batch, how.shines);
  const PlaneRays rays = { this->Lanes, this->Bundles, how.round ? *how.round : this->Crossings, *how.entering, maps,
    this->Angular ? this->Directed : *maps[0], this->Angular ? this->Along : *maps[0], this->Powers.Escaped() };
  const auto crossed = [&](int behind) { Report(monitor, static_cast<double>(behind) / planes); };
  PlaneLaunch launch = this->LaunchOf(batch, volume);
  launch.ofRound = how.round != nullptr;
  if (this->Slices.empty() || !this->Slices[batch.first])
  {
    kernels.Launch(launch, this->Whole(batch, volume), rays, 0, planes, nullptr, nullptr, crossed);
    return planes;
  }
  LaneSlices& slices = *this->Slices[batch.first];
  SweepVolume shining = volume;
  shining.source = how.shines ? volume.source : nullptr;
  shining.octantSource = how.shines ? this->OctantSource : nullptr;
  slices.Cross(shining, launch,
    [&](const PlaneLaunch& inSlot, int from, int to, const std::vector<cl::Event>* after, cl::Event* done) {
      kernels.Launch(inSlot, slices.Arrays(), rays, from, to, after, done, crossed);
    });
  return planes;
}

LaneFaces::Rays SweepOnGpu::Implementation::RaysOf(const Crossing& how) const
{
  return { this->Lanes, this->Bundles, how.round ? *how.round : this->Crossings, how.round != nullptr, *how.entering };
}

PlaneKernels SweepOnGpu::Implementation::KernelsOf(const LaneBatch& batch, bool shines) const
{
  PlaneKernels::Size size;
  size.lanes = batch.count;
  for (int i = batch.first; i < batch.first + batch.count; ++i)
  {
    const SweepLane& lane = this->The.lanes[i];
    size.u = std::max(size.u, lane.planes.sizeU);
    size.v = std::max(size.v, lane.planes.sizeV);
    size.rays += Count(lane.rays) * this->The.channels;
  }
  PlaneKernels kernels(this->TheDevice, this->Options(batch, shines), this->Angular && shines, size);
  if (this->Faces)
  {
    this->Faces->SetSides(kernels);
  }
  return kernels;
}

/// The volume's arrays as kernel arguments. Arrays that do not exist are not accessed.
PlaneArrays SweepOnGpu::Implementation::Whole(const LaneBatch& batch, const SweepVolume& volume) const
{
  const bool own = batch.hasArrays;
  const Buffer<float>& path = own ? this->OfLanes.path : *this->To.path;
  const Buffer<float>& source = volume.source ? *volume.source : this->SigmaT;
  return { this->SigmaT, source, this->OctantSource ? *this->OctantSource : source, path,
    !batch.around ? path
      : own       ? this->OfLanes.lost
                  : this->Workspace.lost,
    !this->To.flux ? path
      : own        ? this->OfLanes.flux
                   : *this->To.flux,
    !this->To.partialCurrents ? path
      : own                   ? this->OfLanes.currents
                              : *this->To.partialCurrents };
}

void SweepOnGpu::Implementation::AddArrays(const LaneBatch& batch, const SweepVolume& volume)
{
  if (batch.hasArrays)
  {
    this->OfLanes.AddUp(batch, this->LaunchOf(batch, volume), volume);
  }
}

SweepOnGpu::SweepOnGpu(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
  const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace, Ways ways)
  : Inner(std::make_unique<Implementation>(device, layout, sigma_t, periodic, request, workspace, ways))
{
}

SweepOnGpu::~SweepOnGpu() = default;

SweepTally SweepOnGpu::Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor)
{
  return this->Inner->Apply(source, boundary, monitor);
}

void SweepOnGpu::Forget()
{
  this->Inner->Forget();
}
}
