#pragma once

#include "DiscreteOrdinates/AngularScattering.h"
#include "DiscreteOrdinates/LampScattering.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include "Device/Monitor.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// Arrays of one channel on a device, and the operations that the published and the conservative scheme share:
/// uncollided light of lamps, and powers. The forward peak of the phase function is removed from sigma_s and sigma_t
/// (numerics.md, Eq. (D6)), except in the transport of uncollided light of lamps, which is exact.
class ChannelArrays
{
public:
  /// Not collective: may throw on one rank alone.
  /// @param scene, angles  must outlive this
  ChannelArrays(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles, bool netFlux);

  /// Makes AddLamps(), instead of EmitEvenly(), add the emission of empty voxels (sigma_t = 0): as uncollided light
  /// along a separate quadrature (UncollidedEmission.h). Collective.
  void TakeVacuumApart(PropagationSettings settings);
  /// Sets Emits() and Scatters() to whether voxels of any rank emit or scatter. To be called before all other methods.
  /// Collective.
  void LookAtAllRanks();

  /// Bytes of device memory that an instance needs.
  static std::size_t Bytes(const Grid& grid, bool netFlux);

  /// Adds uncollided light to fluence and powers, and its first-collision source to `source`: light of all lamps, light
  /// emitted by empty voxels, and light given by another solver. Collective.
  /// @param source  source of all directions, W / (length^3 sr). On entry the source of a voxel is its element of
  ///   `source` times Scale. On return, if light was added, the source is the element itself, and Scale is 1
  void AddLamps(
    const Buffer<float>& source, const std::array<bool, 3>& periodic, OrdinatesResult& result, const Monitor& monitor);
  /// Adds light of faces that is carried along rays (OrdinatesScene::faces), in angular moments, to the radiance of all
  /// directions. Does nothing without such light. Collective.
  void AddFaces(
    const Buffer<float>& radiance, const std::array<bool, 3>& periodic, EnergyLedger& ledger, const Monitor& monitor);
  /// Power of uncollided light that wraps around periodic axes without end, because nothing attenuates it, W.
  double Stranded() const { return this->GoingRound; }

  /// Power absorbed and power scattered by the medium at a given fluence, W.
  struct Powers
  {
    double absorbed = 0.0, scattered = 0.0;
  };
  /// Collective.
  /// @param lamps  true: `values` is fluence of uncollided light of lamps, all of whose scattering counts; false: other
  ///   fluence, whose scattering into the forward peak does not count as scattering
  Powers PowersOf(const std::vector<float>& values, bool lamps) const;
  /// Writes the isotropic emission of the voxels to `source`, W / (length^3 sr). Collective if any voxel emits.
  /// @param ledger  receives the power of all emission
  void EmitEvenly(const Buffer<float>& source, EnergyLedger& ledger) const;
  bool Emits() const { return this->AnyEmission; }
  bool Scatters() const { return this->AnyScattering; }
  /// Fraction of this rank's voxels that lie in blocks of voxels without scattering, which AngularScattering can skip.
  double PartWithoutScattering() const;
  /// Whether each block of OrdinateBlock consecutive voxels lies in the box `within` of this rank's grid and has no
  /// medium.
  std::vector<cl_uchar> EmptyBlocks(const VoxelBox& within) const;
  void Read(OrdinatesResult& result) const;

  const Medium& TheMedium;
  const std::size_t Voxels;
  const VolumeLayout Layout;
  Buffer<float> SigmaT, SigmaS; ///< sigma_t and sigma_s without the forward peak of the phase function, 1/length
  /// factor by which the sources of all directions of a voxel are to be multiplied, initially 1
  Buffer<float> Scale;
  Buffer<float> Direct; ///< uncollided fluence, W / length^2
  OrdinatesLight Light;
  /// outgoing power and reflected radiance by cell of the box faces; null: no face reflects
  const std::unique_ptr<FaceLight> Faces;

private:
  /// Fraction of the scattered power that is not scattered into the forward peak of the phase function.
  double ScatteredAway() const { return 1.0 - this->Angles.phase.Peak(); }
  Buffer<float> Load(const char* what, double absorbed, double scattered) const;
  void AddGiven(const LampScattering& scattering, const Buffer<float>& sigma_s, const Buffer<float>& source,
    OrdinatesResult& result);
  void Spread(const AngularBasis& basis, const Buffer<float>& moments, const Buffer<float>& radiance) const;
  void CountLamp(const SweepTally& tally, EnergyLedger& ledger);
  float EmissionOf(std::size_t voxel, bool emptyVoxels) const;
  SweepTally AddVacuum(UncollidedVolume volume, const LampScattering& scattering, const Buffer<float>& sigma_s,
    const LampTarget& target, const Monitor& monitor) const;

  Device& TheDevice;
  const OrdinatesScene& Scene;
  const OrdinatesAngles& Angles;
  std::vector<float> Absorption, Scattering;
  bool AnyEmission = false, AnyScattering = false;
  /// Quadrature for the emission of empty voxels; null: no empty voxel emits, or EmitEvenly() adds their emission.
  std::unique_ptr<const SweptDirections> OfVacuum;
  double GoingRound = 0.0;
};
}
