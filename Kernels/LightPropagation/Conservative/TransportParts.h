#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/FaceLight.h"
#include "LightPropagation/Emission/EmissionPeaks.h"
#include "LightPropagation/Problem/MediumOnDevice.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "LightPropagation/Problem/UncollidedDirections.h"
#include "LightPropagation/Scattering/BeamsInSource.h"
#include "LightPropagation/Scattering/ScatteringOperator.h"
#include "LightPropagation/Scattering/SweptMoments.h"
#include "LightPropagation/Sweep/Pipelined/AcrossFaces.h"
#include "LightPropagation/Sweep/Pipelined/SweepInBlocks.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepWorkspace.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "LightPropagation/Uncollided/GivenLight.h"
#include "LightPropagation/Uncollided/Lamps/LampsInBlocks.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include <memory>
#include <optional>
#include <vector>

namespace tyndall
{
/// Building blocks of the iterations: a rank's block of a problem on its device, the quadratures of the solve and the
/// light sources. Holds no state of a solve except the arrays that the iterations work in. Directions, boundary sources
/// and cells of the box faces are those of the whole domain; arrays over voxels are of the block.
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
  const UncollidedDirections Finer;            ///< quadrature of boundary light until its first collision
  std::unique_ptr<const SweptDirections> Fine; ///< sweeps along Finer; null: along Usual
  /// Boundary sources. FineBoundary: those along the finer quadrature; null if there are none. UsualBoundary: those
  /// that sweeps carry along the usual quadrature, which are all others; with DSA, all boundary light.
  std::unique_ptr<const BoundaryLight> UsualBoundary, FineBoundary;
  /// Light by cell of the box faces, if faces reflect or face power is requested; else null.
  std::unique_ptr<FaceLight> Faces;
  std::vector<Light> Lamps; ///< lamps of the scene, and peaks of the environment
  Environment FarAway;      ///< the environment without its peaks
  SplitEmission Emission;   ///< of the medium
  /// Quadrature for the emission of empty voxels, until its first collision; null: no empty voxel emits, or its
  /// emission is swept with the rest.
  std::unique_ptr<const SweptDirections> OfVacuum;
  std::unique_ptr<const GivenLight> Given; ///< uncollided light from another solver; null: none

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
  /// Boundary source of sweeps along the usual directions; empty: none.
  SweepBoundary BoundaryOfSweeps() const;
  bool SweepCarriesBoundarySource() const { return this->UsualBoundary->Shines(); }
  /// The boundary source of FineBoundary, represented in the usual quadrature.
  BoundaryLight FinePartAlongUsual() const;

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

  /// Lamps of a scene, and lamps that represent the peaks of its environment along these directions, in its units.
  std::vector<Light> LampsOf(const Illumination& illumination) const;
  using Sources = std::vector<std::unique_ptr<UncollidedSource>>;
  bool FacesReflect() const { return this->Faces && this->Faces->Reflects(); }
  /// Deposit::spreadsAside: true if face light is stored and no face reflects. Reflected light enters through the cells
  /// it left through, so it must not be spread.
  bool SpreadsAside() const { return this->Faces && !this->Faces->Reflects(); }
  /// Incident radiance by cell, for SweepRequest::faceIn; null: none.
  const Buffer<float>* LightByCells() const { return this->FacesReflect() ? &this->Faces->In() : nullptr; }

  Sources LampSources() const;
  Sources BrightEmissionSources() const;
  /// Localised emission and given light: all uncollided light that neither comes from lamps nor is swept.
  Sources OtherSources() const;
  /// Emission of empty voxels, if it has a quadrature of its own (OfVacuum).
  Sources VacuumSources() const;
  /// Writes the emission that sweeps along the usual directions carry to `source`; writes nothing if there is none.
  /// @return whether any of it is non-zero
  bool LoadEmission(Buffer<float>& source) const;
  void CountEmission(EnergyLedger& ledger) const; ///< counts all emission of the medium; collective

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
  int Functions() const;                                              ///< in the basis; 1: isotropic
  const SweptMoments* Moments() const { return this->Angular.get(); } ///< null if Basis is null
  /// Chooses and makes an implementation of the sweep; no other function does. Collective.
  std::unique_ptr<SweepOperator> MakeSweep(const SweepRequest& request);
  /// Whether MakeSweep can sweep a part of the grid (SweepRequest::box).
  bool SweepsParts() const { return this->TheDomain().IsSerial(); }
  /// Fetches the values beyond the faces of this block from its neighbours. Collective.
  /// @param byFaces  values by face of each voxel, [channel][face][stride]
  BeyondFaces FetchBeyond(const Buffer<float>& byFaces);

private:
  bool ByBalance() const { return this->How == IterationScheme::Dsa; }
  void FindVacuum();
  std::vector<float> EmissionOf(bool emptyVoxels) const;
  void FindBoundaryLight();
  void FindFineBoundary();
  SplitEnvironment SplitFar(const Environment& environment) const;
  void FindFaceLight();
  int SlotOf(const UncollidedSource& source) const;
  UncollidedVolume VolumeOf(const Deposit& deposit);
  SweepTally SumOfVoxels(const SweepTally& own) const;

  bool MediumShines = false;
  std::unique_ptr<const SweptMoments> Angular; ///< null: isotropic, or the block has no voxels
  SweepWorkspace Workspace;
  BlockWorkspace PipelineWorkspace;
  std::unique_ptr<AcrossFaces> Across;      ///< null: the block is the domain
  std::unique_ptr<LampsInBlocks> NearLamps; ///< null until first used
};

/// Makes the parts of a problem, with quadratures chosen for it. Collective.
std::unique_ptr<TransportParts> MakeParts(Device& device, const PropagationProblem& problem, IterationScheme how);
}
