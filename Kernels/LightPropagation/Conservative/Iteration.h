#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"
#include "LightPropagation/Conservative/EnergyLedger.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Result of an iteration. Fluence and flux themselves are in TransportParts::Fluence and Flux.
struct IterationResult
{
  EnergyLedger ledger;
  ConvergenceRecord convergence;
  std::vector<float> fluenceDirect, surfaceRadiance; ///< as in LightField
  std::vector<float> firstMoments;                   ///< likewise; empty: not requested
  std::vector<double> leftByCell; ///< W that left through each face cell, [channel][cell], if requested
  /// Angular moments of the scattered radiance of all light except uncollided light of lamps, in the layout of a source
  /// (ScatteringOperator); only if TransportParts::StoresMoments().
  Buffer<float> shown;
  std::vector<std::string> leftOut; ///< simplifications the iteration made
  KeptLight kept;                   ///< first guess for the next solve; empty: not requested
  bool warm = false;                ///< this solve began from kept light
};

/// Strategy that sums the scattering orders, over the same sweep and scattering operators. Stopping criterion and
/// meaning of the last residual: numerics.md, section 7.9.
class Iteration
{
public:
  virtual ~Iteration() = default;
  /// @throws Aborted if the monitor aborts the solve
  virtual IterationResult Run(const Monitor& monitor) = 0;
};
}
