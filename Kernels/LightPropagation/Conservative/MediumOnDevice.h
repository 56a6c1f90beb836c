#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// A medium's coefficients as kernels read them, 1/length, laid out as VolumeLayout says. Scattering with a mean cosine
/// g is isotropic scattering of sigma_s (1 - g) (numerics.md, Eq. (8)).
class MediumOnDevice
{
public:
  /// Which coefficients differ from one another.
  struct Needs
  {
    bool sigma_s; ///< else it is not read, or is sigma_t
    bool sigma_a; ///< by itself
  };
  /// @param medium  must stay
  MediumOnDevice(Device& device, const Medium& medium, const VolumeLayout& layout, const Needs& needs);

  const Buffer<float>& SigmaT() const { return this->Extinction; }
  const Buffer<float>& SigmaS() const { return this->Scattering.Size() > 0 ? this->Scattering : this->Extinction; }
  const Buffer<float>& SigmaA() const { return this->Absorption; } ///< empty where it was not asked for

private:
  Buffer<float> Extinction, Scattering, Absorption;
};

/// A quantity of voxel and channel, value(voxel, channel), as an array of that layout with `channels` channels; zero
/// beyond the voxels.
template <class Value>
std::vector<float> Planar(const VolumeLayout& layout, int channels, const Value& value)
{
  std::vector<float> values(layout.Stride() * channels + SweepPadding, 0.0f);
  const std::size_t voxels = layout.grid.VoxelCount();
  for (int c = 0; c < channels; ++c)
  {
    for (std::size_t i = 0; i < voxels; ++i)
    {
      values[c * layout.Stride() + i] = value(i, c);
    }
  }
  return values;
}

/// The voxels' values of such an array, times `scale`, the `parts` values of a voxel (channels, times components) side
/// by side.
std::vector<float> Interleaved(const VolumeLayout& layout, const Buffer<float>& planar, double scale);
}
