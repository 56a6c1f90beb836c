// Path integrator of photons. The host defines
//   REAL_WIDTH  photons per packet: 1 on a GPU, 4 to 16 on a CPU
//   BENDS       1: the index varies; ORDER of the integrator is then 1, 2 or 4
//   NODE_BRICKS 1: the array `nodes` covers the domain, in the layout of BrickedBytes
//   DIRECTIONS  1: directions are recorded
//   MARKS       1: each photon carries a number, its mark (PhotonMarch.cl): its weight or origin, which voxels or
//               coarse cells sum; with PATHS its index
//   BRICKS      1: the medium is stored by bricks (PhotonBricks.cl), and a voxel's index in arrays is that of its
//               record: one record per voxel of a filled brick, one for an entire empty brick
//   BLOCKS      1: the grid is a block of the domain, and photons march until they leave it; without BRICKS
//
// A path obeys dr/dt = T, dT/dt = grad(n^2) / 2 with dt = ds / n (numerics.md, Eq. (90)). It is a sequence of steps,
// which are straight lines of constant velocity. A turn is the change of velocity between two steps. The integrators:
//   order 2  steps from kick to kick of the leapfrog, Eq. (91): the polygon of steps is the path
//   order 4  steps of Yoshida's integrator, each of three leapfrogs
//   order 1  explicit Euler, Eq. (92), as in Pfeuti 2009, Eq. 2.10 and 2.11: dx/ds = v / n, dv/ds = grad n
//
// The integrator evaluates n^2 ahead of the photon, but no farther than the look-ahead limits in MarchShared.h, since a
// block of the domain stores the index only within these limits (numerics.md, Eq. (99f)). Without them, a jump of n
// that accelerates a photon could make the integrator look arbitrarily far ahead. Steps in an octree are longer. Those
// of order 2 do not evaluate the index ahead. Those of order 4 end where they leave a cube of 2^YoshidaLevel voxels per
// edge, even in larger nodes.
//
// Where n is constant within the reach of interpolation, n^2 is not evaluated, and one step lasts until n varies.
//
// Positions are in voxels of the domain, velocities in voxels per time, lengths in voxel diagonals.
//
// A photon whose velocity is NaN, zero or infinite (n^2 beyond float) is terminated.

#pragma once
#include "Numerics/Numerics.cl"
#include "Photons/Marching/MarchShared.h"
#include "Photons/Marching/PhotonLanes.cl"
#include "Refraction/Index/SquaredIndex.cl"

#define NEVER 3e38f
#define AHEAD 4        // prefetch distance, in voxels along the axis with the largest component of velocity
#define OUTSIDE -3e38f // value of sigma in the padding around the grid
// Minimum speed of a photon, in voxel diagonals per unit of t, where dt = ds / n. The speed ds / dt is n, except for
// rounding and for steps across jumps of n.
#define SLOWEST_PACE 1e-12f
#define FASTEST_PACE 1e12f

// Arrays and parameters that a marching kernel passes to its functions.
typedef struct
{
  const MarchInfo* info;
  // Optical thickness of a voxel diagonal, [MEDIUM_CHANNELS][info->copy], where info->copy is the number of voxels of
  // the padded grid or, with BRICKS, of records. Sign bit set: the index varies in the voxel.
  const __global float* sigma;
  const __global float* coefficients; // B-spline coefficients of n^2 (SquaredIndex.cl)
  // Octree nodes, one byte per voxel. 0: the index is constant in the voxel; 1 + k: it varies, and the node that
  // contains the voxel has 2^k voxels per edge. The array covers the region `known` (info->known, padded by one voxel).
  // With NODE_BRICKS it covers the domain, stored as a table of bricks followed by the bricks (BrickedBytes).
  const __global uchar* nodes;
  __global long* sums;       // sums of deposits in fixed point, [info->copy][RECORD]
  __global PhotonEnd* ends;  // final states of photons
  __global float4* vertices; // vertices of a path: position in voxels, remaining power; null: vertices are only counted
  // With MARKS: one 64-bit integer per photon, which holds its weight (COUNTS), origin (CELLS) or index (PATHS).
  const __global ulong* marks;
  // With CELLS: for each voxel, index of the coarse cell that contains it, [info->copy]. With BRICKS: for each brick,
  // index of its first record, or minus the index of its only record if it is empty (PhotonBricks in MarchMedium.h).
  const __global int* cells;
#if BLOCKS
  __global PhotonOnItsWay* gone;     // photons that entered other blocks, in any order
  volatile __global int* gone_count; // number of photons in `gone`
  int batch;                         // index of the batch of the photons
#endif
} march_arrays;

// State of a packet of REAL_WIDTH photons. Times are counted from the beginning of the step.
typedef struct
{
  LANES(int, at);         // current voxel, as index into the padded grid
  LANES(int, alive);      // -1 until the photon has ended, then 0
  LANES_3(int, stride);   // change of `at` from a voxel to the next along each axis
  LANES(int, ahead);      // change of `at` to the voxel that is prefetched
  LANES_3(float, wall);   // time at which the photon reaches the next voxel wall along each axis
  LANES_3(float, across); // time between successive voxel walls along each axis
  LANES(float, now);      // current time
  LANES(float, turn);     // time at which the step ends; NEVER: n is constant, and the step lasts until n varies
  LANES(float, settled);  // time until which a varying index in the photon's voxel does not start another step
  LANES(float, pace);     // speed, in diagonals per time
  LANES(float, step);     // duration of the current step
  LANES(int, steps);      // number of steps of the integrator so far
  LANES(int, crossings);  // number of path segments so far whose light was deposited
  // Remaining power of each channel, in units of PackedPhotons::unit.
  float power[CHANNELS][REAL_WIDTH] __attribute__((aligned(64)));
  LANES_3(float, start);        // position at which the step began
  LANES_3(float, velocity);     // velocity in the step, voxels per time
  LANES_3(float, momentum);     // T of Eq. (90), which with order 2 is the velocity; with order 1, v of Eq. (92)
  float4 direction[REAL_WIDTH]; // (1, unit direction): its product with power is added to the sums of power and of flux
#if MARKS
  LANES(ulong, mark); // mark of the photon, for its weight (COUNTS), origin (CELLS) or index (PATHS)
#endif
#if BLOCKS
  // Kahan compensation of the power, stored here for photons that continue in another block.
  float owed[CHANNELS][REAL_WIDTH] __attribute__((aligned(64)));
#if CELLS
  // Coarse cell in which the photon was counted last, so that it is not counted again. Stored here for photons that
  // continue in another block.
  LANES(int, counted);
#endif
#endif
#if BRICKS
  LANES_3(int, voxel); // indices x, y, z of the current voxel in the domain
  LANES(int, last);    // number of voxels along an edge of the region crossed in one segment, less one; PhotonBricks.cl
  LANES_3(float, inverse); // time to cross a voxel along each axis, with the sign of the velocity
#endif
} photon_lanes;

#if BRICKS
#include "Photons/Marching/PhotonBricks.cl"
#endif

static int3 voxel_of(const MarchInfo* info, int at)
{
  const int row = info->grid.size[0] + 2, layer = row * (info->grid.size[1] + 2);
  const int z = at / layer;
  const int y = (at - z * layer) / row;
  return (int3)(at - z * layer - y * row - 1, y - 1, z - 1) + vload3(0, info->first);
}

// Face of the domain through which photon k left, or Elsewhere if it only left the block.
static int face_left(const MarchInfo* info, const photon_lanes* lanes, int k)
{
#if BRICKS
  const int3 voxel = (int3)(lanes->voxel[0][k], lanes->voxel[1][k], lanes->voxel[2][k]);
#else
  const int3 voxel = voxel_of(info, lanes->at[k]);
#endif
  const int3 size = vload3(0, info->whole.size);
  return voxel.x < 0    ? 0
    : voxel.x >= size.x ? 1
    : voxel.y < 0       ? 2
    : voxel.y >= size.y ? 3
    : voxel.z < 0       ? 4
    : voxel.z >= size.z ? 5
                        : Elsewhere;
}

// Index of a voxel of the domain in an array over a region of it, padded by `by` voxels at both ends of each axis.
//   part, first  size and first voxel of the region
static integer place_in(const IndexGrid* part, const int* first, int by, const integer* voxel)
{
  const int row = part->size[0] + 2 * by, layer = row * (part->size[1] + 2 * by);
  return (voxel[2] + (by - first[2])) * layer + (voxel[1] + (by - first[1])) * row + voxel[0] + (by - first[0]);
}

static integer padded(const MarchInfo* info, const integer* voxel)
{
  return place_in(&info->grid, info->first, 1, voxel);
}

// Finds the voxels that contain positions p, for photons in the mask. A photon on a wall between two voxels is assigned
// to the voxel with index `at`, whatever the rounding of p.
static void voxels_at(const MarchInfo* info, integer mask, const real* p, integer at, integer* voxel)
{
  FOR_AXES(a)
  {
    voxel[a] = to_integer(p[a]);
  }
  const integer wrong = mask & truth(padded(info, voxel) != at);
  if (anywhere(wrong))
  {
    LANES_3(int, right);
    LANES(int, there);
    PUT_INTEGERS(there, at);
    FOR_AXES(a)
    {
      PUT_INTEGERS(right[a], voxel[a]);
    }
    FOR_LANES(k, wrong)
    {
      const int3 known = voxel_of(info, there[k]);
      right[0][k] = known.x;
      right[1][k] = known.y;
      right[2][k] = known.z;
    }
    FOR_AXES(a)
    {
      voxel[a] = INTEGERS(right[a]);
    }
  }
}

// Time until a photon at p reaches the wall ahead of it. `low` and `high` are the walls of its voxel; u is its velocity
// along the axis, and `inverse` is 1 / u.
static real time_to_wall(real p, real low, real high, real u, real inverse)
{
  const real time = ((u > (real)0.0f ? high : low) - p) * inverse;
  return u == (real)0.0f ? (real)NEVER : greater(time, (real)0.0f);
}

// Sets the velocity of the photons in a mask to u, and the quantities that follow from it: time to cross a voxel, index
// strides to the next voxels, speed and direction. `inverse` is 1 / u.
static void aim(const MarchInfo* info, photon_lanes* lanes, integer mask, const real* u, const real* inverse)
{
  const int strides[3] = { 1, info->grid.size[0] + 2, (info->grid.size[0] + 2) * (info->grid.size[1] + 2) };
  real way[3], squares = 0.0f, fastest = 0.0f;
  integer ahead = 0;
  FOR_AXES(a)
  {
    const integer stride = u[a] > (real)0.0f ? (integer)strides[a] : (integer)-strides[a];
    const real speed = fabs(u[a]);
    ahead = speed > fastest ? stride : ahead;
    fastest = greater(speed, fastest);
    way[a] = u[a] * info->spacing[a];
    squares += way[a] * way[a];
    PUT_WHERE(mask, lanes->velocity[a], u[a]);
    PUT_WHERE(mask, lanes->across[a], u[a] == (real)0.0f ? (real)0.0f : fabs(inverse[a]));
    PUT_INTEGERS_WHERE(mask, lanes->stride[a], stride);
  }
  const real pace = sqrt(squares);
  PUT_WHERE(mask, lanes->pace, pace);
  PUT_INTEGERS_WHERE(mask, lanes->ahead, AHEAD * ahead);
#if DIRECTIONS
  LANES_3(float, direction);
  FOR_AXES(a)
  {
    PUT(direction[a], way[a] / pace);
  }
  FOR_LANES(k, mask)
  {
    lanes->direction[k] = (float4)(1.0f, direction[0][k], direction[1][k], direction[2][k]);
  }
#endif
}

// Begins steps of the photons in a mask at positions p in `voxel`, with velocities u; `inverse` is 1 / u.
static void begin_steps(const MarchInfo* info, photon_lanes* lanes, integer mask, const integer* voxel, const real* p,
  const real* u, const real* inverse)
{
  FOR_AXES(a)
  {
    const real low = to_real(voxel[a]);
    PUT_WHERE(mask, lanes->start[a], p[a]);
    PUT_WHERE(mask, lanes->wall[a], time_to_wall(p[a], low, low + (real)1.0f, u[a], inverse[a]));
  }
  PUT_WHERE(mask, lanes->now, (real)0.0f);
  aim(info, lanes, mask, u, inverse);
}

#if BENDS
// Index, in the array of spline coefficients of n^2, of the coefficient at a voxel of the domain.
static integer coefficient_of(const MarchInfo* info, const integer* voxel)
{
  return place_in(&info->known, info->knownFirst, 2, voxel);
}

// Computes n^2 and its gradient (per voxel) at positions p of the photons in a mask.
static void squared_index_at(const march_arrays* arrays, integer mask, const real* p, real* squared, real* gradient)
{
  const IndexGrid* known = &arrays->info->known;
  const int row = known->size[0] + 4, layer = row * (known->size[1] + 4);
  const int strides[3] = { 1, row, layer };
  LANES(int, first); // index of the first of the coefficients that the spline combines
  LANES_3(float, fraction);
  LANES(float, values);
  LANES_3(float, slopes);
  integer before = 0;
  FOR_AXES(a)
  {
    const real q = p[a] - (real)0.5f;
    const int least = arrays->info->knownFirst[a] - 1;
    const integer base = clamp(to_integer(q + (real)1.0f) - 1, (integer)least, (integer)(least + known->size[a]));
    before += (base - least) * strides[a];
    PUT(fraction[a], q - to_real(base));
    PUT(slopes[a], (real)0.0f);
  }
  PUT_INTEGERS(first, before);
  PUT(values, (real)1.0f);
  FOR_LANES(k, mask)
  {
    const float3 f = (float3)(fraction[0][k], fraction[1][k], fraction[2][k]);
    const float4 s = squared_index_among(arrays->coefficients + first[k], row, layer, f);
    slopes[0][k] = s.x;
    slopes[1][k] = s.y;
    slopes[2][k] = s.z;
    values[k] = s.w;
  }
  *squared = VECTOR(values);
  FOR_AXES(a)
  {
    gradient[a] = VECTOR(slopes[a]);
  }
}

// Limits a displacement along an axis, in voxels, to the distance ahead of the photon up to which the integrator may
// evaluate n^2 (MarchShared.h).
static real looked_ahead(const MarchInfo* info, real way)
{
  if (ORDER == 2 && info->levels)
  {
    return way; // not limited: a step ends at the wall of its octree node, and the nodes of the entire domain are known
  }
  const float steps = 0.5f * (ORDER == 4 ? YoshidaLooksAhead : LeapfrogLooksAhead) * info->stepSize;
  const float most = info->levels ? greater(steps, (float)(1 << YoshidaLevel)) : steps;
  return lesser(greater(way, (real)-most), (real)most);
}

// Finds the voxels of arbitrary positions. A position beyond the region in which the index is known is assigned to a
// voxel of the region's padding.
static void voxels_of_places(const MarchInfo* info, const real* p, integer* voxel)
{
  FOR_AXES(a)
  {
    const int least = NODE_BRICKS ? -1 : info->knownFirst[a] - 1;
    const int size = NODE_BRICKS ? info->whole.size[a] : info->known.size[a];
    voxel[a] = clamp(to_integer(p[a] + (real)1.0f) - 1, (integer)least, (integer)(least + size + 1));
  }
}

#define NODE_BRICK 8 // voxels along an edge of a brick of nodes, BrickedBytes::Edge

static int node_of_whole(const march_arrays* arrays, int3 voxel)
{
  const int3 size = vload3(0, arrays->info->whole.size);
  if (any(voxel < 0) || any(voxel >= size))
  {
    return 0;
  }
  const int3 bricks = (size + (NODE_BRICK - 1)) / NODE_BRICK, at = voxel / NODE_BRICK, in = voxel % NODE_BRICK;
  const int brick = ((const __global int*)arrays->nodes)[(at.z * bricks.y + at.y) * bricks.x + at.x];
  const ulong uneven = (ulong)(-1 - brick) * (NODE_BRICK * NODE_BRICK * NODE_BRICK) +
    (ulong)((in.z * NODE_BRICK + in.y) * NODE_BRICK + in.x);
  return brick >= 0 ? brick : arrays->nodes[(ulong)bricks.x * bricks.y * bricks.z * sizeof(int) + uneven];
}

// Octree nodes at the voxels of the photons in a mask. 0: n is constant in the voxel, or the photon is not in the mask.
// 1 + k: n varies, and the node that contains the voxel has 2^k voxels per edge.
static integer nodes_of(const march_arrays* arrays, integer mask, const integer* voxel)
{
  if (!NODE_BRICKS)
  {
    const MarchInfo* info = arrays->info;
    // Lanes outside the mask read the padding.
    const integer at = mask & place_in(&info->known, info->knownFirst, 1, voxel);
    return to_integer(gather(uchar, arrays->nodes, at));
  }
  LANES(int, node);
  LANES_3(int, place);
  PUT_INTEGERS(node, (integer)0);
  FOR_AXES(a)
  {
    PUT_INTEGERS(place[a], voxel[a]);
  }
  FOR_LANES(k, mask)
  {
    node[k] = node_of_whole(arrays, (int3)(place[0][k], place[1][k], place[2][k]));
  }
  return INTEGERS(node);
}

// Duration of the next steps of the photons in a mask, from positions p in `voxel` with velocities u; 0 where the
// index does not vary.
static real times_of_steps(
  const march_arrays* arrays, integer mask, const integer* voxel, const real* p, const real* u, const real* inverse)
{
  const MarchInfo* info = arrays->info;
  const integer node = nodes_of(arrays, mask, voxel);
  // The speed is bounded from below: a kick at a jump of n within the step may leave a photon almost without velocity.
  const real shortest =
    (real)info->stepSize / greater(sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]), (real)info->slowest);
  real time = shortest;
  if (info->levels && anywhere(truth(node > 1)))
  {
    // The step ends slightly beyond the octree node that contains the photon or, with order 4, beyond a cube within it.
    const integer above = max(node, 1) - 1, level = ORDER == 4 ? min(above, YoshidaLevel) : above;
    real out = NEVER;
    FOR_AXES(a)
    {
      const integer low = (voxel[a] >> level) << level;
      const integer high = min(low + ((integer)1 << level), info->whole.size[a]);
      const real wall = time_to_wall(p[a], to_real(low), to_real(high), u[a], inverse[a]);
      out = lesser(out, wall);
    }
    time = node > 1 ? greater((real)1.001f * out, shortest) : shortest;
  }
  return node == 0 ? (real)0.0f : time;
}

// Computes dT/dt of Eq. (90), which is half the gradient of n^2, at positions p, in voxels.
static void pull(const march_arrays* arrays, integer mask, const real* p, real* change)
{
  real squared;
  squared_index_at(arrays, mask, p, &squared, change);
  FOR_AXES(a)
  {
    change[a] *= 0.5f / (arrays->info->spacing[a] * arrays->info->spacing[a]);
  }
}

#if ORDER == 1
// Makes a step of explicit Euler from positions p. Sets the velocities u, and returns the step's duration, which equals
// its path length in diagonals.
static real take_step(
  const march_arrays* arrays, photon_lanes* lanes, integer mask, const integer* voxel, const real* p, real* u)
{
  real squared, gradient[3], inverse[3];
  squared_index_at(arrays, mask, p, &squared, gradient);
  const real n = sqrt(squared);
  FOR_AXES(a)
  {
    u[a] = VECTOR(lanes->momentum[a]) / n;
    inverse[a] = (real)1.0f / u[a];
  }
  const real step = times_of_steps(arrays, mask, voxel, p, u, inverse);
  FOR_AXES(a)
  {
    const float h = arrays->info->spacing[a];
    PUT_WHERE(mask, lanes->momentum[a], VECTOR(lanes->momentum[a]) + step * gradient[a] / ((2.0f * h * h) * n));
  }
  return step;
}
#elif ORDER == 4
// Makes a step of Yoshida's integrator from positions p. Sets the mean velocities u of the step, and returns its
// duration.
static real take_step(
  const march_arrays* arrays, photon_lanes* lanes, integer mask, const integer* voxel, const real* p, real* u)
{
  const float outer = 1.35120719195965763f, inner = -1.70241438391931526f;
  real inverse[3], moved[3], place[3],
    change[3]; // `moved` is relative to p, to which small steps cannot be added without loss
  FOR_AXES(a)
  {
    u[a] = VECTOR(lanes->momentum[a]);
    inverse[a] = (real)1.0f / u[a];
    moved[a] = 0.0f;
  }
  const real step = times_of_steps(arrays, mask, voxel, p, u, inverse);
  const integer moving = mask & truth(step > (real)0.0f);
  for (int part = 0; part < 3; ++part)
  {
    const real dt = step * (part == 1 ? inner : outer);
    FOR_AXES(a)
    {
      moved[a] += (real)0.5f * dt * u[a];
      place[a] = p[a] + looked_ahead(arrays->info, moved[a]);
    }
    pull(arrays, moving, place, change);
    FOR_AXES(a)
    {
      u[a] += dt * change[a];
      moved[a] += (real)0.5f * dt * u[a];
    }
  }
  FOR_AXES(a)
  {
    PUT_WHERE(mask, lanes->momentum[a], u[a]);
    u[a] = step > (real)0.0f ? moved[a] / step : u[a];
  }
  return step;
}
#endif

// Starts new steps of the photons in a mask, which have ended a step or have entered a region of varying index.
static void take_turns(const march_arrays* arrays, photon_lanes* lanes, integer mask)
{
  const MarchInfo* info = arrays->info;
  const real now = VECTOR(lanes->now);
  real p[3], u[3], inverse[3];
  integer voxel[3];
  FOR_AXES(a)
  {
    u[a] = VECTOR(lanes->velocity[a]);
    p[a] = VECTOR(lanes->start[a]) + u[a] * now;
  }
  voxels_at(info, mask, p, INTEGERS(lanes->at), voxel);
#if ORDER == 2
  // A photon that enters a region of varying index drifts for half a step. A photon at the end of a step is kicked; it
  // then drifts for half the old step and half the new one.
  const integer kicked = mask & truth(VECTOR(lanes->turn) <= now);
  const real step = VECTOR(lanes->step);
  real change[3], end[3], seen[3];
  integer last[3];
  pull(arrays, kicked, p, change);
  FOR_AXES(a)
  {
    u[a] += masked(kicked, step * change[a]);
    inverse[a] = (real)1.0f / u[a];
    const real way = masked(kicked, (real)0.5f * step * u[a]);
    end[a] = p[a] + way;
    seen[a] = p[a] + looked_ahead(info, way);
  }
  voxels_of_places(info, seen, last);
  FOR_AXES(a)
  {
    last[a] = kicked ? last[a] : voxel[a];
  }
  const real next = times_of_steps(arrays, mask, last, end, u, inverse);
  const real turn = (real)0.5f * (kicked ? step + next : next) + (kicked ? (real)0.0f : now);
  PUT_WHERE(mask, lanes->settled, kicked ? (real)0.5f * step : now);
#else
  const integer kicked = mask;
  const real next = take_step(arrays, lanes, mask, voxel, p, u);
  const real turn = next;
  FOR_AXES(a)
  {
    inverse[a] = (real)1.0f / u[a];
  }
  PUT_WHERE(mask, lanes->settled, (real)0.0f);
#endif
  PUT_WHERE(mask, lanes->step, next);
  PUT_WHERE(mask, lanes->turn, next > (real)0.0f ? turn : (real)NEVER);
  begin_steps(info, lanes, kicked, voxel, p, u, inverse);
  PUT_INTEGERS(lanes->steps, INTEGERS(lanes->steps) - kicked);
}
#endif

// Parks photon k of the packet, which has ended, while the other photons march on: gives it velocity 0 and a voxel of
// the padding around the grid, where it deposits nothing.
static void rest(photon_lanes* lanes, int k)
{
  lanes->alive[k] = 0;
  lanes->at[k] = 0;
  FOR_AXES(a)
  {
    lanes->stride[a][k] = 0;
    lanes->wall[a][k] = lanes->across[a][k] = 0.0f;
  }
  lanes->now[k] = lanes->pace[k] = 0.0f;
  lanes->ahead[k] = 0;
#if BRICKS
  FOR_AXES(a)
  {
    lanes->voxel[a][k] = -1;
    lanes->inverse[a][k] = lanes->velocity[a][k] = 0.0f;
  }
  lanes->last[k] = 0;
#endif
  lanes->turn[k] = NEVER;
}

// Finds the voxels in which photons start from positions p (voxels).
static void voxels_of_starts(const MarchInfo* info, const real* p, integer* voxel)
{
  FOR_AXES(a)
  {
    voxel[a] = clamp(to_integer(p[a]), (integer)0, (integer)(info->whole.size[a] - 1));
  }
}

// Starts photons at positions p (voxels) in unit directions u.
static void set_off(const march_arrays* arrays, photon_lanes* lanes, real* p, real* u)
{
  const MarchInfo* info = arrays->info;
  const integer all = (integer)-1;
  integer voxel[3];
  real inverse[3];
  voxels_of_starts(info, p, voxel);
  FOR_AXES(a)
  {
    u[a] /= info->spacing[a];
  }
  PUT_INTEGERS(lanes->at, padded(info, voxel));
  PUT_INTEGERS(lanes->alive, all);
  PUT_INTEGERS(lanes->steps, (integer)0);
  PUT(lanes->turn, (real)NEVER);
  PUT(lanes->settled, (real)0.0f);
  PUT(lanes->step, (real)0.0f);
#if BENDS
  // Photons start with speed n. Where the index does not vary, n^2 is the spline coefficient, the same at all
  // neighbours.
  const integer varies = truth(as_integer(gather(float, arrays->sigma, INTEGERS(lanes->at))) < 0);
  real squared, gradient[3];
  squared_index_at(arrays, varies, p, &squared, gradient);
  squared = varies ? squared : gather(float, arrays->coefficients, coefficient_of(info, voxel));
  FOR_AXES(a)
  {
    u[a] *= sqrt(squared);
    PUT(lanes->momentum[a], u[a]);
  }
#endif
  FOR_AXES(a)
  {
    inverse[a] = (real)1.0f / u[a];
  }
  begin_steps(info, lanes, all, voxel, p, u, inverse);
#if BRICKS
  set_off_in_bricks(arrays, lanes, voxel, p, u);
#endif
#if BENDS
  if (anywhere(varies))
  {
    take_turns(arrays, lanes, varies);
  }
#endif
}

#if BLOCKS
// Transfer of photons from one block of the domain into another. All coordinates are those of the domain, so a path
// continues as on an undivided grid. An arriving photon is on the wall through which it enters its new voxel. Whether
// it ends at this wall or starts a new step is still to be tested.

// Stores the path state of photon k, which has entered a voxel of another block, in `way`.
static void hand_way_on(const march_arrays* arrays, const photon_lanes* lanes, int k, __global WayOnward* way)
{
  vstore3(voxel_of(arrays->info, lanes->at[k]), 0, way->voxel);
  FOR_AXES(a)
  {
    way->wall[a] = lanes->wall[a][k];
    way->start[a] = lanes->start[a][k];
    way->velocity[a] = lanes->velocity[a][k];
#if BENDS
    way->momentum[a] = lanes->momentum[a][k];
#endif
  }
  way->now = lanes->now[k];
  way->turn = lanes->turn[k];
  way->settled = lanes->settled[k];
  way->step = lanes->step[k];
}

static void take_way_over(photon_lanes* lanes, int k, const __global WayOnward* way)
{
  FOR_AXES(a)
  {
    lanes->wall[a][k] = way->wall[a];
    lanes->start[a][k] = way->start[a];
    lanes->velocity[a][k] = way->velocity[a];
#if BENDS
    lanes->momentum[a][k] = way->momentum[a];
#endif
  }
  lanes->now[k] = way->now;
  lanes->turn[k] = way->turn;
  lanes->settled[k] = way->settled;
  lanes->step[k] = way->step;
}

// Resumes the paths of all photons of a packet in the given voxels, after their states were loaded by take_way_over.
static void go_on_in(const march_arrays* arrays, photon_lanes* lanes, const integer* voxel)
{
  real u[3], inverse[3];
  FOR_AXES(a)
  {
    u[a] = VECTOR(lanes->velocity[a]);
    inverse[a] = (real)1.0f / u[a];
  }
  aim(arrays->info, lanes, (integer)-1, u, inverse);
  PUT_INTEGERS(lanes->at, padded(arrays->info, voxel));
  PUT_INTEGERS(lanes->alive, (integer)-1);
}
#endif
