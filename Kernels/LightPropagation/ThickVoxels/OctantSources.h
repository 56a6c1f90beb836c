#pragma once

#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Problem/MediumOnDevice.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Sweep/BeyondFaces.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "LightPropagation/ThickVoxels/OctantSourcesShared.h"

#include <array>
#include <map>

namespace tyndall
{
/// Light of thick voxels, one order after the other: it is scattered near the faces that it came in through, and shines
/// back through these more than through those beyond. Sweeps take what a voxel scatters as even in it, but for what
/// shines out of it into each octant of directions; what does not get out stays, so that power is kept. That is found
/// of the light that came in through both faces across each axis, by the exact response of a layer as thick as the
/// voxel (numerics.md, section 6.5).
class OctantSources
{
public:
  /// Whether any voxel is so thick that it matters. Collective.
  static bool AreThick(const PropagationProblem& problem);
  /// Whether the source is to be by octant, some voxels are thick, none is opaque, and scattering is isotropic. Of an
  /// automatic source: where a quarter of the voxels that scatter are thick or more, and the orders are as many as the
  /// tolerance asks for. Whatever shines: lights add up. What of exact rays of bright emission or of given light is
  /// first scattered shines evenly out of a voxel, and all later orders by octant. Collective.
  static bool Matter(const PropagationProblem& problem);

  /// Voxels on a device, of a whole medium or of a rank's block of it; all must stay.
  struct Scene
  {
    Device& device;
    const PropagationSettings& settings;
    const VolumeLayout& layout;
    const MediumOnDevice& medium;
    const Grid& whole;
    VoxelBox block; ///< of the whole
    bool lamps;     ///< there are some
  };
  explicit OctantSources(const Scene& scene);

  /// For Deposit::partialCurrents of every sweep.
  const Buffer<float>& Currents() const { return this->OfSweep; }
  /// For SweepRequest::octantSource.
  const Buffer<float>& Sources() const { return this->Found; }

  /// Takes over what came in through voxels' faces along some directions, which must stay.
  void TakeIncoming(const SweptDirections& along);
  /// The arrays that one lamp adds to, and takes over what it did: first scattered light near the faces.
  const Buffer<float>& LampPath() const { return this->PathOfLamp; }
  const Buffer<float>& LampMoments() const { return this->MomentsOfLamp; }
  void TakeLamp(const Buffer<float>& allPath);
  /// Of what was taken, W / (length^2 sr), [channel][face][stride]: what Find() looks at across a block's faces.
  const Buffer<float>& CameInThroughFaces() const { return this->Incoming; }
  /// The sources of what is scattered of all light that was taken since the last time.
  /// @param source  W / (length^3 sr), of the sweep that the last of it came in with
  /// @param beyond  of CameInThroughFaces(), of a block
  void Find(const Buffer<float>& source, const BeyondFaces& beyond = {});

private:
  /// Of rays along some directions (CrossingPattern.h).
  struct Crossings
  {
    Buffer<float> values;
    std::array<int, 6> first;
    double perRadiance;
  };
  const Crossings& CrossingsOf(const SweptDirections& along);
  OctantSourceInfo InfoOf(int channel) const;

  bool IsEmpty() const { return this->The.layout.grid.VoxelCount() == 0; } ///< of a block without voxels

  Scene The;
  Buffer<float> OfSweep, Incoming;                  ///< [channel][face][stride]
  Buffer<float> Found;                              ///< [channel][octant][stride]
  Buffer<float> PathOfLamp, MomentsOfLamp, OfLamps; ///< as Deposit has them; [channel][face][stride]
  Buffer<float> Diffuse, Falling;                   ///< VoxelResponse
  std::map<const SweptDirections*, Crossings> Patterns;
  bool CameIn = false;     ///< light was taken since the last time
  bool LampsShine = false; ///< in what is found next
};
}
