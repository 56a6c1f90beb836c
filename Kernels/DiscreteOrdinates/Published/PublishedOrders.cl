// One explicit step of the radiance along all directions, as published (Gong et al., Eqs. (7) and (9)). Radiance is
// [group][stride][8 directions].
//
//   FACE_IN  1 where faces give back light, by cell

// What is carried one step on: L + h (Q - sigma_t L + S).
//   scattered  S, W / (length^3 sr)
//   steady     Q, of emission and of lamps
__kernel void change_radiance(__global float* radiance, const __global float* scattered, const __global float* steady,
  const __global float* sigma_t, float step, ulong stride)
{
  const ulong i = get_global_id(0), at = get_global_id(1) * stride + i;
  __global float8* light = (__global float8*)radiance + at;
  const float8 gain = ((const __global float8*)steady)[at] + ((const __global float8*)scattered)[at];
  *light += step * (gain - sigma_t[i] * *light);
}

// The cell, among all of the box's faces, beside a voxel at the face that light comes in through along an axis.
inline ulong cell_of(const int at[3], const int n[3], int axis, int up)
{
  const ulong of_x = (ulong)n[1] * n[2], of_y = (ulong)n[0] * n[2], of_z = (ulong)n[0] * n[1];
  const ulong first = axis == 0 ? 0 : axis == 1 ? 2 * of_x : 2 * (of_x + of_y);
  const ulong size = axis == 0 ? of_x : axis == 1 ? of_y : of_z;
  const ulong within = axis == 0 ? (ulong)at[2] * n[1] + at[1] : (ulong)at[axis == 1 ? 2 : 1] * n[0] + at[0];
  return first + (up ? 0 : size) + within;
}

// Each voxel takes what stood one step upwind, linear between the eight nearest voxels. Of a block on one of several
// ranks these may be voxels beside it.
//   before    of a box of `known` voxels, in which the own ones begin at `first`
//   parts     [group][3][8]: the step along each axis in voxels, 0 to 1
//   up        [group][3]: whether the group goes up an axis
//   incoming  [group][3][8]: radiance outside the box, by the axis along which it is left
//   face_in   radiance that is given back, by cell of the box's faces; where FACE_IN
//   own, known  voxels along the axes; of a group `stride` and `known_stride` apart
//   outside   bits of the faces -x, +x, ... +z beyond which there are no voxels
//   around    bits of the axes whose other end follows beyond the end of the own voxels
__kernel void move_on(const __global float* before, __global float* after, const __global float* parts,
  const __global int* up, const __global float* incoming, const __global float* face_in, int4 own, int4 known,
  int4 first, ulong stride, ulong known_stride, int outside, int around)
{
  const int group = get_global_id(1);
  const ulong i = get_global_id(0);
  const int at[3] = { (int)(i % own.x), (int)(i / own.x % own.y), (int)(i / own.x / own.y) };
  const int n[3] = { own.x, own.y, own.z };
  const __global float8* from_far = (const __global float8*)incoming + group * 3;
  const __global float8* part = (const __global float8*)parts + group * 3;
  const __global float8* there = (const __global float8*)before + group * known_stride;
  float8 sum = (float8)0.0f;
  for (int corner = 0; corner < 8; ++corner)
  {
    float8 weight = (float8)1.0f;
    int from[3];
    int left = -1; // the axis
#if FACE_IN
    float8 light = (float8)0.0f; // beyond the box, of all axes along which it is left
    int beyond_axes = 0;
#endif
    for (int a = 0; a < 3; ++a)
    {
      const int upwind = corner >> a & 1;
      weight *= upwind ? part[a] : (float8)1.0f - part[a];
      from[a] = at[a] - (up[3 * group + a] ? upwind : -upwind);
      const bool below = from[a] < 0, above = from[a] >= n[a];
      const bool beyond = (below && (outside >> (2 * a) & 1)) || (above && (outside >> (2 * a + 1) & 1));
      left = beyond ? a : left;
#if FACE_IN
      if (beyond)
      {
        light += from_far[a] + (float8)face_in[cell_of(at, n, a, up[3 * group + a])];
        ++beyond_axes;
      }
#endif
      from[a] += !(around >> a & 1) ? 0 : below ? n[a] : above ? -n[a] : 0;
      from[a] = beyond ? at[a] : from[a]; // which is not read
    }
    const ulong voxel = ((ulong)(from[2] + first.z) * known.y + (from[1] + first.y)) * known.x + (from[0] + first.x);
#if FACE_IN
    light = beyond_axes > 0 ? light / (float)beyond_axes : there[voxel];
    sum += weight * light;
#else
    sum += weight * (left >= 0 ? from_far[left] : there[voxel]);
#endif
  }
  ((__global float8*)after)[group * stride + i] = sum;
}

// Radiance in the voxels at the face that each group leaves through, summed along the rows of it.
//   sums  [group][row][8]; rows of `count` voxels `along` apart begin `between` apart
__kernel void sum_leaving(const __global float* radiance, __global float* sums, const __global int* up, ulong stride,
  int axis, ulong last, ulong between, ulong along, int count)
{
  const ulong row = get_global_id(0), rows = get_global_size(0), group = get_global_id(1);
  const ulong first = (up[3 * group + axis] ? last : 0) + row * between;
  float8 sum = (float8)0.0f;
  for (int i = 0; i < count; ++i)
  {
    sum += ((const __global float8*)radiance)[group * stride + first + i * along];
  }
  ((__global float8*)sums)[group * rows + row] = sum;
}

// Adds what leaves through each cell of the two faces of an axis.
//   out      W, by cell of the box's faces, of which the axis's begin at `low` and `high`
//   across   [group][3][8]: W that radiance 1 carries through a cell across each axis
//   last     from a voxel at the low face to that at the high one; rows of cells are `between` apart, cells `along`
__kernel void leave_by_cells(const __global float* radiance, __global float* out, const __global float* across,
  const __global int* up, ulong stride, int axis, int groups, ulong last, ulong between, ulong along, ulong low,
  ulong high)
{
  const ulong i = get_global_id(0), j = get_global_id(1), cell = j * get_global_size(0) + i;
  float8 through_low = (float8)0.0f, through_high = (float8)0.0f;
  for (int group = 0; group < groups; ++group)
  {
    const __global float8* light = (const __global float8*)radiance + group * stride + j * between + i * along;
    const float8 part = ((const __global float8*)across)[3 * group + axis];
    through_low += up[3 * group + axis] ? (float8)0.0f : part * light[0];
    through_high += up[3 * group + axis] ? part * light[last] : (float8)0.0f;
  }
  const float4 of_low = through_low.lo + through_low.hi, of_high = through_high.lo + through_high.hi;
  out[low + cell] += (of_low.x + of_low.y) + (of_low.z + of_low.w);
  out[high + cell] += (of_high.x + of_high.y) + (of_high.z + of_high.w);
}
