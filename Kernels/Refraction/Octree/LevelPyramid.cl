// Octree levels from the top down, a work-item per node (Pfeuti 2009, listing 3.3). A node's level is that of the whole
// node it lies in, or 0 where none is whole yet.

inline size_t index_of(int4 node, int4 size)
{
  return ((size_t)node.z * size.y + node.y) * size.x + node.x;
}

//   ranges        (min, max) of the nodes of all levels
//   first, size   of this level: first node, nodes per axis
//   above         the same of the level above; unused at the top
//   tolerance     a node is whole where max - min is no more
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
  const uchar own = ranges[i].y - ranges[i].x <= tolerance ? level : 0;
  levels[i] = inherited > 0 ? inherited : own;
}

inline void give(__global uchar* levels, size_t voxel, uchar level, int restrict_it)
{
  levels[voxel] = restrict_it ? min(level, levels[voxel]) : level;
}

// A work-item per node of level 1.
//   nodes    levels of the pyramid's nodes, level 1 first
//   levels   of the voxels: written, or where `restrict_them` made smaller
__kernel void levels_of_voxels(
  const __global uchar* nodes, int4 nodes_size, __global uchar* levels, int4 size, int restrict_them)
{
  const int4 node = (int4)(get_global_id(0), get_global_id(1), get_global_id(2), 0);
  if (node.x >= nodes_size.x || node.y >= nodes_size.y || node.z >= nodes_size.z)
  {
    return;
  }
  const uchar level = nodes[index_of(node, nodes_size)];
  const int4 voxel = 2 * node;
  // Beyond the grid's end: the neighbour within once more.
  const size_t x = voxel.x + 1 < size.x ? 1 : 0;
  const size_t y = voxel.y + 1 < size.y ? size.x : 0;
  const size_t z = voxel.z + 1 < size.z ? (size_t)size.x * size.y : 0;
  const size_t i = index_of(voxel, size);
  give(levels, i, level, restrict_them);
  give(levels, i + x, level, restrict_them);
  give(levels, i + y, level, restrict_them);
  give(levels, i + y + x, level, restrict_them);
  give(levels, i + z, level, restrict_them);
  give(levels, i + z + x, level, restrict_them);
  give(levels, i + z + y, level, restrict_them);
  give(levels, i + z + y + x, level, restrict_them);
}
