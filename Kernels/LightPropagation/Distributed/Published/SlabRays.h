#pragma once

#include "LightPropagation/Published/PublishedFaces.h"
#include "LightPropagation/Published/PublishedPlan.h"
#include "LightPropagation/Sweep/SweepTally.h"
#include "Medium/Medium.h"

#include "Device/Monitor.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// The rays of the published algorithm in the planes that one rank has across each axis: what SweepInSlabs sends from
/// rank to rank, as the parallel algorithm (SlabRaysOnDevice.h) or the sequential one (SlabRaysInTurn.h) has them. Rays
/// go in batches of directions of a face, those of the lower face of an axis first, and a batch in passes.
class SlabRays
{
public:
  /// Made in these steps, with planes across an axis for each that the rank has any of.
  virtual ~SlabRays() = default;
  /// @param medium  of the planes; copied
  virtual void TakePlanes(const PublishedSlab& slab, const Medium& medium) = 0;
  /// Directions a batch, at most, by what fits this rank.
  virtual int MostPerBatch() const = 0;
  /// @param perBatch  directions; the same on all ranks
  virtual void MakeBatches(int perBatch) = 0;

  /// Of the planes across an axis; of none no batches.
  virtual std::size_t Batches(int axis) const = 0;
  virtual bool IsForward(int axis, std::size_t batch) const = 0; ///< towards +axis
  virtual std::size_t Passes(int axis, std::size_t batch) const = 0;
  virtual std::size_t FloatsOfMap(int axis, std::size_t batch) const = 0; ///< that a pass hands on

  /// A batch's way through the planes across an axis.
  struct Way
  {
    int axis;
    std::size_t batch;
    int order;   ///< from 0: in it light comes in from outside
    bool emits;  ///< U is not zero
    bool begins; ///< rays come in to the grid at these planes, or go on round the axis from there
    bool given;  ///< rays come from other planes, or go on round the axis
    bool kept;   ///< and go there
  };

  virtual void BeginOrder() = 0;
  virtual void Begin(const Way& way, const PublishedFaces& faces, SweepTally& tally) = 0;
  /// @param given  what rays have ahead of the planes, where they are given any; empty: nothing
  /// @param faces, tally  told what leaves the box; faces now or in End()
  /// @return what they have behind them, where it is kept
  virtual std::vector<float> Send(const Way& way, std::size_t pass, const std::vector<float>& given,
    PublishedFaces& faces, SweepTally& tally, const Monitor& monitor) = 0;
  virtual void End(const Way& way, PublishedFaces& faces) = 0;

  /// Of the order, of the voxels of the planes across an axis, channels interleaved.
  virtual std::vector<float> Moment(int axis, int moment) const = 0;
  /// U of a direction that maps along the axis read, likewise.
  virtual void WriteSource(int axis, int sourceDirection, const std::vector<float>& source) = 0;
};
}
