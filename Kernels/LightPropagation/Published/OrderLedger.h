#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

#include <chrono>
#include <vector>

namespace tyndall
{
/// Powers and convergence of the scattering orders of a solve as published, and when to stop.
class OrderLedger
{
public:
  /// @param medium  must stay
  OrderLedger(const Medium& medium, int channels, const PropagationSettings& settings);

  /// Boundary powers of the current order, and the power carried round periodic axes; in any number of parts.
  void Count(const SweepTally& tally);
  /// @param fluence  of this order alone, channels interleaved
  void CloseOrder(const std::vector<float>& fluence);

  bool Done() const { return this->Finished; }
  int Orders() const { return static_cast<int>(this->Rows.size()); }
  /// Part of the solve that is done, when a fraction of the current order is.
  double Progress(double fractionOfOrder) const;

  void WriteTo(LightField& field) const; ///< balance, facePowerOut, convergence

private:
  double EstimateResidual(const Rgb& orderSum) const;

  const Medium& TheMedium;
  PropagationSettings Settings;
  int Channels;
  bool Finished = false;
  EnergyLedger Powers;
  Rgb Carried = {};       ///< W carried round periodic axes in this order
  Rgb CarriedBefore = {}; ///< the same of the order before
  Rgb TotalSum = {}, LastSum = {};
  std::vector<ConvergenceRow> Rows;
  std::chrono::steady_clock::time_point Start;
};
}
