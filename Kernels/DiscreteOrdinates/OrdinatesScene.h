#pragma once

#include "Device/Clock.h"
#include "Device/Device.h"
#include "DiscreteOrdinates/OrdinateGroups.h"
#include "DiscreteOrdinates/OrdinatesSettings.h"
#include "DiscreteOrdinates/UpwindSweep.h"
#include "Distribution/Domain.h"
#include "Light/LightField.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/FaceLight.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/PropagationSettings.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "PhaseFunction/SeparablePhaseFunction.h"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tyndall
{
/// Light of the previous solve of one channel, the first guess of this one (KeptLight.h).
struct OrdinatesGuess
{
  bool keeps = false;        ///< keep the light of this solve
  bool begins = false;       ///< there is a first guess
  std::vector<float> values; ///< as OrdinatesResult::left
  double firstScattered = 0.0;
  double rate = 0.0;
};

/// One channel of a scene, in the units of the solver.
struct OrdinatesScene
{
  const Domain& domain;
  const Medium& medium; ///< of this rank's block
  int channel = 0;
  std::vector<Light> lamps;  ///< of the scene, and the peaks of the environment; power of the channel in all three
  IncomingRadiance incoming; ///< empty: no light is incident
  std::array<Rgb, 6> faceAlbedo = {}; ///< of the channel in all three
  UncollidedImage uncollided;         ///< of this channel
  OrdinatesGuess guess;
};

/// Sum over all ranks. Collective.
SweepTally SumOf(const Domain& domain, const SweepTally& own);

/// Directions, and the phase function between them.
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
  std::vector<float> flux;            ///< [x, y, z][voxel]; empty: not requested
  EnergyLedger ledger;                ///< all in channel 0
  std::vector<float> facePower;       ///< W / length^2, by cell of the box's faces; empty: none reflects
  std::vector<ConvergenceRow> convergence;
  bool diverged = false;
  std::vector<float> left;     ///< scattered fluence, for the next solve; empty: not requested
  double firstScattered = 0.0; ///< W first scattered, by which the next guess is scaled
  double rate = 0.0;           ///< ratio of the last two orders
};

/// Reflection by the box faces along the directions of a solve: the albedo times the outgoing power of a cell re-enters
/// as equal radiance along all incident directions (numerics.md, Eq. (D14)). Null if no face reflects.
std::unique_ptr<FaceLight> FaceLightOf(Device& device, const OrdinatesScene& scene, const OrdinateGroups& groups);

/// Arrays of FaceLight for a sweep; none if no face reflects.
std::optional<LightOfCells> CellsOf(const FaceLight* faces);

/// Rows of the convergence table, with an estimate of the remainder from the ratio of successive orders.
class OrdinatesRecord
{
public:
  /// Tells that the next order is the first correction to a first guess (RestOfOrders).
  void BeginWarm(double rate) { this->Rest.BeginWarm(rate); }
  /// @param goesOn  power that the next order carries, W (published scheme: change of fluence); after a first guess its
  ///   magnitude, because orders may be negative
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

/// Boundary light from far away, along the directions of a solve.
struct FarLight
{
  std::vector<Direction> directions;
  std::vector<Rgb> radiance; ///< by direction, W / (length^2 sr)
  std::vector<Light> peaks;  ///< peaks of the environment
};

/// @param perFace  directions per cube face used in the solve
FarLight FarLightOf(const Illumination& shining, int perFace, const OrdinatesSettings& settings);

/// Phase function of a channel. If its mean cosine varies by voxel, the mean weighted by sigma_s is used. Collective.
PhaseFunction FunctionOf(const Domain& domain, const Medium& medium, int channel);

/// Warnings about properties of the medium that make the light inaccurate.
/// @param thickestStep  largest ThickestStep of all channels
std::vector<std::string> DoubtsOf(const OrdinatesSettings& settings, double thickestStep, bool cosineVaries);

/// Face albedo with the value of one channel in all three.
std::array<Rgb, 6> FaceAlbedoOf(const Illumination& shining, int channel);
UncollidedImage UncollidedOf(const Illumination& shining, int channel);

SeparablePhaseFunction SeparableOf(
  const PhaseFunction& function, const std::vector<Direction>& directions, const OrdinatesSettings& settings);

/// @throws DeviceError if the solve does not fit the device; the message states the memory needed
void CheckMemory(Device& device, const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings);

/// Boundary radiance of a channel; empty if there is none. `far` and `shining` must outlive the result.
IncomingRadiance IncomingOf(const FarLight& far, const Illumination& shining, int channel);

/// Lamps of the scene and peaks of the environment, with the power of one channel in all three.
std::vector<Light> LampsOf(const FarLight& far, const Illumination& shining, int channel);

/// Stores the light of one channel in `light`.
void TakeChannel(LightField& light, const OrdinatesResult& found, int channel);

/// Sets the derived quantities of `light`, in the units of the solver.
void DescribeLight(LightField& light, const Device& device, const FarLight& far);

/// Checks convergence and, except for the published scheme, the energy balance (Convergence.h). Collective.
/// @param medium  of this rank, as solved
/// @throws InvalidInput if the energy balance is off
void Judge(
  const OrdinatesSettings& settings, bool diverged, const Domain& domain, const Medium& medium, LightField& light);
}
