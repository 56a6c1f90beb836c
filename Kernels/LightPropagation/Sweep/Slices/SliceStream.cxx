#include "LightPropagation/Sweep/Slices/SliceStream.h"

#include "Device/Sizes.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Number of planes of voxels per slot (device buffer for a slice of a streamed volume), if memory allows: on a CPU as
/// many as in Gruson et al. (2012); more on a GPU, since slices along x are transferred in rows of this many voxels.
constexpr int SliceThickness = 16, SliceThicknessOnGpu = 64;
/// Rays cross the voxels in one slot while the other slot is transferred to or from the host
constexpr std::size_t SlotsPerUnit = 2;

/// Number of floats per voxel in all arrays that are streamed together.
std::size_t FloatsOfVoxel(const SweepPlan& plan)
{
  const int light = plan.angular ? plan.moments.functions : 1;
  const int beams = plan.angular ? plan.angular->Beams() : 0;
  const int lost = plan.periodic[plan.axes.axis] ? light : 0;
  return Count(1 +
    plan.channels *
      (2 * light + beams + lost + (plan.netFlux ? 3 : 0) + (plan.partialCurrents ? 6 : 0) +
        (plan.octantSource ? 8 : 0)));
}

/// Number of planes per slot (device buffer for a slice of a streamed volume) such that all slots fit in the device
/// memory that the rays and the scratch memory leave free; at least one plane.
int ThicknessFor(const Device& device, const SweepPlan& plan, const SweepWorkspace& workspace)
{
  std::size_t left = device.MemoryLimit() - std::min(device.BytesInUse(), device.MemoryLimit());
  for (const Buffer<float>& slot : workspace.slots) // the slots of sweeps along other axes are reused
  {
    left += slot.Size() * sizeof(float);
  }
  const std::size_t plane = Count(plan.plane.sizeU) * Count(plan.plane.sizeV) * FloatsOfVoxel(plan) * sizeof(float);
  const std::size_t fit = left / 4 * 3 / (SlotsPerUnit * plan.units.size() * plane);
  const int most = device.IsCpu() ? SliceThickness : SliceThicknessOnGpu;
  return static_cast<int>(std::clamp<std::size_t>(fit, 1, most));
}

/// Piece (range of planes that fit in one slot) that a unit of work crosses next.
/// @param left  planes that the unit of work still has to cross, first and end
SlicePiece NextPiece(const SweepPlan& plan, bool backward, const cl_int2& left, int thickness, int aligned)
{
  const int planes = plan.Planes();
  const int lap = left.s[0] / planes * planes; // first plane of the current lap around a periodic axis
  const int from = left.s[0] - lap;
  const int to = std::min(left.s[1] - lap, planes);
  SlicePiece piece;
  if (backward)
  {
    piece.end = planes - from;
    const int lowest = std::max(piece.end - thickness, 0);
    piece.begin = std::max(planes - to, RoundUp(lowest, aligned));
  }
  else
  {
    piece.begin = from;
    piece.end = std::min(to, from / aligned * aligned + thickness);
  }
  piece.range = { { left.s[0], left.s[0] + piece.end - piece.begin } };
  return piece;
}

/// Cuts the launches of a sweep into shorter launches, in which each unit of work (rays carried by one work-item) needs
/// only the planes in one slot. The units of work that run concurrently and the order of additions to each plane do not
/// change, so results are identical bit for bit.
/// @param schedule  planes of each unit of work, [launch][unit of work], first and end
/// @param thickness  planes per slot
/// @param aligned  pieces end at multiples of this number of planes or where the planes of a launch end; 1: anywhere
/// @return pieces, [launch][unit of work]
std::vector<std::vector<SlicePiece>> CutIntoPieces(
  const SweepPlan& plan, const std::vector<cl_int2>& schedule, int thickness, int aligned)
{
  const std::size_t units = plan.units.size();
  std::vector<std::vector<SlicePiece>> launches;
  for (std::size_t first = 0; first < schedule.size(); first += units)
  {
    std::vector<cl_int2> left(schedule.begin() + first, schedule.begin() + first + units);
    const auto isLeft = [](const cl_int2& range) { return range.s[0] < range.s[1]; };
    while (std::any_of(left.begin(), left.end(), isLeft))
    {
      std::vector<SlicePiece> launch(units);
      for (std::size_t u = 0; u < units; ++u)
      {
        if (isLeft(left[u]))
        {
          launch[u] = NextPiece(plan, plan.units[u].backward != 0, left[u], thickness, aligned);
          left[u].s[0] = launch[u].range.s[1];
        }
      }
      launches.push_back(std::move(launch));
    }
  }
  return launches;
}

/// Whether two pieces (ranges of planes) share memory: planes are stored in groups of `aligned` neighbouring planes,
/// and both pieces contain planes of the same group.
bool Meet(const SlicePiece& first, const SlicePiece& second, int aligned)
{
  const auto begin = [aligned](const SlicePiece& piece) { return piece.begin / aligned; };
  const auto end = [aligned](const SlicePiece& piece) { return PartsOf(piece.end, aligned); };
  return first.begin < first.end && second.begin < second.end && begin(first) < end(second) &&
    begin(second) < end(first);
}

/// Whether the units of work that run concurrently in each launch never access the same planes.
bool IsApart(const std::vector<std::vector<SlicePiece>>& launches, int aligned)
{
  for (const std::vector<SlicePiece>& launch : launches)
  {
    for (std::size_t a = 0; a < launch.size(); ++a)
    {
      for (std::size_t b = 0; b < a; ++b)
      {
        if (Meet(launch[a], launch[b], aligned))
        {
          return false;
        }
      }
    }
  }
  return true;
}

/// Whether any unit of work in the launch `next` accesses planes that some unit of work crosses in the launch `now`.
bool Follows(const std::vector<SlicePiece>& now, const std::vector<SlicePiece>& next, int aligned)
{
  return std::any_of(now.begin(), now.end(), [&](const SlicePiece& before) {
    return std::any_of(next.begin(), next.end(), [&](const SlicePiece& after) { return Meet(before, after, aligned); });
  });
}
}

std::unique_ptr<SliceStream> SliceStream::Make(Device& device, const SweepPlan& plan, SweepWorkspace& workspace)
{
  if (!device.Streams() || device.SharesHostMemory())
  {
    return nullptr;
  }
  int thickness = std::min(ThicknessFor(device, plan, workspace), plan.Planes());
  const bool byGroups = plan.angular && plan.axes.axis == 0;
  if (byGroups)
  {
    thickness = MomentGroup;
    if (plan.box.size[1] != plan.grid.size[1] ||
      !IsApart(CutIntoPieces(plan, plan.schedule, thickness, MomentGroup), MomentGroup))
    {
      return nullptr;
    }
  }
  return std::make_unique<SliceStream>(device, plan, workspace, thickness);
}

SliceStream::SliceStream(Device& device, const SweepPlan& plan, SweepWorkspace& workspace, int thickness)
  : TheDevice(device)
  , Plan(plan)
  , Workspace(workspace)
  , Transfers(device.AnotherQueue())
  , Extent(plan.box.size)
{
  this->Extent[plan.axes.axis] = thickness;
  this->LaySlots();
}

void SliceStream::LaySlots()
{
  const auto [x, y, z] = this->Extent;
  const std::size_t channels = Count(this->Plan.channels);
  this->Stride = RoundUp<std::size_t>(Count(x) * Count(y) * Count(z), SweepPadding);
  this->Places = this->Plan.moments;
  this->Places.channels = this->Plan.channels;
  this->Places.sizeX = x;
  this->Places.groups = PartsOf<int>(x, MomentGroup);
  this->Places.second = channels * this->Stride;
  const std::size_t row = Count(this->Places.groups) * Count(this->Places.functions - 1) * MomentGroup;
  this->Places.beams = this->Places.second + (this->HasMoments() ? channels * Count(y) * Count(z) * row : 0);
  const bool goesRound = this->Plan.periodic[this->Plan.axes.axis];
  SlotSizes sizes = {};
  const auto want = [&](SlotArray array, bool wanted) {
    sizes[static_cast<std::size_t>(array)] =
      wanted ? SlotsPerUnit * this->Plan.units.size() * this->SlotFloats(array) + SweepPadding : 0;
  };
  want(SlotArray::SigmaT, true);
  want(SlotArray::Source, true);
  want(SlotArray::Path, true);
  want(SlotArray::Lost, goesRound);
  want(SlotArray::Flux, this->Plan.netFlux);
  want(SlotArray::PartialCurrents, this->Plan.partialCurrents);
  want(SlotArray::OctantSource, this->Plan.octantSource);
  this->Workspace.ReserveSlots(this->TheDevice, sizes);
}

std::size_t SliceStream::SlotFloats(SlotArray array) const
{
  const std::size_t all = Count(this->Plan.channels) * this->Stride;
  const std::size_t beams = this->HasMoments() ? Count(this->Plan.angular->Beams()) : 0;
  switch (array)
  {
    case SlotArray::SigmaT: return this->Stride;
    case SlotArray::Source: return this->Places.beams + beams * all;
    case SlotArray::Flux: return 3 * all;
    case SlotArray::PartialCurrents: return 6 * all;
    case SlotArray::OctantSource: return 8 * all;
    default: return this->Places.beams;
  }
}

const Buffer<float>& SliceStream::Slots(SlotArray array) const
{
  const Buffer<float>& slots = this->Workspace.slots[static_cast<std::size_t>(array)];
  // The sweep does not use this array. Kernels need an argument in its place but do not access it, so any buffer
  // serves.
  return slots.Size() > 0 ? slots : this->Workspace.slots[static_cast<std::size_t>(SlotArray::Path)];
}

VolumeArrays SliceStream::Arrays() const
{
  return { this->Slots(SlotArray::SigmaT), this->Slots(SlotArray::Source), this->Slots(SlotArray::OctantSource),
    this->Slots(SlotArray::Path), this->Slots(SlotArray::Lost), this->Slots(SlotArray::Flux),
    this->Slots(SlotArray::PartialCurrents) };
}

SliceStream::SlotPlace SliceStream::PlaceOf(const SlicePiece& piece, std::size_t launch, std::size_t unit) const
{
  return { SlotsPerUnit * unit + launch % SlotsPerUnit, piece.begin / this->Aligned() * this->Aligned() };
}

SliceStream::Schedule SliceStream::Cut(const std::vector<cl_int2>& schedule) const
{
  Schedule cut;
  cut.pieces = CutIntoPieces(this->Plan, schedule, this->Thickness(), this->Aligned());
  std::vector<cl_int2> rows;
  for (std::size_t launch = 0; launch < cut.pieces.size(); ++launch)
  {
    for (const SlicePiece& piece : cut.pieces[launch])
    {
      rows.push_back(piece.range);
    }
    for (std::size_t u = 0; u < cut.pieces[launch].size(); ++u)
    {
      const SlotPlace place = this->PlaceOf(cut.pieces[launch][u], launch, u);
      rows.push_back({ { static_cast<cl_int>(place.slot), place.firstPlane } });
    }
  }
  cut.rows = Buffer<cl_int2>(this->TheDevice, rows, "the schedule");
  return cut;
}

void SliceStream::Describe(SweepInfo& info) const
{
  const std::array<int, 3> step = { 1, this->Extent[0], this->Extent[0] * this->Extent[1] };
  const PlaneAxes& axes = this->Plan.axes;
  info.streamed = 1;
  info.planes.firstU = 0;
  info.planes.firstV = 0;
  info.planes.stepU = step[axes.u];
  info.planes.stepV = step[axes.v];
  info.planes.stepP = step[axes.axis];
  info.sigmaFirst = 0;
  info.first = 0;
  info.stride = this->Stride;
  info.moments = this->Places;
  info.firstChannel = 0;
  info.sizeY = this->Extent[1];
  info.sourceSlot = this->SlotFloats(SlotArray::Source);
  info.pathSlot = this->SlotFloats(SlotArray::Path);
}

std::vector<SliceStream::Streamed> SliceStream::StreamedArrays(const SweepVolume& volume) const
{
  const int channels = this->Plan.channels;
  const int beams = this->HasMoments() ? this->Plan.angular->Beams() : -1;
  const Deposit& to = volume.deposit;
  std::vector<Streamed> arrays = { { volume.sigma_t, SlotArray::SigmaT, 1, volume.sigma_t_first, false },
    { to.path, SlotArray::Path, channels, volume.first, true, this->HasMoments() ? 0 : -1 } };
  if (volume.source)
  {
    arrays.push_back({ volume.source, SlotArray::Source, channels, volume.first, false, beams });
  }
  if (this->Plan.periodic[this->Plan.axes.axis])
  {
    // Rounding errors for compensated summation. CPU kernels store them for the fluence only, GPU kernels for the
    // moments of all angular functions.
    arrays.push_back(
      { &this->Workspace.lost, SlotArray::Lost, channels, volume.first, true, this->HasMoments() ? 0 : -1 });
  }
  if (to.flux)
  {
    arrays.push_back({ to.flux, SlotArray::Flux, 3 * channels, 3 * volume.first, true });
  }
  if (to.partialCurrents)
  {
    arrays.push_back({ to.partialCurrents, SlotArray::PartialCurrents, 6 * channels, 6 * volume.first, true });
  }
  if (volume.octantSource)
  {
    arrays.push_back({ volume.octantSource, SlotArray::OctantSource, 8 * channels, 8 * volume.first, false });
  }
  return arrays;
}

/// Rows of floats to copy between a host array and a slot for a piece (range of planes). They hold one part, such as a
/// channel, of an array without angular moments.
SliceStream::Rows SliceStream::PlanarRows(const SlicePiece& piece) const
{
  const int axis = this->Plan.axes.axis;
  const std::array<int, 3>& n = this->Plan.grid.size;
  std::array<int, 3> first = this->Plan.box.first, size = this->Plan.box.size, inSlot = {};
  first[axis] += piece.begin;
  size[axis] = piece.end - piece.begin;
  inSlot[axis] = piece.begin % this->Aligned();
  const auto place = [](const std::array<int, 3>& voxel, const std::array<int, 3>& extent) {
    return Count(voxel[0]) + Count(extent[0]) * (Count(voxel[1]) + Count(extent[1]) * Count(voxel[2]));
  };
  return { { Count(size[0]), Count(size[1]), Count(size[2]) }, place(first, n), Count(n[0]), Count(n[0]) * Count(n[1]),
    place(inSlot, this->Extent), Count(this->Extent[0]), Count(this->Extent[0]) * Count(this->Extent[1]) };
}

/// Rows of floats to copy between a host array and a slot for a piece (range of planes). They hold the moments of all
/// angular functions except the first.
SliceStream::Rows SliceStream::MomentRows(const SlicePiece& piece) const
{
  const MomentPlaces& host = this->Plan.moments;
  const VoxelBox& box = this->Plan.box;
  const int axis = this->Plan.axes.axis;
  const std::size_t group = Count(host.functions - 1) * MomentGroup;
  const std::size_t ofChannel = Count(host.groups) * group, line = Count(host.channels) * ofChannel;
  const std::size_t slotChannel = Count(this->Places.groups) * group,
                    slotLine = Count(this->Plan.channels) * slotChannel;
  const std::size_t lines = Count(this->Plan.grid.size[1]);
  if (axis == 0)
  {
    const std::size_t begin = Count(piece.begin / MomentGroup), end = Count(PartsOf<int>(piece.end, MomentGroup));
    return { { (end - begin) * group, Count(this->Plan.channels), lines * Count(box.size[2]) },
      host.second + begin * group + line * lines * Count(box.first[2]), ofChannel, line, this->Places.second,
      slotChannel, slotLine };
  }
  std::array<int, 3> first = box.first, size = box.size;
  first[axis] += piece.begin;
  size[axis] = piece.end - piece.begin;
  return { { slotLine, Count(size[1]), Count(size[2]) },
    host.second + line * (Count(first[1]) + lines * Count(first[2])), line, line * lines, this->Places.second, slotLine,
    slotLine * Count(this->Extent[1]) };
}

void SliceStream::CopyRows(const Streamed& array, const Rows& rows, std::size_t host, std::size_t slot, bool back)
{
  constexpr std::size_t Float = sizeof(float);
  const cl::array<cl::size_type, 3> region = { rows.count[0] * Float, rows.count[1], rows.count[2] };
  const cl::array<cl::size_type, 3> inHost = { (host + rows.hostFirst) * Float, 0, 0 };
  const cl::array<cl::size_type, 3> inSlot = { (slot + rows.slotFirst) * Float, 0, 0 };
  const std::vector<cl::Event>* after = this->Waiting.empty() ? nullptr : &this->Waiting;
  const cl::Buffer& slots = this->Slots(array.slots).Handle();
  if (back)
  {
    this->Transfers.enqueueCopyBufferRect(slots, array.host->Handle(), inSlot, inHost, region, rows.slotRow * Float,
      rows.slotLayer * Float, rows.hostRow * Float, rows.hostLayer * Float, after, &this->Last);
  }
  else
  {
    this->Transfers.enqueueCopyBufferRect(array.host->Handle(), slots, inHost, inSlot, region, rows.hostRow * Float,
      rows.hostLayer * Float, rows.slotRow * Float, rows.slotLayer * Float, after, &this->Last);
  }
  this->Waiting.clear(); // the queue of transfers is in order, so later transfers wait for this copy, too
}

/// Copies the planes that all units of work cross in a launch from the host to their slots, or back to the host if
/// `back`.
void SliceStream::Copy(
  const std::vector<Streamed>& arrays, const std::vector<SlicePiece>& launch, int parity, bool back)
{
  for (std::size_t u = 0; u < launch.size(); ++u)
  {
    for (const Streamed& array : arrays)
    {
      if (launch[u].begin < launch[u].end && (array.comesBack || !back))
      {
        const std::size_t slot = this->PlaceOf(launch[u], Count(parity), u).slot;
        this->CopyArray(array, launch[u], slot * this->SlotFloats(array.slots), back);
      }
    }
  }
}

/// Copies one piece (range of planes) of an array from the host to a slot, or back.
/// @param slot  index of the slot's first float
void SliceStream::CopyArray(const Streamed& array, const SlicePiece& piece, std::size_t slot, bool back)
{
  const MomentPlaces& host = this->Plan.moments;
  const std::size_t hostStride = host.second / Count(host.channels);
  const Rows planar = this->PlanarRows(piece);
  for (int part = 0; part < array.parts; ++part)
  {
    this->CopyRows(array, planar, array.first + Count(part) * hostStride, slot + Count(part) * this->Stride, back);
  }
  if (array.beams < 0)
  {
    return;
  }
  const std::size_t ofChannel = Count(host.groups) * Count(host.functions - 1) * MomentGroup;
  this->CopyRows(array, this->MomentRows(piece), array.first / hostStride * ofChannel, slot, back);
  for (int part = 0; part < array.beams * array.parts; ++part)
  {
    const int inHost = part / array.parts * host.channels + part % array.parts;
    this->CopyRows(array, planar, host.beams + array.first + Count(inHost) * hostStride,
      slot + this->Places.beams + Count(part) * this->Stride, back);
  }
}

void SliceStream::Cross(const Schedule& schedule, const SweepVolume& volume, const Launch& launch)
{
  const std::vector<Streamed> arrays = this->StreamedArrays(volume);
  cl::CommandQueue& kernels = this->TheDevice.Queue();
  cl::Event ready;
  kernels.enqueueMarkerWithWaitList(nullptr, &ready);
  kernels.flush();
  this->Waiting = { ready };
  const auto fetch = [&](std::size_t l) { this->Copy(arrays, schedule.pieces[l], static_cast<int>(l % 2), false); };
  fetch(0);
  cl::Event fetched = this->Last;
  for (std::size_t l = 0; l < schedule.pieces.size(); ++l)
  {
    const std::vector<cl::Event> after = { fetched };
    const bool isLast = l + 1 == schedule.pieces.size();
    const bool ahead = !isLast && !Follows(schedule.pieces[l], schedule.pieces[l + 1], this->Aligned());
    // The transfer of the next planes is queued before the kernel, since launch() may block until its kernel starts
    if (ahead)
    {
      fetch(l + 1);
      fetched = this->Last;
    }
    this->Transfers.flush();
    cl::Event done;
    launch(static_cast<int>(l), &after, &done);
    kernels.flush();
    this->Waiting = { done };
    this->Copy(arrays, schedule.pieces[l], static_cast<int>(l % 2), true);
    if (!isLast && !ahead)
    {
      fetch(l + 1);
      fetched = this->Last;
    }
  }
  this->Transfers.flush();
  const std::vector<cl::Event> all = { this->Last };
  kernels.enqueueBarrierWithWaitList(&all);
}
}
