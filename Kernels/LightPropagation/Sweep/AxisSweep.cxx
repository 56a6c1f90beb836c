#include "LightPropagation/Sweep/AxisSweep.h"

#include "Device/Device.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "Medium/BoxFaces.h"
#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
AxisSweep::AxisSweep(Device& device, const SweepVolume& volume, const AxisBundles& rays,
  const std::array<bool, 3>& periodic, SweepWorkspace& workspace, bool sameBoundary)
  : TheDevice(device)
  , Plan(device, Describe(volume, periodic), rays)
  , Workspace(workspace)
  , SameBoundary(sameBoundary)
  , Kernel(device, this->Plan)
{
  const SweepPlan& plan = this->Plan;
  workspace.Reserve(device, this->IsPeriodic() ? 0 : 2 * plan.eachWay.maps, plan.units.size() * plan.ScratchFloats());
  if (this->IsPeriodic())
  {
    this->OwnMaps =
      Buffer<float>(device, 2 * plan.eachWay.maps, "the light propagation maps", CL_MEM_READ_WRITE, Residence::Device);
    this->OwnMaps.Fill(0.0f);
  }
  this->Stream = SliceStream::Make(device, plan, workspace);
  this->First = this->ScheduleOf(plan.laps == 1 ? plan.schedule : plan.roundSchedule);
  this->Rounds = this->ScheduleOf(plan.roundSchedule);
  this->Sums = Buffer<float>(device, 2 * plan.bundles.size() * plan.plane.sizeV * plan.channels, "sums");
  this->Bundles = Buffer<BundleInfo>(device, plan.bundleRows, "the bundles of rays");
  this->FirstCrossings = Buffer<CrossingInfo>(device, plan.Crossings(0, plan.CrossingPlanes()), "the ray pattern");
  this->Kernel.SetOwnLight(plan.OwnLight());
}

SliceStream::Schedule AxisSweep::ScheduleOf(const std::vector<cl_int2>& ranges) const
{
  return this->Stream ? this->Stream->Cut(ranges)
                      : SliceStream::Schedule{ {}, Buffer<cl_int2>(this->TheDevice, ranges, "the schedule") };
}

void AxisSweep::Start(const SweepVolume& volume, const SweepBoundary& boundary, int mostPlanes, const Monitor& monitor)
{
  this->Tally = {};
  const bool lit = static_cast<bool>(boundary);
  if (this->IsPeriodic())
  {
    this->Workspace.ReserveLost(this->TheDevice, volume.deposit.path->Size());
    this->Workspace.lost.Fill(0.0f);
  }
  if (lit)
  {
    this->Enter(boundary, volume.first);
  }
  else
  {
    this->Kernel.ClearBorder();
  }
  const bool byCells = volume.faceIn && !this->IsPeriodic();
  if (byCells)
  {
    if (!lit)
    {
      this->Maps().Fill(0.0f);
    }
    this->RunOnMaps("enter_by_cells", &volume, false, this->RowsOfMaps(), *volume.faceIn);
  }
  this->Dark = lit && !volume.faceIn && !volume.source && !this->IsPeriodic() &&
    std::all_of(this->Tally.in.begin(), this->Tally.in.end(), IsBlack);
  if (this->Dark)
  {
    return;
  }
  // On a periodic axis the maps still hold the power of rays in transit from the previous sweep.
  const bool mapsEmpty = !lit && !this->IsPeriodic() && !byCells;
  const double launches = this->Plan.laps == 1 ? this->Plan.launches : static_cast<double>(this->Plan.units.size());
  this->Cross(volume, { volume.source != nullptr, lit, volume.faceIn != nullptr, mapsEmpty }, this->FirstCrossings,
    this->First, this->Plan.secondsPerLaunch * launches, monitor);
  if (this->IsPeriodic())
  {
    this->GoRound(volume, mostPlanes, monitor);
  }
  else
  {
    this->SumMaps();
    if (volume.deposit.faceOut)
    {
      this->RunOnMaps(
        "leave_by_cells", &volume, true, cl::NDRange(this->Plan.plane.sizeV, 2), this->CellsOf(volume.deposit));
    }
  }
  if (volume.deposit.faceOut)
  {
    this->TakeFaceCells(volume.deposit);
  }
}

void AxisSweep::Forget()
{
  if (this->IsPeriodic())
  {
    this->OwnMaps.Fill(0.0f);
  }
}

SweepTally AxisSweep::Finish()
{
  if (!this->IsPeriodic() && !this->Dark)
  {
    CountSideways(this->Plan, this->Kernel.Sideways(), this->Tally);
    // On an open axis, the rays behind the last plane have left the box; the maps hold their power.
    const std::array<Rgb, 2> power = this->PowerInMaps();
    for (int way = 0; way < 2; ++way)
    {
      for (int c = 0; c < this->Plan.channels; ++c)
      {
        this->Tally.out[2 * this->Plan.axes.axis + 1 - way][c] += power[way][c];
      }
    }
  }
  return this->Tally;
}

/// Writes the incident power of each ray to the maps, W. If the boundary source is the same in each sweep, its
/// SweepBorder is cached.
void AxisSweep::Enter(const SweepBoundary& boundary, std::size_t firstChannel)
{
  std::unique_ptr<SweepBorder>& kept = this->Borders[firstChannel];
  if (!kept)
  {
    kept = std::make_unique<SweepBorder>(this->Plan, boundary);
  }
  this->Maps().Write(kept->maps.data(), kept->maps.size());
  this->Kernel.SetBorder(kept->outside, kept->radiance);
  this->Tally.in = kept->powerIn;
  if (!this->SameBoundary)
  {
    kept.reset();
  }
}

/// Continues rays around a periodic axis until almost no power is in transit, or until they have crossed `mostPlanes`
/// planes.
void AxisSweep::GoRound(const SweepVolume& volume, int mostPlanes, const Monitor& monitor)
{
  const int planes = this->Plan.PatternPlanes();
  CountSideways(this->Plan, this->Kernel.Sideways(), this->Tally);
  if (!this->Kernel.IsBorderClear() || volume.faceIn)
  {
    // The columns at both ends of the maps' rows hold the power of light incident through the faces normal to u. That
    // power has already entered and must not enter again when rays wrap around.
    this->RunOnMaps("darken_beside", nullptr, false, this->RowsOfMaps());
  }
  this->Kernel.ClearBorder();
  Rgb& onTheWay = this->Tally.onTheWay;
  onTheWay = this->PowerOnTheWay();
  const double atFirst = Sum(onTheWay);
  for (int gone = planes; gone < mostPlanes && Sum(onTheWay) > NothingLeft * atFirst; gone += planes)
  {
    const Buffer<CrossingInfo> crossings(this->TheDevice, this->Plan.Crossings(gone, planes), "the ray pattern");
    this->Cross(volume, {}, crossings, this->Rounds,
      this->Plan.secondsPerLaunch * static_cast<double>(this->Plan.units.size()), monitor);
    CountSideways(this->Plan, this->Kernel.Sideways(), this->Tally);
    onTheWay = this->PowerOnTheWay();
  }
}

/// Queues the launches of the kernel `sweep`. `schedule` lists the range of planes through which each work-item carries
/// rays in each launch.
/// @param seconds  upper estimate of the time of all launches together, s
void AxisSweep::Cross(const SweepVolume& volume, const Entry& entry, const Buffer<CrossingInfo>& crossings,
  const SliceStream::Schedule& schedule, double seconds, const Monitor& monitor)
{
  const SweepPlan& plan = this->Plan;
  const Deposit& to = volume.deposit;
  // A bundle never crosses several planes together if there are angular moments, or if light is given or summed per
  // cell of the faces. In these cases the program that is compiled for periodic boxes also serves open boxes.
  const bool faces = to.faceOut || entry.byCells, alone = plan.angular || faces;
  cl::Kernel kernel =
    this->Kernel.Make(faces, alone || plan.periodic[plan.axes.u] || plan.periodic[plan.axes.v], false);
  SweepInfo info = this->Kernel.InfoOf(volume, this->IsPeriodic());
  info.empty = entry.mapsEmpty;
  info.shines = entry.source;
  info.border = entry.border;
  info.faces = this->Faces(volume.faceFirst, to);
  info.faces.in = entry.byCells;
  if (this->Stream)
  {
    this->Stream->Describe(info);
  }
  const auto launches =
    static_cast<int>(this->Stream ? schedule.pieces.size() : schedule.rows.Size() / plan.units.size());
  SweepKernel::Crossing crossing = { info,
    this->Stream ? this->Stream->Arrays() : ArraysOf(volume, this->IsPeriodic() ? &this->Workspace.lost : nullptr),
    this->Maps(), this->Workspace.scratch, crossings, schedule.rows,
    (volume.faceIn ? *volume.faceIn : *to.path).Handle(), this->CellsOf(to), seconds / launches };
  const SliceStream::Launch start = [&](int launch, const std::vector<cl::Event>* after, cl::Event* done) {
    this->Kernel.Launch(kernel, crossing, launch, after, done);
    Report(monitor, (launch + 1.0) / launches);
  };
  if (this->Stream)
  {
    this->Stream->Cross(schedule, volume, start);
    return;
  }
  for (int launch = 0; launch < launches; ++launch)
  {
    start(launch, nullptr, nullptr);
  }
}

/// Memory layout of the cells of the box's four faces parallel to the marching axis.
FaceInfo AxisSweep::Faces(std::size_t firstChannel, const Deposit& to) const
{
  const PlaneAxes& axes = this->Plan.axes;
  FaceInfo faces = {};
  faces.firstChannel = firstChannel;
  faces.stride = BoxFaceCellCount(this->Plan.grid);
  faces.unit = to.faceOut && to.spreadsAside ? to.faceOut->Size() : 0;
  faces.out = to.faceOut != nullptr;
  faces.spread = to.spreadsAside;
  for (int side = 0; side < 4; ++side)
  {
    const int aside = side < 2 ? axes.u : axes.v;
    const BoxFaceLayout layout = LayoutOfFace(this->Plan.grid, 2 * aside + side % 2);
    faces.first[side] = static_cast<cl_int>(layout.first);
    faces.plane[side] = static_cast<cl_int>(layout.step[axes.axis]);
    faces.along[side] = static_cast<cl_int>(layout.step[side < 2 ? axes.v : axes.u]);
  }
  return faces;
}

/// Runs a kernel of SweepMaps.cl.
/// @param volume  selects the channels whose face cells the kernel reads or adds to; null: the kernel uses no cells
/// @param ofFarFaces  whether the cells are on the faces where rays end; false: on those where rays start
template <class... Arguments>
void AxisSweep::RunOnMaps(
  const char* name, const SweepVolume* volume, bool ofFarFaces, const cl::NDRange& range, const Arguments&... arguments)
{
  const SweepPlan& plan = this->Plan;
  MapsInfo info = { plan.eachWay.maps, static_cast<int>(plan.bundles.size()), plan.channels, plan.row, plan.vector,
    plan.plane.sizeU, plan.plane.width, {}, BoxFaceCellCount(plan.grid) };
  for (int way = 0; volume && way < 2; ++way)
  {
    const int face = 2 * plan.axes.axis + (ofFarFaces ? 1 - way : way);
    info.face[way] = volume->faceFirst + LayoutOfFace(plan.grid, face).first;
  }
  cl::Kernel kernel = this->TheDevice.Kernel(name, kernel_source::SweepMaps, ExactOption(this->TheDevice));
  With(kernel, info, this->Maps(), this->Bundles, arguments...);
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, range, GroupOfLargeItems(this->TheDevice, static_cast<int>(range.dimensions())));
}

cl::NDRange AxisSweep::RowsOfMaps() const
{
  return cl::NDRange(this->Plan.plane.sizeV, this->Plan.bundles.size(), 2);
}

/// Buffer in which escaped power is summed per cell of the box's faces, W. Tens of thousands of rays may end in a cell,
/// so sums are exact (ExactValues). Work-items that may add to the same cell each have their own copy of all cells.
const cl::Buffer& AxisSweep::CellsOf(const Deposit& to)
{
  if (!to.faceOut)
  {
    return to.path->Handle();
  }
  if (!this->FaceCells)
  {
    const std::size_t units = to.spreadsAside ? this->Plan.units.size() : 1;
    this->FaceCells.emplace(this->TheDevice, units * to.faceOut->Size(), "the power that leaves by cells");
  }
  return this->FaceCells->Handle();
}

/// Adds to Deposit::faceOut the escaped power per cell that this sweep has summed.
void AxisSweep::TakeFaceCells(const Deposit& to)
{
  cl::Kernel kernel = this->TheDevice.Kernel("take_face_cells", kernel_source::SweepMaps, ExactOption(this->TheDevice));
  const std::size_t units = to.spreadsAside ? this->Plan.units.size() : 1;
  With(kernel, this->FaceCells->Handle(), cl_int(units), cl_ulong(to.faceOut->Size()), *to.faceOut);
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(to.faceOut->Size()));
}

Rgb AxisSweep::PowerOnTheWay()
{
  this->SumMaps();
  const auto [up, down] = this->PowerInMaps();
  return { up[0] + down[0], up[1] + down[1], up[2] + down[2] };
}

void AxisSweep::SumMaps()
{
  this->RunOnMaps("map_power", nullptr, false, this->RowsOfMaps(), this->Sums);
}

/// Power of the rays in the maps, W, for each sense of marching, from the sums of SumMaps().
std::array<Rgb, 2> AxisSweep::PowerInMaps() const
{
  std::array<Rgb, 2> power = {};
  const std::vector<float> sums = this->Sums.Read();
  for (std::size_t i = 0; i < sums.size(); ++i)
  {
    power[2 * i / sums.size()][i % this->Plan.channels] += sums[i];
  }
  return power;
}
}
