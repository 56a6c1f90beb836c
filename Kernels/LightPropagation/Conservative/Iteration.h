#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"
#include "LightPropagation/Conservative/ConvergenceRecord.h"
#include "LightPropagation/Conservative/EnergyLedger.h"

#include <string>
#include <vector>

namespace tyndall
{
/// What an iteration has found when it ends; the light itself is in the parts' Fluence and Flux.
struct IterationResult
{
  EnergyLedger ledger;
  ConvergenceRecord convergence;
  std::vector<float> fluenceDirect, surfaceRadiance; ///< as LightField has them
  std::vector<float> firstMoments;                   ///< the same, where it asks for them
  std::vector<double> leftByCell;                    ///< W through the faces' cells, [channel][cell], where it is kept
  /// Angular moments of what is scattered of all light but uncollided light of lamps, as ScatteringOperator writes a
  /// source; only where TransportParts::StoresMoments().
  Buffer<float> shown;
  std::vector<std::string> leftOut; ///< by the iteration
  KeptLight kept;                   ///< for the next solve; empty: not wanted
  bool warm = false;                ///< begun from kept light
};

/// How scattering orders are added up: a strategy over the same sweep and scattering. When it ends, and what its last
/// residual means: numerics.md, section 7.9.
class Iteration
{
public:
  virtual ~Iteration() = default;
  /// @throws Aborted when the monitor says so
  virtual IterationResult Run(const Monitor& monitor) = 0;
};
}
