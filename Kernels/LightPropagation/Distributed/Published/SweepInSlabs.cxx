#include "LightPropagation/Distributed/Published/SweepInSlabs.h"

#include "Distribution/BoxExchange.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace tyndall
{
namespace
{
std::vector<float> ValuesOf(const Field& field, std::size_t voxels)
{
  const int components = field.HasColour() ? 3 : 1;
  std::vector<float> values;
  values.reserve(voxels * components);
  for (std::size_t voxel = 0; voxel < voxels; ++voxel)
  {
    for (int c = 0; c < components; ++c)
    {
      values.push_back(field.At(voxel, c));
    }
  }
  return values;
}

/// Of each the larger.
PublishedSizes Larger(const PublishedSizes& a, const PublishedSizes& b)
{
  return { std::max(a.rays, b.rays), std::max(a.escaped, b.escaped), std::max(a.carried, b.carried),
    std::max(a.contributions, b.contributions), std::max(a.boundary, b.boundary), std::max(a.left, b.left) };
}
}

SweepTally SumOverRanks(Communicator& communicator, const SweepTally& own)
{
  std::vector<double> values;
  const auto put = [&](const Rgb& rgb) { values.insert(values.end(), rgb.begin(), rgb.end()); };
  std::for_each(own.in.begin(), own.in.end(), put);
  std::for_each(own.out.begin(), own.out.end(), put);
  put(own.onTheWay);
  values = communicator.Sum(values);
  SweepTally all;
  auto from = values.begin();
  const auto take = [&](Rgb& rgb) {
    std::copy_n(from, 3, rgb.begin());
    from += 3;
  };
  std::for_each(all.in.begin(), all.in.end(), take);
  std::for_each(all.out.begin(), all.out.end(), take);
  take(all.onTheWay);
  return all;
}

SweepInSlabs::SweepInSlabs(Device& device, Communicator& communicator, const BlockPartition& blocks, const Medium& own,
  const PublishedModel& model, const PropagationSettings& settings, const PublishedFaces& faces)
  : TheDevice(device)
  , Others(communicator)
  , Blocks(blocks)
  , Model(model)
  , Settings(settings)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Slabs[axis].all.emplace(blocks, axis);
    this->MakeVolumes(axis, own);
  }
  const int perBatch = this->DirectionsPerBatch();
  communicator.Together([&] {
    this->MakePlans(perBatch, faces);
    this->MakeTasks();
  });
}

/// The medium of this rank's planes, from the blocks of those who have it.
void SweepInSlabs::MakeVolumes(int axis, const Medium& own)
{
  Slab& slab = this->Slabs[axis];
  const std::size_t voxels = this->Blocks.blocks[this->Others.Rank()].VoxelCount();
  std::array<std::vector<float>, 3> arrays;
  Medium medium;
  medium.grid = slab.all->boxes.OwnGrid(this->Others.Rank());
  const auto take = [&](Field Medium::*which, std::vector<float>& values) {
    const Field& field = own.*which;
    if (voxels > 0 && field.values)
    {
      const int components = field.HasColour() ? 3 : 1;
      values = ValuesInBox(this->Others, this->Blocks, slab.all->boxes.blocks, ValuesOf(field, voxels), components);
      medium.*which = { values.data(), components };
    }
  };
  take(&Medium::sigma_a, arrays[0]);
  take(&Medium::sigma_s, arrays[1]);
  take(&Medium::emission, arrays[2]);
  this->Others.Together([&] {
    if (medium.grid.VoxelCount() > 0)
    {
      slab.volumes.emplace(this->TheDevice, medium, this->Model, this->TheDevice.KernelWidth(8, 16),
        std::array<bool, 3>{ axis == 0, axis == 1, axis == 2 });
    }
  });
}

/// The same on all ranks: as many as fit all, and so few that ranks have batches to work on at once.
int SweepInSlabs::DirectionsPerBatch() const
{
  const int perFace = this->Model.Directions().PerFace();
  int most = perFace, ranks = 1;
  for (const Slab& slab : this->Slabs)
  {
    ranks = std::max(ranks, static_cast<int>(slab.all->ranks.size()));
    if (slab.volumes)
    {
      most = std::min(most,
        PublishedPlan::DirectionsPerBatch(
          this->TheDevice, this->Blocks.whole, this->Model, this->Settings, *slab.volumes, 0));
    }
  }
  most = -static_cast<int>(this->Others.Largest({ -1.0 * most })[0]);
  const int groups = std::min(ranks, perFace);
  return std::min(most, (perFace + groups - 1) / groups);
}

void SweepInSlabs::MakePlans(int perBatch, const PublishedFaces& faces)
{
  const PublishedVolumes* any = nullptr;
  PublishedSizes sizes;
  for (int axis = 0; axis < 3; ++axis)
  {
    Slab& slab = this->Slabs[axis];
    if (slab.volumes)
    {
      const VoxelBox& box = slab.all->boxes.blocks[this->Others.Rank()];
      slab.plan.emplace(this->TheDevice, this->Blocks.whole, PublishedSlab{ axis, box.first[axis], box.size[axis] },
        this->Model, this->Settings, *slab.volumes, perBatch);
      slab.borders.emplace(this->Model, this->Settings, *slab.plan);
      sizes = Larger(sizes, slab.plan->sizes);
      any = &*slab.volumes;
    }
  }
  if (any)
  {
    this->Sweep.emplace(this->TheDevice, *any, this->Model, this->Settings, sizes, faces.Count() ? faces.Cells() : 0);
  }
}

void SweepInSlabs::MakeTasks()
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::size_t batches = this->Slabs[axis].plan ? this->Slabs[axis].plan->batches.size() : 0;
    for (std::size_t batch = 0; batch < batches; ++batch)
    {
      this->Tasks.push_back(this->TaskOf(axis, batch));
    }
  }
  const auto place = [](const Task& task) { return std::make_tuple(task.step, task.axis, task.batch); };
  std::sort(this->Tasks.begin(), this->Tasks.end(), [&](const Task& a, const Task& b) { return place(a) < place(b); });
  for (const Task& task : this->Tasks)
  {
    this->Waiting.emplace_back(this->Slabs[task.axis].plan->batches[task.batch].passes.size());
  }
}

SweepInSlabs::Task SweepInSlabs::TaskOf(int axis, std::size_t batch) const
{
  const PublishedPlan& plan = *this->Slabs[axis].plan;
  const std::vector<int>& ranks = this->Slabs[axis].all->ranks;
  const int count = static_cast<int>(ranks.size());
  const int batches = static_cast<int>(plan.batches.size()), ofFace = batches / 2;
  const bool forward = plan.batches[batch].Map().forward;
  const int place = this->Slabs[axis].all->PlaceOf(this->Others.Rank());
  const int gone = forward ? place : count - 1 - place;
  const auto rank = [&](int there) { return ranks[forward ? there : count - 1 - there]; };
  const bool begins = gone == 0, ends = gone == count - 1;
  Task task = {};
  task.axis = axis;
  task.batch = batch;
  task.step = axis * ofFace + static_cast<int>(batch) % ofFace + gone;
  task.from = begins ? -1 : rank(gone - 1);
  task.to = ends ? -1 : rank(gone + 1);
  task.around = !this->Settings.periodic[axis] ? -1 : ends ? rank(0) : begins ? rank(count - 1) : -1;
  task.tag = axis * batches + static_cast<int>(batch);
  return task;
}

/// Messages are sent and received although something has gone wrong: none waits in vain.
SweepTally SweepInSlabs::Run(int order, bool emits, PublishedFaces& faces, const Monitor& monitor)
{
  Running running = { order, emits, faces, {}, {}, {} };
  const double all = static_cast<double>(this->Tasks.size());
  for (std::size_t t = 0; t < this->Tasks.size(); ++t)
  {
    this->RunTask(t, running, OfPart(monitor, t / all, (t + 1) / all));
  }
  this->TakeFromAround(running);
  this->Others.Together([&] { running.failure.Throw(); });
  return SumOverRanks(this->Others, running.tally);
}

void SweepInSlabs::RunTask(std::size_t number, Running& running, const Monitor& monitor)
{
  const Task& task = this->Tasks[number];
  running.failure.Attempt([&] { this->BeginTask(task, running); });
  const std::size_t passes = this->Waiting[number].size();
  for (std::size_t p = 0; p < passes; ++p)
  {
    std::vector<float> given = std::exchange(this->Waiting[number][p], {});
    if (task.from >= 0)
    {
      given = this->Others.Receive<float>(task.from, task.tag);
      running.failure.broken = running.failure.broken || given.size() != this->FloatsOfMap(task);
    }
    std::vector<float> rays;
    running.failure.Attempt([&] {
      const double all = static_cast<double>(passes);
      rays = this->Send(task, p, given, running, OfPart(monitor, p / all, (p + 1) / all));
    });
    const bool ends = task.to < 0;
    if (const int to = ends && this->Settings.periodic[task.axis] ? task.around : task.to; to >= 0)
    {
      this->Others.Send(to, task.tag, rays);
    }
  }
  running.failure.Attempt([&] { this->EndTask(task, running); });
}

void SweepInSlabs::BeginTask(const Task& task, Running& running)
{
  Slab& slab = this->Slabs[task.axis];
  PublishedPlan::Batch& batch = slab.plan->batches[task.batch];
  const bool first = running.order == 0;
  if (!first && this->Settings.periodic[task.axis])
  {
    slab.plan->MakePasses(batch, running.order); // rays go on from where they were
  }
  this->Sweep->Begin(first ? slab.borders->Radiance(batch) : std::vector<float>(), running.faces.Radiance());
  if (first && task.from < 0)
  {
    slab.borders->TallyEntered(batch, running.tally);
  }
}

/// @param given  what rays have ahead of this rank's planes; empty: what the box's face has
std::vector<float> SweepInSlabs::Send(
  const Task& task, std::size_t pass, const std::vector<float>& given, Running& running, const Monitor& monitor)
{
  Slab& slab = this->Slabs[task.axis];
  const PublishedPlan::Batch& batch = slab.plan->batches[task.batch];
  const bool periodic = this->Settings.periodic[task.axis];
  const PublishedSweep::Ends ends = { periodic || task.from >= 0, periodic || task.to >= 0 };
  const std::size_t floats = this->FloatsOfMap(task);
  if (ends.given)
  {
    const std::vector<float> rays = given.empty() ? std::vector<float>(floats, 0.0f) : given;
    this->Sweep->Carried[0].Write(rays.data(), floats);
  }
  const std::vector<float> escaped = this->Sweep->Send(*slab.volumes, *slab.plan, batch, batch.passes[pass], ends,
    running.order > 0 || running.emits, [&](double done) { Report(monitor, done); });
  slab.borders->TallyEscaped(batch, escaped, running.tally);
  std::vector<float> rays(ends.kept ? floats : 0);
  this->Sweep->Carried[1].Read(rays.data(), rays.size());
  Report(monitor, 1.0);
  return rays;
}

void SweepInSlabs::EndTask(const Task& task, Running& running)
{
  Slab& slab = this->Slabs[task.axis];
  const PublishedPlan::Batch& batch = slab.plan->batches[task.batch];
  if (this->Sweep->CountsCells())
  {
    slab.borders->TallyLeft(batch, this->Sweep->LeftThroughCells(), running.faces);
  }
  this->Sweep->Collect(*slab.volumes, *slab.plan, batch, !std::exchange(running.collected[task.axis], true));
}

/// For the next order, once all that this rank has to send is sent.
void SweepInSlabs::TakeFromAround(Running& running)
{
  for (std::size_t number = 0; number < this->Tasks.size(); ++number)
  {
    const Task& task = this->Tasks[number];
    if (task.from >= 0 || !this->Settings.periodic[task.axis])
    {
      continue;
    }
    for (std::vector<float>& rays : this->Waiting[number])
    {
      rays = this->Others.Receive<float>(task.around, task.tag);
      running.failure.broken = running.failure.broken || rays.size() != this->FloatsOfMap(task);
    }
  }
}

std::size_t SweepInSlabs::FloatsOfMap(const Task& task) const
{
  const PublishedPlan& plan = *this->Slabs[task.axis].plan;
  const PublishedPlan::Batch& batch = plan.batches[task.batch];
  return plan.CarriedStride(batch) * batch.count;
}

std::vector<float> SweepInSlabs::Moment(int moment, HeldFailure& failure) const
{
  const VoxelBox& block = this->Blocks.blocks[this->Others.Rank()];
  std::vector<float> sum(block.VoxelCount() * this->Model.Channels(), 0.0f);
  for (int axis = 0; axis < 3; ++axis)
  {
    const Slab& slab = this->Slabs[axis];
    const int layout = axis == 0 ? 1 : 0;
    std::vector<float> own(slab.all->boxes.blocks[this->Others.Rank()].VoxelCount() * this->Model.Channels(), 0.0f);
    failure.Attempt([&] {
      if (slab.volumes)
      {
        own = slab.volumes->ReadMoment(slab.volumes->OrderMoments[layout], moment, layout);
      }
    });
    const std::vector<float> found =
      ValuesInBox(this->Others, slab.all->boxes, this->Blocks.blocks, own, this->Model.Channels());
    std::transform(found.begin(), found.end(), sum.begin(), sum.begin(), [](float a, float b) { return a + b; });
  }
  return sum;
}

std::vector<int> SweepInSlabs::SourcesReadAlong(int axis) const
{
  const int perFace = this->Model.Directions().PerFace();
  std::vector<int> sources;
  for (int i = 2 * axis * perFace; i < 2 * (axis + 1) * perFace; ++i)
  {
    sources.push_back(this->Model.SourceOf(i));
  }
  std::sort(sources.begin(), sources.end());
  sources.erase(std::unique(sources.begin(), sources.end()), sources.end());
  return sources;
}

void SweepInSlabs::WriteSources(const std::function<std::vector<float>(int)>& source, HeldFailure& failure)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    int known = -1; // which moment the values are of: those of isotropic scattering are alike
    std::vector<float> values;
    for (const int d : this->SourcesReadAlong(axis))
    {
      if (const int moment = this->Model.Source(d).moment; moment != std::exchange(known, moment))
      {
        values = ValuesInBox(
          this->Others, this->Blocks, this->Slabs[axis].all->boxes.blocks, source(d), this->Model.Channels());
      }
      failure.Attempt([&] {
        if (this->Slabs[axis].volumes)
        {
          this->Slabs[axis].volumes->WriteSourceOf(d, values);
        }
      });
    }
  }
}
}
