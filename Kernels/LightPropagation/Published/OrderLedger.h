#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Published/PublishedModel.h"
#include "LightPropagation/Sweep/SweepTally.h"

#include <array>
#include <chrono>
#include <vector>

namespace tyndall
{
/// Sums over a medium's voxels of an order's fluence, by channel, W / length^2; absorbed and scattered: times sigma_a
/// and sigma_s, W / length^3.
struct OrderSums
{
  Rgb fluence = {}, magnitude = {}, absorbed = {}, scattered = {};
};

/// @param fluence  of this order alone, channels interleaved
OrderSums SumsOf(const Medium& medium, int channels, const float* fluence);

/// W that a medium emits, by channel.
Rgb EmittedBy(const Medium& medium, int channels);

/// Adds up orders: powers, convergence, and whether to go on. Of a medium that is spread over ranks each has one, told
/// of what all have together.
class OrderLedger
{
public:
  OrderLedger(const Medium& medium, const PublishedModel& model, const PropagationSettings& settings);
  /// @param voxelVolume  length^3
  /// @param emitted      W, by the whole medium
  OrderLedger(double voxelVolume, const Rgb& emitted, const PublishedModel& model, const PropagationSettings& settings);

  /// What came in, left, and is on its way through periodic axes, in the order that runs: in any number of parts.
  void Count(const SweepTally& tally);

  /// Of what left, W through each face come back in the next order: before CloseOrder, where cells are counted.
  void GiveBack(const std::array<Rgb, 6>& powers);

  /// The first order has a guess in it that the second is to take away: orders after the first may be negative, and
  /// fall by `rate` at least (numerics.md, section 6.4).
  void BeginWarm(const Rgb& rate);
  const Rgb& Rate() const { return this->Limit; } ///< of an order to the one before, to which it seems to grow

  void CloseOrder(const OrderSums& sums);
  bool Done() const { return this->Finished; }
  int Orders() const { return static_cast<int>(this->Rows.size()); }
  /// Fraction of all work done when a fraction of the running order is.
  double Progress(double fractionOfOrder) const;

  void WriteTo(LightField& field) const; ///< balance, facePowerOut, convergence

private:
  double EstimateResidual(const Rgb& orderSum);
  double RestOfPairs(int channel, double orderSum);

  double VoxelVolume;
  PropagationSettings Settings;
  int Channels;
  bool FacesReflect; ///< light can go to and fro between two of them
  bool Finished = false;
  Rgb Entered = {};                     ///< W
  std::array<Rgb, 6> FacePowerOut = {}; ///< W
  Rgb Carried = {};                     ///< W on the way through periodic axes, of this order
  Rgb CarriedBefore = {};               ///< W, of the one before
  EnergyBalance Balance;
  Rgb TotalSum = {};
  Rgb LastSum = {}, SumBefore = {}; ///< of the last order, of the one before that
  Rgb ComingBack = {};
  Rgb Ratio = {}, Limit = {}, LeastRatio = {};
  bool Warm = false;
  std::vector<ConvergenceRow> Rows;
  std::chrono::steady_clock::time_point Start;
};
}
