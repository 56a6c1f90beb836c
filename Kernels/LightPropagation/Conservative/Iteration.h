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
/// Result of Iteration::Run(), except for fluence and net flux, which are in TransportParts::Fluence and Flux.
struct IterationResult
{
  EnergyLedger ledger;
  ConvergenceRecord convergence;
  /// Uncollided fluence, W / length^2, and outgoing radiance at the box's faces, W / (length^2 sr), as in LightField;
  /// empty: not computed.
  std::vector<float> fluenceDirect, surfaceRadiance;
  /// Mean positions of collisions relative to the voxels' centres (LightField::firstMoments); empty: not requested.
  std::vector<float> firstMoments;
  /// Power that left through each cell of the box faces, W, [channel][cell], if requested.
  std::vector<double> leftByCell;
  /// Angular moments of the in-scattered radiance, without the first-scattered light of lamps, in the layout of a
  /// source (ScatteringOperator). Set only if TransportParts::StoresMoments().
  Buffer<float> shown;
  std::vector<std::string> leftOut; ///< entries of LightField::leftOut that the iteration adds
  KeptLight kept;                   ///< light to begin the next solve from; empty: not requested
  bool warm = false;                ///< whether this solve began from the light of a previous one
};

/// Iteration that solves for the light of all scattering orders by sweeps: source iteration, with or without DSA.
/// Stopping criterion and meaning of the last residual: numerics.md, section 7.9.
class Iteration
{
public:
  virtual ~Iteration() = default;
  /// @throws Aborted if the monitor aborts the solve
  virtual IterationResult Run(const Monitor& monitor) = 0;
};
}
