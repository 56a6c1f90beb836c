#pragma once

#include "Device/Buffer.h"
#include "Device/ExactValues.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/HeldFailure.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/Steady/SteadySystem.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// Lines of links through a grid whose blocks lie on several ranks: each follows its part of them up, when it knows
/// what comes from the blocks before, and down, when it knows what comes from those behind (numerics.md, section 10 c).
/// The same sums as in one memory, to rounding; three pairs of directions are under way at a time.
class LinesInBlocks
{
public:
  /// All ranks make one together, and all of it must stay.
  /// @param lattice  of the rank's block, whose densities are written, those beyond its faces too; null: it has none
  /// @throws InvalidInput on each where blocks wait for each other: no planes cut them apart one after the other
  LinesInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition, const LatticeBox& box,
    const LatticeSettings& settings, const LatticeVoxels& voxels, const Lattice* lattice);

  /// As SteadySystem has it, of the rank's own voxels. All ranks call it.
  /// @throws on every rank what any of them throws
  SteadySystem::Values Sweep(const SteadySystem::Values& even, double shines, bool writes, const Monitor& monitor);

private:
  using Values = std::vector<double>;
  struct Contact ///< lines go from one block to another
  {
    int rank = 0;
    std::vector<std::size_t> lines; ///< of this block, in an order that both know
  };
  struct Pair
  {
    std::array<std::size_t, 2> range = {}; ///< of work-items
    std::vector<Contact> before, behind;
  };
  struct Slot ///< what a pair needs that is under way, as BlockLines.cl has it
  {
    ExactValues behind, before, last, after, first;
  };

  Pair ContactsOf(int pair) const;
  std::size_t LineOf(int pair, std::array<int, 3> voxel) const;
  void Load();
  Values TakeFrom(const std::vector<Contact>& contacts, int tag, int values);
  void GiveTo(const std::vector<Contact>& contacts, int tag, int values, const Values& ofLines);
  void GoUp(int pair, Slot& slot, double shines);
  void GoDown(int pair, Slot& slot, double shines, bool writes);
  cl::Kernel Kernel(const char* name, int pair, double shines) const;
  void Run(cl::Kernel& kernel, int pair);

  Device& TheDevice;
  Communicator& Others;
  const BlockPartition& Partition;
  const LatticeBox& Box;
  const LatticeSettings& Settings;
  const LatticeVoxels& Voxels;
  const Lattice* Densities;
  std::vector<Pair> Pairs;
  std::vector<Slot> Slots;
  std::size_t MostLines = 1;
  ExactValues Straight, Even, Arriving;
  Buffer<float> Passes, Squared;
  HeldFailure Failure; ///< of a sweep
  double Work = 0.0;
};
}
