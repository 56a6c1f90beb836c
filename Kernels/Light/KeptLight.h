#pragma once

#include "Light/LightField.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// Properties of a solve that must be equal in two solves, so that the light of the first can be the initial guess of
/// the second. Medium and lights may differ: a poor guess costs sweeps, but does not change the result.
struct LightKind
{
  std::string method; ///< name of the solver and its iteration scheme
  std::array<int, 3> size = {};
  std::array<double, 3> spacing = {};
  int channels = 0;
  int degree = 0; ///< degree of the angular moments
  int directions = 0;
  std::array<bool, 3> periodic = {};
  VoxelBox block = {}; ///< this rank's subdomain; empty in a serial solve

  /// Clause that names the first property that differs from that of `last`, e.g. "the grid has changed"; empty if all
  /// properties are equal.
  std::string WhatChangedSince(const LightKind& last) const;
};

/// Light of the last solve, as initial guess of the next one (WarmStart; numerics.md, section 6.4); empty before the
/// first solve. In a distributed solve each rank stores the light of its subdomain; powers and convergence rows are
/// those of the domain. A solve that is given a KeptLight starts from it if possible, and stores its result in it on
/// success. The caller owns the KeptLight, and discards it to start without a guess.
struct KeptLight
{
  LightKind kind;
  /// Scattered light, in the units and the layout of the solver; uncollided light is recomputed in each solve.
  std::vector<float> scattered;
  /// power of the first-collision source, W. The next solve divides its own power of this source by this value, and
  /// multiplies the initial guess by the ratio
  Rgb firstScattered = {};
  Rgb rate = {}; ///< ratio of the light of successive iterations at the end of the last solve
  std::vector<ConvergenceRow> fromDarkness; ///< convergence rows of the last solve without an initial guess
  std::vector<KeptLight> channels;          ///< used instead of the members above if channels were solved one by one

  /// Whether no light is kept. A rank without voxels keeps the powers of the domain, but no values.
  bool Empty() const { return Sum(this->firstScattered) == 0.0; }
};

/// Reason, as a clause, why a solve cannot start from kept light; empty if it can.
/// @param maximumOrders  number of iterations that the user requested; 0: until convergence
std::string WhyNotBegun(const KeptLight& kept, const LightKind& kind, int maximumOrders);

/// Replaces `kept` by the result of a solve, `left`, and sets LightField::sweepsSaved of its light.
/// @param warm  whether the solve started from kept light; if false, its rows become the reference for sweepsSaved of
///   later solves
void Keep(KeptLight&& left, bool warm, LightField& light, KeptLight& kept);

/// Clause returned by WhyNotBegun for published methods, which do not start from an initial guess.
constexpr const char* const NotBegunAsPublished = "orders as published begin in the dark";

/// Entry of LightField::leftOut for a solve for which a warm start was requested.
/// @param whyNot  a clause from WhyNotBegun; empty if the solve started from kept light
std::string WordsOfWarmStart(const std::string& whyNot);
}
