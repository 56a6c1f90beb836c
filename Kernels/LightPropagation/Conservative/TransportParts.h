#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Conservative/BlockTransport.h"
#include "LightPropagation/Conservative/FaceLight.h"
#include "LightPropagation/Conservative/LightSources.h"
#include "LightPropagation/Diffusion/SweepModel.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Scattering/BeamScattering.h"
#include "LightPropagation/Scattering/ScatteringOperator.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// Transport of scattered light in accelerated solves, and of the boundary light that is swept with it: by the rays of
/// light propagation maps unless another solver sets its own (DiscreteOrdinates/OrdinatesTransport.h).
struct ScatteredTransport
{
  SweepMaker make;                   ///< makes sweeps; collective
  std::function<SweepModel()> model; ///< properties of these sweeps that the diffusion system uses
};

/// Objects and arrays that all iterations share: this rank's block of the medium on its device, the quadrature of
/// scattered light, the light sources, the sweeps, and arrays of source, path integrals and fluence. Directions and
/// cells of the box faces are those of the whole domain; arrays over voxels are those of the block.
class TransportParts
{
public:
  /// Not collective: may throw on one rank alone.
  /// @param problem  must outlive this object
  /// @param usual  quadrature of scattered light
  /// @param finer  quadrature of boundary light until its first collision
  /// @throws DeviceError if the arrays do not fit
  /// @throws InvalidInput if too few rays would meet the faces (BoundaryLight.h)
  TransportParts(Device& device, const PropagationProblem& problem, IterationScheme how, DirectionSet usual,
    const UncollidedDirections& finer);
  TransportParts(const TransportParts&) = delete; // light sources refer to directions that this object owns
  TransportParts& operator=(const TransportParts&) = delete;

  Device& TheDevice;
  const PropagationProblem& Problem;
  const IterationScheme How;
  const bool ByOctant; ///< whether voxels have sources by octant (OctantSources)
  const VolumeLayout Layout;
  const MediumOnDevice OnDevice;
  const std::unique_ptr<const ScatteringOperator> Scattering;

  /// Rays of the quadrature of scattered light.
  const SweptDirections Usual;
  /// Basis of the angular moments of scattering; null: scattering is isotropic, or the block has no voxels.
  const AngularBasis* Basis = nullptr;
  /// Outgoing and reflected light by cell of the box faces; null unless faces reflect or face power is requested.
  std::unique_ptr<FaceLight> Faces;
  LightSources Lights;
  BlockTransport Transport;
  ScatteredTransport Scattered;

  /// Arrays over voxels, [channel][voxel]: source of the next sweep, W / (length^3 sr); path integrals, W length; net
  /// flux times the voxel's volume, [channel][x, y, z][voxel], empty if not requested; fluence, W / length^2. With
  /// angular moments, Source and Path are [function][channel][voxel], and Source ends with the sources of beams.
  Buffer<float> Source, Path, Flux, Fluence;

  const Domain& TheDomain() const { return this->Problem.TheDomain(); }
  bool IsEmpty() const { return this->TheDomain().IsEmpty(); } ///< whether the block has no voxels
  /// Sets Source to the emission of the medium plus, for light given by another solver, the light scattered into the
  /// forward peak, which delta-M treats as unscattered. Collective; call before any other method.
  void LoadSource();
  /// Whether the first sweep has a non-zero source on any rank; always true if settings.leaveOut is off.
  bool HasSource() const { return this->MediumShines; }
  /// Adds the uncollided light of a source to `deposit`, and the first scattering of a beam to Source. Collective, as
  /// are FindUncollidedPath(), FindUncollided() and FindEvenSky().
  /// @return incident and escaped power of all channels, summed over ranks
  SweepTally AddUncollided(const UncollidedSource& source, const Deposit& deposit, const Monitor& monitor);
  /// Uncollided light of one source in arrays of the host, as AddUncollided() deposits it.
  struct UncollidedPath
  {
    /// Path integrals, W length, [channel][voxel]; with angular moments [function][channel][voxel].
    std::vector<float> path;
    SweepTally tally;
  };
  struct UncollidedFlux : UncollidedPath
  {
    std::vector<float> flux; ///< net flux, W length, [channel][x, y, z][voxel]; empty: not requested
  };
  UncollidedPath FindUncollidedPath(const UncollidedSource& source, const Monitor& monitor);
  UncollidedFlux FindUncollided(const UncollidedSource& source, const Monitor& monitor);
  /// Uncollided light of a uniform sky of radiance 1 along the finer quadrature, and along that of scattered light. By
  /// reciprocity its path integral is also the power that escapes uncollided from a source of 1 in a voxel
  /// (numerics.md, Eq. (45)).
  struct EvenSky
  {
    UncollidedPath fine, usual;
  };
  EvenSky FindEvenSky(const Monitor& monitor);

  bool FacesReflect() const { return this->Faces && this->Faces->Reflects(); }
  /// Value of Deposit::spreadsAside: true if light is stored by face cell and no face reflects. Reflected light is
  /// incident through the cell through which it left, so its power must not be spread over cells.
  bool SpreadsAside() const { return this->Faces && !this->Faces->Reflects(); }
  /// Reflected radiance by cell of the box faces, for SweepRequest::faceIn; null: no face reflects.
  const Buffer<float>* LightByCells() const { return this->FacesReflect() ? &this->Faces->In() : nullptr; }

  /// Writes to `source` the emission that sweeps along the quadrature of scattered light carry; writes nothing if the
  /// medium does not emit.
  /// @return whether this emission is non-zero in any voxel
  bool LoadEmission(Buffer<float>& source) const;

  /// Arrays to which sweeps add light: Path, Flux if requested, and the outgoing power of Faces.
  Deposit WholeDeposit() const;
  std::vector<AxisBundles> AllRays() const; ///< all rays of the quadrature of scattered light
  /// Values of the angular functions along the directions of the sweeps, for SweepRequest::angular; null: scattering is
  /// isotropic.
  const AngularValues* UsualValues() const { return this->Angular ? &this->Angular->Values() : nullptr; }
  void DarkenBeams(); ///< sets the first-collision sources of beams (SweptMoments) in Source to 0
  /// Object that moves the beams' first-collision sources out of Source for the sweep in which beams are traced, and
  /// back for the next one (BeamScattering.h).
  BeamsInSource BeamsOfSource();
  /// copies the first-collision sources of beams from `given` to Source
  void LightBeams(const Buffer<float>& given) const;
  std::size_t BeamValues() const { return this->Angular ? this->Angular->Beams() * this->Layout.Values() : 0; }
  /// Whether the angular moments of scattered light are part of the result.
  bool StoresMoments() const
  {
    return this->Problem.Scattering().Degree() > 0 && this->Problem.Settings().storeMoments;
  }
  int Functions() const; ///< number of angular functions, (degree + 1)^2; 1: isotropic

private:
  bool ByBalance() const { return this->How == IterationScheme::Dsa; }
  void FindFaceLight();
  int SlotOf(const UncollidedSource& source) const;
  SweepTally SumOfVoxels(const SweepTally& own) const;

  bool MediumShines = false;
  /// Angular functions in the directions of sweeps; null: isotropic, or the block has no voxels.
  std::unique_ptr<const SweptMoments> Angular;
};

/// Makes the TransportParts of a problem, with quadratures chosen for it. Collective.
std::unique_ptr<TransportParts> MakeParts(Device& device, const PropagationProblem& problem, IterationScheme how);
}
