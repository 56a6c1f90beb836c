#pragma once

#include "DiscreteOrdinates/OrdinateGroups.h"
#include "DiscreteOrdinates/UpwindSweep.h"
#include "Distribution/Domain.h"
#include "Light/LightField.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/FaceLight.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Sweep/SweepTally.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "PhaseFunction/SeparablePhaseFunction.h"

#include "Device/Clock.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace tyndall
{
/// Light of the last solve of one channel, the first guess of this one (KeptLight.h).
struct OrdinatesGuess
{
  bool keeps = false;        ///< this solve's light is wanted
  std::vector<float> values; ///< as OrdinatesResult::left has them; empty: begin in the dark
  double firstScattered = 0.0;
  double rate = 0.0;
};

/// One channel of a scene, as it is solved.
struct OrdinatesScene
{
  const Domain& domain;
  const Medium& medium; ///< of this rank's block; one voxel of vacuum where that is empty
  int channel = 0;
  std::vector<Light> lamps;  ///< of the scene, and the peaks of the environment; power of the channel in all three
  IncomingRadiance incoming; ///< empty: no light is incident
  std::array<Rgb, 6> faceAlbedo = {}; ///< of the channel in all three
  UncollidedImage uncollided;         ///< the channel's alone
  OrdinatesGuess guess;
};

/// Sum over all ranks. Collective.
SweepTally SumOf(const Domain& domain, const SweepTally& own);

/// Directions and how light is scattered between them.
struct OrdinatesAngles
{
  OrdinateGroups groups;
  SeparablePhaseFunction phase;
  PhaseFunction function;
};

/// Result of one channel. Arrays by voxel.
struct OrdinatesResult
{
  std::vector<float> fluence, direct; ///< W / length^2
  std::vector<float> flux;            ///< [x, y, z][voxel]; empty: not wanted
  EnergyLedger ledger;                ///< all in channel 0
  std::vector<float> facePower;       ///< W / length^2, by cell of the box's faces; empty: none reflects
  std::vector<ConvergenceRow> convergence;
  bool diverged = false;
  std::vector<float> left;     ///< scattered fluence, for the next solve; empty: not wanted
  double firstScattered = 0.0; ///< W, that the guess is scaled by
  double rate = 0.0;           ///< of the last order to the one before
};

/// Reflection by the box's faces along the directions of a solve: the albedo times the outgoing power of a cell comes
/// back as the same radiance along all incident directions (numerics.md, Eq. (D14)). Null: no face reflects.
std::unique_ptr<FaceLight> FaceLightOf(Device& device, const OrdinatesScene& scene, const OrdinateGroups& groups);

/// The arrays of that for a sweep; none where no face reflects.
std::optional<LightOfCells> CellsOf(const FaceLight* faces);

/// Rows of the convergence table, with an estimate of the remainder from the ratio of orders.
class OrdinatesRecord
{
public:
  /// The next order is the first to show the error of a first guess (RestOfOrders).
  void BeginWarm(double rate) { this->Rest.BeginWarm(rate); }
  /// @param goesOn  W (as published: change of fluence); from a first guess a magnitude, as orders may be negative
  void Add(double goesOn, const EnergyLedger& ledger) { this->Add(goesOn, goesOn, ledger); }
  /// @param more  the increment of the sum of all orders
  void Add(double goesOn, double more, const EnergyLedger& ledger);
  double Rate() const { return this->Rest.Ratio(); }
  double Residual() const { return this->Left; }
  std::vector<ConvergenceRow>& All() { return this->Rows; }
  const std::vector<ConvergenceRow>& All() const { return this->Rows; }

private:
  double Start = ClockSeconds();
  std::vector<ConvergenceRow> Rows;
  RestOfOrders Rest;
  double Sum = 0.0, Left = 1.0;
};
}
