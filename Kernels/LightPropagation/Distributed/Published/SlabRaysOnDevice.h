#pragma once

#include "LightPropagation/Distributed/Published/SlabRays.h"
#include "LightPropagation/Published/PublishedBorders.h"
#include "LightPropagation/Published/PublishedSweep.h"

#include "Device/Device.h"

#include <array>
#include <optional>

namespace tyndall
{
/// Those of the parallel algorithm (ParallelPropagation.h).
class SlabRaysOnDevice : public SlabRays
{
public:
  /// @param whole  the grid; must stay, as do device, model and faces
  SlabRaysOnDevice(Device& device, const Grid& whole, const PublishedModel& model, const PropagationSettings& settings,
    const PublishedFaces& faces);

  /// @throws DeviceError if the planes do not fit
  void TakePlanes(const PublishedSlab& slab, const Medium& medium) override;
  int MostPerBatch() const override;
  /// @throws DeviceError if the maps do not fit
  void MakeBatches(int perBatch) override;
  std::size_t Batches(int axis) const override;
  bool IsForward(int axis, std::size_t batch) const override;
  std::size_t Passes(int axis, std::size_t batch) const override;
  std::size_t FloatsOfMap(int axis, std::size_t batch) const override;
  void BeginOrder() override;
  void Begin(const Way& way, const PublishedFaces& faces, SweepTally& tally) override;
  std::vector<float> Send(const Way& way, std::size_t pass, const std::vector<float>& given, PublishedFaces& faces,
    SweepTally& tally, const Monitor& monitor) override;
  void End(const Way& way, PublishedFaces& faces) override;
  std::vector<float> Moment(int axis, int moment) const override;
  void WriteSource(int axis, int sourceDirection, const std::vector<float>& source) override;

private:
  /// Planes across an axis.
  struct Planes
  {
    PublishedSlab slab;
    std::optional<PublishedVolumes> volumes; ///< none where there are no planes
    std::optional<PublishedPlan> plan;
    std::optional<PublishedBorders> borders;
    bool collected = false; ///< some of this order
  };

  Device& TheDevice;
  const Grid& Whole;
  const PublishedModel& Model;
  PropagationSettings Settings;
  const PublishedFaces& Faces;
  std::array<Planes, 3> Across;
  std::optional<PublishedSweep> Sweep; ///< none without planes
};
}
