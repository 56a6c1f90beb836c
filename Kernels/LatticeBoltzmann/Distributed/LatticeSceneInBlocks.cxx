#include "LatticeBoltzmann/Distributed/LatticeSceneInBlocks.h"

#include "LatticeBoltzmann/LatticeLight.h"
#include "LightPropagation/Convergence.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tyndall
{
namespace
{
/// Known round what a rank steps: what lamps' light does in voxels depends on those next to the next ones.
constexpr int Layers = 2;

Medium OwnOf(const BlockPartition& partition, int rank, bool has, const Medium& medium)
{
  Medium own = has ? medium : Medium();
  own.grid = partition.OwnGrid(rank);
  return own;
}

Illumination WithKnown(Illumination illumination, const MediumAround& known)
{
  illumination.uncollided = known.uncollided;
  return illumination;
}

BlockPartition WithWhole(BlockPartition partition, const Grid& whole)
{
  partition.whole = whole;
  return partition;
}

/// Sums over ranks of what each counted.
void AddUp(Communicator& communicator, LightField& light)
{
  EnergyBalance& balance = light.balance;
  std::vector<Rgb*> counted = { &balance.entered, &balance.emitted, &balance.absorbed, &balance.escaped };
  for (Rgb& face : light.facePowerOut)
  {
    counted.push_back(&face);
  }
  std::vector<double> values;
  for (const Rgb* rgb : counted)
  {
    values.insert(values.end(), rgb->begin(), rgb->end());
  }
  values = communicator.Sum(values);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    (*counted[i / 3])[i % 3] = values[i];
  }
  for (std::size_t c = 0; c < 3; ++c)
  {
    balance.leftOver[c] = balance.entered[c] + balance.emitted[c] - balance.absorbed[c] - balance.escaped[c];
  }
}
}

PropagationSettings AsPropagationInBlocks(const LatticeSettings& settings)
{
  PropagationSettings of = AsPropagation(settings);
  of.angularDegree = 0;
  return of;
}

LatticeSceneInBlocks::LatticeSceneInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Field& ior, const Illumination& illumination, const LatticeSettings& settings)
  : has(partition.blocks[communicator.Rank()].VoxelCount() > 0)
  , around(communicator, partition, settings.periodic, Layers)
  , known(this->around, OwnOf(partition, communicator.Rank(), this->has, medium), this->has ? ior : Field(),
      this->has ? illumination.uncollided : UncollidedImage())
  , scene(communicator, this->has, partition, this->known.medium, WithKnown(illumination, this->known),
      AsPropagationInBlocks(settings), MemoryOf(device))
  , partition(WithWhole(partition, this->scene.WholeOf(partition.whole)))
{
}

LatticeBox LatticeSceneInBlocks::Box() const
{
  const LatticeBox own = BoxOf(this->around);
  return { this->scene.medium.grid, own.own, own.innerFaces };
}

void FinishLight(LightField& light, const Device& device, Communicator& communicator, const LatticeSceneInBlocks& scene,
  const Illumination& illumination, const LatticeSettings& settings, double thickest, const Rgb& lost)
{
  AddUp(communicator, light);
  const std::vector<double> all = communicator.Sum({ lost[0], lost[1], lost[2] });
  CountLost({ all[0], all[1], all[2] }, light.balance);
  const BlockScene& solved = scene.scene;
  const bool anisotropic =
    OnAnyRank(communicator, scene.has && !solved.medium.phase.IsIsotropic()) && solved.traits.scatters;
  communicator.Collective([&] { DescribeLight(light, device, anisotropic, settings, thickest); });
  if (settings.scheme == LatticeScheme::Conservative)
  {
    JudgeBalance(light, communicator, scene.has, solved.medium);
  }
  communicator.Collective([&] {
    solved.Undo(light);
    JudgeLight(light, illumination, settings);
  });
}
}
