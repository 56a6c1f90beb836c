// Beams from the surface of a box in which a small bright part of the medium lies. Read after Numerics.cl, FixedPoint.cl and
// LampBeams.cl, whose pyramids and cross-sections these are; the host gives
//   ATOMICS   1 where the device has 64-bit atomics, else one work-item does all
//   NET_FLUX  1 where net flux is wanted
//
// Each face of the box is cut into patches. From a point of each go beams into the half space before it, with the light that the
// patch sends that way: what the box emits on the way to it and does not absorb, in the mean over the patch.

#define EMISSION_SUMS 11 // of a row
#define NEAR_STEPS 4     // a layer, where a beam's cross-section grows fast
#define NEAR_LAYERS 8.0f

// Voxels of a box within the grid, on periodic axes across its border.
typedef struct
{
  int first[3];
  int size[3];
} voxel_box;

// Part of a face of the box.
typedef struct
{
  int axis, up;       // the face
  float low[2];       // of its corner along axes axis + 1, axis + 2, voxels
  float size[2];
  int samples;        // of its radiance, along each edge
  int number;
} face_patch;

// Beams are followed from `inner` on, where their light is known already, to the border of `outer`.
typedef struct
{
  voxel_box source, inner, outer;
  float focus; // length from a patch at which its radiance is looked at
} emission_region;

typedef struct
{
  float lost_inner, escaped_inner, handed_on, escaped[6], stranded;
} emission_tally;

static ulong wrapped_index(const int* size, const int* voxel)
{
  int at[3];
  for (int a = 0; a < 3; ++a)
  {
    at[a] = (voxel[a] % size[a] + size[a]) % size[a];
  }
  return ((ulong)at[2] * size[1] + at[1]) * size[0] + at[0];
}

// Radiance that leaves the box of the source at `from` (voxels, on its surface) along `way` (voxels per length): what is met
// on the way back.
//   emission  [voxel of the box], parts of the power / (length^3 sr)
static float radiance_from(const lamp_info* lamp, const voxel_box* source, const float* from, const float* way,
  const __global float* sigma, const __global float* emission)
{
  int voxel[3];
  float next[3], step[3]; // lengths to the next voxel's border, and from there to the one after it
  for (int a = 0; a < 3; ++a)
  {
    const float w = -way[a];
    const float x = from[a] - source->first[a];
    voxel[a] = clamp((int)(w > 0.0f ? floor(x) : ceil(x) - 1.0f), 0, source->size[a] - 1);
    step[a] = w != 0.0f ? 1.0f / fabs(w) : 1e30f;
    next[a] = w != 0.0f ? fmax((w > 0.0f ? voxel[a] + 1 - x : x - voxel[a]) * step[a], 0.0f) : 1e30f;
  }
  float now = 0.0f, left = 1.0f, radiance = 0.0f;
  while (true)
  {
    const int a = next[0] <= next[1] ? (next[0] <= next[2] ? 0 : 2) : (next[1] <= next[2] ? 1 : 2);
    const int in_grid[3] = { source->first[0] + voxel[0], source->first[1] + voxel[1], source->first[2] + voxel[2] };
    const float sigma_t = sigma[wrapped_index(lamp->size, in_grid)];
    const float length = next[a] - now;
    float through;
    const float lost = extinguished(sigma_t * length, &through);
    const float mean_length = sigma_t * length > 1e-20f ? lost / sigma_t : length;
    radiance += left * mean_length * emission[(voxel[2] * source->size[1] + voxel[1]) * source->size[0] + voxel[0]];
    left *= through;
    now = next[a];
    next[a] += step[a];
    voxel[a] += way[a] > 0.0f ? -1 : 1;
    if (voxel[a] < 0 || voxel[a] >= source->size[a])
    {
      return radiance;
    }
  }
}

// In the mean over the patch, of what goes to where the beam is `focus` lengths from the patch's point: the edges of the box
// make radiance change fast with position and direction, and mostly with both.
//   way    unit vector
//   shift  of the samples, in [0, 1)
static float radiance_of(const lamp_info* lamp, const voxel_box* source, const face_patch* patch, const float* way,
  float focus, float2 shift, const __global float* sigma, const __global float* emission)
{
  float from[3], ray[3];
  float sum = 0.0f;
  const int n = patch->samples;
  from[patch->axis] = source->first[patch->axis] + (patch->up ? source->size[patch->axis] : 0);
  for (int i = 0; i < n * n; ++i)
  {
    from[(patch->axis + 1) % 3] = patch->low[0] + patch->size[0] * (i % n + shift.x) / n;
    from[(patch->axis + 2) % 3] = patch->low[1] + patch->size[1] * (i / n + shift.y) / n;
    float squared = 0.0f;
    for (int a = 0; a < 3; ++a)
    {
      ray[a] = way[a] * focus + (lamp->position[a] - from[a]) * lamp->spacing[a];
      squared += ray[a] * ray[a];
    }
    for (int a = 0; a < 3; ++a)
    {
      ray[a] *= rsqrt(squared) / lamp->spacing[a];
    }
    sum += radiance_from(lamp, source, from, ray, sigma, emission);
  }
  return sum / (n * n);
}

// What a beam needs to know of an axis across its march.
typedef struct
{
  int size, stride, periodic;
  int inner_first, inner_size, outer_first, outer_size;
  float position, tangent, width; // width in tangents
} beam_axis;

static beam_axis axis_of(const lamp_info* lamp, const emission_region* region, int axis, int stride, float tangent, float width)
{
  const beam_axis along = { lamp->size[axis], stride, lamp->periodic[axis], region->inner.first[axis], region->inner.size[axis],
    region->outer.first[axis], region->outer.size[axis], lamp->position[axis], tangent, width };
  return along;
}

// Two neighbouring voxels along an axis, as a beam that is at most one wide lies over them.
typedef struct
{
  float part[2];   // of the beam's width
  int offset[2];   // in the arrays
  int outside[2];  // INSIDE, BEFORE or AFTER
  bool inner[2], outer[2];
} voxel_pair;

static inline void find_pair(const beam_axis* along, float t, voxel_pair* pair)
{
  const float width = clamp(along->width * t, 1e-4f, 1.0f);
  int lowest;
  overlap(along->position + along->tangent * t - 0.5f * width, width, &lowest, &pair->part[0]);
  pair->part[1] = 1.0f - pair->part[0];
  const int n = along->size;
#pragma unroll
  for (int k = 0; k < 2; ++k)
  {
    const int voxel = lowest + k;
    const int in = clamp(voxel, 0, n - 1);
    const int at = along->periodic ? voxel : in;
    pair->inner[k] = (uint)(at - along->inner_first) < (uint)along->inner_size;
    pair->outer[k] = (uint)(at - along->outer_first) < (uint)along->outer_size;
    pair->outside[k] = in == voxel || along->periodic ? INSIDE : (voxel < 0) == (along->tangent < 0.0f) ? AFTER : BEFORE;
    pair->offset[k] = (in == voxel || !along->periodic ? in : (voxel % n + n) % n) * along->stride;
  }
}

// A beam's place in a layer.
typedef struct
{
  int layer;         // offset in the arrays
  bool inner, outer; // of the layer
  float length;      // through it
  float3 way;        // unit vector
} beam_step;

// One step of a beam, as step_beam. What it loses in the inner box is only counted.
//   deposit  path, then net flux along x, y, z, each `stride` units long
// Changes `left`, and `left_inner`: the part of it that is still in the inner box.
static inline void step_emission(float scale, const beam_step* step, const voxel_pair* u, const voxel_pair* v, int face_u, int face_v,
  const __global float* sigma, __global long* deposit, ulong stride, float* left, float* left_inner, emission_tally* tally)
{
  float after = 0.0f, after_inner = 0.0f;
  for (int q = 0; q < 4; ++q)
  {
    const int i = q & 1;
    const int j = q >> 1;
    const float power = *left * u->part[i] * v->part[j];
    if (power <= 0.0f)
    {
      continue;
    }
    const bool inner = step->inner && u->inner[i] && v->inner[j];
    if (u->outside[i] != INSIDE || v->outside[j] != INSIDE)
    {
      if (u->outside[i] != AFTER && v->outside[j] != AFTER)
      {
        after += power; // beside the box, with a beam that goes into it
      }
      else if (inner)
      {
        tally->escaped_inner += power;
      }
      else
      {
        tally->escaped[u->outside[i] == AFTER ? face_u : face_v] += power;
      }
      continue;
    }
    if (!(step->outer && u->outer[i] && v->outer[j]))
    {
      tally->handed_on += power;
      continue;
    }
    const ulong index = (ulong)step->layer + u->offset[i] + v->offset[j];
    float through;
    const float tau = sigma[index] * step->length;
    const float lost = extinguished(tau, &through);
    const float stays = lost < 0.5f ? power - power * lost : power * through;
    after += stays;
    if (inner)
    {
      tally->lost_inner += power * lost;
      after_inner += stays;
      continue;
    }
    const float mean_length = tau > 1e-20f ? lost / sigma[index] : step->length;
    const float amount = power * mean_length * scale;
    add_units(deposit + index, convert_long_sat_rte(amount));
#if NET_FLUX
    add_units(deposit + stride + index, convert_long_sat_rte(amount * step->way.x));
    add_units(deposit + 2 * stride + index, convert_long_sat_rte(amount * step->way.y));
    add_units(deposit + 3 * stride + index, convert_long_sat_rte(amount * step->way.z));
#endif
  }
  *left = after;
  *left_inner = after_inner;
}

// Layers that a beam crosses: to the border of the grid or of the outer box, whichever is nearer.
static int layers_of(const lamp_info* lamp, const emission_region* region, const beam_row* row, int first)
{
  const int n = lamp->size[row->axis];
  const int to_grid = row->up ? n - first : first + 1;
  const int border = region->outer.first[row->axis] + (row->up ? region->outer.size[row->axis] : 0);
  const int to_outer = row->up ? border - first : first - border + 1;
  return min(lamp->periodic[row->axis] ? to_grid + n * lamp->rounds : to_grid, to_outer);
}

// One beam from its point to where it leaves the box.
static void follow_emission_beam(const lamp_info* lamp, const emission_region* region, const beam_row* row, float2 tangent,
  float power, const __global float* sigma, __global long* deposit, ulong stride, emission_tally* tally)
{
  const int u = (row->axis + 1) % 3;
  const int v = (row->axis + 2) % 3;
  float along[3];
  along[row->axis] = row->up ? lamp->spacing[row->axis] : -lamp->spacing[row->axis];
  along[u] = tangent.x * lamp->spacing[u];
  along[v] = tangent.y * lamp->spacing[v];
  const float3 span = (float3)(along[0], along[1], along[2]);
  const float per_layer = sqrt(dot(span, span));
  const float start = lamp->position[row->axis];
  const int first = (int)(row->up ? floor(start) : ceil(start) - 1.0f);
  const int all = layers_of(lamp, region, row, first);
  const int last = row->up ? first + all : first - all; // the layer after
  const int strides[3] = { 1, lamp->size[0], lamp->size[0] * lamp->size[1] };
  const int stride_p = strides[row->axis];
  const beam_axis axis_u = axis_of(lamp, region, u, strides[u], tangent.x, row->widthU);
  const beam_axis axis_v = axis_of(lamp, region, v, strides[v], tangent.y, row->widthV);
  voxel_pair pair_u, pair_v;
  beam_step step;
  step.way = span / per_layer;
  float left = power, left_inner = power;
  float now = 0.0f;
  for (int k = 0; k < all && left > 0.0f; ++k)
  {
    const int depth = row->up ? first + k : first - k;
    const int n = lamp->size[row->axis];
    step.layer = (lamp->periodic[row->axis] ? (depth % n + n) % n : depth) * stride_p;
    step.inner = depth >= region->inner.first[row->axis] &&
      depth < region->inner.first[row->axis] + region->inner.size[row->axis];
    step.outer = true; // or the march would be over
    const float end = row->up ? depth + 1 - start : start - depth;
    const int steps = now < NEAR_LAYERS && left_inner < left ? NEAR_STEPS : STEPS;
    for (int s = 0; s < steps; ++s)
    {
      const float t0 = now + (end - now) * s / steps;
      const float t1 = now + (end - now) * (s + 1) / steps;
      const float t = 0.5f * (t0 + t1);
      find_pair(&axis_u, t, &pair_u);
      find_pair(&axis_v, t, &pair_v);
      step.length = (t1 - t0) * per_layer;
      step_emission(lamp->scale, &step, &pair_u, &pair_v, 2 * u + (tangent.x > 0.0f), 2 * v + (tangent.y > 0.0f), sigma,
        deposit, stride, &left, &left_inner, tally);
    }
    now = end;
  }
  if (!lamp->periodic[row->axis] && (last < 0 || last >= lamp->size[row->axis]))
  {
    tally->escaped_inner += left_inner;
    tally->escaped[2 * row->axis + row->up] += left - left_inner;
  }
  else if (last < region->outer.first[row->axis] ||
    last >= region->outer.first[row->axis] + region->outer.size[row->axis])
  {
    tally->handed_on += left;
  }
  else
  {
    tally->stranded += left;
  }
}

// deposit  parts of the power times length, in fixed point, [path or path, flux along x, y, z][stride], added to
// sums     [row][lost in the inner box, escaped from it, handed on at the outer box's border, escaped through -x to +z, stranded,
//          shone], parts of the power
__kernel void follow_emission(lamp_info lamp, emission_region region, face_patch patch, const __global float* sigma,
  ulong sigma_first, const __global float* emission, __global long* deposit, ulong stride, const __global beam_row* rows,
  int row_count, int first_row, __global float* sums)
{
  sigma += sigma_first;
#if ATOMICS
  const int r = first_row + get_global_id(0);
#else
  for (int r = first_row; r < first_row + row_count; ++r)
#endif
  {
    const beam_row row = rows[r];
    const int u = (row.axis + 1) % 3;
    const int v = (row.axis + 2) % 3;
    const float hu = lamp.spacing[u], hv = lamp.spacing[v], hp = lamp.spacing[row.axis];
    emission_tally tally = { 0.0f, 0.0f, 0.0f, { 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f }, 0.0f };
    float shone = 0.0f;
    for (int i = 0; i < row.count; ++i)
    {
      const float2 tangent = (float2)(row.tangentU + i * row.widthU, row.tangentV);
      const float2 half_width = 0.5f * (float2)(row.widthU, row.widthV);
      const float per_length = rsqrt(hp * hp + tangent.x * tangent.x * hu * hu + tangent.y * tangent.y * hv * hv);
      float way[3];
      way[row.axis] = row.up ? hp * per_length : -hp * per_length;
      way[u] = tangent.x * hu * per_length;
      way[v] = tangent.y * hv * per_length;
      const float cosine = patch.up ? way[patch.axis] : -way[patch.axis];
      if (cosine <= 0.0f)
      {
        continue;
      }
      // Neighbouring beams, and patches, sample elsewhere: square roots of primes make an even lattice.
      const float2 far_on = patch.number * (float2)(0.7548777f, 0.5698403f) + i * (float2)(0.4142136f, 0.7320508f) +
        r * (float2)(0.2360680f, 0.6457513f);
      const float2 shift = far_on - floor(far_on);
      const float power = lamp.intensity * cosine * radiance_of(&lamp, &region.source, &patch, way, region.focus, shift, sigma, emission) *
        solid_angle((tangent.x - half_width.x) * hu, (tangent.x + half_width.x) * hu, (tangent.y - half_width.y) * hv,
          (tangent.y + half_width.y) * hv, hp);
      shone += power;
      follow_emission_beam(&lamp, &region, &row, tangent, power, sigma, deposit, stride, &tally);
    }
    __global float* sum = sums + r * EMISSION_SUMS;
    sum[0] = tally.lost_inner;
    sum[1] = tally.escaped_inner;
    sum[2] = tally.handed_on;
    for (int face = 0; face < 6; ++face)
    {
      sum[3 + face] = tally.escaped[face];
    }
    sum[9] = tally.stranded;
    sum[10] = shone;
  }
}

static ulong index_near(voxel_box near, int4 size, ulong i)
{
  const int all[3] = { size.x, size.y, size.z };
  const int voxel[3] = { near.first[0] + (int)(i % near.size[0]), near.first[1] + (int)(i / near.size[0] % near.size[1]),
    near.first[2] + (int)(i / ((ulong)near.size[0] * near.size[1])) };
  return wrapped_index(all, voxel);
}

// near_values[i] = values[first + voxel i of the box]
__kernel void take_near(
  voxel_box near_box, int4 size, const __global float* values, ulong first, __global float* near_values)
{
  const ulong i = get_global_id(0);
  near_values[i] = values[first + index_near(near_box, size, i)];
}

// Array k of the box, `near_stride` long, is added to the one at first + k * stride.
__kernel void add_near(voxel_box near_box, int4 size, const __global float* near_values, ulong near_stride,
  __global float* values, ulong first, ulong stride)
{
  const ulong i = get_global_id(0);
  const ulong k = get_global_id(1);
  values[first + k * stride + index_near(near_box, size, i)] += near_values[k * near_stride + i];
}

// values[first + i] += unit times the fixed point number at deposit[from + i]
__kernel void add_emission(
  const __global long* deposit, ulong from, __global float* values, ulong first, float unit)
{
  const ulong i = get_global_id(0);
  values[first + i] += (float)deposit[from + i] * unit;
}
