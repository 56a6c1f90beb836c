#include "DiscreteOrdinates/Distributed/OrdinatesInBlocks.h"

#include "Device/Errors.h"
#include "DiscreteOrdinates/OrdinatesParts.h"
#include "DiscreteOrdinates/OrdinatesWarmStart.h"
#include "DiscreteOrdinates/SweptOrders.h"
#include "Distribution/SharedMedium.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/UnvaryingAxes.h"

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

/// A scene of blocks as it is solved: in the units and channels of all.
class OrdinatesOfBlock
{
public:
  /// What is given must stay.
  OrdinatesOfBlock(Device& device, Communicator& communicator, const BlockPartition& partition, bool has,
    const PropagationSettings& asPropagation, const OrdinatesSettings& settings)
    : TheDevice(device)
    , Comm(communicator)
    , Partition(partition)
    , Has(has)
    , AsSolved(asPropagation)
    , Settings(settings)
  {
  }

  /// In the user's units.
  /// Judged, but for the scene as the user gave it.
  LightField Solve(
    const Medium& medium, const Illumination& illumination, const Monitor& monitor, KeptLight* kept) const
  {
    Medium own = this->Has ? medium : Medium();
    own.grid = this->Partition.OwnGrid(this->Comm.Rank());
    Illumination known = illumination;
    known.uncollided = this->UncollidedKnown(illumination.uncollided);
    const BlockScene scene(
      this->Comm, this->Has, this->Partition, own, known, this->AsSolved, MemoryOf(this->TheDevice));
    const Illumination& shining = scene.illumination; // grey where one channel does for three, without voxels too
    const FarLight far = FarLightOf(shining, this->AsSolved.directionsPerFace, this->Settings);
    LightField light;
    light.channels = scene.channels;
    OrdinatesWarmStart warm(kept, this->Settings);
    for (int c = 0; c < light.channels; ++c)
    {
      const double all = light.channels;
      const Monitor ofChannel = OfPart(monitor, c / all, (c + 1) / all);
      this->SolveChannel(light, c, scene, shining, far, warm, ofChannel);
    }
    if (!this->Has)
    {
      light.fluence.clear();
      light.fluenceDirect.clear();
      light.netFlux.clear();
    }
    this->Describe(light, scene, far);
    const OrdinatesRanks ranks = { this->Comm, this->Partition };
    Judge(this->Settings, false, scene.medium, &ranks, light);
    this->Comm.Collective([&] { scene.Undo(light); });
    warm.Finish(light, kept);
    return light;
  }

private:
  void SolveChannel(LightField& light, int channel, const BlockScene& scene, const Illumination& shining,
    const FarLight& far, OrdinatesWarmStart& warm, const Monitor& monitor) const
  {
    BlockPartition inUnits = this->Partition;
    inUnits.whole = scene.WholeOf(this->Partition.whole);
    const Medium solved = this->Has ? scene.medium : VoxelOfVacuum(inUnits.whole);
    const OrdinatesRanks ranks = { this->Comm, inUnits };
    const PhaseFunction function = FunctionOf(solved, channel, &ranks);
    const OrdinatesAngles angles = { OrdinateGroups(far.directions),
      SeparableOf(function, far.directions, this->Settings), function };
    this->Comm.Collective([&] { CheckMemory(this->TheDevice, solved.grid, angles, this->Settings); });
    const OrdinatesScene ofChannel = { solved, channel, LampsOf(far, shining, channel),
      IncomingOf(far, shining, channel), FaceAlbedoOf(shining, channel), UncollidedOf(shining, channel),
      warm.Begin(channel, this->KindOf(inUnits, light.channels), angles, &ranks), &ranks };
    const OrdinatesResult found = SolveSweptOrders(this->TheDevice, ofChannel, angles, this->Settings, monitor);
    this->Comm.Collective([&] {
      TakeChannel(light, found, channel);
      warm.Take(found, channel);
    });
  }

  LightKind KindOf(const BlockPartition& inUnits, int channels) const
  {
    LightKind kind;
    kind.size = inUnits.whole.size;
    kind.spacing = inUnits.whole.spacing;
    kind.channels = channels;
    kind.periodic = this->Settings.periodic;
    kind.block = inUnits.blocks[this->Comm.Rank()];
    return kind;
  }

  /// A rank without voxels takes part in what the others do with light that is given.
  UncollidedImage UncollidedKnown(const UncollidedImage& own) const
  {
    static const float nothing = 0.0f;
    const bool any = OnAnyRank(this->Comm, this->Has && own.IsThere());
    UncollidedImage image;
    image.fluence = any ? Field{ &nothing, 1 } : Field();
    return this->Has ? own : image;
  }

  void Describe(LightField& light, const BlockScene& scene, const FarLight& far) const
  {
    DescribeLight(light, this->TheDevice, far);
    if (!this->Settings.netFlux)
    {
      light.leftOut.emplace_back(left_out::NetFlux);
    }
    const bool varies = OnAnyRank(this->Comm, this->Has && scene.medium.phase.Varies());
    light.doubts = DoubtsOf(this->Settings, 0.0, varies);
    light.directionsPerFace = this->AsSolved.directionsPerFace;
  }

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  const bool Has;
  const PropagationSettings& AsSolved;
  const OrdinatesSettings& Settings;
};
}

OrdinatesSettings AtQualityInBlocks(Communicator& communicator, const BlockPartition& partition, Quality quality,
  const OrdinatesSettings& settings, const Medium& medium, const DeviceMemory& memory)
{
  const bool has = partition.blocks.at(communicator.Rank()).VoxelCount() > 0;
  const MediumOfQuality ofAll = { partition.whole.VoxelCount(),
    !OnAnyRank(communicator, has && !medium.phase.IsIsotropic()) };
  constexpr double MoreThanAny = 1e18; // which a whole number of 64 bits holds
  DeviceMemory least;
  least.all =
    static_cast<std::size_t>(-communicator.Largest({ -std::min(static_cast<double>(memory.all), MoreThanAny) })[0]);
  return AtQuality(quality, settings, ofAll, least);
}

LightField SolveOrdinatesInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const OrdinatesSettings& settings, const Monitor& monitor,
  KeptLight* kept)
{
  RequireSame(communicator, "WarmStart", true, { kept ? 1.0 : 0.0 });
  const bool has = partition.blocks.at(communicator.Rank()).VoxelCount() > 0;
  PropagationSettings asPropagation = AsPropagation(settings);
  communicator.Collective([&] {
    partition.Check();
    Require(!IsPublished(settings), "Blocks cannot be solved as published: take the conservative scheme.");
    Require(static_cast<int>(partition.blocks.size()) == communicator.Ranks(), "There is not a block for each rank.");
    Check(settings);
    if (has)
    {
      CheckBlock(medium, illumination, asPropagation);
      Require(medium.grid.size == partition.OwnGrid(communicator.Rank()).size,
        "The medium of rank " + std::to_string(communicator.Rank()) + " does not have the size of its block.");
    }
  });
  RequireSame(communicator, partition);
  RequireSame(communicator, has, medium, illumination, asPropagation);
  RequireSameOrdinates(communicator, settings);
  RequireSink(LightEndsOnAny(communicator, has, medium, illumination), illumination, asPropagation);
  const UnvaryingAxes unvarying(partition.whole, illumination, asPropagation);
  BlockPartition wide = partition;
  wide.whole = unvarying.Widened(partition.whole);
  asPropagation.directionsPerFace = DirectionsPerFaceFor(asPropagation, unvarying);
  const double narrowing = partition.whole.VoxelVolume() / wide.whole.VoxelVolume();
  Illumination shining = illumination;
  for (Rgb& face : shining.uncollided.escaped)
  {
    face = Times(face, 1.0 / narrowing);
  }
  LightField light =
    OrdinatesOfBlock(device, communicator, wide, has, asPropagation, settings).Solve(medium, shining, monitor, kept);
  MultiplyPowers(light, narrowing);
  if (asPropagation.directionsPerFace != settings.directionsPerFace)
  {
    light.leftOut.push_back(left_out::DirectionsAlongSlab(asPropagation.directionsPerFace));
  }
  light.faceAlbedo = illumination.faceAlbedo;
  WarnAboutInputLight(illumination, light);
  return light;
}
}
