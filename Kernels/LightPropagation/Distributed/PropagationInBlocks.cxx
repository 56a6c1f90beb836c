#include "LightPropagation/Distributed/PropagationInBlocks.h"

#include "Device/Errors.h"
#include "Distribution/SharedMedium.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Conservative/SolveMemory.h"
#include "LightPropagation/Convergence.h"
#include "LightPropagation/Distributed/Balance/GlobalStatistics.h"
#include "LightPropagation/Distributed/Balance/IterationByBalance.h"
#include "LightPropagation/Distributed/IterationInBlocks.h"
#include "LightPropagation/Distributed/LightOfBlock.h"
#include "LightPropagation/PlaneParallel/IsPlaneParallel.h"
#include "LightPropagation/Problem/AngularDegree.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/PropagationQuality.h"
#include "LightPropagation/Problem/UncollidedDirections.h"
#include "LightPropagation/Problem/UnvaryingAxes.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace tyndall
{
std::string NotInBlocks(const PropagationSettings& settings)
{
  if (settings.source == PropagationSource::Linear && settings.uncollidedDirections > 0)
  {
    return "a linear source besides UncollidedDirections";
  }
  return {};
}

void CheckBlocks(Communicator& communicator, const BlockPartition& partition, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings)
{
  const int rank = communicator.Rank();
  bool has = false;
  communicator.Collective([&] {
    partition.Check();
    Require(static_cast<int>(partition.blocks.size()) == communicator.Ranks(), "There is not a block for each rank.");
    has = partition.blocks[rank].VoxelCount() > 0;
    if (has)
    {
      CheckBlock(medium, illumination, settings);
      Require(medium.grid.size == partition.OwnGrid(rank).size,
        "The medium of rank " + std::to_string(rank) + " does not have the size of its block.");
    }
    const std::string refused = NotInBlocks(settings);
    Require(refused.empty(), "A medium that is spread over ranks is not solved with " + refused + ".");
  });
  RequireSame(communicator, partition);
  RequireSame(communicator, has, medium, illumination, settings);
  RequireSink(LightEndsOnAny(communicator, has, medium, illumination), illumination, settings);
}

namespace
{
/// What all ranks are given, checked.
const BlockPartition& Checked(Communicator& communicator, const BlockPartition& partition, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings)
{
  CheckBlocks(communicator, partition, medium, illumination, settings);
  return partition;
}

/// Light comes in through some of the box's faces, and not the same through all.
bool FacesShineUnevenly(const Illumination& light, const std::array<bool, 3>& periodic)
{
  const Rgb* first = nullptr;
  bool differ = false;
  for (int face = 0; face < 6; ++face)
  {
    if (!periodic[face / 2])
    {
      first = first ? first : &light.faces[face];
      differ = differ || light.faces[face] != *first;
    }
  }
  return differ;
}

/// A scene in blocks as it is solved, as PropagationProblem is of the whole.
class ProblemInBlocks
{
public:
  /// All ranks make one together.
  ProblemInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition, const Medium& medium,
    const Illumination& illumination, const PropagationSettings& settings)
    : Comm(communicator)
    , Given(Checked(communicator, partition, medium, illumination, settings))
    , Has(partition.blocks[communicator.Rank()].VoxelCount() > 0)
    , Unvarying(partition.whole, illumination, settings)
    , Settings(settings)
    , Blocks(partition)
    , Shining(illumination)
  {
    this->Settings.directionsPerFace = DirectionsPerFaceFor(settings, this->Unvarying);
    this->Blocks.whole = this->Unvarying.Widened(partition.whole);
    Medium own = this->Has ? medium : Medium();
    own.grid = this->Blocks.OwnGrid(communicator.Rank());
    for (Rgb& face : this->Shining.uncollided.escaped)
    {
      face = Times(face, 1.0 / this->Narrowing());
    }
    this->Scene.emplace(communicator, this->Has, this->Blocks, own, this->Shining, this->Settings, MemoryOf(device));
    this->Blocks.whole = this->Scene->WholeOf(this->Blocks.whole);
    this->Orders = ChooseIterationScheme(communicator, this->Blocks, *this->Scene, this->Settings);
  }
  ProblemInBlocks(const ProblemInBlocks&) = delete; // the scene sees its light
  ProblemInBlocks& operator=(const ProblemInBlocks&) = delete;

  LightField Solve(Device& device, const Illumination& illumination, const Monitor& monitor, KeptLight* kept);
  std::string ReasonNotToDecompose(const Medium& medium, const Illumination& illumination) const;
  bool BalancesVoxels() const { return this->Orders.how == IterationScheme::Dsa; }

private:
  /// Volume of a voxel over that which is solved.
  double Narrowing() const
  {
    return this->Given.whole.VoxelVolume() / this->Unvarying.Widened(this->Given.whole).VoxelVolume();
  }
  UncollidedDirections FinerDirections(IterationScheme how) const;
  MemoryBudget Budget(const Device& device) const;
  bool IsInLayers(const Medium& medium, const Illumination& illumination) const;

  Communicator& Comm;
  const BlockPartition& Given;
  const bool Has; ///< voxels
  const UnvaryingAxes Unvarying;
  PropagationSettings Settings;
  BlockPartition Blocks; ///< in the scene's units
  Illumination Shining;
  std::optional<BlockScene> Scene;
  OrdersOverRanks Orders;
};

/// Of unscattered light from outside, as the whole would have them where it added up orders like this.
UncollidedDirections ProblemInBlocks::FinerDirections(IterationScheme how) const
{
  const BlockScene& scene = *this->Scene;
  const DirectionSet usual = DirectionsForVoxels(this->Settings.directionsPerFace, this->Blocks.whole.spacing);
  const UncollidedDirections own =
    UncollidedDirectionsFor({ this->Settings, scene.illumination, this->Unvarying.IsSlab(), scene.traits.scatters,
                              scene.Scattering().Degree(), [this] { return this->Orders.needed; } },
      usual, how);
  // A rank without voxels has another idea of it: it does not know its medium.
  const std::vector<double> all = this->Comm.Largest({ this->Has ? 1.0 * own.perFace : 0.0,
    this->Has && own.ofFacesAlone ? 1.0 : 0.0, this->Has && own.correctsEscape ? 1.0 : 0.0 });
  return { static_cast<int>(all[0]), all[1] > 0.0, all[2] > 0.0 };
}

/// Kernels for CPUs work on what lies in host memory where it is; for GPUs a block that does not fit goes through the
/// device in slices.
MemoryBudget ProblemInBlocks::Budget(const Device& device) const
{
  if (device.IsCpu())
  {
    return BudgetAskedFor(device, this->Settings.memoryBudget);
  }
  const BlockScene& scene = *this->Scene;
  SolveExtent solve = { this->Blocks.blocks[this->Comm.Rank()].size, this->Settings, scene.channels,
    this->Has ? scene.Scattering().Degree() : 0, this->Orders.how };
  solve.byOctant = this->Settings.source == PropagationSource::Octants;
  solve.ofBlock = true;
  return BudgetOfSolve(device, solve);
}

LightField ProblemInBlocks::Solve(
  Device& device, const Illumination& illumination, const Monitor& monitor, KeptLight* kept)
{
  const BlockScene& scene = *this->Scene;
  Device ofSolve(device, this->Budget(device));
  const bool byBalance = this->Orders.how == IterationScheme::Dsa;
  const UncollidedDirections finer = byBalance ? UncollidedDirections() : this->FinerDirections(this->Orders.how);
  std::optional<IncidentLight> incident;
  std::optional<BlockOnDevice> block;
  std::optional<UncollidedOverRanks> uncollided;
  std::unique_ptr<Iteration> iteration;
  this->Comm.Collective([&] {
    incident.emplace(this->Blocks.whole, this->Settings, scene.illumination, finer, scene.channels);
    block.emplace(ofSolve, this->Comm, this->Blocks, scene, this->Settings, *incident);
    uncollided.emplace(*block, *incident);
    if (byBalance)
    {
      iteration = std::make_unique<IterationByBalance>(*block, *incident, *uncollided, kept);
    }
    else
    {
      iteration = std::make_unique<IterationInBlocks>(*block, *incident, *uncollided, this->Orders, kept);
    }
  });
  IterationResult found = iteration->Run(monitor);
  const bool warm = found.warm;
  KeptLight left = std::move(found.kept);
  LightField light = LightOfBlock(*block, *incident, std::move(found), this->Orders.how);
  JudgeBalance(light, this->Comm, this->Has, scene.medium);
  this->Comm.Collective([&] {
    this->Scene->Undo(light);
    MultiplyPowers(light, this->Narrowing());
  });
  if (block->StoresMoments())
  {
    light.lampsApart = incident->LampsOf(illumination);
  }
  if (kept)
  {
    Keep(std::move(left), warm, light, *kept);
  }
  return light;
}

/// Where these are not the same in all blocks, the whole is solved in vain along all rays.
bool ProblemInBlocks::IsInLayers(const Medium& medium, const Illumination& illumination) const
{
  const bool varies = this->Has && !IsPlaneParallel(medium, illumination, this->Settings);
  return this->Unvarying.IsSlab() || !OnAnyRank(this->Comm, varies);
}

std::string ProblemInBlocks::ReasonNotToDecompose(const Medium& medium, const Illumination& illumination) const
{
  const BlockScene& scene = *this->Scene;
  const bool oneByOne = this->Orders.how == IterationScheme::SourceIteration;
  if (this->IsInLayers(medium, illumination))
  {
    return "layers, which it solves in the cosine alone";
  }
  if (oneByOne && this->Orders.ofWhole != IterationScheme::SourceIteration)
  {
    return "many scattering orders in thin voxels round a periodic axis or along UncollidedDirections, which it "
           "accelerates";
  }
  if (this->Orders.how == IterationScheme::Dsa && FacesShineUnevenly(illumination, this->Settings.periodic) &&
    this->FinerDirections(this->Orders.how).perFace > 0)
  {
    return "faces that shine unevenly, whose light it has along finer directions";
  }
  if (MayHaveEmissionPeaks(this->Comm, this->Has, scene, this->Settings))
  {
    return "small bright emission, whose light it has along exact rays";
  }
  return {};
}
}

LightField SolveInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings, const Monitor& monitor,
  KeptLight* kept)
{
  RequireSame(communicator, "WarmStart", true, { kept ? 1.0 : 0.0 });
  ProblemInBlocks problem(device, communicator, partition, medium, illumination, settings);
  LightField light = problem.Solve(device, illumination, monitor, kept);
  if (light.directionsPerFace != settings.directionsPerFace)
  {
    light.leftOut.push_back(left_out::DirectionsAlongSlab(light.directionsPerFace));
  }
  light.faceAlbedo = illumination.faceAlbedo;
  JudgeConvergence(settings, light);
  WarnAboutInputLight(illumination, light);
  return light;
}

PropagationSettings AtQualityInBlocks(Communicator& communicator, const BlockPartition& partition, Quality quality,
  const PropagationSettings& settings, const Medium& medium, const Illumination& illumination)
{
  const bool has = partition.blocks.at(communicator.Rank()).VoxelCount() > 0;
  const double extinction = communicator.Sum({ has ? SumOfExtinction(medium, 0) : 0.0 })[0];
  const bool scatters = OnAnyRank(communicator, has && Scatters(medium));
  return AtQuality(
    quality, settings, { ShinesThroughFaces(illumination), scatters, MeanThickness(partition.whole, extinction) });
}

bool BalancesVoxels(Device& device, Communicator& communicator, const BlockPartition& partition, const Medium& medium,
  const Illumination& illumination, const PropagationSettings& settings)
{
  return ProblemInBlocks(device, communicator, partition, medium, illumination, settings).BalancesVoxels();
}

std::string ReasonNotToDecompose(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  return ProblemInBlocks(device, communicator, partition, medium, illumination, settings)
    .ReasonNotToDecompose(medium, illumination);
}
}
