#pragma once

#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/Pipelined/AcrossFaces.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "LightPropagation/ThickVoxels/OctantSourcesShared.h"

#include <array>
#include <map>

namespace tyndall
{
/// Scattered light of optically thick voxels, order by order. Such light is scattered near the faces through which it
/// enters, and returns through these more than through the opposite ones. Sweeps treat the scattering source as uniform
/// in a voxel, except for the emission into each octant of directions; light that does not get out stays in the voxel,
/// so that power is conserved. The sources by octant follow from the light that entered through both faces across each
/// axis, by the exact response of a layer as thick as the voxel (numerics.md, section 6.5).
class OctantSources
{
public:
  /// Whether any voxel is so thick that sources by octant make a difference. Collective.
  static bool AreThick(const PropagationProblem& problem);
  /// Whether to use sources by octant: if the settings ask for them, some voxels are thick, none is opaque, and
  /// scattering is isotropic. If the settings leave the choice open: if also at least a quarter of the scattering
  /// voxels are thick, and the number of orders follows from the tolerance. Independent of the light sources, since
  /// light is additive. First-scattered light of localised emission and of given light is uniform in a voxel; later
  /// orders are by octant. Collective.
  static bool Matter(const PropagationProblem& problem);

  /// The voxels of a serial domain, or of a rank's block, on a device; all members must outlive the OctantSources.
  struct Scene
  {
    Device& device;
    const PropagationSettings& settings;
    const VolumeLayout& layout;
    const MediumOnDevice& medium;
    const Grid& whole;
    VoxelBox block; ///< in the whole grid
    bool lamps;     ///< whether there are lamps
  };
  explicit OctantSources(const Scene& scene);

  /// For Deposit::partialCurrents of every sweep.
  const Buffer<float>& Currents() const { return this->OfSweep; }
  /// For SweepRequest::octantSource.
  const Buffer<float>& Sources() const { return this->Found; }

  /// Takes over the light that entered through voxels' faces along some directions, which must outlive this object, and
  /// clears Currents().
  void TakeIncoming(const SweptDirections& along);
  /// The arrays to which one lamp adds its deposit; TakeLamp() takes over its first-scattered light near the faces and
  /// adds its path to `allPath`.
  const Buffer<float>& LampPath() const { return this->PathOfLamp; }
  const Buffer<float>& LampMoments() const { return this->MomentsOfLamp; }
  void TakeLamp(const Buffer<float>& allPath);
  /// Incident radiance of the light taken over, W / (length^2 sr), [channel][face][stride]; Find() needs it across a
  /// block's faces.
  const Buffer<float>& CameInThroughFaces() const { return this->Incoming; }
  /// Computes the sources of the light scattered from all light taken over since the last call.
  /// @param source  of the sweep in which the last of that light entered, W / (length^3 sr)
  /// @param beyond  CameInThroughFaces() beyond a block's faces
  void Find(const Buffer<float>& source, const BeyondFaces& beyond = {});

private:
  /// Crossing pattern of the rays along some directions (CrossingPattern.h).
  struct Crossings
  {
    Buffer<float> values;
    std::array<int, 6> first;
    double perRadiance;
  };
  const Crossings& CrossingsOf(const SweptDirections& along);
  OctantSourceInfo InfoOf(int channel) const;

  bool IsEmpty() const { return this->The.layout.grid.VoxelCount() == 0; } ///< for a block without voxels

  Scene The;
  Buffer<float> OfSweep, Incoming;                  ///< [channel][face][stride]
  Buffer<float> Found;                              ///< [channel][octant][stride]
  Buffer<float> PathOfLamp, MomentsOfLamp, OfLamps; ///< as in Deposit; OfLamps: [channel][face][stride]
  Buffer<float> Diffuse, Falling;                   ///< VoxelResponse
  std::map<const SweptDirections*, Crossings> Patterns;
  bool CameIn = false;     ///< whether light was taken over since the last Find()
  bool LampsShine = false; ///< whether the next Find() includes lamps
};
}
