// Access to voxel arrays in the host's layout, with 1 or 3 channels, or without values (0 components).

#pragma once

#define PER_SPHERE 0.0795774715f // 1 / (4 pi)

inline float channel_of(__global const float* values, int voxel, int components, int channel)
{
  return components == 0 ? 0.0f : values[voxel * components + (components == 3 ? channel : 0)];
}
