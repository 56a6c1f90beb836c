#pragma once

#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Traits.h"

namespace tyndall
{
/// Channels of a scene: those that its light has as data, and those that have to be solved for.
struct SceneChannels
{
  int given = 1; ///< 3 where medium or light has colour, as data; so many does the light of a solve have
  /// One channel is enough: the medium's coefficients are grey, and all that shines has one colour.
  bool one = true;
  CommonColour colour;

  SceneChannels(const Medium& medium, const MediumTraits& traits, const Illumination& illumination);
  /// How many are solved for: one where that is enough and what is not needed is left out, else three.
  int Solved(bool leaveOut) const { return leaveOut && this->one ? 1 : 3; }
  /// The light of `solved` channels as that of as many as are given; says in leftOut what one stood for.
  void Undo(LightField& light, int solved) const;

private:
  const char* LeftOut() const;
};

/// A scene whose three channels are multiples of each other, as its brightest sees it: medium and lights are grey.
struct OneChannelScene
{
  OneChannelScene(const Medium& medium, const Illumination& illumination, const SceneChannels& channels);

  Medium medium; ///< the given one's arrays
  Illumination light;
};

/// Solve a scene in as many channels as it needs, or in three where nothing is to be left out; the light has as many as
/// are given, either way.
/// @param solve  takes a medium, its illumination and the number of channels
template <class Solve>
LightField SolveChannels(bool leaveOut, const SceneChannels& channels, const Medium& medium,
  const Illumination& illumination, const Solve& solve);

/// The light of one channel as that of three, which are multiples of it.
void Spread(LightField& light, const Rgb& colour);

/// Of three channels that are the same the first.
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
