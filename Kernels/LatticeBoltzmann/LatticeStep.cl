// One step of photon density on a lattice (numerics.md, section 10 c). The host gives
//   DIRECTIONS  18 or 6
//   PASSES_ALL  1: no link gives back light, but at reflecting faces
//   BENDS       1: the refractive index varies
//   REFLECTS    1: a face of the box gives back light
//
// Densities are what leaves a voxel along each of its links, [direction][stride]; direction 2 k + 1 is opposite to 2 k.
// Their sum is fluence, W / length^2. The voxels round the box hold what comes in.
#include "LatticeBoltzmann/LatticeShared.h"

#define WIDTH 16
#define WEIGHT(i) (DIRECTIONS == 6 ? 1.0f / 6.0f : (i) < 6 ? 1.0f / 12.0f : 1.0f / 24.0f)
#define FOR_DIRECTIONS(i) _Pragma("unroll") for (int i = 0; i < DIRECTIONS; ++i)

// Of sixteen voxels beginning at `at`: to those of the row's end that are voxels.
static void store_some(float16 values, __global float* to, ulong at, int voxels)
{
  if (voxels >= WIDTH)
  {
    vstore16(values, 0, to + at);
    return;
  }
  float some[WIDTH];
  vstore16(values, 0, some);
  for (int k = 0; k < voxels; ++k)
  {
    to[at + k] = some[k];
  }
}

// A work-item a row of voxels. Arrays are of the lattice but for fluence:
//   resistance  inverse of the part that links let through, as if the neighbour were alike; 1 outside
//   turning     part of the density that collisions make even
//   kept        part that is not absorbed in a step
//   squared     n^2
//   albedo      of faces, outside; 0 inside
//   source      W / length^2 a step, that begins evenly in all directions
//   from, to    densities before and after
//   fluence     [voxel], written with `writes`
__kernel void step_lattice(LatticeInfo lattice, const __global float* resistance, const __global float* turning,
  const __global float* kept, const __global float* squared, const __global float* albedo, const __global float* source,
  const __global float* from, __global float* to, __global float* fluence, int writes)
{
  const int y = get_global_id(0), z = get_global_id(1), nx = lattice.size[0];
  const ulong line = (ulong)(z + 1) * lattice.layer + (ulong)(y + 1) * lattice.row + 1;
  for (int x = 0; x < nx; x += WIDTH)
  {
    const ulong at = line + x;
    const float16 half_source = 0.5f * vload16(0, source + at);
    float16 here[DIRECTIONS], sum = half_source;
#if !PASSES_ALL
    const float16 own = vload16(0, resistance + at);
#endif
#if BENDS
    const float16 index = vload16(0, squared + at);
#endif
    FOR_DIRECTIONS(i)
    {
      const ulong other = at - lattice.offset[i];
      float16 arrives = vload16(0, from + i * lattice.stride + other);
#if !PASSES_ALL || BENDS || REFLECTS
      const float16 back = vload16(0, from + (i ^ 1) * lattice.stride + at);
#if PASSES_ALL
      float16 part = (float16)(1.0f);
#else
      float16 part = 2.0f / (own + vload16(0, resistance + other));
#endif
      float16 returns = part;
#if BENDS
      const float16 there = vload16(0, squared + other), least = fmin(index, there);
      part *= least / there;
      returns *= least / index;
#endif
#if REFLECTS
      returns -= returns * vload16(0, albedo + other);
#endif
      arrives = part * arrives + (1.0f - returns) * back;
#endif
      here[i] = arrives;
      sum += arrives;
    }
    const float16 even = vload16(0, turning + at), stays = vload16(0, kept + at);
    FOR_DIRECTIONS(i)
    {
      const float16 before = here[i] + WEIGHT(i) * half_source;
      const float16 after = (before + even * (WEIGHT(i) * sum - before)) * stays + WEIGHT(i) * half_source;
      store_some(after, to + i * lattice.stride, at, nx - x);
    }
    if (writes)
    {
      store_some(sum, fluence, ((ulong)z * lattice.size[1] + y) * nx + x, nx - x);
    }
  }
}

// Voxels round the box take what those on the other side of a periodic axis hold. A work-item a value of a plane, by
// direction.
//   u, v  steps in memory along the plane, and `along` the axis; n: voxels along it
__kernel void wrap_lattice(__global float* densities, ulong stride, int u, int v, int along, int n)
{
  __global float* at =
    densities + get_global_id(2) * stride + (ulong)get_global_id(0) * u + (ulong)get_global_id(1) * v;
  at[0] = at[(ulong)n * along];
  at[(ulong)(n + 1) * along] = at[along];
}

__constant char Ways[18][3] = { { 1, 0, 0 }, { -1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 },
  { 1, 1, 0 }, { -1, -1, 0 }, { 1, -1, 0 }, { -1, 1, 0 }, { 1, 0, 1 }, { -1, 0, -1 }, { 1, 0, -1 }, { -1, 0, 1 },
  { 0, 1, 1 }, { 0, -1, -1 }, { 0, 1, -1 }, { 0, -1, 1 } };

// W / length^2 that each voxel sends through the box's faces in the next step, [face][voxel]; a corner's light goes
// through the first face that it meets. Periodic axes have no faces.
__kernel void leave_lattice(LatticeInfo lattice, const __global float* resistance, const __global float* densities,
  int periodic, __global float* leaving)
{
  const int at[3] = { get_global_id(0), get_global_id(1), get_global_id(2) };
  const ulong place = (ulong)(at[2] + 1) * lattice.layer + (ulong)(at[1] + 1) * lattice.row + at[0] + 1;
  const ulong voxel = ((ulong)at[2] * lattice.size[1] + at[1]) * lattice.size[0] + at[0];
  const ulong voxels = (ulong)lattice.size[0] * lattice.size[1] * lattice.size[2];
  float through[6] = { 0.0f };
  for (int i = 0; i < DIRECTIONS; ++i)
  {
    for (int a = 0; a < 3; ++a)
    {
      const int next = at[a] + Ways[i][a];
      if (!(periodic >> a & 1) && (next < 0 || next >= lattice.size[a]))
      {
        const int face = 2 * a + (next < 0 ? 0 : 1);
        through[face] +=
          (1.0f - lattice.albedo[face]) * 2.0f / (resistance[place] + 1.0f) * densities[i * lattice.stride + place];
        break;
      }
    }
  }
  for (int face = 0; face < 6; ++face)
  {
    leaving[face * voxels + voxel] = through[face];
  }
}
