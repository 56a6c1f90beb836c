#pragma once

#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Traits.h"

namespace tyndall
{
/// Colour channels of a scene: how many its light has as data, and how many have to be solved for.
struct SceneChannels
{
  int given = 1; ///< channels of the solve's result: 3 if medium or lights have coloured data, else 1
  /// Whether one channel is enough: the medium's coefficients are grey, and all light sources have the same colour.
  bool one = true;
  CommonColour colour;

  SceneChannels(const Medium& medium, const MediumTraits& traits, const Illumination& illumination);
  /// Number of channels to solve for: 1 if that is enough and `leaveOut` is true, else 3.
  int Solved(bool leaveOut) const { return leaveOut && this->one ? 1 : 3; }
  /// Expands light of `solved` channels to `given` channels, and notes in leftOut that one channel stood for all.
  void Undo(LightField& light, int solved) const;

private:
  const char* LeftOut() const;
};

/// The grey scene that stands for one whose three channels are multiples of each other: its brightest channel.
struct OneChannelScene
{
  OneChannelScene(const Medium& medium, const Illumination& illumination, const SceneChannels& channels);

  Medium medium; ///< refers to the arrays of the given medium
  Illumination light;
};

/// Solves a scene in as many channels as it needs, or in three if `leaveOut` is false. The result has `given` channels
/// either way.
/// @param solve  called as solve(medium, illumination, channels); returns the LightField
template <class Solve>
LightField SolveChannels(bool leaveOut, const SceneChannels& channels, const Medium& medium,
  const Illumination& illumination, const Solve& solve);

/// Expands light of one channel to three channels, its multiples by `colour`.
void Spread(LightField& light, const Rgb& colour);

/// Keeps the first of three equal channels.
void KeepOneChannel(LightField& light);
void KeepOneChannel(std::vector<float>& interleaved);

template <class Solve>
LightField SolveChannels(bool leaveOut, const SceneChannels& channels, const Medium& medium,
  const Illumination& illumination, const Solve& solve)
{
  const int solved = channels.Solved(leaveOut);
  LightField light;
  if (solved == 1)
  {
    const OneChannelScene scene(medium, illumination, channels);
    light = solve(scene.medium, scene.light, 1);
  }
  else
  {
    light = solve(medium, illumination, 3);
  }
  channels.Undo(light, solved);
  return light;
}
}
