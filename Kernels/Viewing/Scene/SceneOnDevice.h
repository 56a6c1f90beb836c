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
/// Read-only array for kernels: a copy on the device, or the caller's memory, which a CPU reads without a copy.
class ViewedArray
{
public:
  ViewedArray() = default;

  /// Makes `count` values available to kernels.
  /// @param lent  whether `values` outlive this object, so that no copy is made
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

/// Arrays of a medium and its light on a device, one element per voxel. Arrays that the picture does not need are
/// empty.
struct SceneOnDevice
{
  /// Makes the arrays of medium and light available to kernels. If samples are packed only once
  /// (ViewTraits::PacksOnce), the caller's arrays are read without a copy: medium and light must then outlive the call
  /// of GiveBackWhatIsPacked.
  /// @param block  position of the medium in a larger grid, with `ior` covering BlockOfScene::known; null: the medium
  ///   is the whole domain
  /// @throws DeviceError if the arrays do not fit the device
  SceneOnDevice(Device& device, const Medium& medium, const SolvedLight& light, const Field& ior,
    const ViewTraits& traits, const BlockOfScene* block);

  /// Frees the arrays that are needed only to pack the samples.
  void GiveBackWhatIsPacked();

  /// Angular moments of scattered light, and the fraction of scattering that the solver of these moments treated as
  /// unscattered (SolvedLight). Empty if moments are not shown.
  Buffer<float> moments, straightOn;
  std::array<ViewedArray, 5> arrays; ///< sigma_a, sigma_s, emission, fluence and fluenceDirect (ViewedFields)
  ViewedArray meanDirection;
  Buffer<float> phaseRows; ///< table of the phase function, see Samples/PhaseFunction.cl
  /// Mean cosine g by voxel, with 1 or 3 components; empty if g does not vary or is not needed.
  Buffer<float> meanCosines;
  Buffer<float> ior; ///< refractive index, 1 in all voxels if none is given; empty if it does not vary
  /// For a block: refractive index of the larger box KnownBox, from which the gradient of n^2 is computed.
  Buffer<float> knownIor;
};
}
