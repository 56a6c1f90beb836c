#pragma once

#include "Device/Clock.h"
#include "Light/LightField.h"
#include "LightPropagation/Sweep/SweepOperator.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Energy balance of one solve, W by channel (numerics.md, Eq. (80)): incident, emitted, absorbed, escaped and
/// unaccounted power, and escaped power by face of the box. A value type: a sweep can be counted on a copy that is then
/// kept or discarded.
class EnergyLedger
{
public:
  void Enter(int channel, double watts) { this->Sums.entered[channel] += watts; }
  void Emit(int channel, double watts) { this->Sums.emitted[channel] += watts; }
  void Absorb(int channel, double watts) { this->Sums.absorbed[channel] += watts; }
  void Escape(int channel, int face, double watts)
  {
    this->Sums.escaped[channel] += watts;
    this->Faces[face][channel] += watts;
  }
  /// Counts escaped power whose face is not known yet.
  void Escape(int channel, double watts) { this->Sums.escaped[channel] += watts; }
  /// Assigns escaped power to a face, after Escape(channel, watts) has counted it without a face.
  void AssignFace(int channel, int face, double watts) { this->Faces[face][channel] += watts; }
  /// Distributes `watts` of power that escaped through unknown faces over the six faces, in proportion to the escaped
  /// power already assigned to each. Powers below 0, which rounding produces at dark faces, become 0; their sum is
  /// kept.
  void ShareEscaped(const Rgb& watts = {});
  /// Sets the unaccounted power of a channel: the power still in flight, and the power of sources that no sweep has
  /// transported.
  void SetUnaccounted(int channel, double watts) { this->Sums.leftOver[channel] = watts; }

  /// Scales absorbed and escaped powers down if their sum exceeds the incoming power, so that no unaccounted power is
  /// below 0. For coarse-mesh DSA, which predicts the absorbed and escaped power of later scattering orders: the excess
  /// is the error of this prediction. Leaves a channel unchanged if its excess is too large.
  /// @param error  largest excess that is removed, as a fraction of the absorbed and escaped power
  void SettleOvercount(double error);

  /// Adds the incident and escaped powers of a sweep.
  void Count(const SweepTally& tally);

  const EnergyBalance& Balance() const { return this->Sums; }
  const std::array<Rgb, 6>& FacePowerOut() const { return this->Faces; }

private:
  EnergyBalance Sums;
  std::array<Rgb, 6> Faces = {};
};

/// Rows of the `convergence` table of a solve. The time in a row is counted from the construction of this object.
class ConvergenceRecord
{
public:
  void Add(double residual, double change, const EnergyLedger& ledger)
  {
    const EnergyBalance& balance = ledger.Balance();
    this->Rows.push_back({ static_cast<int>(this->Rows.size()), ClockSeconds() - this->Start, residual, change,
      Sum(balance.absorbed), Sum(balance.escaped), Sum(balance.leftOver) });
  }
  const std::vector<ConvergenceRow>& All() const { return this->Rows; }

private:
  double Start = ClockSeconds();
  std::vector<ConvergenceRow> Rows;
};
}
