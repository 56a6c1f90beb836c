// Octree levels from the top down, a work-item a node (Pfeuti 2009, listing 3.3). A node's level is that of the whole node
// it lies in, or 0 where none is whole yet.

inline size_t index_of(int4 node, int4 size)
{
  return ((size_t)node.z * size.y + node.y) * size.x + node.x;
}

//   ranges        (min, max) of the nodes of all levels
//   first, size   of this level: first node, nodes per axis
//   above         the same of the level above; unused at the top
//   tolerance     a node is whole where max - min is less
__kernel void levels_of_nodes(const __global float2* ranges, __global uchar* levels, ulong first, int4 size,
  ulong above, int4 above_size, int level, int top, float tolerance)
{
  const int4 node = (int4)(get_global_id(0), get_global_id(1), get_global_id(2), 0);
  if (node.x >= size.x || node.y >= size.y || node.z >= size.z)
  {
    return;
  }
  const size_t i = first + index_of(node, size);
  const uchar inherited = level < top ? levels[above + index_of(node >> 1, above_size)] : 0;
  const uchar own = ranges[i].y - ranges[i].x < tolerance ? level : 0;
  levels[i] = inherited > 0 ? inherited : own;
}

//   nodes    levels of the pyramid's nodes, level 1 first
//   levels   of the voxels: written, or where `restrict_them` made smaller
__kernel void levels_of_voxels(
  const __global uchar* nodes, int4 above_size, __global uchar* levels, int4 size, int restrict_them)
{
  const int4 voxel = (int4)(get_global_id(0), get_global_id(1), get_global_id(2), 0);
  if (voxel.x >= size.x || voxel.y >= size.y || voxel.z >= size.z)
  {
    return;
  }
  const size_t i = index_of(voxel, size);
  const uchar level = nodes[index_of(voxel >> 1, above_size)];
  levels[i] = restrict_them ? min(level, levels[i]) : level;
}
