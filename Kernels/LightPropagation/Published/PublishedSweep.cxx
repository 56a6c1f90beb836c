#include "LightPropagation/Published/PublishedSweep.h"

#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "Medium/BoxFaces.h"
#include "TyndallKernelSources.h"

#include <string>

namespace tyndall
{
namespace
{
/// Voxel crossings between two reports; about 50 ms on two cores.
constexpr double CrossingsPerReport = 3e7;

/// Which argument of cross_voxels is the first that only kernels with FACES have.
constexpr cl_uint FacesOfCrossVoxels = 11;
}

PublishedSweep::PublishedSweep(Device& device, const PublishedVolumes& volumes, const PublishedModel& model,
  const PropagationSettings& settings, const PublishedSizes& sizes, std::size_t cellsOfFaces)
  : TheDevice(device)
  , Periodic(settings.periodic)
  , Channels(model.Channels())
  , CellsOfFaces(cellsOfFaces)
{
  this->Rays = Buffer<float>(device, sizes.rays, "the light propagation maps");
  this->Rays.Fill(0.0f);
  this->Escaped = Buffer<float>(device, sizes.escaped, "the light that leaves");
  for (Buffer<float>& buffer : this->Carried)
  {
    buffer = Buffer<float>(device, sizes.carried, "the light on its way through a periodic axis");
    buffer.Fill(0.0f);
  }
  this->Contributions = Buffer<float>(device, sizes.contributions, "the temporary buffers T");
  this->Boundary = Buffer<float>(device, sizes.boundary, "the boundary");
  if (this->CountsCells())
  {
    this->FaceIn = Buffer<float>(device, cellsOfFaces * this->Channels, "the light that faces give back");
    this->Left = Buffer<float>(device, sizes.left, "the light that leaves through the faces");
  }
  this->MakeKernels(volumes, model);
}

void PublishedSweep::MakeKernels(const PublishedVolumes& volumes, const PublishedModel& model)
{
  const std::string common =
    Define("REAL_WIDTH", volumes.Width) + Define("CHANNELS", this->Channels) + Define("COLOURED", volumes.Coloured);
  const std::string faces = Define("FACES", this->CountsCells());
  const auto propagate = [&](const char* name, int source) {
    return this->TheDevice.Kernel(name, kernel_source::PublishedPropagate, common + faces + Define("SOURCE", source));
  };
  this->StartRays = propagate("start_rays", 1);
  this->CrossVoxels[0] = propagate("cross_voxels", 0);
  this->CrossVoxels[1] = propagate("cross_voxels", 1);
  this->EndRays = propagate("end_rays", 1);
  this->AddDirections = this->TheDevice.Kernel(
    "add_directions", kernel_source::PublishedCollect, common + Define("MOMENTS", model.MomentCount()));
}

PublishedMap PublishedSweep::Describe(
  const PublishedVolumes& volumes, const PublishedPlan& plan, const Batch& batch, const Ends& ends) const
{
  const MapGeometry& map = batch.Map();
  const VolumeLayouts& layouts = volumes.Layouts;
  const int rowStride = map.axis == 0 ? layouts.row[1] : map.axis == 1 ? layouts.plane[0] : layouts.row[0];
  return { map.sizeU, map.sizeV, rowStride, layouts.volume[batch.Layout()], plan.RayRow(batch),
    this->Periodic[map.axisU], this->Periodic[map.axisV], ends.given, ends.kept, batch.count };
}

PublishedFaceCells PublishedSweep::DescribeFaces(const PublishedPlan& plan, const Batch& batch) const
{
  const MapGeometry& map = batch.Map();
  const auto layout = [&](int face) { return LayoutOfFace(plan.Whole(), face); };
  const auto step = [&](int face, int axis) { return static_cast<cl_int>(layout(face).step[axis]); };
  const auto first = [&](int face) { return static_cast<cl_int>(layout(face).first); };
  const auto aside = [&](int face) { return first(face) + plan.FirstPlane() * step(face, map.axis); };
  const int w = map.EntryFace(map.axis), u = 2 * map.axisU, v = 2 * map.axisV;
  return { plan.Planes(batch), static_cast<cl_int>(this->CellsOfFaces), first(w), step(w, map.axisU),
    step(w, map.axisV), { aside(u), aside(u + 1) }, step(u, map.axis), step(u, map.axisV), { aside(v), aside(v + 1) },
    step(v, map.axis), step(v, map.axisU) };
}

void PublishedSweep::Begin(const std::vector<float>& boundary, const std::vector<float>& faceRadiance)
{
  if (boundary.empty())
  {
    this->Boundary.Fill(0.0f);
  }
  else
  {
    this->Boundary.Write(boundary.data(), boundary.size());
  }
  if (this->CountsCells())
  {
    this->FaceIn.Write(faceRadiance.data());
    this->Left.Fill(0.0f);
  }
}

std::vector<float> PublishedSweep::Send(const PublishedVolumes& volumes, const PublishedPlan& plan, const Batch& batch,
  const Pass& pass, const Ends& ends, bool emits, const std::function<void(double)>& report)
{
  const PublishedMap info = this->Describe(volumes, plan, batch, ends);
  const int slots = batch.count * this->Channels;
  const cl_ulong carriedFirst = pass.carriedFirst;
  const cl_ulong carriedStride = plan.CarriedStride(batch);
  this->Escaped.Fill(0.0f);
  With(this->StartRays, info, this->Rays, this->Boundary, this->Carried[0], carriedFirst, carriedStride);
  With(this->EndRays, info, static_cast<cl_int>(pass.end), batch.crossings, this->Rays, this->Escaped, this->Carried[1],
    carriedFirst, carriedStride);
  if (this->CountsCells())
  {
    SetFrom(this->StartRays, 6, this->DescribeFaces(plan, batch), this->FaceIn);
    SetFrom(this->EndRays, 8, this->DescribeFaces(plan, batch), this->Left);
  }
  this->Enqueue(this->StartRays, { info.sizeU + 2, info.sizeV + 2, slots }, { 32, 8, 1 });
  this->CrossPlanes(volumes, plan, batch, pass, info, emits, report);
  this->Enqueue(this->EndRays, { info.sizeV, slots, 1 }, { 16, 1, 1 });
  return this->Escaped.Read();
}

void PublishedSweep::CrossPlanes(const PublishedVolumes& volumes, const PublishedPlan& plan, const Batch& batch,
  const Pass& pass, const PublishedMap& info, bool emits, const std::function<void(double)>& report)
{
  const VolumeLayouts& layouts = volumes.Layouts;
  const int axis = batch.Map().axis;
  const int planeStride = axis == 0 ? layouts.plane[1] : axis == 1 ? layouts.row[0] : layouts.plane[0];
  const int layout = batch.Layout();
  cl::Kernel& kernel = this->CrossVoxels[emits ? 1 : 0];
  With(kernel, info, cl_int(0), cl_int(0), cl_int(0), batch.crossings, volumes.Extinction[layout],
    volumes.Scattering[layout], volumes.Sources[layout], this->Rays, this->Contributions, this->Escaped);
  if (this->CountsCells())
  {
    SetFrom(kernel, FacesOfCrossVoxels, this->DescribeFaces(plan, batch), cl_int(0), this->Boundary, this->FaceIn,
      this->Left);
  }
  const bool rows = volumes.Width > 1; // a work-item a row, else a voxel
  double sinceReport = 0.0;
  for (std::size_t l = 0; l < pass.launches.size(); ++l)
  {
    const PublishedPlan::Launch& launch = pass.launches[l];
    kernel.setArg(1, launch.plane * planeStride);
    kernel.setArg(2, static_cast<cl_int>(launch.add));
    kernel.setArg(3, static_cast<cl_int>(launch.first));
    if (this->CountsCells())
    {
      kernel.setArg(FacesOfCrossVoxels + 1, static_cast<cl_int>(launch.plane));
    }
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

void PublishedSweep::Collect(
  const PublishedVolumes& volumes, const PublishedPlan& plan, const Batch& batch, bool begins)
{
  const int layout = batch.Layout();
  const cl_int volume = volumes.Layouts.volume[layout];
  this->Enqueue(With(this->AddDirections, volume, static_cast<cl_int>(batch.count), static_cast<cl_int>(!begins),
                  batch.firstCoefficient, plan.coefficients, this->Contributions, volumes.OrderMoments[layout]),
    { volume / volumes.Width, this->Channels, 1 }, { 64, 1, 1 });
  this->TheDevice.Finish();
}

void PublishedSweep::Enqueue(cl::Kernel& kernel, std::array<int, 3> global, std::array<int, 3> local)
{
  const auto size = [&](int d) { return static_cast<std::size_t>(RoundUp(global[d], local[d])); };
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(size(0), size(1), size(2)), cl::NDRange(local[0], local[1], local[2]));
}
}
