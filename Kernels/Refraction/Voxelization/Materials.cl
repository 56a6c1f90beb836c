// From samples inside to the quantities of a medium: each voxel is the mean of the materials in it.
//
// The host gives
//   CHANNELS  1 or 3, of sigma_a and sigma_s
//   NOISE     1 where materials are perturbed

#include "Refraction/Index/GradientNoise.cl"

// A slab's voxels are runs of `length` of the grid's, the first from `first` on, each `stride` further: a work-item a
// voxel (i of the slab), a row of work-items a run.

inline void add_material(float part, float n, float4 absorption, float4 scattering, ulong i, ulong voxel,
  __global float* ior, __global float* sigma_a, __global float* sigma_s)
{
  const float a[3] = { absorption.x, absorption.y, absorption.z };
  const float s[3] = { scattering.x, scattering.y, scattering.z };
  ior[voxel] += part * n;
  for (int c = 0; c < CHANNELS; ++c)
  {
    sigma_a[i * CHANNELS + c] += part * a[c];
    sigma_s[i * CHANNELS + c] += part * s[c];
  }
}

// Adds one material to a slab's voxels. A voxel of one material alone has its very values.
//   inside         samples of a voxel in the material, in parts of a sample: 0 to `samples`
//   samples        of a voxel
//   indexNoise     by how much n is perturbed, +-
//   scatteringNoise  the same for sigma_s, relative
//   frequency      1 / size of the noise's features, 1/length; position of the grid's corner and edges of a voxel:
//                  length
//   covered        samples in any material so far
//   ior            of the whole grid; the other arrays are the slab's
__kernel void add_object(ulong first, ulong length, ulong stride, __global const ushort* inside, float samples, float n,
  float4 absorption, float4 scattering, float indexNoise, float scatteringNoise, uint seed, float frequency,
  float4 corner, float4 spacing, int nx, int ny, __global float* covered, __global float* ior, __global float* sigma_a,
  __global float* sigma_s)
{
  if (get_global_id(0) >= length)
  {
    return;
  }
  const ulong i = get_global_id(1) * length + get_global_id(0);
  const ulong voxel = first + get_global_id(1) * stride + get_global_id(0);
  const float number = inside[i];
#if NOISE
  if (number > 0.0f)
  {
    const ulong row = voxel / nx;
    const float3 index = (float3)(voxel % nx, row % ny, row / ny);
    const float noise = gradient_noise((corner.xyz + (index + 0.5f) * spacing.xyz) * frequency, seed);
    n += indexNoise * noise;
    scattering *= 1.0f + scatteringNoise * noise;
  }
#endif
  covered[i] += number;
  add_material(number / samples, n, absorption, scattering, i, voxel, ior, sigma_a, sigma_s);
}

// The same for what no mesh covers; `covered` becomes the part that is.
__kernel void add_outside(ulong first, ulong length, ulong stride, float samples, float n, float4 absorption,
  float4 scattering, __global float* covered, __global float* ior, __global float* sigma_a, __global float* sigma_s)
{
  if (get_global_id(0) >= length)
  {
    return;
  }
  const ulong i = get_global_id(1) * length + get_global_id(0);
  const ulong voxel = first + get_global_id(1) * stride + get_global_id(0);
  const float number = covered[i];
  covered[i] = number / samples;
  add_material((samples - number) / samples, n, absorption, scattering, i, voxel, ior, sigma_a, sigma_s);
}
