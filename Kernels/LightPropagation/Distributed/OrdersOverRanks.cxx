#include "LightPropagation/Distributed/OrdersOverRanks.h"

#include "Medium/VoxelSums.h"

#include <algorithm>
#include <vector>

namespace tyndall
{
namespace
{
/// Of all ranks, lines through the whole grid: as many values as its surface has, no more.
ThickLines LinesOfAll(Communicator& communicator, const BlockPartition& partition, const Medium& medium, int channel)
{
  const VoxelBox& block = partition.blocks[communicator.Rank()];
  LineSums all;
  for (int axis = 0; axis < 3; ++axis)
  {
    all[axis].assign(partition.whole.VoxelCount() / static_cast<std::size_t>(partition.whole.size[axis]), 0.0);
  }
  if (block.VoxelCount() > 0)
  {
    const LineSums own =
      SumAlongLines(medium.grid, [&](std::size_t i) { return double(medium.TransportSigmaT(i, channel)); });
    for (int axis = 0; axis < 3; ++axis)
    {
      const PlaneAxes axes = AcrossAxis(axis);
      for (std::size_t i = 0; i < own[axis].size(); ++i)
      {
        const std::size_t width = block.size[axes.u];
        const std::size_t u = block.first[axes.u] + i % width, v = block.first[axes.v] + i / width;
        all[axis][v * partition.whole.size[axes.u] + u] = own[axis][i];
      }
    }
  }
  for (std::vector<double>& ofAxis : all)
  {
    ofAxis = communicator.Sum(ofAxis);
  }
  return { partition.whole, all };
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

OrdersOverRanks HowOrdersAreAdded(Communicator& communicator, const BlockPartition& partition, const BlockScene& scene,
  const PropagationSettings& settings)
{
  OrdersOverRanks orders;
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
    orders.how = inCells ? OrdersAdded::ByCells : OrdersAdded::ByBalance;
  }
  return orders;
}
}
