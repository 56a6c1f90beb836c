#pragma once

#include "Device/Buffer.h"
#include "Distribution/Domain.h"
#include "Photons/Marching/MarchLaunch.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Photons.h"

#include <vector>

namespace tyndall
{
/// Sums that photons add to as they march through a medium, and the light that they become.
class MarchedLight
{
public:
  /// @param medium  must stay
  explicit MarchedLight(const MarchMedium& medium);

  /// Sums for such photons, all zero.
  /// @throws DeviceError where they do not fit
  MarchSums Prepare(const PackedPhotons& packed);
  /// As ShareSums, whose memory is taken for those that there are.
  MarchShares Share(int numbers, int batches) const;
  /// After a march that was broken off: they are not zero.
  void Forget() { this->Sums = Buffer<cl_long>(); }

  /// Queued: the fluence so far, [voxel][channel]. The sums stay.
  cl::Kernel Show(
    const PackedPhotons& packed, const MarchSums& target, const LightField& light, const Buffer<float>& fluence) const;
  /// Arrays of `result`, and what is absorbed and scattered, from the sums, which are zero afterwards. Its light says
  /// how many channels it is to have.
  /// @param weightUnit  of photons that count (CountedPhotons)
  void Finish(const PackedPhotons& packed, const MarchSums& target, float weightUnit, PhotonLight& result) const;

private:
  cl::Kernel SumsKernel(
    const char* name, const PackedPhotons& packed, const MarchSums& target, const LightField& light) const;
  void FinishVoxels(const PackedPhotons& packed, const MarchSums& target, float weightUnit, PhotonLight& result,
    const Buffer<cl_long>& taken) const;
  void FinishBricks(
    const PackedPhotons& packed, const MarchSums& target, PhotonLight& result, const Buffer<cl_long>& taken) const;

  const MarchMedium& Medium;
  Buffer<cl_long> Sums; ///< zero between two runs
};

/// Photons that count in the voxels that they cross.
struct CountedPhotons
{
  CountedPhotons() = default;
  /// @param packed  those of `some` that marks are wanted of
  /// @param largestWeight, count  of the photons of all ranks
  /// @throws InvalidInput where there are more than voxels can count
  CountedPhotons(const std::vector<Photon>& some, const PackedPhotons& packed, float largestWeight, std::size_t count);
  static float LargestWeight(const std::vector<Photon>& photons);

  std::vector<cl_ulong> marks; ///< of each as packed: one photon, and its weight
  float weightUnit = 0.0f;     ///< weight of one of the units that voxels sum up
};

/// Add what became of photons to the light's tallies: what left through the grid's faces, and what is left over. Whole
/// units, whose sums do not depend on the order of the photons. Those that go on elsewhere do not count.
/// @param ends  PhotonEnd and powers of each
void Tally(const PackedPhotons& packed, const std::vector<cl_int>& ends, PhotonLight& result);

/// Sums over all ranks of what this rank's photons became: up to where they were first scattered, and beyond.
/// Collective.
void AddUpTallies(const Domain& domain, PhotonLight& result);
void AddUpScattered(const Domain& domain, PhotonLight& result);

/// Arrays and tallies of photons of `packed.channels` as those of the channels that the light has, or of one where
/// `colours` is 1.
void PutIntoColours(const PackedPhotons& packed, int colours, PhotonLight& result);

void SayWhatIsLeftOut(const MarchMedium& medium, const PackedPhotons& packed, LightField& light);
}
