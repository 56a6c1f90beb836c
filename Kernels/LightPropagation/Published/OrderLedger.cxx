#include "LightPropagation/Published/OrderLedger.h"

#include "LightPropagation/Convergence.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
/// Maximum number of orders; no convergent solve needs more.
constexpr int MostOrders = 10000;

/// The solve ends when the next order would carry at most this fraction of the remaining power. Light that wraps around
/// periodic axes without end does not count.
constexpr double Negligible = 1e-3;
constexpr double LargestRatio = 0.9999; ///< largest ratio of successive orders of a convergent series
}

OrderLedger::OrderLedger(const Medium& medium, int channels, const PropagationSettings& settings)
  : TheMedium(medium)
  , Settings(settings)
  , Channels(channels)
{
  const double power = 4.0 * Pi * medium.grid.VoxelVolume();
  for (std::size_t voxel = 0; voxel < medium.grid.VoxelCount(); ++voxel)
  {
    for (int c = 0; c < channels; ++c)
    {
      this->Powers.Emit(c, power * medium.emission.At(voxel, c));
    }
  }
}

void OrderLedger::Count(const SweepTally& tally)
{
  this->Powers.Count(tally);
  for (int c = 0; c < this->Channels; ++c)
  {
    this->Carried[c] += tally.onTheWay[c];
  }
}

void OrderLedger::CloseOrder(const std::vector<float>& fluence)
{
  const double volume = this->TheMedium.grid.VoxelVolume();
  Rgb sum = {}, absorbed = {}, scattered = {};
  for (std::size_t i = 0; i < fluence.size(); ++i)
  {
    const std::size_t voxel = i / this->Channels, c = i % this->Channels;
    const double value = fluence[i];
    sum[c] += value;
    absorbed[c] += value * this->TheMedium.sigma_a.At(voxel, static_cast<int>(c));
    scattered[c] += value * this->TheMedium.sigma_s.At(voxel, static_cast<int>(c));
  }
  bool goesOn = false;
  for (int c = 0; c < this->Channels; ++c)
  {
    const double next = volume * scattered[c], leftOver = next + this->Carried[c];
    this->Powers.Absorb(c, volume * absorbed[c]);
    this->Powers.SetUnaccounted(c, leftOver);
    this->TotalSum[c] += sum[c];
    goesOn = goesOn ||
      GoesOnToItsEnd(this->Settings.maximumOrders, this->CarriedBefore[c], this->Carried[c], next) >
        Negligible * leftOver;
  }
  const double residual = goesOn ? this->EstimateResidual(sum) : 0.0;
  this->Record.Add(residual, 0.0, this->Powers);
  this->LastSum = sum;
  this->CarriedBefore = std::exchange(this->Carried, {});
  this->Finished = residual == 0.0 ||
    (this->Settings.maximumOrders > 0 ? this->Orders() >= this->Settings.maximumOrders
                                      : MeetsTolerance(this->Settings, residual) || this->Orders() >= MostOrders);
}

/// Estimates the sum of the fluence over all further orders, relative to the sum over the orders so far. Orders are
/// assumed to decrease like a geometric series.
/// @param orderSum  sum over voxels of the fluence of the last order
double OrderLedger::EstimateResidual(const Rgb& orderSum) const
{
  double residual = this->Orders() == 0 ? 1.0 : 0.0;
  for (int c = 0; c < this->Channels; ++c)
  {
    if (orderSum[c] > 0.0 && this->LastSum[c] > 0.0)
    {
      const double ratio = std::min(orderSum[c] / this->LastSum[c], LargestRatio);
      residual = std::max(residual, orderSum[c] * ratio / (1.0 - ratio) / this->TotalSum[c]);
    }
  }
  return residual;
}

double OrderLedger::Progress(double fractionOfOrder) const
{
  const double residual = this->Orders() == 0 ? 1.0 : this->Record.All().back().residual;
  return ProgressOf(this->Settings, residual, this->Orders() + fractionOfOrder);
}

void OrderLedger::WriteTo(LightField& field) const
{
  field.balance = this->Powers.Balance();
  field.facePowerOut = this->Powers.FacePowerOut();
  field.convergence = this->Record.All();
}
}
