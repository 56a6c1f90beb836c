#include "LightPropagation/Published/OrderLedger.h"

#include "LightPropagation/Convergence.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// No problem that converges at all needs more; those that do not must end.
constexpr int MostOrders = 10000;

constexpr double NothingToWaitFor = 1e-3; ///< of what is left over, beside what goes round without end

constexpr double WarmMargin = 1.5; ///< the error of a guess does not fall evenly
}

OrderSums SumsOf(const Medium& medium, int channels, const float* fluence)
{
  OrderSums sums;
  for (std::size_t voxel = 0; voxel < medium.grid.VoxelCount(); ++voxel)
  {
    for (int c = 0; c < channels; ++c)
    {
      const double value = fluence[voxel * channels + c];
      sums.fluence[c] += value;
      sums.magnitude[c] += std::abs(value);
      sums.absorbed[c] += value * medium.sigma_a.At(voxel, c);
      sums.scattered[c] += value * medium.sigma_s.At(voxel, c);
    }
  }
  return sums;
}

Rgb EmittedBy(const Medium& medium, int channels)
{
  const double power = 4.0 * Pi * medium.grid.VoxelVolume();
  Rgb emitted = {};
  for (std::size_t voxel = 0; voxel < medium.grid.VoxelCount(); ++voxel)
  {
    for (int c = 0; c < channels; ++c)
    {
      emitted[c] += power * medium.emission.At(voxel, c);
    }
  }
  return emitted;
}

OrderLedger::OrderLedger(const Medium& medium, const PublishedModel& model, const PropagationSettings& settings)
  : OrderLedger(medium.grid.VoxelVolume(), EmittedBy(medium, model.Channels()), model, settings)
{
}

OrderLedger::OrderLedger(
  double voxelVolume, const Rgb& emitted, const PublishedModel& model, const PropagationSettings& settings)
  : VoxelVolume(voxelVolume)
  , Settings(settings)
  , Channels(model.Channels())
  , FacesReflect(model.FacesReflect())
  , Start(std::chrono::steady_clock::now())
{
  this->Balance.emitted = emitted;
}

void OrderLedger::Count(const SweepTally& tally)
{
  for (int c = 0; c < this->Channels; ++c)
  {
    for (std::size_t face = 0; face < tally.out.size(); ++face)
    {
      this->Entered[c] += tally.in[face][c];
      this->FacePowerOut[face][c] += tally.out[face][c];
    }
    this->Carried[c] += tally.onTheWay[c];
  }
}

void OrderLedger::BeginWarm(const Rgb& rate)
{
  this->Warm = true;
  this->LeastRatio = rate;
}

void OrderLedger::GiveBack(const std::array<Rgb, 6>& powers)
{
  this->ComingBack = {};
  for (std::size_t face = 0; face < powers.size(); ++face)
  {
    for (int c = 0; c < this->Channels; ++c)
    {
      this->FacePowerOut[face][c] -= powers[face][c];
      this->ComingBack[c] += powers[face][c];
    }
  }
}

void OrderLedger::CloseOrder(const OrderSums& sums)
{
  ConvergenceRow row;
  row.iteration = this->Orders();
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count();
  this->Balance.entered = this->Entered;
  this->Balance.escaped = {};
  for (int c = 0; c < this->Channels; ++c)
  {
    this->Balance.absorbed[c] += this->VoxelVolume * sums.absorbed[c];
    this->Balance.leftOver[c] = this->VoxelVolume * sums.scattered[c] + this->Carried[c] + this->ComingBack[c];
    for (const Rgb& face : this->FacePowerOut)
    {
      this->Balance.escaped[c] += face[c];
    }
    this->TotalSum[c] += sums.fluence[c];
    row.absorbed += this->Balance.absorbed[c];
    row.escaped += this->Balance.escaped[c];
    row.leftOver += this->Balance.leftOver[c];
  }
  const Rgb& counted = this->Warm ? sums.magnitude : sums.fluence;
  bool goesOn = this->Warm && Sum(sums.magnitude) > 0.0;
  for (int c = 0; c < this->Channels && !this->Warm; ++c)
  {
    const double others = this->VoxelVolume * sums.scattered[c] + this->ComingBack[c];
    goesOn = goesOn ||
      GoesOnToItsEnd(this->Settings.maximumOrders, this->CarriedBefore[c], this->Carried[c], others) >
        NothingToWaitFor * this->Balance.leftOver[c];
  }
  row.residual = goesOn ? this->EstimateResidual(counted) : 0.0;
  this->SumBefore = this->LastSum;
  this->LastSum = this->Warm && this->Rows.empty() ? Rgb{} : counted; // with a guess it tells nothing
  this->CarriedBefore = std::exchange(this->Carried, {});
  this->Rows.push_back(row);
  this->Finished = row.residual == 0.0 ||
    (this->Settings.maximumOrders > 0 ? this->Orders() >= this->Settings.maximumOrders
                                      : MeetsTolerance(this->Settings, row.residual) || this->Orders() >= MostOrders);
}

/// Orders shrink like a geometric series in the end: what is still to come is its rest.
double OrderLedger::EstimateResidual(const Rgb& orderSum)
{
  double residual = this->Rows.empty() ? 1.0 : 0.0;
  for (int c = 0; c < this->Channels; ++c)
  {
    if (orderSum[c] > 0.0 && (this->LastSum[c] > 0.0 || (this->Warm && !this->Rows.empty())))
    {
      const double known = this->LeastRatio[c] > 0.0 ? this->LeastRatio[c] : 1.0;
      const double found =
        this->LastSum[c] > 0.0 ? std::max(orderSum[c] / this->LastSum[c], this->LeastRatio[c]) : known;
      const double ratio = std::min(found, 0.9999);
      const double growth = this->Ratio[c] > 0.0 && !this->Warm ? std::max(0.0, ratio - this->Ratio[c]) : 0.0;
      this->Limit[c] = std::min(ratio + growth, 0.9999);
      this->Ratio[c] = ratio;
      double rest = orderSum[c] * ratio / (1.0 - ratio) / this->TotalSum[c];
      if (this->FacesReflect)
      {
        rest = std::max(rest, this->RestOfPairs(c, orderSum[c]) / this->TotalSum[c]);
      }
      residual = std::max(residual, this->Warm ? WarmMargin * rest : rest);
    }
  }
  return residual;
}

/// Light that goes to and fro between a face that gives back much and one that gives back little falls by much and by
/// little in turn, but evenly from pair to pair of orders: what the pairs to come add up to.
double OrderLedger::RestOfPairs(int channel, double orderSum)
{
  const double before = this->SumBefore[channel];
  if (before <= 0.0)
  {
    return orderSum; // no pair is known yet
  }
  const double ratio = std::min(orderSum / before, 0.9998);
  this->Limit[channel] = std::max(this->Limit[channel], std::sqrt(ratio));
  return (this->LastSum[channel] + orderSum) * ratio / (1.0 - ratio);
}

double OrderLedger::Progress(double fractionOfOrder) const
{
  const double residual = this->Rows.empty() ? 1.0 : this->Rows.back().residual;
  return ProgressOf(this->Settings, residual, this->Orders() + fractionOfOrder);
}

void OrderLedger::WriteTo(LightField& field) const
{
  field.balance = this->Balance;
  field.facePowerOut = this->FacePowerOut;
  field.convergence = this->Rows;
}
}
