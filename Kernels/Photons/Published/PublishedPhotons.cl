// Kernels of photon marching as published by Pfeuti 2009, section 3.1.5, after Sun et al. 2008. One work-item per
// photon; explicit Euler (Eq. 2.10, 2.11). The line of each step is rasterised, and every voxel on it gains the
// photon's power, regardless of the path length in it. Colour (RGBE, Ward 1991) and mean direction (10 bits per
// component) of a voxel's light share 64 bits, which are updated by compare-and-swap with at most TRIES attempts. A
// photon marches until it leaves its block of the domain. If a step continues in another block, the rest of its line is
// rasterised in that block. The host defines
//   BENDS   1: the index varies
//   LEVELS  1: there are octree levels
//   A_CHANNELS, S_CHANNELS  components of sigma_a and sigma_s, 0: absent
//   TRIES   maximum number of compare-and-swap attempts

#include "Numerics/Numerics.cl"
#include "Photons/Published/PublishedPhotonsShared.h"

#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable

static float3 from_rgbe(uint packed)
{
  const int exponent = (int)(packed >> 24) - 128;
  const float scale = packed == 0 ? 0.0f : ldexp(1.0f, exponent - 8);
  return scale * (float3)(packed & 255, packed >> 8 & 255, packed >> 16 & 255);
}

static uint to_rgbe(float3 colour)
{
  const float most = fmax(fmax(colour.x, colour.y), colour.z);
  if (most < 1e-32f)
  {
    return 0;
  }
  int exponent;
  const float scale = frexp(most, &exponent) * 256.0f / most;
  const uint3 mantissa = convert_uint3(min(colour * scale, 255.0f)); // truncated, as in Ward's RGBE format
  return mantissa.x | mantissa.y << 8 | mantissa.z << 16 | (uint)(exponent + 128) << 24;
}

static float3 from_direction(uint packed)
{
  const float3 bits = (float3)(packed & 1023, packed >> 10 & 1023, packed >> 20 & 1023);
  return packed == 0 ? (float3)(0.0f) : bits * (2.0f / 1023.0f) - 1.0f;
}

static uint to_direction(float3 direction)
{
  const uint3 bits = convert_uint3(clamp((direction + 1.0f) * 511.5f + 0.5f, 0.0f, 1023.0f));
  return bits.x | bits.y << 10 | bits.z << 20;
}

static float luminance(float3 colour)
{
  return dot(colour, (float3)(0.2126f, 0.7152f, 0.0722f));
}

// Adds a deposit to a voxel's packed light: reads, unpacks, changes, packs and writes it by compare-and-swap, with at
// most TRIES attempts. Returns whether an attempt succeeded.
static bool deposit_packed(__global ulong* voxel, float3 power, float3 direction)
{
  for (int i = 0; i < TRIES; ++i)
  {
    const ulong before = *(volatile __global ulong*)voxel;
    const float3 colour = from_rgbe((uint)before);
    const float old_weight = luminance(colour), weight = luminance(power);
    const float3 mean =
      (from_direction((uint)(before >> 32)) * old_weight + direction * weight) / (old_weight + weight);
    const ulong after = to_rgbe(colour + power) | (ulong)to_direction(mean) << 32;
    if (atom_cmpxchg(voxel, before, after) == before)
    {
      return true;
    }
  }
  return false;
}

static int3 voxels_of(const int* numbers)
{
  return (int3)(numbers[0], numbers[1], numbers[2]);
}

static bool is_within(int3 voxel, int3 size)
{
  return all(voxel >= 0) && all(voxel < size);
}

// Index, in an array over a box, of the box's voxel that is nearest to `voxel`.
static int index_in(const IndexGrid* box, int3 voxel)
{
  const int3 inside = clamp(voxel, (int3)(0), voxels_of(box->size) - 1);
  return (inside.z * box->size[1] + inside.y) * box->size[0] + inside.x;
}

static int index_of(const PublishedMarchInfo* info, int3 voxel)
{
  return index_in(&info->own, voxel - voxels_of(info->first));
}

#if BENDS
// Gradient of n per voxel (x, y, z), and n (w), at position p: interpolated linearly between voxel centres.
static float4 index_at(const PublishedMarchInfo* info, const __global float4* index, float3 p)
{
  const float3 q = p - 0.5f, base = floor(q), f = q - base;
  const int3 b = convert_int3(base) - voxels_of(info->knownFirst);
  float4 sum = 0.0f;
  for (int corner = 0; corner < 8; ++corner)
  {
    const int3 d = (int3)(corner & 1, corner >> 1 & 1, corner >> 2);
    const float weight = (d.x ? f.x : 1.0f - f.x) * (d.y ? f.y : 1.0f - f.y) * (d.z ? f.z : 1.0f - f.z);
    sum += weight * index[index_in(&info->known, b + d)];
  }
  return sum;
}
#endif

// Computes n and its gradient in the voxels of the region `known`: the block and two voxels around it. Differences are
// central, and one-sided at the faces of the domain. At faces of the region inside the domain they are wrong, but not
// used, since photons of the block need only one voxel around it.
__kernel void published_index(PublishedMarchInfo info, const __global float* ior, __global float4* index)
{
  const int3 v = (int3)(get_global_id(0), get_global_id(1), get_global_id(2));
  float gradient[3];
  for (int a = 0; a < 3; ++a)
  {
    const int3 step = (int3)(a == 0, a == 1, a == 2);
    const int here = info.knownFirst[a] + (a == 0 ? v.x : a == 1 ? v.y : v.z);
    const int span = (here > 0) + (here < info.whole.size[a] - 1);
    gradient[a] =
      span == 0 ? 0.0f : (ior[index_in(&info.known, v + step)] - ior[index_in(&info.known, v - step)]) / span;
  }
  const int at = index_in(&info.known, v);
  index[at] = (float4)(gradient[0], gradient[1], gradient[2], ior[at]);
}

#define component(values, count, voxel, c) \
  ((count) == 0 ? 0.0f : (values)[(voxel) * (count) + ((count) == 3 ? (c) : 0)])

static float3 extinction(const __global float* sigma_a, const __global float* sigma_s, int v)
{
  return (float3)(component(sigma_a, A_CHANNELS, v, 0) + component(sigma_s, S_CHANNELS, v, 0),
    component(sigma_a, A_CHANNELS, v, 1) + component(sigma_s, S_CHANNELS, v, 1),
    component(sigma_a, A_CHANNELS, v, 2) + component(sigma_s, S_CHANNELS, v, 2));
}

// Length of a step from p along `u` (voxels per length), in the dataset's unit: one voxel or, in a larger octree
// node, to the node's border and slightly beyond.
static float step_length(const PublishedMarchInfo* info, const __global uchar* levels, float3 p, float3 u)
{
  const float voxel = rsqrt(dot(u, u));
  const int3 v = convert_int3_rtn(p);
  const int level = LEVELS ? levels[index_of(info, v)] : 0;
  if (level > 0)
  {
    const int3 low = (v >> level) << level;
    const float3 near = convert_float3(low), far = near + (float)(1 << level);
    const float3 walls = u > 0.0f ? far : near;
    const float3 out = u == 0.0f ? (float3)(1e30f) : fmax((walls - p) / u, 0.0f);
    return fmax(1.001f * fmin(fmin(out.x, out.y), out.z), 0.01f * voxel);
  }
  return voxel;
}

typedef struct
{
  float3 position, velocity, power; // position in voxels; n times unit direction; power in units of TypicalPower
} published_photon;

static published_photon photon_at(const __global PublishedPlace* place)
{
  return (published_photon){ vload3(0, place->position), vload3(0, place->velocity), vload3(0, place->power) };
}

static void put_at(const published_photon* photon, __global PublishedPlace* place)
{
  vstore3(photon->position, 0, place->position);
  vstore3(photon->velocity, 0, place->velocity);
  vstore3(photon->power, 0, place->power);
}

static void deposit(const PublishedMarchInfo* info, int3 voxel, float3 power, float3 direction, __global ulong* packed,
  __global PublishedPhoton* photon)
{
  ++photon->deposits;
  photon->givenUp += !deposit_packed(packed + index_of(info, voxel), power, direction);
  vstore3(vload3(0, photon->deposited) + power, 0, photon->deposited);
}

// Deposits light in the voxels on the line of a step from a to b: those whose centres, along the axis of largest
// change, lie between the two ends. Follows the path's order, starting with voxel number photon->done. For a photon
// that has just arrived, the first voxel is `next`, even if this device rounds differently from the device that sent
// it. Returns false if the line continues in another block; `next` is then its first voxel in that block.
static bool rasterize(const PublishedMarchInfo* info, const published_photon* a, const published_photon* b,
  __global ulong* packed, __global PublishedPhoton* photon, bool arrives, int3* next)
{
  const float3 change = b->position - a->position;
  const float3 size = fabs(change);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const float from = axis == 0 ? a->position.x : axis == 1 ? a->position.y : a->position.z;
  const float to = axis == 0 ? b->position.x : axis == 1 ? b->position.y : b->position.z;
  const int low = (int)ceil(fmin(from, to) - 0.5f), high = (int)ceil(fmax(from, to) - 0.5f);
  const int first = photon->done;
  for (int i = first; i < high - low; ++i)
  {
    const int cell = from < to ? low + i : high - 1 - i;
    const float t = (cell + 0.5f - from) / (to - from);
    const int3 voxel = arrives && i == first ? *next : convert_int3_rtn(a->position + t * change);
    if (!is_within(voxel, voxels_of(info->whole.size)))
    {
      continue;
    }
    if (!is_within(voxel - voxels_of(info->first), voxels_of(info->own.size)))
    {
      photon->done = i;
      *next = voxel;
      return false;
    }
    deposit(info, voxel, mix(a->power, b->power, t), normalize(mix(a->velocity, b->velocity, t)), packed, photon);
  }
  photon->done = high - low;
  return true;
}

static int face_left(const PublishedMarchInfo* info, float3 p)
{
  const float3 size = convert_float3(voxels_of(info->whole.size));
  const float3 before = -p, after = p - size;
  const float most = fmax(fmax(fmax(before.x, before.y), fmax(before.z, after.x)), fmax(after.y, after.z));
  return most == before.x ? 0
    : most == after.x     ? 1
    : most == before.y    ? 2
    : most == after.y     ? 3
    : most == before.z    ? 4
                          : 5;
}

typedef struct
{
  const PublishedMarchInfo* info;
  const __global float4* index;
  const __global float* sigma_a;
  const __global float* sigma_s;
  const __global uchar* levels;
} published_medium;

static published_photon step_from(const published_medium* medium, const published_photon* photon)
{
  const PublishedMarchInfo* info = medium->info;
  const float3 h = (float3)(info->spacing[0], info->spacing[1], info->spacing[2]);
  published_photon next = *photon;
#if BENDS
  const float4 n = index_at(info, medium->index, photon->position);
  const float3 u = photon->velocity / (n.w * h);
#else
  const float3 u = photon->velocity / h;
#endif
  const float ds = step_length(info, medium->levels, photon->position, u);
  next.position += ds * u;
#if BENDS
  next.velocity += ds * n.xyz / h;
#endif
  next.power *=
    exp(-ds * extinction(medium->sigma_a, medium->sigma_s, index_of(info, convert_int3_rtn(photon->position))));
  return next;
}

// Marches photons that start in the block, or have entered it, to their ends or into another block.
__kernel void march_published(PublishedMarchInfo info, const __global float4* index, const __global float* sigma_a,
  const __global float* sigma_s, const __global uchar* levels, __global PublishedPhoton* photons,
  __global ulong* packed)
{
  __global PublishedPhoton* photon = photons + get_global_id(0);
  const published_medium medium = { &info, index, sigma_a, sigma_s, levels };
  published_photon from = photon_at(&photon->from), to = photon_at(&photon->to);
  bool begins = photon->steps == 0, arrives = !begins;
#if BENDS
  from.velocity *= begins ? index_at(&info, index, from.position).w : 1.0f;
#endif
  int3 next = vload3(0, photon->voxel);
  for (;; begins = true, arrives = false)
  {
    if (begins)
    {
      to = step_from(&medium, &from);
      ++photon->steps;
      photon->done = 0;
    }
    if (!rasterize(&info, &from, &to, packed, photon, arrives, &next))
    {
      photon->face = PublishedElsewhere;
      break;
    }
    if (any(to.position < 0.0f) || any(to.position >= convert_float3(voxels_of(info.whole.size))))
    {
      photon->face = face_left(&info, to.position);
      break;
    }
    if (photon->steps == info.stepLimit)
    {
      photon->face = PublishedGivenUp;
      break;
    }
    next = convert_int3_rtn(to.position);
    if (!is_within(next - voxels_of(info.first), voxels_of(info.own.size)))
    {
      photon->face = PublishedElsewhere;
      break;
    }
    from = to;
  }
  put_at(&from, &photon->from);
  put_at(&to, &photon->to);
  vstore3(next, 0, photon->voxel);
}

// Unpacks the light of voxels.
//   fluence_of_unit  fluence, W / length^2, of one unit of power in a voxel
//   fluence    3 values per voxel, W / length^2
//   direction  3 values per voxel, mean direction
__kernel void unpack_light(
  float fluence_of_unit, const __global ulong* packed, __global float* fluence, __global float* direction)
{
  const size_t v = get_global_id(0);
  const float3 colour = from_rgbe((uint)packed[v]) * fluence_of_unit;
  const float3 mean = from_direction((uint)(packed[v] >> 32));
  vstore3(colour, v, fluence);
  vstore3(mean, v, direction);
}

// Applies one axis of the 3x3x3 Gaussian filter, with weights 1/4, 1/2, 1/4.
__kernel void smooth_along(int axis, IndexGrid box, const __global float* from, __global float* to)
{
  const int3 v = (int3)(get_global_id(0), get_global_id(1), get_global_id(2));
  const int3 step = (int3)(axis == 0, axis == 1, axis == 2);
  const float3 sum = 0.25f * (vload3(index_in(&box, v - step), from) + vload3(index_in(&box, v + step), from)) +
    0.5f * vload3(index_in(&box, v), from);
  vstore3(sum, index_in(&box, v), to);
}
