#pragma once

#include "Device/ExactValues.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LightPropagation/CoarseDiffusion/CoarseDiffusion.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"
#include "LightPropagation/Problem/MediumOnDevice.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// Diffusion of one channel on cells of voxels, as CoarseDiffusion.h has it (numerics.md, section 7.13), of a grid that
/// is spread over ranks, in an open box: cells are those of the whole grid, whichever ranks have their voxels. The
/// first rank solves the system; all hold values by cells, an eighth of the voxels at most.
class CellsOverRanks
{
public:
  /// @param communicator, partition, medium  must stay
  /// @param layout  of the rank's block
  /// @param halvings  along each axis; cells have 2^halvings voxels
  /// @param linear  light is taken as linear across voxels, not as constant in each
  CellsOverRanks(Device& device, Communicator& communicator, const BlockPartition& partition,
    const VolumeLayout& layout, int channel, const MediumOnDevice& medium, const std::array<int, 3>& halvings,
    bool linear);

  using Powers = CoarseDiffusion::Powers; ///< of all ranks

  /// From the path integrals of a sweep to the next source, as CoarseDiffusion::ScatterOrder. All ranks call it.
  /// @param path  W length, [channel][stride]; replaced by what the next sweep is to have less
  /// @param fluence  W / length^2, added to
  /// @param source  W / (length^3 sr), replaced
  /// @param guess  W length, of all orders to come, in the place of the cells' solution; null, on all ranks: that
  Powers ScatterOrder(
    Buffer<float>& path, Buffer<float>& fluence, Buffer<float>& source, const Buffer<float>* guess = nullptr);

private:
  using Values = std::vector<float>;
  std::vector<double> SumByCells(const Values& ofVoxels);
  double Solve(const Values& scattered, bool guessed);
  void AddComing(Values& light, const Buffer<float>* guess);
  double FoundAt(const std::array<int, 3>& voxel) const;
  Values WithNeighbours(const Values& own);
  std::size_t PlaceOf(const std::array<int, 3>& voxel) const;
  double ScatteredIn(const std::array<int, 3>& voxel, const Values& light, std::array<double, 6>& kept) const;

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  VolumeLayout Layout;
  Grid Cells;           ///< their number alone
  CoarseCells Box = {}; ///< of the whole grid
  std::size_t First;    ///< of the channel
  bool Linear;
  VoxelBox Held;                           ///< the block and, where light is linear, the voxels beside it
  Values SigmaT, SigmaS;                   ///< of these
  std::unique_ptr<MultigridSolver> Solver; ///< of the first rank, else null
  ExactValues FoundOnDevice;
  std::vector<double> Borders; ///< as CoarseMatrix has them
  std::vector<double> Found;   ///< W / length^2, by cells
};
}
