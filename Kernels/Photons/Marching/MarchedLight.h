#pragma once

#include "Device/Buffer.h"
#include "Distribution/Domain.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Marching/MarchRun.h"
#include "Photons/Photons.h"

#include <vector>

namespace tyndall
{
/// Sums of photons' deposits in a medium on its device, and their conversion to light.
class MarchedLight
{
public:
  /// Creates an object without sums; Prepare allocates them.
  /// @param medium  referenced, not copied
  explicit MarchedLight(const MarchMedium& medium);

  /// Provides sums for the deposits of packed photons, all zero, and describes their memory layout.
  /// @throws DeviceError if the sums do not fit into the device's memory
  MarchSums Prepare(const PackedPhotons& packed);
  /// Number of copies of the sums that fit into memory (ShareSums); the memory of existing sums counts as available.
  MarchShares Share(int numbers, int batches) const;
  /// Discards the sums after an aborted march, which leaves them nonzero.
  void Forget() { this->Sums = Buffer<cl_long>(); }

  /// Queues the conversion of the sums accumulated so far to fluence, [voxel][channel], without changing the sums.
  cl::Kernel Show(
    const PackedPhotons& packed, const MarchSums& target, const LightField& light, const Buffer<float>& fluence) const;
  /// Converts the sums to the arrays of `result` and to absorbed and scattered power, then zeroes the sums.
  /// result.light.channels must be set to the number of channels wanted.
  /// @param weightUnit  photon weight that counts as 1 in the voxels' integer sums (StartingPhotons::weightUnit), if
  ///   photons are counted
  void Finish(const PackedPhotons& packed, const MarchSums& target, float weightUnit, PhotonLight& result) const;

private:
  cl::Kernel SumsKernel(
    const char* name, const PackedPhotons& packed, const MarchSums& target, const LightField& light) const;
  void FinishVoxels(const PackedPhotons& packed, const MarchSums& target, float weightUnit, PhotonLight& result,
    const Buffer<cl_long>& taken) const;
  void FinishBricks(
    const PackedPhotons& packed, const MarchSums& target, PhotonLight& result, const Buffer<cl_long>& taken) const;

  const MarchMedium& Medium;
  Buffer<cl_long> Sums; ///< sums of deposits in fixed point; all zero between two marches
};

/// Adds the final states of photons to the light's energy balance: the power that escaped through each face of the
/// domain, and the power of photons that were terminated. Powers are rounded to whole units, so that their sums do not
/// depend on the order of the photons. Photons that continue in another block are ignored.
/// @param ends  final state (PhotonEnd) and remaining power of each photon, in units of packed.unit
void Tally(const PackedPhotons& packed, const std::vector<cl_int>& ends, PhotonLight& result);

/// Replaces this rank's powers and numbers of uncollided light (energy balance, powers, counts) by their sums over all
/// ranks. Collective.
void AddUpTallies(const Domain& domain, PhotonLight& result);
/// Replaces this rank's powers and numbers of scattered light (energy balance, powers, number of scatterings) by their
/// sums over all ranks. Collective.
void AddUpScattered(const Domain& domain, PhotonLight& result);

/// Converts arrays and powers of packed.channels channels to the channels of the light, or to one channel if `colours`
/// is 1.
void PutIntoColours(const PackedPhotons& packed, int colours, PhotonLight& result);

/// Texts of left_out for what a march leaves out because of traits of the medium and of the photons.
std::vector<std::string> LeftOutOf(
  const MarchTraits& traits, const MarchSettings& settings, const PackedPhotons& packed);

void SayWhatIsLeftOut(const MarchMedium& medium, const PackedPhotons& packed, LightField& light);

/// Indices of the photons in one of the batches from which the standard error is estimated. From each group of
/// `batches` consecutive photons one is chosen at random, the same on every machine.
PhotonNumbers NumbersOfBatch(std::size_t photons, std::size_t batch, std::size_t batches);

/// Sums the light of several independent batches of photons, each with a part of the power, and estimates the standard
/// error of the sum (numerics.md, Eq. (99e)).
class MarchedBatches
{
public:
  void Add(PhotonLight&& part);
  /// Returns the light of all batches, with fluenceError; with one batch or none, the light without an error.
  PhotonLight Sum() &&;

private:
  void AddArrays(const PhotonLight& part);

  PhotonLight All;
  int Count = 0;
  std::vector<double> Fluence, Squares, Direct, Flow, Weights;
};
}
