#include "LightPropagation/Distributed/Balance/OrdersOverRanks.h"

#include "Medium/VoxelSums.h"

#include <algorithm>
#include <vector>

namespace tyndall
{
namespace
{
constexpr int LinesTag = 29996; ///< not one of those that others take (GhostCells.cxx)

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

/// Of all ranks. The first one has the sums along lines through the whole grid: as many as its surface has cells.
ThickLines LinesOfAll(Communicator& communicator, const BlockPartition& partition, const Medium& medium, int channel)
{
  std::vector<double> own;
  communicator.Together([&] {
    const LineSums sums =
      SumAlongLines(medium.grid, [&](std::size_t i) { return double(medium.TransportSigmaT(i, channel)); });
    for (const std::vector<double>& ofAxis : sums)
    {
      own.insert(own.end(), ofAxis.begin(), ofAxis.end());
    }
  });
  ThickLines lines;
  if (communicator.Rank() > 0)
  {
    communicator.Send(0, LinesTag, own);
  }
  else
  {
    LineSums all;
    for (int axis = 0; axis < 3; ++axis)
    {
      all[axis].assign(partition.whole.VoxelCount() / static_cast<std::size_t>(partition.whole.size[axis]), 0.0);
    }
    AddLines(partition, 0, own, all);
    for (int rank = 1; rank < communicator.Ranks(); ++rank)
    {
      AddLines(partition, rank, communicator.Receive<double>(rank, LinesTag), all);
    }
    lines = ThickLines(partition.whole, all);
  }
  const std::vector<double> found = communicator.Sum(
    { lines.along[0], lines.along[1], lines.along[2], lines.uneven ? 1.0 : 0.0 }); // the other ranks have zeros
  std::copy_n(found.begin(), 3, lines.along.begin());
  lines.uneven = found[3] > 0.0;
  return lines;
}

/// Of what is scattered, in the mean.
double AlbedoOfAll(Communicator& communicator, const Medium& medium, int channel)
{
  const auto sigmaS = [&](std::size_t i) { return double(medium.TransportSigmaS(i, channel)); };
  const auto albedo = [&](std::size_t i) {
    const double s = sigmaS(i);
    return s > 0.0 ? s * s / (s + medium.sigma_a.At(i, channel)) : 0.0;
  };
  const std::vector<double> sums =
    communicator.Sum({ SumOverVoxels(medium.grid, sigmaS), SumOverVoxels(medium.grid, albedo) });
  return sums[0] > 0.0 ? sums[1] / sums[0] : 0.0;
}

double ThickestOfAll(Communicator& communicator, const Medium& medium, int channels)
{
  double thickest = 0.0;
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      thickest = std::max<double>(thickest, medium.TransportSigmaT(i, c));
    }
  }
  return communicator.Largest({ thickest })[0];
}
}

namespace
{
/// What neither cells nor the balance of voxels carry from rank to rank.
bool IsBeyondBoth(Communicator& communicator, const BlockScene& scene, const PropagationSettings& settings)
{
  const bool own = scene.Scattering().Degree() > 0 || Reflects(scene.illumination) || settings.periodic[0] ||
    settings.periodic[1] || settings.periodic[2];
  return communicator.Largest({ own ? 1.0 : 0.0 })[0] > 0.0; // a rank without voxels scatters evenly
}
}

OrdersOverRanks HowOrdersAreAdded(Communicator& communicator, const BlockPartition& partition, const BlockScene& scene,
  const PropagationSettings& settings)
{
  OrdersOverRanks orders;
  if (IsBeyondBoth(communicator, scene, settings))
  {
    return orders;
  }
  const bool balances = !settings.facePower && settings.uncollidedDirections <= 0;
  if (settings.source == PropagationSource::Linear)
  {
    orders.how = OrdersAdded::ByBalance; // the source of orders and of cells is constant here
    return orders;
  }
  if (settings.acceleration != PropagationAcceleration::Automatic || settings.maximumOrders > 0 ||
    !scene.traits.scatters)
  {
    return orders;
  }
  orders.halvings = CellHalvings(partition.whole, ThickestOfAll(communicator, scene.medium, scene.channels));
  const bool inCells = AreThinEnough(partition.whole, orders.halvings);
  std::vector<IsotropicChannel> channels;
  for (int c = 0; c < scene.channels; ++c)
  {
    channels.push_back(
      { LinesOfAll(communicator, partition, scene.medium, c), AlbedoOfAll(communicator, scene.medium, c) });
  }
  if (ScatteredManyTimes(channels, inCells))
  {
    orders.how = inCells ? OrdersAdded::ByCells : balances ? OrdersAdded::ByBalance : OrdersAdded::OneByOne;
  }
  return orders;
}
}
