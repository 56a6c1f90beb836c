// Kernels of the conservative estimator (numerics.md, section 13.2). The host defines
//   BATCHES     number of independent batches, at least 2
//   CHANNELS    number of channels of the light, 1 or 3
//   DIRECTIONS  1: the light has mean directions
//   WOVEN       1: the grid's light is [voxel][batch][channel] with two batches; 0: [batch][voxel][channel]
//   FINEST      1: the finer level is the grid itself, in the host's layout; 0: rows of a level
//
// Fields of a pyramid level: first the light of each batch (sum of channels), then the quantities to be smoothed. These
// are the channels of the batches' mean light, and its flux (light times mean direction). The detail of a level is the
// level minus the interpolation of the next coarser level.

#include "Reconstruction/LightPyramidShared.h"
#include "Reconstruction/LightRows.cl"

#define CARRIED (CHANNELS + 3 * DIRECTIONS)
#define FIELDS (BATCHES + CARRIED)
// A result consists of CARRIED fields of smoothed quantities and two more fields. The field BLENDED is the pyramid
// level from which the light is taken; it is fractional where levels are blended. The field SQUARED is the squared
// error.
#define BLENDED CARRIED
#define SQUARED (BLENDED + 1)
#define RESULTS (CARRIED + BesideResults)

typedef struct
{
  pair batch[BATCHES];
  pair carried[CARRIED];
} light_pair;

// Loads the light of 2 REAL_WIDTH successive voxels (a pair of vectors) in each of the two batches, from an array
// [voxel][batch][channel].
#if WOVEN && CHANNELS == 1
inline void load_batches(const __global float* batches, size_t voxel, pair* light)
{
  const pair low = load_pair(2 * voxel, batches), high = load_pair(2 * voxel + 2 * REAL_WIDTH, batches);
  light[0] = (pair)(low.even, high.even);
  light[1] = (pair)(low.odd, high.odd);
}
#elif WOVEN
inline void load_batches(const __global float* batches, size_t voxel, pair_of_three* light)
{
  const pair_of_three low = load_three(2 * voxel, batches), high = load_three(2 * voxel + 2 * REAL_WIDTH, batches);
  light[0].x = (pair)(low.x.even, high.x.even);
  light[0].y = (pair)(low.y.even, high.y.even);
  light[0].z = (pair)(low.z.even, high.z.even);
  light[1].x = (pair)(low.x.odd, high.x.odd);
  light[1].y = (pair)(low.y.odd, high.y.odd);
  light[1].z = (pair)(low.z.odd, high.z.odd);
}
#endif

// Loads 2 REAL_WIDTH successive voxels of the grid (a pair of vectors), with light multiplied by `scale`.
inline light_pair load_voxels(
  const __global float* batches, const __global float* directions, int4 size, size_t voxel, float scale)
{
  light_pair light;
#if CHANNELS == 1
  pair given[BATCHES];
#else
  pair_of_three given[BATCHES];
#endif
#if WOVEN
  load_batches(batches, voxel, given);
#else
  const size_t all = (size_t)size.w * size.y * size.z;
#pragma unroll
  for (int b = 0; b < BATCHES; ++b)
  {
#if CHANNELS == 1
    given[b] = load_pair(b * all + voxel, batches);
#else
    given[b] = load_three(b * all + voxel, batches);
#endif
  }
#endif
#pragma unroll
  for (int c = 0; c < CARRIED; ++c)
  {
    light.carried[c] = 0.0f;
  }
#pragma unroll
  for (int b = 0; b < BATCHES; ++b)
  {
#if CHANNELS == 1
    light.batch[b] = scale * given[b];
    light.carried[0] += light.batch[b];
#else
    const pair_of_three colour = given[b];
    light.carried[0] += scale * colour.x;
    light.carried[1] += scale * colour.y;
    light.carried[2] += scale * colour.z;
    light.batch[b] = scale * colour.x + scale * colour.y + scale * colour.z;
#endif
  }
  pair total = 0.0f;
#pragma unroll
  for (int c = 0; c < CHANNELS; ++c)
  {
    light.carried[c] *= 1.0f / BATCHES;
    total += light.carried[c];
  }
#if DIRECTIONS
  const pair_of_three direction = load_three(voxel, directions);
  light.carried[CHANNELS] = total * direction.x;
  light.carried[CHANNELS + 1] = total * direction.y;
  light.carried[CHANNELS + 2] = total * direction.z;
#endif
  return light;
}

inline void add_voxels(pair* sum, const __global float* batches, const __global float* directions, int4 size,
  const size_t* rows, int x, float scale)
{
  const float weights[4] = { 0.125f, 0.375f, 0.375f, 0.125f };
#pragma unroll
  for (int f = 0; f < FIELDS; ++f)
  {
    sum[f] = 0.0f;
  }
  for (int k = 0; k < 16; ++k)
  {
    const light_pair light = load_voxels(batches, directions, size, rows[k] + x, scale);
    const float w = weights[k % 4] * weights[k / 4];
#pragma unroll
    for (int b = 0; b < BATCHES; ++b)
    {
      sum[b] += w * light.batch[b];
    }
#pragma unroll
    for (int c = 0; c < CARRIED; ++c)
    {
      sum[BATCHES + c] += w * light.carried[c];
    }
  }
}

#if REAL_WIDTH == 8
#define shifted_up(before, values) \
  (float8)((before).sf, (values).s0, (values).s1, (values).s2, (values).s3, (values).s4, (values).s5, (values).s6)
#define shifted_down(values, after) \
  (float8)((values).s1, (values).s2, (values).s3, (values).s4, (values).s5, (values).s6, (values).s7, (after).s0)
#define first_of(p) ((p).s0)
#define last_of(p) ((p).sf)
#else
#define shifted_up(before, values) ((before).y)
#define shifted_down(values, after) ((after).x)
#define first_of(p) ((p).x)
#define last_of(p) ((p).y)
#endif

// Computes pyramid level 1, whose cells are 2 x 2 x 2 voxels, from the grid's voxels with weights 1 3 3 1 along each
// axis. One pass computes all fields: the light of each batch, then channels and flux of the mean light.
__kernel void voxels_down(const __global float* batches, const __global float* directions, int4 fine_size,
  __global float* coarse, int4 size, float scale)
{
  const int y = ROW_Y, z = ROW_Z;
  size_t rows[16];
  for (int k = 0; k < 16; ++k)
  {
    rows[k] = ((size_t)within(2 * z + k / 4 - 1, fine_size.z) * fine_size.y + within(2 * y + k % 4 - 1, fine_size.y)) *
      fine_size.w;
  }
  const int wide = 2 * REAL_WIDTH;
  pair before[FIELDS], here[FIELDS], after[FIELDS];
#if REAL_WIDTH > 1
  add_voxels(here, batches, directions, fine_size, rows, 0, scale);
#pragma unroll
  for (int f = 0; f < FIELDS; ++f)
  {
    before[f] = (pair)first_of(here[f]);
  }
#endif
  FOR_CELLS(x, size.x)
  {
    const int at = 2 * x;
#if REAL_WIDTH == 1
    add_voxels(here, batches, directions, fine_size, rows, at, scale);
    add_voxels(before, batches, directions, fine_size, rows, max(at - wide, 0), scale);
#endif
    add_voxels(after, batches, directions, fine_size, rows, min(at + wide, fine_size.w - wide), scale);
#pragma unroll
    for (int f = 0; f < FIELDS; ++f)
    {
      const pair left = x > 0 ? before[f] : (pair)first_of(here[f]);
      const pair right = at + wide < fine_size.w ? after[f] : (pair)last_of(here[f]);
      const real even = here[f].even, odd = here[f].odd;
      const real cells = 0.375f * (even + odd) + 0.125f * (shifted_up(left, odd) + shifted_down(even, right));
      __global float* row = coarse + row_of(size, f, y, z);
      store_real(cells, x, row);
      repeat_ends(row, x, REAL_WIDTH, size.x);
      before[f] = here[f];
      here[f] = after[f];
    }
  }
}

// Loads all fields in two vectors of successive cells of a row: with FINEST from the grid's voxels, else from the rows
// of a pyramid level.
inline light_pair load_light(
  const __global float* fine, const __global float* directions, int4 size, int x, int y, int z, float scale)
{
  if (FINEST)
  {
    return load_voxels(fine, directions, size, ((size_t)z * size.y + y) * size.w + x, scale);
  }
  const __global float* row = fine + row_of(size, 0, y, z) + x;
  const size_t field = field_of(size);
  light_pair light;
#pragma unroll
  for (int b = 0; b < BATCHES; ++b)
  {
    light.batch[b] = load_pair(b * field, row);
  }
#pragma unroll
  for (int c = 0; c < CARRIED; ++c)
  {
    light.carried[c] = load_pair((BATCHES + c) * field, row);
  }
  return light;
}

// Measures noise and light in the details of a level, in cells of 2 x 2 x 2 (numerics.md, Eq. (101)). A detail is the
// level minus the interpolation of the next coarser level. Field 0 is the noise, that is, the variance of the batches'
// mean detail d: sum (d_b - d)^2 / (B (B - 1)). Field 1 is d^2.
__kernel void measure_details(const __global float* fine, const __global float* directions, int4 fine_size, float scale,
  const __global float* coarse, int4 size, __global float* measured)
{
  const int y = ROW_Y, z = ROW_Z;
  rows_about rows[4];
  for (int k = 0; k < 4; ++k)
  {
    rows[k] = rows_for_children(size, y, z, k);
  }
  const size_t field = field_of(size);
  FOR_CELLS(x, size.x)
  {
    real squares = 0.0f, total = 0.0f, common = 0.0f;
    for (int k = 0; k < 4; ++k)
    {
      const int fy = min(2 * y + k % 2, fine_size.y - 1), fz = min(2 * z + k / 2, fine_size.z - 1);
      const light_pair light = load_light(fine, directions, fine_size, 2 * x, fy, fz, scale);
      real first[2], sum[2] = { 0.0f, 0.0f };
#pragma unroll
      for (int b = 0; b < BATCHES; ++b)
      {
        const children finer = interpolate(coarse + b * field, &rows[k], x);
        const real detail[2] = { light.batch[b].even - finer.even, light.batch[b].odd - finer.odd };
#pragma unroll
        for (int i = 0; i < 2; ++i)
        {
          if (b == 0)
          {
            first[i] = detail[i];
          }
          else // details are summed relative to the first batch's, to avoid cancellation
          {
            const real other = detail[i] - first[i];
            sum[i] += other;
            squares += other * other;
          }
        }
      }
#pragma unroll
      for (int i = 0; i < 2; ++i)
      {
        const real mean = first[i] + sum[i] * (1.0f / BATCHES);
        total += mean * mean;
        common += sum[i] * sum[i];
      }
    }
    const real noise = (squares - common * (1.0f / BATCHES)) * (0.125f / (BATCHES * (BATCHES - 1)));
    __global float* row = measured + row_of(size, 0, y, z);
    store_real(positive_part(noise), x, row);
    store_real(0.125f * total, x, row + field);
    repeat_ends(row, x, REAL_WIDTH, size.x);
    repeat_ends(row + field, x, REAL_WIDTH, size.x);
  }
}

// Smooths `fields` quantities of a level, from number `first` on, with binomial weights 1 4 6 4 1 along y and z. The
// kernels that read the output smooth along x.
__kernel void smooth_across(const __global float* from, int4 size, __global float* to, int first, int fields)
{
  const float weights[5] = { 0.0625f, 0.25f, 0.375f, 0.25f, 0.0625f };
  const int y = ROW_Y, z = ROW_Z;
  size_t rows[25];
  for (int k = 0; k < 25; ++k)
  {
    rows[k] = row_of(size, first, y + k % 5 - 2, z + k / 5 - 2);
  }
  for (int f = 0; f < fields; ++f)
  {
    const __global float* cells = from + f * field_of(size);
    __global float* row = to + row_of(size, f, y, z);
    FOR_CELLS(x, size.x)
    {
      real sum = 0.0f;
#pragma unroll
      for (int dz = 0; dz < 5; ++dz)
      {
        real along = 0.0f;
#pragma unroll
        for (int dy = 0; dy < 5; ++dy)
        {
          along += weights[dy] * load_real(rows[5 * dz + dy] + x, cells);
        }
        sum += weights[dz] * along;
      }
      store_real(sum, x, row);
      repeat_ends(row, x, REAL_WIDTH, size.x);
    }
  }
}

inline real smoothed(const __global float* row, int x)
{
  return 0.375f * load_real(x, row) + 0.25f * (load_real(x - 1, row) + load_real(x + 1, row)) +
    0.0625f * (load_real(x - 2, row) + load_real(x + 2, row));
}

// Computes the Wiener gain, the fraction of a level's details that is kept (numerics.md, Eq. (102)). A detail is the
// level minus the interpolation of the next coarser level. Twice the noise is subtracted, so that random fluctuations
// are not mistaken for light.
__kernel void find_gains(const __global float* measured, int4 size, __global float* gains)
{
  const int y = ROW_Y, z = ROW_Z;
  const size_t field = field_of(size);
  const __global float* row = measured + row_of(size, 0, y, z);
  __global float* to = gains + row_of(size, 0, y, z);
  FOR_CELLS(x, size.x)
  {
    const real noise = smoothed(row, x), total = smoothed(row + field, x);
    const real sure = positive_part(total - 2.0f * noise);
    const real gain = select((real)0.0f, sure / (sure + noise), sure > 0.0f);
    store_real(gain, x, to + GainField * field);
    store_real((1.0f - gain) * (1.0f - gain) * (total - noise), x, to + RemovedField * field);
    store_real(gain * gain * noise, x, to + KeptField * field);
    repeat_ends(to + GainField * field, x, REAL_WIDTH, size.x);
    repeat_ends(to + RemovedField * field, x, REAL_WIDTH, size.x);
  }
}

// Adds up the squared error (numerics.md, Eq. (104)). It has three parts: noise that was kept, light that was removed
// as noise (times `honesty`), and the error of the coarser levels.
__kernel void add_errors(
  const __global float* removed, int4 size, float honesty, const __global float* results, __global float* gains)
{
  const int y = ROW_Y, z = ROW_Z;
  const size_t field = field_of(size);
  const __global float* row = removed + row_of(size, 0, y, z);
  const __global float* above = results + row_of(size, SQUARED, y, z);
  __global float* cells = gains + row_of(size, 0, y, z);
  FOR_CELLS(x, size.x)
  {
    const real here =
      multiply_add((real)honesty, positive_part(smoothed(row, x)), load_real(KeptField * field + x, cells));
    store_real(load_real(x, above) + here, ErrorField * field + x, cells);
    repeat_ends(cells + ErrorField * field, x, REAL_WIDTH, size.x);
  }
}

// Computes the result of the top level of the pyramid. The quantities to be smoothed are taken unchanged (gain 1). The
// noise, which is the variance of the batches' mean light, is smoothed before begin_errors stores it as the squared
// error.
__kernel void begin_results(
  const __global float* level, int4 size, __global float* results, float top, __global float* noise)
{
  const int y = ROW_Y, z = ROW_Z;
  const size_t field = field_of(size);
  const __global float* from = level + row_of(size, 0, y, z);
  __global float* to = results + row_of(size, 0, y, z);
  __global float* deviation = noise + row_of(size, 0, y, z);
  FOR_CELLS(x, size.x)
  {
    real mean = 0.0f, squares = 0.0f;
#pragma unroll
    for (int b = 0; b < BATCHES; ++b)
    {
      mean += load_real(b * field + x, from);
    }
    mean *= 1.0f / BATCHES;
#pragma unroll
    for (int b = 0; b < BATCHES; ++b)
    {
      const real off = load_real(b * field + x, from) - mean;
      squares += off * off;
    }
#pragma unroll
    for (int c = 0; c < CARRIED; ++c)
    {
      store_real(load_real((BATCHES + c) * field + x, from), c * field + x, to);
    }
    store_real((real)top, BLENDED * field + x, to);
    store_real(squares * (1.0f / (BATCHES * (BATCHES - 1))), x, deviation);
    repeat_ends(deviation, x, REAL_WIDTH, size.x);
    for (int f = 0; f < SQUARED; ++f)
    {
      repeat_ends(to + f * field, x, REAL_WIDTH, size.x);
    }
  }
}

__kernel void begin_errors(const __global float* noise, int4 size, __global float* results)
{
  const int y = ROW_Y, z = ROW_Z;
  const __global float* row = noise + row_of(size, 0, y, z);
  __global float* to = results + row_of(size, SQUARED, y, z);
  FOR_CELLS(x, size.x)
  {
    store_real(smoothed(row, x), x, to);
    repeat_ends(to, x, REAL_WIDTH, size.x);
  }
}

#if DIRECTIONS
// Factor that converts a flux (x, y, z) to the mean direction of light. `total` is the sum of the light's channels. The
// factor limits the direction's length to 1, and is 0 where there is no light.
inline real direction_of(real total, real x, real y, real z)
{
  const real cut = select((real)0.0f, 1.0f / total, total > 0.0f);
  const real square = (x * cut) * (x * cut) + (y * cut) * (y * cut) + (z * cut) * (z * cut);
  if (any_of(square > 1.0f)) // rarely true
  {
    return select(cut, cut / sqrt(square), square > 1.0f);
  }
  return cut;
}
#endif

// Stores the light and mean direction of two vectors of voxels, computed from their smoothed quantities.
inline __attribute__((always_inline)) void store_voxels(
  const children* smooth, float unit, size_t voxel, __global float* fluence, __global float* mean_direction)
{
  children total = { 0.0f, 0.0f };
  pair light[3];
#pragma unroll
  for (int c = 0; c < CHANNELS; ++c)
  {
    const real even = positive_part(smooth[c].even), odd = positive_part(smooth[c].odd);
    total.even += even;
    total.odd += odd;
    light[c] = woven(even * unit, odd * unit);
  }
#if CHANNELS == 1
  store_pair(light[0], voxel, fluence);
#else
  store_three(light[0], light[1], light[2], voxel, fluence);
#endif
#if DIRECTIONS
  const children *x = smooth + CHANNELS, *y = x + 1, *z = x + 2;
  const real even = direction_of(total.even, x->even, y->even, z->even);
  const real odd = direction_of(total.odd, x->odd, y->odd, z->odd);
  store_three(woven(x->even * even, x->odd * odd), woven(y->even * even, y->odd * odd),
    woven(z->even * even, z->odd * odd), voxel, mean_direction);
#endif
}

// Computes the result of a level: the interpolated result of the next coarser level, plus the gain times the details of
// this level.
//   fine, fine_size, directions, scale   light of this level
//   coarse, results, gains               light, result and gains of the next coarser level, of `size`
//   to          output: rows of RESULTS fields of this level; with FINEST the fluence of the grid's voxels
//   number      number of this level, from 0
//   mean_direction, blended     output with FINEST: mean direction of each voxel, and the level from which its
//               light was taken
__kernel void blend_level(const __global float* fine, const __global float* directions, int4 fine_size, float scale,
  const __global float* coarse, const __global float* results, const __global float* gains, int4 size, float number,
  __global float* to, __global float* mean_direction, __global float* blended)
{
  const int y = ROW_Y, z = ROW_Z;
  const size_t field = field_of(size);
  const float unit = 1.0f / scale;
  const size_t fine_field = field_of(fine_size);
  // The loop over the four rows of children is outermost, so that only one row of each quantity of this level is read
  // at a time. Hardware prefetches a few rows, but not four rows of every quantity.
  for (int k = 0; k < 4; ++k)
  {
    const rows_about rows = rows_for_children(size, y, z, k);
    const int fy = min(2 * y + k % 2, fine_size.y - 1), fz = min(2 * z + k / 2, fine_size.z - 1);
    const bool outside = fy < 2 * y + k % 2 || fz < 2 * z + k / 2;
    FOR_CELLS(x, size.x)
    {
      const light_pair light = load_light(fine, directions, fine_size, 2 * x, fy, fz, scale);
      const children gain = interpolate(gains + GainField * field, &rows, x);
      children kept[CARRIED];
#pragma unroll
      for (int c = 0; c < CARRIED; ++c)
      {
        const children finer = interpolate(coarse + (BATCHES + c) * field, &rows, x);
        kept[c] = interpolate(results + c * field, &rows, x);
        kept[c].even = multiply_add(gain.even, light.carried[c].even - finer.even, kept[c].even);
        kept[c].odd = multiply_add(gain.odd, light.carried[c].odd - finer.odd, kept[c].odd);
      }
      if (outside)
      {
        continue;
      }
      const children above = interpolate(results + BLENDED * field, &rows, x);
      const pair level =
        woven(above.even + gain.even * (number - above.even), above.odd + gain.odd * (number - above.odd));
      if (FINEST)
      {
        const size_t voxel = ((size_t)fz * fine_size.y + fy) * fine_size.w + 2 * x;
        store_voxels(kept, unit, voxel, to, mean_direction);
        store_pair(level, voxel, blended);
        continue;
      }
      __global float* row = to + row_of(fine_size, 0, fy, fz) + 2 * x;
      const children squared = interpolate(gains + ErrorField * field, &rows, x);
#pragma unroll
      for (int c = 0; c < CARRIED; ++c)
      {
        store_pair(woven(kept[c].even, kept[c].odd), c * fine_field, row);
      }
      store_pair(level, BLENDED * fine_field, row);
      store_pair(woven(squared.even, squared.odd), SQUARED * fine_field, row);
      for (int f = 0; f < RESULTS; ++f)
      {
        repeat_ends(row - 2 * x + f * fine_field, 2 * x, 2 * REAL_WIDTH, fine_size.x);
      }
    }
  }
}

// Scales each channel of the light to conserve its total, and computes the standard errors. The error of the sum of
// channels is divided among them in proportion to their light.
__kernel void finish_light(const __global float* gains, int4 size, float4 conserve, float unit, __global float* fluence,
  __global float* errors, int4 fine_size)
{
  const int y = ROW_Y, z = ROW_Z;
  rows_about rows[4];
  for (int k = 0; k < 4; ++k)
  {
    rows[k] = rows_for_children(size, y, z, k);
  }
  FOR_CELLS(x, size.x)
  {
    for (int k = 0; k < 4; ++k)
    {
      const int fy = 2 * y + k % 2, fz = 2 * z + k / 2;
      if (fy < fine_size.y && fz < fine_size.z)
      {
        const children error = interpolate(gains + ErrorField * field_of(size), &rows[k], x);
        const size_t voxel = ((size_t)fz * fine_size.y + fy) * fine_size.w + 2 * x;
        const pair deviation = unit * sqrt(positive_part(woven(error.even, error.odd)));
#if CHANNELS == 1
        store_pair(load_pair(voxel, fluence) * conserve.x, voxel, fluence);
        store_pair(deviation * conserve.x, voxel, errors);
#else
        const pair_of_three light = load_three(voxel, fluence);
        const pair_of_three scaled = { light.x / unit, light.y / unit, light.z / unit };
        const pair total = scaled.x + scaled.y + scaled.z;
        const pair share = select((pair)0.0f, deviation / total, total > 0.0f);
        const pair even_share = select(deviation * (1.0f / 3.0f), (pair)0.0f, total > 0.0f);
        store_three(light.x * conserve.x, light.y * conserve.y, light.z * conserve.z, voxel, fluence);
        store_three((scaled.x * share + even_share) * conserve.x, (scaled.y * share + even_share) * conserve.y,
          (scaled.z * share + even_share) * conserve.z, voxel, errors);
#endif
      }
    }
  }
}
