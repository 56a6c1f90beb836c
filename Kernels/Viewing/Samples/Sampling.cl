// Packets of REAL_WIDTH rays, and interpolation of samples along them.
//
// Macros set by the host:
//   COLOURED    1: extinction differs between red, green and blue; 0: one extinction for all three
//   GREY        1: the source does not differ between the channels either; an element of `samples` then holds source
//               and extinction of a voxel and of the next voxel along y
//   BRICKED     1: samples are stored in bricks (SampleBricks); 0: in the order of voxels
//   MANY_STEPS  1: rays take so many steps that rounding errors accumulate noticeably
//
// Floating-point contraction is off. Otherwise the compiler would fuse multiply and add in some expressions only, and
// pictures rendered with and without skipping of bricks would differ in the last bit.
//
// Positions are in voxels from the box's lower corner: voxel (i, j, k) covers [i, i+1] x [j, j+1] x [k, k+1]. Arrays
// named `samples` and `extinctions` have a border of one voxel that repeats the outermost voxels. Interpolation
// therefore needs no bounds checks, and the medium ends at the faces of the box, not half a voxel inside.

#pragma once
#include "Numerics/Numerics.cl"
#include "Numerics/Prefetch.cl"
#include "Viewing/Samples/SampleLayout.cl"
#include "Viewing/Scene/ViewShared.h"

#pragma OPENCL FP_CONTRACT OFF

#if REAL_WIDTH == 1
#define EACH_LANE(DO) DO(0)
#define LANE(v, n) v
#else
#define LANE(v, n) TYNDALL_JOIN(v.s, n)
#if REAL_WIDTH == 4
#define EACH_LANE(DO) DO(0) DO(1) DO(2) DO(3)
#elif REAL_WIDTH == 8
#define EACH_LANE(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)
#else
#define EACH_LANE(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7) DO(8) DO(9) DO(a) DO(b) DO(c) DO(d) DO(e) DO(f)
#endif
#endif

// Minimum and maximum as single vector instructions; wrong for NaN.
#define lesser(a, b) ((a) < (b) ? (a) : (b))
#define greater(a, b) ((a) > (b) ? (a) : (b))

// Combines the upper and the lower half of a vector by `operation`, repeatedly until four lanes are left.
#if REAL_WIDTH == 16
#define REDUCED_TO_FOUR(type, v, operation)    \
  const type##8 eight = operation(v.lo, v.hi); \
  const type##4 four = operation(eight.lo, eight.hi);
#elif REAL_WIDTH == 8
#define REDUCED_TO_FOUR(type, v, operation) const type##4 four = operation(v.lo, v.hi);
#else
#define REDUCED_TO_FOUR(type, v, operation) const type##4 four = v;
#endif
#define either(a, b) ((a) | (b))
#if REAL_WIDTH == 1
#define least_lane(v) (v)
#define any_lane(condition) (condition)
#else
inline float least_lane(real v)
{
  REDUCED_TO_FOUR(float, v, lesser)
  const float2 two = lesser(four.lo, four.hi);
  return lesser(two.x, two.y);
}
// Whether the condition holds in any lane (element) of a vector. PoCL's any() tests lane by lane, which is slow.
inline int any_lane(integer condition)
{
  REDUCED_TO_FOUR(int, condition, either)
  const int2 two = either(four.lo, four.hi);
  return either(two.x, two.y) != 0;
}
#endif
#define most_lanes(v) (-least_lane(-(v)))
#define all_lanes(condition) (!any_lane((condition) == 0))

typedef struct
{
  real x, y, z;
} real3;

typedef struct
{
  real r, g, b;
} rgb;

// Adds `more` to a sum; with MANY_STEPS by Kahan summation (1965), whose compensation is `rest`.
inline void add_to(real* sum, real* rest, real more)
{
#if MANY_STEPS
  const real whole = more - *rest;
  const real next = *sum + whole;
  *rest = (next - *sum) - whole;
  *sum = next;
#else
  *sum += more;
#endif
}

// A packet of REAL_WIDTH rays: entry point into the box (voxels), direction (voxels per unit length), and path length
// inside the box (0: the ray misses the box).
typedef struct
{
  real3 entry;
  real3 direction;
  real length;
} rays;

inline real at_least_tiny(real v)
{
  const real tiny = (real)1e-20f;
  return fabs(v) > tiny ? v : copysign(tiny, v);
}

inline real within(real v, int size)
{
  return lesser(greater(v, (real)0.0f), (real)(float)size);
}

// Clips rays to the box of `size` voxels.
//   from      start of the rays, voxels
//   farthest  length at which the rays end
//   before    receives the length from the start to the entry
inline rays clip_to_box(real3 from, real3 direction, real farthest, int4 size, real* before)
{
  const real ix = (real)1.0f / at_least_tiny(direction.x);
  const real iy = (real)1.0f / at_least_tiny(direction.y);
  const real iz = (real)1.0f / at_least_tiny(direction.z);
  const real x0 = -from.x * ix;
  const real y0 = -from.y * iy;
  const real z0 = -from.z * iz;
  const real x1 = ((real)(float)size.x - from.x) * ix;
  const real y1 = ((real)(float)size.y - from.y) * iy;
  const real z1 = ((real)(float)size.z - from.z) * iz;
  const real in = greater(greater(lesser(x0, x1), lesser(y0, y1)), greater(lesser(z0, z1), (real)0.0f));
  const real out = lesser(lesser(greater(x0, x1), greater(y0, y1)), lesser(greater(z0, z1), farthest));
  // Entry points are clamped: rounding errors of a distant camera must not move them out of the box.
  rays result;
  result.direction = direction;
  result.entry.x = within(fma(in, direction.x, from.x), size.x);
  result.entry.y = within(fma(in, direction.y, from.y), size.y);
  result.entry.z = within(fma(in, direction.z, from.z), size.z);
  const real left_x = ((ix > (real)0.0f ? (real)(float)size.x : (real)0.0f) - result.entry.x) * ix;
  const real left_y = ((iy > (real)0.0f ? (real)(float)size.y : (real)0.0f) - result.entry.y) * iy;
  const real left_z = ((iz > (real)0.0f ? (real)(float)size.z : (real)0.0f) - result.entry.z) * iz;
  const real left = lesser(lesser(left_x, left_y), lesser(left_z, farthest - in));
  result.length = out > in ? greater(left, (real)0.0f) : (real)0.0f;
  *before = result.length > (real)0.0f ? in : (real)0.0f;
  return result;
}

// Length along each ray in which it advances by `step` voxels.
inline real step_length(real3 direction, float step)
{
  return (real)step / sqrt(fma(direction.x, direction.x, fma(direction.y, direction.y, direction.z * direction.z)));
}

inline real3 along(rays packet, real distance)
{
  // Beyond the box, the point stays at the ray's exit.
  const real d = lesser(distance, packet.length);
  real3 p;
  p.x = fma(d, packet.direction.x, packet.entry.x);
  p.y = fma(d, packet.direction.y, packet.entry.y);
  p.z = fma(d, packet.direction.z, packet.entry.z);
  return p;
}

// The eight voxel centres around one point on each ray of a packet: twice the index of the first centre; the
// interpolation weights of the four pairs along x; and the weight of the upper centre of each pair.
typedef struct
{
  integer twiceFirst;
  real nearLow, nearHigh, farLow, farHigh;
  real x;
#if GREY
  real y, near, far; // weights of the upper centre along y, and of the two centres along z
#endif
} corners;

// Computes the interpolation weights at points p, and the indices of the lower of the two voxel centres along each
// axis: first_i along x as integers; j and k along y and z as integers stored in reals.
__attribute__((always_inline)) inline void weigh_corners(real3 p, corners* at, integer* first_i, real* j, real* k)
{
  // Conversion to integer truncates, which equals floor here, because points in the box are at least half a voxel above
  // the border's centres; PoCL compiles floor to eleven instructions.
  const real px = p.x + (real)0.5f;
  const real py = p.y + (real)0.5f;
  const real pz = p.z + (real)0.5f;
  const integer i = to_integer(px);
  *first_i = i;
  *j = to_real(to_integer(py));
  *k = to_real(to_integer(pz));
  const real y = py - *j;
  const real z = pz - *k;
  const real both = y * z;
  const real z_only = z - both;
  at->x = px - to_real(i);
  at->farHigh = both;
  at->nearHigh = y - both;
  at->farLow = z_only;
  at->nearLow = ((real)1.0f - y) - z_only;
#if GREY
  at->y = y;
  at->near = (real)1.0f - z;
  at->far = z;
#endif
}

// Finds the eight voxel centres around points p in arrays of `size` voxels that begin at voxel `first`.
__attribute__((always_inline)) inline void find_corners_from(real3 p, int4 first, int4 size, corners* at)
{
  integer i;
  real j, k;
  weigh_corners(p, at, &i, &j, &k);
  // Row indices are computed in float, which represents integers up to 16 million exactly.
  const integer row = to_integer(fma(k - (real)(float)first.z, (real)(float)(size.y + 2), j - (real)(float)first.y));
  at->twiceFirst = (row * (size.x + 2) + (i - first.x)) * 2;
}

__attribute__((always_inline)) inline void find_corners(real3 p, int4 size, corners* at)
{
  find_corners_from(p, (int4)(0), size, at);
}

#if BRICKED
// Finds the eight voxel centres around points p in samples that are stored in bricks.
// @param records  for each brick, index of its first sample; 0 for empty bricks, whose samples are zero
__attribute__((always_inline)) inline void find_corners_in_bricks(
  real3 p, int4 size, __global const int* records, corners* at)
{
  integer i;
  real y, z;
  weigh_corners(p, at, &i, &y, &z);
  const integer j = to_integer(y), k = to_integer(z);
  const integer brick =
    ((k >> BrickBits) * (size.y / BrickEdge + 1) + (j >> BrickBits)) * (size.x / BrickEdge + 1) + (i >> BrickBits);
  integer first = (integer)records[LANE(brick, 0)];
  if (any_lane(brick != (integer)LANE(brick, 0))) // rays of a packet are mostly in one brick
  {
#define RECORD(n) LANE(first, n) = records[LANE(brick, n)];
    EACH_LANE(RECORD)
#undef RECORD
  }
  const integer within = (integer)(BrickEdge - 1);
  at->twiceFirst = (first + ((k & within) * SAMPLE_ROWS + (j & within)) * SampleEdge + (i & within)) * 2;
}
#endif

#if REAL_WIDTH > 1
// Prefetches the rows of samples around a point p that the packet will reach. The point may lie outside the array,
// since a prefetch accepts any address.
inline void fetch_ahead(__global const float4* samples, real3 p, int4 size)
{
  const int row = size.x + 2;
  const int slice = row * (size.y + 2);
  const integer j = to_integer(p.y + (real)0.5f);
  const integer k = to_integer(p.z + (real)0.5f);
  const integer at = k * slice + j * row + to_integer(p.x + (real)0.5f);
#define ASK(place) PREFETCH(samples + (place), 0, 3)
#define ASK_AROUND(n)       \
  ASK(LANE(at, n));         \
  ASK(LANE(at, n) + row);   \
  ASK(LANE(at, n) + slice); \
  ASK(LANE(at, n) + slice + row)
  ASK_AROUND(0);
  ASK_AROUND(3);
#if REAL_WIDTH == 16
  ASK_AROUND(c);
  ASK_AROUND(f);
#endif
#undef ASK_AROUND
#undef ASK
}
#else
#define fetch_ahead(samples, p, size)
#endif

inline float8 neighbours(__global const float2* row, uint twice_first)
{
  __global const float4* at = (__global const float4*)(row + twice_first);
  return (float8)(at[0], at[1]); // a float4 is aligned to 16 bytes, but not to the 32 bytes of a float8
}

#if REAL_WIDTH == 16
// Interpolates along x for four rays. Each argument v belongs to one ray and holds four values at the lower x, then
// four at the upper x. The weights of the rays are in lanes 0, 4, 8 and c of x. Returns 16 lanes: the four interpolated
// values of the first ray, then those of the second, third and fourth.
inline float16 four_between(float8 v0, float8 v4, float8 v8, float8 vc, float16 x)
{
  const float16 left = (float16)(v0, v4);
  const float16 right = (float16)(v8, vc);
  const float16 lower = (float16)(left.s0123, left.s89ab, right.s0123, right.s89ab);
  const float16 upper = (float16)(left.s4567, left.scdef, right.s4567, right.scdef);
  return fma(x, upper - lower, lower);
}

// Transposes the values of a packet's rays from [ray][value] to [value][ray].
//   a, b, c, d  results of four_between for the rays 0, 4, 8, c; for 1, 5, 9, d; for 2, 6, a, e; for 3, 7, b, f
//   colour, w   receive the first three values and the fourth value of each ray
__attribute__((always_inline)) inline void transpose_quarters(
  float16 a, float16 b, float16 c, float16 d, rgb* colour, real* w)
{
  // Only permutations within quarters of a register are used, which are fast.
  const float16 ab_low =
    (float16)(a.s0, b.s0, a.s1, b.s1, a.s4, b.s4, a.s5, b.s5, a.s8, b.s8, a.s9, b.s9, a.sc, b.sc, a.sd, b.sd);
  const float16 cd_low =
    (float16)(c.s0, d.s0, c.s1, d.s1, c.s4, d.s4, c.s5, d.s5, c.s8, d.s8, c.s9, d.s9, c.sc, d.sc, c.sd, d.sd);
  const float16 ab_high =
    (float16)(a.s2, b.s2, a.s3, b.s3, a.s6, b.s6, a.s7, b.s7, a.sa, b.sa, a.sb, b.sb, a.se, b.se, a.sf, b.sf);
  const float16 cd_high =
    (float16)(c.s2, d.s2, c.s3, d.s3, c.s6, d.s6, c.s7, d.s7, c.sa, d.sa, c.sb, d.sb, c.se, d.se, c.sf, d.sf);
  // Pairs of floats are moved as longs; otherwise PoCL compiles each of these expressions to ten instructions.
#define FIRST_PAIRS(p, q)                                                                                            \
  as_float16((long8)(as_long8(p).s0, as_long8(q).s0, as_long8(p).s2, as_long8(q).s2, as_long8(p).s4, as_long8(q).s4, \
    as_long8(p).s6, as_long8(q).s6))
#define SECOND_PAIRS(p, q)                                                                                           \
  as_float16((long8)(as_long8(p).s1, as_long8(q).s1, as_long8(p).s3, as_long8(q).s3, as_long8(p).s5, as_long8(q).s5, \
    as_long8(p).s7, as_long8(q).s7))
  colour->r = FIRST_PAIRS(ab_low, cd_low);
  colour->g = SECOND_PAIRS(ab_low, cd_low);
  colour->b = FIRST_PAIRS(ab_high, cd_high);
  *w = SECOND_PAIRS(ab_high, cd_high);
#undef FIRST_PAIRS
#undef SECOND_PAIRS
}
#endif

// Interpolates values trilinearly at each ray's point: their xyz to `colour`, their w to `w`. Neighbours along x are
// adjacent in memory, so four loads of eight floats read all corners of a ray. If `paired` (a compile-time constant),
// an element holds two numbers of a voxel and two of the next voxel along y. Then two loads suffice, and the caller
// interpolates along y. size.w is 0, which the compiler cannot know: this keeps `at` in memory, from which a CPU
// broadcasts single lanes at no cost.
__attribute__((always_inline)) inline void gather_values(
  __global const float4* values, const corners* at, int4 size, const int paired, rgb* colour, real* w)
{
  __global const float2* near_low = (__global const float2*)values;
  __global const float2* near_high = near_low + 2 * ROW_LENGTH(size);
  __global const float2* far_low = near_low + 2 * SLICE_LENGTH(size);
  __global const float2* far_high = far_low + 2 * ROW_LENGTH(size);
#define FIRST(n) ((const uint*)&at->twiceFirst)[0x##n + size.w]
#define WEIGHT(part, n) (((const float*)&at->part)[0x##n + size.w])
#define FETCH_FOUR(n)                                                               \
  v##n = WEIGHT(nearLow, n) * neighbours(near_low, FIRST(n));                       \
  v##n = fma((float8)(WEIGHT(nearHigh, n)), neighbours(near_high, FIRST(n)), v##n); \
  v##n = fma((float8)(WEIGHT(farLow, n)), neighbours(far_low, FIRST(n)), v##n);     \
  v##n = fma((float8)(WEIGHT(farHigh, n)), neighbours(far_high, FIRST(n)), v##n);
#if GREY
#define FETCH(n)                                                               \
  float8 v##n;                                                                 \
  if (paired)                                                                  \
  {                                                                            \
    v##n = WEIGHT(near, n) * neighbours(near_low, FIRST(n));                   \
    v##n = fma((float8)(WEIGHT(far, n)), neighbours(far_low, FIRST(n)), v##n); \
  }                                                                            \
  else                                                                         \
  {                                                                            \
    FETCH_FOUR(n)                                                              \
  }
#else
#define FETCH(n) \
  float8 v##n;   \
  FETCH_FOUR(n)
#endif
#if REAL_WIDTH == 16
  const float16 x = at->x;
  FETCH(0) FETCH(4) FETCH(8) FETCH(c) const float16 a = four_between(v0, v4, v8, vc, x.s000044448888cccc);
  FETCH(1) FETCH(5) FETCH(9) FETCH(d) const float16 b = four_between(v1, v5, v9, vd, x.s111155559999dddd);
  FETCH(2) FETCH(6) FETCH(a) FETCH(e) const float16 c = four_between(v2, v6, va, ve, x.s22226666aaaaeeee);
  FETCH(3) FETCH(7) FETCH(b) FETCH(f) const float16 d = four_between(v3, v7, vb, vf, x.s33337777bbbbffff);
  transpose_quarters(a, b, c, d, colour, w);
#else
  EACH_LANE(FETCH)
#define BETWEEN(n) const float4 u##n = fma((float4)(WEIGHT(x, n)), v##n.hi - v##n.lo, v##n.lo);
  EACH_LANE(BETWEEN)
#undef BETWEEN
#if REAL_WIDTH == 1
#define TRANSPOSED(c) u0.c
#elif REAL_WIDTH == 4
#define TRANSPOSED(c) (real)(u0.c, u1.c, u2.c, u3.c)
#else
#define TRANSPOSED(c) (real)(u0.c, u1.c, u2.c, u3.c, u4.c, u5.c, u6.c, u7.c)
#endif
  colour->r = TRANSPOSED(x);
  colour->g = TRANSPOSED(y);
  colour->b = TRANSPOSED(z);
  *w = TRANSPOSED(w);
#undef TRANSPOSED
#endif
#undef FETCH
#undef FETCH_FOUR
#undef FIRST
#undef WEIGHT
}

inline void gather(__global const float4* values, const corners* at, int4 size, rgb* colour, real* w)
{
  gather_values(values, at, size, 0, colour, w);
}

// Interpolates source and grey extinction at each ray's point.
inline void gather_samples(__global const float4* samples, const corners* at, int4 size, rgb* source, real* sigma)
{
#if GREY
  rgb low;
  real high;
  gather_values(samples, at, size, 1, &low, &high);
  source->r = source->g = source->b = fma(at->y, low.b - low.r, low.r);
  *sigma = fma(at->y, high - low.g, low.g);
#else
  gather_values(samples, at, size, 0, source, sigma);
#endif
}

// Interpolates bilinearly in a table for each ray. The table values are two adjacent ones from index `lower` on, and
// two from `upper` on. x is the weight of the second value of a pair, y the weight of the upper pair.
inline rgb between_four(__global const float4* values, integer lower, integer upper, real x, real y)
{
  rgb seen;
#define SEE(n)                                                               \
  {                                                                          \
    __global const float4* below = values + LANE(lower, n);                  \
    __global const float4* above = values + LANE(upper, n);                  \
    const float4 a = fma((float4)LANE(x, n), below[1] - below[0], below[0]); \
    const float4 b = fma((float4)LANE(x, n), above[1] - above[0], above[0]); \
    const float4 c = fma((float4)LANE(y, n), b - a, a);                      \
    LANE(seen.r, n) = c.x;                                                   \
    LANE(seen.g, n) = c.y;                                                   \
    LANE(seen.b, n) = c.z;                                                   \
  }
  EACH_LANE(SEE)
#undef SEE
  return seen;
}

// `bricks` holds a signed distance per brick (FindDistances in PackedSamples.cxx). Its absolute value is the Chebyshev
// distance, in bricks, to the nearest brick of another class. The sign is positive for empty bricks and negative for
// bricks with extinction or emission; the value is 0 where rays bend.

// Describes the bricks ahead of a packet of rays. Finished rays are ignored.
//   steps  number of steps that every ray can take before one of them leaves the surrounding bricks of its class
//          (empty, filled, or with bending rays)
//   empty  whether all these steps are in empty bricks
//   bends  whether a ray bends
typedef struct
{
  int steps, empty, bends;
} stretch;

__attribute__((always_inline)) inline stretch stretch_ahead(
  __global const char* bricks, int4 brick_count, real3 p, real3 strides, integer done)
{
  const integer bx = min(to_integer(p.x * (real)(1.0f / BrickEdge)), brick_count.x - 1);
  const integer by = min(to_integer(p.y * (real)(1.0f / BrickEdge)), brick_count.y - 1);
  const integer bz = min(to_integer(p.z * (real)(1.0f / BrickEdge)), brick_count.z - 1);
  const integer brick = (bz * brick_count.y + by) * brick_count.x + bx;
  integer distance = (integer)(int)bricks[LANE(brick, 0)];
  if (any_lane(brick != (integer)LANE(brick, 0))) // rays of a packet are mostly in one brick
  {
#define DISTANCE(n) LANE(distance, n) = bricks[LANE(brick, n)];
    EACH_LANE(DISTANCE)
#undef DISTANCE
  }
  const integer reach = (distance < 0 ? -distance : distance) - 1;
#define STEPS_LEFT(b, c) \
  ((to_real(strides.c > (real)0.0f ? (b + reach + 1) * BrickEdge : (b - reach) * BrickEdge) - p.c) * strides.c)
  const real steps = lesser(lesser(STEPS_LEFT(bx, x), STEPS_LEFT(by, y)), STEPS_LEFT(bz, z));
#undef STEPS_LEFT
  stretch s;
  s.empty = all_lanes(done | (distance > 0));
  s.bends = any_lane((done == 0) & (distance == 0));
  s.steps = 1 + (int)lesser(greater(least_lane(done ? (real)1e6f : steps), 0.0f), 1e6f);
  return s;
}

// Number of steps, with sign, in which a ray advances by one voxel along each axis.
inline real3 strides_per_voxel(real3 direction, real step)
{
  real3 strides;
  strides.x = (real)1.0f / at_least_tiny(direction.x * step);
  strides.y = (real)1.0f / at_least_tiny(direction.y * step);
  strides.z = (real)1.0f / at_least_tiny(direction.z * step);
  return strides;
}

// Clips rays to one block of a larger grid.
//
// A ray takes the same steps as through the whole grid; each step belongs to the block that contains its midpoint.
// Samples thus lie at the same points as in the whole grid, and every step is taken exactly once.

#define BEYOND 1e30f // length beyond the end of every ray

// Number of steps of a ray whose midpoints are closer than `distance` to its entry into the whole grid.
//   steps        number of steps through the whole grid
//   last_middle  distance of the last step's midpoint from the entry
inline real steps_before(real distance, real step, real steps, real last_middle)
{
  const real nominal = ceil(distance / step - (real)0.5f);
  const real full = lesser(greater(nominal, (real)0.0f), greater(steps - (real)1.0f, (real)0.0f));
  const integer all = (steps > (real)0.0f) & (last_middle < distance);
  return full + (all ? (real)1.0f : (real)0.0f);
}

// Computes the section of each ray whose steps belong to the block, in voxel coordinates of the block.
//   from    start of the rays, voxels of the whole grid
//   stride  length of a step, voxels
//   before  receives the length of the ray in front of the block
//   enters  receives whether the ray enters the whole grid in this block
//   leaves  receives whether the ray leaves the whole grid from this block; also set for rays that miss the grid, if
//           this block shows them the background
inline rays clip_to_block(real3 from, real3 direction, real farthest, const BlockInfo* b, float stride, real* before,
  integer* enters, integer* leaves)
{
  const rays whole = clip_to_box(from, direction, farthest, b->whole, before);
  const real step = step_length(direction, stride);
  const real steps = ceil(whole.length / step);
  const real last_middle = (real)0.5f * (whole.length + (steps - (real)1.0f) * step);

  // Distances from the entry into the whole grid to the planes between blocks, computed so that adjacent blocks obtain
  // bitwise equal values.
  real in = (real)-BEYOND, out = (real)BEYOND;
#define CLIP(c)                                                                                            \
  {                                                                                                        \
    const real inverse = (real)1.0f / at_least_tiny(direction.c);                                          \
    const real beyond = copysign((real)BEYOND, inverse);                                                   \
    const real lower = b->begin.c > 0 ? ((real)(float)b->begin.c - whole.entry.c) * inverse : -beyond;     \
    const real upper = b->end.c < b->whole.c ? ((real)(float)b->end.c - whole.entry.c) * inverse : beyond; \
    in = greater(in, lesser(lower, upper));                                                                \
    out = lesser(out, greater(lower, upper));                                                              \
  }
  CLIP(x)
  CLIP(y)
  CLIP(z)
#undef CLIP
  const real first = steps_before(in, step, steps, last_middle);
  const real last = steps_before(out, step, steps, last_middle);
  const integer crosses = last > first;
  *enters = crosses & (first == (real)0.0f);
  *leaves = (crosses & (last == steps)) | ((whole.length == (real)0.0f) & (integer)(b->first.w != 0 ? -1 : 0));

  rays part;
  const real skipped = first * step;
  part.direction = direction;
  part.length = crosses ? lesser(last * step, whole.length) - skipped : (real)0.0f;
  part.entry.x = crosses ? fma(skipped, direction.x, whole.entry.x) - (real)(float)b->first.x : (real)0.0f;
  part.entry.y = crosses ? fma(skipped, direction.y, whole.entry.y) - (real)(float)b->first.y : (real)0.0f;
  part.entry.z = crosses ? fma(skipped, direction.z, whole.entry.z) - (real)(float)b->first.z : (real)0.0f;
  *before = crosses ? *before + skipped : (real)0.0f;
  return part;
}
