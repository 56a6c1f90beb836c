#pragma once

#include "LightPropagation/Distributed/Published/SlabRays.h"
#include "LightPropagation/Distributed/Published/SlabsAcross.h"
#include "LightPropagation/Published/PublishedFaces.h"

#include "Device/Monitor.h"
#include "Distribution/Communicator.h"
#include "Distribution/HeldFailure.h"

#include <functional>
#include <vector>

namespace tyndall
{
/// What all ranks counted. All call it.
SweepTally SumOverRanks(Communicator& communicator, const SweepTally& own);

/// All rays of an order of the published algorithm, in a medium that is spread over ranks by blocks.
///
/// Rays move aside as they go plane by plane along the axis of their face. So for each axis a rank has whole planes
/// across it (SlabsAcross.h), and rays go from the rank that has the planes before to that which has those behind as
/// a map of one plane; none go aside. Ranks work at once on batches of directions, which go both ways along each axis:
/// the k-th of those that begin at a rank reaches the one that is n places on at step k + n, and each rank takes its
/// batches in the order of these steps, whence none waits for another in a circle.
///
/// A rank holds its planes across each of three axes (of a grid with fewer planes than ranks a whole plane, or none),
/// maps of a plane of a batch, and those of all directions along periodic axes where it has an end of one.
class SweepInSlabs
{
public:
  /// All ranks make one together.
  /// @param blocks  of the medium; must stay, as do communicator and model
  /// @param own     medium of this rank's block; looked at by nobody where that has no voxels
  /// @param rays    without planes so far; must stay
  SweepInSlabs(Communicator& communicator, const BlockPartition& blocks, const Medium& own, const PublishedModel& model,
    const PropagationSettings& settings, SlabRays& rays);

  /// All rays once. All ranks call it.
  /// @param order   from 0: in it light comes in from outside
  /// @param emits   U is not zero
  /// @param faces   told what leaves through their cells on this rank
  /// @param monitor given fractions of the order
  /// @return what all ranks counted
  SweepTally Run(int order, bool emits, PublishedFaces& faces, const Monitor& monitor);

  /// Of the order that was run, of this rank's block, channels interleaved. All ranks with voxels call it.
  /// @param failure  told what goes wrong; to be thrown by all together
  std::vector<float> Moment(int moment, HeldFailure& failure) const;

  /// U of the next order, where it goes. All ranks with voxels call it.
  /// @param source  of a source direction, of this rank's block, channels interleaved
  /// @param failure  likewise
  void WriteSources(const std::function<std::vector<float>(int sourceDirection)>& source, HeldFailure& failure);

private:
  /// A batch through this rank's planes.
  struct Task
  {
    int axis;
    std::size_t batch;
    int step;
    int from, to; ///< ranks; -1: rays come in or go out there, or round the axis
    int around;   ///< rank to which rays go round a periodic axis from here, or from which they come; -1: none
    int tag;
  };

  /// What an order is run with.
  struct Running
  {
    int order;
    bool emits;
    PublishedFaces& faces;
    SweepTally tally;
    HeldFailure failure;
  };

  void TakePlanes(int axis, const Medium& own);
  int DirectionsPerBatch() const;
  void MakeTasks();
  Task TaskOf(int axis, std::size_t batch) const;
  SlabRays::Way WayOf(const Task& task, const Running& running) const;
  void RunTask(std::size_t number, Running& running, const Monitor& monitor);
  void TakeFromAround(Running& running);
  bool HasPlanes(int axis) const { return this->Slabs[axis].PlaceOf(this->Comm.Rank()) >= 0; }
  const VoxelBox& PlanesOf(int axis) const { return this->Slabs[axis].boxes.blocks[this->Comm.Rank()]; }

  Communicator& Comm;
  const BlockPartition& Blocks;
  const PublishedModel& Model;
  PropagationSettings Settings;
  SlabRays& Rays;
  std::vector<SlabsAcross> Slabs; ///< by axis
  std::vector<Task> Tasks;        ///< in the order in which they are done
  /// Of each task and pass, what rays that went round have as they begin the next order; empty: nothing.
  std::vector<std::vector<std::vector<float>>> Waiting;
};
}
