#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

#include <vector>

namespace tyndall
{
/// Energy balance and convergence of a solve with the published scheme, order by order, and its stopping criterion.
class OrderLedger
{
public:
  /// @param medium  must outlive this object
  OrderLedger(const Medium& medium, int channels, const PropagationSettings& settings);

  /// Adds powers of the current order: incident and escaped power, and power that wraps around periodic axes. May be
  /// called several times per order.
  void Count(const SweepTally& tally);
  /// Ends the current order and decides whether it was the last one.
  /// @param fluence  fluence of this order alone, W / length^2, channels interleaved
  void CloseOrder(const std::vector<float>& fluence);

  bool Done() const { return this->Finished; }
  int Orders() const { return static_cast<int>(this->Record.All().size()); }
  /// Progress of the solve, 0 to 1, given the completed fraction of the current order.
  double Progress(double fractionOfOrder) const;

  void WriteTo(LightField& field) const; ///< sets balance, facePowerOut and convergence

private:
  double EstimateResidual(const Rgb& orderSum) const;

  const Medium& TheMedium;
  PropagationSettings Settings;
  int Channels;
  bool Finished = false;
  EnergyLedger Powers;
  Rgb Carried = {};       ///< power that wraps around periodic axes in this order, W
  Rgb CarriedBefore = {}; ///< power that wrapped around in the previous order, W
  Rgb TotalSum = {}, LastSum = {};
  ConvergenceRecord Record;
};
}
