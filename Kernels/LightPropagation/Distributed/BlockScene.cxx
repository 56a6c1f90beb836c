#include "LightPropagation/Distributed/BlockScene.h"

#include "Distribution/SharedMedium.h"
#include "Light/ChannelReduction.h"
#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/TruncatedScattering.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tyndall
{
Medium VoxelOfVacuum(const Grid& whole)
{
  static const float nothing = 0.0f;
  Medium vacuum;
  vacuum.grid = whole;
  vacuum.grid.size = { 1, 1, 1 };
  vacuum.sigma_a = vacuum.sigma_s = { &nothing, 1 };
  return vacuum;
}

BlockScene::BlockScene(Communicator& communicator, bool has, const BlockPartition& partition, const Medium& ofBlock,
  const Illumination& shining, const PropagationSettings& settings, const DeviceMemory& memory)
  : medium(ofBlock)
  , illumination(shining)
  , traits(TraitsOfAll(communicator, has ? TraitsOf(ofBlock, true) : MediumTraits()))
  , lengthUnit(LengthUnitOf(partition.whole))
{
  communicator.Collective([&] {
    this->illumination.lights = SeenFrom(partition.whole, shining.lights);
    if (this->lengthUnit != 1.0)
    {
      // All ranks scale the lamps, since all trace their light.
      this->InLengths.emplace(
        has ? this->medium : VoxelOfVacuum(partition.whole), this->illumination, this->lengthUnit);
      this->medium = has ? this->InLengths->medium : this->medium;
      this->illumination = this->InLengths->illumination;
    }
  });
  const Grid whole = this->WholeOf(partition.whole);
  const AllThatShines here = has ? ShiningOn(whole, this->medium, this->illumination) : AllThatShines();
  const std::vector<double> all = communicator.Largest({ here.power, here.first });
  this->powerUnit = PowerUnitFor({ all[0], all[1] });
  if (this->powerUnit != 1.0)
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
  this->given = OnAnyRank(communicator, has && shining.uncollided.IsThere());
  this->Truncate(communicator, partition, settings, memory);
  // The traits describe extinction with the similarity relation only.
  this->traits.greyExtinction = this->traits.grey || (this->traits.greyExtinction && this->Truncated->Degree() == 0);
  this->sharedExtinction = this->channels == 1 || (settings.leaveOut && this->traits.greyExtinction);
}

/// As in PropagationProblem, with data of all ranks.
void BlockScene::Truncate(Communicator& communicator, const BlockPartition& partition,
  const PropagationSettings& settings, const DeviceMemory& memory)
{
  const Grid whole = this->WholeOf(partition.whole);
  AngularDetail detail = AngularDetailOf(this->medium, this->channels);
  detail.moments = communicator.Largest(detail.moments);
  const std::vector<double> extinction =
    communicator.Sum({ detail.extinction[0], detail.extinction[1], detail.extinction[2] });
  std::copy(extinction.begin(), extinction.end(), detail.extinction.begin());
  std::size_t most = 0;
  for (const VoxelBox& block : partition.blocks)
  {
    most = std::max(most, block.VoxelCount());
  }
  int degree = 0;
  communicator.Collective(
    [&] { degree = this->traits.scatters ? AngularDegreeFor(detail, whole, settings, false, most, memory) : 0; });
  degree = -static_cast<int>(communicator.Largest({ -1.0 * degree })[0]); // smallest over ranks, which fits all devices
  communicator.Collective([&] {
    std::optional<DirectionKernel> kernel;
    if (degree > 0 && IsMuchThinnerAlongOneAxis(detail, whole, this->channels, settings.periodic))
    {
      kernel.emplace(DirectionsForVoxels(settings.directionsPerFace, whole.spacing), degree);
    }
    this->Truncated.emplace(this->medium, degree, this->channels, kernel ? &*kernel : nullptr);
  });
  this->Truncated->RaiseDegree(static_cast<int>(communicator.Largest({ 1.0 * this->Truncated->Degree() })[0]));
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
