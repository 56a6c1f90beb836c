// Smallest and largest value of 2x2x2 children, a work-item per node (Pfeuti 2009, listing 3.2). A child beyond the
// grid's end is its neighbour within once more.
//
//   children_size  children per axis
//   nodes          levels from 1 on, (min, max) a node
//   first          of the level that is written
//   size           nodes of it per axis

typedef struct
{
  size_t at[4];  // (0, 0), (1, 0), (0, 1), (1, 1) of y and z
  size_t across; // to the second child along x
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

// Not fmin and fmax, which look for NaN.
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
  nodes[first + ((size_t)node.z * size.y + node.y) * size.x + node.x] = range;
}

//   below  first of the level below
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
  nodes[first + ((size_t)node.z * size.y + node.y) * size.x + node.x] = range;
}
