#pragma once

#include "Light/LightField.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// What has to be the same for the light of one solve to be the first guess of another. What the medium and the lights
/// are like is not among it: a guess that is far off costs sweeps, and is not part of the answer.
struct LightKind
{
  std::string method; ///< of light propagation, and how its orders are added up
  std::array<int, 3> size = {};
  std::array<double, 3> spacing = {};
  int channels = 0;
  int degree = 0; ///< of angular moments
  int directions = 0;
  std::array<bool, 3> periodic = {};
  VoxelBox block = {}; ///< of the grid, whose light it is; of one that is not spread over ranks: none

  /// What is not as in `last`, as a clause: "the grid has changed". Empty: nothing.
  std::string WhatChangedSince(const LightKind& last) const;
};

/// Light of the last solve, the first guess of the next one (WarmStart; numerics.md, section 6.4). Empty before the
/// first. Of a grid that is spread over ranks by blocks each rank keeps that of its own, but powers and rows are of the
/// whole. A solve that is given one begins from it where it can, and leaves its own in it when it ends well. The user
/// owns it, and drops it to begin in the dark.
struct KeptLight
{
  LightKind kind;
  /// Scattered light, in the units and the layout of the solver: unscattered light is found anew each time.
  std::vector<float> scattered;
  Rgb firstScattered = {};                  ///< W, of unscattered light; the guess is scaled by how it changed
  Rgb rate = {};                            ///< by which the last iterations fell, each over the one before
  std::vector<ConvergenceRow> fromDarkness; ///< rows of the last solve that began in the dark

  bool Empty() const { return this->scattered.empty() || Sum(this->firstScattered) == 0.0; }
};

/// Why a solve cannot begin from kept light, as a clause. Empty: it can.
/// @param maximumOrders  iterations that the user counts; 0: they are not counted
std::string WhyNotBegun(const KeptLight& kept, const LightKind& kind, int maximumOrders);

/// Puts what a solve left in the place of what was kept, and sets sweepsSaved of its light (LightField.h).
/// @param warm  the solve began from kept light; else it is what the next ones are measured by
void Keep(KeptLight&& left, bool warm, LightField& light, KeptLight& kept);

/// Such a clause: no paper starts from a guess.
constexpr const char* const NotBegunAsPublished = "orders as published begin in the dark";

/// Words of `left_out` for a solve that was to begin from kept light.
/// @param whyNot  a clause; empty: it did
std::string WordsOfWarmStart(const std::string& whyNot);
}
