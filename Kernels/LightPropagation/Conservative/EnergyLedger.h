#pragma once

#include "Device/Clock.h"
#include "Light/LightField.h"
#include "LightPropagation/Sweep/SweepOperator.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Counts the power of one solve by its fate, W by channel. No other class does this (numerics.md, Eq. (80)). A value
/// type: a sweep can be counted on a copy that is then kept or discarded.
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
  /// Escaped power whose face is not known yet.
  void Escape(int channel, double watts) { this->Sums.escaped[channel] += watts; }
  /// Assigns to a face power that Escape(channel, watts) has counted.
  void AssignFace(int channel, int face, double watts) { this->Faces[face][channel] += watts; }
  /// Distributes power that escaped through unknown faces, in proportion to the known escaped power of each face.
  void ShareEscaped(const Rgb& watts);
  /// Sets the power left over, instead of adding to it.
  void SetUnaccounted(int channel, double watts) { this->Sums.leftOver[channel] = watts; }

  /// Adds the incident and escaped powers of a sweep.
  void Count(const SweepTally& tally);

  const EnergyBalance& Balance() const { return this->Sums; }
  const std::array<Rgb, 6>& FacePowerOut() const { return this->Faces; }

private:
  EnergyBalance Sums;
  std::array<Rgb, 6> Faces = {};
};

/// The rows of the `convergence` table, with the time since construction.
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
