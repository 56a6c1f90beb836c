// The light of a small bright part of the medium, gathered along straight rays. Read after Numerics.cl; the host gives
//   CHANNELS  1 or 3 that share sigma_t
//   NET_FLUX  1 where net flux is wanted
//   CELLS     of a side of the tables of escaping light, along an edge

#define OPAQUE 80.0f   // mean free paths that nothing comes through
#define UNEVEN 0.005f  // part by which halves of the rays may differ
#define LINES 4        // an edge of a part's face; half as many where there are many parts

typedef struct
{
  int size[3];
  float spacing[3];
  int source_first[3], source_size[3]; // the box of what shines
  int near_first[3], near_size[3];     // the box whose light is known already
  int first_node[2], nodes[2];         // where few and where many begin in the array of nodes, and how many they are
} emission_scene;

// As many rays as a vector has lanes.
typedef union
{
  real all;
  float lane[REAL_WIDTH];
} rays;

#if REAL_WIDTH == 1
#define any_of(condition) (condition)
#define first_of(value) (value)
#define take(from, index) ((from)[index])
#else
#define any_of(condition) any(condition)
#define first_of(value) ((value).s0)
static inline real take(const __global float* from, integer i)
{
#if REAL_WIDTH == 4
  return (real)(from[i.s0], from[i.s1], from[i.s2], from[i.s3]);
#elif REAL_WIDTH == 8
  return (real)(from[i.s0], from[i.s1], from[i.s2], from[i.s3], from[i.s4], from[i.s5], from[i.s6], from[i.s7]);
#else
  return (real)(from[i.s0], from[i.s1], from[i.s2], from[i.s3], from[i.s4], from[i.s5], from[i.s6], from[i.s7], from[i.s8],
    from[i.s9], from[i.sa], from[i.sb], from[i.sc], from[i.sd], from[i.se], from[i.sf]);
#endif
}
#endif

// Part that is left in the mean over an optical length.
static real mean_left(real tau)
{
  real left;
  const real lost = extinguished(tau, &left);
  return select((real)1.0f, lost / fmax(tau, (real)1e-6f), tau > (real)1e-6f);
}

// Rays from points in `voxel` to nodes in the source's box: what is left of light on the way / its length squared.
//   node, point  in voxels, along x, y, z
//   over_voxel   1: of all that the line has of the voxel, in the mean; 0: at the point
//   sigma        of the grid
//   way          unit vectors, towards the points
//   distance     lengths from node to point
// What is lost in the source's box is not known here.
static real trace(const emission_scene* s, const real* node, const real* point, const int* voxel, int over_voxel,
  const __global float* sigma, real* way, real* distance)
{
  const int strides[3] = { 1, s->size[0], s->size[0] * s->size[1] };
  const int begin = voxel[0] + voxel[1] * strides[1] + voxel[2] * strides[2];
  real rate[3], step[3], next[3];
  integer move[3];
  real squared = 0.0f, enter = 0.0f, behind = 1e30f;
  for (int a = 0; a < 3; ++a)
  {
    way[a] = (point[a] - node[a]) * s->spacing[a];
    squared += way[a] * way[a];
  }
  const real inverse = rsqrt(squared);
  for (int a = 0; a < 3; ++a)
  {
    way[a] *= inverse;
    rate[a] = -way[a] / s->spacing[a];
    const integer up = rate[a] > (real)0.0f;
    step[a] = 1.0f / fmax(fabs(rate[a]), (real)1e-20f);
    const real x = point[a] - voxel[a];
    next[a] = select(x, 1.0f - x, up) * step[a];
    behind = fmin(behind, select(1.0f - x, x, up) * step[a]);
    move[a] = select((integer)-strides[a], (integer)strides[a], up);
    const real low = s->source_first[a] - point[a];
    enter = fmax(enter, select(-low - s->source_size[a], low, up) * step[a]);
  }
  const real ahead = fmin(next[0], fmin(next[1], next[2]));
  *distance = squared * inverse;
  integer index = begin;
  real now = 0.0f, tau = 0.0f;
  integer under_way = now < enter;
  while (any_of(under_way))
  {
    const real end = fmin(fmin(next[0], fmin(next[1], next[2])), enter);
    tau += take(sigma, index) * (end - now);
    for (int a = 0; a < 3; ++a)
    {
      const integer crossed = next[a] <= end && end < enter;
      index += select((integer)0, move[a], crossed);
      next[a] += select((real)0.0f, step[a], crossed);
    }
    now = end;
    under_way = now < enter && tau < (real)OPAQUE;
  }
  real received = inverse * inverse;
  if (over_voxel)
  {
    const float own = sigma[begin];
    tau = fmax(tau - own * ahead, (real)0.0f);
    received *= mean_left(own * (ahead + behind));
  }
  real left;
  extinguished(tau, &left);
  return received * left;
}

#define ESCAPES (6 * (CELLS + 1) * (CELLS + 1)) // of a node

// A node's table: for each way along an axis, tangents along the next and the one after it. Part of the light that gets out of the
// source's box that way, and how far towards it that light's middle is from the part's own.
static float2 escape_of(const __global float2* table, const float* way)
{
  const float x = fabs(way[0]), y = fabs(way[1]), z = fabs(way[2]);
  const int axis = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
  const float scale = 0.5f * CELLS / fabs(way[axis]);
  const float u = way[(axis + 1) % 3] * scale + 0.5f * CELLS;
  const float v = way[(axis + 2) % 3] * scale + 0.5f * CELLS;
  const int i = clamp((int)u, 0, CELLS - 1);
  const int j = clamp((int)v, 0, CELLS - 1);
  const __global float2* at = table + ((2 * axis + (way[axis] > 0.0f)) * (CELLS + 1) + j) * (CELLS + 1) + i;
  return mix(mix(at[0], at[1], u - i), mix(at[CELLS + 1], at[CELLS + 2], u - i), v - j);
}

// What shines on a ray: what of it comes back to the ray's beginning, all; and both times their length from there.
typedef struct
{
  float out, all, out_at, all_at;
} shining_sums;

// A ray through the voxels of the source's box from `from` (voxels of the box) along `rate` (voxels per length), to its border
// or until so far. Returns its optical length.
//   sums  added to; null: not wanted
static float cross_source(const emission_scene* s, const float* from, const float* rate, float until, const __global float* sigma,
  const __global float* grey, shining_sums* sums)
{
  float next[3], step[3], now = 0.0f, tau = 0.0f;
  for (int a = 0; a < 3; ++a)
  {
    step[a] = 1.0f / fmax(fabs(rate[a]), 1e-20f);
    const float border = rate[a] > 0.0f ? floor(from[a] + 1e-4f) + 1.0f - from[a] : from[a] - ceil(from[a] - 1e-4f) + 1.0f;
    next[a] = border * step[a];
    until = fmin(until, (rate[a] > 0.0f ? s->source_size[a] - from[a] : from[a]) * step[a]);
  }
  while (now < until)
  {
    const float end = fmin(fmin(next[0], fmin(next[1], next[2])), until);
    int in_box = 0, in_grid = 0;
    for (int a = 2; a >= 0; --a)
    {
      const int at = clamp((int)floor(from[a] + 0.5f * (now + end) * rate[a]), 0, s->source_size[a] - 1);
      in_box = in_box * s->source_size[a] + at;
      in_grid = in_grid * s->size[a] + at + s->source_first[a];
      next[a] += next[a] <= end ? step[a] : 0.0f;
    }
    const float length = end - now;
    const float through = sigma[in_grid] * length;
    if (sums)
    {
      real left, left_here;
      extinguished(tau, &left);
      const real lost = extinguished(through, &left_here);
      const float shines = grey[in_box] * length;
      const float gets_out = shines * first_of(left) * (through > 1e-6f ? first_of(lost) / through : 1.0f);
      const float where = through < 0.05f ? 0.5f - through / 12.0f : 1.0f / through - first_of(left_here) / first_of(lost);
      sums->out += gets_out;
      sums->all += shines;
      sums->out_at += gets_out * (now + length * where);
      sums->all_at += shines * 0.5f * (now + end);
    }
    tau += through;
    now = end;
  }
  return tau;
}

// Of an even number, by Gauss's rule of two points.
static float line_at(int i, int lines)
{
  return (i / 2 * 2 + (i & 1 ? 1.577350269f : 0.422649731f)) / lines;
}

// Fills in the tables, [node][ESCAPES], from lines through the faces of each part.
//   parts  of nodes: low and high corner, voxels of the box, [node][2]
__kernel void find_escapes(emission_scene s, const __global float* sigma, ulong sigma_first, const __global float* grey,
  const __global float4* parts, __global float2* escapes, ulong first, ulong count)
{
  const ulong i = first + get_global_id(0);
  if (i >= count)
  {
    return;
  }
  sigma += sigma_first;
  const int node = i / ESCAPES;
  const int texel = i % ESCAPES;
  const int lines = node < s.nodes[0] ? LINES : LINES / 2;
  const int side = texel / ((CELLS + 1) * (CELLS + 1));
  const int axis = side / 2;
  float way[3], rate[3], back[3];
  way[axis] = side % 2 ? 1.0f : -1.0f;
  way[(axis + 1) % 3] = texel % (CELLS + 1) * (2.0f / CELLS) - 1.0f;
  way[(axis + 2) % 3] = texel / (CELLS + 1) % (CELLS + 1) * (2.0f / CELLS) - 1.0f;
  const float inverse = rsqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
  for (int a = 0; a < 3; ++a)
  {
    way[a] *= inverse;
    rate[a] = way[a] / s.spacing[a];
    back[a] = -rate[a];
  }
  const float4 lower = parts[2 * node], upper = parts[2 * node + 1];
  const float low[3] = { lower.x, lower.y, lower.z };
  const float size[3] = { upper.x - lower.x, upper.y - lower.y, upper.z - lower.z };
  float out = 0.0f, all = 0.0f, out_at = 0.0f, all_at = 0.0f;
  for (int a = 0; a < 3; ++a)
  {
    const int u = (a + 1) % 3, v = (a + 2) % 3;
    const float area = fabs(rate[a]) * size[u] * size[v];
    for (int k = 0; k < lines * lines && area > 0.0f; ++k)
    {
      float from[3];
      from[a] = low[a] + (way[a] > 0.0f ? size[a] : 0.0f);
      from[u] = low[u] + line_at(k % lines, lines) * size[u];
      from[v] = low[v] + line_at(k / lines, lines) * size[v];
      float until = 1e30f;
      for (int b = 0; b < 3; ++b)
      {
        until = fmin(until, (way[b] > 0.0f ? from[b] - low[b] : low[b] + size[b] - from[b]) / fmax(fabs(rate[b]), 1e-20f));
      }
      shining_sums sums = { 0.0f, 0.0f, 0.0f, 0.0f };
      real left;
      extinguished(cross_source(&s, from, rate, 1e30f, sigma, grey, 0), &left);
      cross_source(&s, from, back, until, sigma, grey, &sums);
      out += area * first_of(left) * sums.out;
      all += area * sums.all;
      // Positions along the way, from the middle of the box on.
      float start = 0.0f;
      for (int b = 0; b < 3; ++b)
      {
        start += (from[b] - 0.5f * s.source_size[b]) * s.spacing[b] * way[b];
      }
      out_at += area * first_of(left) * (start * sums.out - sums.out_at);
      all_at += area * (start * sums.all - sums.all_at);
    }
  }
  escapes[i] = out > 0.0f ? (float2)(out / all, out_at / out - all_at / all) : (float2)(0.0f);
}

// Every node of a rule to its place in the voxel: Gauss's 2 x 2 x 2 points in turn.
//   across  axis of the face that the places are on, 3: in the voxel
//   sums    [channel][fluence, net flux along x, y, z]
// Returns by how much two halves of the nodes differ, to their sum.
static float gather(const emission_scene* s, const int* voxel, int rule, int across, const __global float* sigma,
  const __global float2* escapes, const __global float4* nodes, const __global float* powers, float* sums)
{
  const int end = s->first_node[rule] + s->nodes[rule];
  const float thickness = sigma[(voxel[2] * s->size[1] + voxel[1]) * s->size[0] + voxel[0]] *
    fmax(s->spacing[0], fmax(s->spacing[1], s->spacing[2]));
  float whole = 0.0f, difference = 0.0f;
  for (int i = 0; i < CHANNELS * 4; ++i)
  {
    sums[i] = 0.0f;
  }
  for (int first = s->first_node[rule]; first < end; first += REAL_WIDTH)
  {
    rays node[3], point[3], way[3], light, distance;
    for (int l = 0; l < REAL_WIDTH; ++l)
    {
      const float4 at = nodes[min(first + l, end - 1)];
      const int code = (int)at.w;
      node[0].lane[l] = at.x;
      node[1].lane[l] = at.y;
      node[2].lane[l] = at.z;
      for (int a = 0; a < 3; ++a)
      {
        const float place = code >> a & 1 ? 0.788675135f : 0.211324865f;
        point[a].lane[l] = voxel[a] + (a != across ? place : voxel[a] > 0 ? 1.0f : 0.0f);
      }
    }
    real unit[3];
    const real from[3] = { node[0].all, node[1].all, node[2].all };
    const real to[3] = { point[0].all, point[1].all, point[2].all };
    light.all = trace(s, from, to, voxel, across > 2 && thickness > 1.0f, sigma, unit, &distance.all);
    for (int a = 0; a < 3; ++a)
    {
      way[a].all = unit[a];
    }
    for (int l = 0; l < REAL_WIDTH && first + l < end; ++l)
    {
      const int code = (int)nodes[first + l].w;
      const float towards[3] = { way[0].lane[l], way[1].lane[l], way[2].lane[l] };
      const float2 escape = escape_of(escapes + (first + l) * ESCAPES, towards);
      const float nearer = 1.0f + escape.y / fmax(distance.lane[l] - escape.y, 0.5f * distance.lane[l]);
      const float amount = light.lane[l] * escape.x * nearer * nearer;
      for (int c = 0; c < CHANNELS; ++c)
      {
        const float power = amount * powers[(first + l) * CHANNELS + c];
        whole += light.lane[l] * powers[(first + l) * CHANNELS + c];
        difference += (code & 8 ? light.lane[l] : -light.lane[l]) * powers[(first + l) * CHANNELS + c];
        sums[4 * c] += power;
        for (int a = 0; a < 3; ++a)
        {
          sums[4 * c + 1 + a] += power * towards[a];
        }
      }
    }
  }
  return whole > 0.0f ? fabs(difference) / whole : 0.0f;
}

// With as many nodes as it takes.
static void gather_enough(const emission_scene* s, const int* voxel, int across, const __global float* sigma,
  const __global float2* escapes, const __global float4* nodes, const __global float* powers, float* sums)
{
  if (gather(s, voxel, 0, across, sigma, escapes, nodes, powers, sums) > UNEVEN)
  {
    gather(s, voxel, 1, across, sigma, escapes, nodes, powers, sums);
  }
}

static bool is_near(const emission_scene* s, const int* voxel)
{
  bool inside = true;
  for (int a = 0; a < 3; ++a)
  {
    inside = inside && voxel[a] >= s->near_first[a] && voxel[a] < s->near_first[a] + s->near_size[a];
  }
  return inside;
}

// path    W length, [channel][stride]
// flux    W length, [channel][x, y, z][stride]
// nodes   x, y, z in voxels; bits: where it shines in a voxel, which half it is of, which table is its own
// powers  W / (4 pi) of the nodes, [node][CHANNELS]
__kernel void gather_voxels(emission_scene s, const __global float* sigma, ulong sigma_first, const __global float2* escapes,
  const __global float4* nodes, const __global float* powers, __global float* path, __global float* flux, ulong stride, ulong first,
  ulong count)
{
  const ulong i = first + get_global_id(0);
  const int voxel[3] = { (int)(i % s.size[0]), (int)(i / s.size[0] % s.size[1]), (int)(i / ((ulong)s.size[0] * s.size[1])) };
  if (i >= count || is_near(&s, voxel))
  {
    return;
  }
  float sums[CHANNELS * 4];
  gather_enough(&s, voxel, 3, sigma + sigma_first, escapes, nodes, powers, sums);
  const float volume = s.spacing[0] * s.spacing[1] * s.spacing[2];
  for (int c = 0; c < CHANNELS; ++c)
  {
    path[c * stride + i] = sums[4 * c] * volume;
#if NET_FLUX
    for (int a = 0; a < 3; ++a)
    {
      flux[(3 * c + a) * stride + i] = sums[4 * c + 1 + a] * volume;
    }
#endif
  }
}

// What goes out through cell i of a face of the grid, [cell][CHANNELS], W.
__kernel void gather_face(emission_scene s, int axis, int up, const __global float* sigma, ulong sigma_first,
  const __global float2* escapes, const __global float4* nodes, const __global float* powers, __global float* out, ulong first,
  ulong count)
{
  const ulong i = first + get_global_id(0);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  if (i >= count)
  {
    return;
  }
  int voxel[3];
  voxel[axis] = up ? s.size[axis] - 1 : 0;
  voxel[u] = i % s.size[u];
  voxel[v] = i / s.size[u];
  float sums[CHANNELS * 4] = { 0.0f };
  if (!is_near(&s, voxel))
  {
    gather_enough(&s, voxel, axis, sigma + sigma_first, escapes, nodes, powers, sums);
  }
  for (int c = 0; c < CHANNELS; ++c)
  {
    out[i * CHANNELS + c] = fabs(sums[4 * c + 1 + axis]) * s.spacing[u] * s.spacing[v];
  }
}

// near_values[i] = values[first + voxel i of the box]
static ulong index_near(const emission_scene* s, ulong i)
{
  const ulong x = s->near_first[0] + i % s->near_size[0];
  const ulong y = s->near_first[1] + i / s->near_size[0] % s->near_size[1];
  const ulong z = s->near_first[2] + i / ((ulong)s->near_size[0] * s->near_size[1]);
  return (z * s->size[1] + y) * s->size[0] + x;
}

__kernel void take_near(emission_scene s, const __global float* values, ulong first, __global float* near_values)
{
  const ulong i = get_global_id(0);
  near_values[i] = values[first + index_near(&s, i)];
}

// Array k of the box, `near_stride` long, is added to the one at first + k * stride.
__kernel void add_near(emission_scene s, const __global float* near_values, ulong near_stride, __global float* values,
  ulong first, ulong stride)
{
  const ulong i = get_global_id(0);
  const ulong k = get_global_id(1);
  values[first + k * stride + index_near(&s, i)] += near_values[k * near_stride + i];
}

// W that a row of voxels takes from the light gathered in it.
__kernel void take_rows(int row, const __global float* sigma, ulong sigma_first, const __global float* path, ulong path_first,
  __global float* taken)
{
  const ulong i = get_global_id(0);
  float sum = 0.0f;
  for (ulong x = i * row; x < (i + 1) * row; ++x)
  {
    sum += sigma[sigma_first + x] * path[path_first + x];
  }
  taken[i] = sum;
}

// values[first + i] += factor * gathered[from + i]
__kernel void add_gathered(const __global float* gathered, ulong from, __global float* values, ulong first, float factor)
{
  const ulong i = get_global_id(0);
  values[first + i] += gathered[from + i] * factor;
}
