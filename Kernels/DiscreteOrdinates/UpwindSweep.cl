// Upwind sweep along all directions: computes mean and outgoing radiance of each voxel from source and incident
// radiance (numerics.md, Eqs. (D9) to (D11)). Radiance is [group of eight directions][voxel][8 directions]; successive
// groups are `stride` voxels apart. The host defines
//
//   REAL_WIDTH  8: a work-item processes all directions of a group; 1: one direction
#include "DiscreteOrdinates/OrdinatesShared.h"
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

// Voxels along an axis in the order in which a direction crosses them: x the first one, y the step to the next, z the
// number of those in the box [first, last], w that of all of the part.
inline int4 swept_range(int up, int beyond, int first, int last, int size)
{
  const int in_box = last - first + 1;
  const int outside = beyond ? (up ? size - 1 - last : first) : 0;
  return (int4)(up ? first : last, up ? 1 : -1, in_box, in_box + outside);
}

// Sweeps a range of layers along z, of all voxels, of a box, or of the voxels downwind of the box. One work-item per
// group of directions, or per direction. Downwind of a box: x, y, z hold the radiance that left the box, and its voxels
// are set to 0.
//   radiance  on entry the source, W / (length^3 sr), to be multiplied by scale; on return the mean radiance
//   scale     factor by voxel for all sources
//   shares    [group][x, y, z, chord][8]: weight of the radiance from each upwind neighbour in the incident radiance;
//             length of the mean chord
//   up        [group][3]: whether the directions of the group are positive along each axis
//   x, y, z   radiance through the faces, [group][z][y][8], [group][z][x][8], [group][y][x][8]: incident before the
//             sweep, outgoing after it
__kernel void sweep_upwind(__global float* radiance, const __global float* sigma_t, const __global float* scale,
  const __global float* shares, const __global int* up, __global float* x, __global float* y, __global float* z,
  SweptLayers layers)
{
  const int nx = layers.size[0], ny = layers.size[1], nz = layers.size[2];
  const int item = get_global_id(0);
  const int group = item * REAL_WIDTH / 8;
  const int lane = item * REAL_WIDTH % 8;
  const real share_x = load_real((group * 4 + 0) * 8 + lane, shares);
  const real share_y = load_real((group * 4 + 1) * 8 + lane, shares);
  const real share_z = load_real((group * 4 + 2) * 8 + lane, shares);
  const real chord = load_real((group * 4 + 3) * 8 + lane, shares);
  const int up_x = up[3 * group], up_y = up[3 * group + 1], up_z = up[3 * group + 2];
  const int beyond = layers.part == SweepsBeyondBox;
  const int4 x_range = swept_range(up_x, beyond, layers.first[0], layers.last[0], nx);
  const int4 y_range = swept_range(up_y, beyond, layers.first[1], layers.last[1], ny);
  const int4 z_range = swept_range(up_z, beyond, layers.first[2], layers.last[2], nz);
  for (int layer = layers.begin; layer < min(layers.end, z_range.w); ++layer)
  {
    const int k = z_range.x + z_range.y * layer;
    __global float* along_y = y + ((ulong)group * nz + k) * nx * 8 + lane;
    for (int row = 0; row < y_range.w; ++row)
    {
      const int j = y_range.x + y_range.y * row;
      __global float* along_x = x + (((ulong)group * nz + k) * ny + j) * 8 + lane;
      __global float* along_z = z + ((ulong)group * ny + j) * nx * 8 + lane;
      const ulong first = ((ulong)k * ny + j) * nx;
      __global float* cells = radiance + (group * layers.stride + first) * 8 + lane;
      real from_x = load_real(0, along_x);
      int column = 0;
      for (; beyond && layer < z_range.z && row < y_range.z && column < x_range.z; ++column) // within the box
      {
        store_real((real)0.0f, (x_range.x + x_range.y * column) * 8, cells);
      }
      for (; column < x_range.w; ++column)
      {
        const int i = x_range.x + x_range.y * column;
        const real from_y = load_real(i * 8, along_y);
        const real from_z = load_real(i * 8, along_z);
        const real source = load_real(i * 8, cells) * (real)scale[first + i];
        const real aside = multiply_add(share_y, from_y, share_z * from_z);
        real mean;
        const real out =
          cross_voxel((real)sigma_t[first + i] * chord, multiply_add(share_x, from_x, aside), source * chord, &mean);
        store_real(mean, i * 8, cells);
        store_real(out, i * 8, along_y);
        store_real(out, i * 8, along_z);
        from_x = out;
      }
      store_real(from_x, 0, along_x);
    }
  }
}

// Adds the radiance that leaves a box to that of earlier sweeps.
__kernel void add_face(__global float* sum, const __global float* face)
{
  const ulong i = get_global_id(0);
  ((__global float8*)sum)[i] += ((const __global float8*)face)[i];
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

// Adds the reflected radiance of the cells of the two faces perpendicular to an axis to the incident radiance along
// every incident direction.
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
//   across  [group][3][8]: power that a radiance of 1 W / (length^2 sr) along the direction carries through a cell
//           perpendicular to each axis, W
__kernel void leave_by_cells(const __global float* face, __global float* out, const __global float* across,
  const __global int* up, int axis, int groups, ulong low, ulong high)
{
  const ulong cell = get_global_id(0), cells = get_global_size(0);
  float8 through_low = (float8)0.0f, through_high = (float8)0.0f;
  for (int group = 0; group < groups; ++group)
  {
    const float8 power =
      ((const __global float8*)face)[group * cells + cell] * ((const __global float8*)across)[3 * group + axis];
    through_low += up[3 * group + axis] ? (float8)0.0f : power;
    through_high += up[3 * group + axis] ? power : (float8)0.0f;
  }
  const float4 of_low = through_low.lo + through_low.hi, of_high = through_high.lo + through_high.hi;
  out[low + cell] += (of_low.x + of_low.y) + (of_low.z + of_low.w);
  out[high + cell] += (of_high.x + of_high.y) + (of_high.z + of_high.w);
}

// Adds an isotropic source, by voxel, to the source of all directions.
__kernel void add_even_source(__global float* radiance, const __global float* source, ulong stride)
{
  const ulong i = get_global_id(0), group = get_global_id(1);
  ((__global float8*)radiance)[group * stride + i] += (float8)source[i];
}

// Sets the source of all directions to an isotropic emission, by voxel.
__kernel void even_source(__global float* radiance, const __global float* emission, ulong stride)
{
  const ulong i = get_global_id(0), group = get_global_id(1);
  ((__global float8*)radiance)[group * stride + i] = (float8)emission[i];
}
