#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Conservative/BlockTransport.h"
#include "LightPropagation/Conservative/FaceLight.h"
#include "LightPropagation/Conservative/LightSources.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Scattering/BeamScattering.h"
#include "LightPropagation/Scattering/ScatteringOperator.h"
#include "LightPropagation/Scattering/SweptMoments.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// Building blocks of the iterations: a rank's block of a problem on its device, the quadrature of scattered light, the
/// light sources and how rays get through the grid. Holds no state of a solve except the arrays that the iterations
/// work in. Directions and cells of the box faces are those of the whole domain; arrays over voxels are of the block.
class TransportParts
{
public:
  /// Not collective: may throw on one rank alone.
  /// @param problem  must outlive this
  /// @param usual  quadrature of scattered light
  /// @param finer  quadrature of boundary light until its first collision
  /// @throws DeviceError if the arrays do not fit
  /// @throws InvalidInput if there are too few rays (BoundaryLight.h)
  TransportParts(Device& device, const PropagationProblem& problem, IterationScheme how, DirectionSet usual,
    const UncollidedDirections& finer);
  TransportParts(const TransportParts&) = delete; // light sources refer to directions that this owns
  TransportParts& operator=(const TransportParts&) = delete;

  Device& TheDevice;
  const PropagationProblem& Problem;
  const IterationScheme How;
  const VolumeLayout Layout;
  const MediumOnDevice OnDevice;
  const std::unique_ptr<const ScatteringOperator> Scattering;

  /// Quadrature of scattered light.
  const SweptDirections Usual;
  /// Basis of the angular moments of scattering; null: scattering is isotropic, or the block has no voxels.
  const AngularBasis* Basis = nullptr;
  /// Light by cell of the box faces, if faces reflect or face power is requested; else null.
  std::unique_ptr<FaceLight> Faces;
  LightSources Lights;
  BlockTransport Transport;

  /// Arrays over voxels, [channel][stride]; Flux [channel][x, y, z][stride], empty if net flux is not requested. With
  /// angular moments, Source and Path are [function][channel][stride], and the sources of beams follow in Source.
  Buffer<float> Source, Path, Flux, Fluence;

  const Domain& TheDomain() const { return this->Problem.TheDomain(); }
  bool IsEmpty() const { return this->TheDomain().IsEmpty(); } ///< the block has no voxels
  /// Writes the emission of the medium, and the unscattered forward part of given light, to Source. Collective; call
  /// before any other method.
  void LoadSource();
  /// Whether Source is non-zero in the first sweep, or optimisations are off (settings.leaveOut).
  bool HasSource() const { return this->MediumShines; }
  /// Adds the uncollided light of one source to `deposit`. Collective, as are all methods that add or find uncollided
  /// light.
  /// @return tally of all channels, summed over ranks
  SweepTally AddUncollided(const UncollidedSource& source, const Deposit& deposit, const Monitor& monitor);
  /// Result of AddUncollided in separate arrays on the host.
  struct UncollidedPath
  {
    std::vector<float> path; ///< W length, in the layout of a deposit
    SweepTally tally;
  };
  struct UncollidedFlux : UncollidedPath
  {
    std::vector<float> flux; ///< likewise; empty: not requested
  };
  UncollidedPath FindUncollidedPath(const UncollidedSource& source, const Monitor& monitor);
  UncollidedFlux FindUncollided(const UncollidedSource& source, const Monitor& monitor);
  /// Uncollided light of a uniform sky of radiance 1, along the finer and the usual quadrature. By reciprocity this is
  /// also the power that escapes from a source of 1 in each voxel (numerics.md, Eq. (45)).
  struct EvenSky
  {
    UncollidedPath fine, usual;
  };
  EvenSky FindEvenSky(const Monitor& monitor);

  bool FacesReflect() const { return this->Faces && this->Faces->Reflects(); }
  /// Deposit::spreadsAside: true if face light is stored and no face reflects. Reflected light enters through the cells
  /// it left through, so it must not be spread.
  bool SpreadsAside() const { return this->Faces && !this->Faces->Reflects(); }
  /// Incident radiance by cell, for SweepRequest::faceIn; null: none.
  const Buffer<float>* LightByCells() const { return this->FacesReflect() ? &this->Faces->In() : nullptr; }

  /// Writes the emission that sweeps along the usual directions carry to `source`; writes nothing if there is none.
  /// @return whether any of it is non-zero
  bool LoadEmission(Buffer<float>& source) const;

  Deposit WholeDeposit() const;             ///< path, and flux if requested
  std::vector<AxisBundles> AllRays() const; ///< along the usual directions
  /// Angular moments along the usual directions, for SweepRequest::angular; null: scattering is isotropic.
  const AngularValues* UsualValues() const { return this->Angular ? &this->Angular->Values() : nullptr; }
  void DarkenBeams();                                ///< sets the sources of beams in Source to 0
  BeamsInSource BeamsOfSource();                     ///< for source iteration
  void LightBeams(const Buffer<float>& given) const; ///< copies the sources of beams from `given` to Source
  std::size_t BeamValues() const { return this->Angular ? this->Angular->Beams() * this->Layout.Values() : 0; }
  /// Whether the angular moments of scattered light are part of the result.
  bool StoresMoments() const
  {
    return this->Problem.Scattering().Degree() > 0 && this->Problem.Settings().storeMoments;
  }
  int Functions() const; ///< in the basis; 1: isotropic

private:
  bool ByBalance() const { return this->How == IterationScheme::Dsa; }
  void FindFaceLight();
  int SlotOf(const UncollidedSource& source) const;
  SweepTally SumOfVoxels(const SweepTally& own) const;

  bool MediumShines = false;
  std::unique_ptr<const SweptMoments> Angular; ///< null: isotropic, or the block has no voxels
};

/// Makes the parts of a problem, with quadratures chosen for it. Collective.
std::unique_ptr<TransportParts> MakeParts(Device& device, const PropagationProblem& problem, IterationScheme how);
}
