#include "LightPropagation/Distributed/Balance/OrdersOverRanks.h"

#include "Distribution/MessageTags.h"
#include "Medium/VoxelSums.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace tyndall
{
namespace
{
/// Adds what a block has of the whole grid's lines.
void AddLines(const BlockPartition& partition, int rank, const std::vector<double>& ofBlock, LineSums& all)
{
  const VoxelBox& block = partition.blocks[rank];
  auto next = ofBlock.begin();
  for (int axis = 0; axis < 3; ++axis)
  {
    const PlaneAxes axes = AcrossAxis(axis);
    for (int v = 0; v < block.size[axes.v] && next != ofBlock.end(); ++v)
    {
      const std::size_t row = static_cast<std::size_t>(block.first[axes.v] + v) * partition.whole.size[axes.u];
      for (int u = 0; u < block.size[axes.u]; ++u)
      {
        all[axis][row + block.first[axes.u] + u] += *next++;
      }
    }
  }
}

using VoxelValue = std::function<double(std::size_t voxel)>;

/// Of all ranks. The first one has the sums along lines through the whole grid: as many as its surface has cells.
/// @param sigma_t  of the block's voxels
ThickLines LinesOfAll(
  Communicator& communicator, const BlockPartition& partition, const Grid& own, const VoxelValue& sigma_t)
{
  std::vector<double> ofBlock;
  communicator.Collective([&] {
    const LineSums sums = SumAlongLines(own, sigma_t);
    for (const std::vector<double>& ofAxis : sums)
    {
      ofBlock.insert(ofBlock.end(), ofAxis.begin(), ofAxis.end());
    }
  });
  ThickLines lines;
  if (communicator.Rank() > 0)
  {
    communicator.Send(0, MessageTag::SumsAlongLines, ofBlock);
  }
  else
  {
    LineSums all;
    for (int axis = 0; axis < 3; ++axis)
    {
      all[axis].assign(partition.whole.VoxelCount() / static_cast<std::size_t>(partition.whole.size[axis]), 0.0);
    }
    AddLines(partition, 0, ofBlock, all);
    for (int rank = 1; rank < communicator.Ranks(); ++rank)
    {
      AddLines(partition, rank, communicator.Receive<double>(rank, MessageTag::SumsAlongLines), all);
    }
    lines = ThickLines(partition.whole, all);
  }
  const std::vector<double> found = communicator.Sum(
    { lines.along[0], lines.along[1], lines.along[2], lines.uneven ? 1.0 : 0.0 }); // the other ranks have zeros
  std::copy_n(found.begin(), 3, lines.along.begin());
  lines.uneven = found[3] > 0.0;
  return lines;
}

/// Of what is scattered as sweeps carry it, in the mean.
double AlbedoOfAll(Communicator& communicator, const BlockScene& scene, int channel)
{
  const auto sigmaS = [&](std::size_t i) { return double(scene.Scattering().SigmaS(i, channel)); };
  const auto albedo = [&](std::size_t i) {
    const double s = sigmaS(i);
    return s > 0.0 ? s * s / (s + scene.medium.sigma_a.At(i, channel)) : 0.0;
  };
  const Grid& grid = scene.medium.grid;
  const std::vector<double> sums = communicator.Sum({ SumOverVoxels(grid, sigmaS), SumOverVoxels(grid, albedo) });
  return sums[0] > 0.0 ? sums[1] / sums[0] : 0.0;
}

/// As sweeps carry light.
double ThickestOfAll(Communicator& communicator, const BlockScene& scene)
{
  double thickest = 0.0;
  for (std::size_t i = 0; i < scene.medium.grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < scene.channels; ++c)
    {
      thickest = std::max<double>(thickest, scene.Scattering().SigmaT(i, c));
    }
  }
  return communicator.Largest({ thickest })[0];
}

ScatteringOfScene ScatteringOfAll(Communicator& communicator, const BlockPartition& partition, const BlockScene& scene,
  const PropagationSettings& settings)
{
  const Grid& own = scene.medium.grid;
  ScatteringOfScene all = { partition.whole, settings.periodic, scene.illumination.faceAlbedo,
    scene.Scattering().Degree(), false, ThickestOfAll(communicator, scene), {} };
  for (int c = 0; c < scene.channels; ++c)
  {
    ScatteringOfChannel channel;
    channel.diffusing =
      LinesOfAll(communicator, partition, own, [&](std::size_t i) { return scene.medium.TransportSigmaT(i, c); });
    if (all.degree > 0)
    {
      channel.swept =
        LinesOfAll(communicator, partition, own, [&](std::size_t i) { return scene.Scattering().SigmaT(i, c); });
    }
    channel.albedo = AlbedoOfAll(communicator, scene, c);
    all.channels.push_back(channel);
  }
  return all;
}

/// What cells do not carry from rank to rank.
bool GoesRound(const PropagationSettings& settings)
{
  return settings.periodic[0] || settings.periodic[1] || settings.periodic[2];
}

/// How blocks do it.
IterationScheme InBlocks(IterationScheme ofWhole, const PropagationSettings& settings)
{
  if (settings.source == PropagationSource::Linear)
  {
    return IterationScheme::Dsa;
  }
  const bool balances = settings.uncollidedDirections <= 0;
  const bool has = ofWhole == IterationScheme::Dsa ? balances : !GoesRound(settings);
  return has ? ofWhole : IterationScheme::SourceIteration;
}
}

OrdersOverRanks ChooseIterationScheme(Communicator& communicator, const BlockPartition& partition,
  const BlockScene& scene, const PropagationSettings& settings)
{
  OrdersOverRanks orders;
  const bool accelerates = MayBeAccelerated(settings, scene.traits.scatters);
  if (!accelerates && settings.uncollidedDirections >= 0)
  {
    return orders;
  }
  const ScatteringOfScene all = ScatteringOfAll(communicator, partition, scene, settings);
  orders.needed = OrdersNeeded(all);
  orders.halvings = CellHalvings(all.grid, all.thickest);
  orders.ofWhole = ChooseIterationScheme(settings, scene.traits.scatters, all);
  orders.how = InBlocks(orders.ofWhole, settings);
  return orders;
}
}
