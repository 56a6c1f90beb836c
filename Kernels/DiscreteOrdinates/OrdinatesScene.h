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
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "PhaseFunction/SeparablePhaseFunction.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tyndall
{
/// One channel of a scene, in the units in which the solver computes (PropagationProblem).
struct OrdinatesScene
{
  const Domain& domain;
  const Medium& medium; ///< medium of this rank's block
  int channel = 0;
  /// Lamps of the scene and parallel beams that represent peaks of the environment, with the power of this channel in
  /// all three components.
  std::vector<Light> lamps;
  IncomingRadiance incoming; ///< boundary source of sweeps; empty: no light is incident
  /// Light that enters through faces and is traced along separate rays until its first collision; null: this light is
  /// part of `incoming`.
  const BoundaryLight* faces = nullptr;
  int facesDegree = -1;               ///< degree of the angular moments in which `faces` are scattered
  std::array<Rgb, 6> faceAlbedo = {}; ///< albedo of this channel in all three components
  UncollidedImage uncollided;         ///< uncollided light of this channel, given by another solver
  VoxelBox filled;                    ///< box of this rank's voxels that contains all of the medium, in all channels
};

/// Sums the incident and escaped powers of a sweep over all ranks. Collective.
SweepTally SumOf(const Domain& domain, const SweepTally& own);

/// Directions of a solve, and the phase function between them: its separable form for second and later scattering
/// orders, and the function itself for first scattering.
struct OrdinatesAngles
{
  OrdinateGroups groups;
  SeparablePhaseFunction phase;
  PhaseFunction function;
};

/// Result of the solve of one channel. Arrays are by voxel of this rank's block, unless stated otherwise.
struct OrdinatesResult
{
  std::vector<float> fluence, direct; ///< total and uncollided fluence, W / length^2
  std::vector<float> flux;            ///< net flux, W / length^2, [x, y, z][voxel]; empty: not requested
  EnergyLedger ledger;                ///< energy balance, in channel 0 of the ledger
  /// Outgoing power per area, W / length^2, by cell of the box's faces; empty: no face reflects.
  std::vector<float> facePower;
  std::vector<ConvergenceRow> convergence;
  std::vector<std::string> leftOut; ///< what the sweeps of this channel omitted (LeftOut.h)
};

/// Makes the arrays of outgoing and reflected light by cell of the box faces for the directions of a solve
/// (numerics.md, Eq. (D14)). The outgoing power of a cell, times the albedo, is incident in the next sweep as equal
/// radiance along all incident directions. Null if no face reflects.
std::unique_ptr<FaceLight> FaceLightOf(Device& device, const OrdinatesScene& scene, const OrdinateGroups& groups);

/// Arrays of `faces` that a sweep adds to and reads; none if `faces` is null.
std::optional<LightOfCells> CellsOf(const FaceLight* faces);

/// Rows of the convergence table of one channel. The sum of the orders not computed is estimated from the ratio of
/// successive orders.
class OrdinatesRecord
{
public:
  /// @param goesOn  power still in transport, which the next order carries, W (published scheme: change of fluence)
  void Add(double goesOn, const EnergyLedger& ledger);
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

/// Directions of a solve, the radiance of sky and environment along them, and the peaks of the environment, which are
/// not part of that radiance.
struct FarLight
{
  std::vector<Direction> directions;
  std::vector<Rgb> radiance; ///< radiance of sky and environment by direction, W / (length^2 sr)
  std::vector<Light> peaks;  ///< peaks of the environment, represented by parallel beams
};

/// Chooses the directions of a solve, and splits the light of sky and environment into peaks and radiance along the
/// directions.
/// @param perFace  directions per cube face of the solve
FarLight FarLightOf(const Illumination& shining, int perFace, const OrdinatesSettings& settings);

/// Phase function of a channel. If its mean cosine varies by voxel, the result has the mean over the voxels, weighted
/// by sigma_s. Collective.
PhaseFunction FunctionOf(const Domain& domain, const Medium& medium, int channel);

/// Warnings about properties of the medium or settings that make the light inaccurate.
/// @param thickestStep  largest ThickestStep (sigma_t times the length of an explicit step) of all channels
std::vector<std::string> DoubtsOf(const OrdinatesSettings& settings, double thickestStep, bool cosineVaries);

/// Albedo of each face, with the value of one channel in all three components.
std::array<Rgb, 6> FaceAlbedoOf(const Illumination& shining, int channel);
UncollidedImage UncollidedOf(const Illumination& shining, int channel);

/// @param nowhereNegative  whether the terms are damped until their sum is nowhere negative (SeparableSettings)
SeparablePhaseFunction SeparableOf(const PhaseFunction& function, const std::vector<Direction>& directions,
  const OrdinatesSettings& settings, bool nowhereNegative);

/// Checks that the solve fits the device.
/// @param facesDegree  OrdinatesScene::facesDegree; -1: no light of faces has rays of its own
/// @throws DeviceError if it does not; the message states the memory needed
void CheckMemory(
  Device& device, const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings, int facesDegree);
/// @param bytes, radiance  bytes of device memory of the whole solve, and of its largest array
void CheckMemory(Device& device, int directions, std::size_t bytes, std::size_t radiance);

/// Boundary source of a channel: environment, sky and faces; empty if there is none. `far` and `shining` must outlive
/// the result.
IncomingRadiance IncomingOf(const FarLight& far, const Illumination& shining, int channel);

/// Lamps of the scene and parallel beams that represent peaks of the environment, with the power of one channel in all
/// three components.
std::vector<Light> LampsOf(const FarLight& far, const Illumination& shining, int channel);

/// Copies the result of one channel to `light`.
void TakeChannel(LightField& light, const OrdinatesResult& found, int channel);

/// Sets in-scattered radiance, half-range flux and the name of the device in `light`, from its fluence and the
/// directions, those of `faces` if not null; `light` is in the units of the solver.
void DescribeLight(LightField& light, const Device& device, const FarLight& far, const BoundaryLight* faces);

/// Checks convergence and, except for the published scheme, the energy balance of `light` (Convergence.h). Collective.
/// @param medium  of this rank's block, in the units of the solver
/// @throws InvalidInput if the energy balance is off
void Judge(const OrdinatesSettings& settings, const Domain& domain, const Medium& medium, LightField& light);
}
