// Upwind sweep along all directions: computes mean and outgoing radiance of each voxel from source and incident
// radiance (numerics.md, Eqs. (D9) to (D11)). Radiance is [group of eight directions][voxel][8 directions]; successive
// groups are `stride` voxels apart. The host defines
//
//   REAL_WIDTH  8: a work-item processes all directions of a group; 1: one direction
#include "DiscreteOrdinates/OrdinatesShared.h"
#include "LightPropagation/Sweep/MomentPlacesShared.h"
#include "Numerics/Numerics.cl"

#define THIN 0.3f // optical length below which the power series in cross_voxel() are accurate to rounding

// Radiance after crossing a voxel along the mean chord (numerics.md, Eq. (D10)).
//   tau   optical length, >= 0
//   in    incident radiance, averaged over the faces
//   gain  source times length of the chord
//   mean  receives the mean radiance in the voxel
// Returns the outgoing radiance: incident radiance plus gain - tau mean.
inline real cross_voxel(real tau, real in, real gain, real* mean)
{
  // phi1 = (1 - exp(-tau)) / tau and phi2 = (tau - 1 + exp(-tau)) / tau^2 by power series, for small tau
  const real t = fmin(tau, (real)THIN);
  real p = multiply_add(t, (real)-1.98412698e-4f, (real)1.38888889e-3f);
  p = multiply_add(p, t, (real)-8.33333333e-3f);
  p = multiply_add(p, t, (real)4.16666667e-2f);
  p = multiply_add(p, t, (real)-1.66666667e-1f);
  const real thin2 = multiply_add(p, t, (real)0.5f);
  const real thin1 = multiply_add(-t, thin2, (real)1.0f);
  // the exact functions, for larger tau
  const real thick = fmax(tau, (real)THIN);
  real left;
  const real gone = extinguished(thick, &left);
  const real inverse = (real)1.0f / thick;
  const real thick1 = gone * inverse;
  const real thick2 = ((real)1.0f - thick1) * inverse;
#if REAL_WIDTH == 1
  const bool is_thin = tau < THIN;
  const real p1 = is_thin ? thin1 : thick1;
  const real p2 = is_thin ? thin2 : thick2;
  const real transmitted = is_thin ? 1.0f - t * thin1 : left;
#else
  const integer is_thin = tau < (real)THIN;
  const real p1 = select(thick1, thin1, is_thin);
  const real p2 = select(thick2, thin2, is_thin);
  const real transmitted = select(left, multiply_add(-t, thin1, (real)1.0f), is_thin);
#endif
  *mean = multiply_add(in, p1, gain * p2);
  return multiply_add(in, transmitted, gain * p1);
}

// Voxels along an axis in the order in which a direction crosses them. Returns x: index of the first one; y: step to
// the next; z: number of voxels in the box [first, last]; w: number of voxels in the swept part of the grid.
inline int4 swept_range(int up, int beyond, int first, int last, int size)
{
  const int in_box = last - first + 1;
  const int outside = beyond ? (up ? size - 1 - last : first) : 0;
  return (int4)(up ? first : last, up ? 1 : -1, in_box, in_box + outside);
}

// Reciprocal weight of the outgoing radiance in weighted diamond differences: the weight is 1 / (1 - T) - 1 / x, where
// T = exp(-x) is approximated by 1 / (1 + x + ... + x^6 / 720) (numerics.md, Eq. (D15)). The result is 2 in vacuum, 1
// in opaque voxels.
//   x  optical length of the voxel along the direction, between faces normal to an axis, >= 0
inline real reciprocal_weight(real x)
{
  const real t = fmin(x, (real)1e5f);
  real above = multiply_add(t, (real)1.38888889e-3f, (real)8.33333333e-3f);
  above = multiply_add(above, t, (real)4.16666667e-2f);
  above = multiply_add(above, t, (real)1.66666667e-1f);
  above = multiply_add(above, t, (real)0.5f);
  above = multiply_add(above, t, (real)1.0f);
  real below = multiply_add(t, (real)1.38888889e-3f, (real)6.94444444e-3f);
  below = multiply_add(below, t, (real)3.33333333e-2f);
  below = multiply_add(below, t, (real)0.125f);
  below = multiply_add(below, t, (real)3.33333333e-1f);
  below = multiply_add(below, t, (real)0.5f);
  return above / below;
}

// Mean and outgoing radiance of a voxel, by weighted diamond differences (numerics.md, Eq. (D15)).
//   tau    optical length of the mean chord, >= 0
//   share  weight of the face normal to each axis in the power that enters; their sum is 1
//   weight reciprocal_weight() along each axis
//   gain   source times length of the mean chord
//   in     radiance that enters through each face;  out: receives the radiance that leaves
// Returns the mean radiance. If the radiance that leaves through a face would be negative, it is set to 0. This happens
// at no more than two faces of a voxel, and power is conserved. If the source is negative (truncated angular
// moments) or the mean radiance is, light leaves through all faces: else no face might be left.
inline real cross_by_diamonds(real tau, const real* share, const real* weight, real gain, const real* in, real* out)
{
  real flows[3], kept[3];
  real enters = gain, leaves = tau;
#pragma unroll
  for (int a = 0; a < 3; ++a)
  {
    flows[a] = share[a] * weight[a];
    enters = multiply_add(flows[a], in[a], enters);
    leaves += flows[a];
  }
  real mean = enters / leaves;
#pragma unroll
  for (int a = 0; a < 3; ++a)
  {
    out[a] = multiply_add(weight[a], mean - in[a], in[a]);
  }
  const real least = fmin(out[0], fmin(out[1], out[2]));
#if REAL_WIDTH == 1
  const bool negative = least < 0.0f;
#else
  const bool negative = any(least < (real)0.0f);
#endif
  for (int round = 0; negative && round < 2; ++round)
  {
    enters = gain;
    leaves = tau;
#pragma unroll
    for (int a = 0; a < 3; ++a)
    {
      kept[a] = round == 0 ? (real)1.0f : kept[a];
      kept[a] = select(kept[a], (real)0.0f, (out[a] < (real)0.0f) & (mean > (real)0.0f) & (gain >= (real)0.0f));
      enters = multiply_add(mix(share[a], flows[a], kept[a]), in[a], enters);
      leaves = multiply_add(flows[a], kept[a], leaves);
    }
    mean = enters / leaves;
#pragma unroll
    for (int a = 0; a < 3; ++a)
    {
      out[a] = kept[a] * multiply_add(weight[a], mean - in[a], in[a]);
    }
  }
  return mean;
}

// Bits of the mode of a sweep: where it reads its source, what it writes, and its spatial scheme.
enum
{
  ByDirection = 1, // source by direction, replaced by mean radiance; else an isotropic source
  InSums = 2,      // sums over the directions of each group; else the source is to be multiplied by `scale`
  ByDiamonds = 4   // weighted diamond differences; else mean chords
};

typedef struct
{
  __global float* light; // source, W / (length^3 sr); with ByDirection replaced by mean radiance
  const __global float* sigma_t;
  const __global float* scale;
  const __global float* shares;
  const __global float* across;
  const __global int* up;
  __global float *x, *y, *z;
  __global float4* sums;
  const __global uchar* empty; // whether each block of OrdinateBlock voxels has no medium, if SweptLayers::skips
} ordinate_arrays;

// Weights of a work-item's directions; the arrays of the same names are explained at sweep_layers.
typedef struct
{
  real share[3], chord;
  real chords[3]; // lengths of the mean chords from face to face along each axis
  real across[3], angle;
} ordinate_weights;

static inline ordinate_weights weights_of(const ordinate_arrays* arrays, int group, int lane)
{
  ordinate_weights weights;
  for (int a = 0; a < 3; ++a)
  {
    weights.share[a] = load_real((group * 4 + a) * 8 + lane, arrays->shares);
    weights.chords[a] = 1.0f / fmax(weights.share[a], (real)1e-6f);
    weights.across[a] = load_real((group * 4 + a) * 8 + lane, arrays->across);
  }
  weights.chord = load_real((group * 4 + 3) * 8 + lane, arrays->shares);
  weights.angle = load_real((group * 4 + 3) * 8 + lane, arrays->across);
  return weights;
}

// Mean over a voxel's faces of the radiance that enters through them.
static inline real entering(const ordinate_weights* of, const real* in)
{
  return multiply_add(of->share[0], in[0], multiply_add(of->share[1], in[1], of->share[2] * in[2]));
}

// Crosses a voxel by weighted diamond differences or, if `diamonds` is 0, along the mean chord.
//   source  W / (length^3 sr)
//   in      radiance that enters through the faces normal to x, y, z;  out: receives the radiance that leaves
// Returns the mean radiance.
static inline real cross_ordinate(
  const ordinate_weights* of, real sigma_t, real source, int diamonds, const real* in, real* out)
{
  const real tau = sigma_t * of->chord, gain = source * of->chord;
  if (diamonds)
  {
    const real weight[3] = { reciprocal_weight(tau * of->chords[0]), reciprocal_weight(tau * of->chords[1]),
      reciprocal_weight(tau * of->chords[2]) };
    return cross_by_diamonds(tau, of->share, weight, gain, in, out);
  }
  real mean;
  out[0] = out[1] = out[2] = cross_voxel(tau, entering(of, in), gain, &mean);
  return mean;
}

// Sums over the work-item's directions: powers through the faces normal to x, y, z, of the light that enters or, if
// `of_mean`, of the mean radiance; and fluence.
static inline float4 sums_of(const ordinate_weights* of, const real* in, real mean, int of_mean)
{
  return (float4)(sum_of(of->across[0] * (of_mean ? mean : in[0])), sum_of(of->across[1] * (of_mean ? mean : in[1])),
    sum_of(of->across[2] * (of_mean ? mean : in[2])), sum_of(of->angle * mean));
}

// Stores the sums of fluence and net flux over the directions of a group, for a voxel of a block without medium,
// [fluence, flux along x, y, z][voxel of the block]. They replace the radiance of the block's first voxels.
//   light  radiance of the group, [voxel][8];  up: signs of the directions
static inline void keep_sums(__global float* light, ulong index, real mean, const ordinate_weights* of,
  const SweptLayers* layers, const __global int* up)
{
  __global float* const block = light + index / OrdinateBlock * OrdinateBlock * 8;
  const int voxel = index % OrdinateBlock;
  block[voxel] = sum_of(of->angle * mean);
  for (int a = 0; a < 3 && layers->perArea[0] > 0.0f; ++a)
  {
    const float perArea = up[a] ? layers->perArea[a] : -layers->perArea[a];
    block[(1 + a) * OrdinateBlock + voxel] = perArea * sum_of(of->across[a] * mean);
  }
}

// Sweeps a range of layers along z: of all voxels, of a box, or of the voxels downwind of a box. One work-item per
// group of directions, or per direction. In a sweep downwind of a box, x, y and z hold on entry the radiance that left
// the box, and the light of voxels in the box is set to 0.
//   light     source, W / (length^3 sr); with ByDirection by direction, replaced by the mean radiance
//   scale     factor by voxel for the sources of all directions; not used with InSums
//   shares    [group][x, y, z, chord][8]: weight of the radiance from each upwind neighbour in the incident radiance;
//             length of the mean chord
//   across    [group][x, y, z, angle][8]: power that a radiance of 1 W / (length^2 sr) along the direction carries
//             through a voxel face normal to each axis, W; solid angle of the direction, sr
//   up        [group][3]: whether the directions of the group are positive along each axis
//   x, y, z   radiance through the faces, [group][z][y][8], [group][z][x][8], [group][y][x][8]: incident before the
//             sweep, outgoing after it
//   sums      [group][voxel]: three powers through the voxel faces normal to x, y, z, W, then fluence. The powers are
//             those of the light that enters the voxel or, if layers->ofMean, of its mean radiance
//   mode      ByDirection ... ByDiamonds, a compile-time constant
// With SweptLayers::skips, voxels of blocks without medium have no source, and of their radiance only sums are kept.
static inline __attribute__((always_inline)) void sweep_layers(
  const ordinate_arrays* arrays, const SweptLayers* layers, const int mode)
{
  const int nx = layers->size[0], ny = layers->size[1], nz = layers->size[2];
  const int item = get_global_id(0), group = item * REAL_WIDTH / 8, lane = item * REAL_WIDTH % 8;
  const ordinate_weights weights = weights_of(arrays, group, lane);
  const __global uchar* const empty = mode == ByDirection && REAL_WIDTH == 8 && layers->skips ? arrays->empty : 0;
  const __global int* const up = arrays->up + 3 * group;
  const __global float* sigma_t = arrays->sigma_t + layers->firstT;
  const int beyond = layers->part == SweepsBeyondBox;
  const int4 x_range = swept_range(up[0], beyond, layers->first[0], layers->last[0], nx);
  const int4 y_range = swept_range(up[1], beyond, layers->first[1], layers->last[1], ny);
  const int4 z_range = swept_range(up[2], beyond, layers->first[2], layers->last[2], nz);
  for (int layer = layers->begin; layer < min(layers->end, z_range.w); ++layer)
  {
    const int k = z_range.x + z_range.y * layer;
    __global float* along_y = arrays->y + ((ulong)group * nz + k) * nx * 8 + lane;
    for (int row = 0; row < y_range.w; ++row)
    {
      const int j = y_range.x + y_range.y * row;
      __global float* along_x = arrays->x + (((ulong)group * nz + k) * ny + j) * 8 + lane;
      __global float* along_z = arrays->z + ((ulong)group * ny + j) * nx * 8 + lane;
      const ulong first = ((ulong)k * ny + j) * nx;
      __global float* cells = arrays->light + (group * layers->stride + first) * 8 + lane;
      const __global float* even = arrays->light + layers->firstSource + first;
      real from_x = load_real(0, along_x);
      int column = 0;
      for (; beyond && layer < z_range.z && row < y_range.z && column < x_range.z; ++column) // within the box
      {
        store_real((real)0.0f, (x_range.x + x_range.y * column) * 8, cells);
      }
      for (; column < x_range.w; ++column)
      {
        const int i = x_range.x + x_range.y * column;
        const real in[3] = { from_x, load_real(i * 8, along_y), load_real(i * 8, along_z) };
        if (empty && empty[(first + i) / OrdinateBlock])
        {
          from_x = entering(&weights, in);
          keep_sums(arrays->light + group * layers->stride * 8, first + i, from_x, &weights, layers, up);
          store_real(from_x, i * 8, along_y);
          store_real(from_x, i * 8, along_z);
          continue;
        }
        real source = mode & ByDirection ? load_real(i * 8, cells) : (real)even[i];
        source = mode & InSums ? source : source * (real)arrays->scale[first + i];
        const int diamonds = mode & ByDiamonds && sigma_t[first + i] > layers->thin;
        real out[3];
        const real mean = cross_ordinate(&weights, (real)sigma_t[first + i], source, diamonds, in, out);
        if (mode & ByDirection)
        {
          store_real(mean, i * 8, cells);
        }
        if (mode & InSums)
        {
          arrays->sums[group * layers->stride + first + i] = sums_of(&weights, in, mean, layers->ofMean);
        }
        store_real(out[1], i * 8, along_y);
        store_real(out[2], i * 8, along_z);
        from_x = out[0];
      }
      store_real(from_x, 0, along_x);
    }
  }
}

// Adds the radiance that leaves a face of a box in this sweep to the sum over earlier sweeps.
__kernel void add_face(__global float* sum, const __global float* face)
{
  const ulong i = get_global_id(0);
  ((__global float8*)sum)[i] += ((const __global float8*)face)[i];
}

#define ORDINATES                                                                                        \
  const __global float *shares, const __global float *across, const __global int *up, __global float *x, \
    __global float *y, __global float *z, SweptLayers layers

__kernel void sweep_upwind(__global float* radiance, const __global float* sigma_t, const __global float* scale,
  const __global uchar* empty, ORDINATES)
{
  const ordinate_arrays arrays = { radiance, sigma_t, scale, shares, across, up, x, y, z, 0, empty };
  sweep_layers(&arrays, &layers, ByDirection);
}

// Sweeps that store sums over the directions of each group (InSums). One work-item per group.
#define SWEEP_IN_SUMS(name, mode)                                                                            \
  __kernel void name(__global float* light, const __global float* sigma_t, __global float4* sums, ORDINATES) \
  {                                                                                                          \
    const ordinate_arrays arrays = { light, sigma_t, 0, shares, across, up, x, y, z, sums, 0 };              \
    sweep_layers(&arrays, &layers, (mode) | InSums);                                                         \
  }
SWEEP_IN_SUMS(sweep_even, 0)
SWEEP_IN_SUMS(sweep_even_by_diamonds, ByDiamonds)
SWEEP_IN_SUMS(sweep_moments_by_diamonds, ByDirection | ByDiamonds)

// Adds the sums over the directions of each group to path integrals, and to partial currents or net flux.
//   sums      [group][voxel], as sweep_layers() writes them
//   volume    volume of a voxel
//   path      W length, [channel][voxel]
//   through   [channel][part][voxel]: 6 parts: power that enters each voxel through its faces -x, +x, ... +z, W; 3: net
//             flux along x, y, z, W length; 0 parts: not computed
//   edges     edges of a voxel
//   stride    number of values per channel; first: index of the channel's first value in path
__kernel void gather_sums(const __global float4* sums, const __global int* up, int groups, ulong groupStride,
  float volume, __global float* path, __global float* through, int parts, float4 edges, ulong stride, ulong first)
{
  const ulong i = get_global_id(0);
  float4 low = (float4)0.0f, high = (float4)0.0f;
  for (int group = 0; group < groups; ++group)
  {
    const float4 sum = sums[group * groupStride + i];
    const int4 rises = (int4)(up[3 * group], up[3 * group + 1], up[3 * group + 2], 1) != 0;
    low += select((float4)0.0f, sum, rises);
    high += select(sum, (float4)0.0f, rises);
  }
  path[first + i] += volume * low.w;
  const float4 net = edges * (low - high);
  const float values[6] = { parts == 3 ? net.x : low.x, parts == 3 ? net.y : high.x, parts == 3 ? net.z : low.y, high.y,
    low.z, high.z };
  for (int part = 0; part < parts; ++part)
  {
    through[parts * first + part * stride + i] += values[part];
  }
}

// Computes the source along each direction from its angular moments and the sources of beams (BeamScattering.h).
//   source  moments, W / (length^3 sr) (MomentPlacesShared.h)
//   values  [group][function, then beam][8]: values of the angular functions and of the beams' distributions
//   radiance  receives the source, [group][voxel][8]; if `adds`, the source is added to it
__kernel void spread_moments(MomentPlaces places, int channel, int beams, ulong stride, const __global float* source,
  const __global float* values, __global float* radiance, ulong groupStride, int adds)
{
  const ulong i = get_global_id(0);
  const ulong group = get_global_id(1), line = i / places.sizeX, x = i % places.sizeX;
  const __global float8* of = (const __global float8*)values + group * (places.functions + beams);
  __global float8* to = (__global float8*)radiance + group * groupStride + i;
  float8 sum = of[0] * source[channel * stride + i] + (adds ? *to : (float8)0.0f);
  for (int function = 1; function < places.functions; ++function)
  {
    sum += of[function] * source[MOMENT_PLACE(places, function, channel, line, x)];
  }
  for (int beam = 0; beam < beams; ++beam)
  {
    sum += of[places.functions + beam] * source[places.beams + (beam * places.channels + channel) * stride + i];
  }
  *to = sum;
}

// Adds the angular moments of the radiance to those of the path integrals, except for the first moment, which
// gather_sums adds.
//   weights  [group][function][8]: values of the angular functions times solid angle, sr
__kernel void gather_moments(MomentPlaces places, int channel, int groups, float volume, const __global float* radiance,
  const __global float* weights, __global float* path, ulong groupStride)
{
  const ulong i = get_global_id(0), line = i / places.sizeX, x = i % places.sizeX;
  for (int function = 1; function < places.functions; ++function)
  {
    float8 sum = (float8)0.0f;
    for (int group = 0; group < groups; ++group)
    {
      sum += ((const __global float8*)weights)[group * places.functions + function] *
        ((const __global float8*)radiance)[group * groupStride + i];
    }
    const float4 four = sum.lo + sum.hi;
    path[MOMENT_PLACE(places, function, channel, line, x)] += volume * ((four.x + four.y) + (four.z + four.w));
  }
}

// Sums the radiance of each row of a face.
//   face  [group][row][count][8]
//   sums  [group][row][8]
__kernel void sum_rows(const __global float* face, __global float* sums, int count)
{
  const ulong row = get_global_id(0);
  const __global float8* values = (const __global float8*)(face + row * count * 8);
  float8 sum = (float8)0.0f;
  for (int i = 0; i < count; ++i)
  {
    sum += values[i];
  }
  ((__global float8*)sums)[row] = sum;
}

// Sets the incident radiance of a face, equal for all its voxels.
//   values  [group][8], W / (length^2 sr)
//   count   number of voxels of the face
__kernel void fill_face(__global float* face, const __global float* values, int count)
{
  const ulong i = get_global_id(0);
  ((__global float8*)face)[i] = ((const __global float8*)values)[i / count];
}

// Adds reflected radiance to the incident radiance along every incident direction, in each cell of the two faces
// perpendicular to an axis.
//   face  incident radiance, W / (length^2 sr), [group][cell][8]
//   in    reflected radiance, W / (length^2 sr), by cell of the box faces; the cells of the two faces begin at `low`
//         and `high`
__kernel void enter_by_cells(
  __global float* face, const __global float* in, const __global int* up, int axis, ulong low, ulong high)
{
  const ulong cell = get_global_id(0), cells = get_global_size(0), group = get_global_id(1);
  ((__global float8*)face)[group * cells + cell] += (float8)in[(up[3 * group + axis] ? low : high) + cell];
}

// Adds the outgoing power of each cell of the two faces perpendicular to an axis to `out`.
//   face    outgoing radiance, W / (length^2 sr), [group][cell][8]
//   out     W, by cell of the box faces; the cells of the two faces begin at `low` and `high`
//   across  [group][4][8]: power that a radiance of 1 W / (length^2 sr) along the direction carries through a cell
//           perpendicular to each axis, W
__kernel void leave_by_cells(const __global float* face, __global float* out, const __global float* across,
  const __global int* up, int axis, int groups, ulong low, ulong high)
{
  const ulong cell = get_global_id(0), cells = get_global_size(0);
  float8 through_low = (float8)0.0f, through_high = (float8)0.0f;
  for (int group = 0; group < groups; ++group)
  {
    const float8 power =
      ((const __global float8*)face)[group * cells + cell] * ((const __global float8*)across)[4 * group + axis];
    through_low += up[3 * group + axis] ? (float8)0.0f : power;
    through_high += up[3 * group + axis] ? power : (float8)0.0f;
  }
  const float4 of_low = through_low.lo + through_low.hi, of_high = through_high.lo + through_high.hi;
  out[low + cell] += (of_low.x + of_low.y) + (of_low.z + of_low.w);
  out[high + cell] += (of_high.x + of_high.y) + (of_high.z + of_high.w);
}

// Sets the source of all directions to an isotropic emission, by voxel.
__kernel void even_source(__global float* radiance, const __global float* emission, ulong stride)
{
  const ulong i = get_global_id(0), group = get_global_id(1);
  ((__global float8*)radiance)[group * stride + i] = (float8)emission[i];
}
