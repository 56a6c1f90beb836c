// The light of a small bright part of the medium far from it, along fans of rays that many voxels share. The host gives
//   CHANNELS  1 or 3 that share sigma_t
//   NET_FLUX  1 where net flux is wanted
//
// A fan is all rays from one point of the box of what shines into one 24th of space, on a grid of tangents that has a
// ray in every voxel even of the last layer. Each ray keeps what is left of its light in every layer; each voxel takes
// the mean of the rays that come through it (numerics.md, Eqs. (40a), (40b)).

#include "LightPropagation/Uncollided/EmissionBox.cl"

#define OF_HALVES 2.5f // two halves of the fans may differ by that many times the error asked for: their mean is better
#define DIM 1e-6f      // part of what is not extinguished, below which halves of the fans need not agree

static void turn_fan(const EmissionInfo* s, const FanInfo* fan, turned_scene* turned)
{
  const lit_voxel nowhere = { { 0, 0, 0 }, 3, 0, false };
  lit_voxel turned_nowhere;
  turn_scene(s, &nowhere, fan->order, fan->turned, turned, &turned_nowhere);
}

// sigma_t, but none in the box: what rays lose after they have left it.
__kernel void clear_box(EmissionInfo s, const __global float* sigma, ulong sigma_first, __global float* outside)
{
  const ulong i = get_global_id(0);
  const int at[3] = { (int)(i % s.size[0]), (int)(i / s.size[0] % s.size[1]),
    (int)(i / ((ulong)s.size[0] * s.size[1])) };
  bool inside = true;
  for (int a = 0; a < 3; ++a)
  {
    inside = inside && at[a] >= s.sourceFirst[a] && at[a] < s.sourceFirst[a] + s.sourceSize[a];
  }
  outside[i] = inside ? 0.0f : sigma[sigma_first + i];
}

// A line from a point of the box, both ways through the box.
static void begin_line(const turned_scene* s, const float* point, const real* way, box_ray* ray)
{
  ray->enter = -1e30f;
  ray->leave = 1e30f;
  for (int a = 0; a < 3; ++a)
  {
    ray->rate[a] = way[a] / s->spacing[a];
    ray->up[a] = ray->rate[a] > (real)0.0f;
    ray->step[a] = 1.0f / fmax(fabs(ray->rate[a]), (real)1e-20f);
    const float x = point[a] - floor(point[a]);
    ray->next[a] = select((real)x, (real)(1.0f - x), ray->up[a]) * ray->step[a];
    const float below = point[a] - s->sourceFirst[a], above = s->sourceSize[a] - below;
    ray->leave = fmin(ray->leave, select((real)below, (real)above, ray->up[a]) * ray->step[a]);
    ray->enter = fmax(ray->enter, -select((real)above, (real)below, ray->up[a]) * ray->step[a]);
  }
}

// Radiance at the end of the line in the box, over the density of points along it: points are as dense as what shines,
// so that in a clear box this is the same for all lines.
//   weights  W / sr, [CHANNELS]
static void weigh_line(const turned_scene* s, const float* point, const real* way, float emitted,
  const __global float* sigma, const __global float* outside, const __global float* emission, real* weights)
{
  const real back[3] = { -way[0], -way[1], -way[2] };
  real at[3], passed[CHANNELS], all = 0.0f;
  box_ray ray;
  for (int a = 0; a < 3; ++a)
  {
    at[a] = point[a];
  }
  begin_line(s, point, back, &ray);
  see_box(s, at, &ray, 1.0f, sigma, emission, weights);
  begin_line(s, point, back, &ray);
  see_box(s, at, &ray, 1.0f, outside, emission, passed); // there is nothing in its way
  for (int c = 0; c < CHANNELS; ++c)
  {
    all += passed[c];
  }
  for (int c = 0; c < CHANNELS; ++c)
  {
    weights[c] *= emitted / fmax(all, (real)1e-30f);
  }
}

// Lines of a fan beside each other.
typedef struct
{
  float point[3];        // where they begin, voxels
  float low[2], high[2]; // least and largest tangent along the second and the third axis
} line_packet;

// Whether a packet may come to voxels of its part of space in a layer or behind it.
static bool is_wanted(
  const EmissionInfo* s, const turned_scene* turned, const FanInfo* fan, const line_packet* packet, int layer)
{
  const float near = layer - packet->point[0], far = near + 1.0f;
  const float away = layer + 1.0f - turned->sourceFirst[0] - 0.5f * turned->sourceSize[0]; // no voxel is farther aside
  bool wanted = true;
  for (int a = 1; a < 3; ++a)
  {
    const float low_tangent = packet->low[a - 1], high_tangent = packet->high[a - 1];
    const float low = packet->point[a] + low_tangent * (low_tangent > 0.0f ? near : far);
    const float high = packet->point[a] + high_tangent * (high_tangent > 0.0f ? far : near);
    const float middle = turned->sourceFirst[a] + 0.5f * turned->sourceSize[a];
    const bool above = low > s->size[fan->order[a]] || (low_tangent >= 1.0f && low > middle + away + 0.5f);
    wanted = wanted && !above && !(high_tangent <= 0.0f && high < fan->first[a]);
  }
  return wanted;
}

// Follows lines through a layer. Returns what is left of their light, mean over the voxel that they are in at `sample`.
//   now, index, received  place on the line, voxel, part of the light that is left: moved on
static real cross_layer(const turned_scene* s, const __global float* outside, real sample, real end_of_layer, real* now,
  integer* index, real* received, box_ray* ray)
{
  real kept = 0.0f, through;
  integer crossed[3];
  integer under_way = *now < end_of_layer;
  while (any_of(under_way))
  {
    const real to_planes = fmin(ray->next[0], fmin(ray->next[1], ray->next[2]));
    const real end = select(*now, to_planes, under_way);
    const real here = *received * mean_left(take(outside, *index) * fmax(end - *now, (real)0.0f), &through);
    kept = select(kept, here, under_way && *now <= sample && sample < end);
    *received *= through;
    for (int a = 0; a < 3; ++a)
    {
      crossed[a] = under_way && ray->next[a] <= end;
      ray->next[a] += select((real)0.0f, ray->step[a], crossed[a]);
    }
    *index = clamp(*index + index_step(ray, crossed, s->strides), (integer)0, (integer)s->last);
    *now = end;
    // The plane itself, found by sums of steps, ends the layer.
    under_way = under_way && !crossed[0];
  }
  return kept;
}

// points  of the scene turned for this fan: [point][place along the three axes in voxels, depth of samples in a layer]
// tangents  of the lines
// left    part of the light that is left, mean over the voxel that the ray is in: [point][layer][row][line]
// weights [point][CHANNELS][row][line], as above
__kernel void follow_fan(EmissionInfo s, FanInfo fan, const __global float* sigma, ulong sigma_first,
  const __global float* outside, const __global float* points, const __global float* tangents,
  const __global float* emission, __global float* left, __global float* weights)
{
  const int line = get_global_id(0) * REAL_WIDTH, band_row = get_global_id(1), p = get_global_id(2);
  const float row_tangent = fan.firstRow + (fan.bandFirst + band_row) * fan.spacing;
  const __global float* of_point = points + 4 * (fan.pointFirst + p);
  const line_packet packet = { { of_point[0], of_point[1], of_point[2] }, { tangents[line], row_tangent },
    { tangents[line + REAL_WIDTH - 1], row_tangent } };
  turned_scene turned;
  turn_fan(&s, &fan, &turned);
  const real along[3] = { turned.spacing[0], load_real(line, tangents) * turned.spacing[1],
    (real)(row_tangent * turned.spacing[2]) };
  const real per_layer = sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
  const real way[3] = { along[0] / per_layer, along[1] / per_layer, along[2] / per_layer };
  box_ray ray;
  real now = 0.0f, received = 1.0f, of_line[CHANNELS];
  integer index = turned.base;
  begin_line(&turned, packet.point, way, &ray);
  for (int a = 0; a < 3; ++a)
  {
    index += (int)floor(packet.point[a]) * turned.strides[a];
  }
  const ulong lines = (ulong)fan.bandRows * fan.lines, place = (ulong)band_row * fan.lines + line;
  for (int layer = (int)floor(packet.point[0]); layer < fan.first[0] + fan.layers; ++layer)
  {
    const bool is_far = layer >= fan.first[0];
    if (is_far && !is_wanted(&s, &turned, &fan, &packet, layer))
    {
      return;
    }
    const float begin = layer - packet.point[0];
    const real kept = cross_layer(
      &turned, outside, (begin + of_point[3]) * per_layer, (begin + 1.0f) * per_layer, &now, &index, &received, &ray);
    if (is_far)
    {
      store_real(kept, ((ulong)p * fan.layers + layer - fan.first[0]) * lines + place, left);
    }
    if (layer == fan.first[0])
    {
      weigh_line(&turned, packet.point, way, fan.emitted, sigma + sigma_first, outside, emission, of_line);
      for (int c = 0; c < CHANNELS; ++c)
      {
        store_real(of_line[c], (p * CHANNELS + c) * lines + place, weights);
      }
    }
  }
}

// Half voxels from the middle of the box along each axis; how many of the 24 parts of space the voxel lies in, if it is
// in one that leads up along all axes, the first of them the farthest; else 0.
static int parts_of_space(const int* distance)
{
  int parts = 1;
  for (int a = 0; a < 3; ++a)
  {
    if (distance[a] < 0 || distance[a] > distance[0])
    {
      return 0;
    }
    parts *= distance[a] == 0 ? 2 : 1;
  }
  return parts * (1 + (distance[1] == distance[0]) + (distance[2] == distance[0]));
}

// The lines of a fan between two places, as indices.
static int2 lines_between(float low, float high, float layers, float first, float spacing, int count)
{
  const int begin = (int)ceil((low / layers - first) / spacing), end = (int)ceil((high / layers - first) / spacing);
  return (int2)(clamp(begin, 0, count), clamp(end, 0, count));
}

// Adds the mean of the lines of fan p that come through a voxel (numerics.md, Eqs. (40a), (40b)).
//   at     the voxel, in the turned scene
//   parts  of space that it lies in
//   sums   [channel][fluence, net flux along the turned axes] times the voxel's volume
static void add_fan(const turned_scene* s, const FanInfo* fan, int p, const int* at, int parts,
  const __global float* points, const __global float* left, const __global float* weights, float* sums)
{
  const ulong lines = (ulong)fan->bandRows * fan->lines;
  const __global float* point = points + 4 * (fan->pointFirst + p);
  const float layers = at[0] + point[3] - point[0];
  const float forward = (at[0] + 0.5f - point[0]) * s->spacing[0];
  const int2 u =
    lines_between(at[1] - point[1], at[1] + 1 - point[1], layers, fan->firstLine, fan->spacing, fan->lines);
  const int2 v = lines_between(at[2] - point[2], at[2] + 1 - point[2], layers, fan->firstRow, fan->spacing, fan->rows);
  const float share = fan->share / (parts * max((u.y - u.x) * (v.y - v.x), 1));
  const __global float* of_layer = left + ((ulong)p * fan->layers + at[0] - fan->first[0]) * lines;
  for (int row = max(v.x, fan->bandFirst); row < min(v.y, fan->bandFirst + fan->bandRows); ++row)
  {
    const float up = (fan->firstRow + row * fan->spacing) * layers * s->spacing[2];
    for (int line = u.x; line < u.y; ++line)
    {
      const float aside = (fan->firstLine + line * fan->spacing) * layers * s->spacing[1];
      const float inverse = 1.0f / (forward * forward + aside * aside + up * up);
      const float deep = s->spacing[0] * s->spacing[0] * inverse / 24.0f;
      const float seen = inverse * (1.0f + deep * (8.0f * forward * forward * inverse - 2.0f)) * share;
      const ulong place = (ulong)(row - fan->bandFirst) * fan->lines + line;
      for (int c = 0; c < CHANNELS; ++c)
      {
        const float got = seen * of_layer[place] * weights[(p * CHANNELS + c) * lines + place];
        sums[4 * c] += got;
#if NET_FLUX
        const float part = got * sqrt(inverse);
        sums[4 * c + 1] += part * forward;
        sums[4 * c + 2] += part * aside;
        sums[4 * c + 3] += part * up;
#endif
      }
    }
  }
}

// path  W length times the number of fans, [channel][stride], added to;  flux  the same, [channel][x, y, z][stride]
// halves  path of half of the fans, sum over the channels, [voxel], added to
__kernel void collect_fans(EmissionInfo s, FanInfo fan, const __global float* points, const __global float* left,
  const __global float* weights, __global float* path, __global float* flux, ulong stride, __global float* halves)
{
  turned_scene turned;
  turn_fan(&s, &fan, &turned);
  const int at[3] = { fan.first[0] + (int)get_global_id(2), fan.first[1] + (int)get_global_id(0),
    fan.first[2] + (int)get_global_id(1) };
  int distance[3];
  ulong i = turned.base;
  for (int a = 0; a < 3; ++a)
  {
    distance[a] = 2 * at[a] + 1 - 2 * turned.sourceFirst[a] - turned.sourceSize[a];
    i += (long)at[a] * turned.strides[a];
  }
  const int parts = parts_of_space(distance);
  if (parts == 0)
  {
    return;
  }
  float sums[CHANNELS * 4];
  for (int k = 0; k < CHANNELS * 4; ++k)
  {
    sums[k] = 0.0f;
  }
  const int of_half = clamp(fan.halfOfPoints - fan.pointFirst, 0, fan.points);
  for (int p = 0; p < fan.points; ++p)
  {
    for (int c = 0; c < CHANNELS && p == of_half; ++c)
    {
      halves[i] += sums[4 * c];
    }
    add_fan(&turned, &fan, p, at, parts, points, left, weights, sums);
  }
  for (int c = 0; c < CHANNELS; ++c)
  {
    halves[i] += of_half == fan.points ? sums[4 * c] : 0.0f;
    path[c * stride + i] += sums[4 * c];
#if NET_FLUX
    for (int k = 0; k < 3; ++k)
    {
      flux[(3 * c + turned.axis[k]) * stride + i] += turned.sign[k] * sums[4 * c + 1 + k];
    }
#endif
  }
}

// What half of the fans have found, before the other half: sum over the channels.
__kernel void keep_half(const __global float* path, ulong stride, __global float* halves)
{
  const ulong i = get_global_id(0);
  halves[i] = 0.0f;
  for (int c = 0; c < CHANNELS; ++c)
  {
    halves[i] += path[c * stride + i];
  }
}

// found  1 where two halves of the fans agree, -1 where a voxel is too near for them, else 0
// clear  W length in a voxel at a distance of 1 with nothing between, sum over the channels
__kernel void judge_fans(EmissionInfo s, const __global float* path, ulong stride, float clear,
  const __global float* halves, __global float* found)
{
  const ulong i = get_global_id(0);
  const int at[3] = { (int)(i % s.size[0]), (int)(i / s.size[0] % s.size[1]),
    (int)(i / ((ulong)s.size[0] * s.size[1])) };
  float all = 0.0f, squared = 0.0f;
  int farthest = 0;
  for (int a = 0; a < 3; ++a)
  {
    const int distance = abs(2 * at[a] + 1 - 2 * s.sourceFirst[a] - s.sourceSize[a]);
    farthest = max(farthest, distance);
    squared += 0.25f * distance * distance * s.spacing[a] * s.spacing[a];
  }
  for (int c = 0; c < CHANNELS; ++c)
  {
    all += path[c * stride + i];
  }
  const bool agree = fabs(all - 2.0f * halves[i]) <= OF_HALVES * s.uneven * fmax(all, DIM * clear / squared);
  found[i] = farthest < s.near ? -1.0f : agree ? 1.0f : 0.0f;
}

__kernel void scale_fans(__global float* values, float factor)
{
  values[get_global_id(0)] *= factor;
}
