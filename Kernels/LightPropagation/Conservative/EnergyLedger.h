#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Sweep/SweepVolume.h"

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
  /// What left by Escape(channel, watts) did so through this face.
  void EscapeWasThrough(int channel, int face, double watts) { this->Faces[face][channel] += watts; }
  /// What has escaped through faces that are not known did so as the rest did.
  void ShareEscaped(const Rgb& watts);
  /// In all; replaces what was said before.
  void LeaveOver(int channel, double watts) { this->Sums.leftOver[channel] = watts; }

  /// What came in and went out, of the channels of a volume.
  void Count(const SweepTally& tally);

  const EnergyBalance& Balance() const { return this->Sums; }
  const std::array<Rgb, 6>& FacePowerOut() const { return this->Faces; }

private:
  EnergyBalance Sums;
  std::array<Rgb, 6> Faces = {};
};
}
