// Rays through a range of planes, on a CPU: a work-item carries all the rays of its unit (one way along the axis, some or all
// bundles) and deposits into the volume itself. Units of one launch never share a plane, so nothing is lost and sums have one
// order. Read after SweepLayout.cl and one SweepBundle.cl for each number of MEMBERS
// that occurs (1, 2, 4, 8), with MEMBERS_1, ... defined.

typedef struct
{
  int backward; // 0 marches from the lower end of the axis, 1 from the upper
  int firstBundle, bundles;
  int scratch;  // where its scratch begins, in floats
} unit_info;

// How a plane lies in the volume: voxel (u, v) of plane p is u * stepU + v * stepV + p * stepP.
typedef struct
{
  int sizeU, sizeV, sizeP;
  int stepU, stepV, stepP;
  int width;
  int block;    // planes packed together: 1 where rows are contiguous in memory, else a vector's worth
  float vacuum; // 1/length, so thin that no float notices
} plane_layout;

static void zero(__global float* values, int count)
{
  for (int i = 0; i < count; i += REAL_WIDTH)
  {
    store_real((real)0.0f, i, values + 0);
  }
}

// Copy planes [first, first + count) of the volume into scratch, rows padded by vacuum; clear what is to be summed up.
static void pack(const plane_layout* layout, __global float* planes, int first, int count, const __global float* sigma,
  const __global float* source, ulong stride)
{
  const int rows = layout->sizeV * ROW;
  for (int j = 0; j < count; ++j)
  {
    zero(planes + j * PLANES * rows, PLANES * rows);
  }
  for (int v = 0; v < layout->sizeV; ++v)
  {
    for (int u = 0; u < layout->sizeU; ++u)
    {
      const ulong voxel = (ulong)u * layout->stepU + (ulong)v * layout->stepV + (ulong)first * layout->stepP;
      __global float* to = planes + v * ROW + u;
      for (int j = 0; j < count; ++j)
      {
        to[j * PLANES * rows] = sigma[voxel + (ulong)j * layout->stepP];
#if SOURCE
        for (int c = 0; c < CHANNELS; ++c)
        {
          to[(j * PLANES + PLANE_SOURCE + c) * rows] = source[c * stride + voxel + (ulong)j * layout->stepP];
        }
#endif
      }
    }
  }
  for (int j = 0; j < count; ++j)
  {
    __global float* plane = planes + j * PLANES * rows;
    for (int v = 0; v < layout->sizeV; ++v)
    {
      for (int x = 0; x < layout->width; x += REAL_WIDTH)
      {
        const int at = v * ROW + x;
        // Vacuum is a very thin medium: 0 / 0 never happens.
        const real s = fmax(load_real(at, plane + PLANE_SIGMA * rows), (real)layout->vacuum);
        store_real(s, at, plane + PLANE_SIGMA * rows);
        store_real((real)1.0f / s, at, plane + PLANE_INVERSE * rows);
      }
    }
  }
}

// Add what the planes gathered to the volume. The medium's own light on the way through the voxel where it starts was left
// out until here: per unit of source it is sum of power (l - p1) / sigma = (lengths.x - taken) / sigma, by series where that
// would cancel. lengths: sums over all segments of power times l, l^2 / 2, l^3 / 6, l^4 / 24.
static void unpack(const plane_layout* layout, __global float* planes, int first, int count, __global float* path,
  __global float* flux, ulong stride, const __global float4* lengths, int backward, int axis)
{
  const int rows = layout->sizeV * ROW;
#if SOURCE
  for (int j = 0; j < count; ++j)
  {
    __global float* plane = planes + j * PLANES * rows;
    const float4 l = lengths[backward ? count - 1 - j : j];
    for (int at = 0; at < rows; at += REAL_WIDTH)
    {
      const real sigma = load_real(at, plane + PLANE_SIGMA * rows);
      const real closed = (l.x - load_real(at, plane + PLANE_TAKEN * rows)) * load_real(at, plane + PLANE_INVERSE * rows);
      const real series = mad(mad((real)l.w, sigma, (real)-l.z), sigma, (real)l.y);
      const real own = select(closed, series, sigma * l.y < 0.01f * l.x);
      for (int c = 0; c < CHANNELS; ++c)
      {
        __global float* sum = plane + (PLANE_PATH + c) * rows;
        store_real(mad(own, load_real(at, plane + (PLANE_SOURCE + c) * rows), load_real(at, sum)), at, sum);
      }
    }
  }
#endif
  for (int v = 0; v < layout->sizeV; ++v)
  {
    for (int u = 0; u < layout->sizeU; ++u)
    {
      const ulong voxel = (ulong)u * layout->stepU + (ulong)v * layout->stepV + (ulong)first * layout->stepP;
      const __global float* from = planes + v * ROW + u;
      for (int j = 0; j < count; ++j)
      {
        const ulong to = voxel + (ulong)j * layout->stepP;
        for (int c = 0; c < CHANNELS; ++c)
        {
          path[c * stride + to] += from[(j * PLANES + PLANE_PATH + c) * rows];
#if NET_FLUX
          const int u_axis = axis == 0 ? 1 : 0;
          const int v_axis = axis == 2 ? 1 : 2;
          const __global float* fluxes = from + (j * PLANES + PLANE_FLUX + 3 * c) * rows;
          flux[(3 * c + u_axis) * stride + to] += fluxes[0];
          flux[(3 * c + v_axis) * stride + to] += fluxes[rows];
          flux[(3 * c + axis) * stride + to] += backward ? -fluxes[2 * rows] : fluxes[2 * rows];
#endif
        }
      }
    }
  }
}

static void cross_plane(sweep_state* state, __global float* maps, const __global float* outside,
  const __global float* radiance, const __global bundle_info* bundle, const __global crossing_info* crossing)
{
  __global float* map = maps + bundle->map;
  const __global float* rows = outside + bundle->outside;
  const __global float* values = radiance + bundle->border;
  switch (bundle->members)
  {
#ifdef MEMBERS_1
    case 1: cross_plane_1(state, map, rows, values, bundle, crossing); break;
#endif
#ifdef MEMBERS_2
    case 2: cross_plane_2(state, map, rows, values, bundle, crossing); break;
#endif
#ifdef MEMBERS_4
    case 4: cross_plane_4(state, map, rows, values, bundle, crossing); break;
#endif
#ifdef MEMBERS_8
    case 8: cross_plane_8(state, map, rows, values, bundle, crossing); break;
#endif
  }
}

// sigma     1/length, [voxel] from sigma_first on
// source    W / (length^3 sr), [channel][stride] from `first` on
// path      W length, [channel][stride] from `first` on, added to
// flux      W length, [channel][x, y, z][stride] from 3 `first` on, added to
// maps      rays of both ways; `maps_each_way` floats each
// outside, radiance   rays that come in, both ways as maps
// crossings [plane from where rays start][bundle]
// lengths   [unit][plane from where rays start], see unpack
// schedule  [launch][unit] first plane and end, counted from where rays start; beyond the last plane the axis begins anew
// tally     [plane from where rays start][unit][-u, +u, -v, +v][channel] W that left
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void sweep(const __global float* sigma,
  ulong sigma_first, const __global float* source, __global float* path, __global float* flux, ulong first_value,
  ulong stride, __global float* maps, ulong maps_each_way, const __global float* outside, uint outside_each_way, const __global float* radiance, uint radiance_each_way,
  __global float* scratch, const __global unit_info* units, const __global bundle_info* bundles, int bundle_count,
  const __global crossing_info* crossings, const __global float4* lengths, int planes_of_pattern, const __global int2* schedule, int launch,
  __global float* tally, plane_layout layout, int axis)
{
  const int u = get_global_id(0);
  const int unit_count = get_global_size(0);
  const unit_info unit = units[u];
  const int2 range = schedule[launch * unit_count + u];
  const int rows = layout.sizeV * ROW;

  sweep_state state;
  state.sizeU = layout.sizeU;
  state.sizeV = layout.sizeV;
  state.width = layout.width;
  state.ring = scratch + unit.scratch;
  __global float* planes = state.ring + 2 * RING_ROWS * MAX_MEMBERS * CHANNELS * ROW + PAD; // past the last row's border
  sigma += sigma_first;
  source += first_value;
  path += first_value;
  flux += 3 * first_value;
  maps += unit.backward * maps_each_way;
  outside += unit.backward * outside_each_way;
  radiance += unit.backward * radiance_each_way;

  for (int begin = range.x, count; begin < range.y; begin += count)
  {
    const int lap = begin / layout.sizeP * layout.sizeP; // planes already marched when the axis began anew
    count = min(min(layout.block, range.y - begin), lap + layout.sizeP - begin);
    const int first = unit.backward ? layout.sizeP - (begin - lap) - count : begin - lap;
    pack(&layout, planes, first, count, sigma, source, stride);
    for (int k = begin; k < begin + count; ++k)
    {
      const int plane = unit.backward ? layout.sizeP - 1 - (k - lap) : k - lap;
      state.planes = planes + (plane - first) * PLANES * rows;
      for (int side = 0; side < 4; ++side)
      {
        for (int c = 0; c < CHANNELS; ++c)
        {
          state.escaped[side][c] = 0.0f;
          state.rounding[side][c] = 0.0f;
        }
      }
      for (int b = unit.firstBundle; b < unit.firstBundle + unit.bundles; ++b)
      {
        cross_plane(&state, maps, outside, radiance, bundles + b, crossings + k * bundle_count + b);
      }
      for (int side = 0; side < 4; ++side)
      {
        for (int c = 0; c < CHANNELS; ++c)
        {
          tally[((k * unit_count + u) * 4 + side) * CHANNELS + c] = state.escaped[side][c];
        }
      }
    }
    unpack(&layout, planes, first, count, path, flux, stride, lengths + u * planes_of_pattern + begin, unit.backward, axis);
  }
}
