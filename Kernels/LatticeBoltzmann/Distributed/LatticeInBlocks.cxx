#include "LatticeBoltzmann/Distributed/LatticeInBlocks.h"

#include "Device/Errors.h"
#include "Distribution/SharedMedium.h"
#include "LatticeBoltzmann/Distributed/ChannelInBlocks.h"
#include "LatticeBoltzmann/Distributed/LatticeSceneInBlocks.h"
#include "LatticeBoltzmann/Distributed/UncollidedInBlocks.h"
#include "LatticeBoltzmann/LatticeLight.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Photons/Distributed/PhotonShares.h"
#include "Photons/Distributed/PhotonsInBlocks.h"

#include <algorithm>

namespace tyndall
{
namespace
{
void RequireSameLattice(
  Communicator& communicator, bool has, const Field& ior, const Illumination& shining, const LatticeSettings& settings)
{
  std::vector<double> numbers = { 1.0 * settings.directions, 1.0 * static_cast<int>(settings.scheme),
    1.0 * settings.maximumSteps, 1.0 * settings.solvesSteady, 1.0 * settings.probes, settings.tolerance,
    1.0 * settings.blockSize, 1.0 * settings.stepsPerExchange, 1.0 * settings.interleaves, 1.0 * settings.stretches };
  for (const Rgb& face : shining.faceAlbedo)
  {
    numbers.insert(numbers.end(), face.begin(), face.end());
  }
  RequireSame(communicator, "settings of the lattice", true, numbers);
  RequireSame(communicator, "whether there is a refractive index", has, { ior.values ? 1.0 : 0.0 });
}

/// What a rank can tell of its own input. All ranks call it.
void CheckInBlocks(Communicator& communicator, const BlockPartition& partition, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings)
{
  communicator.Collective([&] {
    partition.Check();
    Require(static_cast<int>(partition.blocks.size()) == communicator.Ranks(), "There is not a block for each rank.");
    Check(settings);
    const std::string refused = NotInBlocks(settings);
    Require(refused.empty(), "A lattice that is spread over ranks is not solved with " + refused + ".");
    Check(illumination);
    CheckFaceAlbedo(illumination, settings.periodic);
    if (partition.blocks[communicator.Rank()].VoxelCount() > 0)
    {
      CheckLattice(medium, ior, settings);
      Check(illumination.uncollided, medium);
      Require(medium.grid.size == partition.OwnGrid(communicator.Rank()).size,
        "The medium of rank " + std::to_string(communicator.Rank()) + " does not have the size of its block.");
    }
  });
}

/// What they have to have alike, and to have together. All ranks call it.
void CheckTogether(Communicator& communicator, const BlockPartition& partition, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings)
{
  const bool has = partition.blocks.at(communicator.Rank()).VoxelCount() > 0;
  RequireSame(communicator, partition);
  RequireSame(communicator, has, medium, illumination, AsPropagationInBlocks(settings));
  RequireSameLattice(communicator, has, ior, illumination, settings);
  RequireSink(LightEndsOnAny(communicator, has, medium, illumination), illumination, AsPropagation(settings));
}
}

LightField SolveLatticeInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Field& ior, const std::vector<Photon>& share, const Illumination& illumination,
  const LatticeSettings& settings, const Monitor& monitor)
{
  CheckInBlocks(communicator, partition, medium, ior, illumination, settings);
  communicator.Collective([&] { CheckPhotonsGoNotRound(settings); });
  CheckTogether(communicator, partition, medium, ior, illumination, settings);
  const bool has = partition.blocks[communicator.Rank()].VoxelCount() > 0;
  MarchSettings march;
  const bool needs = settings.netFlux || (has && NeedsFirstMoments(medium, settings));
  march.meanDirection = OnAnyRank(communicator, needs);
  const PhotonLight found =
    PhotonMarcherInBlocks(device, communicator, partition, medium, ior, march).March(share, OfPart(monitor, 0.0, 0.5));
  Illumination lit = illumination;
  lit.uncollided = has ? ImageOf(found) : UncollidedImage();
  LightField light =
    SolveLatticeInBlocks(device, communicator, partition, medium, ior, lit, settings, OfPart(monitor, 0.5, 1.0));
  DoubtPhotons(found, PlaceAmong(communicator, share.size()).all, light);
  return light;
}

LightField SolveLatticeInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Field& ior, const Illumination& illumination, const LatticeSettings& settings,
  const Monitor& monitor)
{
  const bool has = partition.blocks.at(communicator.Rank()).VoxelCount() > 0;
  CheckInBlocks(communicator, partition, medium, ior, illumination, settings);
  CheckTogether(communicator, partition, medium, ior, illumination, settings);

  const LatticeSceneInBlocks scene(device, communicator, partition, medium, ior, illumination, settings);
  const BlockScene& solved = scene.scene;
  const bool moments = OnAnyRank(communicator, has && NeedsFirstMoments(solved.medium, settings));
  const Uncollided direct =
    UncollidedInBlocks(device, communicator, scene.partition, scene.around, scene.OfKnown(), settings, moments)
      .Find(OfPart(monitor, 0.0, 0.1));
  LightField light = BeginLight(scene.Box().Count(), solved.channels, settings);
  double thickest = 0.0;
  for (int c = 0; c < light.channels; ++c)
  {
    ChannelInBlocks channel(device, communicator, scene, settings, direct, c);
    const double all = light.channels;
    channel.Solve(OfPart(monitor, 0.1 + 0.9 * c / all, 0.1 + 0.9 * (c + 1) / all));
    channel.AddTo(light);
    thickest = std::max(thickest, channel.Thickest());
  }
  FinishLight(light, device, communicator, scene, illumination, settings, thickest, direct.lost);
  return light;
}
}
