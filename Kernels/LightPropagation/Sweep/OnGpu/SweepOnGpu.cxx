#include "LightPropagation/Sweep/OnGpu/SweepOnGpu.h"

#include "Device/Sizes.h"
#include "LightPropagation/Sweep/SweepBorder.h"
#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Lanes (rays of one sense along an axis) that run concurrently may use 1 / MostAtOnce of the memory.
constexpr int MostAtOnce = 4;
constexpr int AllSides = 15; ///< bits 0 to 3: each side of the box is a face of the domain

/// Returns the lanes of a sweep, one for each sense along each axis. All lanes run concurrently if their arrays fit in
/// memory together. They run one after another if the arrays do not fit, if only a subregion of the grid is swept (the
/// arrays outside it would have to be cleared), or if the volume is in host memory.
GpuLanes ChooseLanes(const Device& device, const SweepVolume& volume, const std::vector<AxisBundles>& rays,
  const std::array<bool, 3>& periodic, SweepOnGpu::Ways ways)
{
  const bool mayAtOnce = ways == SweepOnGpu::Ways::Automatic && volume.box.VoxelCount() == 0 && !device.Streams();
  GpuLanes lanes(device, volume, rays, periodic, mayAtOnce);
  const std::size_t left = device.MemoryLimit() - device.BytesInUse();
  const bool fit = sizeof(float) * lanes.ArrayFloats(volume.stride) <= left / MostAtOnce;
  return fit || !mayAtOnce ? std::move(lanes) : GpuLanes(device, volume, rays, periodic, false);
}
}

SweepOnGpu::SweepOnGpu(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
  const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace, Ways ways)
  : SweepByGroups(layout, sigma_t, request)
  , TheDevice(device)
  , Workspace(workspace)
  , The(ChooseLanes(device, this->VolumeOf(0), request.rays, periodic, ways))
  , OfLanes(device, this->The, layout, this->VolumeOf(0).deposit)
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

void SweepOnGpu::MakeBuffers()
{
  Device& device = this->TheDevice;
  const auto ofRays = [&device](std::size_t floats, const char* what) {
    return Buffer<float>(device, floats, what, CL_MEM_READ_WRITE, Residence::Device);
  };
  this->Bundles = Buffer<BundleInfo>(device, this->The.bundles, "the bundles of rays");
  this->Crossings = Buffer<CrossingInfo>(device, this->The.crossings, "the ray pattern");
  const std::size_t open = this->The.mostMapsOpen, around = this->The.mostMapsAround;
  if (this->Request.angular)
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

/// Creates Slices if the volume is in host memory. Call after all other buffers on the device have been allocated.
void SweepOnGpu::MakeSlices()
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

SweepTally SweepOnGpu::ApplyGroup(
  std::size_t /*group*/, const SweepVolume& volume, const SweepBoundary& boundary, const Monitor& monitor)
{
  SweepTally tally;
  if (this->The.lanes.empty())
  {
    return tally;
  }
  const bool lit = this->Enter(boundary, volume.firstChannel, tally);
  if (boundary) // the rays that incident light starts replace those in transit from earlier sweeps, as in SweepInMemory
  {
    this->Forget(volume.firstChannel);
  }
  const double lanes = static_cast<double>(this->The.lanes.size());
  for (const LaneBatch& batch : this->The.batches)
  {
    const Monitor ofBatch = OfPart(monitor, batch.first / lanes, (batch.first + batch.count) / lanes);
    if (batch.around)
    {
      this->GoRound(batch, volume, tally, ofBatch);
    }
    else if (lit || volume.source || this->ShineByCells())
    {
      this->CrossOnce(batch, volume, tally, ofBatch);
    }
  }
  return tally;
}

SweepOnGpu::Entered SweepOnGpu::EnteredFrom(const SweepBoundary& boundary) const
{
  Entered entered;
  auto& [entering, power] = entered;
  power = {};
  for (const SweepPlan& plan : this->The.plans)
  {
    const SweepBorder border(plan, boundary, SweepBorder::Holds::RaysAlone);
    for (int way = 0; way < 2; ++way)
    {
      if (way == 0 ? plan.forward : plan.backward)
      {
        const auto begin = border.rays.begin() + way * plan.eachWay.radiance;
        entering.insert(entering.end(), begin, begin + plan.eachWay.radiance);
      }
    }
    AddTo(power, border.powerIn);
  }
  return entered;
}

/// Computes the incident power of each ray, and sets the incident power of each face in the tally.
/// @return whether any light is incident
bool SweepOnGpu::Enter(const SweepBoundary& boundary, int group, SweepTally& tally)
{
  if (!boundary)
  {
    this->Entering.Fill(cl_float4{});
    return false;
  }
  Entered& entered = this->KeptEntering[group];
  if (entered.first.empty())
  {
    entered = this->EnteredFrom(boundary);
  }
  this->Entering.Write(entered.first.data());
  tally.in = entered.second;
  if (!this->Request.sameBoundary)
  {
    this->KeptEntering.erase(group);
  }
  return !std::all_of(tally.in.begin(), tally.in.end(), IsBlack);
}

/// Carries the rays of a batch (lanes that run concurrently) of open axes from where they start to the ends of the
/// axes.
void SweepOnGpu::CrossOnce(const LaneBatch& batch, const SweepVolume& volume, SweepTally& tally, const Monitor& monitor)
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

/// Carries the rays of both senses along a periodic axis (a batch), including rays in transit from the previous sweep.
/// They cross all laps in which rays start and then wrap around the axis until almost no power is in transit
/// (numerics.md, section 4.6).
void SweepOnGpu::GoRound(const LaneBatch& batch, const SweepVolume& volume, SweepTally& tally, const Monitor& monitor)
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
  for (int gone = planes; gone < this->Request.mostPlanes && Sum(onTheWay) > NothingLeft * atFirst; gone += planes)
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

/// Clears arrays before a sweep around a periodic axis: the lanes' own path integrals, fluxes and currents or, if lanes
/// have no arrays of their own, the rounding errors of the path integrals.
void SweepOnGpu::BeginLost(const LaneBatch& batch)
{
  if (batch.hasArrays)
  {
    this->OfLanes.Clear(batch);
    return;
  }
  this->Workspace.ReserveLost(this->TheDevice, this->Request.deposit.path->Size());
  this->Workspace.lost.Fill(0.0f);
}

SweepOnGpu::OnTheWay& SweepOnGpu::RaysOnTheWay(const LaneBatch& batch, int group)
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

/// Discards the rays in transit along periodic axes.
/// @param group  index of a group of channels that are swept together; none: all groups
void SweepOnGpu::Forget(std::optional<int> group)
{
  for (auto& [key, rays] : this->Rounds)
  {
    if (key.second == group.value_or(key.second))
    {
      rays.maps[rays.current].Fill(0.0f);
    }
  }
}

PlaneLaunch SweepOnGpu::LaunchOf(const LaneBatch& batch, const SweepVolume& volume) const
{
  PlaneLaunch launch = {};
  launch.sigmaFirst = volume.sigma_t_first;
  launch.sourceFirst = volume.source ? volume.first : 0;
  launch.putFirst = batch.hasArrays ? 0 : volume.first;
  launch.stride = volume.stride;
  launch.firstLane = batch.first;
  launch.firstChannel = volume.firstChannel;
  launch.adds = !batch.hasArrays || batch.around;
  launch.inPlaces = !batch.hasArrays;
  launch.outerSides = AllSides;
  launch.moments = volume.moments;
  return launch;
}

void SweepOnGpu::StartRays(const LaneBatch& batch)
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

/// Carries the rays of a batch (lanes that run concurrently) once through all planes.
/// @param maps  the two maps of ray powers; each plane reads one and writes the other
/// @return number of planes
int SweepOnGpu::Cross(const LaneBatch& batch, const SweepVolume& volume, const Crossing& how,
  const std::array<const Buffer<float>*, 2>& maps, const Monitor& monitor)
{
  int planes = 0;
  for (int i = batch.first; i < batch.first + batch.count; ++i)
  {
    planes = std::max(planes, this->The.lanes[i].patternPlanes);
  }
  if (this->Faces)
  {
    this->Faces->EnterSides(batch, this->RaysOf(how), volume.faceFirst);
  }
  const Buffer<float>& unused = *maps[0];
  const PlaneRays rays = { this->Lanes, this->Bundles, how.round ? *how.round : this->Crossings, *how.entering, maps,
    volume.angular ? this->Directed : unused, volume.angular ? this->Along : unused, this->Powers.Escaped(),
    this->Faces ? this->Faces->In() : unused, this->Faces ? this->Faces->Out() : unused };
  PlaneLaunch launch = this->LaunchOf(batch, volume);
  launch.ofRound = how.round != nullptr;
  launch.shines = how.shines;
  PlaneKernels kernels(
    this->TheDevice, this->The.PlanOf(batch.first), this->Faces ? SidesOfDomain : SidesNotStored, this->SizeOf(batch));
  kernels.Cross(volume, launch, this->Arrays(batch, volume),
    this->Slices.empty() ? nullptr : this->Slices[batch.first].get(), rays, planes, monitor);
  if (this->Faces)
  {
    this->Faces->Leave(batch, this->RaysOf(how), volume.faceFirst, maps);
  }
  return planes;
}

LaneFaces::Rays SweepOnGpu::RaysOf(const Crossing& how) const
{
  return { this->Lanes, this->Bundles, how.round ? *how.round : this->Crossings, how.round != nullptr, *how.entering };
}

PlaneKernels::Size SweepOnGpu::SizeOf(const LaneBatch& batch) const
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
  return size;
}

/// Arrays that the plane kernels read and add to: those of the volume or, for deposits of lanes that run concurrently,
/// the arrays of the lanes.
VolumeArrays SweepOnGpu::Arrays(const LaneBatch& batch, const SweepVolume& volume) const
{
  if (!batch.hasArrays)
  {
    return ArraysOf(volume, batch.around ? &this->Workspace.lost : nullptr);
  }
  SweepVolume own = volume;
  own.deposit.path = &this->OfLanes.path;
  own.deposit.flux = volume.deposit.flux ? &this->OfLanes.flux : nullptr;
  own.deposit.partialCurrents = volume.deposit.partialCurrents ? &this->OfLanes.currents : nullptr;
  return ArraysOf(own, batch.around ? &this->OfLanes.lost : nullptr);
}

void SweepOnGpu::AddArrays(const LaneBatch& batch, const SweepVolume& volume)
{
  if (batch.hasArrays)
  {
    this->OfLanes.AddUp(batch, this->LaunchOf(batch, volume), volume);
  }
}
}
