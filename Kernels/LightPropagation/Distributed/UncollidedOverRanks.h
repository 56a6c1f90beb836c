#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Distributed/BlockOnDevice.h"
#include "LightPropagation/Distributed/IncidentLight.h"
#include "LightPropagation/Distributed/LampsInBlocks.h"
#include "LightPropagation/Emission/UncollidedEmission.h"
#include "LightPropagation/ThickVoxels/OctantSources.h"
#include "LightPropagation/Uncollided/GivenLight.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// What shines in a medium that is spread over ranks before any of it is scattered (numerics.md, section 5): of lamps,
/// of faces and sky along directions of their own, what another solver found, and what the medium emits, which waits in
/// the block's source for the first sweep. Knows nothing of scattering orders.
class UncollidedOverRanks
{
public:
  /// @param block, incident  must stay
  /// @throws DeviceError if the array for a lamp's light does not fit
  UncollidedOverRanks(BlockOnDevice& block, const IncidentLight& incident);

  /// Writes what the medium emits, and what of given light goes straight on, to the block's source. All ranks call it.
  /// @param ledger  emission is counted there
  /// @return whether any of it shines, on any rank
  bool LoadSource(EnergyLedger& ledger);
  /// What of given light goes straight on, added to a source of this rank.
  /// @return whether anything does
  bool AddStraightOn(const Buffer<float>& source) const;

  /// Adds uncollided light to the block's arrays: of lamps, then of the boundary and of emitting empty voxels, each
  /// along its own directions, then what is given. First scattering of parallel beams goes to the source. Collective.
  /// @param shown  what light of lamps is first scattered is added to it; null: not wanted
  /// @param atFaces  of thick voxels, which take what it does at their faces; null, on all ranks: not wanted
  /// @return of all ranks
  SweepTally AddAll(const Buffer<float>* shown, OctantSources* atFaces, const Monitor& monitor);
  std::size_t Count() const; ///< of lamps and sets of directions, for a share of a monitor

  /// The light of one lamp alone; what a parallel beam is first scattered, to the block's source. All ranks call it.
  /// @param deposit  with first moments, where they are wanted
  /// @return of all ranks
  SweepTally AddLamp(std::size_t lamp, const Deposit& deposit, const Monitor& monitor);
  /// What is given of another solver. All ranks call it.
  SweepTally AddGiven(const Monitor& monitor);
  /// What empty voxels emit, where it goes along directions of its own. All ranks call it.
  SweepTally AddVacuum(OctantSources* atFaces, const Monitor& monitor);
  /// What the medium emits and the sweeps carry, written to a source of this rank, the first moment.
  void WriteEmission(Buffer<float>& source) const;

  /// W length, [channel][stride], of a sky of radiance 1, as TransportParts::EvenSky.
  struct EvenSky
  {
    std::vector<float> fine, usual;
  };
  /// Where there are finer directions. All ranks call it.
  EvenSky FindEvenSky(const Monitor& monitor);

private:
  void FindVacuum();
  std::vector<float> EmissionOf(bool emptyVoxels) const;
  Rgb LoadEmission();
  SweepTally OnAllRanks(const std::function<SweepTally()>& add);
  SweepTally AddLampAt(std::size_t lamp, OctantSources* atFaces, const Monitor& monitor);
  SweepTally AddBoundary(const BoundaryLight& light, const Deposit& deposit, const Monitor& monitor);
  SweepTally FollowLamp(std::size_t lamp, const Deposit& deposit, const Monitor& monitor);
  UncollidedVolume VolumeOf(const Deposit& deposit);

  BlockOnDevice& Block;
  const IncidentLight& Incident;
  std::unique_ptr<const GivenLight> Given; ///< null: none is, or there are no voxels
  /// As TransportParts has it, where any rank's empty voxels emit.
  std::unique_ptr<const SweptDirections> OfVacuum;
  std::unique_ptr<LampsInBlocks> NearLamps; ///< null until there is one
  Buffer<float> OfLamp;                     ///< path integrals of one lamp's light, where it goes into angular moments
};
}
