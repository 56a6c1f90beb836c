// One step of photon density on a lattice (numerics.md, section 10 c). The host gives
//   DIRECTIONS  18 or 6
//   BENDS       1: the refractive index varies
//
// Densities are what leaves a voxel along each of its links, [direction][stride]; direction 2 k + 1 is opposite to 2 k.
// Their sum is fluence, W / length^2.
#include "LatticeBoltzmann/LatticeShared.h"

__constant char Ways[18][3] = { { 1, 0, 0 }, { -1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 },
  { 1, 1, 0 }, { -1, -1, 0 }, { 1, -1, 0 }, { -1, 1, 0 }, { 1, 0, 1 }, { -1, 0, -1 }, { 1, 0, -1 }, { -1, 0, 1 },
  { 0, 1, 1 }, { 0, -1, -1 }, { 0, 1, -1 }, { 0, -1, 1 } };

#define WEIGHT(i) (DIRECTIONS == 6 ? 1.0f / 6.0f : (i) < 6 ? 1.0f / 12.0f : 1.0f / 24.0f)
#define OUTSIDE -1

// What a voxel does to light.
typedef struct
{
  const __global float* passing; // part that links let through, as if the neighbour were alike
  const __global float* turning; // part of the density that collisions make even
  const __global float* lost;    // part that is absorbed in a step
  const __global float* squared; // n^2
} lattice_medium;

// The voxel from which light comes to `at` along a way; OUTSIDE: `face` says through which face.
static int neighbour(const LatticeInfo* lattice, const int* at, int way, int* face)
{
  int place[3];
  for (int a = 0; a < 3; ++a)
  {
    place[a] = at[a] - Ways[way][a];
    if (place[a] < 0 || place[a] >= lattice->size[a])
    {
      if (!lattice->periodic[a])
      {
        *face = 2 * a + (place[a] < 0 ? 0 : 1);
        return OUTSIDE;
      }
      place[a] += place[a] < 0 ? lattice->size[a] : -lattice->size[a];
    }
  }
  return (place[2] * lattice->size[1] + place[1]) * lattice->size[0] + place[0];
}

static float both(float a, float b)
{
  return 2.0f * a * b / (a + b);
}

// Part of the light from one voxel that gets into another.
static float part_passed(const lattice_medium* medium, int from, int to)
{
  float part = both(medium->passing[from], medium->passing[to]);
#if BENDS
  part *= fmin(medium->squared[from], medium->squared[to]) / medium->squared[from];
#endif
  return part;
}

// What leaves through a face along a way, of density 1.
static float part_out(const lattice_medium* medium, int voxel)
{
  return both(medium->passing[voxel], 1.0f);
}

//   from, to   densities before and after
//   source     W / length^2 a step, that begins evenly in all directions
//   fluence    written with `writes`
__kernel void step_lattice(LatticeInfo lattice, const __global float* passing, const __global float* turning,
  const __global float* lost, const __global float* squared, const __global float* source, const __global float* from,
  __global float* to, __global float* fluence, int writes)
{
  const lattice_medium medium = { passing, turning, lost, squared };
  const int at[3] = { get_global_id(0), get_global_id(1), get_global_id(2) };
  const int voxel = (at[2] * lattice.size[1] + at[1]) * lattice.size[0] + at[0];
  const float half_source = 0.5f * source[voxel];
  float here[DIRECTIONS], sum = half_source;
  for (int i = 0; i < DIRECTIONS; ++i)
  {
    int face = 0;
    const int other = neighbour(&lattice, at, i, &face);
    const float back = from[(i ^ 1) * lattice.stride + voxel];
    float arrives;
    if (other == OUTSIDE)
    {
      const float out = part_out(&medium, voxel);
      arrives = out * WEIGHT(i) * lattice.incoming[face] + (1.0f - out + out * lattice.albedo[face]) * back;
    }
    else
    {
      arrives = part_passed(&medium, other, voxel) * from[i * lattice.stride + other] +
        (1.0f - part_passed(&medium, voxel, other)) * back;
    }
    here[i] = arrives;
    sum += arrives;
  }
  const float even = turning[voxel], kept = 1.0f - lost[voxel];
  for (int i = 0; i < DIRECTIONS; ++i)
  {
    const float before = here[i] + WEIGHT(i) * half_source;
    to[i * lattice.stride + voxel] = (before + even * (WEIGHT(i) * sum - before)) * kept + WEIGHT(i) * half_source;
  }
  if (writes)
  {
    fluence[voxel] = sum;
  }
}

// W / length^2 that leave each voxel through the box's faces in the next step, [face][voxel].
__kernel void leave_lattice(
  LatticeInfo lattice, const __global float* passing, const __global float* densities, __global float* leaving)
{
  const lattice_medium medium = { passing, 0, 0, 0 };
  const int at[3] = { get_global_id(0), get_global_id(1), get_global_id(2) };
  const int voxel = (at[2] * lattice.size[1] + at[1]) * lattice.size[0] + at[0];
  const ulong voxels = (ulong)lattice.size[0] * lattice.size[1] * lattice.size[2];
  float through[6] = { 0.0f };
  for (int i = 0; i < DIRECTIONS; ++i)
  {
    int face = 0;
    if (neighbour(&lattice, at, i ^ 1, &face) != OUTSIDE)
    {
      continue;
    }
    through[face] += (1.0f - lattice.albedo[face]) * part_out(&medium, voxel) * densities[i * lattice.stride + voxel];
  }
  for (int face = 0; face < 6; ++face)
  {
    leaving[face * voxels + voxel] = through[face];
  }
}
