#pragma once

#include "DiscreteOrdinates/AngularScattering.h"
#include "DiscreteOrdinates/LampScattering.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Sweep/Pipelined/SweepInBlocks.h"
#include "LightPropagation/Sweep/SweepWorkspace.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "LightPropagation/Uncollided/Lamps/LampsInBlocks.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include "Device/Monitor.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// One channel of a medium on a device, its light, and the parts that both schemes share: uncollided light of lamps,
/// and powers. The forward peak of the phase function is removed from sigma_s and sigma_t (numerics.md, Eq. (D6)),
/// except for the uncollided light of lamps, which is exact.
class ChannelArrays
{
public:
  /// Asks no other rank: it may fail on one alone.
  /// @param scene, angles  must stay
  ChannelArrays(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles, bool netFlux);

  /// Moves the emission of empty voxels from EmitEvenly to AddLamps: uncollided light along rays of its own
  /// (UncollidedEmission.h). Collective.
  void TakeVacuumApart(PropagationSettings settings);
  /// Finds whether voxels of any rank emit or scatter; first. Collective, as most of the following.
  void LookAtAllRanks();

  /// Bytes that these arrays take on the device.
  static std::size_t Bytes(const Grid& grid, bool netFlux);

  /// Uncollided light of all lamps, of empty voxels and of another solver: counts it, and adds its first-collision
  /// source.
  /// @param source  of all directions, over Scale
  void AddLamps(
    const Buffer<float>& source, const std::array<bool, 3>& periodic, OrdinatesResult& result, const Monitor& monitor);
  /// W of lamps whose rays wrap around periodic axes without end.
  double Stranded() const { return this->GoingRound; }

  /// Absorbed and scattered power of a fluence, W.
  struct Powers
  {
    double absorbed = 0.0, scattered = 0.0;
  };
  /// @param lamps  whether it is uncollided light of lamps
  Powers PowersOf(const std::vector<float>& values, bool lamps) const;
  /// Scattered power of the magnitude of the difference of two fluences, W. Collective.
  double MagnitudeOf(const std::vector<float>& values, const std::vector<float>& others) const;
  /// Emission of the voxels into every direction. W / (length^3 sr). Collective, where any voxel emits.
  /// @param ledger  all emission is counted
  void EmitEvenly(const Buffer<float>& source, EnergyLedger& ledger) const;
  /// Adds the isotropic scattering source of a fluence, which may be negative.
  void ScatterEvenly(const std::vector<float>& values, double factor, const Buffer<float>& source) const;
  bool Emits() const { return this->AnyEmission; }
  bool Scatters() const { return this->AnyScattering; }
  void Read(OrdinatesResult& result) const;

  const Medium& TheMedium;
  const std::size_t Voxels;
  const VolumeLayout Layout;
  Buffer<float> SigmaT, SigmaS; ///< 1/length
  Buffer<float> Scale;          ///< of the sources of a voxel, 1 at first
  Buffer<float> Direct;         ///< W / length^2, of lamps
  OrdinatesLight Light;
  const std::unique_ptr<FaceLight> Faces; ///< null: none reflects

private:
  Buffer<float> Load(const char* what, double absorbed, double scattered) const;
  std::unique_ptr<SweepOperator> SweepOf(
    const Buffer<float>& sigma_t, const std::array<bool, 3>& periodic, const SweepRequest& request);
  void SpreadOverRanks(UncollidedVolume& volume, std::unique_ptr<LampsInBlocks>& nearLamps) const;
  void AddGiven(const LampScattering& scattering, const Buffer<float>& sigma_s, const Buffer<float>& source,
    OrdinatesResult& result);
  void CountLamp(const SweepTally& tally, EnergyLedger& ledger);
  float EmissionOf(std::size_t voxel, bool emptyVoxels) const;
  SweepTally AddVacuum(UncollidedVolume volume, const LampScattering& scattering, const Buffer<float>& sigma_s,
    const LampTarget& target, const Monitor& monitor) const;

  Device& TheDevice;
  const OrdinatesScene& Scene;
  const OrdinatesAngles& Angles;
  double ScatteredAway; ///< 1 less the forward peak
  std::vector<float> Absorption, Scattering;
  bool AnyEmission = false, AnyScattering = false;
  std::unique_ptr<const SweptDirections> OfVacuum; ///< along which empty voxels emit; null: none does, or not apart
  double GoingRound = 0.0;
  SweepWorkspace Workspace;
  BlockWorkspace BlocksWorkspace;
};
}
