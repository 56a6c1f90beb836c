#include "LightPropagation/Sweep/AxisSweep.h"

#include "Device/Defines.h"
#include "Device/ExactValues.h"
#include "Device/GroupSize.h"
#include "LightPropagation/Sweep/Slices/SliceStream.h"
#include "LightPropagation/Sweep/SweepBorder.h"
#include "LightPropagation/Sweep/SweepDefines.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepPlan.h"
#include "Medium/BoxFaces.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <map>
#include <string>

namespace tyndall
{
namespace
{
using BundleMaps = cl_int2; ///< for map_power: members, first float of the maps

std::vector<BundleMaps> MapsOf(const SweepPlan& plan)
{
  std::vector<BundleMaps> maps;
  for (const BundleInfo& bundle : plan.bundleRows)
  {
    maps.push_back({ { bundle.members, bundle.map } });
  }
  return maps;
}
}

struct AxisSweep::Implementation
{
  Implementation(Device& device, const SweepVolume& volume, int axis, const std::vector<Bundle>& bundles,
    const std::array<bool, 3>& periodic, SweepWorkspace& workspace, bool sameBoundary)
    : TheDevice(device)
    , Plan(device, volume.grid, volume.box, axis, bundles, volume.channels, periodic, volume.deposit.flux != nullptr,
        volume.deposit.partialCurrents != nullptr, volume.angular, volume.moments, volume.faceIn != nullptr,
        volume.octantSource != nullptr)
    , Workspace(workspace)
    , SameBoundary(sameBoundary)
  {
    this->MakeBuffers();
  }

  void MakeBuffers();
  void Enter(const SweepBoundary& boundary, std::size_t firstChannel);
  void DarkenSides();
  void DarkenBeside();
  /// Which sources and boundary light a launch has.
  struct Entry
  {
    bool source = false;    ///< the medium has a source
    bool border = false;    ///< light is incident on the faces that rays pass sideways
    bool byCells = false;   ///< that light is given by cells
    bool mapsEmpty = false; ///< the maps' memory is uninitialised
  };
  void CrossOnce(const SweepVolume& volume, const Entry& entry, const Monitor& monitor);
  void GoRound(const SweepVolume& volume, int mostPlanes, const Monitor& monitor);

  /// The planes that each unit crosses in each launch.
  struct Schedule
  {
    const Buffer<cl_int2>& planes;
    int launches;
    const SliceStream::Schedule& streamed; ///< the same for a streamed volume
  };
  Schedule Rounds() const
  {
    return { this->RoundSchedule, static_cast<int>(this->Plan.units.size()), this->StreamedRounds };
  }
  void Launch(const SweepVolume& volume, const Entry& entry, const Buffer<CrossingInfo>& crossings,
    const Schedule& schedule, const Monitor& monitor);
  cl::Kernel MapsKernel(const char* name);
  cl::Kernel SweepKernel(const Deposit& to, bool byCells);
  FaceInfo Faces(std::size_t firstChannel, const Deposit& to) const;
  void EnterByCells(const SweepVolume& volume);
  const cl::Buffer& CellsOf(const Deposit& to);
  void TakeFaceCells(const Deposit& to);
  void LeaveByCells(const SweepVolume& volume);

  /// Ray maps, laid out as in SweepBorder.
  Buffer<float>& Maps() { return this->IsPeriodic() ? this->OwnMaps : this->Workspace.maps; }
  bool IsPeriodic() const { return this->Plan.periodic[this->Plan.axes.axis]; }
  void CountSideways();
  void CountEnds();
  void SumMaps();
  std::array<Rgb, 2> PowerInMaps() const;
  Rgb PowerOnTheWay();

  Device& TheDevice;
  SweepPlan Plan;
  SweepWorkspace& Workspace;
  bool SameBoundary;

  Buffer<float> OwnMaps;           ///< maps of a periodic axis
  Buffer<float> Outside, Radiance; ///< as SweepBorder has them
  Buffer<float> Sideways;          ///< power that left sideways, W: [plane][unit][-u, +u, -v, +v][channel]
  ExactValues FaceCells;           ///< escaped power by cell, as Deposit::faceOut: [unit][channel][cell]
  bool HasFaceCells = false;
  Buffer<float> Sums; ///< power in the maps: [way][bundle][row][channel]
  Buffer<BundleInfo> Bundles;
  Buffer<BundleMaps> MapPlaces;
  Buffer<UnitInfo> Units;
  Buffer<float> Coefficients;
  Buffer<cl_int2> FirstSchedule, RoundSchedule;
  Buffer<CrossingInfo> FirstCrossings;
  Buffer<OwnLightInfo> FirstOwnLight;
  Buffer<cl_int> FunctionPlaces;
  std::unique_ptr<SliceStream> Stream; ///< for a volume in host memory; null: it is swept in place
  SliceStream::Schedule StreamedFirst, StreamedRounds;

  std::map<std::size_t, std::unique_ptr<SweepBorder>> Borders; ///< by SweepVolume::first
  bool SidesDark = false;                                      ///< Outside and Radiance are zero
  bool Dark = false;                                           ///< the current sweep has no light to carry
  SweepTally Tally;                                            ///< of the current sweep
};

void AxisSweep::Implementation::MakeBuffers()
{
  Device& device = this->TheDevice;
  const SweepPlan& plan = this->Plan;
  const std::size_t channels = static_cast<std::size_t>(plan.channels);
  this->Workspace.Reserve(
    device, this->IsPeriodic() ? 0 : 2 * plan.mapsEachWay, plan.units.size() * plan.ScratchFloats());
  if (this->IsPeriodic())
  {
    this->OwnMaps =
      Buffer<float>(device, 2 * plan.mapsEachWay, "the light propagation maps", CL_MEM_READ_WRITE, Residence::Device);
    this->OwnMaps.Fill(0.0f);
  }
  this->Stream = SliceStream::Make(device, plan, this->Workspace);
  if (this->Stream)
  {
    this->StreamedFirst = this->Stream->Cut(plan.schedule);
    this->StreamedRounds = this->Stream->Cut(plan.roundSchedule);
  }
  this->Outside = Buffer<float>(device, 2 * plan.outsideEachWay, "the light that comes in sideways");
  this->Radiance = Buffer<float>(device, 2 * plan.radianceEachWay, "the light that comes in sideways");
  this->Sideways =
    Buffer<float>(device, plan.units.size() * plan.PatternPlanes() * 4 * channels, "the power that leaves sideways");
  this->Sums = Buffer<float>(device, 2 * plan.bundles.size() * plan.plane.sizeV * channels, "sums");
  this->Bundles = Buffer<BundleInfo>(device, plan.bundleRows, "the bundles of rays");
  this->MapPlaces = Buffer<BundleMaps>(device, MapsOf(plan), "the bundles of rays");
  this->Units = Buffer<UnitInfo>(device, plan.units, "the units of work");
  this->Coefficients = Buffer<float>(
    device, plan.coefficients.empty() ? std::vector<float>{ 0.0f } : plan.coefficients, "the angular functions");
  this->FirstSchedule = Buffer<cl_int2>(device, plan.schedule, "the schedule");
  this->RoundSchedule = Buffer<cl_int2>(device, plan.roundSchedule, "the schedule");
  this->FirstCrossings = Buffer<CrossingInfo>(device, plan.Crossings(0, plan.CrossingPlanes()), "the ray pattern");
  this->FirstOwnLight = Buffer<OwnLightInfo>(device, plan.OwnLight(), "the ray pattern");
  this->FunctionPlaces = Buffer<cl_int>(device, plan.FunctionPlaces(), "the angular functions");
}

/// Writes the incident light to the maps. If it is the same in each sweep, its border is cached.
void AxisSweep::Implementation::Enter(const SweepBoundary& boundary, std::size_t firstChannel)
{
  std::unique_ptr<SweepBorder>& kept = this->Borders[firstChannel];
  if (!kept)
  {
    kept = std::make_unique<SweepBorder>(this->Plan, boundary);
  }
  const SweepBorder& border = *kept;
  this->Maps().Write(border.maps.data(), border.maps.size());
  this->Outside.Write(border.outside.data());
  this->Radiance.Write(border.radiance.data());
  this->Tally.in = border.powerIn;
  this->SidesDark = false;
  if (!this->SameBoundary)
  {
    kept.reset();
  }
}

/// Clears the light that is incident sideways.
void AxisSweep::Implementation::DarkenSides()
{
  if (!this->SidesDark)
  {
    this->Outside.Fill(0.0f);
    this->Radiance.Fill(0.0f);
    this->SidesDark = true;
  }
}

/// Clears the incident light beside the rows in the maps of a periodic axis: it has entered, and must not enter again
/// when rays wrap around.
void AxisSweep::Implementation::DarkenBeside()
{
  const SweepPlan& plan = this->Plan;
  cl::Kernel kernel = this->MapsKernel("darken_beside");
  With(kernel, this->OwnMaps, cl_ulong(plan.mapsEachWay), this->MapPlaces, cl_int(plan.channels), cl_int(plan.row),
    cl_int(plan.vector), plan.plane.sizeU, plan.plane.width);
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange,
    cl::NDRange(plan.plane.sizeV, plan.bundles.size(), 2), GroupOfLargeItems(this->TheDevice, 3));
}

/// Carries rays from where they start to the end of the axis or, on a periodic axis, of the last lap in which rays
/// start.
void AxisSweep::Implementation::CrossOnce(const SweepVolume& volume, const Entry& entry, const Monitor& monitor)
{
  const Schedule schedule =
    this->Plan.laps == 1 ? Schedule{ this->FirstSchedule, this->Plan.launches, this->StreamedFirst } : this->Rounds();
  this->Launch(volume, entry, this->FirstCrossings, schedule, monitor);
}

/// Carries rays on round a periodic axis until almost no power is under way.
void AxisSweep::Implementation::GoRound(const SweepVolume& volume, int mostPlanes, const Monitor& monitor)
{
  const int planes = this->Plan.PatternPlanes();
  this->CountSideways();
  if (!this->SidesDark || volume.faceIn)
  {
    this->DarkenBeside();
  }
  this->DarkenSides();
  Rgb& onTheWay = this->Tally.onTheWay;
  onTheWay = this->PowerOnTheWay();
  const double atFirst = Sum(onTheWay);
  for (int gone = planes; gone < mostPlanes && Sum(onTheWay) > NothingLeft * atFirst; gone += planes)
  {
    const Buffer<CrossingInfo> crossings(this->TheDevice, this->Plan.Crossings(gone, planes), "the ray pattern");
    this->Launch(volume, {}, crossings, this->Rounds(), monitor);
    this->CountSideways();
    onTheWay = this->PowerOnTheWay();
  }
}

void AxisSweep::Implementation::Launch(const SweepVolume& volume, const Entry& entry,
  const Buffer<CrossingInfo>& crossings, const Schedule& schedule, const Monitor& monitor)
{
  cl::Kernel kernel = this->SweepKernel(volume.deposit, entry.byCells);
  const SweepPlan& plan = this->Plan;
  const Buffer<float>& flux = volume.deposit.flux ? *volume.deposit.flux : *volume.deposit.path;
  const Buffer<float>& partialCurrents =
    volume.deposit.partialCurrents ? *volume.deposit.partialCurrents : *volume.deposit.path;
  // never read if there is no source
  const Buffer<float>& source = volume.source ? *volume.source : *volume.deposit.path;
  const Buffer<float>& lost = this->IsPeriodic() ? this->Workspace.lost : *volume.deposit.path;
  SweepInfo info = {};
  info.sigmaFirst = volume.sigma_t_first;
  info.first = volume.first;
  info.stride = volume.stride;
  info.mapsEachWay = plan.mapsEachWay;
  info.outsideEachWay = static_cast<uint>(plan.outsideEachWay);
  info.radianceEachWay = static_cast<uint>(plan.radianceEachWay);
  info.coefficientsEachWay = static_cast<uint>(plan.coefficientsEachWay);
  info.empty = entry.mapsEmpty;
  info.shines = entry.source;
  info.border = entry.border;
  info.roundAxis = this->IsPeriodic();
  info.periodicU = plan.periodic[plan.axes.u];
  info.periodicV = plan.periodic[plan.axes.v];
  info.bundles = static_cast<int>(plan.bundles.size());
  info.patternPlanes = plan.PatternPlanes();
  info.axis = plan.axes.axis;
  info.planes = plan.plane;
  info.faces = this->Faces(volume.faceFirst, volume.deposit);
  info.faces.in = entry.byCells;
  const cl::Buffer& faceOut = this->CellsOf(volume.deposit);
  const Buffer<float>& faceIn = volume.faceIn ? *volume.faceIn : *volume.deposit.path;
  const Buffer<float>& octantSource = volume.octantSource ? *volume.octantSource : *volume.deposit.path;
  plan.DescribeMoments(info);
  info.sizeY = plan.grid.size[1];
  info.firstChannel = volume.firstChannel;
  if (this->Stream)
  {
    this->Stream->Describe(info);
  }
  const auto in = [this](SlotArray array, const Buffer<float>& whole) -> const Buffer<float>& {
    return this->Stream ? this->Stream->Slots(array) : whole;
  };
  const int launches = this->Stream ? static_cast<int>(schedule.streamed.pieces.size()) : schedule.launches;
  const SliceStream::Launch start = [&](int launch, const std::vector<cl::Event>* after, cl::Event* done) {
    info.launch = launch;
    With(kernel, info, in(SlotArray::SigmaT, *volume.sigma_t), in(SlotArray::Source, source),
      in(SlotArray::Path, *volume.deposit.path), in(SlotArray::Lost, lost), in(SlotArray::Flux, flux),
      in(SlotArray::PartialCurrents, partialCurrents), this->Maps(), this->Outside, this->Radiance,
      this->Workspace.scratch, this->Units, this->Bundles, this->Coefficients, crossings, this->FirstOwnLight,
      this->Stream ? schedule.streamed.rows : schedule.planes, this->Sideways, faceOut, faceIn,
      in(SlotArray::OctantSource, octantSource), this->FunctionPlaces);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(plan.units.size()), cl::NDRange(1), after, done);
    this->TheDevice.Queued(plan.secondsPerLaunch * schedule.launches / launches);
    Report(monitor, (launch + 1.0) / launches);
  };
  if (this->Stream)
  {
    this->Stream->Cross(schedule.streamed, volume, start);
    return;
  }
  for (int launch = 0; launch < launches; ++launch)
  {
    start(launch, nullptr, nullptr);
  }
}

/// Memory layout of the cells of the faces that rays of this axis pass sideways.
FaceInfo AxisSweep::Implementation::Faces(std::size_t firstChannel, const Deposit& to) const
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

/// On an open axis, adds light given by cells of the faces where rays start to the maps.
void AxisSweep::Implementation::EnterByCells(const SweepVolume& volume)
{
  const SweepPlan& plan = this->Plan;
  std::vector<float> power;
  for (const BundleInfo& bundle : plan.bundleRows)
  {
    power.push_back(bundle.power);
  }
  const Buffer<float> powers(this->TheDevice, power, "the bundles of rays");
  const int low = 2 * plan.axes.axis;
  cl::Kernel kernel = this->MapsKernel("enter_by_cells");
  With(kernel, this->Maps(), cl_ulong(plan.mapsEachWay), this->MapPlaces, powers, cl_int(plan.channels),
    cl_int(plan.row), cl_int(plan.vector), plan.plane.sizeU, *volume.faceIn,
    cl_ulong(volume.faceFirst + LayoutOfFace(plan.grid, low).first),
    cl_ulong(volume.faceFirst + LayoutOfFace(plan.grid, low + 1).first), cl_ulong(BoxFaceCellCount(plan.grid)));
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange,
    cl::NDRange(plan.plane.sizeV, plan.bundles.size(), 2), GroupOfLargeItems(this->TheDevice, 3));
  this->TheDevice.Finish(); // before the buffer of powers is destroyed
}

/// The buffer in which escaped power is summed by cell. Tens of thousands of rays end in a cell, too many for a sum in
/// floats; and units that run concurrently need their own copies, as rays may share cells.
const cl::Buffer& AxisSweep::Implementation::CellsOf(const Deposit& to)
{
  if (!to.faceOut)
  {
    return to.path->Handle();
  }
  if (!this->HasFaceCells)
  {
    const std::size_t units = to.spreadsAside ? this->Plan.units.size() : 1;
    this->FaceCells = ExactValues(this->TheDevice, units * to.faceOut->Size(), "the power that leaves by cells");
    this->HasFaceCells = true;
  }
  return this->FaceCells.Handle();
}

/// Adds the sweep's own sums by cell to faceOut.
void AxisSweep::Implementation::TakeFaceCells(const Deposit& to)
{
  cl::Kernel kernel = this->MapsKernel("take_face_cells");
  const std::size_t units = to.spreadsAside ? this->Plan.units.size() : 1;
  With(kernel, this->FaceCells.Handle(), cl_int(units), cl_ulong(to.faceOut->Size()), *to.faceOut);
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(to.faceOut->Size()));
}

/// On an open axis, counts the power in the maps that leaves through the cells of the far faces.
void AxisSweep::Implementation::LeaveByCells(const SweepVolume& volume)
{
  const SweepPlan& plan = this->Plan;
  const int low = 2 * plan.axes.axis;
  cl::Kernel kernel = this->MapsKernel("leave_by_cells");
  With(kernel, this->Maps(), cl_ulong(plan.mapsEachWay), this->MapPlaces, cl_int(plan.bundles.size()),
    cl_int(plan.channels), cl_int(plan.row), cl_int(plan.vector), plan.plane.sizeU, this->CellsOf(volume.deposit),
    cl_ulong(volume.faceFirst + LayoutOfFace(plan.grid, low + 1).first),
    cl_ulong(volume.faceFirst + LayoutOfFace(plan.grid, low).first), cl_ulong(BoxFaceCellCount(plan.grid)));
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(plan.plane.sizeV, 2), GroupOfLargeItems(this->TheDevice, 2));
}

cl::Kernel AxisSweep::Implementation::MapsKernel(const char* name)
{
  return this->TheDevice.Kernel(name, kernel_source::SweepMaps, ExactOption(this->TheDevice));
}

cl::Kernel AxisSweep::Implementation::SweepKernel(const Deposit& to, bool byCells)
{
  const SweepPlan& plan = this->Plan;
  // If planes are not chained anyway, one program serves periodic boxes as well.
  const bool alone = plan.angular || to.faceOut || byCells;
  const std::string options = DefinesOf(plan) + ExactOption(this->TheDevice) + Define("NET_FLUX", to.flux != nullptr) +
    Define("FACES", to.faceOut || byCells) +
    Define("PERIODIC", alone || plan.periodic[plan.axes.u] || plan.periodic[plan.axes.v]);
  return this->TheDevice.Kernel("sweep", kernel_source::Sweep, options);
}

void AxisSweep::Implementation::CountSideways()
{
  const std::vector<float> left = this->Sideways.Read();
  const PlaneAxes& axes = this->Plan.axes;
  const std::array<int, 4> faces = { 2 * axes.u, 2 * axes.u + 1, 2 * axes.v, 2 * axes.v + 1 };
  for (std::size_t i = 0; i < left.size(); ++i)
  {
    this->Tally.out[faces[i / this->Plan.channels % 4]][i % this->Plan.channels] += left[i];
  }
}

/// Counts the power in the maps behind the last plane of an open axis as escaped.
void AxisSweep::Implementation::CountEnds()
{
  const std::array<Rgb, 2> power = this->PowerInMaps();
  for (int way = 0; way < 2; ++way)
  {
    for (int c = 0; c < this->Plan.channels; ++c)
    {
      this->Tally.out[2 * this->Plan.axes.axis + 1 - way][c] += power[way][c];
    }
  }
}

Rgb AxisSweep::Implementation::PowerOnTheWay()
{
  this->SumMaps();
  const auto [up, down] = this->PowerInMaps();
  return { up[0] + down[0], up[1] + down[1], up[2] + down[2] };
}

void AxisSweep::Implementation::SumMaps()
{
  const SweepPlan& plan = this->Plan;
  cl::Kernel kernel = this->MapsKernel("map_power");
  With(kernel, this->Maps(), cl_ulong(plan.mapsEachWay), this->MapPlaces, plan.plane.sizeV, cl_int(plan.channels),
    cl_int(plan.row), cl_int(plan.vector), plan.plane.sizeU, this->Sums);
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange,
    cl::NDRange(plan.plane.sizeV, plan.bundles.size(), 2), GroupOfLargeItems(this->TheDevice, 3));
}

/// Power by way, from the sums of SumMaps.
std::array<Rgb, 2> AxisSweep::Implementation::PowerInMaps() const
{
  std::array<Rgb, 2> power = {};
  const std::vector<float> sums = this->Sums.Read();
  for (std::size_t i = 0; i < sums.size(); ++i)
  {
    power[2 * i / sums.size()][i % this->Plan.channels] += sums[i];
  }
  return power;
}

AxisSweep::AxisSweep(Device& device, const SweepVolume& volume, int axis, const std::vector<Bundle>& bundles,
  const std::array<bool, 3>& periodic, SweepWorkspace& workspace, bool sameBoundary)
  : Inner(std::make_unique<Implementation>(device, volume, axis, bundles, periodic, workspace, sameBoundary))
{
}

AxisSweep::~AxisSweep() = default;

void AxisSweep::Start(const SweepVolume& volume, const SweepBoundary& boundary, int mostPlanes, const Monitor& monitor)
{
  Implementation& self = *this->Inner;
  self.Tally = {};
  if (self.IsPeriodic())
  {
    self.Workspace.ReserveLost(self.TheDevice, volume.deposit.path->Size());
    self.Workspace.lost.Fill(0.0f);
  }
  if (boundary)
  {
    self.Enter(boundary, volume.first);
  }
  else
  {
    self.DarkenSides();
  }
  const bool lit = static_cast<bool>(boundary);
  const bool byCells = volume.faceIn && !self.IsPeriodic();
  if (byCells)
  {
    if (!lit)
    {
      self.Maps().Fill(0.0f);
    }
    self.EnterByCells(volume);
  }
  self.Dark = lit && !volume.faceIn && !volume.source && !self.IsPeriodic() &&
    std::all_of(self.Tally.in.begin(), self.Tally.in.end(), IsBlack);
  if (self.Dark)
  {
    return;
  }
  // The maps of a periodic axis hold the rays under way from the previous sweep.
  const bool mapsEmpty = !lit && !self.IsPeriodic() && !byCells;
  self.CrossOnce(volume, { volume.source != nullptr, lit, volume.faceIn != nullptr, mapsEmpty }, monitor);
  if (self.IsPeriodic())
  {
    self.GoRound(volume, mostPlanes, monitor);
  }
  else
  {
    self.SumMaps();
    if (volume.deposit.faceOut)
    {
      self.LeaveByCells(volume);
    }
  }
  if (volume.deposit.faceOut)
  {
    self.TakeFaceCells(volume.deposit);
  }
}

void AxisSweep::Forget()
{
  if (this->Inner->IsPeriodic())
  {
    this->Inner->OwnMaps.Fill(0.0f);
  }
}

SweepTally AxisSweep::Finish()
{
  Implementation& self = *this->Inner;
  if (!self.IsPeriodic() && !self.Dark)
  {
    self.CountSideways();
    self.CountEnds();
  }
  return self.Tally;
}
}
