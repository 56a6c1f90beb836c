#pragma once

#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Problem/UncollidedDirections.h"
#include "LightPropagation/PropagationSettings.h"
#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// The light that comes to a grid spread over ranks from faces, sky, environment and lamps, and the directions that it
/// comes along. Of the whole grid, the same on all ranks, and on the host alone: knows neither ranks nor devices.
class IncidentLight
{
public:
  /// @param whole, shining  in the solver's units
  /// @param finer  directions of unscattered light from outside
  /// @param channels  of the medium
  /// @throws InvalidInput where rays are too few (BoundaryLight.h)
  IncidentLight(const Grid& whole, const PropagationSettings& settings, const Illumination& shining,
    const UncollidedDirections& finer, int channels);
  IncidentLight(const IncidentLight&) = delete; // boundaries see directions that this owns
  IncidentLight& operator=(const IncidentLight&) = delete;

  /// Of scattered light.
  const SweptDirections& Usual() const { return this->OfScattered; }
  /// Of unscattered light from outside; null: the same.
  const SweptDirections* Fine() const { return this->OfUnscattered.get(); }
  /// How they were chosen.
  const UncollidedDirections& Finer() const { return this->Chosen; }
  /// Those that light from outside does come along.
  const SweptDirections& OfBoundary() const { return this->AlongFine ? *this->OfUnscattered : this->OfScattered; }

  /// All that does not come along the finer directions.
  const BoundaryLight& UsualBoundary() const { return *this->AlongUsual; }
  /// Null where nothing does.
  const BoundaryLight* FineBoundary() const { return this->AlongFine.get(); }
  bool SweepCarriesBoundarySource() const { return this->AlongUsual->Shines(); }
  /// EscapeCorrection.h is due: scattered light leaves along other directions than light from outside comes in.
  bool CorrectsEscape() const { return this->Chosen.correctsEscape; }

  /// Those of the scene and the peaks of its environment.
  const std::vector<Light>& Lamps() const { return this->AllLamps; }
  /// The same of another illumination, in its own units.
  std::vector<Light> LampsOf(const Illumination& shining) const;

private:
  SplitEnvironment SplitFar(const Environment& environment) const;
  void MakeFineBoundary(
    const Grid& whole, const PropagationSettings& settings, const Illumination& shining, int channels);

  const SweptDirections OfScattered;
  const UncollidedDirections Chosen;
  const std::unique_ptr<const SweptDirections> OfUnscattered;
  const SplitEnvironment Far;
  std::unique_ptr<const BoundaryLight> AlongUsual, AlongFine;
  const std::vector<Light> AllLamps;
};
}
