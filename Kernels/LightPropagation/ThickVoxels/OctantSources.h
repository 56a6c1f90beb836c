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
/// Sources by octant of optically thick voxels, for each scattering order. Light that enters such a voxel is scattered
/// near the faces through which it enters, and returns through these faces more than through the opposite ones. Sweeps
/// treat the scattering source as uniform in a voxel, except for an additional source in each octant of directions;
/// light that does not leave the voxel remains in it, so that power is conserved. The sources by octant follow from the
/// light that entered through both faces across each axis, by the exact response of a layer as thick as the voxel
/// (numerics.md, section 6.5).
class OctantSources
{
public:
  /// Whether any voxel is so optically thick that sources by octant change the result. Collective.
  static bool AreThick(const PropagationProblem& problem);
  /// Whether to use sources by octant. They are used if the settings request them, any voxel is thick, none is opaque,
  /// and scattering is isotropic. If the settings leave the choice open, at least a quarter of the scattering voxels
  /// must also be thick, and the tolerance must determine the number of orders. Independent of the light sources, so
  /// that the light of several sources adds up. First-scattered light of localised emission is uniform in a voxel;
  /// later orders have sources by octant. Collective.
  static bool Matter(const PropagationProblem& problem);

  /// The voxels of a rank's subdomain (or of a serial domain) on a device. All references must outlive the
  /// OctantSources.
  struct Scene
  {
    Device& device;
    const PropagationSettings& settings;
    const VolumeLayout& layout;
    const MediumOnDevice& medium;
    const Grid& whole;
    VoxelBox block; ///< the subdomain's voxels, in indices of the domain
    bool lamps;     ///< whether there are lamps or light given by another solver
  };
  explicit OctantSources(const Scene& scene);

  /// Power that enters through voxels' faces, W, [channel][face][voxel]; pass as Deposit::partialCurrents to every
  /// sweep.
  const Buffer<float>& Currents() const { return this->OfSweep; }
  /// Source of each octant as found by Find(), W / (length^3 sr), [channel][octant][voxel]; pass as
  /// SweepRequest::octantSource.
  const Buffer<float>& Sources() const { return this->Found; }

  /// Adds the light in Currents() to the incident light, and sets Currents() to 0.
  /// @param along  directions of the sweep that filled Currents(); must outlive this object
  void TakeIncoming(const SweptDirections& along);
  /// Path integrals, W length, to which one lamp adds its deposit before TakeLamp().
  const Buffer<float>& LampPath() const { return this->PathOfLamp; }
  /// First moments, as Deposit::firstMoments, to which one lamp adds its deposit before TakeLamp().
  const Buffer<float>& LampMoments() const { return this->MomentsOfLamp; }
  /// Records the sources by face (e of numerics.md, Eq. (46e)) of the light that is first scattered from one lamp, adds
  /// LampPath() to `allPath`, and sets LampPath() and LampMoments() to 0.
  void TakeLamp(const Buffer<float>& allPath);
  /// Mean incident radiance at voxels' faces, W / (length^2 sr), [channel][face][voxel], summed over the calls of
  /// TakeIncoming() since the last Find(). Find() needs these values for the ghost cells around a subdomain, too.
  const Buffer<float>& CameInThroughFaces() const { return this->Incoming; }
  /// Computes Sources() for the light scattered from all light of TakeIncoming() and TakeLamp() since the last call.
  /// @param source  uniform source of the last sweep whose light was taken, W / (length^3 sr)
  /// @param beyond  CameInThroughFaces() of the voxels across a subdomain's faces
  void Find(const Buffer<float>& source, const BeyondFaces& beyond = {});

private:
  /// For each voxel face, the power that rays of a set of directions carry through it at uniform radiance, divided by
  /// the mean over faces (SweepModel.h).
  struct Crossings
  {
    Buffer<float> values;
    std::array<int, 6> first;
    double perRadiance;
  };
  const Crossings& CrossingsOf(const SweptDirections& along);
  OctantSourceInfo InfoOf(int channel) const;

  /// Whether this rank's subdomain has no voxels.
  bool IsEmpty() const { return this->The.layout.grid.VoxelCount() == 0; }

  Scene The;
  Buffer<float> OfSweep, Incoming; ///< see Currents(), CameInThroughFaces()
  Buffer<float> Found;             ///< see Sources()
  /// See LampPath(), LampMoments(); OfLamps: for each face of a voxel, the source of lamps' light after its first
  /// scattering, [channel][face][voxel].
  Buffer<float> PathOfLamp, MomentsOfLamp, OfLamps;
  Buffer<float> Diffuse, Falling; ///< tables of VoxelResponse
  std::map<const SweptDirections*, Crossings> Patterns;
  bool CameIn = false;     ///< whether TakeIncoming() was called since the last Find()
  bool LampsShine = false; ///< whether the next Find() includes light first scattered from lamps
};
}
