// Propagation as published (Gruson et al. 2012, Algorithm 2, first half): all rays of a direction cross the grid plane
// by plane, one ray per voxel, and write their deposits to the buffer T of that direction. The host defines
//   CHANNELS  1 or 3
//   COLOURED  1 if sigma has CHANNELS channels, 0 if all share one
//   SOURCE    1 if U is not zero
//
// The paper synchronises the rays of a work-group by __syncthreads. Here all rays of all directions cross one voxel per
// launch, and the sequence of launches synchronises them. Rays are stored by the voxel they are in: a ray map is [row
// -1 .. size_v][PAD | column 0 .. size_u - 1 | PAD], with a border for light incident through the sides. A work-item
// processes a row of the map if REAL_WIDTH > 1 (CPU), and one voxel if REAL_WIDTH is 1 (GPU).
//

#include "LightPropagation/Published/PublishedShared.h"
#include "Numerics/Numerics.cl"

#define PAD REAL_WIDTH

// Number of floats for the outgoing radiance of one direction, W / (length^2 sr), summed over rays. Each row of the map
// has one sum for the face normal to u and one for the end of the marching axis; one sum is for the face normal to v.
#define ESCAPED(map) (2 * (map).sizeV + 1)

static __global float* ray_row(__global float* rays, const PublishedMap* map, int parity, int slot, int v)
{
  const ulong row = (ulong)(parity * map->directions * CHANNELS + slot) * (map->sizeV + 2) + (v + 1);
  return rays + row * map->rayRow + PAD;
}

// Path length times mean transmittance, (1 - exp(-tau)) / sigma; in vacuum the path length. `gone` is 1 - exp(-tau).
inline real depth(real gone, real tau, float length)
{
  return length * (max(gone, (real)1e-37f) / max(tau, (real)1e-37f));
}

// Sets the initial radiance of the rays. It is written to both ray maps, because both need the border. One work-item
// per element of the map with border, direction and channel.
//   boundary  incident radiance through the faces across w, u, v: [direction][3][CHANNELS]
//   carried   radiance of the rays that have wrapped around the marching axis, per voxel of the first plane; the
//             batch's first value has the index carried_first, and each direction has carried_stride floats
__kernel void start_rays(const PublishedMap map, __global float* rays, __global const float* boundary,
  __global const float* carried, const ulong carried_first, const ulong carried_stride)
{
  const int u = (int)get_global_id(0) - 1;
  const int v = (int)get_global_id(1) - 1;
  const int slot = get_global_id(2);
  if (u > map.sizeU || v > map.sizeV)
  {
    return;
  }
  const int outside_u = u < 0 || u == map.sizeU;
  const int outside_v = v < 0 || v == map.sizeV;
  const int direction = slot / CHANNELS;
  const int channel = slot % CHANNELS;
  const int side_u = outside_u && !map.periodicU;
  const int side_v = outside_v && !map.periodicV;
  boundary += direction * 3 * CHANNELS + channel;
  float radiance = boundary[0];
  if (side_u || side_v) // at an edge, the mean of both sides' radiance
  {
    radiance = (side_u ? boundary[CHANNELS] : 0.0f) + (side_v ? boundary[2 * CHANNELS] : 0.0f);
    radiance *= side_u && side_v ? 0.5f : 1.0f;
  }
  else if (map.periodicW)
  {
    const int from_u = (u + map.sizeU) % map.sizeU;
    const int from_v = (v + map.sizeV) % map.sizeV;
    radiance =
      carried[carried_first + direction * carried_stride + (channel * map.sizeV + from_v) * map.sizeU + from_u];
  }
  ray_row(rays, &map, 0, slot, v)[u] = radiance;
  ray_row(rays, &map, 1, slot, v)[u] = radiance;
}

// Adds to `escaped` the radiance that leaves through the sides as rays move into the next voxel. At an edge of the box,
// half of the radiance is counted at each of the two sides.
static void leave_sides(
  const PublishedMap* map, const PublishedCrossing* crossing, __global const float* row, int v, __global float* escaped)
{
  const int leaves_u = crossing->moveU != 0 && !map->periodicU;
  const int leaves_v = crossing->moveV != 0 && !map->periodicV && v == (crossing->moveV > 0 ? map->sizeV - 1 : 0);
  const float last = leaves_u ? row[crossing->moveU > 0 ? map->sizeU - 1 : 0] : 0.0f;
  if (leaves_u)
  {
    escaped[v] += leaves_v ? 0.5f * last : last;
  }
  if (leaves_v)
  {
    float sum = -0.5f * last;
    for (int u = 0; u < map->sizeU; ++u)
    {
      sum += row[u];
    }
    escaped[map->sizeV] += sum;
  }
}

// Radiance of a ray after it has crossed one voxel, Eq. (3) (numerics.md, Eq. (9)).
inline real cross_voxel(real radiance, real sigma_t, real source, float length)
{
  const real tau = sigma_t * length;
  real left;
  const real gone = extinguished(tau, &left);
  return SOURCE ? multiply_add(radiance, left, source * depth(gone, tau, length)) : radiance * left;
}
// Deposit of a ray in a voxel, Eq. (6) divided by sigma_s (numerics.md, Eq. (10)): path integral of radiance, in
// W / (length sr).
inline real deposit(real radiance, real sigma_s, float length)
{
  const real tau = sigma_s * length;
  real left;
  const real gone = extinguished(tau, &left);
  return radiance * depth(gone, tau, length);
}

#if REAL_WIDTH > 1
// Copies the radiance of row v of a ray map to the border on periodic axes: along u, both ends of the row to the
// opposite ends; along v, an outermost row to the border row beyond the opposite side. Called after the last write to
// the row.
static void wrap_row(__global float* rays, const PublishedMap* map, int parity, int slot, int v)
{
  __global float* row = ray_row(rays, map, parity, slot, v);
  if (map->periodicU)
  {
    row[map->sizeU] = row[0];
    row[-1] = row[map->sizeU - 1];
  }
  for (int copy = -1; map->periodicV && copy <= 1; copy += 2)
  {
    if (v == (copy < 0 ? map->sizeV - 1 : 0))
    {
      __global float* border = ray_row(rays, map, parity, slot, copy < 0 ? -1 : map->sizeV);
      for (int u = -1; u <= map->sizeU; ++u)
      {
        border[u] = row[u];
      }
    }
  }
}
#else
// Stores the radiance of the ray in voxel (u, v) of a ray map and, on periodic axes, of its images in the border.
static void store_with_images(
  __global float* rays, const PublishedMap* map, int parity, int slot, int u, int v, float radiance)
{
  for (int dv = -1; dv <= 1; ++dv)
  {
    for (int du = -1; du <= 1; ++du)
    {
      const int image_u = u + du * map->sizeU;
      const int image_v = v + dv * map->sizeV;
      if ((du == 0 || map->periodicU) && (dv == 0 || map->periodicV) && image_u >= -1 && image_u <= map->sizeU &&
        image_v >= -1 && image_v <= map->sizeV)
      {
        ray_row(rays, map, parity, slot, image_v)[image_u] = radiance;
      }
    }
  }
}
#endif

// Moves all rays of all directions of a launch into their next voxel and through it.
//   crossings         voxel crossings of all launches; those of this launch, one per direction, begin at index `first`
//   plane             index of the first float of the crossed plane in a volume
//   add               0: no rays have crossed these voxels yet, T is overwritten; 1: deposits are added to T
__kernel void cross_voxels(const PublishedMap map, const int plane, const int add, const int first,
  __global const PublishedCrossing* crossings, __global const float* sigma_t, __global const float* sigma_s,
  __global const float* sources, __global float* rays, __global float* contributions, __global float* escaped)
{
  const int v = get_global_id(1);
  if (v >= map.sizeV)
  {
    return;
  }
  const int channel = get_global_id(2) % CHANNELS;
  const PublishedCrossing crossing = crossings[first + get_global_id(2) / CHANNELS];
  const int slot = crossing.direction * CHANNELS + channel;
  const ulong row = (ulong)plane + v * map.rowStride;
  sigma_t += row + (COLOURED ? (ulong)channel * map.volume : 0);
  sigma_s += row + (COLOURED ? (ulong)channel * map.volume : 0);
  sources += row + (SOURCE ? (ulong)(crossing.source * CHANNELS + channel) * map.volume : 0);
  contributions += row + (ulong)slot * map.volume;
  escaped += (ulong)slot * ESCAPED(map);
  __global float* from = ray_row(rays, &map, crossing.parity, slot, v - crossing.moveV) - crossing.moveU;
  __global float* to = ray_row(rays, &map, !crossing.parity, slot, v);
  const float length = crossing.length;

#if REAL_WIDTH > 1
  leave_sides(&map, &crossing, ray_row(rays, &map, crossing.parity, slot, v), v, escaped);
  const float right_border = to[map.sizeU]; // saved, since the last vector of the row may overwrite it
  for (int u = 0; u < map.sizeU; u += REAL_WIDTH)
  {
    const real source = SOURCE ? load_real(u, sources) : (real)0.0f;
    const real radiance = cross_voxel(load_real(u, from), load_real(u, sigma_t), source, length);
    const real gained = deposit(radiance, load_real(u, sigma_s), length);
    store_real(add ? load_real(u, contributions) + gained : gained, u, contributions);
    store_real(radiance, u, to);
  }
  to[map.sizeU] = right_border;
  wrap_row(rays, &map, !crossing.parity, slot, v);
#else
  const int u = get_global_id(0);
  if (u >= map.sizeU)
  {
    return;
  }
  if (u == 0)
  {
    leave_sides(&map, &crossing, ray_row(rays, &map, crossing.parity, slot, v), v, escaped);
  }
  const float radiance = cross_voxel(from[u], sigma_t[u], SOURCE ? sources[u] : 0.0f, length);
  const float gained = deposit(radiance, sigma_s[u], length);
  contributions[u] = add ? contributions[u] + gained : gained;
  store_with_images(rays, &map, !crossing.parity, slot, u, v, radiance);
#endif
}

// Sums the radiance of the rays that leave after the last plane. If they wrap around the marching axis, stores their
// radiance in `carried` for the next order, carried_stride floats per direction. One work-item per row of the map,
// direction and channel.
//   crossings  one per direction, from index `first` on; the member `parity` says in which of the two ray maps the rays
//              are
__kernel void end_rays(const PublishedMap map, const int first, __global const PublishedCrossing* crossings,
  __global float* rays, __global float* escaped, __global float* carried, const ulong carried_first,
  const ulong carried_stride)
{
  const int v = get_global_id(0);
  if (v >= map.sizeV)
  {
    return;
  }
  const int channel = get_global_id(1) % CHANNELS;
  const PublishedCrossing crossing = crossings[first + get_global_id(1) / CHANNELS];
  const int slot = crossing.direction * CHANNELS + channel;
  __global const float* row = ray_row(rays, &map, crossing.parity, slot, v);
  float sum = 0.0f;
  for (int u = 0; u < map.sizeU; ++u)
  {
    sum += row[u];
  }
  escaped[(ulong)slot * ESCAPED(map) + map.sizeV + 1 + v] = sum;
  if (map.periodicW)
  {
    carried += carried_first + crossing.direction * carried_stride + (ulong)(channel * map.sizeV + v) * map.sizeU;
    for (int u = 0; u < map.sizeU; ++u)
    {
      carried[u] = row[u];
    }
  }
}
