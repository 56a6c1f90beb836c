#include "DiscreteOrdinates/Distributed/OrdinatesInBlocks.h"

#include "Device/Errors.h"
#include "DiscreteOrdinates/OrdinatesParts.h"
#include "DiscreteOrdinates/SweptOrders.h"
#include "Distribution/SharedMedium.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/Problem/PropagationProblem.h"

#include <algorithm>

namespace tyndall
{
namespace
{
void RequireSameOrdinates(Communicator& communicator, const OrdinatesSettings& settings)
{
  RequireSame(communicator, "settings of the ordinates", true,
    { 1.0 * static_cast<int>(settings.scattering), 1.0 * settings.spiralDirections, 1.0 * settings.terms });
}

/// What shines, for a rank without voxels where one channel does for three: it must know whether something does.
Illumination White(Illumination light)
{
  const auto whiten = [](Rgb& rgb) { rgb.fill(Sum(rgb)); };
  for (Light& lamp : light.lights)
  {
    whiten(lamp.power);
  }
  whiten(light.sky);
  std::for_each(light.faces.begin(), light.faces.end(), whiten);
  for (std::size_t i = 0; i + 2 < light.environment.radiance.size(); i += 3)
  {
    float* const pixel = light.environment.radiance.data() + i;
    std::fill_n(pixel, 3, pixel[0] + pixel[1] + pixel[2]);
  }
  return light;
}
}

std::string NotInBlocks(const Medium& medium, const Illumination& illumination, const OrdinatesSettings& settings)
{
  if (settings.periodic[0] || settings.periodic[1] || settings.periodic[2])
  {
    return "a periodic axis";
  }
  if (Reflects(illumination))
  {
    return "a face that gives back light (FaceAlbedo)";
  }
  if (illumination.uncollided.IsThere())
  {
    return "light of another solver (UncollidedLight)";
  }
  if (medium.phase.Varies())
  {
    return "a mean cosine that varies by voxel (cells g)";
  }
  return IsPublished(settings) ? "the published Scheme" : std::string();
}

LightField SolveOrdinatesInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const OrdinatesSettings& settings, const Monitor& monitor)
{
  const bool has = partition.blocks.at(communicator.Rank()).VoxelCount() > 0;
  const PropagationSettings asPropagation = AsPropagation(settings);
  communicator.Together([&] {
    partition.Check();
    Require(static_cast<int>(partition.blocks.size()) == communicator.Ranks(), "There is not a block for each rank.");
    Check(settings);
    const std::string refused = NotInBlocks(medium, illumination, settings);
    Require(
      refused.empty(), "A medium that is spread over ranks is not solved by discrete ordinates with " + refused + ".");
    if (has)
    {
      Check(medium, illumination, asPropagation);
      Require(medium.grid.size == partition.OwnGrid(communicator.Rank()).size,
        "The medium of rank " + std::to_string(communicator.Rank()) + " does not have the size of its block.");
    }
  });
  RequireSame(communicator, partition);
  RequireSame(communicator, has, medium, illumination, asPropagation);
  RequireSameOrdinates(communicator, settings);
  Medium own = has ? medium : Medium();
  own.grid = partition.OwnGrid(communicator.Rank());
  const BlockScene scene(communicator, has, partition, own, illumination, asPropagation, MemoryOf(device));
  BlockPartition inUnits = partition;
  inUnits.whole = scene.WholeOf(partition.whole);
  const Medium solved = has ? scene.medium : VoxelOfVacuum(inUnits.whole);
  const OrdinatesRanks ranks = { communicator, inUnits };
  const Illumination shining = has || scene.channels == 3 ? scene.illumination : White(scene.illumination);
  const FarLight far = FarLightOf(shining, settings.directionsPerFace, settings);
  LightField light;
  light.channels = scene.channels;
  for (int c = 0; c < light.channels; ++c)
  {
    const PhaseFunction function = solved.phase.OfChannel(c);
    const OrdinatesAngles angles = { OrdinateGroups(far.directions), SeparableOf(function, far.directions, settings),
      function };
    communicator.Together([&] { CheckMemory(device, solved.grid, angles, settings); });
    const OrdinatesScene ofChannel = { solved, c, LampsOf(far, shining, c), IncomingOf(far, shining, c), {}, {}, {},
      &ranks };
    const double all = light.channels;
    TakeChannel(
      light, SolveSweptOrders(device, ofChannel, angles, settings, OfPart(monitor, c / all, (c + 1) / all)), c);
  }
  if (!has)
  {
    light.fluence.clear();
    light.fluenceDirect.clear();
    light.netFlux.clear();
  }
  DescribeLight(light, device, far);
  if (!settings.netFlux)
  {
    light.leftOut.emplace_back(left_out::NetFlux);
  }
  light.directionsPerFace = settings.directionsPerFace;
  communicator.Together([&] { scene.Undo(light); });
  Judge(settings, false, light);
  return light;
}
}
