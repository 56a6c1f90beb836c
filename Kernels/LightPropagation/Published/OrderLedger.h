#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

#include <vector>

namespace tyndall
{
/// Powers and convergence of the scattering orders of a solve with the published scheme, and the stopping criterion.
class OrderLedger
{
public:
  /// @param medium  must outlive this
  OrderLedger(const Medium& medium, int channels, const PropagationSettings& settings);

  /// Adds boundary powers of the current order, and the power that wraps around periodic axes. May be called several
  /// times per order.
  void Count(const SweepTally& tally);
  /// @param fluence  of this order alone, channels interleaved
  void CloseOrder(const std::vector<float>& fluence);

  bool Done() const { return this->Finished; }
  int Orders() const { return static_cast<int>(this->Record.All().size()); }
  /// Fraction of the solve that is done, given the fraction of the current order that is done.
  double Progress(double fractionOfOrder) const;

  void WriteTo(LightField& field) const; ///< balance, facePowerOut, convergence

private:
  double EstimateResidual(const Rgb& orderSum) const;

  const Medium& TheMedium;
  PropagationSettings Settings;
  int Channels;
  bool Finished = false;
  EnergyLedger Powers;
  Rgb Carried = {};       ///< W that wraps around periodic axes in this order
  Rgb CarriedBefore = {}; ///< the same of the order before
  Rgb TotalSum = {}, LastSum = {};
  ConvergenceRecord Record;
};
}
