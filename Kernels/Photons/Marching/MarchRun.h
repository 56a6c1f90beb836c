#pragma once

#include "Device/Batches.h"
#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Marching/MarchShared.h"
#include "Photons/Marching/PhotonPacking.h"

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace tyndall
{
/// Number of copies of the sums of deposits, and the work-items that add to each copy. Work-item w adds to copies w,
/// w + workers, ...; copy c belongs to batch c % batches.
struct MarchShares
{
  bool atomics = false; ///< whether deposits are added by 64-bit atomics
  /// Number of work-items, which fetch photons from a common counter. 0: one work-item per packet (vector of photons);
  /// all photons of a batch then add to one copy.
  int workers = 0;
  int copies = 1;
  int batches = 1;
};

/// Chooses the number of copies of the sums from the settings and the device's free memory.
/// @param records  records in one copy of the sums
/// @param numbers  64-bit numbers in a record
/// @param held     bytes already allocated for sums, which the new sums will reuse
/// @throws DeviceError if the settings ask for atomics that the device lacks, or the sums of all batches do not fit
MarchShares ShareSums(const MarchMedium& medium, std::size_t records, int numbers, int batches, std::size_t held);

/// The buffer to which photons deposit their light, and its layout.
struct MarchSums
{
  MarchShares shares;
  std::size_t records = 0; ///< records in one copy: voxels of the padded grid, records of bricks, or coarse cells
  int numbers = 1;         ///< 64-bit numbers in a record
  bool directions = false; ///< whether a record holds the sums of power times direction
  bool counts = false;     ///< whether a record counts the photons that crossed its voxel
  /// Index of the coarse cell of each voxel, if deposits are summed in coarse cells, which also count photons. Null:
  /// deposits are summed in voxels.
  const Buffer<cl_int>* cells = nullptr;
  const Buffer<cl_long>* sums = nullptr; ///< sums of deposits in fixed point, [copy][record][number]

  /// Number of 64-bit numbers in one copy of the sums.
  std::size_t Stride() const { return this->records * static_cast<std::size_t>(this->numbers); }
};

inline const int* WhereIs(const PhotonOnItsWay& photon)
{
  return photon.way.voxel;
}

/// Photons on a device, ordered by batch: photons that start, or photons that arrived from other blocks.
struct PhotonsOnDevice
{
  /// Uploads photons that start.
  /// @param marks  one 64-bit integer per packed photon, which counts the photon or tells its origin (PhotonMarch.cl);
  ///   empty if photons are not counted
  PhotonsOnDevice(Device& device, const PackedPhotons& packed, const std::vector<cl_ulong>& marks = {});
  PhotonsOnDevice(Device& device, std::vector<PhotonOnItsWay> arrived, int batches, int channels);

  const cl::Buffer& Handle() const { return this->resumes ? this->arrived.Handle() : this->starting.Handle(); }
  std::size_t LargestBatch() const; ///< number of photons in the largest batch

  bool resumes;                   ///< whether the photons arrived from other blocks; false: they start in this block
  Buffer<float> starting;         ///< photons that start in this block, as PackedPhotons::values
  Buffer<PhotonOnItsWay> arrived; ///< photons that arrived from other blocks
  std::vector<int> begins;        ///< index of the first photon of each batch, and one past the last photon
  Buffer<cl_int> batchBegin;
  Buffer<cl_ulong> marks;
  Buffer<cl_int> ends; ///< final state (PhotonEnd) and remaining power of each photon, which the kernel writes
};

/// A kernel of PhotonMarch.cl that adds the deposits of photons to MarchSums.
class MarchKernel
{
public:
  /// Builds the kernel `name` of PhotonMarch.cl.
  /// @param options  definitions of macros that do not follow from the medium and the sums
  MarchKernel(const MarchMedium& medium, const MarchSums& target, int channels, const std::string& options = {},
    const char* name = "march_photons");

  /// Sets the arguments that all variants of the kernel share.
  /// @return number of arguments that were set
  cl_uint Set(const PhotonsOnDevice& photons, MarchLaunch launch, const Buffer<cl_int>& counters);
  /// Global range of work-items for `photons` in each batch.
  cl::NDRange Range(std::size_t photons) const;
  cl::NDRange Group() const; ///< size of work-groups

  cl::Kernel kernel;

private:
  const MarchMedium& Medium;
  const MarchSums& Target;
  Buffer<cl_int> None;
};

/// Sizes of the launches of a kernel that follows photons.
/// @param photons  number of photons in the largest batch
/// @param first  photons in the first launch
/// @param whole  each launch has a multiple of this number of photons
Batches PhotonLaunches(
  const MarchMedium& medium, std::size_t photons, std::size_t first, std::size_t whole, int batches);

/// Appends the first `count` photons of a buffer to `all`.
template <class OnItsWay>
void AppendPhotons(const Buffer<OnItsWay>& photons, int count, std::vector<OnItsWay>& all)
{
  const std::size_t before = all.size(), more = static_cast<std::size_t>(count);
  all.resize(before + more);
  photons.Read(all.data() + before, more);
}

/// Marches photons through a rank's block to their ends or, if there are other blocks, until they leave it.
class MarchRun
{
public:
  /// Compiles the kernel for photons of `channels` power channels.
  /// @param medium, target  referenced, not copied
  /// @param channels  number of power channels of the photons
  MarchRun(const MarchMedium& medium, const MarchSums& target, int channels)
    : Medium(medium)
    , Target(target)
    , Channels(channels)
    , Kernel(medium, target, channels)
  {
  }

  /// Result of marching some photons.
  struct Outcome
  {
    std::vector<cl_int> ends; ///< final state (PhotonEnd) and remaining power of each photon, the input of Tally
    std::vector<PhotonOnItsWay> gone; ///< photons that entered other blocks, in any order
  };
  /// Marches photons that start in this block.
  /// @param marks  one 64-bit integer per photon for counting (PhotonMarch.cl); empty if photons are not counted
  /// @throws Aborted; the sums then hold only a part of the photons' deposits
  Outcome Start(const PackedPhotons& photons, const std::vector<cl_ulong>& marks, const Monitor& monitor);
  /// Marches photons that arrived from other blocks to their ends or until they leave this block.
  /// @throws Aborted
  Outcome Resume(std::vector<PhotonOnItsWay> arrived, const Monitor& monitor);

private:
  Outcome March(const PhotonsOnDevice& photons, const Monitor& monitor);

  const MarchMedium& Medium;
  const MarchSums& Target;
  int Channels;
  MarchKernel Kernel;
};

/// Traces the paths of photons through the domain as lists of their corners, and joins the parts traced in different
/// blocks. Collective.
/// @param through  medium of this rank's block; null if it has no voxels
/// @param photons  the same on all ranks
/// @param numbers  indices of the photons to trace
/// @return the paths on rank 0, ascending by photon index; nothing on other ranks
std::vector<PhotonPath> TracePaths(const Domain& domain, const MarchMedium* through, const std::vector<Photon>& photons,
  const std::vector<std::size_t>& numbers, int eventLimit);

/// Device times, s, of a march in turns. A turn is a launch that follows photons over a limited number of path
/// segments.
struct TurnTimes
{
  int turns = 0;          ///< number of turns
  double marching = 0.0;  ///< time of the marching kernels
  double meanwhile = 0.0; ///< time of the work queued by MarchTurns::meanwhile
  double together = 0.0;  ///< time during which march and `meanwhile` were running concurrently
};

/// Callbacks of a march in turns. In each turn photons march a limited number of path segments, while the light
/// deposited in earlier turns is processed (Bernabei et al., section III-A).
struct MarchTurns
{
  /// Number of path segments (from voxel wall to voxel wall) that a photon marches per turn. 0: a single turn, to the
  /// photon's end.
  int stretches = 16;
  /// Whether photons march on a separate command queue, concurrently with the processing of light (`meanwhile`). False:
  /// one queue for both.
  bool sideBySide = true;
  /// Called once before the first turn (launch over a limited number of path segments).
  /// @param photons  the packed photons
  /// @param channels  number of channels of the fluence that `take` receives
  std::function<void(const PackedPhotons& photons, int channels)> begin;
  /// Queues the processing of the light deposited in earlier turns, without waiting for it. Returns the events of the
  /// first and the last queued command.
  std::function<std::array<cl::Event, 2>(const cl::CommandQueue& queue)> meanwhile;
  /// Queues the transfer of the light accumulated since the march began.
  /// @param fluence  W / length^2, [voxel][channel]
  std::function<void(const cl::CommandQueue& queue, const Buffer<float>& fluence)> take;
  TurnTimes times; ///< output: device times of the march
};

/// Marches photons to their ends in turns. Each turn is a launch over a limited number of path segments (MarchTurns).
/// @param show  queues the conversion of the sums accumulated so far to fluence
/// @throws DeviceError if the states of the photons do not fit into the device's memory; Aborted: the sums then hold
///   only a part of the paths
void MarchInTurns(const MarchMedium& medium, const PackedPhotons& packed, const PhotonsOnDevice& photons,
  const MarchSums& target, MarchTurns& turns,
  const std::function<const Buffer<float>&(const cl::CommandQueue& queue)>& show, const Monitor& monitor);
}
