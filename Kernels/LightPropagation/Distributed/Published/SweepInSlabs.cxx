#include "LightPropagation/Distributed/Published/SweepInSlabs.h"

#include "Distribution/BoxExchange.h"

#include <algorithm>
#include <array>
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

SweepInSlabs::SweepInSlabs(Communicator& communicator, const BlockPartition& blocks, const Medium& own,
  const PublishedModel& model, const PropagationSettings& settings, SlabRays& rays)
  : Comm(communicator)
  , Blocks(blocks)
  , Model(model)
  , Settings(settings)
  , Rays(rays)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Slabs.emplace_back(blocks, axis);
    this->TakePlanes(axis, own);
  }
  const int perBatch = this->DirectionsPerBatch();
  communicator.Collective([&] {
    this->Rays.MakeBatches(perBatch);
    this->MakeTasks();
  });
}

/// The medium of this rank's planes, from the blocks of those who have it.
void SweepInSlabs::TakePlanes(int axis, const Medium& own)
{
  const SlabsAcross& slabs = this->Slabs[axis];
  const std::size_t voxels = this->Blocks.blocks[this->Comm.Rank()].VoxelCount();
  std::array<std::vector<float>, 3> arrays;
  Medium medium;
  medium.grid = slabs.boxes.OwnGrid(this->Comm.Rank());
  const auto take = [&](Field Medium::*which, std::vector<float>& values) {
    const Field& field = own.*which;
    if (voxels > 0 && field.values)
    {
      const int components = field.HasColour() ? 3 : 1;
      values = ValuesInBox(this->Comm, this->Blocks, slabs.boxes.blocks, ValuesOf(field, voxels), components);
      medium.*which = { values.data(), components };
    }
  };
  take(&Medium::sigma_a, arrays[0]);
  take(&Medium::sigma_s, arrays[1]);
  take(&Medium::emission, arrays[2]);
  this->Comm.Collective([&] {
    if (this->HasPlanes(axis))
    {
      const VoxelBox& planes = this->PlanesOf(axis);
      this->Rays.TakePlanes({ axis, planes.first[axis], planes.size[axis] }, medium);
    }
  });
}

/// The same on all ranks: as many as fit all, and so few that ranks have batches to work on at once.
int SweepInSlabs::DirectionsPerBatch() const
{
  const int perFace = this->Model.Directions().PerFace();
  std::size_t ranks = 1;
  for (const SlabsAcross& slabs : this->Slabs)
  {
    ranks = std::max(ranks, slabs.ranks.size());
  }
  const int most = -static_cast<int>(this->Comm.Largest({ -1.0 * this->Rays.MostPerBatch() })[0]);
  const int groups = std::min(static_cast<int>(ranks), perFace);
  return std::min(most, (perFace + groups - 1) / groups);
}

void SweepInSlabs::MakeTasks()
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::size_t batches = this->HasPlanes(axis) ? this->Rays.Batches(axis) : 0;
    for (std::size_t batch = 0; batch < batches; ++batch)
    {
      this->Tasks.push_back(this->TaskOf(axis, batch));
    }
  }
  const auto place = [](const Task& task) { return std::make_tuple(task.step, task.axis, task.batch); };
  std::sort(this->Tasks.begin(), this->Tasks.end(), [&](const Task& a, const Task& b) { return place(a) < place(b); });
  for (const Task& task : this->Tasks)
  {
    this->Waiting.emplace_back(this->Rays.Passes(task.axis, task.batch));
  }
}

SweepInSlabs::Task SweepInSlabs::TaskOf(int axis, std::size_t batch) const
{
  const std::vector<int>& ranks = this->Slabs[axis].ranks;
  const int count = static_cast<int>(ranks.size());
  const int batches = static_cast<int>(this->Rays.Batches(axis)), ofFace = batches / 2;
  const bool forward = this->Rays.IsForward(axis, batch);
  const int place = this->Slabs[axis].PlaceOf(this->Comm.Rank());
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

SlabRays::Way SweepInSlabs::WayOf(const Task& task, const Running& running) const
{
  const bool periodic = this->Settings.periodic[task.axis];
  return { task.axis, task.batch, running.order, running.emits, task.from < 0, periodic || task.from >= 0,
    periodic || task.to >= 0 };
}

/// Messages are sent and received although something has gone wrong: none waits in vain.
SweepTally SweepInSlabs::Run(int order, bool emits, PublishedFaces& faces, const Monitor& monitor)
{
  Running running = { order, emits, faces, {}, {} };
  running.failure.Attempt([&] { this->Rays.BeginOrder(); });
  const double all = static_cast<double>(this->Tasks.size());
  for (std::size_t t = 0; t < this->Tasks.size(); ++t)
  {
    this->RunTask(t, running, OfPart(monitor, t / all, (t + 1) / all));
  }
  this->TakeFromAround(running);
  this->Comm.Collective([&] { running.failure.Throw(); });
  return SumOverRanks(this->Comm, running.tally);
}

void SweepInSlabs::RunTask(std::size_t number, Running& running, const Monitor& monitor)
{
  const Task& task = this->Tasks[number];
  const SlabRays::Way way = this->WayOf(task, running);
  running.failure.Attempt([&] { this->Rays.Begin(way, running.faces, running.tally); });
  const std::size_t passes = this->Waiting[number].size();
  for (std::size_t p = 0; p < passes; ++p)
  {
    std::vector<float> given = std::exchange(this->Waiting[number][p], {});
    if (task.from >= 0)
    {
      given = this->Comm.Receive<float>(task.from, task.tag);
      running.failure.broken = running.failure.broken || given.size() != this->Rays.FloatsOfMap(task.axis, task.batch);
    }
    std::vector<float> rays;
    running.failure.Attempt([&] {
      const double all = static_cast<double>(passes);
      rays = this->Rays.Send(way, p, given, running.faces, running.tally, OfPart(monitor, p / all, (p + 1) / all));
    });
    const bool ends = task.to < 0;
    if (const int to = ends && this->Settings.periodic[task.axis] ? task.around : task.to; to >= 0)
    {
      this->Comm.Send(to, task.tag, rays);
    }
  }
  running.failure.Attempt([&] { this->Rays.End(way, running.faces); });
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
      rays = this->Comm.Receive<float>(task.around, task.tag);
      running.failure.broken = running.failure.broken || rays.size() != this->Rays.FloatsOfMap(task.axis, task.batch);
    }
  }
}

std::vector<float> SweepInSlabs::Moment(int moment, HeldFailure& failure) const
{
  const VoxelBox& block = this->Blocks.blocks[this->Comm.Rank()];
  std::vector<float> sum(block.VoxelCount() * this->Model.Channels(), 0.0f);
  for (int axis = 0; axis < 3; ++axis)
  {
    std::vector<float> own(this->PlanesOf(axis).VoxelCount() * this->Model.Channels(), 0.0f);
    failure.Attempt([&] {
      if (this->HasPlanes(axis))
      {
        own = this->Rays.Moment(axis, moment);
      }
    });
    const std::vector<float> found =
      ValuesInBox(this->Comm, this->Slabs[axis].boxes, this->Blocks.blocks, own, this->Model.Channels());
    std::transform(found.begin(), found.end(), sum.begin(), sum.begin(), [](float a, float b) { return a + b; });
  }
  return sum;
}

void SweepInSlabs::WriteSources(const std::function<std::vector<float>(int)>& source, HeldFailure& failure)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    int known = -1; // which moment the values are of: those of isotropic scattering are alike
    std::vector<float> values;
    for (const int d : this->Model.SourcesReadAlong(axis))
    {
      if (const int moment = this->Model.Source(d).moment; moment != std::exchange(known, moment))
      {
        values =
          ValuesInBox(this->Comm, this->Blocks, this->Slabs[axis].boxes.blocks, source(d), this->Model.Channels());
      }
      failure.Attempt([&] {
        if (this->HasPlanes(axis))
        {
          this->Rays.WriteSource(axis, d, values);
        }
      });
    }
  }
}
}
