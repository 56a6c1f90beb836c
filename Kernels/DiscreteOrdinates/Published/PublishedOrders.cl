// Kernels of the published scheme: one explicit step of the radiance along all directions (Gong et al., Eqs. (7) and
// (9)). Radiance is [group of eight directions][voxel][8 directions]; successive groups are `stride` voxels apart.

// Computes the radiance L after emission and collisions, before it is advected: L + h (Q - sigma_t L + S), where h is
// the length of the step.
//   scattered  S, scattering source, W / (length^3 sr)
//   steady     Q, emission and first-collision source of lamps, W / (length^3 sr)
__kernel void change_radiance(__global float* radiance, const __global float* scattered, const __global float* steady,
  const __global float* sigma_t, float step, ulong stride)
{
  const ulong i = get_global_id(0), at = get_global_id(1) * stride + i;
  __global float8* light = (__global float8*)radiance + at;
  const float8 gain = ((const __global float8*)steady)[at] + ((const __global float8*)scattered)[at];
  *light += step * (gain - sigma_t[i] * *light);
}

// Advects the radiance by one step: each voxel takes the radiance one step upwind, interpolated trilinearly between
// voxels.
//   parts     [group][3][8]: length of the step along each axis in voxels, 0 to 1
//   up        [group][3]: whether the directions of the group are positive along each axis
//   incoming  [group][3][8]: radiance outside the box, by the axis perpendicular to the face through which it enters
//   size      number of voxels along each axis
//   stride    stride between groups, voxels
//   periodic  bit mask of the periodic axes
__kernel void move_on(const __global float* before, __global float* after, const __global float* parts,
  const __global int* up, const __global float* incoming, int4 size, ulong stride, int periodic)
{
  const int group = get_global_id(1);
  const ulong i = get_global_id(0);
  const int at[3] = { (int)(i % size.x), (int)(i / size.x % size.y), (int)(i / size.x / size.y) };
  const int n[3] = { size.x, size.y, size.z };
  const __global float8* outside = (const __global float8*)incoming + group * 3;
  const __global float8* part = (const __global float8*)parts + group * 3;
  const __global float8* inside = (const __global float8*)before + group * stride;
  float8 sum = (float8)0.0f;
  for (int corner = 0; corner < 8; ++corner)
  {
    float8 weight = (float8)1.0f;
    int from[3];
    int left = -1; // axis along which the interpolation point is outside the box; -1: inside
    for (int a = 0; a < 3; ++a)
    {
      const int upwind = corner >> a & 1;
      weight *= upwind ? part[a] : (float8)1.0f - part[a];
      from[a] = at[a] - (up[3 * group + a] ? upwind : -upwind);
      const bool beyond = from[a] < 0 || from[a] >= n[a];
      left = beyond && !(periodic >> a & 1) ? a : left;
      from[a] = (from[a] + n[a]) % n[a];
    }
    const ulong voxel = ((ulong)from[2] * size.y + from[1]) * size.x + from[0];
    sum += weight * (left >= 0 ? outside[left] : inside[voxel]);
  }
  ((__global float8*)after)[group * stride + i] = sum;
}

// Sums the radiance in the voxels at the face through which the directions of each group leave the box, along the rows
// of that face.
//   sums  [group][row][8]; successive voxels of a row are `along` apart, rows of `count` voxels `between` apart
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
