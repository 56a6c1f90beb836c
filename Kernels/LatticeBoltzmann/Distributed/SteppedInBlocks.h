#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/HeldFailure.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/Settling.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// A lattice whose blocks lie on several ranks and step together: before each step a block gets what the voxels around
/// it send into it, round periodic axes too. Each step is that of one memory. Blocks of voxels that step by themselves
/// (LatticeSettings::blockSize) get it before each of their exchanges; of those that lie on several ranks each of these
/// ranks steps all voxels.
class SteppedInBlocks : public SteppedLattice
{
public:
  /// All ranks make one together, and all of it must stay.
  /// @param settings  with the axes that are periodic in the whole grid
  /// @param box  voxels of the lattice, in the whole grid: the rank's block, or whole blocks that step by themselves
  /// @param lattice  null: the rank has none
  SteppedInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
    const LatticeSettings& settings, const VoxelBox& box, Lattice* lattice);

  /// All ranks call it.
  /// @throws on every rank what any of them throws
  void Step(int steps, double done, const Monitor& monitor) override;
  /// Once all steps are done, with what voxels around the block send then. All ranks call it.
  void FillAround();
  std::vector<float> Probed() const override;
  std::vector<float> Fluence() const override; ///< of the rank's block
  std::vector<double> Sum(const std::vector<double>& ofRank) override { return this->Comm.Sum(ofRank); }
  void Alone(const std::function<void()>& work) override { this->Comm.Collective(work); }

private:
  using Voxel = std::array<int, 3>;
  /// Densities that go to each rank, or come from it, one after the other.
  struct Parcels
  {
    std::vector<std::size_t> counts; ///< by rank
    Buffer<cl_ulong> places;
  };

  bool Has() const { return this->TheLattice != nullptr; }
  template <class Act>
  void ForComing(const BlockPartition& partition, const Act& act) const;
  void FindParcels(const BlockPartition& partition);
  cl_ulong PlaceOf(int direction, const Voxel& voxel) const;
  void FindProbes(const BlockPartition& partition);
  void Exchange();

  Device& TheDevice;
  Communicator& Comm;
  const LatticeSettings& Settings;
  const VoxelBox Own, Box;
  Lattice* TheLattice;
  Parcels Sends, Gets;
  bool LooksAtAll = true;
  Buffer<cl_int> Probes; ///< of the rank's own voxels
  HeldFailure Failure;   ///< of some steps
};
}
