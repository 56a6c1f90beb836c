#pragma once

#include "Device/ExactValues.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LightPropagation/CoarseDiffusion/CoarseDiffusion.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// Coarse-mesh DSA of one channel, as CoarseDiffusion (numerics.md, section 7.13), on a grid that is distributed over
/// ranks and has no periodic axis. Cells are those of the whole grid, whichever ranks own their voxels. The first rank
/// solves the system; all ranks store the values of all cells, at most an eighth of the number of voxels.
class CellsOverRanks
{
public:
  /// @param communicator, partition, medium  must outlive this object
  /// @param layout  of the rank's block
  /// @param halvings  along each axis; cells have 2^halvings voxels
  /// @param linear  light varies linearly across voxels rather than being constant in each
  CellsOverRanks(Device& device, Communicator& communicator, const BlockPartition& partition,
    const VolumeLayout& layout, int channel, const MediumOnDevice& medium, const std::array<int, 3>& halvings,
    bool linear);

  using Powers = CoarseDiffusion::Powers; ///< summed over all ranks

  /// Computes the next source from the path integrals of a sweep, as CoarseDiffusion::ScatterOrder(). Collective.
  /// @param path  W length, [channel][stride]; replaced by the (negative) path to subtract from the next sweep's
  /// @param fluence  W / length^2, added to
  /// @param source  W / (length^3 sr), replaced
  /// @param guess  path of all later orders, W length, to use instead of the cells' solution; null, on all ranks: use
  ///   the solution
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
  Grid Cells;           ///< only its size is used
  CoarseCells Box = {}; ///< cells of the whole grid
  std::size_t First;    ///< offset of the channel
  bool Linear;
  VoxelBox Held;                           ///< the block and, if light is linear across voxels, its halo
  Values SigmaT, SigmaS;                   ///< 1/length, of the voxels in `Held`
  std::unique_ptr<MultigridSolver> Solver; ///< on the first rank; else null
  ExactValues FoundOnDevice;
  std::vector<double> Borders; ///< as in CoarseMatrix
  std::vector<double> Found;   ///< W / length^2, by cells
};
}
