#include "LightPropagation/Published/ParallelPropagation.h"

#include "Device/Defines.h"
#include "Light/ChannelReduction.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Published/PublishedBorders.h"
#include "LightPropagation/Published/PublishedFaces.h"
#include "LightPropagation/Published/PublishedPlan.h"
#include "LightPropagation/Published/PublishedVolumes.h"
#include "LightPropagation/Published/PublishedWarmStart.h"
#include "Medium/BoxFaces.h"
#include "TyndallKernelSources.h"

#include "Device/Sizes.h"

#include <string>

namespace tyndall
{
namespace
{
/// Voxel crossings between two reports; about 50 ms on two cores.
constexpr double CrossingsPerReport = 3e7;

/// Which argument of cross_voxels is the first that only kernels with FACES have.
constexpr cl_uint FacesOfCrossVoxels = 11;

using Batch = PublishedPlan::Batch;
using Pass = PublishedPlan::Pass;
using Launch = PublishedPlan::Launch;
}

struct ParallelPropagation::Implementation
{
  Implementation(Device& device, const Medium& medium, const Illumination& illumination,
    const PropagationSettings& settings, std::size_t temporaryBytes, int channels, const KeptLight* kept)
    : TheDevice(device)
    , TheMedium(medium)
    , Outside(illumination)
    , Settings(settings)
    , Model(medium, illumination, settings, channels)
    , Traits(TraitsOf(medium))
    , Ledger(medium, this->Model, settings)
    , Channels(this->Model.Channels())
    , Volumes(device, medium, this->Model, device.KernelWidth(8, 16))
    , Plan(device, medium.grid, this->Model, settings, this->Volumes, temporaryBytes)
    , Borders(this->Model, settings, this->Plan)
    , Faces(medium.grid, this->Model, settings)
    , Warm(medium, this->Model, settings, kept)
    , Emits(this->Traits.emits || !settings.leaveOut)
  {
    this->MakeBuffers();
    this->MakeKernels();
  }

  void MakeBuffers();
  void MakeKernels();

  // One order
  bool FirstOrder() const { return this->Ledger.Orders() == 0 && !this->SourceGiven; }
  PublishedMap Describe(const Batch& batch) const;
  PublishedFaceCells DescribeFaces(const Batch& batch) const;
  void BeginFaces();
  void WriteBoundary(const Batch& batch);
  void Propagate(int number, const Monitor& monitor);
  void SendRays(const Batch& batch, const Pass& pass, const PublishedMap& info, const Monitor& monitor, double done);
  void CrossPlanes(const Batch& batch, const Pass& pass, const PublishedMap& info, const Monitor& monitor, double done);
  void Collect(int number);
  void FinishOrder();
  void UpdateSourcesOfOrder();
  void LookAtDirect();
  void Enqueue(cl::Kernel& kernel, std::array<int, 3> global, std::array<int, 3> local);

  // What came of it
  LightField Result() const;
  std::vector<float> ScatteredRadiance(std::size_t storedDirections) const;
  std::vector<float> NetFlux() const;

  Device& TheDevice;
  const Medium& TheMedium;
  Illumination Outside;
  PropagationSettings Settings;
  PublishedModel Model;
  MediumTraits Traits;
  OrderLedger Ledger;
  int Channels;
  PublishedVolumes Volumes;
  PublishedPlan Plan;
  PublishedBorders Borders;
  PublishedFaces Faces;
  PublishedWarmStart Warm;
  bool Emits; ///< U is not zero
  bool SourceGiven = false;
  std::vector<float> FluenceDirect;

  Buffer<float> Coefficients, Rays, Escaped, Contributions, Boundary;
  Buffer<float> Carried[2];   ///< of the order before, of this one
  Buffer<float> FaceIn, Left; ///< radiance that faces give back; what leaves through their cells
  cl::Kernel StartRays, CrossVoxels[2], EndRays, AddDirections, UpdateSources;
};

void ParallelPropagation::Implementation::MakeBuffers()
{
  Device& device = this->TheDevice;
  this->Coefficients = Buffer<float>(device, this->Plan.coefficients, "the scattering factors");
  this->Rays = Buffer<float>(device, this->Plan.raysSize, "the light propagation maps");
  this->Rays.Fill(0.0f);
  this->Escaped = Buffer<float>(device, this->Plan.escapedSize, "the light that leaves");
  for (Buffer<float>& buffer : this->Carried)
  {
    buffer = Buffer<float>(device, this->Plan.carriedSize, "the light on its way through a periodic axis");
    buffer.Fill(0.0f);
  }
  this->Contributions = Buffer<float>(device, this->Plan.contributionsSize, "the temporary buffers T");
  this->Boundary = Buffer<float>(device, this->Plan.boundarySize, "the boundary");
  if (this->Faces.Count())
  {
    this->FaceIn = Buffer<float>(device, this->Faces.Radiance().size(), "the light that faces give back");
    this->Left = Buffer<float>(device, this->Plan.leftSize, "the light that leaves through the faces");
  }
}

void ParallelPropagation::Implementation::MakeKernels()
{
  const std::string common = Define("REAL_WIDTH", this->Volumes.Width) + Define("CHANNELS", this->Channels) +
    Define("COLOURED", this->Volumes.Coloured);
  const std::string faces = Define("FACES", this->Faces.Count());
  const auto propagate = [&](const char* name, int source) {
    return this->TheDevice.Kernel(name, kernel_source::PublishedPropagate, common + faces + Define("SOURCE", source));
  };
  const auto collect = [&](const char* name) {
    return this->TheDevice.Kernel(
      name, kernel_source::PublishedCollect, common + Define("MOMENTS", this->Model.MomentCount()));
  };
  this->StartRays = propagate("start_rays", 1);
  this->CrossVoxels[0] = propagate("cross_voxels", 0);
  this->CrossVoxels[1] = propagate("cross_voxels", 1);
  this->EndRays = propagate("end_rays", 1);
  this->AddDirections = collect("add_directions");
  this->UpdateSources = collect("update_sources");
}

PublishedMap ParallelPropagation::Implementation::Describe(const Batch& batch) const
{
  const MapGeometry& map = batch.Map();
  const VolumeLayouts& layouts = this->Volumes.Layouts;
  const int rowStride = map.axis == 0 ? layouts.row[1] : map.axis == 1 ? layouts.plane[0] : layouts.row[0];
  return { map.sizeU, map.sizeV, rowStride, layouts.volume[batch.Layout()], this->Plan.RayRow(batch),
    this->Settings.periodic[map.axisU], this->Settings.periodic[map.axisV], this->Settings.periodic[map.axis],
    batch.count };
}

PublishedFaceCells ParallelPropagation::Implementation::DescribeFaces(const Batch& batch) const
{
  const MapGeometry& map = batch.Map();
  const auto layout = [&](int face) { return LayoutOfFace(this->TheMedium.grid, face); };
  const auto first = [&](int face) { return static_cast<cl_int>(layout(face).first); };
  const auto step = [&](int face, int axis) { return static_cast<cl_int>(layout(face).step[axis]); };
  const int w = map.EntryFace(map.axis), u = 2 * map.axisU, v = 2 * map.axisV;
  return { map.planes, static_cast<cl_int>(this->Faces.Cells()), first(w), step(w, map.axisU), step(w, map.axisV),
    { first(u), first(u + 1) }, step(u, map.axis), step(u, map.axisV), { first(v), first(v + 1) }, step(v, map.axis),
    step(v, map.axisU) };
}

/// Light from outside belongs to the first order.
void ParallelPropagation::Implementation::WriteBoundary(const Batch& batch)
{
  if (this->FirstOrder())
  {
    this->Boundary.Write(this->Borders.Radiance(batch).data());
    this->Borders.TallyEntered(batch, this->Ledger);
  }
  else
  {
    this->Boundary.Fill(0.0f);
  }
}

void ParallelPropagation::Implementation::Propagate(int number, const Monitor& monitor)
{
  Batch& batch = this->Plan.batches[number];
  const double batches = static_cast<double>(this->Plan.batches.size());
  if (this->Ledger.Orders() > 0 && this->Settings.periodic[batch.Map().axis])
  {
    this->Plan.MakePasses(batch, this->Ledger.Orders()); // rays go on from where they were
  }
  this->WriteBoundary(batch);
  this->BeginFaces();
  const PublishedMap info = this->Describe(batch);
  for (std::size_t p = 0; p < batch.passes.size(); ++p)
  {
    this->SendRays(
      batch, batch.passes[p], info, monitor, (number + p / static_cast<double>(batch.passes.size())) / batches);
  }
  if (this->Faces.Count())
  {
    this->Borders.TallyLeft(batch, this->Left.Read(), this->Faces);
  }
  Report(monitor, this->Ledger.Progress((number + 1.0) / batches));
}

void ParallelPropagation::Implementation::BeginFaces()
{
  if (this->Faces.Count())
  {
    this->FaceIn.Write(this->Faces.Radiance().data());
    this->Left.Fill(0.0f);
  }
}

/// One ray a voxel of the map and direction, from the first plane to behind the last.
void ParallelPropagation::Implementation::SendRays(
  const Batch& batch, const Pass& pass, const PublishedMap& info, const Monitor& monitor, double done)
{
  const int slots = batch.count * this->Channels;
  const cl_ulong carriedFirst = pass.carriedFirst;
  const cl_ulong carriedStride = this->Plan.CarriedStride(batch);
  this->Escaped.Fill(0.0f);
  With(this->StartRays, info, this->Rays, this->Boundary, this->Carried[0], carriedFirst, carriedStride);
  With(this->EndRays, info, static_cast<cl_int>(pass.end), batch.crossings, this->Rays, this->Escaped, this->Carried[1],
    carriedFirst, carriedStride);
  if (this->Faces.Count())
  {
    SetFrom(this->StartRays, 6, this->DescribeFaces(batch), this->FaceIn);
    SetFrom(this->EndRays, 8, this->DescribeFaces(batch), this->Left);
  }
  this->Enqueue(this->StartRays, { info.sizeU + 2, info.sizeV + 2, slots }, { 32, 8, 1 });
  this->CrossPlanes(batch, pass, info, monitor, done);
  this->Enqueue(this->EndRays, { info.sizeV, slots, 1 }, { 16, 1, 1 });
  this->Borders.TallyEscaped(batch, this->Escaped.Read(), this->Ledger);
}

void ParallelPropagation::Implementation::CrossPlanes(
  const Batch& batch, const Pass& pass, const PublishedMap& info, const Monitor& monitor, double done)
{
  const VolumeLayouts& layouts = this->Volumes.Layouts;
  const int axis = batch.Map().axis;
  const int planeStride = axis == 0 ? layouts.plane[1] : axis == 1 ? layouts.row[0] : layouts.plane[0];
  const int layout = batch.Layout();
  cl::Kernel& kernel = this->CrossVoxels[this->FirstOrder() && !this->Emits ? 0 : 1];
  With(kernel, info, cl_int(0), cl_int(0), cl_int(0), batch.crossings, this->Volumes.Extinction[layout],
    this->Volumes.Scattering[layout], this->Volumes.Sources[layout], this->Rays, this->Contributions, this->Escaped);
  if (this->Faces.Count())
  {
    SetFrom(
      kernel, FacesOfCrossVoxels, this->DescribeFaces(batch), cl_int(0), this->Boundary, this->FaceIn, this->Left);
  }
  const bool rows = this->Volumes.Width > 1; // a work-item a row, else a voxel
  double sinceReport = 0.0;
  for (std::size_t l = 0; l < pass.launches.size(); ++l)
  {
    const Launch& launch = pass.launches[l];
    kernel.setArg(1, launch.plane * planeStride);
    kernel.setArg(2, static_cast<cl_int>(launch.add));
    kernel.setArg(3, static_cast<cl_int>(launch.first));
    if (this->Faces.Count())
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
      const std::size_t launches = pass.launches.size() * batch.passes.size() * this->Plan.batches.size();
      Report(monitor, this->Ledger.Progress(done + (l + 1.0) / launches));
    }
  }
}

void ParallelPropagation::Implementation::Collect(int number)
{
  const Batch& batch = this->Plan.batches[number];
  const int layout = batch.Layout();
  const bool begins = number == 0 || this->Plan.batches[number - 1].Layout() != layout;
  const cl_int volume = this->Volumes.Layouts.volume[layout];
  this->Enqueue(With(this->AddDirections, volume, static_cast<cl_int>(batch.count), static_cast<cl_int>(!begins),
                  batch.firstCoefficient, this->Coefficients, this->Contributions, this->Volumes.OrderMoments[layout]),
    { volume / this->Volumes.Width, this->Channels, 1 }, { 64, 1, 1 });
  this->TheDevice.Finish();
}

void ParallelPropagation::Implementation::FinishOrder()
{
  if (this->Ledger.Orders() == 1 && this->Warm.Begins())
  {
    this->Warm.TakeFrom(this->Volumes);
  }
  if (this->Ledger.Orders() == 0 && this->Outside.uncollided.IsThere())
  {
    this->Volumes.AddGiven(this->Outside.uncollided);
    this->Ledger.CountGiven(this->Outside.uncollided);
  }
  this->UpdateSourcesOfOrder();
  if (this->Ledger.Orders() == 0)
  {
    this->LookAtDirect();
  }
  this->Faces.CloseOrder(this->Ledger);
  this->Ledger.CloseOrder(this->Volumes.ReadMoment(this->Volumes.OrderMoments[0], 0).data());
  this->Ledger.carried = {};
  std::swap(this->Carried[0], this->Carried[1]);
  this->Emits = true; // from now on U is not zero
}

void ParallelPropagation::Implementation::UpdateSourcesOfOrder()
{
  const PublishedVolumes& volumes = this->Volumes;
  this->Enqueue(With(this->UpdateSources, volumes.Layouts, static_cast<cl_int>(volumes.Parts.Size()), volumes.Parts,
                  volumes.Scattering[0], volumes.OrderMoments[0], volumes.OrderMoments[1], volumes.Totals,
                  volumes.Sources[0], volumes.Sources[1]),
    { volumes.Layouts.size[0], volumes.Layouts.size[1], volumes.Layouts.size[2] * this->Channels }, { 32, 8, 1 });
}

void ParallelPropagation::Implementation::LookAtDirect()
{
  this->FluenceDirect = this->Volumes.ReadMoment(this->Volumes.OrderMoments[0], 0);
  if (this->Warm.Keeps())
  {
    this->Warm.AddTo(this->Volumes, this->Faces, this->FluenceDirect);
  }
  if (this->Warm.Begins())
  {
    this->UpdateSourcesOfOrder();
    this->Ledger.BeginWarm(this->Warm.Rate());
  }
}

void ParallelPropagation::Implementation::Enqueue(
  cl::Kernel& kernel, std::array<int, 3> global, std::array<int, 3> local)
{
  const auto size = [&](int d) { return static_cast<std::size_t>(RoundUp(global[d], local[d])); };
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(size(0), size(1), size(2)), cl::NDRange(local[0], local[1], local[2]));
}

LightField ParallelPropagation::Implementation::Result() const
{
  LightField field;
  field.channels = this->Channels;
  field.fluence = this->Volumes.ReadMoment(this->Volumes.Totals, 0);
  field.fluenceDirect = this->FluenceDirect;
  field.storedDirections = this->Model.StoredDirections();
  field.scatteredRadiance = this->ScatteredRadiance(field.storedDirections.size());
  if (this->Settings.netFlux)
  {
    field.netFlux = this->NetFlux();
  }
  this->Ledger.WriteTo(field);
  this->Faces.WriteTo(field);
  field.leftOut =
    LeftOutAsPublished(this->TheMedium, this->Traits, this->Outside, this->Settings, this->Ledger.Orders());
  if (this->Warm.Keeps())
  {
    field.leftOut.push_back(this->Warm.Words());
  }
  field.halfRangeFlux = HalfRangeFlux(this->Model.Directions());
  field.device = this->TheDevice.Name();
  JudgeConvergence(this->Settings, field);
  DoubtGivenLight(this->Outside, field);
  return field;
}

std::vector<float> ParallelPropagation::Implementation::ScatteredRadiance(std::size_t storedDirections) const
{
  const std::size_t channels = static_cast<std::size_t>(this->Channels);
  std::vector<float> radiance(this->TheMedium.grid.VoxelCount() * channels * storedDirections);
  for (std::size_t d = 0; d < storedDirections; ++d)
  {
    const PublishedModel::Part part = this->Model.ScatteredRadiance(static_cast<int>(d));
    const std::vector<float> moment = this->Volumes.ReadMoment(this->Volumes.Totals, part.moment);
    for (std::size_t i = 0; i < moment.size(); ++i)
    {
      radiance[(i / channels * storedDirections + d) * channels + i % channels] =
        static_cast<float>(part.factor) * moment[i];
    }
  }
  return radiance;
}

std::vector<float> ParallelPropagation::Implementation::NetFlux() const
{
  std::vector<float> netFlux(3 * this->TheMedium.grid.VoxelCount() * this->Channels);
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<float> flux = this->Volumes.ReadMoment(this->Volumes.Totals, this->Model.NetFlux(axis));
    for (std::size_t i = 0; i < flux.size(); ++i)
    {
      netFlux[3 * i + axis] = flux[i];
    }
  }
  return netFlux;
}

ParallelPropagation::ParallelPropagation(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, std::size_t temporaryBytes, int channels, const KeptLight* kept)
  : Inner(std::make_unique<Implementation>(device, medium, illumination, settings, temporaryBytes, channels, kept))
{
}

ParallelPropagation::~ParallelPropagation() = default;

const PublishedModel& ParallelPropagation::Model() const
{
  return this->Inner->Model;
}

int ParallelPropagation::BatchCount() const
{
  return static_cast<int>(this->Inner->Plan.batches.size());
}

int ParallelPropagation::FirstDirection(int batch) const
{
  return batch < this->BatchCount() ? this->Inner->Plan.batches[batch].first
                                    : static_cast<int>(this->Model().Directions().directions.size());
}

void ParallelPropagation::Propagate(int batch, const Monitor& monitor)
{
  this->Inner->Propagate(batch, monitor);
}

void ParallelPropagation::Collect(int batch)
{
  this->Inner->Collect(batch);
}

void ParallelPropagation::FinishOrder()
{
  this->Inner->FinishOrder();
}

void ParallelPropagation::RunOrder(const Monitor& monitor)
{
  for (int batch = 0; batch < this->BatchCount(); ++batch)
  {
    this->Propagate(batch, monitor);
    this->Collect(batch);
  }
  this->FinishOrder();
}

bool ParallelPropagation::Done() const
{
  return this->Inner->Ledger.Done();
}

std::vector<std::vector<float>> ParallelPropagation::Contributions(int batch) const
{
  const PublishedVolumes& volumes = this->Inner->Volumes;
  const Batch& which = this->Inner->Plan.batches[batch];
  const std::size_t size = volumes.LayoutSize(which.Layout());
  std::vector<std::vector<float>> contributions;
  contributions.reserve(which.count);
  for (int i = 0; i < which.count; ++i)
  {
    contributions.push_back(
      volumes.Interleave(which.Layout(), volumes.ReadPart(this->Inner->Contributions, i * size, size).data()));
  }
  return contributions;
}

void ParallelPropagation::SetContributions(int batch, const std::vector<std::vector<float>>& contributions)
{
  const Batch& which = this->Inner->Plan.batches[batch];
  for (int i = 0; i < which.count; ++i)
  {
    const std::vector<float> arranged = this->Inner->Volumes.Arrange(which.Layout(), contributions[i].data());
    this->Inner->TheDevice.Queue().enqueueWriteBuffer(this->Inner->Contributions.Handle(), CL_TRUE,
      i * arranged.size() * sizeof(float), arranged.size() * sizeof(float), arranged.data());
  }
}

std::vector<float> ParallelPropagation::Source() const
{
  return this->Inner->Volumes.ReadSource();
}

void ParallelPropagation::SetSource(const std::vector<float>& source)
{
  this->Inner->Volumes.WriteSource(source);
  this->Inner->SourceGiven = true;
  this->Inner->Emits = true;
}

LightField ParallelPropagation::Result() const
{
  return this->Inner->Result();
}

KeptLight ParallelPropagation::Left() const
{
  return this->Inner->Warm.Leave(this->Inner->Volumes, this->Inner->Faces, this->Inner->Ledger.Rate());
}

bool ParallelPropagation::BeganWarm() const
{
  return this->Inner->Warm.Begins();
}

LightField SolveParallel(Device& device, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor, std::size_t temporaryBytes, KeptLight* kept)
{
  Check(medium);
  CheckPublishedPhase(medium); // before channels become one
  Check(illumination);
  const SceneChannels channels(medium, TraitsOf(medium), illumination);
  return SolveChannels(settings.leaveOut, channels, medium, illumination,
    [&](const Medium& ofChannels, const Illumination& light, int count) {
      ParallelPropagation propagation(device, ofChannels, light, settings, temporaryBytes, count, kept);
      do
      {
        propagation.RunOrder(monitor);
      } while (!propagation.Done());
      LightField found = propagation.Result();
      if (kept)
      {
        Keep(propagation.Left(), propagation.BeganWarm(), found, *kept);
      }
      return found;
    });
}
}
