#pragma once

#include "Device/Buffer.h"
#include "Device/ExactValues.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/HeldFailure.h"
#include "LatticeBoltzmann/Distributed/JoinedLine.h"
#include "LatticeBoltzmann/Distributed/PiecesOfLines.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/Steady/SteadySystem.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Lines of links through a grid whose blocks lie on several ranks, round periodic axes too (numerics.md, section 10
/// c): each rank follows its pieces of them up, all at once; who has the beginning of a line joins its pieces, and each
/// then follows its own down. The same sums as in one memory, to rounding.
class LinesInBlocks
{
public:
  /// All ranks make one together, and all of it must stay.
  /// @param settings  with the axes that are periodic in the whole grid
  /// @param lattice  of the rank's block, whose densities are written, those beyond its faces too; null: it has none
  /// @throws on every rank what any of them throws
  LinesInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition, const LatticeBox& box,
    const LatticeSettings& settings, const LatticeVoxels& voxels, const Lattice* lattice);

  /// As SteadySystem has it, of the rank's own voxels. All ranks call it.
  /// @throws on every rank what any of them throws
  SteadySystem::Values Sweep(const SteadySystem::Values& even, double shines, bool writes, const Monitor& monitor);

private:
  using Values = std::vector<double>;
  /// Pieces about which this rank and another talk, in an order that both know.
  struct Shared
  {
    int rank = 0;
    std::vector<std::size_t> pieces;
  };
  /// A line that this rank joins: of each piece the place among those of all ranks that it hears of.
  struct Line
  {
    std::vector<std::size_t> places;
    bool closed = false;
  };
  struct Pair
  {
    std::array<std::size_t, 2> range = {}; ///< of work-items
    std::vector<Shared> joinedBy;          ///< this rank's pieces, by the rank that joins their lines
    std::vector<Shared> heardOf;           ///< pieces of the lines that this rank joins, by the rank that has them
    std::vector<Line> lines;
    std::vector<PieceOfLine> parts; ///< of the pieces heard of, side by side
    ExactValues below;
  };
  /// Of a piece's numbers some.
  struct Part
  {
    std::size_t first = 0, count = 0, of = 0;
  };
  struct Slot ///< what a pair needs that is under way, as BlockLines.cl has it
  {
    ExactValues behind, share, says, joined;
  };

  void FindLines(const BlockPartition& partition, const std::array<bool, 3>& periodic);
  Pair LinesFrom(const PiecesOfLines& pieces) const;
  void TellWhoJoins(const BlockPartition& partition);
  void Load(const BlockPartition& partition, const std::array<bool, 3>& periodic);
  Values Below(const PiecesOfLines& pieces, const VoxelBox& block, int pair) const;
  void LearnParts();
  void Give(const std::vector<Shared>& to, int tag, Part part, const Values& values);
  Values Take(const std::vector<Shared>& from, int tag, std::size_t width);
  void GoUp(int pair, Slot& slot, double shines, Part says);
  void Join(int pair);
  void SolveCg(int pair, Slot& slot, double shines, bool writes);
  cl::Kernel Kernel(const char* name, int pair, double shines) const;
  void Run(cl::Kernel& kernel, int pair);

  Device& TheDevice;
  Communicator& Comm;
  const LatticeBox& Box;
  const LatticeSettings& Settings;
  const LatticeVoxels& Voxels;
  const Lattice* Densities;
  std::vector<Pair> Pairs;
  std::vector<Slot> Slots;
  std::size_t MostPieces = 1;
  ExactValues Straight, Even, Arriving;
  Buffer<float> Passes, Squared, Endless;
  HeldFailure Failure; ///< of a sweep
  double Work = 0.0;
};
}
