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
/// A read-only array for kernels: a copy on the device, or memory lent by its owner, which a CPU reads without a copy.
class ViewedArray
{
public:
  ViewedArray() = default;

  /// @param lent  `values` outlive this object, so no copy is needed
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

/// Arrays of a medium and its light on a device, voxel by voxel; those that the picture does not need are empty.
struct SceneOnDevice
{
  /// If samples are packed only once (ViewTraits::PacksOnce), no copies are made: medium and light must then outlive
  /// the call of GiveBackWhatIsPacked.
  /// @throws DeviceError if they do not fit
  /// @param block  the medium's place in a larger grid, with `ior` covering BlockOfScene::known; null: the medium is
  ///   the whole domain
  SceneOnDevice(Device& device, const Medium& medium, const SolvedLight& light, const Field& ior,
    const ViewTraits& traits, const BlockOfScene* block);

  /// Frees the arrays that are read only while samples are packed.
  void GiveBackWhatIsPacked();

  Buffer<float> moments, straightOn; ///< if moments are shown
  std::array<ViewedArray, 5> arrays; ///< ViewedFields
  ViewedArray meanDirection;
  Buffer<float> phaseRows;   ///< tables of the phase function, see Samples/PhaseFunction.cl
  Buffer<float> meanCosines; ///< g by voxel, with the components that the picture needs
  Buffer<float> ior;         ///< refractive index; 1 if rays could bend but no index is given
  /// for a block: refractive index of the larger box KnownBox, from which the bending is computed
  Buffer<float> knownIor;
};
}
