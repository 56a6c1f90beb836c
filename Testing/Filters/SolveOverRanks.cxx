// A medium that ParaView's extent translator spreads over MPI ranks, solved block by block, and marched through by
// photons, against the whole on one. Run by mpiexec; a program by itself.

#include "OverRanks.h"

#include "Pieces/ControllerCommunicator.h"

#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "Photons/Marching/PhotonMarcher.h"

#include "vtkExtentTranslator.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

using namespace tyndall;

namespace
{
/// The blocks of cells that the ranks of a pipeline have of an image.
BlockPartition PartitionOf(const Grid& grid, int ranks)
{
  BlockPartition partition = { grid, {} };
  vtkNew<vtkExtentTranslator> translator;
  translator->SetWholeExtent(0, grid.size[0], 0, grid.size[1], 0, grid.size[2]);
  translator->SetNumberOfPieces(ranks);
  for (int rank = 0; rank < ranks; ++rank)
  {
    translator->SetPiece(rank);
    translator->PieceToExtent();
    int extent[6];
    translator->GetExtent(extent);
    VoxelBox block;
    for (int axis = 0; axis < 3; ++axis)
    {
      block.first[axis] = extent[2 * axis];
      block.size[axis] = std::max(0, extent[2 * axis + 1] - extent[2 * axis]);
    }
    partition.blocks.push_back(block);
  }
  return partition;
}

/// Coefficients of a block, by where voxels are in the whole.
struct Waves
{
  explicit Waves(const BlockPartition& partition, int rank)
  {
    medium.grid = partition.OwnGrid(rank);
    const VoxelBox& block = partition.blocks[rank];
    for (std::size_t i = 0; i < block.VoxelCount(); ++i)
    {
      const std::array<int, 3> at = medium.grid.VoxelAt(i);
      const double wave = std::sin(0.7 * (at[0] + block.first[0])) * std::sin(0.5 * (at[1] + block.first[1])) *
        std::sin(0.9 * (at[2] + block.first[2]));
      absorption.push_back(static_cast<float>(0.1 * (1.0 + wave)));
      scattering.push_back(static_cast<float>(0.4 * (1.0 - wave)));
      index.push_back(static_cast<float>(1.2 + 0.1 * wave));
    }
    medium.sigma_a = { absorption.data() };
    medium.sigma_s = { scattering.data() };
  }
  Waves(const Waves&) = delete;
  Waves& operator=(const Waves&) = delete;

  Medium medium;
  std::vector<float> absorption, scattering, index;
};

/// The largest difference from the light of the whole, over its largest value; of rank 0, else 0.
double DifferenceFromWhole(Communicator& communicator, const BlockPartition& partition, const LightField& own,
  const std::function<LightField()>& solveWhole)
{
  communicator.Send(0, 1, own.fluence);
  if (communicator.Rank() > 0)
  {
    return 0.0;
  }
  const LightField whole = solveWhole();
  double largest = 0.0, difference = 0.0;
  for (int rank = 0; rank < communicator.Ranks(); ++rank)
  {
    const std::vector<float> part = communicator.Receive<float>(rank, 1);
    const Grid grid = partition.OwnGrid(rank);
    for (std::size_t i = 0; i < part.size(); ++i)
    {
      std::array<int, 3> at = grid.VoxelAt(i);
      for (int axis = 0; axis < 3; ++axis)
      {
        at[axis] += partition.blocks[rank].first[axis];
      }
      const double expected = whole.fluence[partition.whole.IndexOf(at)];
      largest = std::max(largest, expected);
      difference = std::max(difference, std::abs(part[i] - expected));
    }
  }
  return difference / largest;
}

bool Solve(Communicator& communicator)
{
  Grid grid;
  grid.size = { 17, 12, 9 };
  const BlockPartition partition = PartitionOf(grid, communicator.Ranks());
  const std::shared_ptr<Device> device = Device::Find();
  Illumination shining;
  shining.sky = { 1.0, 1.0, 1.0 };
  shining.lights.emplace_back();
  PropagationSettings settings;
  settings.directionsPerFace = 9;
  const Waves block(partition, communicator.Rank());
  const LightField light = SolveConservative(*device, Domain(communicator, partition), block.medium, shining, settings);
  const double difference = DifferenceFromWhole(communicator, partition, light, [&] {
    const BlockPartition alone = { grid, { { { 0, 0, 0 }, grid.size } } };
    SingleRank single;
    return SolveConservative(*device, Domain(single, alone), Waves(alone, 0).medium, shining, settings);
  });
  if (communicator.Rank() == 0)
  {
    std::cout << communicator.Ranks() << " ranks, " << communicator.Sent().bytes << " bytes sent by rank 0; differs by "
              << difference << ", balance off by " << light.balance.RelativeError(1) << "\n";
  }
  return difference < 1e-6 && light.balance.RelativeError(1) < 1e-6;
}

/// From the middle of each voxel of a face, aslant.
std::vector<Photon> PhotonsInto(const Grid& grid)
{
  std::vector<Photon> photons;
  for (int i = 0; i < grid.size[1] * grid.size[2]; ++i)
  {
    Photon photon;
    photon.position = { 0.0, i % grid.size[1] + 0.5, i / grid.size[1] + 0.5 };
    photon.direction = { 0.8f, 0.6f * (i % 2 == 0 ? 1.0f : -1.0f), 0.0f };
    photon.power = { 1.0f, 1.0f, 1.0f };
    photons.push_back(photon);
  }
  return photons;
}

/// Bit for bit.
bool March(Communicator& communicator)
{
  Grid grid;
  grid.size = { 17, 12, 9 };
  const BlockPartition partition = PartitionOf(grid, communicator.Ranks());
  const std::shared_ptr<Device> device = Device::Find();
  const std::vector<Photon> photons = PhotonsInto(grid);
  RoundsTraffic traffic;
  const auto march = [&](Communicator& ranks, const BlockPartition& blocks) {
    const Waves block(blocks, ranks.Rank());
    MarchSettings settings;
    settings.maximumOrders = 0;
    PhotonMarcher marcher(*device, Domain(ranks, blocks), block.medium, { block.index.data(), 1 }, settings);
    const PhotonLight light = marcher.March(ranks.Rank() == 0 ? photons : std::vector<Photon>());
    traffic = marcher.Traffic();
    return light;
  };
  const PhotonLight light = march(communicator, partition);
  const RoundsTraffic ofRank = traffic;
  const double difference = DifferenceFromWhole(communicator, partition, light.light, [&] {
    SingleRank single;
    return march(single, { grid, { { { 0, 0, 0 }, grid.size } } }).light;
  });
  if (communicator.Rank() == 0)
  {
    std::cout << photons.size() << " photons, " << ofRank.handed << " handed on by rank 0 in " << ofRank.rounds
              << " rounds; light differs by " << difference << ", balance off by "
              << light.light.balance.RelativeError(1) << "\n";
  }
  return difference == 0.0 && light.scatterings > 0 && light.light.balance.RelativeError(1) < 1e-6;
}
}

int main(int argc, char* argv[])
{
  return test::RunOverRanks(argc, argv, [](vtkMPIController* controller) {
    ControllerCommunicator communicator(controller, 60.0);
    return Solve(communicator) && March(communicator);
  });
}
