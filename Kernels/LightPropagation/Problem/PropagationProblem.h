#pragma once

#include "Distribution/Domain.h"
#include "Light/ChannelReduction.h"
#include "Light/LightField.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/Problem/GridAxes.h"
#include "LightPropagation/Problem/SceneChecks.h"
#include "LightPropagation/Problem/SceneUnits.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "Medium/Traits.h"

#include <optional>

namespace tyndall
{
/// A scene as it is solved: in units of length and power that floats represent well, with voxels widened along axes on
/// which nothing varies (UnvaryingAxes), and with as few channels as needed. Each rank has the medium of its subdomain;
/// all properties on which decisions are based (traits, channels, degree of the moments) refer to the domain. Made once
/// from the user's input; Undo() converts the resulting light back.
class PropagationProblem
{
public:
  /// Checks and converts a scene. Collective.
  /// @param domain  domain of the grid as given by the user
  /// @param medium  medium of this rank's subdomain, with its grid; of a subdomain without voxels only the grid is read
  /// @param medium, illumination  their arrays must outlive this object
  /// @param memory  memory of this rank's device, which limits the degree of angular moments if the settings leave it
  ///   open
  /// @throws InvalidInput  as Check() in SceneChecks.h
  PropagationProblem(const Domain& domain, const Medium& medium, const Illumination& illumination,
    const PropagationSettings& settings, const DeviceMemory& memory = {});
  /// Checks and converts a scene on a serial domain.
  PropagationProblem(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings,
    const DeviceMemory& memory = {})
    : PropagationProblem(Domain(medium.grid), medium, illumination, settings, memory)
  {
  }
  PropagationProblem(const PropagationProblem&) = delete; // the medium refers to arrays of this object
  PropagationProblem& operator=(const PropagationProblem&) = delete;

  const Domain& TheDomain() const { return this->Solving; }
  const Grid& Whole() const { return this->Solving.Whole(); } ///< grid of the domain
  const Medium& TheMedium() const { return this->Solved; }
  const Grid& TheGrid() const { return this->Solved.grid; } ///< grid of this rank's subdomain
  /// Traits of the domain's medium (whether it absorbs, scatters, emits, is grey, ...); but the box `filled` is that of
  /// this rank's subdomain.
  const MediumTraits& Traits() const { return this->TheTraits; }
  /// Scattering coefficients and moments of the sweeps (delta-M).
  const TruncatedScattering& Scattering() const { return *this->Truncated; }
  const Illumination& Shining() const { return this->SolvedLight; }
  const PropagationSettings& Settings() const { return this->TheSettings; }
  int Channels() const { return this->ChannelCount; } ///< number of channels that are solved, 1 or 3
  /// Whether uncollided light is given by voxel, as input.
  bool HasGivenLight() const { return this->Given; }
  /// Whether all voxels of the domain have an isotropic phase function.
  bool IsIsotropic() const { return this->Isotropic; }
  /// Whether the source is linear within a voxel; false: constant, as in the published scheme.
  bool HasLinearSource() const { return this->TheSettings.source != PropagationSource::Constant; }
  /// Whether scattering is computed: the medium scatters, or leaveOut is off in the settings.
  bool ComputesScattering() const { return !this->TheSettings.leaveOut || this->TheTraits.scatters; }
  bool IsSlab() const { return this->Unvarying.IsSlab(); }
  /// Whether the box is much thinner along one axis, so that sources must be nowhere negative (numerics.md, Eq. (8c)).
  bool IsMuchThinner() const { return this->MuchThinner; }

  /// Converts light to the user's units, channels and voxels, and reports simplifications in light.leftOut.
  void Undo(LightField& light) const;

private:
  void TakeUnits(const Illumination& illumination);
  void TakeChannels();
  void Truncate(const DeviceMemory& memory);

  UnvaryingAxes Unvarying;
  Domain Solving; ///< domain in the solver's unit of length
  PropagationSettings TheSettings;
  int DirectionsAskedFor;
  double Narrowing = 1.0; ///< volume of a voxel divided by that of the widened voxel
  double LengthUnit = 1.0, PowerUnit = 1.0;
  std::optional<SceneInLengths> InLengths;
  std::optional<SceneInUnits> InUnits;
  Medium Solved;
  Illumination SolvedLight;
  MediumTraits TheTraits;
  std::optional<SceneChannels> Reduction;
  std::optional<TruncatedScattering> Truncated;
  int ChannelCount = 3;
  bool Given = false, Isotropic = false, MuchThinner = false;
};
}
