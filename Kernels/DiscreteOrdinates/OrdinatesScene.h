#pragma once

#include "DiscreteOrdinates/OrdinateGroups.h"
#include "DiscreteOrdinates/UpwindSweep.h"
#include "Light/LightField.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "PhaseFunction/SeparablePhaseFunction.h"

#include "Device/Clock.h"

#include <vector>

namespace tyndall
{
/// One channel of a scene as discrete ordinates see it: what is solved.
struct OrdinatesScene
{
  const Medium& medium;
  int channel = 0;
  std::vector<Light> lamps;  ///< of the scene, and the peaks of the environment; power of the channel in all three
  IncomingRadiance incoming; ///< empty: no environment, sky or face shines
};

/// Directions and how light is scattered between them.
struct OrdinatesAngles
{
  OrdinateGroups groups;
  SeparablePhaseFunction phase;
  PhaseFunction function;
};

/// What a solve of one channel found. Arrays by voxel.
struct OrdinatesResult
{
  std::vector<float> fluence, direct; ///< W / length^2
  std::vector<float> flux;            ///< [x, y, z][voxel]; empty: not wanted
  EnergyLedger ledger;                ///< all in channel 0
  std::vector<ConvergenceRow> convergence;
  bool diverged = false;
};

/// Rows of the convergence table, and an estimate of what is still to come from how fast orders become smaller
/// (numerics.md, Eq. (43)).
class OrdinatesRecord
{
public:
  /// @param scattered  W (as published: change of fluence) that goes on
  void Add(double scattered, const EnergyLedger& ledger);
  double Residual() const { return this->Left; }
  bool Grows() const { return this->Ratio > 1.0 && this->Rows.size() > 3; } ///< the last order was larger
  std::vector<ConvergenceRow>& All() { return this->Rows; }
  const std::vector<ConvergenceRow>& All() const { return this->Rows; }

private:
  double Start = ClockSeconds();
  std::vector<ConvergenceRow> Rows;
  double Sum = 0.0, Last = 0.0, Ratio = 0.0, Left = 1.0;
};
}
