#pragma once

#include "Light/ChannelReduction.h"
#include "Light/LightField.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/Problem/SceneUnits.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Problem/UnvaryingAxes.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"
#include "Medium/Traits.h"

#include <array>
#include <optional>

namespace tyndall
{
/// @throws InvalidInput what Check() of the three throw, where a face that gives back light lies across a periodic
///   axis, and where light could not end: all faces give back all of it and nothing absorbs
void Check(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);

/// The same of a medium that is one of several blocks, but for what only all of them tell: whether light ends.
void CheckBlock(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);
/// Whether light ends in a medium, and whether it begins there: is emitted, or scattered of lamps within or of light
/// that is given. By channel, in any voxel.
struct LightEnds
{
  std::array<bool, 3> absorbs = {}, begins = {};
};
LightEnds LightEndsIn(const Medium& medium, const Illumination& illumination);
/// @throws InvalidInput where light can neither leave the box nor be absorbed, and goes on until it does
void RequireSink(const LightEnds& ends, const Illumination& illumination, const PropagationSettings& settings);

/// A scene as it is solved: in units of length and of power that floats hold well, wide along axes on which nothing
/// changes, with as many channels as it needs. Made once from what the user gave; Undo() turns the light that was found
/// back into what the user asked for.
class PropagationProblem
{
public:
  /// @param medium, illumination  their arrays must stay
  /// @throws InvalidInput what Check() above throws
  /// @param memory  for angular moments, where the settings leave open how many
  PropagationProblem(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings,
    const DeviceMemory& memory = {});
  PropagationProblem(const PropagationProblem&) = delete; // the medium sees arrays that this owns
  PropagationProblem& operator=(const PropagationProblem&) = delete;

  const Medium& TheMedium() const { return this->Solved; }
  const Grid& TheGrid() const { return this->Solved.grid; }
  const MediumTraits& Traits() const { return this->TheTraits; }
  const TruncatedScattering& Scattering() const { return *this->Truncated; } ///< as sweeps carry it
  const Illumination& Shining() const { return this->SolvedLight; }
  const PropagationSettings& Settings() const { return this->TheSettings; }
  int Channels() const { return this->ChannelCount; } ///< 1 or 3
  /// The scattered light of a voxel is taken as linear across it, not as constant as published.
  bool HasLinearSource() const { return this->TheSettings.source != PropagationSource::Constant; }
  /// The medium scatters, or nothing is to be left out.
  bool ComputesScattering() const { return !this->TheSettings.leaveOut || this->TheTraits.scatters; }
  bool IsSlab() const { return this->Unvarying.IsSlab(); }

  /// To the user's units, channels and voxels; says in leftOut what was left out.
  void Undo(LightField& light) const;

private:
  void TakeUnits(const Medium& wide, const Illumination& illumination);
  void Truncate(const DeviceMemory& memory);

  UnvaryingAxes Unvarying;
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
};
}
