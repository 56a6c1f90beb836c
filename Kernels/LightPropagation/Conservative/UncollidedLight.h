#pragma once

#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"

#include <vector>

namespace tyndall
{
/// Extinction and scattering as the diffusion systems of a block read them: with ghosts, where sigma_s is below 0.
struct GhostedMedium
{
  GhostedMedium(TransportParts& parts, const BlockWithGhosts& block);

  GhostedBuffer sigma_t; ///< that light diffuses with
  GhostedBuffer swept;   ///< of the sweeps
  GhostedBuffer sigma_a, sigma_s;
  bool hasMoments;

  const Buffer<float>& Swept() const { return this->hasMoments ? this->swept.Values() : this->sigma_t.Values(); }
};

/// All uncollided light that a diffusion-accelerated solve finds apart from its sweeps: of lamps, of small bright
/// emission, and of what comes in through the faces the difference that finer directions make (numerics.md, sections 5
/// and 7.10). Found once, when it is made. Collective.
class UncollidedLight
{
public:
  /// @param parts  their Flux holds the light's afterwards
  /// @param block, medium  with ghosts; must stay
  UncollidedLight(
    TransportParts& parts, const BlockWithGhosts& block, const GhostedMedium& medium, const Monitor& monitor);

  const std::vector<float>& Path() const { return this->Lengths; } ///< W length, [channel][stride]
  /// W length of lamps alone, [channel][stride]; empty where there are none.
  const std::vector<float>& PathOfLamps() const { return this->LengthsOfLamps; }
  /// Whether lamps' light that passes voxels' faces at once where it is first scattered goes to the diffusion systems:
  /// voxels are thick, there are lamps, and the source is not constant.
  bool Passes() const { return this->ThroughFaces.Size() > 0; }
  /// If so, as DiffusionSystem::Arrays has them: W through faces, and W / (length^3 sr) of what is first scattered less
  /// that.
  const Buffer<float>& Passed() const { return this->PassedWithGhosts.Values(); }
  const Buffer<float>& OfLamps() const { return this->OfLampsWithGhosts.Values(); }
  /// What was emitted and came in, what of it left, and what was absorbed before it was scattered.
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
  Buffer<float> PathOfLamp, MomentsOfLamp;       ///< of one lamp, as Deposit has them
  Buffer<float> ThroughFaces, ScatteredInVoxels; ///< of all lamps
  GhostedBuffer PathWithGhosts, MomentsWithGhosts, AllPathWithGhosts, PassedWithGhosts, OfLampsWithGhosts;
  EnergyLedger Counted;
  SweepTally OfSources; ///< what is on its way goes round a periodic axis without end
};
}
