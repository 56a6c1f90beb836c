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
  int perFace = 0; ///< directions per cube face; 0: the quadrature of scattered light
  /// Whether only light of faces uses these directions; sky and environment, which are uniform or smooth, then use the
  /// directions of scattered light.
  bool ofFacesAlone = false;
  /// Whether the difference in escaped power between these directions and those of scattered light is corrected
  /// (EscapeCorrection.h), at three times the cost.
  bool correctsEscape = false;
};

/// Chooses the directions for uncollided boundary light: settings.uncollidedDirections or, if that is -1, the largest
/// of 36, 49, 64 and 100 directions per cube face, with which a solve with one emitting face is predicted to take at
/// most 1.5 times as long as without them. The automatic choice is 0 if a face reflects; with DSA and angular moments,
/// to save memory; and with coarse-mesh DSA, where more directions would need the escape correction, which would change
/// the light of lamps as well. With discrete ordinates (settings.alongRays is false), only light of faces uses the
/// chosen directions, which are at least as many as for scattered light; if scattering is anisotropic, 36 at least, and
/// more only if the solve is predicted to take at most 1.1 times as long. With DSA, sweeps also carry the light of
/// faces.
/// @param usual  quadrature of scattered light; unless it is fitted (DirectionSet::orbits), the automatic choice is 0
/// Collective.
UncollidedDirections UncollidedDirectionsFor(
  const PropagationProblem& problem, const DirectionSet& usual, IterationScheme how);

/// Light sources of a problem, sorted by how their light is transported: traced along exact rays until its first
/// collision, swept along a finer quadrature until its first collision, or swept along the quadrature of scattered
/// light together with that light. Boundary sources are those of the whole domain, emission is that of this rank's
/// block.
class LightSources
{
public:
  /// @param problem, layout, usual  must outlive this object; `usual` is the quadrature of scattered light
  /// @param byBalance  whether the solve uses DSA, whose sweeps carry all boundary light
  /// @param finer  quadrature of boundary light until its first collision
  /// @throws InvalidInput if there are too few rays (BoundaryLight.h)
  LightSources(const PropagationProblem& problem, bool byBalance, const VolumeLayout& layout,
    const SweptDirections& usual, const UncollidedDirections& finer);
  LightSources(const LightSources&) = delete; // light sources refer to directions that this object owns
  LightSources& operator=(const LightSources&) = delete;

  /// Sets Emission, and OfVacuum if empty voxels emit and need a quadrature of their own. Collective; call before any
  /// method that concerns emission.
  void FindEmission();

  const PropagationProblem& Problem;
  const bool ByBalance;
  const VolumeLayout& Layout;
  const SweptDirections& Usual;
  const UncollidedDirections Finer; ///< quadrature of boundary light until its first collision
  bool CorrectsEscape;              ///< Finer.correctsEscape; false if the boundary source is uniform
  /// Rays of the quadrature Finer; null if that is the quadrature of scattered light.
  std::unique_ptr<const SweptDirections> Fine;
  /// Boundary sources. FineBoundary: transported along the quadrature Fine; null if there are none. UsualBoundary:
  /// carried by sweeps along the quadrature of scattered light; with DSA all boundary light, else all that is not in
  /// FineBoundary.
  std::unique_ptr<const BoundaryLight> UsualBoundary, FineBoundary;
  std::vector<Light> Lamps; ///< lamps of the scene, and parallel beams that represent peaks of the environment
  Environment FarAway;      ///< the environment without its peaks
  /// Emission of the medium: localised emission, which is traced along exact rays, and the rest.
  SplitEmission Emission;
  /// Quadrature for the emission of empty voxels, until its first collision; null: no empty voxel emits, or that
  /// emission is swept along the quadrature of scattered light.
  std::unique_ptr<const SweptDirections> OfVacuum;
  std::unique_ptr<const GivenLight> Given; ///< uncollided light from another solver; null: none

  /// Boundary source of sweeps along the directions of scattered light; empty: none.
  SweepBoundary BoundaryOfSweeps() const;
  bool SweepCarriesBoundarySource() const { return this->UsualBoundary->Shines(); }
  /// FineBoundary, represented in the quadrature of scattered light instead of the finer one.
  BoundaryLight FinePartAlongUsual() const;
  /// Lamps of a scene, and parallel beams that represent the peaks of its environment, in the units of `illumination`.
  std::vector<Light> LampsOf(const Illumination& illumination) const;

  using Sources = std::vector<std::unique_ptr<UncollidedSource>>;
  Sources LampSources() const;
  Sources PeakSources() const;  ///< localised emission, along exact rays
  Sources GivenSources() const; ///< uncollided light given by another solver
  /// Source of the emission of empty voxels, if it is swept along a quadrature of its own (OfVacuum); else none.
  Sources VacuumSources() const;
  /// Emission without localised emission, W / (length^3 sr), [channel][voxel].
  /// @param emptyVoxels  true: emission of the empty voxels that is swept along the quadrature OfVacuum; false: of all
  ///   other voxels
  std::vector<float> EmissionOf(bool emptyVoxels) const;
  void CountEmission(EnergyLedger& ledger) const; ///< adds all emission of the medium to the ledger; collective

private:
  void FindBoundaryLight();
  void FindFineBoundary();
  SplitEnvironment SplitFar(const Environment& environment) const;
};
}
