#pragma once

#include "LightPropagation/Distributed/Published/SlabRays.h"
#include "LightPropagation/Published/SequentialRays.h"

#include <array>
#include <optional>

namespace tyndall
{
/// Those of the sequential algorithm (SequentialRays.h): a direction is a batch, and one ray after the other goes
/// through a rank's planes. None depends on another, but for the order in which they are added up, so that the ranks
/// work at once all the same.
class SlabRaysInTurn : public SlabRays
{
public:
  /// @param whole  the grid; must stay, as do model and settings
  SlabRaysInTurn(const Grid& whole, const PublishedModel& model, const PropagationSettings& settings);

  void TakePlanes(const PublishedSlab& slab, const Medium& medium) override;
  int MostPerBatch() const override { return 1; }
  void MakeBatches(int) override {}
  std::size_t Batches(int axis) const override;
  bool IsForward(int axis, std::size_t batch) const override;
  std::size_t Passes(int, std::size_t) const override { return 1; }
  std::size_t FloatsOfMap(int axis, std::size_t batch) const override;
  void BeginOrder() override;
  void Begin(const Way&, const PublishedFaces&, SweepTally&) override {}
  std::vector<float> Send(const Way& way, std::size_t pass, const std::vector<float>& given, PublishedFaces& faces,
    SweepTally& tally, const Monitor& monitor) override;
  void End(const Way&, PublishedFaces&) override {}
  std::vector<float> Moment(int axis, int moment) const override;
  void WriteSource(int axis, int sourceDirection, const std::vector<float>& source) override;

private:
  int DirectionOf(int axis, std::size_t batch) const;

  const Grid& Whole;
  const PublishedModel& Model;
  const PropagationSettings& Settings;
  std::array<std::optional<SequentialRays>, 3> Across; ///< none where there are no planes
};
}
