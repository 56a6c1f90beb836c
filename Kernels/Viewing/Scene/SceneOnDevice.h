#pragma once

#include "Device/Buffer.h"
#include "Device/HostMappedBuffer.h"
#include "Medium/Medium.h"
#include "Viewing/Scene/SolvedLight.h"
#include "Viewing/Scene/ViewTraits.h"

#include <array>
#include <memory>

namespace tyndall
{
/// An array that kernels read: a copy on the device, or one that its owner lends, of which a CPU needs no copy.
class ViewedArray
{
public:
  ViewedArray() = default;

  /// @param lent  the values stay until this goes
  ViewedArray(Device& device, const float* values, std::size_t count, bool lent, const char* what)
    : Copy(device, lent ? nullptr : values, lent ? 0 : count, what)
    , Lent(lent ? std::make_unique<HostMappedBuffer<float>>(device, values, count, what) : nullptr)
  {
  }

  const cl::Buffer& Handle() const { return this->Lent ? this->Lent->Handle() : this->Copy.Handle(); }

private:
  Buffer<float> Copy;
  std::unique_ptr<HostMappedBuffer<float>> Lent;
};

/// Arrays of a medium and its light on a device, voxel by voxel, as far as pictures show them; the others are empty.
struct SceneOnDevice
{
  /// Where samples are packed once (ViewTraits::PacksOnce) medium and light must stay until GiveBackWhatIsPacked: no
  /// copies are made of them.
  /// @throws DeviceError if they do not fit
  /// @param block  of which the medium is one: `ior` is of the voxels that it says; null: of none
  SceneOnDevice(Device& device, const Medium& medium, const SolvedLight& light, const Field& ior,
    const ViewTraits& traits, const BlockOfScene* block);

  /// Gives back the memory of what is read only where samples are packed.
  void GiveBackWhatIsPacked();

  Buffer<float> moments, straightOn; ///< where moments are shown
  std::array<ViewedArray, 5> arrays; ///< ViewedFields
  ViewedArray meanDirection;
  Buffer<float> phaseRows;   ///< tables of the phase function, see Samples/PhaseFunction.cl
  Buffer<float> meanCosines; ///< g as all channels are seen
  Buffer<float> ior;         ///< 1 where rays could bend and it is not given
  Buffer<float> knownIor;    ///< of a block: that of more voxels, by which rays bend
};
}
