#include "LightPropagation/Sweep/OnGpu/PlaneKernels.h"

#include "Device/Device.h"
#include "Device/Sizes.h"
#include "TyndallKernelSources.h"

namespace tyndall
{
namespace
{
/// Work-items per group along u and along v. There are more along u, because voxels that are contiguous in memory are
/// mostly along u.
constexpr std::size_t GroupU = 32, GroupV = 4;
/// Time per ray and voxel, s; only determines how often the host waits
constexpr double GpuSecondsPerRay = 1e-10;
}

LaneSlices::LaneSlices(const SweepPlan& plan, const SweepLane& lane)
  : Plan(plan)
{
  UnitInfo unit = {};
  unit.backward = lane.backward;
  unit.bundles = lane.bundles;
  this->Plan.units = { unit };
  this->Plan.schedule = { cl_int2{ { 0, lane.patternPlanes } } };
}

std::unique_ptr<LaneSlices> LaneSlices::Make(
  Device& device, const SweepPlan& plan, SweepLane& lane, SweepWorkspace& workspace)
{
  std::unique_ptr<LaneSlices> slices(new LaneSlices(plan, lane));
  slices->Stream = SliceStream::Make(device, slices->Plan, workspace);
  if (!slices->Stream)
  {
    return nullptr;
  }
  slices->Schedule = slices->Stream->Cut(slices->Plan.schedule);
  SweepInfo slots = {};
  slots.planes = lane.planes;
  slices->Stream->Describe(slots);
  lane.planes = slots.planes;
  lane.planes.firstP = 0;
  return slices;
}

void LaneSlices::Cross(const SweepVolume& volume, const PlaneLaunch& launch, const Planes& cross)
{
  SweepInfo slots = {};
  this->Stream->Describe(slots);
  PlaneLaunch inSlot = launch;
  inSlot.sourceFirst = inSlot.putFirst = slots.first;
  inSlot.stride = slots.stride;
  inSlot.moments = slots.moments;
  inSlot.firstChannel = slots.firstChannel;
  this->Stream->Cross(this->Schedule, volume, [&](int number, const std::vector<cl::Event>* after, cl::Event* done) {
    const SlicePiece& piece = this->Schedule.pieces[number].front();
    const SliceStream::SlotPlace place = this->Stream->PlaceOf(piece, number, 0);
    inSlot.sigmaFirst = place.slot * slots.stride;
    inSlot.slotSource = place.slot * slots.sourceSlot;
    inSlot.slotPath = place.slot * slots.pathSlot;
    inSlot.slotValues = place.slot * slots.stride * static_cast<std::size_t>(this->Plan.channels);
    inSlot.slotPlane = place.firstPlane;
    cross(inSlot, piece.range.s[0], piece.range.s[1], after, done);
  });
}

PlaneKernels::PlaneKernels(Device& device, const SweepDescription& sweep, int sides, const Size& size)
  : TheDevice(device)
  , All(RoundUp(Count(size.u), GroupU), RoundUp(Count(size.v), GroupV), Count(size.lanes))
  , Seconds(GpuSecondsPerRay * size.u * size.v * static_cast<double>(size.rays))
{
  const bool angular = sweep.angular != nullptr;
  const std::string options = Define("CHANNELS", sweep.channels) + Define("NET_FLUX", sweep.netFlux) +
    Define("CURRENTS", sweep.partialCurrents) + Define("OCTANT_SOURCE", sweep.octantSource) +
    Define("ANGULAR", angular) + Define("FUNCTIONS", angular ? sweep.angular->Functions() : 1) +
    Define("BEAMS", angular ? sweep.angular->Beams() : 0) + Define("SIDES", sides);
  this->CrossPlane = device.Kernel("cross_plane", kernel_source::SweepOnGpu, options);
  if (angular)
  {
    this->FindDirected = device.Kernel("find_directed", kernel_source::SweepOnGpu, options);
  }
}

void PlaneKernels::Cross(const SweepVolume& volume, const PlaneLaunch& launch, const VolumeArrays& arrays,
  LaneSlices* slices, const PlaneRays& rays, int planes, const Monitor& monitor)
{
  const VolumeArrays in = slices ? slices->Arrays() : arrays;
  const cl::NDRange group(GroupU, GroupV, 1);
  const LaneSlices::Planes cross = [&](PlaneLaunch at, int from, int to, const std::vector<cl::Event>* after,
                                     cl::Event* done) {
    for (at.plane = from; at.plane < to; ++at.plane)
    {
      if (this->FindDirected() && at.shines)
      {
        With(this->FindDirected, at, rays.lanes, in.source, rays.functions, rays.directed);
        this->TheDevice.Queue().enqueueNDRangeKernel(this->FindDirected, cl::NullRange, this->All, group, after);
      }
      With(this->CrossPlane, at, rays.lanes, in.sigma_t, in.source, in.octants, in.path, in.lost, in.flux, in.currents,
        *rays.maps[at.plane % 2], *rays.maps[1 - at.plane % 2], rays.entering, rays.bundles, rays.crossings,
        rays.directed, rays.functions, rays.escaped, rays.sidesIn, rays.sidesOut);
      this->TheDevice.Queue().enqueueNDRangeKernel(
        this->CrossPlane, cl::NullRange, this->All, group, after, at.plane + 1 == to ? done : nullptr);
      after = nullptr; // later launches are ordered by the queue
      this->TheDevice.Queued(this->Seconds);
      Report(monitor, (at.plane + 1.0) / planes);
    }
  };
  if (!slices)
  {
    cross(launch, 0, planes, nullptr, nullptr);
    return;
  }
  SweepVolume shining = volume;
  shining.source = launch.shines ? volume.source : nullptr;
  shining.octantSource = launch.shines ? volume.octantSource : nullptr;
  slices->Cross(shining, launch, cross);
}
}
