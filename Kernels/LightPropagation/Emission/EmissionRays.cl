// Light of a localised emission, gathered by each voxel along straight rays. Options:
//   CHANNELS  1, or 3 that share sigma_t
//   NET_FLUX  1: compute net flux
//   MOST      maximum number of rays from a voxel to the emitting box

#include "LightPropagation/Emission/EmissionBox.cl"

#define OPAQUE 80.0f // optical length beyond which the transmittance is taken as 0

static void begin_ray(const turned_scene* s, const lit_voxel* voxel, const real* point, const real* way, box_ray* ray)
{
  ray->enter = 0.0f;
  ray->leave = 1e30f;
  ray->behind = 1e30f;
  for (int a = 0; a < 3; ++a)
  {
    ray->rate[a] = way[a] / s->spacing[a];
    ray->up[a] = ray->rate[a] > (real)0.0f;
    ray->step[a] = 1.0f / fmax(fabs(ray->rate[a]), (real)1e-20f);
    const real x = point[a] - voxel->at[a];
    ray->next[a] = select(x, 1.0f - x, ray->up[a]) * ray->step[a];
    ray->behind = fmin(ray->behind, select(1.0f - x, x, ray->up[a]) * ray->step[a]);
    const real low = s->sourceFirst[a] - point[a];
    const real high = low + s->sourceSize[a];
    ray->enter = fmax(ray->enter, select(-high, low, ray->up[a]) * ray->step[a]);
    ray->leave = fmin(ray->leave, select(-low, high, ray->up[a]) * ray->step[a]);
  }
  ray->ahead = fmin(ray->next[0], fmin(ray->next[1], ray->next[2]));
  ray->leave = fmax(ray->leave, (real)0.0f);
  ray->enter = fmin(ray->enter, ray->leave); // rounding may place the entry behind the exit
}

// Traces a ray from voxel `begin` of the grid to the emitting box. @return optical length from the point to the box
static real follow_to_box(const turned_scene* s, box_ray* ray, int begin, const __global float* sigma)
{
  integer index = begin, crossed[3];
  real now = 0.0f, tau = 0.0f;
  integer under_way = now < ray->enter;
  while (any_of(under_way))
  {
    const real end = fmin(fmin(ray->next[0], fmin(ray->next[1], ray->next[2])), ray->enter);
    tau += take(sigma, index) * (end - now);
    cross_planes(ray, end, ray->enter, crossed);
    index += index_step(ray, crossed, s->strides);
    // Clamped, since by rounding a ray along a face of the grid may take a step of zero length out of the grid.
    index = clamp(index, (integer)0, (integer)s->last);
    now = end;
    under_way = now < ray->enter && tau < (real)OPAQUE;
  }
  return tau;
}

// Traces rays from points to the emitting box and through it. Computes the radiance at the points, W / (length^2 sr),
// [CHANNELS] (numerics.md, Eq. (40)). The extinction in the receiving voxel is averaged over the line through that
// voxel.
//   point      position along x, y, z, voxels
//   way        unit vectors towards the emitting box
//   sigma      extinction of the grid, 1/length
//   emission   of the emitting box, W / (length^3 sr), [CHANNELS][voxel]
static void trace(const turned_scene* s, const lit_voxel* voxel, const real* point, const real* way,
  const __global float* sigma, const __global float* emission, real* radiance)
{
  const int* strides = s->strides;
  const int begin = s->base + voxel->at[0] * strides[0] + voxel->at[1] * strides[1] + voxel->at[2] * strides[2];
  box_ray ray;
  begin_ray(s, voxel, point, way, &ray);
  real tau = follow_to_box(s, &ray, begin, sigma);
  real received = 1.0f, left;
  if (!voxel->inside && voxel->across > 2)
  {
    const float own = sigma[begin];
    tau = fmax(tau - own * ray.ahead, (real)0.0f);
    received = mean_left(own * (ray.ahead + ray.behind), &left);
  }
  extinguished(tau, &left);
  see_box(s, point, &ray, received * left, sigma, emission, radiance, 0);
}

// Solid angle, seen from the voxel's centre, of each side of the emitting box through which light arrives; 0 for the
// other sides. Values below an eighth of the largest are raised to that eighth, since a side's solid angle may be
// larger from other points of the voxel.
static void find_sides(const turned_scene* s, const lit_voxel* voxel, float* solid_angles)
{
  float largest = 0.0f;
  for (int side = 0; side < 6; ++side)
  {
    const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const int at = voxel->at[axis], first = s->sourceFirst[axis], end = first + s->sourceSize[axis];
    const bool seen = voxel->inside
      ? axis != voxel->across || side % 2 != voxel->up || at != (side % 2 ? end - 1 : first)
      : (side % 2 ? at >= end : at < first);
    const float away = fabs((side % 2 ? end : first) - at - 0.5f) * s->spacing[axis];
    solid_angles[side] = 0.0f;
    for (int corner = 0; corner < 4 && seen; ++corner)
    {
      const float x = (s->sourceFirst[u] + (corner & 1) * s->sourceSize[u] - voxel->at[u] - 0.5f) * s->spacing[u];
      const float y = (s->sourceFirst[v] + (corner >> 1) * s->sourceSize[v] - voxel->at[v] - 0.5f) * s->spacing[v];
      const float part = atan(x * y / (away * sqrt(x * x + y * y + away * away)));
      solid_angles[side] += corner == 0 || corner == 3 ? part : -part;
    }
    largest = fmax(largest, solid_angles[side]);
  }
  for (int side = 0; side < 6; ++side)
  {
    solid_angles[side] = solid_angles[side] > 0.0f ? fmax(solid_angles[side], 0.125f * largest) : 0.0f;
  }
}

// values[(axis + shift) % 3], for each SIMD lane.
static inline real along(const real* values, integer axis, int shift)
{
  const real other = select(values[(2 + shift) % 3], values[(1 + shift) % 3], axis == (integer)1);
  return select(other, values[shift % 3], axis == (integer)0);
}

// The side of the emitting box to which rays are directed, for each SIMD lane.
typedef struct
{
  integer axis, highSide; // axis of the side's normal; -1: the side at the upper end of this axis, 0: at the lower end
  real part;              // remainder of the coordinate that selected the side, 0 to 1
  real share;             // the side's share of the solid angle of all sides
} box_side;

// Selects a side of the emitting box with a probability in proportion to its solid angle.
//   choice  first coordinate of a lattice point, 0 to 1, times `total`
//   total   sum of the solid angles of the six sides
static box_side choose_side(const float* solid_angles, float total, real choice)
{
  box_side to;
  to.axis = to.highSide = 0;
  to.part = 0.0f;
  to.share = 1.0f;
  float before = 0.0f;
  for (int side = 0; side < 6; ++side)
  {
    const integer chosen = choice >= (real)(solid_angles[side] > 0.0f ? before : 1e30f);
    to.axis = select(to.axis, (integer)(side / 2), chosen);
    to.highSide = select(to.highSide, (integer)(-(side % 2)), chosen);
    to.part = select(to.part, (choice - before) / fmax(solid_angles[side], 1e-30f), chosen);
    to.share = select(to.share, (real)(solid_angles[side] / total), chosen);
    before += solid_angles[side];
  }
  to.part = clamp(to.part, (real)0.0f, (real)1.0f);
  return to;
}

// Directs rays from points to a side of the emitting box (numerics.md, Eq. (41)): u = to->part and v, from 0 to 1,
// parametrise the angles by tan(x / 2) and sin.
//   way      receives unit vectors along the rays
//   returns  solid angle per unit of u and v, sr, divided by the probability of the side
static real aim_at_side(
  const turned_scene* s, const lit_voxel* voxel, const box_side* to, const real* point, real v, real* way)
{
  real low[3], high[3], edge[3];
  for (int a = 0; a < 3; ++a)
  {
    low[a] = (s->sourceFirst[a] - point[a]) * s->spacing[a];
    high[a] = low[a] + s->sourceSize[a] * s->spacing[a];
    edge[a] = s->spacing[a];
  }
  const real low_u = along(low, to->axis, 1), high_u = along(high, to->axis, 1);
  const real low_v = along(low, to->axis, 2), high_v = along(high, to->axis, 2);
  const real away = fmax(
    fabs(select(along(low, to->axis, 0), along(high, to->axis, 0), to->highSide)), 1e-4f * along(edge, to->axis, 0));
  const real half_low = low_u / (away + sqrt(away * away + low_u * low_u));
  const real half_range = high_u / (away + sqrt(away * away + high_u * high_u)) - half_low;
  const real tangent = half_low + half_range * to->part; // tangent of half the angle
  const real squared = tangent * tangent;
  // distance from the point to the line on the box's side along which v varies
  const real across_u = away * (1.0f + squared) / (1.0f - squared);
  const real sin_low = low_v * rsqrt(across_u * across_u + low_v * low_v);
  const real sin_range = high_v * rsqrt(across_u * across_u + high_v * high_v) - sin_low;
  const real sine = sin_low + sin_range * v;
  const real solid_angle = half_range * 2.0f / (1.0f + squared) * sin_range / to->share;
  // Above 0, since a ray parallel to the side would miss it.
  const real cosine = sqrt(fmax(1.0f - sine * sine, (real)1e-12f));
  const integer ahead = voxel->inside ? to->highSide : ~to->highSide;
  const real forward = cosine * (1.0f - squared) / (1.0f + squared);
  const real turned[3] = { select(-forward, forward, ahead), cosine * 2.0f * tangent / (1.0f + squared), sine };
  const integer back = select((integer)0, 3 - to->axis, to->axis > (integer)0);
  for (int a = 0; a < 3; ++a)
  {
    way[a] = along(turned, back, a);
  }
  return solid_angle;
}

// Gathers light along rays to the emitting box. The points of a lattice in five dimensions provide positions in the
// voxel, and directions that are uniform over the solid angles of the box's sides. The first coordinate selects a side,
// with a probability proportional to the side's solid angle. The remainder of the first coordinate (u, 0 to 1) and the
// second coordinate (v) parametrise the angles by tan(x / 2) and sin (aim_at_side).
//   from, end  range of rays, a multiple of REAL_WIDTH
//   points     lattice, [u, v, x, y, z][MOST]
//   sums       mean over the rays, W / length^2, [channel][fluence, net flux along x, y, z]
static void gather_rays(const turned_scene* s, const lit_voxel* voxel, const float* solid_angles, int from, int end,
  const __global float* points, const __global float* sigma, const __global float* emission, float* sums)
{
  real all[CHANNELS * 4];
  for (int k = 0; k < CHANNELS * 4; ++k)
  {
    all[k] = 0.0f;
  }
  float total = 0.0f;
  for (int side = 0; side < 6; ++side)
  {
    total += solid_angles[side];
  }
  for (int i = from; i < end && total > 0.0f; i += REAL_WIDTH)
  {
    const box_side to = choose_side(solid_angles, total, load_real(i, points) * total);
    real point[3], way[3], radiance[CHANNELS];
    for (int a = 0; a < 3; ++a)
    {
      point[a] = voxel->at[a] + (a == voxel->across ? (real)voxel->up : load_real(i, points + (2 + a) * MOST));
    }
    const real solid_angle = aim_at_side(s, voxel, &to, point, load_real(i, points + MOST), way);
    trace(s, voxel, point, way, sigma, emission, radiance);
    for (int c = 0; c < CHANNELS; ++c)
    {
      radiance[c] *= solid_angle;
      all[4 * c] += radiance[c];
      for (int a = 0; a < 3; ++a)
      {
        all[4 * c + 1 + a] -= radiance[c] * way[a];
      }
    }
  }
  for (int k = 0; k < CHANNELS * 4; ++k)
  {
    sums[k] = sum_of(all[k]) / (end - from);
  }
}

// Transformations of the scene (permutations and reflections of its axes) that make equivalent voxels and faces receive
// equal light. There is only one for a voxel, unless the voxel lies symmetrically with respect to the emission.
typedef struct
{
  int permutations[6][3]; // permutations of the scene's axes
  int count;
  // Bit masks of axes: those that are reflected; those along which the voxel and the emission's centre have the same
  // coordinate, so that the light is averaged over both signs of the axis.
  int turned, either;
} ways_to_turn;

// Whether axis a precedes axis b in the permuted scene. Order: the normal of a receiving face, then decreasing distance
// from the centre of the emission, size of the emission, and size of the voxel.
static bool goes_before(const EmissionInfo* s, const lit_voxel* voxel, const int* distance, int a, int b)
{
  if ((a == voxel->across) != (b == voxel->across))
  {
    return a == voxel->across;
  }
  const float far_a = abs(distance[a]) * s->spacing[a], far_b = abs(distance[b]) * s->spacing[b];
  const float wide_a = s->sourceSize[a] * s->spacing[a], wide_b = s->sourceSize[b] * s->spacing[b];
  return far_a != far_b ? far_a > far_b : wide_a != wide_b ? wide_a > wide_b : s->spacing[a] > s->spacing[b];
}

static void find_ways(const EmissionInfo* s, const lit_voxel* voxel, ways_to_turn* ways)
{
  const int all[6][3] = { { 0, 1, 2 }, { 0, 2, 1 }, { 1, 0, 2 }, { 1, 2, 0 }, { 2, 0, 1 }, { 2, 1, 0 } };
  int distance[3]; // distance of the voxel from the emitting box's centre, half voxels
  ways->count = ways->turned = ways->either = 0;
  for (int a = 0; a < 3; ++a)
  {
    const int place = 2 * voxel->at[a] + (a == voxel->across ? 2 * voxel->up : 1);
    distance[a] = place - 2 * s->sourceFirst[a] - s->sourceSize[a];
    ways->turned |= (distance[a] < 0) << a;
    ways->either |= (distance[a] == 0) << a;
  }
  for (int p = 0; p < 6; ++p)
  {
    const int* order = all[p];
    if (goes_before(s, voxel, distance, order[1], order[0]) || goes_before(s, voxel, distance, order[2], order[1]))
    {
      continue;
    }
    for (int a = 0; a < 3; ++a)
    {
      ways->permutations[ways->count][a] = order[a];
    }
    ++ways->count;
  }
}

// Mean of the light along the rays of the lattice points [from, end), and over all transformations `ways` of the scene.
static void gather_ways(const EmissionInfo* s, const lit_voxel* voxel, const ways_to_turn* ways, int from, int end,
  const __global float* points, const __global float* sigma, const __global float* emission, float* sums)
{
  int count = 0;
  for (int k = 0; k < CHANNELS * 4; ++k)
  {
    sums[k] = 0.0f;
  }
  for (int p = 0; p < ways->count; ++p)
  {
    for (int mask = 0; mask < 8; ++mask)
    {
      if ((mask & ~ways->either) != 0)
      {
        continue;
      }
      turned_scene turned;
      lit_voxel from_here;
      float solid_angles[6], of_way[CHANNELS * 4];
      turn_scene(s, voxel, ways->permutations[p], ways->turned | mask, &turned, &from_here);
      find_sides(&turned, &from_here, solid_angles);
      gather_rays(&turned, &from_here, solid_angles, from, end, points, sigma, emission, of_way);
      for (int c = 0; c < CHANNELS; ++c)
      {
        sums[4 * c] += of_way[4 * c];
        for (int k = 0; k < 3; ++k)
        {
          sums[4 * c + 1 + turned.axis[k]] += turned.sign[k] * of_way[4 * c + 1 + k];
        }
      }
      ++count;
    }
  }
  for (int k = 0; k < CHANNELS * 4; ++k)
  {
    sums[k] /= count;
  }
}

// Whether a voxel is in the emitting box or next to it.
static bool is_close(const EmissionInfo* s, const lit_voxel* voxel)
{
  bool close = true;
  for (int a = 0; a < 3; ++a)
  {
    const int from_first = voxel->at[a] - s->sourceFirst[a];
    close = close && from_first >= -1 && from_first <= s->sourceSize[a];
  }
  return close;
}

// Gathers light in a voxel or through a face with as many rays as the accepted error requires. If the scene has several
// transformations (ways_to_turn), all rays are traced in each of them. Half of the rays in each of two transformations
// would be less accurate than all rays in one.
static void gather(const EmissionInfo* s, lit_voxel* voxel, const __global float* points, const __global float* sigma,
  const __global float* emission, float* sums)
{
  float others[CHANNELS * 4];
  ways_to_turn ways;
  voxel->inside = true;
  for (int a = 0; a < 3; ++a)
  {
    voxel->inside =
      voxel->inside && voxel->at[a] >= s->sourceFirst[a] && voxel->at[a] < s->sourceFirst[a] + s->sourceSize[a];
  }
  find_ways(s, voxel, &ways);
  const int fewest = is_close(s, voxel) ? s->fewestClose : s->fewest;
  gather_ways(s, voxel, &ways, 0, fewest / 2, points, sigma, emission, sums);
  bool even = false;
  for (int count = fewest / 2; count < MOST && !even; count *= 2)
  {
    gather_ways(s, voxel, &ways, count, 2 * count, points, sigma, emission, others);
    float whole = 0.0f, difference = 0.0f;
    for (int k = 0; k < CHANNELS * 4; ++k)
    {
      whole += k % 4 == 0 ? sums[k] + others[k] : 0.0f;
      difference += k % 4 == 0 ? sums[k] - others[k] : 0.0f;
      sums[k] = 0.5f * (sums[k] + others[k]);
    }
    even = fabs(difference) <= s->uneven * whole;
  }
}

// Gathers the light of voxels [first, count), one work-item per voxel.
// path      W length, [channel][voxel]
// flux      W length, [channel][x, y, z][voxel]
// emission  of the emitting box, W / (length^3 sr), [channel][voxel]
// found     above 0: voxels whose light is known from fans of rays (EmissionFans.cl), which are skipped
__kernel void gather_voxels(EmissionInfo s, const __global float* sigma, ulong sigma_first,
  const __global float* points, const __global float* emission, __global float* path, __global float* flux,
  ulong stride, const __global float* found, ulong first, ulong count)
{
  const ulong i = first + get_global_id(0);
  if (i >= count || found[i] > 0.0f)
  {
    return;
  }
  lit_voxel voxel = {
    { (int)(i % s.size[0]), (int)(i / s.size[0] % s.size[1]), (int)(i / ((ulong)s.size[0] * s.size[1])) }, 3, 0, false
  };
  float sums[CHANNELS * 4];
  gather(&s, &voxel, points, sigma + sigma_first, emission, sums);
  const float volume = s.spacing[0] * s.spacing[1] * s.spacing[2];
  for (int c = 0; c < CHANNELS; ++c)
  {
    path[c * stride + i] = sums[4 * c] * volume;
    for (int a = 0; NET_FLUX && a < 3; ++a)
    {
      flux[(3 * c + a) * stride + i] = sums[4 * c + 1 + a] * volume;
    }
  }
}

// Gathers the outgoing flux density through cells [first, count) of a face of the grid, one work-item per cell.
// out         W / length^2, [cell][CHANNELS]
// found       above 0: cells whose light is known from fans of rays (EmissionFans.cl), which are skipped
// face_first  the face's first cell in `out` and `found`
__kernel void gather_face(EmissionInfo s, int axis, int up, const __global float* sigma, ulong sigma_first,
  const __global float* points, const __global float* emission, __global float* out, const __global float* found,
  ulong face_first, ulong first, ulong count)
{
  const ulong i = first + get_global_id(0);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  if (i >= count || found[face_first + i] > 0.0f)
  {
    return;
  }
  lit_voxel voxel = { { 0, 0, 0 }, axis, up, false };
  voxel.at[axis] = up ? s.size[axis] - 1 : 0;
  voxel.at[u] = i % s.size[u];
  voxel.at[v] = i / s.size[u];
  float sums[CHANNELS * 4];
  gather(&s, &voxel, points, sigma + sigma_first, emission, sums);
  for (int c = 0; c < CHANNELS; ++c)
  {
    out[(face_first + i) * CHANNELS + c] = fabs(sums[4 * c + 1 + axis]);
  }
}

// Power that each row of voxels removes, by extinction, from the light gathered in it, W. One work-item per row.
__kernel void take_rows(int row, const __global float* sigma, ulong sigma_first, const __global float* path,
  ulong path_first, __global float* taken)
{
  const ulong i = get_global_id(0);
  float sum = 0.0f;
  for (ulong x = i * row; x < (i + 1) * row; ++x)
  {
    sum += sigma[sigma_first + x] * path[path_first + x];
  }
  taken[i] = sum;
}

// Adds gathered light: values[first + i] += factor * gathered[from + i].
__kernel void add_gathered(
  const __global float* gathered, ulong from, __global float* values, ulong first, float factor)
{
  const ulong i = get_global_id(0);
  values[first + i] += gathered[from + i] * factor;
}

// Copies the light computed by fans of rays (EmissionFans.cl): values[first + i * stride] = factor * brought[i]
__kernel void take_fans(const __global float* brought, __global float* values, ulong first, ulong stride, float factor)
{
  const ulong i = get_global_id(0);
  values[first + i * stride] = factor * brought[i];
}

// Sets the value v at first + i * stride to min(v, factor * found[i]): a voxel counts as lit by fans of rays
// (EmissionFans.cl) only if it is lit by the fans of all channels.
__kernel void take_least(const __global float* found, __global float* values, ulong first, ulong stride, float factor)
{
  const ulong i = get_global_id(0);
  values[first + i * stride] = fmin(values[first + i * stride], factor * found[i]);
}
