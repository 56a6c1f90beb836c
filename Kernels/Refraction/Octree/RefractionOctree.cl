// Kernels that build the octree of a quantity (Pfeuti 2009, listings 3.2 and 3.3): the least and largest value in
// each node, from the voxels up, and the levels, from the top down. One work-item per node.

inline size_t index_of(int4 node, int4 size)
{
  return ((size_t)node.z * size.y + node.y) * size.x + node.x;
}

// Ranges (least and largest value) of nodes. Children beyond the grid's end are replaced by the last ones inside.
//
//   children_size  number of children along each axis
//   nodes          (min, max) of each node, in levels from 1 up
//   first          index of the first node of the level that is computed
//   size           number of nodes of that level along each axis

typedef struct
{
  size_t at[4];  // indices of the first children at (0, 0), (1, 0), (0, 1), (1, 1) along y and z
  size_t across; // offset from the first to the second child along x
} children;

inline children children_of(int4 node, int4 children_size)
{
  const size_t row = children_size.x;
  const size_t layer = row * children_size.y;
  const int4 first = node * 2;
  const size_t up = first.y + 1 < children_size.y ? row : 0;
  const size_t back = first.z + 1 < children_size.z ? layer : 0;
  children c;
  c.at[0] = first.z * layer + first.y * row + first.x;
  c.at[1] = c.at[0] + up;
  c.at[2] = c.at[0] + back;
  c.at[3] = c.at[1] + back;
  c.across = first.x + 1 < children_size.x ? 1 : 0;
  return c;
}

// Minimum and maximum without the checks for NaN of fmin and fmax.
inline float smaller(float a, float b)
{
  return a < b ? a : b;
}
inline float larger(float a, float b)
{
  return a > b ? a : b;
}
inline float2 joined(float2 a, float2 b)
{
  return (float2)(smaller(a.x, b.x), larger(a.y, b.y));
}

__kernel void min_max_of_voxels(
  const __global float* voxels, int4 children_size, __global float2* nodes, ulong first, int4 size)
{
  const int4 node = (int4)(get_global_id(0), get_global_id(1), get_global_id(2), 0);
  if (node.x >= size.x || node.y >= size.y || node.z >= size.z)
  {
    return;
  }
  const children c = children_of(node, children_size);
  float2 range = (float2)(voxels[c.at[0]]);
  range = joined(range, (float2)(voxels[c.at[0] + c.across]));
  range = joined(range, (float2)(voxels[c.at[1]]));
  range = joined(range, (float2)(voxels[c.at[1] + c.across]));
  range = joined(range, (float2)(voxels[c.at[2]]));
  range = joined(range, (float2)(voxels[c.at[2] + c.across]));
  range = joined(range, (float2)(voxels[c.at[3]]));
  range = joined(range, (float2)(voxels[c.at[3] + c.across]));
  nodes[first + index_of(node, size)] = range;
}

// Computes the range (least and largest value) in each node of one level from the ranges of the level below.
//   below  index of the first node of the level below
__kernel void min_max_of_nodes(__global float2* nodes, ulong below, int4 children_size, ulong first, int4 size)
{
  const int4 node = (int4)(get_global_id(0), get_global_id(1), get_global_id(2), 0);
  if (node.x >= size.x || node.y >= size.y || node.z >= size.z)
  {
    return;
  }
  const children c = children_of(node, children_size);
  const __global float2* from = nodes + below;
  float2 range = joined(from[c.at[0]], from[c.at[0] + c.across]);
  range = joined(range, joined(from[c.at[1]], from[c.at[1] + c.across]));
  range = joined(range, joined(from[c.at[2]], from[c.at[2] + c.across]));
  range = joined(range, joined(from[c.at[3]], from[c.at[3] + c.across]));
  nodes[first + index_of(node, size)] = range;
}

// Computes the levels of nodes. The level of a node is that of the largest undivided node that contains it or equals
// it; 0 if there is none.
//
//   ranges        (min, max) of the nodes of all levels
//   first, size   index of the first node of the level that is computed, and number of its nodes along each axis
//   above, above_size  index of the first node, and number of nodes along each axis, of the level from which nodes
//                      inherit; not used at the top
//   from, shift   node (i, j, k) inherits from node (from + (i, j, k)) >> shift
//   tolerance     a node stays undivided if max - min is at most this value
__kernel void levels_of_nodes(const __global float2* ranges, __global uchar* levels, ulong first, int4 size,
  ulong above, int4 above_size, int4 from, int shift, int level, int top, float tolerance)
{
  const int4 node = (int4)(get_global_id(0), get_global_id(1), get_global_id(2), 0);
  if (node.x >= size.x || node.y >= size.y || node.z >= size.z)
  {
    return;
  }
  const size_t i = first + index_of(node, size);
  const uchar inherited = level < top ? levels[above + index_of((from + node) >> shift, above_size)] : 0;
  const uchar own = ranges[i].y - ranges[i].x <= tolerance ? level : 0;
  levels[i] = inherited > 0 ? inherited : own;
}

inline void give(__global uchar* levels, size_t voxel, uchar level, int restrict_it)
{
  levels[voxel] = restrict_it ? min(level, levels[voxel]) : level;
}

// Copies the levels of the nodes of level 1 to their voxels, one work-item per node.
//   nodes    levels of the nodes of level 1, the first ones of the pyramid
//   levels   levels of the voxels: overwritten, or with `restrict_them` reduced to the nodes' levels
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
  // Voxels beyond the grid's end are replaced by the last ones inside.
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
