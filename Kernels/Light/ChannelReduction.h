#pragma once

#include "Device/Monitor.h"
#include "Light/KeptLight.h"
#include "Lights/Lights.h"
#include "Medium/Traits.h"

#include <functional>
#include <vector>

namespace tyndall
{
/// Number of colour channels of a scene, in the resulting light and in the solve.
struct SceneChannels
{
  int given = 1; ///< number of channels of the result: 3 if medium or lights have coloured data, else 1
  /// Whether one channel suffices: the medium's coefficients are grey, and all light sources have the same colour.
  bool one = true;
  CommonColour colour;

  SceneChannels(const Medium& medium, const MediumTraits& traits, const Illumination& illumination);
  /// Number of channels in which the scene is solved: 1 if that suffices and `leaveOut` is true, else 3.
  int Solved(bool leaveOut) const { return leaveOut && this->one ? 1 : 3; }
  /// Converts light of `solved` channels to `given` channels. If one channel was solved for all, LightField::leftOut
  /// says so.
  void Undo(LightField& light, int solved) const;

private:
  const char* LeftOut() const;
};

/// Grey scene that consists of one channel of a coloured scene.
struct OneChannelScene
{
  OneChannelScene(const Medium& medium, const Illumination& illumination, int channel);
  /// The scene of the brightest channel, for a scene whose three channels are multiples of each other.
  OneChannelScene(const Medium& medium, const Illumination& illumination, const SceneChannels& channels)
    : OneChannelScene(medium, illumination, channels.colour.Brightest())
  {
  }

  Medium medium; ///< medium of one channel, which refers to the arrays of the given medium
  Illumination light;
};

/// Solves a scene in one channel if that suffices and `leaveOut` is true, otherwise in three. The result has
/// channels.given channels.
/// @param solve  called as solve(medium, illumination, channels); returns the LightField
template <class Solve>
LightField SolveChannels(bool leaveOut, const SceneChannels& channels, const Medium& medium,
  const Illumination& illumination, const Solve& solve);

/// Expands light of one channel to three channels: its multiples by the components of `colour`.
void Spread(LightField& light, const Rgb& colour);

/// Joins the light of three channels, each solved as a scene of one channel (OneChannelScene). Arrays that not all
/// channels have are left out, except for angular moments: a channel without moments uses its mean scattered radiance
/// as moment of degree 0, which includes the light first scattered from lamps. Surface radiance is NaN in channels that
/// do not have it.
LightField JoinChannels(std::vector<LightField> channels);

/// Solves the three channels of a scene one after the other, and joins their light (JoinChannels).
/// @param kept  light of the last solve by channel, which is replaced (KeptLight::channels); null: none
/// @param solve  solves one channel with its part of the progress and of the kept light, null if `kept` is null
LightField SolveOneByOne(const Monitor& monitor, KeptLight* kept,
  const std::function<LightField(int channel, const Monitor& monitor, KeptLight* kept)>& solve);

/// Reduces light of three equal channels to one channel.
void KeepOneChannel(LightField& light);
/// Reduces interleaved values of three equal channels to one channel.
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
