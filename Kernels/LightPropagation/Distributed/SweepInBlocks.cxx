#include "LightPropagation/Distributed/SweepInBlocks.h"

#include "Device/Errors.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace tyndall
{
namespace
{
/// Sums of all ranks, of what each counted.
void AddUp(Communicator& communicator, std::array<Rgb, 6>& power)
{
  std::vector<double> values;
  for (const Rgb& face : power)
  {
    values.insert(values.end(), face.begin(), face.end());
  }
  values = communicator.Sum(values);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    power[i / 3][i % 3] = values[i];
  }
}

void AddTo(std::array<Rgb, 6>& sum, const std::array<Rgb, 6>& power)
{
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      sum[face][c] += power[face][c];
    }
  }
}
}

SweepInBlocks::SweepInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const VolumeLayout& layout, const Buffer<float>& sigma_t, const SweepRequest& request, BlockWorkspace& workspace,
  int mostRays)
  : TheDevice(device)
  , Others(communicator)
  , Partition(partition)
  , Layout(layout)
  , SigmaT(sigma_t)
  , To(request.deposit)
  , Angular(request.angular)
  , OctantSource(request.octantSource)
  , Parts(mostRays > 0 ? SortByOctant(request.rays, mostRays) : FastestParts(partition, request.rays))
  , TheSchedule(partition, this->Parts, {})
{
  Require(!request.faceIn && !request.deposit.faceOut,
    "Light by cells of the box's faces is not swept in a grid that is spread over ranks.");
  if (partition.blocks[communicator.Rank()].VoxelCount() > 0)
  {
    for (const ParallelBundles& part : this->Parts)
    {
      this->Tasks.push_back(this->MakeTask(part, workspace));
    }
  }
}

SweepInBlocks::Task SweepInBlocks::MakeTask(const ParallelBundles& rays, BlockWorkspace& workspace)
{
  const int own = this->Others.Rank();
  Task task;
  const SweepVolume volume = this->VolumeOf(this->Layout.Groups()[0], nullptr);
  task.sweep = std::make_unique<BlockSweep>(this->TheDevice, this->Partition, own, rays, volume, workspace);
  for (int rank = 0; rank < this->Others.Ranks(); ++rank)
  {
    std::vector<BlockContact> from = ContactsBetween(this->Partition, rays, rank, own);
    std::vector<BlockContact> to = ContactsBetween(this->Partition, rays, own, rank);
    if (!from.empty())
    {
      task.senders.push_back(std::move(from));
    }
    if (!to.empty())
    {
      task.receivers.push_back(std::move(to));
    }
  }
  return task;
}

SweepVolume SweepInBlocks::VolumeOf(const ChannelGroup& group, const Buffer<float>* source) const
{
  SweepVolume volume = GroupVolume(this->Layout, group, this->SigmaT, this->To);
  volume.source = source;
  volume.octantSource = this->OctantSource;
  volume.angular = this->Angular;
  volume.moments = this->Layout.Places(this->Angular ? this->Angular->Functions() : 1);
  volume.deposit.flux = this->Angular ? nullptr : volume.deposit.flux; // it is among the moments
  return volume;
}

/// Rays that this rank waits for come although something has gone wrong, here or on the rank that sends them: told so.
SweepTally SweepInBlocks::Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor)
{
  SweepTally tally;
  std::exception_ptr error;
  const std::vector<ChannelGroup> groups = this->Layout.Groups();
  const std::vector<int>& order = this->TheSchedule.OrderOf(this->Others.Rank());
  const double all = static_cast<double>(groups.size() * std::max<std::size_t>(order.size(), 1));
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    const int first = groups[g].first;
    const SweepBoundary ofChannels = boundary && first > 0
      ? SweepBoundary([&](int direction, int face) { return OfGroup(boundary(direction, face), first); })
      : boundary;
    SweepTally ofGroup;
    for (std::size_t t = 0; t < order.size(); ++t)
    {
      const double before = static_cast<double>(g * order.size() + t);
      this->SweepTask(order[t], this->VolumeOf(groups[g], source), ofChannels, ofGroup, error,
        OfPart(monitor, before / all, (before + 1.0) / all));
    }
    Add(tally, ofGroup, first);
  }
  this->Others.Together([&] {
    if (error)
    {
      std::rethrow_exception(error);
    }
  });
  AddUp(this->Others, tally.in);
  AddUp(this->Others, tally.out);
  return tally;
}

/// Whether this rank says what comes in: all know it, but those without voxels.
bool SweepInBlocks::CountsPowerIn() const
{
  const auto hasVoxels = [](const VoxelBox& block) { return block.VoxelCount() > 0; };
  const std::vector<VoxelBox>& blocks = this->Partition.blocks;
  return std::find_if(blocks.begin(), blocks.end(), hasVoxels) - blocks.begin() == this->Others.Rank();
}

void SweepInBlocks::SweepTask(int number, const SweepVolume& volume, const SweepBoundary& boundary, SweepTally& tally,
  std::exception_ptr& error, const Monitor& monitor)
{
  const Task& task = this->Tasks[number];
  std::vector<std::vector<float>> messages;
  for (const std::vector<BlockContact>& sender : task.senders)
  {
    messages.push_back(this->Others.Receive<float>(sender.front().from, number));
  }
  State state = State::Failed;
  RaysAtFaces rays;
  try
  {
    if (!error)
    {
      state = this->Enter(task, messages, boundary, rays);
    }
    if (state != State::Failed && this->CountsPowerIn())
    {
      AddTo(tally.in, task.sweep->PowerIn(boundary));
    }
    if (state == State::Lit || (state == State::Dark && volume.source))
    {
      rays = task.sweep->Cross(volume, std::move(rays), boundary, tally, monitor);
      state = State::Lit;
    }
  }
  catch (...)
  {
    error = std::current_exception();
    state = State::Failed;
  }
  for (const std::vector<BlockContact>& receiver : task.receivers)
  {
    std::vector<float> message = { static_cast<float>(state) };
    for (const BlockContact& contact : receiver)
    {
      if (state == State::Lit)
      {
        task.sweep->Pack(contact, rays, message);
      }
    }
    this->Others.Send(receiver.front().to, number, message);
  }
}

/// The rays that come in, from outside and from other ranks.
SweepInBlocks::State SweepInBlocks::Enter(const Task& task, const std::vector<std::vector<float>>& messages,
  const SweepBoundary& boundary, RaysAtFaces& rays) const
{
  rays = task.sweep->FromOutside(boundary);
  const auto isLit = [](const std::vector<float>& values) {
    return std::any_of(values.begin(), values.end(), [](float value) { return value != 0.0f; });
  };
  State state = boundary && (isLit(rays.maps) || isLit(rays.sides)) ? State::Lit : State::Dark;
  for (std::size_t i = 0; i < messages.size(); ++i)
  {
    const State ofSender = static_cast<State>(static_cast<int>(messages[i].at(0)));
    if (ofSender == State::Failed)
    {
      return State::Failed;
    }
    std::size_t at = 1;
    for (const BlockContact& contact : task.senders[i])
    {
      if (ofSender == State::Lit)
      {
        task.sweep->Unpack(contact, messages[i], at, rays);
        state = State::Lit;
      }
    }
  }
  return state;
}

std::size_t SweepInBlocks::FaceBytes() const
{
  std::size_t most = 0;
  for (const Task& task : this->Tasks)
  {
    most = std::max(most, task.sweep->Bytes());
  }
  return most;
}
}
