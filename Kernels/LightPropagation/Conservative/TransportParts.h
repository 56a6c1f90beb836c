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
/// A rank's block of a problem on its device, with the quadratures it is solved with and the sources of its light: what
/// the iterations are made of. Holds no state of a solve but the arrays that they work in. Directions, boundary sources
/// and the cells of the box's faces are those of the whole domain; arrays over voxels are of the block.
class TransportParts
{
public:
  /// Not collective: what may fail here fails on one rank alone.
  /// @param problem  must stay
  /// @param usual  directions of scattered light
  /// @param finer  of light from outside until it meets the medium
  /// @throws DeviceError if the arrays do not fit; InvalidInput where rays are too few (BoundaryLight.h)
  TransportParts(Device& device, const PropagationProblem& problem, IterationScheme how, DirectionSet usual,
    const UncollidedDirections& finer);
  TransportParts(const TransportParts&) = delete; // lights see directions that this owns
  TransportParts& operator=(const TransportParts&) = delete;

  Device& TheDevice;
  const PropagationProblem& Problem;
  const IterationScheme How;
  const VolumeLayout Layout;
  const MediumOnDevice OnDevice;
  const std::unique_ptr<const ScatteringOperator> Scattering;

  /// Along the directions of scattered light.
  const SweptDirections Usual;
  /// Of the moments in which light is scattered; null: all is isotropic, or the block has no voxels.
  const AngularBasis* Basis = nullptr;
  const UncollidedDirections Finer;            ///< of light from outside until it meets the medium
  std::unique_ptr<const SweptDirections> Fine; ///< those directions; null: the usual ones
  /// FineBoundary: along the finer directions; null where nothing comes along them. UsualBoundary: what sweeps carry,
  /// all the rest; where orders are accelerated by the whole balance all that comes in.
  std::unique_ptr<const BoundaryLight> UsualBoundary, FineBoundary;
  /// By cells of the box's faces: where they reflect, or face power is asked for; else null.
  std::unique_ptr<FaceLight> Faces;
  std::vector<Light> Lamps; ///< those of the scene and the peaks of the environment
  Environment FarAway;      ///< the environment without its peaks
  SplitEmission Emission;   ///< of the medium
  /// What empty voxels emit goes along these until it meets the medium; null: none emits, or it goes with the rest.
  std::unique_ptr<const SweptDirections> OfVacuum;
  std::unique_ptr<const GivenLight> Given; ///< that another solver found; null: none

  /// [channel][stride]; flux [channel][x, y, z][stride], empty where net flux is not asked for. Where light has angular
  /// moments, Source and Path have them [function][channel][stride], and Source those of beams behind them.
  Buffer<float> Source, Path, Flux, Fluence;

  const Domain& TheDomain() const { return this->Problem.TheDomain(); }
  bool IsEmpty() const { return this->TheDomain().IsEmpty(); } ///< the block has no voxels
  /// Writes what the medium emits, and what of given light goes straight on, to Source. Collective; to be called first.
  void LoadSource();
  /// Sweeps read Source from the first on: it shines, or nothing is left out.
  bool HasSource() const { return this->MediumShines; }
  /// What sweeps along the usual directions carry of the light from outside; empty: nothing.
  SweepBoundary BoundaryOfSweeps() const;
  bool SweepCarriesBoundarySource() const { return this->UsualBoundary->Shines(); }
  /// The light of FineBoundary along the usual directions.
  BoundaryLight FinePartAlongUsual() const;

  /// The light of one source, added to where `deposit` says. Collective, as all that adds or finds uncollided light.
  /// @return all channels, of all ranks
  SweepTally AddUncollided(const UncollidedSource& source, const Deposit& deposit, const Monitor& monitor);
  /// The same into arrays of its own, read back.
  struct UncollidedPath
  {
    std::vector<float> path; ///< as the deposit has it
    SweepTally tally;
  };
  struct UncollidedFlux : UncollidedPath
  {
    std::vector<float> flux; ///< the same; empty where it is not asked for
  };
  UncollidedPath FindUncollidedPath(const UncollidedSource& source, const Monitor& monitor);
  UncollidedFlux FindUncollided(const UncollidedSource& source, const Monitor& monitor);
  /// Uncollided light of a sky of radiance 1, along the finer directions and along the usual ones. By reciprocity it is
  /// also what leaves the box of a source of 1 in each voxel (numerics.md, Eq. (45)).
  struct EvenSky
  {
    UncollidedPath fine, usual;
  };
  EvenSky FindEvenSky(const Monitor& monitor);

  /// The lamps of a scene and those that stand for the peaks of its environment along these directions, in its units.
  std::vector<Light> LampsOf(const Illumination& illumination) const;
  using Sources = std::vector<std::unique_ptr<UncollidedSource>>;
  bool FacesReflect() const { return this->Faces && this->Faces->Reflects(); }
  /// Deposit::spreadsAside: but for light that comes back, through the cells that it comes in through.
  bool SpreadsAside() const { return this->Faces && !this->Faces->Reflects(); }
  /// What comes in by cells, for SweepRequest::faceIn; null: nothing.
  const Buffer<float>* LightByCells() const { return this->FacesReflect() ? &this->Faces->In() : nullptr; }

  Sources LampSources() const;
  Sources BrightEmissionSources() const;
  /// Small bright emission and given light: what is not of lamps, and not swept.
  Sources OtherSources() const;
  /// What empty voxels emit, where it goes along directions of its own.
  Sources VacuumSources() const;
  /// What the usual directions carry of what the medium emits, into a source; nothing where it does not.
  /// @return whether any of it shines
  bool LoadEmission(Buffer<float>& source) const;
  void CountEmission(EnergyLedger& ledger) const; ///< all that the medium emits, however it is carried; collective

  Deposit WholeDeposit() const;             ///< path, and flux where it is asked for
  std::vector<AxisBundles> AllRays() const; ///< of the usual directions
  /// Of the usual directions, for SweepRequest::angular; null: all is isotropic.
  const AngularValues* UsualValues() const { return this->Angular ? &this->Angular->Values() : nullptr; }
  void DarkenBeams();                                ///< in Source
  BeamsInSource BeamsOfSource();                     ///< where orders are added up one by one
  void LightBeams(const Buffer<float>& given) const; ///< in Source, as they are in another one
  std::size_t BeamValues() const { return this->Angular ? this->Angular->Beams() * this->Layout.Values() : 0; }
  /// What is scattered is handed out in angular moments.
  bool StoresMoments() const
  {
    return this->Problem.Scattering().Degree() > 0 && this->Problem.Settings().storeMoments;
  }
  int Functions() const;                                              ///< of the basis; 1: none
  const SweptMoments* Moments() const { return this->Angular.get(); } ///< null where Basis is
  /// The one place where an implementation of the sweep is chosen. Collective.
  std::unique_ptr<SweepOperator> MakeSweep(const SweepRequest& request);
  /// Whether MakeSweep sweeps a part of the grid (SweepRequest::box).
  bool SweepsParts() const { return this->TheDomain().IsSerial(); }
  /// Of values by voxels' faces, [channel][face][stride], those beyond the block's faces. Collective.
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
  std::unique_ptr<const SweptMoments> Angular; ///< null: all is isotropic, or the block has no voxels
  SweepWorkspace Workspace;
  BlockWorkspace PipelineWorkspace;
  std::unique_ptr<AcrossFaces> Across;      ///< null: the block is the whole grid
  std::unique_ptr<LampsInBlocks> NearLamps; ///< null until there is one
};

/// A problem's parts, with the quadratures that suit it. Collective.
std::unique_ptr<TransportParts> MakeParts(Device& device, const PropagationProblem& problem, IterationScheme how);
}
