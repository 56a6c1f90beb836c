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
  const char* LeftOut() const; ///< in words, where one is enough
};

/// A scene whose three channels are multiples of each other, as its brightest sees it: medium and lights are grey.
struct OneChannelScene
{
  OneChannelScene(const Medium& medium, const Illumination& illumination, const SceneChannels& channels);

  Medium medium; ///< the given one's arrays
  Illumination light;
};

/// Solve a scene in as many channels as it needs, or in three where nothing is to be left out; the light has as many as are
/// given, either way.
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
  if (!leaveOut || !channels.one)
  {
    LightField light = solve(medium, illumination, 3);
    if (channels.given == 1)
    {
      KeepOneChannel(light);
    }
    return light;
  }
  const OneChannelScene scene(medium, illumination, channels);
  LightField light = solve(scene.medium, scene.light, 1);
  light.leftOut.insert(light.leftOut.begin(), channels.LeftOut());
  if (channels.given == 3)
  {
    Spread(light, channels.colour.Relative());
  }
  return light;
}
}
