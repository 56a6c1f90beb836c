// Access to voxel arrays in the host's layout, with 1 or 3 components per voxel, or without values (0 components).

#pragma once

#define PER_SPHERE 0.0795774715f // 1 / (4 pi)

inline float channel_of(__global const float* values, int voxel, int components, int channel)
{
  return components == 0 ? 0.0f : values[voxel * components + (components == 3 ? channel : 0)];
}

// Calls DO(neighbour) for all voxels that scatter in any channel in the 3 x 3 x 3 neighbourhood of a voxel, the voxel
// itself included.
#define FOR_SCATTERING_AROUND(voxel, size, scattering, components, DO)                                      \
  {                                                                                                         \
    const int3 at = { (voxel) % (size).x, (voxel) / (size).x % (size).y, (voxel) / ((size).x * (size).y) }; \
    for (int z = max(at.z - 1, 0); z <= min(at.z + 1, (size).z - 1); ++z)                                   \
      for (int y = max(at.y - 1, 0); y <= min(at.y + 1, (size).y - 1); ++y)                                 \
        for (int x = max(at.x - 1, 0); x <= min(at.x + 1, (size).x - 1); ++x)                               \
        {                                                                                                   \
          const int neighbour = (z * (size).y + y) * (size).x + x;                                          \
          if (scatters_at(scattering, neighbour, components))                                               \
          {                                                                                                 \
            DO(neighbour)                                                                                   \
          }                                                                                                 \
        }                                                                                                   \
  }

inline int scatters_at(__global const float* scattering, int voxel, int components)
{
  return channel_of(scattering, voxel, components, 0) + channel_of(scattering, voxel, components, 1) +
    channel_of(scattering, voxel, components, 2) >
    0.0f;
}

inline int is_beside_scattering(__global const float* scattering, int voxel, int components, int4 size)
{
  int found = 0;
#define COUNT(neighbour) found = 1;
  FOR_SCATTERING_AROUND(voxel, size, scattering, components, COUNT)
#undef COUNT
  return found;
}
