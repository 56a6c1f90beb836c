#include "LightPropagation/Sweep/Pipelined/SweepInBlocks.h"

#include "Distribution/SharedMedium.h"
#include "Medium/BoxFaces.h"

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <utility>

namespace tyndall
{
namespace
{
/// Replaces the power through each face on each rank, W, by its sum over all ranks. Collective.
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
}

SweepRequest SweepInBlocks::OfWholeDomain(SweepRequest request)
{
  request.box = {};
  return request;
}

SweepInBlocks::SweepInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const VolumeLayout& layout, const Buffer<float>& sigma_t, const std::array<bool, 3>& periodic,
  const SweepRequest& request, BlockWorkspace& workspace, int mostRays)
  : SweepByGroups(layout, sigma_t, OfWholeDomain(request))
  , TheDevice(device)
  , Comm(communicator)
  , Partition(partition)
  , Periodic(periodic)
  , Workspace(workspace)
  , Parts(mostRays > 0 ? SortByOctant(request.rays, mostRays) : FastestParts(partition, request.rays))
  , TheSchedule(partition, this->Parts, {})
{
  for (ParallelBundles& part : this->Parts)
  {
    for (Bundle& bundle : part.bundles)
    {
      bundle.power /= this->Laps(part.axis);
    }
  }
  if (partition.blocks[communicator.Rank()].VoxelCount() > 0)
  {
    if (this->IsAnyPeriodic())
    {
      workspace.sweep.ReserveLost(device, request.deposit.path->Size());
    }
    for (const ParallelBundles& part : this->Parts)
    {
      this->Tasks.push_back(this->MakeTask(part, workspace));
    }
  }
}

int SweepInBlocks::Laps(int axis) const
{
  const int size = this->Partition.whole.size[axis];
  return PlanesOfPattern(size, this->Periodic[axis]) / size;
}

SweepInBlocks::Task SweepInBlocks::MakeTask(const ParallelBundles& rays, BlockWorkspace& workspace) const
{
  const int own = this->Comm.Rank();
  Task task;
  const SweepVolume volume = this->VolumeOf(0);
  task.sweep =
    std::make_unique<BlockSweep>(this->TheDevice, this->Partition, own, rays, this->Periodic, volume, workspace);
  /// Finds the contacts (sets of shared voxel faces) through which rays pass from block `from` to block `to`, in three
  /// lists: within the domain, around a periodic axis transverse to the marching axis, and around the marching axis.
  const auto sorted = [&](int from, int to) {
    std::array<Contacts, 3> found;
    for (const BlockContact& contact : ContactsBetween(this->Partition, rays, from, to, this->Periodic))
    {
      found[!contact.around ? 0 : contact.kind == BlockContact::Along ? 2 : 1].push_back(contact);
    }
    return found;
  };
  for (int rank = 0; rank < this->Comm.Ranks(); ++rank)
  {
    auto [from, asideFrom, aheadFrom] = sorted(rank, own);
    auto [to, asideTo, aheadTo] = sorted(own, rank);
    if (!from.empty())
    {
      task.senders.push_back(std::move(from));
    }
    if (!to.empty())
    {
      task.receivers.push_back(std::move(to));
    }
    if (!asideFrom.empty() || !aheadFrom.empty())
    {
      task.aroundFrom.push_back({ std::move(asideFrom), std::move(aheadFrom), {}, {} });
      task.aroundFrom.back().waiting.resize(this->Layout.Groups().size());
    }
    if (!asideTo.empty() || !aheadTo.empty())
    {
      task.aroundTo.push_back({ std::move(asideTo), std::move(aheadTo) });
    }
  }
  return task;
}

void SweepInBlocks::Forget()
{
  for (Task& task : this->Tasks)
  {
    for (Around& around : task.aroundFrom)
    {
      for (std::vector<float>& rays : around.waiting)
      {
        rays.clear();
      }
    }
  }
}

/// Sweeps the whole domain once. Collective. After an error on one rank, all ranks continue to exchange messages,
/// marked as failed, so that no rank waits forever for a message.
SweepTally SweepInBlocks::Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor)
{
  const Deposit& to = this->Request.deposit;
  this->Error = nullptr;
  this->FaceIn = this->Request.faceIn ? this->Request.faceIn->Read() : std::vector<float>();
  if (std::all_of(this->FaceIn.begin(), this->FaceIn.end(), [](float value) { return value == 0.0f; }))
  {
    this->FaceIn.clear();
  }
  this->Left.assign(to.faceOut ? to.faceOut->Size() : 0, 0.0);
  SweepTally tally = SweepByGroups::Apply(source, boundary, monitor);
  this->Comm.Collective([&] {
    if (this->Error)
    {
      std::rethrow_exception(this->Error);
    }
  });
  AddUp(this->Comm, tally.in);
  AddUp(this->Comm, tally.out);
  if (to.faceOut)
  {
    AddOverRanks(this->TheDevice, this->Comm, this->Left, *to.faceOut);
  }
  return tally;
}

/// Sweeps one group of channels. Rays along an open axis need one lap (crossing of the domain); rays along a periodic
/// axis continue in further laps until almost no power is in transit, as in AxisSweep.
SweepTally SweepInBlocks::ApplyGroup(
  std::size_t group, const SweepVolume& volume, const SweepBoundary& boundary, const Monitor& monitor)
{
  Sweeping sweeping = { volume, boundary };
  sweeping.group = group;
  sweeping.cells = { this->FaceIn.empty() ? nullptr : this->FaceIn.data() + this->FirstCell(volume),
    this->Left.empty() ? nullptr : this->Left.data() + this->FirstCell(volume), volume.deposit.spreadsAside };
  if (this->IsAnyPeriodic() && !this->Tasks.empty())
  {
    this->Workspace.sweep.lost.Fill(0.0f);
  }
  std::array<double, 3> atFirst = {};
  sweeping.goesOn = { true, true, true };
  for (bool any = true; any; ++sweeping.lap)
  {
    if (!this->SweepLap(sweeping, sweeping.lap == 0 ? monitor : OfPart(monitor, 1.0, 1.0)))
    {
      break;
    }
    any = false;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int laps = this->Laps(axis), gone = sweeping.lap + 1;
      const double onTheWay = Sum(sweeping.ahead[axis]);
      atFirst[axis] = gone == laps ? onTheWay : atFirst[axis];
      const bool far = gone % laps == 0 &&
        (gone * this->Partition.whole.size[axis] >= this->Request.mostPlanes ||
          onTheWay <= NothingLeft * atFirst[axis]);
      const bool goesOn = this->Periodic[axis] && sweeping.goesOn[axis] && !far;
      for (int c = 0; c < 3 && sweeping.goesOn[axis] && !goesOn; ++c)
      {
        sweeping.tally.onTheWay[c] += sweeping.ahead[axis][c];
      }
      sweeping.goesOn[axis] = goesOn;
      any = any || goesOn;
    }
  }
  return sweeping.tally;
}

/// Index of the first face cell of this group of channels in FaceIn (incident radiance) and Left (escaped power),
/// which hold the cells of all faces of the whole domain for all channels.
std::size_t SweepInBlocks::FirstCell(const SweepVolume& volume) const
{
  return volume.firstChannel * BoxFaceCellCount(this->Partition.whole);
}

/// Sweeps one lap, in which rays cross the domain once along their marching axes. The first pass includes sources and
/// incident light if rays still start in this lap. Each further pass carries only the rays that wrapped around a
/// periodic axis transverse to their marching axis; passes end when there are no such rays. Collective.
/// @return false if an error occurred on any rank
bool SweepInBlocks::SweepLap(Sweeping& sweeping, const Monitor& monitor)
{
  sweeping.ahead = {};
  sweeping.again = false;
  bool more = this->SweepPass(sweeping, monitor);
  while (this->IsAnyPeriodic())
  {
    std::vector<double> flags = { more ? 1.0 : 0.0, this->Error ? 1.0 : 0.0 };
    flags = this->Comm.Largest(flags);
    if (flags[1] > 0.0)
    {
      return false;
    }
    if (flags[0] == 0.0)
    {
      break;
    }
    sweeping.again = true;
    more = this->SweepPass(sweeping, OfPart(monitor, 1.0, 1.0));
  }
  std::vector<double> ahead;
  for (const Rgb& power : sweeping.ahead)
  {
    ahead.insert(ahead.end(), power.begin(), power.end());
  }
  ahead = this->IsAnyPeriodic() ? this->Comm.Sum(ahead) : ahead;
  for (std::size_t i = 0; i < ahead.size(); ++i)
  {
    sweeping.ahead[i / 3][i % 3] = ahead[i];
  }
  return true;
}

/// Sweeps this rank's block once along each set of bundles of rays whose axis takes part in the lap.
/// @return whether any rays have wrapped around a transverse periodic axis to this rank, so that another pass is needed
bool SweepInBlocks::SweepPass(Sweeping& sweeping, const Monitor& monitor)
{
  const std::vector<int>& order = this->TheSchedule.OrderOf(this->Comm.Rank());
  const double all = static_cast<double>(order.size());
  for (std::size_t t = 0; t < order.size(); ++t)
  {
    if (sweeping.goesOn[this->Parts[order[t]].axis])
    {
      this->SweepTask(order[t], sweeping, OfPart(monitor, t / all, (t + 1) / all));
    }
  }
  return this->IsAnyPeriodic() && this->TakeFromAround(sweeping);
}

void AddOverRanks(Device& device, Communicator& communicator, const std::vector<double>& left, const Buffer<float>& to)
{
  const std::vector<double> ofAll = communicator.Sum(left);
  std::vector<float> out = to.Read();
  std::transform(out.begin(), out.end(), ofAll.begin(), out.begin(),
    [](float before, double more) { return static_cast<float>(before + more); });
  to.CopyFrom(Buffer<float>(device, out, "the light that leaves by cells"), 0, out.size());
  device.Finish(); // the copy must end before its temporary source is destroyed
}

/// Whether this rank reports the incident power of the domain; only one of the ranks with voxels does.
bool SweepInBlocks::CountsPowerIn() const
{
  return IsFirstThatHas(this->Comm, this->Partition);
}

void SweepInBlocks::SweepTask(int number, Sweeping& sweeping, const Monitor& monitor)
{
  Task& task = this->Tasks[number];
  const int axis = this->Parts[number].axis;
  const bool starts = !sweeping.again && sweeping.lap < this->Laps(axis);
  std::vector<std::vector<float>> messages;
  for (const Contacts& sender : task.senders)
  {
    messages.push_back(this->Comm.Receive<float>(sender.front().from, number));
  }
  State state = State::Failed;
  RaysAtFaces rays;
  try
  {
    if (!this->Error)
    {
      task.sweep->BeginLap(sweeping.lap * this->Partition.whole.size[axis]);
      state = this->Enter(task, messages, sweeping, rays);
    }
    const SweepBoundary boundary = starts ? sweeping.boundary : SweepBoundary();
    if (state != State::Failed && this->CountsPowerIn())
    {
      AddTo(sweeping.tally.in, task.sweep->PowerIn(boundary));
    }
    SweepVolume volume = sweeping.volume;
    volume.source = starts ? volume.source : nullptr;
    if (state == State::Lit || (state == State::Dark && volume.source))
    {
      const LightByCells cells = { starts ? sweeping.cells.in : nullptr, sweeping.cells.left, sweeping.cells.spreads };
      SweepTally tally;
      rays = task.sweep->Cross(volume, std::move(rays), boundary, cells, tally, monitor);
      for (int c = 0; c < 3; ++c)
      {
        sweeping.ahead[axis][c] += std::exchange(tally.onTheWay[c], 0.0);
      }
      Add(sweeping.tally, tally);
      state = State::Lit;
    }
  }
  catch (...)
  {
    this->Error = std::current_exception();
    state = State::Failed;
  }
  this->SendOn(number, state, rays);
}

/// Sends the outgoing rays of this rank's block to the ranks downwind, and to those reached around periodic axes.
/// @param number  index in Tasks of the set of bundles to which the rays belong
/// @param state  whether the rays carry power; sent first in each message
void SweepInBlocks::SendOn(int number, State state, const RaysAtFaces& rays)
{
  const Task& task = this->Tasks[number];
  const auto send = [&](int to, std::initializer_list<const Contacts*> groups) {
    std::vector<float> message = { static_cast<float>(state) };
    for (const Contacts* contacts : groups)
    {
      for (const BlockContact& contact : *contacts)
      {
        if (state == State::Lit)
        {
          task.sweep->Pack(contact, rays, message);
        }
      }
    }
    this->Comm.Send(to, number, message);
  };
  for (const Contacts& receiver : task.receivers)
  {
    send(receiver.front().to, { &receiver });
  }
  for (const auto& [aside, ahead] : task.aroundTo)
  {
    send((aside.empty() ? ahead : aside).front().to, { &aside, &ahead });
  }
}

/// Receives the rays that wrapped around in this pass, from all ranks, after this rank has finished the pass.
/// @return whether any of these rays wrapped around a transverse axis and carry power, so that another pass is needed
bool SweepInBlocks::TakeFromAround(const Sweeping& sweeping)
{
  const auto isLit = [](float value) { return value != 0.0f; };
  bool any = false;
  for (std::size_t number = 0; number < this->Tasks.size(); ++number)
  {
    for (Around& around : this->Tasks[number].aroundFrom)
    {
      if (!sweeping.goesOn[this->Parts[number].axis])
      {
        continue;
      }
      const int from = (around.aside.empty() ? around.ahead : around.aside).front().from;
      const std::vector<float> message = this->Comm.Receive<float>(from, static_cast<int>(number));
      const State state = static_cast<State>(static_cast<int>(message.at(0)));
      around.rays.clear();
      if (state != State::Lit || this->Error)
      {
        continue;
      }
      const std::size_t aside = this->Tasks[number].sweep->Values(around.aside);
      around.rays.assign(message.begin() + 1, message.begin() + 1 + static_cast<std::ptrdiff_t>(aside));
      any = any || std::any_of(around.rays.begin(), around.rays.end(), isLit);
      std::vector<float>& waiting = around.waiting[sweeping.group];
      waiting.resize(message.size() - 1 - aside, 0.0f);
      std::transform(waiting.begin(), waiting.end(), message.begin() + 1 + static_cast<std::ptrdiff_t>(aside),
        waiting.begin(), std::plus<>());
    }
  }
  return any;
}

/// Collects the incoming rays of a block, from outside the domain and from other ranks.
/// @return Lit if any of them carries power, else Dark; Failed if a sending rank has thrown
SweepInBlocks::State SweepInBlocks::Enter(
  Task& task, const std::vector<std::vector<float>>& messages, const Sweeping& sweeping, RaysAtFaces& rays) const
{
  const bool starts = !sweeping.again && sweeping.lap < this->Laps(task.sweep->Axis());
  const SweepBoundary boundary = starts ? sweeping.boundary : SweepBoundary();
  LightByCells cells = sweeping.cells;
  cells.in = starts ? cells.in : nullptr;
  rays = task.sweep->FromOutside(boundary, cells);
  const auto isLit = [](const std::vector<float>& values) {
    return std::any_of(values.begin(), values.end(), [](float value) { return value != 0.0f; });
  };
  State state = (boundary || cells.in) && (isLit(rays.maps) || isLit(rays.sides)) ? State::Lit : State::Dark;
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
  return this->EnterFromAround(task, sweeping, rays) == State::Lit ? State::Lit : state;
}

/// Adds the waiting rays that wrapped around a periodic axis to the incoming rays. In the first pass of a lap these are
/// the rays that wrapped around the marching axis in the lap before; in later passes, those that wrapped around a
/// transverse axis in the pass before.
SweepInBlocks::State SweepInBlocks::EnterFromAround(Task& task, const Sweeping& sweeping, RaysAtFaces& rays) const
{
  State state = State::Dark;
  const auto enter = [&](const Contacts& contacts, std::vector<float>& waiting) {
    std::size_t at = 0;
    for (const BlockContact& contact : contacts)
    {
      if (!waiting.empty())
      {
        task.sweep->Unpack(contact, waiting, at, rays);
        state = State::Lit;
      }
    }
    waiting.clear();
  };
  for (Around& around : task.aroundFrom)
  {
    if (sweeping.again)
    {
      enter(around.aside, around.rays);
    }
    else
    {
      enter(around.ahead, around.waiting[sweeping.group]);
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
