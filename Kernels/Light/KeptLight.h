#pragma once

#include "Light/LightField.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// What must be the same in two solves for the light of one to be the initial guess of the other. Medium and lights
/// need not be: a poor guess costs sweeps, but does not change the result.
struct LightKind
{
  std::string method; ///< of light propagation, and its iteration scheme
  std::array<int, 3> size = {};
  std::array<double, 3> spacing = {};
  int channels = 0;
  int degree = 0; ///< degree of the angular moments
  int directions = 0;
  std::array<bool, 3> periodic = {};
  VoxelBox block = {}; ///< this rank's block of the grid; empty in a serial solve

  /// What differs from `last`, as a clause, e.g. "the grid has changed"; empty if nothing does.
  std::string WhatChangedSince(const LightKind& last) const;
};

/// Light of the last solve, the initial guess of the next one (WarmStart; numerics.md, section 6.4); empty before the
/// first solve. In a distributed solve each rank keeps the light of its block, while powers and convergence rows are
/// those of the domain. A solve that is given a KeptLight starts from it if it can, and stores its own result in it on
/// success. The user owns it, and discards it to start without a guess.
struct KeptLight
{
  LightKind kind;
  /// Scattered light, in the units and the layout of the solver; uncollided light is recomputed in each solve.
  std::vector<float> scattered;
  Rgb firstScattered = {}; ///< W; power of the first-collision source. The guess is scaled by its change
  Rgb rate = {};           ///< ratio of successive iterations' light at the end of the solve
  std::vector<ConvergenceRow> fromDarkness; ///< convergence rows of the last solve without an initial guess

  bool Empty() const { return this->scattered.empty() || Sum(this->firstScattered) == 0.0; }
};

/// Why a solve cannot start from kept light, as a clause; empty if it can.
/// @param maximumOrders  number of iterations that the user asked for; 0: until convergence
std::string WhyNotBegun(const KeptLight& kept, const LightKind& kind, int maximumOrders);

/// Replaces `kept` by what a solve left, and sets LightField::sweepsSaved of its light.
/// @param warm  the solve started from kept light; if false, its rows become the reference for sweepsSaved of later
///   solves
void Keep(KeptLight&& left, bool warm, LightField& light, KeptLight& kept);

/// Clause returned by WhyNotBegun for published methods, which do not start from a guess.
constexpr const char* const NotBegunAsPublished = "orders as published begin in the dark";

/// Entry of LightField::leftOut for a solve that was asked to start from kept light.
/// @param whyNot  a clause from WhyNotBegun; empty if it did start from kept light
std::string WordsOfWarmStart(const std::string& whyNot);
}
