// Light of a localised emission in voxels far from it, along fans of rays that many voxels share. Options:
//   CHANNELS  1
//   NET_FLUX  1: compute net flux
//
// A fan consists of all rays from one point of the emitting box into one 24th of the sphere of directions, on a grid of
// tangents fine enough that a ray crosses every voxel of the last layer. For each ray and each layer of voxels that it
// crosses, the light that the ray carries is stored; each voxel averages over the rays that cross it (numerics.md, Eqs.
// (40a), (40b)). The rays of a SIMD packet belong to one row of a fan: they cross planes between rows of voxels
// together, and at most one plane between voxels of a row per step.

#include "LightPropagation/Emission/EmissionBox.cl"

// The light of the first and that of the second half of the fans agree if their difference is at most this factor times
// EmissionInfo::uneven times their sum. The factor is above 1, since the sum is more accurate than the difference
// suggests.
#define OF_HALVES 3.0f
// If the light of all fans is less than this fraction of their light without extinction, the difference of the halves
// is compared with that fraction instead.
#define DIM 1e-6f

static void turn_fan(const EmissionInfo* s, const FanInfo* fan, turned_scene* turned)
{
  const lit_voxel nowhere = { { 0, 0, 0 }, 3, 0, false };
  lit_voxel turned_nowhere;
  turn_scene(s, &nowhere, fan->order, fan->turned, turned, &turned_nowhere);
}

// Copies sigma_t to `outside`, with 0 in the emitting box: the extinction that the rays of a fan undergo after leaving
// the box. The axes are permuted as in FanInfo::order: voxels along the second axis are contiguous, followed by those
// along the third. One work-item per voxel.
__kernel void lay_out(
  EmissionInfo s, FanInfo fan, const __global float* sigma, ulong sigma_first, __global float* outside)
{
  const int strides[3] = { 1, s.size[0], s.size[0] * s.size[1] };
  const int at[3] = { (int)get_global_id(2), (int)get_global_id(0), (int)get_global_id(1) };
  const ulong to = ((ulong)at[0] * s.size[fan.order[2]] + at[2]) * s.size[fan.order[1]] + at[1];
  bool inside = true;
  ulong from = sigma_first;
  for (int k = 0; k < 3; ++k)
  {
    const int a = fan.order[k];
    inside = inside && at[k] >= s.sourceFirst[a] && at[k] < s.sourceFirst[a] + s.sourceSize[a];
    from += (ulong)at[k] * strides[a];
  }
  outside[FanMargin + to] = inside ? 0.0f : sigma[from];
}

// Sets up a ray on the line through a point of the emitting box: its distances from the point to the box's faces, ahead
// (`leave`) and behind (`enter`, negative).
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

// Power per solid angle that a ray of a fan carries where it leaves the emitting box, W / sr: the radiance there,
// divided by the density of the fans' origins along the line of the ray. Origins are distributed in proportion to
// emission, so that this power is equal for all rays if the box does not attenuate.
static real weigh_line(const turned_scene* s, const float* point, const real* way, float emitted,
  const __global float* sigma, const __global float* emission)
{
  const real back[3] = { -way[0], -way[1], -way[2] };
  real at[3], seen[1], clear[1];
  box_ray ray;
  for (int a = 0; a < 3; ++a)
  {
    at[a] = point[a];
  }
  begin_line(s, point, back, &ray);
  see_box(s, at, &ray, 1.0f, sigma, emission, seen, clear);
  return seen[0] * emitted / fmax(clear[0], (real)1e-30f);
}

// Origin and tangents of a SIMD packet: adjacent rays of a fan, i.e. of the rays from one point of the emitting box.
typedef struct
{
  float point[3]; // origin of the rays, voxels
  // Smallest and largest tangent (voxels per layer) of the packet's rays along the second and third axis
  float low[2], high[2];
} line_packet;

// Whether a packet of a fan's rays may still reach voxels, in this layer or beyond, in the part of space (one of 24)
// that the fan lights.
static bool is_wanted(
  const EmissionInfo* s, const turned_scene* turned, const FanInfo* fan, const line_packet* packet, int layer)
{
  const float near = layer - packet->point[0], far = near + 1.0f;
  // lateral limit, in this layer, of the part of space that the fan lights, voxels from the emitting box's centre
  const float away = layer + 1.0f - turned->sourceFirst[0] - 0.5f * turned->sourceSize[0];
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

// State of a SIMD packet of a fan's rays that follow_fan() traces. All rays of a packet belong to one row of the fan.
typedef struct
{
  // position of the rays' origin along the second and third axis, voxels; tangent of their row along the third axis
  float point[2], row_tangent;
  real tangent, inverse; // tangents of the rays along the second axis, and their inverses
  real per_layer;        // path length of each ray per layer
  real tau;              // optical length from the emitting box
  real kept;             // transmittance at `sample`, averaged over the voxel there
  float sample;          // distance from the origin at which light is sampled, layers
} fan_lines;

// Advances the rays within one row of voxels, from `from` to `to` (layers from the origin). Requires that no ray
// crosses more than one plane of voxel faces.
static void cross_row(const turned_scene* s, const FanInfo* fan, const __global float* row, int last, float from,
  float to, fan_lines* lines)
{
  const real begin = floor(lines->point[0] + lines->tangent * from);
  const real end = floor(lines->point[0] + lines->tangent * to);
  const real plane = clamp((fmax(begin, end) - lines->point[0]) * lines->inverse, (real)from, (real)to);
  const real middle = select((real)to, plane, begin != end);
  const integer low = clamp(to_integer(fmin(begin, end)), (integer)0, (integer)last);
  const bool turned = fan->strides[1] < 0; // whether voxels are in reverse order in memory
  real one, other;
  take_pairs(row, turned ? -1 - low : low, &one, &other);
  const integer as_they_lie = turned ? begin > end : begin <= end;
  const real first = select(other, one, as_they_lie) * (middle - from) * lines->per_layer;
  const real second = select(one, other, as_they_lie) * (to - middle) * lines->per_layer;
  if (lines->sample >= from && lines->sample < to)
  {
    const integer later = middle <= (real)lines->sample;
    real left, through;
    extinguished(lines->tau + select((real)0.0f, first, later), &left);
    lines->kept = left * mean_left(select(first, second, later), &through);
  }
  lines->tau += first + second;
}

// Advances the rays within one layer of voxels, from `from` to `to` (layers from the origin). In each step no ray
// crosses more than one plane of voxel faces across the second axis, and no more than one across the third.
static void cross_layer(const turned_scene* s, const EmissionInfo* info, const FanInfo* fan,
  const __global float* of_layer, int steps, float from, float to, fan_lines* lines)
{
  const int last[2] = { info->size[fan->order[1]] - 1, info->size[fan->order[2]] - 1 };
  for (int step = 0; step < steps; ++step)
  {
    const float begin = from + (to - from) * step / steps, end = from + (to - from) * (step + 1) / steps;
    const float low = floor(lines->point[1] + lines->row_tangent * begin);
    const float high = floor(lines->point[1] + lines->row_tangent * end);
    const float plane = low == high ? end : clamp((fmax(low, high) - lines->point[1]) / lines->row_tangent, begin, end);
    cross_row(s, fan, of_layer + clamp((int)low, 0, last[1]) * fan->strides[2], last[0], begin, plane, lines);
    if (plane < end)
    {
      cross_row(s, fan, of_layer + clamp((int)high, 0, last[1]) * fan->strides[2], last[0], plane, end, lines);
    }
  }
}

// Factor that converts light per solid angle to its mean over a voxel: the average of 1 / r^2 over the layer,
// 1/length^2.
static real spread(const turned_scene* s, const fan_lines* lines, float layers)
{
  const float forward = layers * s->spacing[0], up = lines->row_tangent * lines->sample * s->spacing[2];
  const real aside = lines->tangent * (lines->sample * s->spacing[1]);
  const real inverse = 1.0f / (forward * forward + aside * aside + up * up);
  const real deep = inverse * (s->spacing[0] * s->spacing[0] / 24.0f);
  return inverse * (1.0f + deep * (8.0f * forward * forward * inverse - 2.0f));
}

// Traces the rays of fans; a fan consists of all rays from one point of the emitting box. One work-item per SIMD packet
// of rays, row of rays, and fan.
// points    origins of the fans in the permuted scene, [fan][FanPointFloats]
// tangents  tangents of a row's rays along the second axis, without the offset of the fan
// outside   extinction outside the emitting box, see lay_out()
// light     fluence that the ray contributes to the voxel it is in, W / length^2; at layer index fan.layers, flux
//           density through the face of the grid: [fan][layer][row][ray of the row]
__kernel void follow_fan(EmissionInfo s, FanInfo fan, const __global float* sigma, ulong sigma_first,
  const __global float* outside, const __global float* points, const __global float* tangents,
  const __global float* emission, __global float* light)
{
  const int line = get_global_id(0) * REAL_WIDTH, band_row = get_global_id(1), p = get_global_id(2);
  const __global float* of_point = points + FanPointFloats * (fan.pointFirst + p);
  const float aside = of_point[4] * fan.spacing;
  const line_packet packet = { { of_point[0], of_point[1], of_point[2] },
    { tangents[line] + aside, fan.firstRow + (fan.bandFirst + band_row + of_point[5]) * fan.spacing },
    { tangents[line + REAL_WIDTH - 1] + aside,
      fan.firstRow + (fan.bandFirst + band_row + of_point[5]) * fan.spacing } };
  turned_scene turned;
  turn_fan(&s, &fan, &turned);
  fan_lines lines = { { of_point[1], of_point[2] }, packet.low[1], load_real(line, tangents) + aside };
  const real along[3] = { turned.spacing[0], lines.tangent * turned.spacing[1],
    (real)(lines.row_tangent * turned.spacing[2]) };
  lines.inverse = 1.0f / select(lines.tangent, (real)1e-20f, lines.tangent == (real)0.0f);
  lines.per_layer = sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
  lines.tau = 0.0f;
  const int steps = max(1, (int)ceil(fmax(fmax(fabs(packet.low[0]), fabs(packet.high[0])), fabs(packet.low[1]))));
  const ulong all = (ulong)fan.bandRows * fan.lines;
  __global float* to = light + (ulong)p * (fan.layers + 1) * all + (ulong)band_row * fan.lines + line;
  real weight = 0.0f;
  for (int layer = (int)floor(of_point[0]); layer < fan.first[0] + fan.layers; ++layer)
  {
    const bool is_far = layer >= fan.first[0];
    if (is_far && !is_wanted(&s, &turned, &fan, &packet, layer))
    {
      return;
    }
    const float begin = layer - of_point[0];
    lines.sample = begin + of_point[3];
    cross_layer(&turned, &s, &fan, outside + (FanMargin + fan.base + layer * fan.strides[0]), steps, fmax(begin, 0.0f),
      begin + 1.0f, &lines);
    if (layer == fan.first[0])
    {
      const real way[3] = { along[0] / lines.per_layer, along[1] / lines.per_layer, along[2] / lines.per_layer };
      weight = weigh_line(&turned, packet.point, way, fan.emitted, sigma + sigma_first, emission);
    }
    if (is_far)
    {
      store_real(weight * lines.kept * spread(&turned, &lines, begin + 0.5f), (layer - fan.first[0]) * all, to);
    }
  }
  real left;
  extinguished(lines.tau, &left);
  const float layers = fan.first[0] + fan.layers - of_point[0];
  const real inverse = 1.0f / (layers * lines.per_layer);
  store_real(weight * left * inverse * inverse * (along[0] / lines.per_layer), fan.layers * all, to);
}

// Number of a fan's rays along one axis that pass below a position. The rays that cross a voxel are those between the
// numbers for its two borders.
//   place      position relative to the fan's origin, voxels
//   per_voxel  number of rays per voxel edge at the depth of the voxels
//   before     index of the ray with tangent 0, negated
static integer lines_up_to(real place, float per_voxel, float before, int count)
{
  return clamp(to_integer(ceil(place * per_voxel - before)), (integer)0, (integer)count);
}

// Adds the light of rays to the sums of adjacent voxels: each SIMD lane has one ray and one voxel. The rays belong to
// one row of a fan.
//   got        light of the ray, divided by the number of rays over which its voxel averages
//   aside, up  tangents of the ray and of the row, times the voxel's edge
//   sums       [fluence, net flux along the permuted axes]
static void add_lines(const turned_scene* s, real got, real aside, float up, real* sums)
{
  sums[0] += got;
  if (!NET_FLUX)
  {
    return;
  }
  const real part = got * rsqrt(s->spacing[0] * s->spacing[0] + aside * aside + up * up);
  sums[1] += part * s->spacing[0];
  sums[2] += part * aside;
  sums[3] += part * up;
}

// For each of some adjacent voxels, or adjacent cells of the face at the end of the layers: adds to `sums` the mean
// light of those rays of fan p that cross it (numerics.md, Eqs. (40a), (40b)).
//   layer       layer of voxels, from 0; fan->layers: the face
//   at, row_at  positions of the voxels along the second and the third axis
static void add_fan(const turned_scene* s, const FanInfo* fan, int p, int layer, real at, int row_at,
  const __global float* points, const __global float* light, real* sums)
{
  const ulong all = (ulong)fan->bandRows * fan->lines;
  const __global float* point = points + FanPointFloats * (fan->pointFirst + p);
  const float depth = layer == fan->layers ? 0.0f : point[3];
  const float per_voxel = 1.0f / ((fan->first[0] + layer + depth - point[0]) * fan->spacing);
  const float before = fan->firstLine / fan->spacing + point[4], rows_before = fan->firstRow / fan->spacing + point[5];
  const integer begin = lines_up_to(at - point[1], per_voxel, before, fan->lines);
  const integer end = lines_up_to(at + 1.0f - point[1], per_voxel, before, fan->lines);
  const int low = clamp((int)ceil((row_at - point[2]) * per_voxel - rows_before), 0, fan->rows);
  const int high = clamp((int)ceil((row_at + 1 - point[2]) * per_voxel - rows_before), 0, fan->rows);
  const real share = 1.0f / fmax(to_real(end - begin) * (float)(high - low), (real)1.0f);
  const __global float* of_layer = light + ((ulong)p * (fan->layers + 1) + layer) * all;
  const float edge = fan->spacing * s->spacing[1];
  for (int row = max(low, fan->bandFirst); row < min(high, fan->bandFirst + fan->bandRows); ++row)
  {
    const __global float* of_row = of_layer + (ulong)(row - fan->bandFirst) * fan->lines;
    const float up = (row + rows_before) * fan->spacing * s->spacing[2];
    for (integer line = begin; any_of(line < end); line += 2)
    {
      real one, next;
      take_pairs(of_row, min(line, (integer)(fan->lines - 1)), &one, &next);
      const real aside = (to_real(line) + before) * edge;
      add_lines(s, select((real)0.0f, one * share, line < end), aside, up, sums);
      add_lines(s, select((real)0.0f, next * share, line + 1 < end), aside + edge, up, sums);
    }
  }
}

// Space is divided into 24 parts, one for each combination of a cyclic permutation and a reflection of the axes.
// Returns the number of parts that contain a voxel; it is more than 1 if the voxel lies on a border between parts.
// Returns 0 if the voxel is not in the part whose fans are traced, in which no distance is negative and the distance
// along the first axis is the largest.
//   distance  from the centre of the emitting box along each axis, half voxels
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

// Distance of a voxel, or of a cell of the face, from the centre of the emitting box along each axis, in half voxels.
static void find_distance(const turned_scene* s, const int* at, bool is_face, int* distance)
{
  for (int a = 0; a < 3; ++a)
  {
    distance[a] = 2 * at[a] + (a == 0 && is_face ? 0 : 1) - 2 * s->sourceFirst[a] - s->sourceSize[a];
  }
}

// Index in the original grid of a voxel of the permuted scene.
static ulong voxel_index(const turned_scene* s, const int* at)
{
  return s->base + (long)at[0] * s->strides[0] + (long)at[1] * s->strides[1] + (long)at[2] * s->strides[2];
}

// Index, among the cells of all faces of the grid (FanFaceFirst), of a cell of the face at which the rays of a fan end.
static ulong cell_index(const EmissionInfo* s, const FanInfo* fan, const turned_scene* turned, const int* at)
{
  const int sizes[2] = { s->size[fan->order[1]], s->size[fan->order[2]] };
  const int u = turned->sign[1] < 0.0f ? sizes[0] - 1 - at[1] : at[1];
  const int v = turned->sign[2] < 0.0f ? sizes[1] - 1 - at[2] : at[2];
  return fan->faceFirst + (ulong)v * sizes[0] + u;
}

// Adds the light of the FanInfo::points fans that follow_fan() has just traced to the sums over all fans. One work-item
// per SIMD packet of voxels, row, and layer.
//   path         fluence, W / length^2, [voxel]
//   flux         net flux, W / length^2, [x, y, z][voxel]
//   halves       fluence due to the first half of the fans, W / length^2, [voxel]
//   faces        outgoing flux density through the box's faces, W / length^2, [cell]
//   face_halves  outgoing flux density due to the first half of the fans, W / length^2, [cell]
__kernel void collect_fans(EmissionInfo s, FanInfo fan, const __global float* points, const __global float* light,
  __global float* path, __global float* flux, ulong stride, __global float* halves, __global float* faces,
  __global float* face_halves)
{
  turned_scene turned;
  turn_fan(&s, &fan, &turned);
  const int layer = get_global_id(2);
  const bool is_face = layer == fan.layers;
  int at[3] = { fan.first[0] + layer, fan.first[1] + (int)get_global_id(0) * REAL_WIDTH,
    fan.first[2] + (int)get_global_id(1) };
  int distance[3];
  find_distance(&turned, at, is_face, distance);
  if (distance[2] < 0 || distance[2] > distance[0] || distance[1] > distance[0])
  {
    return;
  }
  real sums[4], early = 0.0f, beside; // sums over all fans and over their first half; positions along the second axis
  for (int lane = 0; lane < REAL_WIDTH; ++lane)
  {
    ((float*)&beside)[lane] = at[1] + lane;
  }
  for (int k = 0; k < 4; ++k)
  {
    sums[k] = 0.0f;
  }
  const int of_half = clamp(fan.halfOfPoints - fan.pointFirst, 0, fan.points);
  for (int p = 0; p < fan.points; ++p)
  {
    early = p == of_half ? sums[0] : early;
    add_fan(&turned, &fan, p, layer, beside, at[2], points, light, sums);
  }
  early = of_half == fan.points ? sums[0] : early;
  for (int lane = 0; lane < REAL_WIDTH && at[1] < s.size[fan.order[1]]; ++lane, ++at[1], distance[1] += 2)
  {
    const int parts = parts_of_space(distance);
    const float share = parts == 0 ? 0.0f : 1.0f / parts;
    const float all = share * ((const float*)&sums[0])[lane], first_half = share * ((const float*)&early)[lane];
    if (parts > 0 && is_face)
    {
      const ulong cell = cell_index(&s, &fan, &turned, at);
      faces[cell] += all;
      face_halves[cell] += first_half;
    }
    else if (parts > 0)
    {
      const ulong i = voxel_index(&turned, at);
      path[i] += all;
      halves[i] += first_half;
      for (int k = 0; NET_FLUX && k < 3; ++k)
      {
        flux[turned.axis[k] * stride + i] += turned.sign[k] * share * ((const float*)&sums[1 + k])[lane];
      }
    }
  }
}

// Whether the light of the first half of the fans agrees with that of the second half: the difference is small relative
// to the sum, or to a small fraction of the light without extinction.
//   all         light of all fans
//   first_half  light of the first half of the fans
//   clear       light of all fans without extinction
static bool agree(const EmissionInfo* s, float all, float first_half, float clear)
{
  return fabs(all - 2.0f * first_half) <= OF_HALVES * s->uneven * fmax(all, DIM * clear);
}

// Compares the light of the first and the second half of the fans in each voxel.
// found    receives 1: the halves agree; 0: they differ; -1: the voxel is too close to the emission for fans
// emitted  integral of emission over the emitting box, times the number of fans
__kernel void judge_voxels(
  EmissionInfo s, float emitted, const __global float* path, const __global float* halves, __global float* found)
{
  const ulong i = get_global_id(0);
  const int at[3] = { (int)(i % s.size[0]), (int)(i / s.size[0] % s.size[1]),
    (int)(i / ((ulong)s.size[0] * s.size[1])) };
  float squared = 0.0f;
  int farthest = 0;
  for (int a = 0; a < 3; ++a)
  {
    const int distance = abs(2 * at[a] + 1 - 2 * s.sourceFirst[a] - s.sourceSize[a]);
    farthest = max(farthest, distance);
    squared += 0.25f * distance * distance * s.spacing[a] * s.spacing[a];
  }
  found[i] = farthest < s.near ? -1.0f : agree(&s, path[i], halves[i], emitted / squared) ? 1.0f : 0.0f;
}

// Compares the light of the first and the second half of the fans in each cell of a face, as judge_voxels() does in
// voxels.
// found  also -1 in cells that are farther from the emission laterally than along the face's normal
__kernel void judge_cells(EmissionInfo s, int axis, int up, ulong first, float emitted, const __global float* faces,
  const __global float* halves, __global float* found)
{
  const ulong i = get_global_id(0);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const int at[2] = { (int)(i % s.size[u]), (int)(i / s.size[u]) };
  const int ahead = abs((up ? 2 * s.size[axis] : 0) - 2 * s.sourceFirst[axis] - s.sourceSize[axis]);
  const int aside = max(abs(2 * at[0] + 1 - 2 * s.sourceFirst[u] - s.sourceSize[u]),
    abs(2 * at[1] + 1 - 2 * s.sourceFirst[v] - s.sourceSize[v]));
  const float away = 0.5f * ahead * s.spacing[axis];
  // A fan lights only voxels from its first layer on, and only those in its part (one of 24) of space.
  const bool far = ahead > s.near && aside <= ahead;
  const bool even = agree(&s, faces[first + i], halves[first + i], emitted / fmax(away * away, 1e-30f));
  found[first + i] = !far ? -1.0f : even ? 1.0f : 0.0f;
}

__kernel void scale_fans(__global float* values, float factor)
{
  values[get_global_id(0)] *= factor;
}
