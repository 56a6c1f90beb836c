#include "LightPropagation/Distributed/BlockScene.h"

#include "Distribution/SharedMedium.h"
#include "Light/ChannelReduction.h"

#include <algorithm>
#include <string>
#include <vector>

namespace tyndall
{
void RequireSame(Communicator& communicator, bool has, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings)
{
  const auto components = [](const Field& field) { return field.values ? field.components : 0; };
  RequireSame(communicator, "the components of sigma_a, sigma_s or emission, or one has no emission", has,
    { 1.0 * components(medium.sigma_a), 1.0 * components(medium.sigma_s), 1.0 * components(medium.emission) });
  const bool varies = has && medium.phase.Varies();
  const auto cosine = [&](int c) { return has && !varies ? medium.phase.MeanCosine(0, c) : 0.0; };
  RequireSame(communicator, "g", has, { varies ? 1.0 : 0.0, cosine(0), cosine(1), cosine(2) });
  RequireSame(communicator, "settings", true,
    { 1.0 * settings.directionsPerFace, 1.0 * settings.mapResolution, 1.0 * settings.maximumOrders, settings.tolerance,
      1.0 * settings.netFlux, 1.0 * settings.leaveOut, 1.0 * settings.staggeredRays,
      1.0 * static_cast<int>(settings.source), 1.0 * static_cast<int>(settings.acceleration) });
  std::vector<double> light = { 1.0 * static_cast<double>(illumination.lights.size()), Sum(illumination.sky),
    1.0 * illumination.environment.width, 1.0 * illumination.environment.height };
  for (const Rgb& face : illumination.faces)
  {
    light.insert(light.end(), face.begin(), face.end());
  }
  RequireSame(communicator, "what shines on it", true, light);
}

BlockScene::BlockScene(Communicator& communicator, bool has, const Grid& whole, const Medium& ofBlock,
  const Illumination& shining, const PropagationSettings& settings)
  : medium(ofBlock)
  , illumination(shining)
  , traits(TraitsOfAll(communicator, has ? TraitsOf(ofBlock, true) : MediumTraits()))
  , lengthUnit(LengthUnitOf(whole))
{
  communicator.Together([&] {
    if (has && this->lengthUnit != 1.0)
    {
      this->InLengths.emplace(this->medium, this->illumination, this->lengthUnit);
      this->medium = this->InLengths->medium;
      this->illumination = this->InLengths->illumination;
    }
  });
  this->powerUnit = communicator.Largest({ has ? PowerUnitOf(this->medium, this->illumination) : 0.0 })[0];
  if (has && this->powerUnit != 1.0)
  {
    this->InUnits.emplace(this->medium, this->illumination, this->powerUnit);
    this->medium = this->InUnits->medium;
    this->illumination = this->InUnits->illumination;
  }
  const SceneChannels reduction(this->medium, this->traits, this->illumination);
  this->channels = static_cast<int>(communicator.Largest({ has ? 1.0 * reduction.given : 1.0 })[0]);
  if (has && this->channels == 1)
  {
    const OneChannelScene one(this->medium, this->illumination, reduction);
    this->medium = one.medium;
    this->illumination = one.light;
  }
  this->sharedExtinction = this->channels == 1 || (settings.leaveOut && this->traits.greyExtinction);
}
Grid BlockScene::WholeOf(Grid grid) const
{
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.spacing[axis] /= this->lengthUnit;
    grid.origin[axis] /= this->lengthUnit;
  }
  return grid;
}

void BlockScene::Undo(LightField& light) const
{
  if (this->powerUnit != 1.0)
  {
    ToWatts(light, this->powerUnit);
  }
  if (this->lengthUnit != 1.0)
  {
    MultiplyPowers(light, this->lengthUnit * this->lengthUnit);
  }
}
}
