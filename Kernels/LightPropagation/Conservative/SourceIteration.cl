// Adds path integrals to the fluence of all voxels outside a box. One work-item per voxel and channel.
//   path     W length
//   fluence  W / length^2, added to
//   first, filled  first voxel and size of the box
__kernel void add_outside(const __global float* path, __global float* fluence, ulong stride, float per_volume,
  int3 size, int3 first, int3 filled)
{
  const ulong at = get_global_id(0);
  const int x = (int)(at % size.x) - first.x;
  const int y = (int)(at / size.x % size.y) - first.y;
  const int z = (int)(at / ((ulong)size.x * size.y)) - first.z;
  if (x < 0 || y < 0 || z < 0 || x >= filled.x || y >= filled.y || z >= filled.z)
  {
    const ulong i = get_global_id(1) * stride + at;
    fluence[i] += path[i] * per_volume;
  }
}
