// Kernels that compute the properties of a medium from counts of samples: each voxel gets the mean of the materials
// in it.
//
// The host defines
//   CHANNELS  number of components of sigma_a and sigma_s, 1 or 3
//   NOISE     1 if materials are perturbed
//   VARIED_G  1 if scattering materials differ in their mean cosines

#include "Refraction/Voxelization/VoxelizationShared.h"

// Gradient noise of Perlin (Improving noise, SIGGRAPH 2002). A hash takes the place of his table, so that a seed
// selects one of 2^32 patterns.

inline uint scrambled(uint bits)
{
  bits ^= bits >> 16;
  bits *= 0x7feb352du;
  bits ^= bits >> 15;
  bits *= 0x846ca68bu;
  bits ^= bits >> 16;
  return bits;
}

// Dot product of `away` with one of the twelve directions to the midpoints of a cube's edges; a hash of corner and
// seed selects the direction.
inline float gradient_at(int3 corner, uint seed, float3 away)
{
  const uint hash = scrambled((uint)corner.x + scrambled((uint)corner.y + scrambled((uint)corner.z + seed)));
  const uint kind = hash % 12;
  const float first = kind < 8 ? away.x : away.y;
  const float second = kind < 4 ? away.y : away.z;
  return ((kind & 1) ? -first : first) + ((kind & 2) ? -second : second);
}

// Gradient noise in [-1, 1], twice continuously differentiable, 0 at integer coordinates, with features of a size of
// about 1.
inline float gradient_noise(float3 position, uint seed)
{
  const float3 low = floor(position);
  const int3 corner = convert_int3(low);
  const float3 in = position - low;
  const float3 fade = in * in * in * (in * (in * 6.0f - 15.0f) + 10.0f);
  float value[2];
  for (int z = 0; z < 2; ++z)
  {
    float row[2];
    for (int y = 0; y < 2; ++y)
    {
      const float left = gradient_at(corner + (int3)(0, y, z), seed, in - (float3)(0, y, z));
      const float right = gradient_at(corner + (int3)(1, y, z), seed, in - (float3)(1, y, z));
      row[y] = mix(left, right, fade.x);
    }
    value[z] = mix(row[0], row[1], fade.y);
  }
  return clamp(mix(value[0], value[1], fade.z), -1.0f, 1.0f);
}

// Each kernel has one work-item per voxel (index i in the slab). A slab consists of runs of consecutive voxels
// (MaterialSlab); the second dimension of work-items counts the runs.

// Adds a material to a voxel with the volume fraction `part`. The mean cosine is weighted by sigma_s (numerics.md, Eq.
// (3e)) and updated with every material, so that a voxel of a single material gets exactly the material's g.
//   i      index of the voxel in the slab, which sigma_a, sigma_s and g cover
//   voxel  index of the voxel in the box, which ior covers
inline void add_material(float part, const MaterialInfo* material, ulong i, ulong voxel, __global float* ior,
  __global float* sigma_a, __global float* sigma_s, __global float* g)
{
  const float a[3] = { material->absorption.x, material->absorption.y, material->absorption.z };
  const float s[3] = { material->scattering.x, material->scattering.y, material->scattering.z };
  ior[voxel] += part * material->n;
  for (int c = 0; c < CHANNELS; ++c)
  {
    sigma_a[i * CHANNELS + c] += part * a[c];
    sigma_s[i * CHANNELS + c] += part * s[c];
    const float weight = part * s[c];
    if (VARIED_G && weight > 0.0f)
    {
      g[i * CHANNELS + c] += (material->g - g[i * CHANNELS + c]) * (weight / sigma_s[i * CHANNELS + c]);
    }
  }
}

// Adds one material to the voxels of a slab, the part of the box that is processed at a time. A voxel of a single
// material gets exactly the material's values.
//   inside    for each voxel, the number of samples inside the material, in units of 1 / UnitsOfSample of a sample;
//             slab.samples if all are inside
//   covered   sum of these numbers over all materials added so far
//   ior       n in the entire box; the other arrays cover the slab
__kernel void add_object(MaterialSlab slab, MaterialInfo given, __global const ushort* inside, __global float* covered,
  __global float* ior, __global float* sigma_a, __global float* sigma_s, __global float* g)
{
  if (get_global_id(0) >= slab.length)
  {
    return;
  }
  const ulong i = get_global_id(1) * slab.length + get_global_id(0);
  const ulong voxel = slab.first + get_global_id(1) * slab.stride + get_global_id(0);
  const float number = inside[i];
  MaterialInfo material = given; // PoCL 3.1 lets the work-items of a group share a struct argument: do not write to it
  if (NOISE && number > 0.0f)
  {
    const ulong row = voxel / slab.nx;
    const float3 index =
      (float3)(slab.x0 + (int)(voxel % slab.nx), slab.y0 + (int)(row % slab.ny), slab.z0 + (int)(row / slab.ny));
    const float3 at = (slab.corner.xyz + (index + 0.5f) * slab.spacing.xyz) * material.frequency;
    const float noise = gradient_noise(at, material.seed);
    material.n += material.indexNoise * noise;
    material.scattering *= 1.0f + material.scatteringNoise * noise;
  }
  covered[i] += number;
  add_material(number / slab.samples, &material, i, voxel, ior, sigma_a, sigma_s, g);
}

// Adds the outside material to the fraction of each voxel that no mesh covers. `covered` holds the sums from
// add_object, and receives the covered fractions of the voxels.
__kernel void add_outside(MaterialSlab slab, MaterialInfo material, __global float* covered, __global float* ior,
  __global float* sigma_a, __global float* sigma_s, __global float* g)
{
  if (get_global_id(0) >= slab.length)
  {
    return;
  }
  const ulong i = get_global_id(1) * slab.length + get_global_id(0);
  const ulong voxel = slab.first + get_global_id(1) * slab.stride + get_global_id(0);
  const float number = covered[i];
  covered[i] = number / slab.samples;
  add_material((slab.samples - number) / slab.samples, &material, i, voxel, ior, sigma_a, sigma_s, g);
}
