#pragma once

#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"

#include <vector>

namespace tyndall
{
/// Extinction and scattering as the diffusion systems of a block read them, with ghost cells. Ghost cells carry sigma_s
/// < 0.
struct GhostedMedium
{
  GhostedMedium(TransportParts& parts, const BlockWithGhosts& block);

  GhostedBuffer sigma_t; ///< extinction of the diffusion systems
  GhostedBuffer swept;   ///< extinction of the sweeps
  GhostedBuffer sigma_a, sigma_s;
  bool hasMoments;

  const Buffer<float>& Swept() const { return this->hasMoments ? this->swept.Values() : this->sigma_t.Values(); }
};

/// Uncollided light that a DSA solve computes apart from its sweeps: of lamps, of localised emission, and the
/// difference between the finer and the usual quadrature for boundary light (numerics.md, sections 5 and 7.10).
/// Computed once, in the constructor. Collective.
class UncollidedLight
{
public:
  /// @param parts  parts.Flux then holds the flux of this light
  /// @param block, medium  with ghost cells; must outlive this
  UncollidedLight(
    TransportParts& parts, const BlockWithGhosts& block, const GhostedMedium& medium, const Monitor& monitor);

  const std::vector<float>& Path() const { return this->Lengths; } ///< W length, [channel][stride]
  /// Path integrals of lamps alone, W length, [channel][stride]; empty if there are no lamps.
  const std::vector<float>& PathOfLamps() const { return this->LengthsOfLamps; }
  /// Whether first-collided light of lamps that leaves its voxel straight away is given to the diffusion systems as
  /// power through voxel faces. True if voxels are optically thick, there are lamps, and the source is linear.
  bool Passes() const { return this->ThroughFaces.Size() > 0; }
  /// If Passes(), in the layout of DiffusionSystem::Arrays: that power through faces, W, and the rest of the
  /// first-collision source, W / (length^3 sr).
  const Buffer<float>& Passed() const { return this->PassedWithGhosts.Values(); }
  const Buffer<float>& OfLamps() const { return this->OfLampsWithGhosts.Values(); }
  /// Emitted and incident power, the part of it that escaped, and the part that was absorbed at its first collision.
  const EnergyLedger& Ledger() const { return this->Counted; }

private:
  bool NeedsFirstMoments() const;
  void AddSources(const Monitor& monitor);
  void MakePassing();
  SweepTally AddLampThroughFaces(const UncollidedSource& lamp, const Monitor& monitor);
  void PassFaces();
  void FindScatteredInVoxels();
  void AddBoundaryDifference(const Monitor& monitor);
  double PartOfDifference(std::size_t voxel, int channel) const;
  void CountAbsorbed();

  TransportParts& Parts;
  const Domain& TheDomain;
  const Medium& TheMedium;
  bool LinearSource;
  std::vector<float> Lengths, LengthsOfLamps;
  const BlockWithGhosts& Block;
  const GhostedMedium& Coefficients;
  Buffer<float> PathOfLamp, MomentsOfLamp;       ///< of one lamp, in the layout of Deposit
  Buffer<float> ThroughFaces, ScatteredInVoxels; ///< of all lamps
  GhostedBuffer PathWithGhosts, MomentsWithGhosts, AllPathWithGhosts, PassedWithGhosts, OfLampsWithGhosts;
  EnergyLedger Counted;
  SweepTally OfSources; ///< its onTheWay wraps around periodic axes without end
};
}
