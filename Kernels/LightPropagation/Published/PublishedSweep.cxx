#include "LightPropagation/Published/PublishedSweep.h"

#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "TyndallKernelSources.h"

#include <string>

namespace tyndall
{
namespace
{
/// Voxel crossings between progress reports; about 50 ms on two cores.
constexpr double CrossingsPerReport = 3e7;
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

/// Boundary radiance perpendicular to w, u, v: [direction][3][channel].
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

/// Counts incident power: of rays that start on the map, and of those that enter through a side.
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

/// Reads the outgoing radiance of a pass, in the layout of PublishedPropagate.cl.
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
  const bool rows = this->Volumes.Width > 1; // one work-item per row, else per voxel
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
