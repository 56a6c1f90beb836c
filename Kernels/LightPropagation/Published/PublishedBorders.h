#pragma once

#include "LightPropagation/Published/PublishedFaces.h"
#include "LightPropagation/Published/PublishedPlan.h"
#include "LightPropagation/Sweep/SweepTally.h"

#include <vector>

namespace tyndall
{
/// Light through the faces of the box, in the published algorithm: the radiance that the maps of a batch start with,
/// and the power that comes in and goes out.
class PublishedBorders
{
public:
  /// @param model, plan  must stay
  PublishedBorders(const PublishedModel& model, const PropagationSettings& settings, const PublishedPlan& plan);

  /// Radiance entering across w, u, v in order 0: [direction][3][channel], filled up to what the plan has for it.
  std::vector<float> Radiance(const PublishedPlan::Batch& batch) const;
  /// Adds up, of the whole grid, rays that start on the map in order 0, and those that come in anew through a side.
  void TallyEntered(const PublishedPlan::Batch& batch, SweepTally& tally) const;
  /// Adds up what a pass left at the borders, laid out as PublishedPropagate.cl says.
  void TallyEscaped(const PublishedPlan::Batch& batch, const std::vector<float>& escaped, SweepTally& tally) const;
  /// The same by cell, as PublishedFaces.cl lays it out.
  void TallyLeft(const PublishedPlan::Batch& batch, const std::vector<float>& left, PublishedFaces& faces) const;

private:
  const PublishedModel& Model;
  PropagationSettings Settings;
  const PublishedPlan& Plan;
};
}
