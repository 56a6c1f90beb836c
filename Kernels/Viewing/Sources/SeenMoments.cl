// Computes the radiance that each voxel scatters towards the eye from the angular moments of scattered light.
//
// Macros set by the host:
//   DEGREE  degree of the moments

#include "Numerics/SphericalHarmonics.cl"
#include "Viewing/Scene/ViewShared.h"

#define HARMONICS ((DEGREE + 1) * (DEGREE + 1))

// Evaluates the moments of each voxel in the direction of the eye, one work-item per voxel.
//   moments  W / (length^2 sr), [voxel][harmonic][channel]
//   seen     receives the radiance towards the eye, 3 per voxel
__kernel void see_moments(ShadowInfo info, __global const float* restrict moments, __global float* restrict seen)
{
  const int i = get_global_id(0);
  const int j = get_global_id(1);
  const int k = get_global_id(2) + info.firstSlice;
  if (i >= info.size.x)
  {
    return;
  }
  const size_t voxel = ((size_t)k * info.size.y + j) * info.size.x + i;
  const int4 first = info.block.first;
  const float3 place = (float3)((i + first.x + 0.5f) * info.spacing.x, (j + first.y + 0.5f) * info.spacing.y,
    (k + first.z + 0.5f) * info.spacing.z);
  // Direction towards the eye. In a parallel projection it is opposite to the view axis.
  const float3 out = (1.0f - info.eye.w) * (info.eye.xyz - place) - info.eye.w * info.forward.xyz;
  float harmonics[HARMONICS];
  find_harmonics(out / sqrt(fmax(dot(out, out), 1e-30f)), harmonics);
  __global const float* from = moments + voxel * (HARMONICS * MOMENT_CHANNELS);
  float sums[MOMENT_CHANNELS];
  for (int c = 0; c < MOMENT_CHANNELS; ++c)
  {
    sums[c] = 0.0f;
  }
  for (int q = 0; q < HARMONICS; ++q)
  {
    for (int c = 0; c < MOMENT_CHANNELS; ++c)
    {
      sums[c] = fma(from[q * MOMENT_CHANNELS + c], harmonics[q], sums[c]);
    }
  }
  for (int c = 0; c < 3; ++c)
  {
    seen[3 * voxel + c] = sums[MOMENT_CHANNELS == 3 ? c : 0];
  }
}
