#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Marching/PhotonPacking.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// How many copies of the sums there are, and which work-item adds to which copy. Work-item w serves copies w, w +
/// workers, ...; copy c belongs to batch c % batches.
struct MarchShares
{
  bool atomics = false;
  /// Work-items that fetch photons from a common counter; 0: one work-item per packet, all of a batch add to one copy.
  int workers = 0;
  int copies = 1;
  int batches = 1;
};

/// Chooses the number of copies of the sums from the settings and the device's memory.
/// @param records  records in one copy of the sums
/// @param numbers  64-bit numbers in a record
/// @param held     bytes already allocated that the new sums will reuse
/// @throws DeviceError if the settings ask for atomics that the device lacks, or the sums of all batches do not fit
MarchShares ShareSums(const MarchMedium& medium, std::size_t records, int numbers, int batches, std::size_t held);

/// Packed photons on a device, and buffers for their end records.
struct PhotonsOnDevice
{
  /// @param marks  counting mark of each packed photon (PhotonMarch.cl); empty if photons are not counted
  PhotonsOnDevice(Device& device, const PackedPhotons& packed, const std::vector<cl_ulong>& marks = {});

  Buffer<float> values;
  Buffer<cl_ulong> marks;
  Buffer<cl_int> batchBegin;
  Buffer<cl_int> ends; ///< PhotonEnd and remaining power of each photon
};

/// The buffer to which photons deposit, and its layout.
struct MarchSums
{
  MarchShares shares;
  std::size_t records = 0; ///< records in a copy: voxels of the padded grid, records of bricks, or coarse cells
  int numbers = 1;         ///< numbers in a record
  bool directions = false; ///< whether a record holds sums of power times direction
  bool counts = false;     ///< whether a record counts the photons that crossed its voxel
  /// Coarse cell of each voxel, for deposits to cells, which count photons; null: deposits to voxels.
  const Buffer<cl_int>* cells = nullptr;
  const Buffer<cl_long>* sums = nullptr; ///< [copies][records][numbers]
};

/// Creates a kernel of PhotonMarch.cl that adds to such sums: march_photons unless `options` select another.
cl::Kernel MarchKernelFor(
  const MarchMedium& medium, const MarchSums& target, int channels, const char* name, const std::string& options = {});

constexpr int MarchBlock = 512; ///< number of neighbouring photons that one work-item takes at a time

/// Marches photons to their ends.
/// @throws Aborted: the sums then hold only a part of the photons
void MarchPhotons(const MarchMedium& medium, const PackedPhotons& packed, const PhotonsOnDevice& photons,
  const MarchSums& target, const Monitor& monitor);

constexpr double SecondsPerLaunch = 0.1; ///< target duration of one launch of a kernel that follows photons
/// Photons per launch: 30 MiB for those that leave the block.
constexpr std::size_t MarchedBetweenBlocks = 262144;

/// Device buffer for the photons that leave the block during a kernel launch, in any order.
template <class OnItsWay>
class GonePhotons
{
public:
  /// @param marched  maximum number of photons in a launch
  GonePhotons(Device& device, std::size_t marched)
    : Photons(device, marched, "photons into other blocks")
    , Count(device, 1, "number of photons into other blocks")
  {
  }

  const Buffer<OnItsWay>& Room() const { return this->Photons; }
  const Buffer<cl_int>& Number() const { return this->Count; }
  void Empty() { this->Count.Fill(0); } ///< call before each launch
  /// Appends the photons of the last launch to `all`.
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
