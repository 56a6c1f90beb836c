#pragma once

#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/TransportParts.h"

#include <vector>

namespace tyndall
{
/// All uncollided light that a diffusion-accelerated solve finds apart from its sweeps: of lamps, of small bright
/// emission, and of what comes in through the faces the difference that finer directions make (numerics.md, sections 5
/// and 7.10). Found once, when it is made.
class UncollidedLight
{
public:
  /// @param parts  their Flux holds the light's afterwards
  UncollidedLight(TransportParts& parts, const Monitor& monitor);

  const std::vector<float>& Path() const { return this->Lengths; } ///< W length, [channel][stride]
  /// W length of lamps alone, [channel][stride]; empty where there are none.
  const std::vector<float>& PathOfLamps() const { return this->LengthsOfLamps; }
  /// W, of lamps, as DiffusionSystem::Arrays has it; empty where voxels are thin, there are no lamps, or the source is
  /// constant.
  const Buffer<float>& Passed() const { return this->ThroughFaces; }
  /// W / (length^3 sr), the same: what lamps' light is first scattered, less what passes faces at once.
  Buffer<float> ScatteredInVoxels() const;
  /// What was emitted and came in, what of it left, and what was absorbed before it was scattered.
  const EnergyLedger& Ledger() const { return this->Counted; }

private:
  bool NeedsFirstMoments() const;
  void AddSources(const Monitor& monitor);
  void PassFaces(const Buffer<float>& path, const Buffer<float>& firstMoments);
  void AddBoundaryDifference(const Monitor& monitor);
  double PartOfDifference(std::size_t voxel, int channel) const;
  void CountAbsorbed();

  TransportParts& Parts;
  const Medium& TheMedium;
  bool LinearSource;
  std::vector<float> Lengths, LengthsOfLamps;
  Buffer<float> ThroughFaces;
  EnergyLedger Counted;
  SweepTally OfSources; ///< what is on its way goes round a periodic axis without end
};
}
