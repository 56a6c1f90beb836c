#include "LightPropagation/Sweep/Pipelined/SweepSchedule.h"

#include "Device/Errors.h"

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <map>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

namespace tyndall
{
namespace
{
/// Returns the bundle with only those of its directions that march in sense `way` along the axis and have the signs
/// signU, signV along the transverse axes u, v.
Bundle MembersThatGo(const Bundle& bundle, int way, int signU, int signV)
{
  Bundle part = bundle;
  part.members.clear();
  for (Member member : bundle.members)
  {
    int& other = way == 0 ? member.opposite : member.direction;
    const int direction = way == 0 ? member.direction : member.opposite;
    other = -1;
    if (direction >= 0 && member.uFromU + member.uFromV == signU && member.vFromU + member.vFromV == signV)
    {
      part.members.push_back(member);
    }
  }
  return part;
}

/// Divides a set of parallel bundles into sets of at most mostRays rays (one bundle with more rays is not divided), and
/// appends them to `parts`.
void AddParts(const ParallelBundles& whole, int mostRays, std::vector<ParallelBundles>& parts)
{
  ParallelBundles part = whole;
  part.bundles.clear();
  for (const Bundle& bundle : whole.bundles)
  {
    const int rays = part.Rays() + static_cast<int>(bundle.members.size());
    if (mostRays > 0 && rays > mostRays && !part.bundles.empty())
    {
      parts.push_back(part);
      part.bundles.clear();
      part.goThroughEdges = false;
    }
    part.bundles.push_back(bundle);
    part.goThroughEdges = part.goThroughEdges || bundle.MovesBothWaysAtOnce();
  }
  if (!part.bundles.empty())
  {
    parts.push_back(part);
  }
}
}

int ParallelBundles::Rays() const
{
  std::size_t rays = 0;
  for (const Bundle& bundle : this->bundles)
  {
    rays += bundle.members.size();
  }
  return static_cast<int>(rays);
}

std::vector<ParallelBundles> SortByOctant(const std::vector<AxisBundles>& rays, int mostRays)
{
  std::vector<ParallelBundles> parts;
  for (const AxisBundles& along : rays)
  {
    const PlaneAxes axes = AcrossAxis(along.axis);
    for (int octant = 0; octant < 8; ++octant)
    {
      const auto sign = [octant](int bit) { return octant >> bit & 1 ? -1 : 1; };
      ParallelBundles part;
      part.axis = along.axis;
      part.way = octant >> 2;
      part.signs[axes.u] = sign(0);
      part.signs[axes.v] = sign(1);
      part.signs[axes.axis] = sign(2);
      for (const Bundle& bundle : along.bundles)
      {
        const Bundle going = MembersThatGo(bundle, part.way, sign(0), sign(1));
        if (!going.members.empty())
        {
          part.bundles.push_back(going);
        }
      }
      AddParts(part, mostRays, parts);
    }
  }
  return parts;
}

std::vector<BlockContact> ContactsBetween(
  const BlockPartition& partition, const ParallelBundles& rays, int from, int to, const std::array<bool, 3>& periodic)
{
  const VoxelBox& source = partition.blocks[from];
  const VoxelBox& target = partition.blocks[to];
  if (source.VoxelCount() == 0 || target.VoxelCount() == 0)
  {
    return {};
  }
  const PlaneAxes axes = AcrossAxis(rays.axis);
  // Returns the contact of kind `kind`: those cells of block `from` whose rays enter cells of block `to` in a move by
  // one voxel along each of the axes `along`.
  const auto contact = [&](BlockContact::Kind kind, std::initializer_list<int> along) {
    BlockContact found = { from, to, kind, target, false };
    for (const int axis : along)
    {
      const int size = partition.whole.size[axis];
      int& first = found.cells.first[axis];
      first = rays.signs[axis] > 0 ? target.first[axis] - 1 : EndOf(target, axis);
      found.cells.size[axis] = 1;
      if (periodic[axis] && (first < 0 || first >= size))
      {
        first = first < 0 ? size - 1 : 0;
        found.around = true;
      }
    }
    found.cells = Common(found.cells, source);
    return found;
  };
  std::vector<BlockContact> contacts = { contact(BlockContact::Along, { axes.axis }),
    contact(BlockContact::AsideU, { axes.u }), contact(BlockContact::AsideV, { axes.v }) };
  if (rays.goThroughEdges)
  {
    contacts.push_back(contact(BlockContact::Edge, { axes.u, axes.v }));
  }
  std::vector<BlockContact> there;
  for (const BlockContact& one : contacts)
  {
    if (one.cells.VoxelCount() > 0)
    {
      there.push_back(one);
    }
  }
  return there;
}

namespace
{
/// Rank to which a block sends its outgoing rays after its sweep along a set of bundles, and the number of these rays.
struct Receiver
{
  int rank = 0;
  std::size_t rays = 0;
};

/// Dependency graph of the blocks for one set of bundles: senders and receivers of each block, and the length of the
/// longest chain of blocks downwind of it.
struct TaskGraph
{
  std::vector<std::vector<Receiver>> receivers; ///< per rank: ranks that receive its rays
  std::vector<int> waitsFor;                    ///< per rank: number of ranks that send rays to it
  std::vector<int> behind;
};

/// Number of rays that cross a contact (set of shared voxel faces) between two blocks, per channel. A ray passes
/// through faces parallel to the marching axis only in some planes. At these faces a ray counts as a fraction: the mean
/// number of voxels that it moves sideways per plane.
std::size_t RaysThrough(const ParallelBundles& bundles, const BlockContact& contact)
{
  const double cells = static_cast<double>(contact.cells.VoxelCount());
  double rays = 0.0;
  for (const Bundle& bundle : bundles.bundles)
  {
    for (const Member& member : bundle.members)
    {
      const bool swapped = member.uFromU == 0;
      const double moves[] = { 1.0, swapped ? bundle.tangentV : bundle.tangentU,
        swapped ? bundle.tangentU : bundle.tangentV, bundle.MovesBothWaysAtOnce() ? bundle.tangentU : 0.0 };
      rays += cells * moves[contact.kind];
    }
  }
  return static_cast<std::size_t>(rays);
}

/// Number of blocks in the longest chain of blocks downwind that wait for the rays of a block. Found by recursion.
int FindBehind(TaskGraph& graph, int rank)
{
  int& behind = graph.behind[rank];
  Require(behind != -2, "Blocks lie such that each waits for another: cut the grid by planes, one after the other.");
  if (behind == -1)
  {
    behind = -2; // marks the block as being visited, to detect cycles
    int most = 0;
    for (const Receiver& receiver : graph.receivers[rank])
    {
      most = std::max(most, 1 + FindBehind(graph, receiver.rank));
    }
    graph.behind[rank] = most;
    return most;
  }
  return behind;
}

/// Whether two blocks share a face, an edge or a corner; only then can rays pass from one into the other.
bool Touch(const VoxelBox& a, const VoxelBox& b)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (a.first[axis] > EndOf(b, axis) || b.first[axis] > EndOf(a, axis))
    {
      return false;
    }
  }
  return true;
}

TaskGraph GraphOf(const BlockPartition& partition, const ParallelBundles& bundles)
{
  const int ranks = static_cast<int>(partition.blocks.size());
  TaskGraph graph = { std::vector<std::vector<Receiver>>(ranks), std::vector<int>(ranks, 0),
    std::vector<int>(ranks, -1) };
  for (int from = 0; from < ranks; ++from)
  {
    for (int to = 0; to < ranks; ++to)
    {
      if (!Touch(partition.blocks[from], partition.blocks[to]))
      {
        continue;
      }
      Receiver receiver = { to, 0 };
      const std::vector<BlockContact> contacts = ContactsBetween(partition, bundles, from, to);
      for (const BlockContact& contact : contacts)
      {
        receiver.rays += RaysThrough(bundles, contact);
      }
      if (!contacts.empty())
      {
        graph.receivers[from].push_back(receiver);
        ++graph.waitsFor[to];
      }
    }
  }
  for (int rank = 0; rank < ranks; ++rank)
  {
    FindBehind(graph, rank);
  }
  return graph;
}

/// Discrete-event simulation of a distributed sweep.
class Play
{
public:
  Play(const BlockPartition& partition, const std::vector<ParallelBundles>& tasks, const SweepCosts& costs)
    : orders(partition.blocks.size())
    , Partition(partition)
    , Tasks(tasks)
    , Costs(costs)
    , Ready(partition.blocks.size())
    , Busy(partition.blocks.size(), false)
  {
    for (const ParallelBundles& task : tasks)
    {
      this->Graphs.push_back(GraphOf(partition, task));
      const std::vector<int>& behind = this->Graphs.back().behind;
      this->inALine = std::max(this->inALine, 1 + *std::max_element(behind.begin(), behind.end()));
    }
  }

  void Run()
  {
    for (std::size_t rank = 0; rank < this->Partition.blocks.size(); ++rank)
    {
      for (std::size_t task = 0; task < this->Tasks.size(); ++task)
      {
        if (this->Graphs[task].waitsFor[rank] == 0 && this->Partition.blocks[rank].VoxelCount() > 0)
        {
          this->Events.push({ 0.0, 0, static_cast<int>(rank), static_cast<int>(task) });
        }
      }
    }
    while (!this->Events.empty())
    {
      const auto [now, kind, rank, task] = this->Events.top();
      this->Events.pop();
      this->time = std::max(this->time, now);
      this->Touched.insert(rank);
      if (kind == 1)
      {
        this->Finish(now, rank, task);
      }
      else
      {
        this->Ready[rank].insert({ -this->Graphs[task].behind[rank], task });
      }
      // Tasks are started after all events of the current time, because such an event may make a more urgent task
      // ready.
      if (this->Events.empty() || std::get<0>(this->Events.top()) > now)
      {
        this->StartAll(now);
      }
    }
  }

  std::vector<std::vector<int>> orders;
  double time = 0.0, work = 0.0;
  std::size_t messages = 0, rays = 0;
  int inALine = 0;

private:
  void StartAll(double now)
  {
    for (const int rank : std::exchange(this->Touched, {}))
    {
      if (this->Busy[rank] || this->Ready[rank].empty())
      {
        continue;
      }
      const int task = this->Ready[rank].begin()->second;
      this->Ready[rank].erase(this->Ready[rank].begin());
      this->Busy[rank] = true;
      this->orders[rank].push_back(task);
      const double takes = this->Costs.ofTask +
        this->Costs.ofRay * this->Tasks[task].Rays() * static_cast<double>(this->Partition.blocks[rank].VoxelCount());
      this->work += takes;
      this->Events.push({ now + takes, 1, rank, task });
    }
  }

  void Finish(double now, int rank, int task)
  {
    this->Busy[rank] = false;
    TaskGraph& graph = this->Graphs[task];
    for (const Receiver& receiver : graph.receivers[rank])
    {
      ++this->messages;
      this->rays += receiver.rays;
      const double arrives = now + this->Costs.ofMessage + this->Costs.ofValue * static_cast<double>(receiver.rays);
      double& last = this->LastArrival[{ receiver.rank, task }];
      last = std::max(last, arrives);
      if (--graph.waitsFor[receiver.rank] == 0)
      {
        this->Events.push({ last, 0, receiver.rank, task });
      }
    }
  }

  const BlockPartition& Partition;
  const std::vector<ParallelBundles>& Tasks;
  const SweepCosts& Costs;
  std::vector<TaskGraph> Graphs;
  /// Per rank: tasks that are ready to run, as pairs (-n, task) in order of urgency, where n is the number of blocks in
  /// the longest chain downwind that waits for the rays of this task
  std::vector<std::set<std::pair<int, int>>> Ready;
  std::vector<bool> Busy;
  std::set<int> Touched;                             ///< ranks with an event at the current time
  std::map<std::pair<int, int>, double> LastArrival; ///< latest arrival time of a message for a task; key: rank, task
  using Event = std::tuple<double, int, int, int>; ///< time; 0 if a task becomes ready, 1 if it is finished; rank; task
  std::priority_queue<Event, std::vector<Event>, std::greater<Event>> Events;
};
}

SweepSchedule::SweepSchedule(
  const BlockPartition& partition, const std::vector<ParallelBundles>& tasks, const SweepCosts& costs)
{
  Play play(partition, tasks, costs);
  play.Run();
  this->Orders = play.orders;
  this->Makespan = play.time;
  this->Work = play.work;
  this->Sent = play.messages;
  this->SentRays = play.rays;
  this->InALine = play.inALine;
}

std::vector<ParallelBundles> FastestParts(const BlockPartition& partition, const std::vector<AxisBundles>& rays)
{
  // Costs are relative to carrying one ray through one voxel, which takes 2 to 3 ns. The overhead per block, mostly for
  // queueing kernel launches, is about 1 ms (measured).
  const SweepCosts costs = { 1.0, 4e5, 2e3, 1.0 };
  std::vector<ParallelBundles> fastest = SortByOctant(rays, 0);
  double least = SweepSchedule(partition, fastest, costs).Time();
  for (const int mostRays : { 4, 2, 1 })
  {
    std::vector<ParallelBundles> parts = SortByOctant(rays, mostRays);
    const double time = SweepSchedule(partition, parts, costs).Time();
    if (time < least)
    {
      least = time;
      fastest.swap(parts);
    }
  }
  return fastest;
}
}
