#pragma once

#include "DiscreteOrdinates/AngularScattering.h"
#include "DiscreteOrdinates/LampScattering.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Sweep/Pipelined/SweepInBlocks.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
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
  /// Not collective: may throw on one rank alone.
  /// @param scene, angles  must outlive this
  ChannelArrays(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles, bool netFlux);

  /// Moves the emission of empty voxels from EmitEvenly to AddLamps: uncollided light along rays of its own
  /// (UncollidedEmission.h). Collective.
  void TakeVacuumApart(PropagationSettings settings);
  /// Finds whether voxels of any rank emit or scatter; call first. Collective, as are most of the following methods.
  void LookAtAllRanks();

  /// Bytes of device memory that these arrays need.
  static std::size_t Bytes(const Grid& grid, bool netFlux);

  /// Adds uncollided light of all lamps, of empty voxels and of another solver to fluence and powers, and adds its
  /// first-collision source.
  /// @param source  of all directions, relative to Scale
  void AddLamps(
    const Buffer<float>& source, const std::array<bool, 3>& periodic, OrdinatesResult& result, const Monitor& monitor);
  /// Power of lamps whose rays wrap around periodic axes without end, W.
  double Stranded() const { return this->GoingRound; }

  /// Power that the medium absorbs and scatters of a fluence, W.
  struct Powers
  {
    double absorbed = 0.0, scattered = 0.0;
  };
  /// @param lamps  the fluence is uncollided light of lamps
  Powers PowersOf(const std::vector<float>& values, bool lamps) const;
  /// Scattered power of the absolute difference of two fluences, W. Collective.
  double MagnitudeOf(const std::vector<float>& values, const std::vector<float>& others) const;
  /// Writes the isotropic emission of the voxels, W / (length^3 sr). Collective if any voxel emits.
  /// @param ledger  receives all emission
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
  Buffer<float> Scale;          ///< factor of the sources of each voxel, initially 1
  Buffer<float> Direct;         ///< W / length^2, uncollided
  OrdinatesLight Light;
  const std::unique_ptr<FaceLight> Faces; ///< null: no face reflects

private:
  double ScatteredAway() const
  {
    return 1.0 - this->Angles.phase.Peak();
  } ///< scattered fraction without the forward peak
  Buffer<float> Load(const char* what, double absorbed, double scattered) const;
  std::unique_ptr<SweepOperator> SweepOf(
    const Buffer<float>& sigma_t, const std::array<bool, 3>& periodic, const SweepRequest& request);
  void AddGiven(const LampScattering& scattering, const Buffer<float>& sigma_s, const Buffer<float>& source,
    OrdinatesResult& result);
  void CountLamp(const SweepTally& tally, EnergyLedger& ledger);
  float EmissionOf(std::size_t voxel, bool emptyVoxels) const;
  SweepTally AddVacuum(UncollidedVolume volume, const LampScattering& scattering, const Buffer<float>& sigma_s,
    const LampTarget& target, const Monitor& monitor) const;

  Device& TheDevice;
  const OrdinatesScene& Scene;
  const OrdinatesAngles& Angles;
  std::vector<float> Absorption, Scattering;
  bool AnyEmission = false, AnyScattering = false;
  std::unique_ptr<const SweptDirections> OfVacuum; ///< quadrature of emission of empty voxels; null: none, or swept
  double GoingRound = 0.0;
  SweepWorkspace Workspace;
  BlockWorkspace BlocksWorkspace;
};
}
