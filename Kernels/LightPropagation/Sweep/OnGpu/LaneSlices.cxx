#include "LightPropagation/Sweep/OnGpu/LaneSlices.h"

namespace tyndall
{
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

PlaneArrays LaneSlices::Arrays() const
{
  const auto slots = [this](SlotArray array) -> const Buffer<float>& { return this->Stream->Slots(array); };
  return { slots(SlotArray::SigmaT), slots(SlotArray::Source), slots(SlotArray::OctantSource), slots(SlotArray::Path),
    slots(SlotArray::Lost), slots(SlotArray::Flux), slots(SlotArray::PartialCurrents) };
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
}
