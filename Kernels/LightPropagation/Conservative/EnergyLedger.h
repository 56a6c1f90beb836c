#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Sweep/SweepTally.h"

#include <array>

namespace tyndall
{
/// Counts where the power of one light goes, W by channel: the only place that does (numerics.md, Eq. (80)). A value: a
/// sweep can be counted on a copy, which replaces this or is dropped.
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
  /// Through a face that is not known yet.
  void Escape(int channel, double watts) { this->Sums.escaped[channel] += watts; }
  /// Says through which face W left that were counted by Escape(channel, watts).
  void AssignFace(int channel, int face, double watts) { this->Faces[face][channel] += watts; }
  /// Shares W that escaped through unknown faces among the faces, in proportion to what is known of each.
  void ShareEscaped(const Rgb& watts);
  /// Sets the W left over, and does not add to them.
  void SetUnaccounted(int channel, double watts) { this->Sums.leftOver[channel] = watts; }

  /// What came in and went out, of the channels of a volume.
  void Count(const SweepTally& tally);

  const EnergyBalance& Balance() const { return this->Sums; }
  const std::array<Rgb, 6>& FacePowerOut() const { return this->Faces; }

private:
  EnergyBalance Sums;
  std::array<Rgb, 6> Faces = {};
};
}
