#include "LightPropagation/Published/PublishedSweep.h"

#include "Device/Device.h"
#include "Device/Sizes.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <string>

namespace tyndall
{
namespace
{
/// Number of voxel crossings between progress reports; about 50 ms on two cores.
constexpr double CrossingsPerReport = 3e7;
}

PublishedPlan::PublishedPlan(Device& device, const Grid& grid, const PublishedModel& model,
  const PropagationSettings& settings, const PublishedVolumes& volumes, std::size_t temporaryBytes)
  : TheDevice(device)
  , TheGrid(grid)
  , Model(model)
  , Settings(settings)
  , Volumes(volumes)
{
  const int perBatch = this->DirectionsPerBatch(temporaryBytes);
  this->MakeBatches(perBatch);
  this->MeasureBuffers(perBatch);
}

/// Number of directions per batch: all of a cube face if their temporary buffers T fit into the remaining memory; at
/// least one.
int PublishedPlan::DirectionsPerBatch(std::size_t temporaryBytes) const
{
  const int perFace = this->Model.Directions().PerFace();
  const std::size_t one = this->LargestLayout() * sizeof(float);
  const double maps = 4.0; // two ray maps, and as much memory again for the tables of voxel crossings
  const std::size_t map =
    static_cast<std::size_t>(maps * this->Volumes.Channels() * sizeof(float) * this->LargestRayMap());
  const std::size_t taken = this->TheDevice.BytesInUse() + map * perFace;
  const std::size_t left = this->TheDevice.MemoryLimit() - std::min(taken, this->TheDevice.MemoryLimit());
  std::size_t most = std::min(left, this->TheDevice.AllocationLimit());
  most = temporaryBytes > 0 ? std::min(most, temporaryBytes) : most;
  return static_cast<int>(std::clamp<std::size_t>(most / one, 1, perFace));
}

std::size_t PublishedPlan::LargestLayout() const
{
  return std::max(this->Volumes.LayoutSize(0), this->Volumes.LayoutSize(1));
}

double PublishedPlan::LargestRayMap() const
{
  const Grid& grid = this->TheGrid;
  const int width = this->Volumes.Width;
  double largest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double u = grid.size[AcrossAxis(axis).u];
    const double v = grid.size[AcrossAxis(axis).v];
    largest = std::max(largest, (u + 3.0 * width) * (v + 2.0));
  }
  return largest;
}

void PublishedPlan::MakeBatches(int perBatch)
{
  const DirectionSet& set = this->Model.Directions();
  const int perFace = set.PerFace();
  std::vector<float> factors;
  for (int face = 0; face < 6; ++face)
  {
    for (int first = 0; first < perFace; first += perBatch)
    {
      Batch batch;
      batch.first = face * perFace + first;
      batch.count = std::min(perBatch, perFace - first);
      for (int i = batch.first; i < batch.first + batch.count; ++i)
      {
        batch.maps.emplace_back(this->TheGrid, this->Settings, set.directions[i], i, perFace);
      }
      if (this->Settings.periodic[batch.Map().axis])
      {
        batch.carriedFirst = this->sizes.carried;
        this->sizes.carried += this->CarriedStride(batch) * batch.count;
      }
      this->MakePasses(batch, 0);
      this->AppendCoefficients(batch, factors);
      this->batches.push_back(std::move(batch));
    }
  }
  this->coefficients = Buffer<float>(this->TheDevice, factors, "the scattering factors");
}

void PublishedPlan::MeasureBuffers(int perBatch)
{
  for (const Batch& batch : this->batches)
  {
    const std::size_t slots = static_cast<std::size_t>(batch.count) * this->Volumes.Channels();
    const std::size_t rows = batch.Map().sizeV;
    // Two ray maps: before and after a voxel crossing
    this->sizes.rays = std::max(this->sizes.rays, 2 * slots * (rows + 2) * this->RayRow(batch));
    this->sizes.escaped = std::max(this->sizes.escaped, slots * (2 * rows + 1));
  }
  this->sizes.contributions = perBatch * this->LargestLayout();
  this->sizes.boundary = static_cast<std::size_t>(this->Model.Directions().PerFace()) * 3 * this->Volumes.Channels();
}

int PublishedPlan::RayRow(const Batch& batch) const
{
  return RoundUp(batch.Map().sizeU, this->Volumes.Width) + 2 * this->Volumes.Width;
}

std::size_t PublishedPlan::CarriedStride(const Batch& batch) const
{
  return static_cast<std::size_t>(batch.Map().sizeU) * batch.Map().sizeV * this->Volumes.Channels() * this->SubMaps();
}

void PublishedPlan::AppendCoefficients(Batch& batch, std::vector<float>& to) const
{
  batch.firstCoefficient = static_cast<cl_int>(to.size());
  for (int k = 0; k < this->Model.MomentCount(); ++k)
  {
    for (int i = 0; i < batch.count; ++i)
    {
      to.push_back(static_cast<float>(this->Model.Coefficient(k, batch.first + i) * batch.maps[i].density));
    }
  }
}

/// Lists the voxel crossings of all directions, ordered by sub-map (rays that start at the same position within their
/// voxels), plane and launch.
void PublishedPlan::MakePasses(Batch& batch, int order) const
{
  std::vector<PublishedCrossing> crossings;
  batch.passes.clear();
  for (int subMap = 0; subMap < this->SubMaps(); ++subMap)
  {
    CrossingsByPlane byPlane(batch.Map().planes);
    std::vector<PublishedCrossing> ends;
    for (int i = 0; i < batch.count; ++i)
    {
      this->WalkThrough(batch, i, subMap, order, byPlane, ends);
    }
    Pass pass;
    for (int plane = 0; plane < batch.Map().planes; ++plane)
    {
      for (std::size_t voxel = 0; voxel < byPlane[plane].size(); ++voxel)
      {
        const std::vector<PublishedCrossing>& together = byPlane[plane][voxel];
        pass.launches.push_back({ batch.Map().PlaneAt(plane), static_cast<int>(crossings.size()),
          static_cast<int>(together.size()), subMap > 0 || voxel > 0 });
        crossings.insert(crossings.end(), together.begin(), together.end());
      }
    }
    pass.end = static_cast<int>(crossings.size());
    crossings.insert(crossings.end(), ends.begin(), ends.end());
    pass.carriedFirst = batch.carriedFirst + subMap * (this->CarriedStride(batch) / this->SubMaps());
    batch.passes.push_back(std::move(pass));
  }
  batch.crossings = Buffer<PublishedCrossing>(this->TheDevice, crossings, "the table of voxel crossings");
}

GridWalk PublishedPlan::Walk(const MapGeometry& map, int subMap, int order) const
{
  return map.Walk(this->Settings.mapResolution, subMap, order);
}

/// Adds to `byPlane` the voxel crossings of direction i of a batch, for the rays of one sub-map (those that start at
/// the same position within their voxels). Adds to `ends` the entry that end_rays() reads.
void PublishedPlan::WalkThrough(const Batch& batch, int i, int subMap, int order, CrossingsByPlane& byPlane,
  std::vector<PublishedCrossing>& ends) const
{
  const int source = this->Volumes.SourceSlot(batch.Layout(), this->Model.SourceOf(batch.first + i));
  GridWalk walk = this->Walk(batch.maps[i], subMap, order);
  int parity = 0;
  int plane = -1;
  std::size_t voxel = 0;
  while (walk.Next())
  {
    voxel = walk.plane == plane ? voxel + 1 : 0;
    plane = walk.plane;
    byPlane[plane].resize(std::max(byPlane[plane].size(), voxel + 1));
    byPlane[plane][voxel].push_back(
      { i, parity, walk.moveU, walk.moveV, source, static_cast<float>(walk.fraction * batch.maps[i].length) });
    parity = 1 - parity;
  }
  ends.push_back({ i, parity, 0, 0, 0, 0.0f });
}

PublishedSweep::PublishedSweep(Device& device, const PublishedVolumes& volumes, const PublishedPlan& plan,
  const PublishedModel& model, const PropagationSettings& settings)
  : TheDevice(device)
  , Volumes(volumes)
  , Plan(plan)
  , Model(model)
  , Periodic(settings.periodic)
  , Channels(model.Channels())
{
  const PublishedSizes& sizes = plan.sizes;
  this->Rays = Buffer<float>(device, sizes.rays, "the light propagation maps");
  this->Rays.Fill(0.0f);
  this->Escaped = Buffer<float>(device, sizes.escaped, "the light that leaves");
  this->Carried = Buffer<float>(device, sizes.carried, "the light on its way through a periodic axis");
  this->Carried.Fill(0.0f);
  this->Contributions = Buffer<float>(device, sizes.contributions, "the temporary buffers T");
  this->Boundary = Buffer<float>(device, sizes.boundary, "the boundary");
  this->MakeKernels();
}

void PublishedSweep::MakeKernels()
{
  const std::string common = Define("REAL_WIDTH", this->Volumes.Width) + Define("CHANNELS", this->Channels) +
    Define("COLOURED", this->Volumes.Coloured);
  const auto propagate = [&](const char* name, int source) {
    return this->TheDevice.Kernel(name, kernel_source::PublishedPropagate, common + Define("SOURCE", source));
  };
  this->StartRays = propagate("start_rays", 1);
  this->CrossVoxels[0] = propagate("cross_voxels", 0);
  this->CrossVoxels[1] = propagate("cross_voxels", 1);
  this->EndRays = propagate("end_rays", 1);
  this->AddDirections = this->TheDevice.Kernel(
    "add_directions", kernel_source::PublishedCollect, common + Define("MOMENTS", this->Model.MomentCount()));
}

PublishedMap PublishedSweep::Describe(const Batch& batch) const
{
  const MapGeometry& map = batch.Map();
  const VolumeLayouts& layouts = this->Volumes.Layouts;
  const int rowStride = map.axis == 0 ? layouts.row[1] : map.axis == 1 ? layouts.plane[0] : layouts.row[0];
  return { map.sizeU, map.sizeV, rowStride, layouts.volume[batch.Layout()], this->Plan.RayRow(batch),
    this->Periodic[map.axisU], this->Periodic[map.axisV], this->Periodic[map.axis], batch.count };
}

void PublishedSweep::Begin(const Batch& batch, bool incident, SweepTally& tally)
{
  if (!incident)
  {
    this->Boundary.Fill(0.0f);
    return;
  }
  const std::vector<float> radiance = this->IncidentRadiance(batch);
  this->Boundary.Write(radiance.data(), radiance.size());
  this->TallyIncident(batch, tally);
}

/// Incident radiance of a batch's directions through the faces across w, u, v, W / (length^2 sr):
/// [direction][3][channel].
std::vector<float> PublishedSweep::IncidentRadiance(const Batch& batch) const
{
  std::vector<float> radiance;
  for (int i = 0; i < batch.count; ++i)
  {
    for (int axis : { batch.maps[i].axis, batch.maps[i].axisU, batch.maps[i].axisV })
    {
      const Rgb& boundary = this->Model.Boundary(batch.first + i, axis);
      radiance.insert(radiance.end(), boundary.begin(), boundary.begin() + this->Channels);
    }
  }
  radiance.resize(this->Plan.sizes.boundary);
  return radiance;
}

/// Adds the incident power of a batch of directions to `tally`: that of rays that start on the first plane, and that of
/// rays that enter through the sides.
void PublishedSweep::TallyIncident(const Batch& batch, SweepTally& tally) const
{
  for (int i = 0; i < batch.count; ++i)
  {
    const MapGeometry& map = batch.maps[i];
    const auto enter = [&](int axis, double rays) {
      const Rgb& boundary = this->Model.Boundary(batch.first + i, axis);
      for (int c = 0; c < this->Channels; ++c)
      {
        tally.in[map.EntryFace(axis)][c] += rays * map.beamPower * boundary[c];
      }
    };
    enter(map.axis, static_cast<double>(map.sizeU) * map.sizeV * this->Plan.SubMaps());
    for (int subMap = 0; subMap < this->Plan.SubMaps(); ++subMap)
    {
      GridWalk walk = this->Plan.Walk(map, subMap, 0);
      while (walk.Next())
      {
        const bool entersU = walk.moveU != 0 && !this->Periodic[map.axisU];
        const bool entersV = walk.moveV != 0 && !this->Periodic[map.axisV];
        const double edge = entersU && entersV ? 0.5 : 0.0; // the ray enters half through each side
        enter(map.axisU, entersU ? map.sizeV - edge : 0.0);
        enter(map.axisV, entersV ? map.sizeU - edge : 0.0);
      }
    }
  }
}

/// Adds to `tally` the outgoing power of a pass (all rays of a batch on one sub-map), from the outgoing radiance in the
/// layout of PublishedPropagate.cl.
void PublishedSweep::TallyEscaped(const Batch& batch, SweepTally& tally) const
{
  const std::vector<float> escaped = this->Escaped.Read();
  const int rows = batch.Map().sizeV;
  std::size_t at = 0;
  for (const MapGeometry& map : batch.maps)
  {
    const auto take = [&](int count) {
      double sum = 0.0;
      for (int k = 0; k < count; ++k)
      {
        sum += escaped[at++];
      }
      return map.beamPower * sum;
    };
    for (int c = 0; c < this->Channels; ++c)
    {
      tally.out[map.ExitFace(map.axisU)][c] += take(rows);
      tally.out[map.ExitFace(map.axisV)][c] += take(1);
      (this->Periodic[map.axis] ? tally.onTheWay[c] : tally.out[map.ExitFace(map.axis)][c]) += take(rows);
    }
  }
}

void PublishedSweep::Send(
  const Batch& batch, const Pass& pass, bool emits, SweepTally& tally, const std::function<void(double)>& report)
{
  const PublishedMap info = this->Describe(batch);
  const int slots = batch.count * this->Channels;
  const cl_ulong carriedFirst = pass.carriedFirst;
  const cl_ulong carriedStride = this->Plan.CarriedStride(batch);
  this->Escaped.Fill(0.0f);
  With(this->StartRays, info, this->Rays, this->Boundary, this->Carried, carriedFirst, carriedStride);
  With(this->EndRays, info, static_cast<cl_int>(pass.end), batch.crossings, this->Rays, this->Escaped, this->Carried,
    carriedFirst, carriedStride);
  this->Enqueue(this->StartRays, { info.sizeU + 2, info.sizeV + 2, slots }, { 32, 8, 1 });
  this->CrossPlanes(batch, pass, info, emits, report);
  this->Enqueue(this->EndRays, { info.sizeV, slots, 1 }, { 16, 1, 1 });
  this->TallyEscaped(batch, tally);
}

void PublishedSweep::CrossPlanes(
  const Batch& batch, const Pass& pass, const PublishedMap& info, bool emits, const std::function<void(double)>& report)
{
  const VolumeLayouts& layouts = this->Volumes.Layouts;
  const int axis = batch.Map().axis;
  const int planeStride = axis == 0 ? layouts.plane[1] : axis == 1 ? layouts.row[0] : layouts.plane[0];
  const int layout = batch.Layout();
  cl::Kernel& kernel = this->CrossVoxels[emits ? 1 : 0];
  With(kernel, info, cl_int(0), cl_int(0), cl_int(0), batch.crossings, this->Volumes.Extinction[layout],
    this->Volumes.Scattering[layout], this->Volumes.Sources[layout], this->Rays, this->Contributions, this->Escaped);
  const bool rows = this->Volumes.Width > 1; // whether a work-item processes a row; false: one voxel
  double sinceReport = 0.0;
  for (std::size_t l = 0; l < pass.launches.size(); ++l)
  {
    const PublishedPlan::Launch& launch = pass.launches[l];
    kernel.setArg(1, launch.plane * planeStride);
    kernel.setArg(2, static_cast<cl_int>(launch.add));
    kernel.setArg(3, static_cast<cl_int>(launch.first));
    const int slots = launch.count * this->Channels;
    rows ? this->Enqueue(kernel, { 1, info.sizeV, slots }, { 1, 16, 1 })
         : this->Enqueue(kernel, { info.sizeU, info.sizeV, slots }, { 32, 8, 1 });
    sinceReport += static_cast<double>(info.sizeU) * info.sizeV * slots;
    if (sinceReport > CrossingsPerReport)
    {
      sinceReport = 0.0;
      this->TheDevice.Finish();
      report((static_cast<double>(l) + 1.0) / static_cast<double>(pass.launches.size()));
    }
  }
}

void PublishedSweep::Collect(const Batch& batch, bool begins)
{
  const int layout = batch.Layout();
  const cl_int volume = this->Volumes.Layouts.volume[layout];
  this->Enqueue(
    With(this->AddDirections, volume, static_cast<cl_int>(batch.count), static_cast<cl_int>(!begins),
      batch.firstCoefficient, this->Plan.coefficients, this->Contributions, this->Volumes.OrderMoments[layout]),
    { volume / this->Volumes.Width, this->Channels, 1 }, { 64, 1, 1 });
  this->TheDevice.Finish();
}

void PublishedSweep::Enqueue(cl::Kernel& kernel, std::array<int, 3> global, std::array<int, 3> local)
{
  const auto size = [&](int d) { return static_cast<std::size_t>(RoundUp(global[d], local[d])); };
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(size(0), size(1), size(2)), cl::NDRange(local[0], local[1], local[2]));
}
}
