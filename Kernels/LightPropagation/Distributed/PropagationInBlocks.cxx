#include "LightPropagation/Distributed/PropagationInBlocks.h"

#include "Device/Errors.h"
#include "Distribution/SharedMedium.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Distributed/IterationInBlocks.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/UncollidedDirections.h"
#include "LightPropagation/Problem/UnvaryingAxes.h"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
std::string NotInBlocks(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  const bool goesRound = settings.periodic[0] || settings.periodic[1] || settings.periodic[2];
  const auto isNear = [](const Light& light) { return light.type != LightType::Directional; };
  if (goesRound && std::any_of(illumination.lights.begin(), illumination.lights.end(), isNear))
  {
    return "a point, spot or rectangle light beside a periodic axis";
  }
  if (settings.source == PropagationSource::Octants)
  {
    return "a source by octants of directions";
  }
  const bool isAngular = !medium.phase.IsIsotropic() && settings.angularDegree != 0;
  if (settings.source == PropagationSource::Linear &&
    (isAngular || goesRound || Reflects(illumination) || settings.facePower || settings.uncollidedDirections > 0))
  {
    return "a linear source besides anisotropic scattering, periodic axes, FaceAlbedo, UncollidedDirections or power "
           "by "
           "cells of faces";
  }
  return {};
}

namespace
{
/// By channel.
std::array<bool, 3> AbsorbsOnAny(Communicator& communicator, bool has, const Medium& medium)
{
  const std::array<bool, 3> own = has ? ChannelsThatAbsorb(medium) : std::array<bool, 3>{};
  const std::vector<double> any = communicator.Largest({ own[0] * 1.0, own[1] * 1.0, own[2] * 1.0 });
  return { any[0] > 0.0, any[1] > 0.0, any[2] > 0.0 };
}
}

namespace
{
/// Of unscattered light from outside, as the whole would have them where it added up orders like this.
UncollidedDirections FinerDirectionsFor(Communicator& communicator, const BlockPartition& partition, bool has,
  const BlockScene& scene, const PropagationSettings& settings, const OrdersOverRanks& orders, OrdersAdded how)
{
  const DirectionSet usual = DirectionsForVoxels(settings.directionsPerFace, partition.whole.spacing);
  const UncollidedDirections own = UncollidedDirectionsFor({ settings, scene.illumination, false, scene.traits.scatters,
                                                             scene.Scattering().Degree(), [&] { return orders.needed; } },
    usual, how);
  // A rank without voxels has another idea of what shines: it does not know its channels.
  const std::vector<double> all =
    communicator.Largest({ has ? 1.0 * own.perFace : 0.0, has && own.correctsEscape ? 1.0 : 0.0 });
  return { static_cast<int>(all[0]), all[1] > 0.0 };
}

WayInBlocks WayOf(Communicator& communicator, const BlockPartition& partition, bool has, const BlockScene& scene,
  const PropagationSettings& settings)
{
  WayInBlocks way;
  way.orders = HowOrdersAreAdded(communicator, partition, scene, settings);
  if (way.orders.how != OrdersAdded::ByBalance)
  {
    way.finer =
      FinerDirectionsFor(communicator, partition, has, scene, settings, way.orders, way.orders.how);
  }
  return way;
}
}

LightField SolveInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor)
{
  const bool has = partition.blocks.at(communicator.Rank()).VoxelCount() > 0;
  communicator.Together([&] {
    partition.Check();
    Require(static_cast<int>(partition.blocks.size()) == communicator.Ranks(), "There is not a block for each rank.");
    if (has)
    {
      CheckBlock(medium, illumination, settings);
      Require(medium.grid.size == partition.OwnGrid(communicator.Rank()).size,
        "The medium of rank " + std::to_string(communicator.Rank()) + " does not have the size of its block.");
    }
    const std::string refused = NotInBlocks(medium, illumination, settings);
    Require(refused.empty(), "A medium that is spread over ranks is not solved with " + refused + ".");
  });
  RequireSame(communicator, partition);
  RequireSame(communicator, has, medium, illumination, settings);
  CheckLightHasAnEnd(AbsorbsOnAny(communicator, has, medium), illumination, settings.periodic);
  const UnvaryingAxes unvarying(partition.whole, illumination, settings);
  BlockPartition wide = partition;
  wide.whole = unvarying.Widened(partition.whole);
  PropagationSettings solved = settings;
  solved.directionsPerFace = DirectionsPerFaceFor(settings, unvarying);
  Medium own = has ? medium : Medium();
  own.grid = wide.OwnGrid(communicator.Rank());
  Illumination shining = illumination;
  for (Rgb& face : shining.uncollided.escaped)
  {
    face = Times(face, wide.whole.VoxelVolume() / partition.whole.VoxelVolume());
  }
  const BlockScene scene(communicator, has, wide, own, shining, solved, MemoryOf(device));
  BlockPartition inUnits = wide;
  inUnits.whole = scene.WholeOf(wide.whole);
  const WayInBlocks way = WayOf(communicator, inUnits, has, scene, solved);
  std::unique_ptr<IterationInBlocks> iteration;
  communicator.Together(
    [&] { iteration = std::make_unique<IterationInBlocks>(device, communicator, inUnits, scene, solved, way); });
  LightField light = iteration->Run(monitor);
  communicator.Together([&] {
    scene.Undo(light);
    MultiplyPowers(light, partition.whole.VoxelVolume() / wide.whole.VoxelVolume());
  });
  if (iteration->StoresMoments())
  {
    light.lampsApart = iteration->LampsOf(illumination);
  }
  if (solved.directionsPerFace != settings.directionsPerFace)
  {
    light.leftOut.push_back(left_out::DirectionsAlongSlab(solved.directionsPerFace));
  }
  light.faceAlbedo = illumination.faceAlbedo;
  JudgeConvergence(settings, light);
  DoubtGivenLight(illumination, light);
  return light;
}
}
