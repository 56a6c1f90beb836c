// Incident radiance and escaped power per cell of the box's faces, in a sweep on GPUs. The light incident through each
// cell is written to the sides (SweepOnGpuShared.h) before planes are crossed; escaped power is summed per cell
// afterwards, by one work-item per cell, so the order of summation is fixed and no atomics are needed. Physics and
// numerics are those of SweepSides.cl and SweepMaps.cl. The host defines
//   CHANNELS  channels swept together

#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"
#include "Numerics/Numerics.cl"

// Cells of the box's faces that adjoin one plane of a lane, for one channel. A lane is the rays that march in one sense
// along an axis.
typedef struct
{
  const __global SweepLane* lane;
  const __global LaneFaceInfo* faces;
  const __global float* light;
  int plane;
} cells_beside;

// A ray in a plane: its bundle, the index of its direction (member) in the bundle, and its sideways moves.
typedef struct
{
  const __global BundleInfo* bundle;
  const __global CrossingInfo* crossing;
  int member;
} ray_in_plane;

// Ray number `ray` of a lane (the rays that march in one sense along an axis) in the k-th plane that they cross.
// @param rays  for each ray of all lanes: index of its bundle, and index of its direction (member) in the bundle
static ray_in_plane ray_of(const __global SweepLane* lane, const __global int2* rays,
  const __global BundleInfo* bundles, const __global CrossingInfo* crossings, int ray, int k)
{
  const int2 of = rays[lane->firstRay + ray];
  const ray_in_plane found = { bundles + of.x, crossings + k * lane->bundles + of.x - lane->firstBundle, of.y };
  return found;
}

static float light_of_cell(const cells_beside* cells, int side, int i)
{
  const __global LaneFaceInfo* faces = cells->faces;
  return cells->light[faces->first[side] + cells->plane * faces->plane[side] + i * faces->along[side]];
}

// Incident power of a ray, W: `power`, which is its power at radiance 1, times the mean radiance of the cells i and i +
// move of a side. If cell i + move is not on the face, the radiance is that of cell i.
static float light_of_cells(const cells_beside* cells, float power, int side, int i, int move)
{
  if (!cells->faces->in)
  {
    return 0.0f;
  }
  const __global SweepLane* lane = cells->lane;
  const int size = side < 2 ? lane->planes.sizeV : lane->planes.sizeU;
  const bool wraps = side < 2 ? lane->periodicV : lane->periodicU;
  const float here = light_of_cell(cells, side, i);
  const int beside = wraps ? (i + move + size) % size : i + move;
  return power *
    (move == 0 || beside < 0 || beside >= size ? here : 0.5f * (here + light_of_cell(cells, side, beside)));
}

// Writes the power of the rays that enter through the sides of planes, W, for one lane (the rays that march in one
// sense along an axis). One work-item per position along the sides, ray and channel, and plane (SweepOnGpuShared.h).
// crossings  sideways moves of rays, from the lane's first plane on
__kernel void enter_sides(int number, const __global SweepLane* lanes, const __global LaneFaceInfo* faces,
  const __global int2* rays, const __global BundleInfo* bundles, const __global CrossingInfo* crossings,
  const __global float4* entering, const __global float* face_in, ulong first, ulong stride, __global float* sides_in)
{
  const int place = get_global_id(0), slot = get_global_id(1), k = get_global_id(2);
  const __global SweepLane* lane = lanes + number;
  const int sizeU = lane->planes.sizeU, sizeV = lane->planes.sizeV;
  const ray_in_plane ray = ray_of(lane, rays, bundles, crossings + lane->crossings, slot / CHANNELS, k);
  const cells_beside cells = { lane, faces + number, face_in + first + slot % CHANNELS * stride, plane_of(lane, k) };
  const float4 alike = entering[lane->firstRay * CHANNELS + slot];
  const float power = ray.bundle->power;
  float light = 0.0f;
  for (int s = 1; s < ray.crossing->stages; ++s)
  {
    const int2 move = move_of(ray.bundle, ray.member, ray.crossing, s);
    const int faceU = move.x > 0 ? 0 : 1, faceV = move.y > 0 ? 2 : 3;
    if (place < sizeU && move.y != 0)
    {
      light = alike.y + light_of_cells(&cells, power, faceV, place, move.x);
    }
    if (place >= sizeU && place < sizeU + sizeV && move.x != 0)
    {
      light = alike.x + light_of_cells(&cells, power, faceU, place - sizeU, move.y);
    }
    // At an edge of the box, half of the power enters through each of the two faces
    if (place == sizeU + sizeV && move.x != 0 && move.y != 0)
    {
      light = 0.5f *
        (alike.x + alike.y + light_of_cells(&cells, power, faceV, move.x > 0 ? 0 : sizeU - 1, 0) +
          light_of_cells(&cells, power, faceU, move.y > 0 ? 0 : sizeV - 1, 0));
    }
  }
  sides_in[lane->sides + ((ulong)k * lane->rays * CHANNELS + slot) * SIDE_FLOATS(&lane->planes) + place] = light;
}

// Fraction of a ray's power that leaves through the cells of plane p, if the ray leaves the box sideways in plane
// `plane`.
// @param planes  number of planes from one sideways move of the ray to the next
static float part_through(const __global SweepLane* lane, int spread, int plane, int p, float planes)
{
  if (!spread)
  {
    return plane == p ? 1.0f : 0.0f;
  }
  const int size = lane->planes.sizeP;
  float begin = plane + 0.5f - 0.5f * planes, end = plane + 0.5f + 0.5f * planes, part = 0.0f;
  begin = lane->around ? begin : fmax(begin, 0.0f);
  end = lane->around ? end : fmin(end, (float)size);
  for (int round = lane->around ? -1 : 0; round <= (lane->around ? 1 : 0); ++round)
  {
    const int there = p + round * size;
    part += fmax(fmin(end, there + 1.0f) - fmax(begin, (float)there), 0.0f);
  }
  return part / (end - begin);
}

// Power with which a ray leaves a plane through cell `i` of a side, W. At an edge of the plane, half of the power of
// rays that move along u and v at once leaves through each of the two sides.
// @param in, out  power of the rays at the sides, for this ray and plane (SweepOnGpuShared.h)
static float power_through(const __global SweepLane* lane, const ray_in_plane* ray, int side, int i,
  const __global float* in, const __global float* out)
{
  const int sizeU = lane->planes.sizeU, sizeV = lane->planes.sizeV;
  const bool of_u = side < 2;
  const int size = of_u ? sizeV : sizeU; // number of cells along the face
  const bool edges = !(of_u ? lane->periodicV : lane->periodicU);
  float power = 0.0f;
  for (int s = 1; s < ray->crossing->stages; ++s)
  {
    const int2 move = move_of(ray->bundle, ray->member, ray->crossing, s);
    const int through = of_u ? move.x : move.y, along = of_u ? move.y : move.x;
    if (through != (side % 2 ? 1 : -1))
    {
      continue;
    }
    const bool turns = edges && along != 0;
    const float stays = turns && i == (along > 0 ? size - 1 : 0) ? 0.5f : 1.0f;
    float leaves = stays * out[of_u ? sizeU + i : i];
    // Adds power that enters through the adjacent face of the box and leaves through this one without crossing a voxel
    if (turns && i == (along > 0 ? 0 : size - 1))
    {
      const int last = side % 2 ? (of_u ? sizeU : sizeV) - 1 : 0;
      leaves += 0.5f * in[of_u ? last : sizeU + last];
    }
    power = multiply_add(ray->crossing->part[s], leaves, power);
  }
  return power;
}

// Adds to face_out the power that leaves through each cell of the faces parallel to the marching axis, W. One work-item
// per cell, side and channel.
__kernel void leave_sides(int number, const __global SweepLane* lanes, const __global LaneFaceInfo* faces,
  const __global int2* rays, const __global BundleInfo* bundles, const __global CrossingInfo* crossings, int of_round,
  const __global float* sides_in, const __global float* sides_out, __global float* face_out, ulong first, ulong stride)
{
  const int i = get_global_id(0), p = get_global_id(1), side = get_global_id(2) / CHANNELS;
  const int c = get_global_id(2) % CHANNELS;
  const __global SweepLane* lane = lanes + number;
  if (i >= (side < 2 ? lane->planes.sizeV : lane->planes.sizeU) || (side < 2 ? lane->periodicU : lane->periodicV))
  {
    return;
  }
  const __global LaneFaceInfo* of_lane = faces + number;
  const int at = lane->backward ? lane->planes.sizeP - 1 - p : p;
  float left = 0.0f;
  for (int r = 0; r < lane->rays; ++r)
  {
    const int2 of = rays[lane->firstRay + r];
    const __global BundleInfo* bundle = bundles + of.x;
    // Whether the ray crosses this side of the box when it moves along the bundle's own axis u; false: along its own
    // axis v
    const bool ofU = bundle->move[of.y][side < 2 ? 0 : 2] != 0;
    const float planes = ofU ? bundle->planesU : bundle->planesV;
    // A ray may leave through this plane's cells if it moves sideways in a plane that is at most this number of planes
    // away.
    const int reach = lane->around ? lane->patternPlanes : of_lane->spread ? (int)ceil(0.5f * planes) : 0;
    for (int k = max(at - reach, 0); k < min(at + reach + 1, lane->patternPlanes); ++k)
    {
      const float part = part_through(lane, of_lane->spread, plane_of(lane, k), p, planes);
      if (part > 0.0f)
      {
        const ray_in_plane ray = ray_of(lane, rays, bundles, crossings + (of_round ? 0 : lane->crossings), r, k);
        const ulong before = lane->sides + (((ulong)k * lane->rays + r) * CHANNELS + c) * SIDE_FLOATS(&lane->planes);
        left = multiply_add(part, power_through(lane, &ray, side, i, sides_in + before, sides_out + before), left);
      }
    }
  }
  face_out[first + c * stride + of_lane->first[side] + p * of_lane->plane[side] + i * of_lane->along[side]] += left;
}

// Adds the light incident per cell to the power of a lane's rays (those that march in one sense along an axis) where
// they start. One work-item per float of the lane's maps (power of each ray).
__kernel void enter_start(int number, const __global SweepLane* lanes, const __global LaneFaceInfo* faces,
  const __global int2* rays, const __global BundleInfo* bundles, const __global float* face_in, ulong first,
  ulong stride, __global float* maps)
{
  const __global SweepLane* lane = lanes + number;
  const ulong plane = (ulong)lane->planes.sizeU * lane->planes.sizeV;
  const ulong i = get_global_id(0), slot = i / plane;
  const float power = bundles[rays[lane->firstRay + slot / CHANNELS].x].power;
  maps[lane->map + i] += power * face_in[first + slot % CHANNELS * stride + faces[number].start + i % plane];
}

// Adds the power of a lane's rays (those that march in one sense along an axis) to the cells of the face where they
// end, W. One work-item per cell and channel.
__kernel void leave_end(int number, const __global SweepLane* lanes, const __global LaneFaceInfo* faces,
  const __global float* maps, __global float* face_out, ulong first, ulong stride)
{
  const __global SweepLane* lane = lanes + number;
  const ulong plane = (ulong)lane->planes.sizeU * lane->planes.sizeV;
  const ulong cell = get_global_id(0);
  const int c = get_global_id(1);
  float left = 0.0f;
  for (int ray = 0; ray < lane->rays; ++ray)
  {
    left += maps[lane->map + ((ulong)ray * CHANNELS + c) * plane + cell];
  }
  face_out[first + c * stride + faces[number].end + cell] += left;
}
