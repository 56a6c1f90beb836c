#pragma once

#include <cstddef>

namespace tyndall
{
/// A non-owning view of one quantity on a grid: `components` floats per voxel (1, or 3 for interleaved RGB), x fastest.
struct Field
{
  const float* values = nullptr; ///< the values, not owned; null: the quantity is zero everywhere
  int components = 1;
  /// Index of the component (of three) that is used for every channel; -1: channel c uses component c.
  int standsForAll = -1;

  bool HasColour() const { return this->components == 3 && this->standsForAll < 0; }
  float At(std::size_t voxel, int channel) const
  {
    const int component = this->components != 3 ? 0 : this->standsForAll >= 0 ? this->standsForAll : channel;
    return this->values ? this->values[voxel * this->components + component] : 0.0f;
  }
};
}
