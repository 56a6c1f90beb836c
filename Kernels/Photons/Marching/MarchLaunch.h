#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Marching/PhotonPacking.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// How many copies of the sums there are, and who adds to which. Work-item w serves copies w, w + workers, ...; copy c
/// is for batch c % batches.
struct MarchShares
{
  bool atomics = false;
  int workers = 0; ///< work-items that take photons as they come; 0: one per packet, and all of a batch add to its copy
  int copies = 1;
  int batches = 1;
};

/// As the settings ask for.
/// @param records  of a copy of the sums
/// @param numbers  of 64 bits, in a record
/// @param held     bytes in use that new sums will take over
/// @throws DeviceError where the device has no atomics and they are asked for, or the sums of all batches do not fit
MarchShares ShareSums(const MarchMedium& medium, std::size_t records, int numbers, int batches, std::size_t held);

/// Photons on a device, and their ends.
struct PhotonsOnDevice
{
  /// @param marks  of each photon as packed, by which it counts; empty where none are counted
  PhotonsOnDevice(Device& device, const PackedPhotons& packed, const std::vector<cl_ulong>& marks = {});

  Buffer<float> values;
  Buffer<cl_ulong> marks;
  Buffer<cl_int> batchBegin;
  Buffer<cl_int> ends; ///< PhotonEnd and the power of each
};

/// What photons deposit, and where.
struct MarchSums
{
  MarchShares shares;
  std::size_t records = 0;               ///< of a copy: voxels of the padded grid, records of bricks, or cells
  int numbers = 1;                       ///< of a record
  bool directions = false;               ///< are among them
  bool counts = false;                   ///< and photons that crossed voxels
  const Buffer<cl_int>* cells = nullptr; ///< of voxels: cells are deposited, and count; null: voxels are deposited
  const Buffer<cl_long>* sums = nullptr; ///< [copies][records][numbers]
};

/// A kernel of PhotonMarch.cl that adds to such sums, march_photons but with TURNS.
cl::Kernel MarchKernelFor(
  const MarchMedium& medium, const MarchSums& target, int channels, const char* name, const std::string& options = {});

constexpr int MarchBlock = 512; ///< neighbouring photons that one work-item takes one after the other

/// March photons to their ends.
/// @throws Aborted: the sums are of a part of the photons then
void MarchPhotons(const MarchMedium& medium, const PackedPhotons& packed, const PhotonsOnDevice& photons,
  const MarchSums& target, const Monitor& monitor);

constexpr double SecondsPerLaunch = 0.1;             ///< of a kernel that follows photons
constexpr std::size_t MarchedBetweenBlocks = 262144; ///< photons of a launch: 30 MiB of those that go on

/// Room on a device for photons that a launch of a kernel puts, in any order, where they go on in other blocks.
template <class OnItsWay>
class GonePhotons
{
public:
  /// @param marched  photons of a launch at most
  GonePhotons(Device& device, std::size_t marched)
    : Photons(device, marched, "photons into other blocks")
    , Count(device, 1, "number of photons into other blocks")
  {
  }

  const Buffer<OnItsWay>& Room() const { return this->Photons; }
  const Buffer<cl_int>& Number() const { return this->Count; }
  void Empty() { this->Count.Fill(0); } ///< before a launch
  /// After it.
  void AppendTo(std::vector<OnItsWay>& all) const
  {
    const std::size_t before = all.size(), more = static_cast<std::size_t>(this->Count.Read().front());
    all.resize(before + more);
    this->Photons.Read(all.data() + before, more);
  }

private:
  Buffer<OnItsWay> Photons;
  Buffer<cl_int> Count;
};
}
