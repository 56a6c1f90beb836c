// Kernels that convert the sums of photons' deposits to light. The host defines
//   CHANNELS, DIRECTIONS, COUNTS  as in PhotonMarch.cl
//   CARRIES                 1: when the absorbed and scattered power of a voxel is truncated to whole units, the
//                           fraction is carried to the next voxel of the row. Needed if units are large: half a
//                           unit per voxel would be lost otherwise
//   BRICKS                  1: the sums are stored by bricks (MarchMedium.h)
//   COLOURS                 channels of the output; may be 3 with CHANNELS 1, where one channel stands for all three
// "Units" are the fixed-point units of power in which deposits are summed, PackedPhotons::unit watts each.

#include "Medium/BrickShared.h"
#include "Numerics/Numerics.cl"
#include "Photons/Marching/MarchShared.h"

#define RECORD (CHANNELS + 3 * DIRECTIONS + COUNTS)
#define component(values, count, voxel, c) \
  ((count) == 0 ? 0.0f : (values)[(voxel) * (count) + ((count) == 3 ? (c) : 0)])

// Writes the fluence of channel c to the same channel of the output, or to all output channels if CHANNELS is 1.
//   path  sum over photons of power (in units of PackedPhotons::unit) times path length (in voxel diagonals) in
//         channel c
static void put_fluence(const LightSumsInfo* info, __global float* voxel, int c, float path)
{
  if (CHANNELS == COLOURS)
  {
    voxel[c] = ldexp(path * info->fluence, info->exponent);
    return;
  }
  for (int out = 0; out < COLOURS; ++out)
  {
    voxel[out] = ldexp(path * info->fluence * info->colour[out], info->exponent);
  }
}

// Power, in fixed-point units, that a voxel absorbs or scatters; `coefficient` is its sigma_a or its sigma_s. In an
// optically thick voxel the sum of deposits is the power that the photons lost, and the fraction coefficient /
// extinction of it is returned.
//   carried  with CARRIES: fraction of a unit that remained from the previous voxel; receives the fraction that remains
//            from this voxel
static long taken_by(const LightSumsInfo* info, float sum, float coefficient, float extinction, float* carried)
{
  const float thickness = info->diagonal * extinction;
  const float taken = sum * (thickness > 1.0f ? coefficient / extinction : info->diagonal * coefficient);
  const float all = CARRIES ? taken + *carried : taken;
  if (CARRIES)
  {
    *carried = all - trunc(all);
  }
  return (long)all;
}

// Adds up those sums of a voxel that belong to one batch, and sets them to 0. There are info->copies copies of the
// sums; copy w belongs to batch w modulo info->batches. Returns false if all sums were 0.
//   record      the voxel's RECORD sums in the first copy
//   copyStride  distance from one copy of these sums to the next
static bool take_batch(const LightSumsInfo* info, __global long* record, ulong copyStride, int batch, long* sum)
{
  for (int c = 0; c < RECORD; ++c)
  {
    sum[c] = 0;
  }
  bool any = false;
  for (int w = batch; w < info->copies; w += info->batches)
  {
    __global long* here = record + w * copyStride;
    long bits = 0;
    for (int c = 0; c < RECORD; ++c)
    {
      sum[c] += here[c];
      bits |= here[c];
    }
    if (bits != 0) // records that are 0 already, typically half of the memory, need not be written
    {
      any = true;
      for (int c = 0; c < RECORD; ++c)
      {
        here[c] = 0;
      }
    }
  }
  return any;
}

#if DIRECTIONS
// Writes the mean direction of the light, of length at most 1. It is computed from whole fixed-point units, so it is
// coarse in a voxel whose sum is only a few units of power.
static void put_direction(__global float* mean_direction, const long* sum, float total)
{
  const float3 flow = (float3)(sum[CHANNELS], sum[CHANNELS + 1], sum[CHANNELS + 2]);
  const float most = fmax(total, length(flow));
  const float part = total > 0.0f ? 1.0f / most : 0.0f;
  for (int a = 0; a < 3; ++a)
  {
    mean_direction[a] = sum[CHANNELS + a] * part;
  }
}
#endif

// Power of each channel that is absorbed ([0]) and scattered ([1]): whole fixed-point units, and the fraction of a unit
// that is carried to the next voxel.
typedef struct
{
  long units[2][CHANNELS];
  float carried[2][CHANNELS];
} taken_power;

static taken_power nothing_taken()
{
  taken_power taken;
  for (int c = 0; c < CHANNELS; ++c)
  {
    taken.units[0][c] = taken.units[1][c] = 0;
    taken.carried[0][c] = taken.carried[1][c] = 0.0f;
  }
  return taken;
}

// Stores the power that a work-item's voxels absorb and scatter, as [absorbed, scattered][CHANNELS] in fixed-point
// units.
static void store_taken(const taken_power* taken, __global long* to)
{
  for (int c = 0; c < 2 * CHANNELS; ++c)
  {
    const bool more = CARRIES && taken->carried[c / CHANNELS][c % CHANNELS] >= 0.5f;
    to[c] = taken->units[c / CHANNELS][c % CHANNELS] + more;
  }
}

// Optical thickness of a voxel's diagonal, at least 1. It uses sigma_a + sigma_s of the medium (`extinction`,
// 1/length), since the extinction packed for the photons is limited to a finite range.
static float thickness_of(const LightSumsInfo* info, float extinction)
{
  return fmax(info->diagonal * extinction, 1.0f);
}

// Converts the sums of one record to the light of a voxel. If sums are stored by bricks, the record of an empty brick
// stands for all its voxels: the light is then the mean over these `voxels` voxels.
//   record  index of the record, also in sigma_a and sigma_s
static void finish_record(const LightSumsInfo* info, const __global float* sigma_a, const __global float* sigma_s,
  size_t record, const long* sum, float voxels, __global float* fluence, __global float* mean_direction,
  taken_power* taken)
{
  float total = 0.0f;
  for (int c = 0; c < CHANNELS; ++c)
  {
    const float a = component(sigma_a, info->absorption, record, c),
                s = component(sigma_s, info->scattering, record, c);
    total += sum[c];
    // Power times path length in diagonals: the sum of deposits, divided by b of numerics.md, Eq. (98), and by the
    // number of voxels that share the record.
    put_fluence(info, fluence, c, (float)sum[c] / (thickness_of(info, a + s) * voxels));
    taken->units[0][c] += taken_by(info, sum[c], a, a + s, &taken->carried[0][c]);
    taken->units[1][c] += taken_by(info, sum[c], s, a + s, &taken->carried[1][c]);
  }
#if DIRECTIONS
  put_direction(mean_direction, sum, total);
#endif
}

// Converts the sums to light, one row of voxels per work-item: adds up the copies of the sums and sets them to 0.
//   fluence         COLOURS values per voxel
//   mean_direction  3 values per voxel: sum of power times direction over sum of power, no longer than 1; 0 in dark
//                   voxels
//   photon_count    one value per voxel; photon_weight: mean weight of the counted photons, 0 if there are none
//   batch_fluence   [voxel][batch][COLOURS] fluence of each batch, as if it carried all the power
//   taken           [row][absorbed, scattered][CHANNELS], power in units of PackedPhotons::unit
__kernel void finish_light(LightSumsInfo info, const __global float* sigma_a, const __global float* sigma_s,
  __global long* sums, ulong copyStride, __global float* fluence, __global float* mean_direction,
  __global float* photon_count, __global float* photon_weight, __global float* batch_fluence, __global long* taken)
{
  const int r = get_global_id(0);
  const int nx = info.grid.size[0], ny = info.grid.size[1];
  const size_t first = ((size_t)(r / ny + 1) * (ny + 2) + r % ny + 1) * (nx + 2) + 1;
  taken_power ofRow = nothing_taken();
  for (int x = 0; x < nx; ++x)
  {
    const size_t voxel = (size_t)r * nx + x;
    long sum[RECORD];
    for (int c = 0; c < RECORD; ++c)
    {
      sum[c] = 0;
    }
    for (int b = 0; b < info.batches; ++b)
    {
      long part[RECORD];
      take_batch(&info, sums + (first + x) * RECORD, copyStride, b, part);
      for (int c = 0; c < RECORD; ++c)
      {
        sum[c] += part[c];
      }
      for (int c = 0; c < CHANNELS && info.batches > 1; ++c)
      {
        const float extinction =
          component(sigma_a, info.absorption, voxel, c) + component(sigma_s, info.scattering, voxel, c);
        put_fluence(&info, batch_fluence + (voxel * info.batches + b) * COLOURS, c,
          (float)part[c] / thickness_of(&info, extinction) * info.batches);
      }
    }
    finish_record(
      &info, sigma_a, sigma_s, voxel, sum, 1.0f, fluence + voxel * COLOURS, mean_direction + voxel * 3, &ofRow);
#if COUNTS
    const ulong counted = sum[RECORD - 1], weights = counted & (((ulong)1 << CountShift) - 1);
    const float photons = counted >> CountShift;
    photon_count[voxel] = photons;
    photon_weight[voxel] = photons > 0.0f ? weights / photons * info.weight : 0.0f;
#endif
  }
  store_taken(&ofRow, taken + (size_t)r * 2 * CHANNELS);
}

#if BRICKS
// Number of bricks along x and y.
static int2 bricks_across(const LightSumsInfo* info)
{
  return (int2)((info->grid.size[0] + BrickEdge - 1) / BrickEdge, (info->grid.size[1] + BrickEdge - 1) / BrickEdge);
}

static void leave_dark(__global float* fluence, __global float* mean_direction, size_t voxel)
{
  for (int c = 0; c < COLOURS; ++c)
  {
    fluence[voxel * COLOURS + c] = 0.0f;
  }
#if DIRECTIONS
  vstore3((float3)(0.0f), voxel, mean_direction);
#endif
}

// Converts the sums to light as finish_light does, but for sums stored by bricks (MarchMedium.h), one brick per
// work-item. One batch, and no counts.
//   sigma_a, sigma_s  of each record
//   fluence, mean_direction  of each voxel; in an empty brick only the lowest voxel is written, with the mean over
//                            the brick, which fill_empty then copies
//   taken             [brick][absorbed, scattered][CHANNELS], power in units
__kernel void finish_bricks(LightSumsInfo info, const __global int* bricks, const __global float* sigma_a,
  const __global float* sigma_s, __global long* sums, ulong copyStride, __global float* fluence,
  __global float* mean_direction, __global long* taken)
{
  const int brick = get_global_id(0), first = bricks[brick];
  const int2 n = bricks_across(&info);
  const int place[3] = { brick % n.x, brick / n.x % n.y, brick / (n.x * n.y) };
  int size[3];
  for (int a = 0; a < 3; ++a)
  {
    size[a] = min((int)BrickEdge, info.grid.size[a] - place[a] * BrickEdge);
  }
  const float voxels = first < 0 ? size[0] * size[1] * size[2] : 1;
  const size_t strideY = info.grid.size[0], strideZ = strideY * info.grid.size[1];
  const size_t low = place[2] * BrickEdge * strideZ + place[1] * BrickEdge * strideY + place[0] * BrickEdge;
  taken_power ofBrick = nothing_taken();
  for (int z = 0; z < (first < 0 ? 1 : size[2]); ++z)
  {
    for (int y = 0; y < (first < 0 ? 1 : size[1]); ++y)
    {
      for (int x = 0; x < (first < 0 ? 1 : size[0]); ++x)
      {
        const size_t voxel = low + z * strideZ + y * strideY + x;
        const size_t record = first < 0 ? -first : first + (z * BrickEdge + y) * BrickEdge + x;
        long sum[RECORD];
        if (!take_batch(&info, sums + record * RECORD, copyStride, 0, sum)) // false in most voxels, as photons are few
        {
          leave_dark(fluence, mean_direction, voxel);
          continue;
        }
        finish_record(&info, sigma_a, sigma_s, record, sum, voxels, fluence + voxel * COLOURS,
          mean_direction + voxel * 3, &ofBrick);
      }
    }
  }
  store_taken(&ofBrick, taken + (size_t)brick * 2 * CHANNELS);
}

#if defined(__has_builtin)
#if __has_builtin(__builtin_nontemporal_store)
#define STORE_PAST_CACHES 1
#endif
#endif

// Stores values to an aligned address, bypassing the caches. The array is far larger than the caches, and its memory
// need not be read before it is written.
static void store_past_caches(float4 values, __global float* to)
{
#ifdef STORE_PAST_CACHES
  __builtin_nontemporal_store(values, (__global float4*)to);
#else
  vstore4(values, 0, to);
#endif
}

// Stores the same one or three components in each voxel from `begin` to `end`.
static void fill_voxels(__global float* values, size_t begin, size_t end, float3 value, int components)
{
  __global float* const to = values + begin * components;
  if (end - begin != BrickEdge || ((size_t)to & (sizeof(float4) - 1)) != 0)
  {
    for (size_t i = 0; i < end - begin; ++i)
    {
      if (components == 3)
      {
        vstore3(value, i, to);
      }
      else
      {
        to[i] = value.x;
      }
    }
  }
  else if (components == 3)
  {
    for (int at = 0; at < 24; at += 12)
    {
      store_past_caches(value.xyzx, to + at);
      store_past_caches(value.yzxy, to + at + 4);
      store_past_caches(value.zxyz, to + at + 8);
    }
  }
  else
  {
    store_past_caches(value.xxxx, to);
    store_past_caches(value.xxxx, to + 4);
  }
}

// Copies the light of the lowest voxel in each empty brick to the brick's other voxels. Work-items proceed row by row
// along x, so that memory is written sequentially.
__kernel void fill_empty(
  LightSumsInfo info, const __global int* bricks, __global float* fluence, __global float* mean_direction)
{
  const int r = get_global_id(0), nx = info.grid.size[0], ny = info.grid.size[1];
  const int y = r % ny, z = r / ny, within = BrickEdge - 1;
  const int2 n = bricks_across(&info);
  const size_t row = (size_t)r * nx, lowest = ((size_t)(z & ~within) * ny + (y & ~within)) * nx;
  for (int b = 0; b < n.x; ++b)
  {
    if (bricks[((z >> BrickBits) * n.y + (y >> BrickBits)) * n.x + b] >= 0)
    {
      continue;
    }
    const size_t from = lowest + b * BrickEdge;
    const size_t begin = row + b * BrickEdge + (row == lowest ? 1 : 0), end = row + min((b + 1) * (int)BrickEdge, nx);
    fill_voxels(fluence, begin, end, COLOURS == 3 ? vload3(from, fluence) : (float3)(fluence[from]), COLOURS);
#if DIRECTIONS
    fill_voxels(mean_direction, begin, end, vload3(from, mean_direction), 3);
#endif
  }
}
#endif

// Converts the sums accumulated so far to fluence, as finish_light does, but without changing the sums. One row of
// voxels per work-item.
__kernel void show_light(LightSumsInfo info, const __global float* sigma_a, const __global float* sigma_s,
  const __global long* sums, ulong copyStride, __global float* fluence)
{
  const int r = get_global_id(0);
  const int nx = info.grid.size[0], ny = info.grid.size[1];
  const size_t first = ((size_t)(r / ny + 1) * (ny + 2) + r % ny + 1) * (nx + 2) + 1;
  for (int x = 0; x < nx; ++x)
  {
    const size_t voxel = (size_t)r * nx + x;
    for (int c = 0; c < CHANNELS; ++c)
    {
      long sum = 0;
      for (int w = 0; w < info.copies; ++w)
      {
        sum += sums[(first + x) * RECORD + c + w * copyStride];
      }
      const float extinction =
        component(sigma_a, info.absorption, voxel, c) + component(sigma_s, info.scattering, voxel, c);
      put_fluence(&info, fluence + voxel * COLOURS, c, (float)sum / thickness_of(&info, extinction));
    }
  }
}
