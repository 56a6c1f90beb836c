#include "LightPropagation/Distributed/Published/SlabRaysOnDevice.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
/// Of each the larger.
PublishedSizes Larger(const PublishedSizes& a, const PublishedSizes& b)
{
  return { std::max(a.rays, b.rays), std::max(a.escaped, b.escaped), std::max(a.carried, b.carried),
    std::max(a.contributions, b.contributions), std::max(a.boundary, b.boundary), std::max(a.left, b.left) };
}
}

SlabRaysOnDevice::SlabRaysOnDevice(Device& device, const Grid& whole, const PublishedModel& model,
  const PropagationSettings& settings, const PublishedFaces& faces)
  : TheDevice(device)
  , Whole(whole)
  , Model(model)
  , Settings(settings)
  , Faces(faces)
{
}

void SlabRaysOnDevice::TakePlanes(const PublishedSlab& slab, const Medium& medium)
{
  this->Across[slab.axis].slab = slab;
  this->Across[slab.axis].volumes.emplace(this->TheDevice, medium, this->Model, this->TheDevice.KernelWidth(8, 16),
    std::array<bool, 3>{ slab.axis == 0, slab.axis == 1, slab.axis == 2 });
}

int SlabRaysOnDevice::MostPerBatch() const
{
  int most = this->Model.Directions().PerFace();
  for (const Planes& planes : this->Across)
  {
    if (planes.volumes)
    {
      most = std::min(most,
        PublishedPlan::DirectionsPerBatch(
          this->TheDevice, this->Whole, this->Model, this->Settings, *planes.volumes, 0));
    }
  }
  return most;
}

void SlabRaysOnDevice::MakeBatches(int perBatch)
{
  const PublishedVolumes* any = nullptr;
  PublishedSizes sizes;
  for (Planes& planes : this->Across)
  {
    if (planes.volumes)
    {
      planes.plan.emplace(
        this->TheDevice, this->Whole, planes.slab, this->Model, this->Settings, *planes.volumes, perBatch);
      planes.borders.emplace(this->Model, this->Settings, *planes.plan);
      sizes = Larger(sizes, planes.plan->sizes);
      any = &*planes.volumes;
    }
  }
  if (any)
  {
    this->Sweep.emplace(
      this->TheDevice, *any, this->Model, this->Settings, sizes, this->Faces.Count() ? this->Faces.Cells() : 0);
  }
}

std::size_t SlabRaysOnDevice::Batches(int axis) const
{
  return this->Across[axis].plan ? this->Across[axis].plan->batches.size() : 0;
}

bool SlabRaysOnDevice::IsForward(int axis, std::size_t batch) const
{
  return this->Across[axis].plan->batches[batch].Map().forward;
}

std::size_t SlabRaysOnDevice::Passes(int axis, std::size_t batch) const
{
  return this->Across[axis].plan->batches[batch].passes.size();
}

std::size_t SlabRaysOnDevice::FloatsOfMap(int axis, std::size_t batch) const
{
  const PublishedPlan& plan = *this->Across[axis].plan;
  return plan.CarriedStride(plan.batches[batch]) * plan.batches[batch].count;
}

void SlabRaysOnDevice::BeginOrder()
{
  for (Planes& planes : this->Across)
  {
    planes.collected = false;
  }
}

void SlabRaysOnDevice::Begin(const Way& way, const PublishedFaces& faces, SweepTally& tally)
{
  Planes& planes = this->Across[way.axis];
  PublishedPlan::Batch& batch = planes.plan->batches[way.batch];
  const bool first = way.order == 0;
  if (!first && this->Settings.periodic[way.axis])
  {
    planes.plan->MakePasses(batch, way.order); // rays go on from where they were
  }
  this->Sweep->Begin(first ? planes.borders->Radiance(batch) : std::vector<float>(), faces.Radiance());
  if (first && way.begins)
  {
    planes.borders->TallyEntered(batch, tally);
  }
}

std::vector<float> SlabRaysOnDevice::Send(const Way& way, std::size_t pass, const std::vector<float>& given,
  PublishedFaces&, SweepTally& tally, const Monitor& monitor)
{
  Planes& planes = this->Across[way.axis];
  const PublishedPlan::Batch& batch = planes.plan->batches[way.batch];
  const std::size_t floats = this->FloatsOfMap(way.axis, way.batch);
  if (way.given)
  {
    const std::vector<float> rays = given.empty() ? std::vector<float>(floats, 0.0f) : given;
    this->Sweep->Carried[0].Write(rays.data(), floats);
  }
  const std::vector<float> escaped = this->Sweep->Send(*planes.volumes, *planes.plan, batch, batch.passes[pass],
    { way.given, way.kept }, way.order > 0 || way.emits, [&](double done) { Report(monitor, done); });
  planes.borders->TallyEscaped(batch, escaped, tally);
  std::vector<float> rays(way.kept ? floats : 0);
  this->Sweep->Carried[1].Read(rays.data(), rays.size());
  Report(monitor, 1.0);
  return rays;
}

void SlabRaysOnDevice::End(const Way& way, PublishedFaces& faces)
{
  Planes& planes = this->Across[way.axis];
  const PublishedPlan::Batch& batch = planes.plan->batches[way.batch];
  if (this->Sweep->CountsCells())
  {
    planes.borders->TallyLeft(batch, this->Sweep->LeftThroughCells(), faces);
  }
  this->Sweep->Collect(*planes.volumes, *planes.plan, batch, !std::exchange(planes.collected, true));
}

std::vector<float> SlabRaysOnDevice::Moment(int axis, int moment) const
{
  const PublishedVolumes& volumes = *this->Across[axis].volumes;
  const int layout = axis == 0 ? 1 : 0;
  return volumes.ReadMoment(volumes.OrderMoments[layout], moment, layout);
}

void SlabRaysOnDevice::WriteSource(int axis, int sourceDirection, const std::vector<float>& source)
{
  this->Across[axis].volumes->WriteSourceOf(sourceDirection, source);
}
}
