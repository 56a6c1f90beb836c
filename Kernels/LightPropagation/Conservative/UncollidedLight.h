#pragma once

#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"

#include <vector>

namespace tyndall
{
/// Coefficients of the medium with ghost cells, 1/length, as the diffusion systems of a block read them. Ghost cells
/// have sigma_s < 0, which excludes them from sums.
struct GhostedMedium
{
  GhostedMedium(TransportParts& parts, const BlockWithGhosts& block);

  GhostedBuffer sigma_t; ///< transport extinction, sigma_a + sigma_s (1 - g)
  GhostedBuffer swept;   ///< extinction of the sweeps; set only if there are angular moments
  GhostedBuffer sigma_a, sigma_s;
  bool hasMoments;

  const Buffer<float>& Swept() const { return this->hasMoments ? this->swept.Values() : this->sigma_t.Values(); }
};

/// Uncollided light of a DSA solve that its sweeps do not carry: light of lamps, light of localised emission, and the
/// change of boundary light by a finer quadrature than that of scattered light (numerics.md, sections 5 and 7.10).
/// Computed once, in the constructor. Collective.
class UncollidedLight
{
public:
  /// @param parts  must outlive this object; the constructor adds the net flux of this light to parts.Flux
  /// @param block, medium  block and coefficients with ghost cells; must outlive this object
  UncollidedLight(
    TransportParts& parts, const BlockWithGhosts& block, const GhostedMedium& medium, const Monitor& monitor);

  /// Path integrals of all uncollided light of this object, W length, [channel][voxel].
  const std::vector<float>& Path() const { return this->Lengths; }
  /// Path integrals of the light of lamps alone, W length, [channel][voxel]; empty if there are no lamps.
  const std::vector<float>& PathOfLamps() const { return this->LengthsOfLamps; }
  /// Whether the first-scattered light of lamps that leaves its voxel without another collision enters the diffusion
  /// systems as power through voxel faces (LampPassing). True if voxels are optically thick, there are lamps or light
  /// given by another solver, and the source is linear.
  bool Passes() const { return this->ThroughFaces.Size() > 0; }
  /// If Passes(): power of first-scattered lamp light through voxel faces, W, and the remaining first-collision source
  /// of lamps, W / (length^3 sr); DiffusionSystem::Arrays::passed and ofLamps.
  const Buffer<float>& Passed() const { return this->PassedWithGhosts.Values(); }
  const Buffer<float>& OfLamps() const { return this->OfLampsWithGhosts.Values(); }
  /// Energy balance of the light of this object: emitted, incident, escaped uncollided, and absorbed at its first
  /// collision.
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
  /// path integrals and first moments of collisions of one lamp's light, W length
  Buffer<float> PathOfLamp, MomentsOfLamp;
  /// Sums over all lamps, without ghost cells: power of first-scattered light through voxel faces, W, and the
  /// first-collision source without this light, W / (length^3 sr).
  Buffer<float> ThroughFaces, ScatteredInVoxels;
  GhostedBuffer PathWithGhosts, MomentsWithGhosts, AllPathWithGhosts, PassedWithGhosts, OfLampsWithGhosts;
  EnergyLedger Counted;
  /// Incident and escaped power of lamps, localised emission and light given by another solver; onTheWay is light that
  /// wraps around periodic axes without end.
  SweepTally OfSources;
};
}
