// Chooses a pyramid level for each voxel and interpolates the light there; one work-item per row (or voxel). The host
// defines
//   CHANNELS, DIRECTIONS  number of channels of the light, and whether it has mean directions; the fields of its
//                         pyramid are the channels, then the mean direction
//
// Levels are processed one by one for a vector of voxels, and each voxel keeps the value of its chosen level.
// Adjacent voxels of a row lie between the same cells of a level, so that no gather is needed.

#include "Reconstruction/LightPyramidShared.h"
#include "Reconstruction/LightRows.cl"

// A row of voxels lies between four rows of a level. Holds these rows, y fastest, and the interpolation weights along y
// and z.
typedef struct
{
  size_t at[4];
  size_t field;
  float y, z;
  float cell; // 1 / (voxels per cell along an axis)
  int first;  // position along x of the row's first voxel among the voxels that the level covers, a multiple of 8
} rows_between;

inline rows_between rows_beside(const __global PyramidLevels* where, int level, int y, int z)
{
  const int4 size = where->size[level], first = where->first[level];
  const float cell = 1.0f / (float)(1 << level);
  const float at_y = ((float)(y + first.y) + 0.5f) * cell - 0.5f, at_z = ((float)(z + first.z) + 0.5f) * cell - 0.5f;
  const float low_y = floor(at_y), low_z = floor(at_z);
  rows_between r;
#pragma unroll
  for (int k = 0; k < 4; ++k)
  {
    r.at[k] = where->offset[level] + row_of(size, 0, (int)low_y + k % 2, (int)low_z + k / 2);
  }
  r.field = field_of(size);
  r.y = at_y - low_y;
  r.z = at_z - low_z;
  r.cell = cell;
  r.first = first.x;
  return r;
}

inline real between(real low, real high, real part)
{
  return multiply_add(part, high - low, low);
}

// Interpolates a level along y and z, for REAL_WIDTH cells of a row from x on.
inline real cells_across(const __global float* values, const rows_between* rows, int x)
{
  const real low = between(load_real(x, values + rows->at[0]), load_real(x, values + rows->at[1]), (real)rows->y);
  const real high = between(load_real(x, values + rows->at[2]), load_real(x, values + rows->at[3]), (real)rows->y);
  return between(low, high, (real)rows->z);
}

// Trilinear interpolation of a level at REAL_WIDTH voxels, from x on (getInterpolatedValue of listing B.3).
inline real sample(const __global float* values, const rows_between* rows, int level, int x)
{
  if (level == 0)
  {
    return load_real(x, values + rows->at[0]);
  }
  x += rows->first;
  const int first = (x - (1 << level) / 2) >> level; // index of the cell to the left of the first voxel
#if REAL_WIDTH == 8
  const float8 cells = cells_across(values, rows, first);
  if (level == 1)
  {
    const float8 part = (float8)(0.75f, 0.25f, 0.75f, 0.25f, 0.75f, 0.25f, 0.75f, 0.25f);
    return between(cells.s01122334, cells.s12233445, part);
  }
  if (level == 2)
  {
    const float8 part = (float8)(0.625f, 0.875f, 0.125f, 0.375f, 0.625f, 0.875f, 0.125f, 0.375f);
    return between(cells.s00111122, cells.s11222233, part);
  }
  if (level == 3)
  {
    const float8 part = (float8)(0.5625f, 0.6875f, 0.8125f, 0.9375f, 0.0625f, 0.1875f, 0.3125f, 0.4375f);
    return between(cells.s00001111, cells.s11112222, part);
  }
  const float8 voxels = (float8)(0.5f, 1.5f, 2.5f, 3.5f, 4.5f, 5.5f, 6.5f, 7.5f);
  const float begin = (float)(x - (1 << level) / 2 - (first << level));
  return between(cells.s00000000, cells.s11111111, (begin + voxels) * rows->cell);
#else
  const float part = ((float)(x - (1 << level) / 2 - (first << level)) + 0.5f) * (1.0f / (float)(1 << level));
  return between(cells_across(values, rows, first), cells_across(values, rows, first + 1), part);
#endif
}

inline void sample_light(const __global float* light, const rows_between* rows, int level, int x, real* channels)
{
#pragma unroll
  for (int c = 0; c < CHANNELS; ++c)
  {
    channels[c] = sample(light + c * rows->field, rows, level, x);
  }
}

inline real sum_of_channels(const real* channels)
{
#if CHANNELS == 3
  return channels[0] + channels[1] + channels[2];
#else
  return channels[0];
#endif
}

inline void take(real* taken, const real* channels, integer where)
{
#pragma unroll
  for (int c = 0; c < CHANNELS; ++c)
  {
    taken[c] = select(taken[c], channels[c], where);
  }
}

// Finds the lowest level with at least `least` photons (level `top` if there is none), and interpolates the first
// `fields` fields of `wanted` at this level. These are the channels of the light or, for the published estimator, the
// photons' weight.
inline real populated(const __global float* counts, const rows_between* rows_of_counts, float least,
  const __global float* wanted, const rows_between* rows, const int fields, int top, int x, real* found)
{
  real level = 0.0f;
  integer open = -1; // mask of the voxels whose level is not yet found
  for (int l = 0; l <= top && any_of(open); ++l)
  {
    const integer more = l < top ? open & (sample(counts, rows_of_counts + l, l, x) < least) : (integer)0;
    const integer here = open & (more == 0);
    level = select(level, (real)l, here);
    if (any_of(here))
    {
      for (int f = 0; f < fields; ++f)
      {
        found[f] = select(found[f], sample(wanted + f * rows[l].field, rows + l, l, x), here);
      }
    }
    open = more;
  }
  return level;
}

// Returns the highest level, at most `highest`, up to which the difference of successive levels does not grow (listing
// B.3). `taken` receives the light of this level.
inline real by_surround(
  const __global float* light, const rows_between* rows, int top, real highest, int x, real* taken)
{
  real level = 0.0f;
  sample_light(light, rows, 0, x, taken);
  integer climbing = highest >= 1.0f;
  if (top <= 2 || !any_of(climbing))
  {
    return level;
  }
  real surround[CHANNELS];
  sample_light(light, rows + 1, 1, x, surround);
  real difference = fabs(sum_of_channels(taken) - sum_of_channels(surround));
  for (int l = 2; l < top && any_of(climbing); ++l)
  {
    real next[CHANNELS];
    sample_light(light, rows + l, l, x, next);
    const real next_difference = fabs(sum_of_channels(surround) - sum_of_channels(next));
    climbing = climbing & (next_difference <= difference) & (highest >= (real)(l - 1));
    level = select(level, (real)(l - 1), climbing);
    take(taken, surround, climbing);
#pragma unroll
    for (int c = 0; c < CHANNELS; ++c)
    {
      surround[c] = next[c];
    }
    difference = next_difference;
  }
  return level;
}

#if DIRECTIONS
// Stores the mean direction of each voxel at its level, which is one of `lowest` to `top`.
inline void store_direction(const __global float* light, const rows_between* rows, int lowest, int top, real level,
  int x, size_t voxel, __global float* direction)
{
  real way[3] = { 0.0f, 0.0f, 0.0f };
  for (int l = lowest; l <= top; ++l)
  {
    const integer here = level == (real)l;
    if (any_of(here))
    {
#pragma unroll
      for (int c = 0; c < 3; ++c)
      {
        way[c] = select(way[c], sample(light + (CHANNELS + c) * rows[l].field, rows + l, l, x), here);
      }
    }
  }
  const real square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
  real cut = 1.0f;
  if (any_of(square > 1.0f)) // rarely true
  {
    cut = select(cut, 1.0f / sqrt(square), square > 1.0f);
  }
  store_reals_of_three(way[0] * cut, way[1] * cut, way[2] * cut, voxel, direction);
}
#endif

// Kernel of all estimators that use one level per voxel.
//   light, counts, weights     pyramids of light, photon counts and photon weights
//   where, where_counts        layouts of these pyramids
//   estimator, top             how levels are chosen (LevelEstimator), and the highest level
//   parameter                  ByPublished: increment of photon weight per level; else minimum number of photons
//   fluence, direction, chosen output: light, mean direction and level of each voxel
//   voxels                     voxels of the grid along x, y, z, and the pitch of its rows
__kernel void choose_level(const __global float* light, const __global PyramidLevels* where,
  const __global float* counts, const __global float* weights, const __global PyramidLevels* where_counts,
  int estimator, int top, float parameter, __global float* fluence, __global float* direction, __global float* chosen,
  int4 voxels)
{
  const int y = ROW_Y, z = ROW_Z, lowest = estimator == ByConstantRadius ? top : 0;
  rows_between rows[LevelsAtMost + 1], rows_of_counts[LevelsAtMost + 1];
  for (int l = lowest; l <= top; ++l)
  {
    rows[l] = rows_beside(where, l, y, z);
    rows_of_counts[l] = rows_beside(where_counts, l, y, z);
  }
  const size_t begin = ((size_t)z * voxels.y + y) * voxels.w;
  FOR_CELLS(x, voxels.x)
  {
    real taken[CHANNELS] = { 0.0f };
    real level = (real)top;
    if (estimator == ByPublished)
    {
      real weight = 0.0f;
      populated(counts, rows_of_counts, 1.0f, weights, rows_of_counts, 1, top, x, &weight);
      level = by_surround(light, rows, top, weight / parameter, x, taken);
    }
    else if (estimator == ByConstantRadius)
    {
      sample_light(light, rows + top, top, x, taken);
    }
    else
    {
      level = populated(counts, rows_of_counts, parameter, light, rows, CHANNELS, top, x, taken);
    }
#if CHANNELS == 3
    store_reals_of_three(taken[0], taken[1], taken[2], begin + x, fluence);
#else
    store_real(taken[0], begin + x, fluence);
#endif
#if DIRECTIONS
    store_direction(light, rows, lowest, top, level, x, begin + x, direction);
#endif
    store_real(level, begin + x, chosen);
  }
}
