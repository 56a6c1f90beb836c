#pragma once

#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Emission/EmissionPeaks.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "LightPropagation/Uncollided/GivenLight.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// Directions for the uncollided light of faces, sky and environment. The choice does not depend on which light sources
/// are on, so that solutions can be superposed.
struct UncollidedDirections
{
  int perFace = 0; ///< directions per cube face; 0: the same as for scattered light
  /// Used for light of faces only; sky and environment, which are uniform or smooth, use the directions of scattered
  /// light.
  bool ofFacesAlone = false;
  /// The difference in escape between these and the directions of scattered light is corrected (EscapeCorrection.h);
  /// three times as expensive.
  bool correctsEscape = false;
};

/// The value in the settings or, if they leave it open (-1), the largest of 36, 49, 64 and 100 directions for light of
/// faces with which a solve with one emitting face is predicted to take at most a quarter longer. 0 if a face reflects;
/// with coarse-mesh DSA (more directions gain nothing without the escape correction, which would change the light of
/// lamps as well); and, for memory, in accelerated solves with angular moments.
/// @param usual  quadrature of scattered light; only if it is a fitted one do finer directions alone improve accuracy
/// Collective.
UncollidedDirections UncollidedDirectionsFor(
  const PropagationProblem& problem, const DirectionSet& usual, IterationScheme how);

/// The light sources of a problem, each assigned to the way it is transported: traced along exact rays until its first
/// collision, swept along a finer quadrature until then, or swept along the usual quadrature with scattered light.
/// Boundary sources are those of the whole domain, emission is of the block.
class LightSources
{
public:
  /// @param problem, layout, usual  must outlive this; usual: quadrature of scattered light
  /// @param byBalance  for DSA, whose sweeps carry all boundary light
  /// @param finer  quadrature of boundary light until its first collision
  /// @throws InvalidInput if there are too few rays (BoundaryLight.h)
  LightSources(const PropagationProblem& problem, bool byBalance, const VolumeLayout& layout,
    const SweptDirections& usual, const UncollidedDirections& finer);
  LightSources(const LightSources&) = delete; // sources refer to directions that this owns
  LightSources& operator=(const LightSources&) = delete;

  /// Gives the emission of empty voxels a quadrature of its own, if it needs one. Collective; call before any method
  /// that concerns emission.
  void FindVacuum();

  const PropagationProblem& Problem;
  const bool ByBalance;
  const VolumeLayout& Layout;
  const SweptDirections& Usual;
  const UncollidedDirections Finer;            ///< quadrature of boundary light until its first collision
  std::unique_ptr<const SweptDirections> Fine; ///< sweeps along Finer; null: along Usual
  /// Boundary sources. FineBoundary: those along the finer quadrature; null if there are none. UsualBoundary: those
  /// that sweeps carry along the usual quadrature, which are all others; with DSA, all boundary light.
  std::unique_ptr<const BoundaryLight> UsualBoundary, FineBoundary;
  std::vector<Light> Lamps; ///< lamps of the scene, and peaks of the environment
  Environment FarAway;      ///< the environment without its peaks
  SplitEmission Emission;   ///< of the medium
  /// Quadrature for the emission of empty voxels, until its first collision; null: no empty voxel emits, or its
  /// emission is swept with the rest.
  std::unique_ptr<const SweptDirections> OfVacuum;
  std::unique_ptr<const GivenLight> Given; ///< uncollided light from another solver; null: none

  /// Boundary source of sweeps along the usual directions; empty: none.
  SweepBoundary BoundaryOfSweeps() const;
  bool SweepCarriesBoundarySource() const { return this->UsualBoundary->Shines(); }
  /// The boundary source of FineBoundary, represented in the usual quadrature.
  BoundaryLight FinePartAlongUsual() const;
  /// Lamps of a scene, and lamps that represent the peaks of its environment along these directions, in its units.
  std::vector<Light> LampsOf(const Illumination& illumination) const;

  using Sources = std::vector<std::unique_ptr<UncollidedSource>>;
  Sources LampSources() const;
  /// Localised emission and given light: all uncollided light that neither comes from lamps nor is swept.
  Sources OtherSources() const;
  /// Emission of empty voxels, if it has a quadrature of its own (OfVacuum).
  Sources VacuumSources() const;
  /// Emission without localised emission, W / (length^3 sr), [channel][stride].
  /// @param emptyVoxels  of empty voxels that are swept separately; false: of all other voxels
  std::vector<float> EmissionOf(bool emptyVoxels) const;
  void CountEmission(EnergyLedger& ledger) const; ///< counts all emission of the medium; collective

private:
  void FindBoundaryLight();
  void FindFineBoundary();
  SplitEnvironment SplitFar(const Environment& environment) const;
};
}
