// Kernels that add the deposits of a lamp's beams, which are in fixed point, to the arrays of a deposit. Options as for
// LampBeams.cl.

#include "LightPropagation/Uncollided/Lamps/BeamPower.cl"
#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"
#include "Numerics/Numerics.cl"

#define DEEPEST 7 // maximum number of halvings of a voxel close to a rectangle

// Solid angle of the rectangle as seen from a point, sr; 0 from behind. Coordinates, in units of length, are along the
// rectangle's edges and its normal.
static float angle_seen(const RectangleInfo* rectangle, float3 from)
{
  return from.z > 0.0f
    ? solid_angle(-from.x, -from.y, 2.0f * rectangle->reach[0], 2.0f * rectangle->reach[1], from.z, 16.0f)
    : 0.0f;
}

// A cell into which a voxel is divided. `middle` is its centre, relative to the rectangle's centre, along the
// rectangle's edges and normal; `edge` has the edge lengths along x, y, z.
typedef struct
{
  float3 middle;
  float edge[3];
  float radius; // radius of the circumscribed sphere
  float deep;   // half the cell's extent along the rectangle's normal
} voxel_cell;

static float distance_to_border(const RectangleInfo* rectangle, float3 from)
{
  const float a = fabs(from.x) - rectangle->reach[0], b = fabs(from.y) - rectangle->reach[1];
  const float aside = a < 0.0f && b < 0.0f ? fmax(a, b) : length((float2)(fmax(a, 0.0f), fmax(b, 0.0f)));
  return length((float2)(aside, from.z));
}

static float3 to_rectangle(const RectangleInfo* rectangle, float x, float y, float z)
{
  float along[3];
  for (int a = 0; a < 3; ++a)
  {
    along[a] =
      rectangle->corner[a] + x * rectangle->edges[a][0] + y * rectangle->edges[a][1] + z * rectangle->edges[a][2];
  }
  return (float3)(along[0], along[1], along[2]);
}

// Integral of the rectangle's solid angle over a cell, divided by the cell's volume. The cell is divided into columns
// along the axis nearest to the rectangle's normal, each cut off at the rectangle's plane. There are two Gauss points
// along each axis.
static float mean_over_cell(const RectangleInfo* rectangle, const voxel_cell* cell)
{
  const float gauss = 0.288675135f;
  int axis = 0;
  for (int a = 1; a < 3; ++a)
  {
    axis = fabs(rectangle->edges[2][a]) > fabs(rectangle->edges[2][axis]) ? a : axis;
  }
  const float slope = rectangle->edges[2][axis] * cell->edge[axis];
  float sum = 0.0f;
  for (int column = 0; column < 4; ++column)
  {
    float offset[3] = { 0.0f, 0.0f, 0.0f };
    offset[(axis + 1) % 3] = (column & 1 ? gauss : -gauss) * cell->edge[(axis + 1) % 3];
    offset[(axis + 2) % 3] = (column & 2 ? gauss : -gauss) * cell->edge[(axis + 2) % 3];
    const float middle = cell->middle.z + rectangle->edges[2][0] * offset[0] + rectangle->edges[2][1] * offset[1] +
      rectangle->edges[2][2] * offset[2];
    // Position where the rectangle's plane intersects the column, relative to the column's centre and as a fraction of
    // its length.
    const float plane = clamp(-middle / slope, -0.5f, 0.5f);
    const float from = slope > 0.0f ? plane : -0.5f, to = slope > 0.0f ? 0.5f : plane;
    for (int i = 0; i < 2; ++i)
    {
      offset[axis] = (0.5f * (from + to) + (i ? gauss : -gauss) * (to - from)) * cell->edge[axis];
      float3 at = cell->middle;
      for (int a = 0; a < 3; ++a)
      {
        at += offset[a] * (float3)(rectangle->edges[0][a], rectangle->edges[1][a], rectangle->edges[2][a]);
      }
      sum += 0.125f * (to - from) * angle_seen(rectangle, at);
    }
  }
  return sum;
}

// Whether a cell must be halved. The rectangle's solid angle varies fast near the rectangle's border and, for a small
// rectangle, with the inverse square of the distance.
//   before  extent of the voxel in front of the rectangle's plane, in units of length
static bool is_coarse(const RectangleInfo* rectangle, const voxel_cell* cell, int level, float before)
{
  const float3 normal =
    (float3)(fabs(rectangle->edges[2][0]), fabs(rectangle->edges[2][1]), fabs(rectangle->edges[2][2]));
  const bool slanted = normal.x + normal.y + normal.z > 1.001f;
  if (slanted && level < DEEPEST && fabs(cell->middle.z) < cell->deep && cell->deep > 0.25f * before)
  {
    return true;
  }
  const int levels = cell->radius > 0.5f * fmin(rectangle->reach[0], rectangle->reach[1]) ? DEEPEST : 3;
  return level < levels && distance_to_border(rectangle, cell->middle) < 2.5f * cell->radius;
}

// Mean over a voxel of the rectangle's solid angle, sr, which is 0 behind the rectangle. The voxel is divided
// adaptively into cells, which are visited in Morton order.
static float mean_solid_angle(const RectangleInfo* rectangle, const int* voxel)
{
  float sum = 0.0f, before = 0.0f;
  int level = 0;
  for (uint at = 0; at < 1u << (3 * DEEPEST);)
  {
    const float size = 1.0f / (1 << level);
    float place[3] = { 0.5f * size, 0.5f * size, 0.5f * size };
    for (int i = 0; i < level; ++i)
    {
      const uint bits = at >> (3 * (DEEPEST - 1 - i));
      for (int a = 0; a < 3; ++a)
      {
        place[a] += (bits >> a & 1) ? 0.5f / (1 << i) : 0.0f;
      }
    }
    voxel_cell cell;
    cell.deep = 0.0f;
    for (int a = 0; a < 3; ++a)
    {
      cell.edge[a] = size * rectangle->spacing[a];
      cell.deep += 0.5f * fabs(rectangle->edges[2][a]) * cell.edge[a];
    }
    cell.radius = 0.5f * sqrt(cell.edge[0] * cell.edge[0] + cell.edge[1] * cell.edge[1] + cell.edge[2] * cell.edge[2]);
    cell.middle = to_rectangle(rectangle, (voxel[0] + place[0]) * rectangle->spacing[0],
      (voxel[1] + place[1]) * rectangle->spacing[1], (voxel[2] + place[2]) * rectangle->spacing[2]);
    before = level == 0 ? cell.deep + fmin(cell.middle.z, 0.0f) : before;
    const bool behind = cell.middle.z <= -cell.deep;
    if (!behind && is_coarse(rectangle, &cell, level, before))
    {
      ++level;
      continue;
    }
    if (!behind)
    {
      const bool plain = cell.middle.z > cell.deep && distance_to_border(rectangle, cell.middle) > 10.0f * cell.radius;
      sum += (plain ? angle_seen(rectangle, cell.middle) : mean_over_cell(rectangle, &cell)) * size * size * size;
    }
    at += 1u << (3 * (DEEPEST - level));
    while (level > 0 && at % (1u << (3 * (DEEPEST - level + 1))) == 0)
    {
      --level;
    }
  }
  return sum;
}

// Sum of mean_solid_angle() over the rectangle and its periodic images, sr.
static float mean_of_images(const RectangleInfo* rectangle, const int* voxel)
{
  const int* images = rectangle->images;
  float sum = 0.0f;
  for (int z = -images[2]; z <= images[2]; ++z)
  {
    for (int y = -images[1]; y <= images[1]; ++y)
    {
      for (int x = -images[0]; x <= images[0]; ++x)
      {
        const int from[] = { voxel[0] + x * rectangle->period[0], voxel[1] + y * rectangle->period[1],
          voxel[2] + z * rectangle->period[2] };
        sum += mean_solid_angle(rectangle, from);
      }
    }
  }
  return sum;
}

// Computes the factor by which each voxel's path from a rectangle's beams is multiplied to be exact in vacuum
// (numerics.md, Eq. (34a)). In voxels that no beam reaches, the path integral is set to its value in vacuum, attenuated
// within the voxel.
// fixed_path  fixed-point sums, argument `path` of follow_lamp (LampBeams.cl)
__kernel void find_gains(RectangleInfo rectangle, __global long* fixed_path, ulong stride, __global float* gains,
  ulong first, const __global float* sigma, ulong sigma_first, float diagonal)
{
  const ulong i = first + get_global_id(0);
  const int voxel[] = { (int)(i % rectangle.size[0]), (int)(i / rectangle.size[0] % rectangle.size[1]),
    (int)(i / rectangle.size[0] / rectangle.size[1]) };
  const float right = rectangle.path * mean_of_images(&rectangle, voxel);
  const float beams = (float)fixed_path[FIRST_OF_VACUUM * stride + i] / rectangle.scale;
  float gain = beams > 0.0f ? right / beams : 1.0f;
  if (AROUND) // light that has wrapped around an axis more often than the images is not corrected
  {
    const float all = (float)fixed_path[i], direct = (float)fixed_path[(FIRST_OF_VACUUM + 1) * stride + i];
    gain = all > 0.0f ? 1.0f + (gain - 1.0f) * fmin(direct / all, 1.0f) : 1.0f;
  }
  gains[i] = gain;
  if (!(beams > 0.0f) && fixed_path[i] == 0)
  {
    const float extinction = sigma[sigma_first + i], tau = 0.5f * extinction * diagonal;
    float through;
    const float kept = tau > 1e-6f ? extinguished(tau, &through) / tau : 1.0f;
    fixed_path[i] = convert_long_sat_rte(right * kept * units_of(extinction, diagonal) * rectangle.scale);
  }
}

// Factor of a voxel's path that find_gains() computed; 1 for lamps other than rectangles.
static float gain_of(const __global float* gains, ulong i)
{
  return VACUUM ? gains[i] : 1.0f;
}

// Adds a lamp's path integrals to those of the deposit. One work-item per voxel and channel.
// gains  factor of each voxel, if VACUUM
// path   W length, [channel][voxel]; the kernel adds to it
// units  value of a fixed-point unit, W length, [channel]
// sigma  extinction, 1/length, shared by the channels
__kernel void add_fixed(const __global long* fixed_path, __global float* path, ulong first, ulong stride, float4 units,
  const __global float* sigma, ulong sigma_first, float diagonal, const __global float* gains)
{
  const ulong i = get_global_id(0);
  const int channel = get_global_id(1);
  const float unit = channel == 0 ? units.x : channel == 1 ? units.y : units.z;
  path[first + channel * stride + i] +=
    (float)fixed_path[i] * unit * gain_of(gains, i) / units_of(sigma[sigma_first + i], diagonal);
}

// Adds to face_out the power of a lamp's light that escaped through each cell of the box's faces. One work-item per
// cell and channel.
// cells     escaped power per cell in fixed point, from follow_lamp (LampBeams.cl)
// face_out  W, [channel][cell]; the kernel adds to it
// watts     power of the lamp, W, [channel]
__kernel void add_fixed_cells(
  const __global long* cells, __global float* face_out, ulong first, ulong stride, float4 watts)
{
  const ulong i = get_global_id(0);
  const int channel = get_global_id(1);
  const float unit = (channel == 0 ? watts.x : channel == 1 ? watts.y : watts.z) / LampPowerUnits;
  face_out[first + channel * stride + i] += (float)cells[i] * unit;
}

// Adds a lamp's net flux to that of the deposit. One work-item per voxel and channel.
// fixed_path  fixed-point sums, argument `path` of follow_lamp (LampBeams.cl)
// flux  W length, [channel][x, y, z][voxel]; the kernel adds to it
__kernel void add_fixed_flux(const __global long* fixed_path, __global float* flux, ulong first, ulong stride,
  float4 units, const __global float* sigma, ulong sigma_first, float diagonal, const __global float* gains)
{
  const ulong i = get_global_id(0);
  const int channel = get_global_id(1);
  const float unit = channel == 0 ? units.x : channel == 1 ? units.y : units.z;
  for (int axis = 0; axis < 3; ++axis)
  {
    flux[3 * (first + channel * stride) + axis * stride + i] += (float)fixed_path[(FIRST_OF_FLUX + axis) * stride + i] *
      unit * gain_of(gains, i) / units_of(sigma[sigma_first + i], diagonal);
  }
}

// Adds a lamp's first moments to those of the deposit. One work-item per voxel and channel. In opaque voxels a moment
// is nearly half of the path integral: their difference, the depth of the losses, is taken before rounding to floats.
// fixed_path  fixed-point sums, argument `path` of follow_lamp (LampBeams.cl)
// first_moments  W length, [channel][-x, +x, -y, +y, -z, +z][voxel]; the kernel adds to it
__kernel void add_fixed_moments(const __global long* fixed_path, __global float* first_moments, ulong first,
  ulong stride, float4 units, const __global float* sigma, ulong sigma_first, float diagonal,
  const __global float* gains)
{
  const ulong i = get_global_id(0);
  const int channel = get_global_id(1);
  const float unit = channel == 0 ? units.x : channel == 1 ? units.y : units.z;
  const float divisor = units_of(sigma[sigma_first + i], diagonal);
  const float path = (float)fixed_path[i] * unit * gain_of(gains, i) / divisor;
  for (int axis = 0; axis < 3; ++axis)
  {
    const long moment = fixed_path[(1 + axis) * stride + i];
    const long beyond = fixed_path[i] - 2 * (long)abs(moment);
    const float towards = 0.5f * (path - (float)beyond * unit * gain_of(gains, i) / divisor);
    first_moments[6 * (first + channel * stride) + (2 * axis + (moment > 0)) * stride + i] += fmax(towards, 0.0f);
  }
}

// Adds the same path integral, W length, to every voxel.
__kernel void add_evenly(__global float* path, ulong first, float each)
{
  path[first + get_global_id(0)] += each;
}
