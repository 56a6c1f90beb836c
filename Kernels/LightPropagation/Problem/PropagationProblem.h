#pragma once

#include "Distribution/Domain.h"
#include "Light/ChannelReduction.h"
#include "Light/LightField.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/Problem/SceneChecks.h"
#include "LightPropagation/Problem/SceneUnits.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Problem/UnvaryingAxes.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "Medium/Traits.h"

#include <array>
#include <optional>
#include <string>

namespace tyndall
{
/// A scene as it is solved: in units of length and of power that floats hold well, wide along axes on which nothing
/// changes, with as many channels as it needs. Each rank has the medium of its block; all that a solve decides by
/// (traits, channels, degree of the moments) is of the whole domain. Made once from what the user gave; Undo() turns
/// the light that was found back into what the user asked for.
class PropagationProblem
{
public:
  /// Collective.
  /// @param domain  of the grid as it is given
  /// @param medium  of this rank's block, with its grid; of a block without voxels nothing else is read
  /// @param medium, illumination  their arrays must stay
  /// @throws InvalidInput what Check() above throws
  /// @param memory  of this rank, for angular moments, where the settings leave open how many
  PropagationProblem(const Domain& domain, const Medium& medium, const Illumination& illumination,
    const PropagationSettings& settings, const DeviceMemory& memory = {});
  /// Of a serial domain.
  PropagationProblem(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings,
    const DeviceMemory& memory = {})
    : PropagationProblem(Domain(medium.grid), medium, illumination, settings, memory)
  {
  }
  PropagationProblem(const PropagationProblem&) = delete; // the medium sees arrays that this owns
  PropagationProblem& operator=(const PropagationProblem&) = delete;

  const Domain& TheDomain() const { return this->Solving; }
  const Grid& Whole() const { return this->Solving.Whole(); } ///< the domain's grid
  const Medium& TheMedium() const { return this->Solved; }
  const Grid& TheGrid() const { return this->Solved.grid; }                  ///< of this rank's block
  const MediumTraits& Traits() const { return this->TheTraits; }             ///< `filled` alone is of this rank's block
  const TruncatedScattering& Scattering() const { return *this->Truncated; } ///< as sweeps carry it
  const Illumination& Shining() const { return this->SolvedLight; }
  const PropagationSettings& Settings() const { return this->TheSettings; }
  int Channels() const { return this->ChannelCount; } ///< 1 or 3
  /// Uncollided light is given by voxel.
  bool HasGivenLight() const { return this->Given; }
  /// The scattered light of a voxel is taken as linear across it, not as constant as published.
  bool HasLinearSource() const { return this->TheSettings.source != PropagationSource::Constant; }
  /// The medium scatters, or nothing is to be left out.
  bool ComputesScattering() const { return !this->TheSettings.leaveOut || this->TheTraits.scatters; }
  bool IsSlab() const { return this->Unvarying.IsSlab(); }

  /// To the user's units, channels and voxels; says in leftOut what was left out.
  void Undo(LightField& light) const;

private:
  void TakeUnits(const Illumination& illumination);
  void TakeChannels();
  void Truncate(const DeviceMemory& memory);

  UnvaryingAxes Unvarying;
  Domain Solving; ///< in the unit of length
  PropagationSettings TheSettings;
  int DirectionsAskedFor;
  double Narrowing = 1.0; ///< volume of a voxel over that which is solved
  double LengthUnit = 1.0, PowerUnit = 1.0;
  std::optional<SceneInLengths> InLengths;
  std::optional<SceneInUnits> InUnits;
  Medium Solved;
  Illumination SolvedLight;
  MediumTraits TheTraits;
  std::optional<SceneChannels> Reduction;
  std::optional<TruncatedScattering> Truncated;
  int ChannelCount = 3;
  bool Given = false;
};
}
