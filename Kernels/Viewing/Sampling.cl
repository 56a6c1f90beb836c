// Rays through a medium, REAL_WIDTH of them at a time, and what they meet there.
//
// Needs Numerics.cl before it. Define
//   COLOURED  1: extinction differs between red, green and blue; 0: one extinction serves all three
//
// Every result is rounded as written: else the compiler fuses multiply and add here but not there, and two variants of a
// kernel (skipping bricks or not) would give pictures that differ in the last place.
//
// Positions are in voxels from the box's lower corner, so that voxel (i, j, k) covers [i, i+1] x [j, j+1] x [k, k+1]. Arrays
// named `samples` and `extinctions` have a border of one voxel that repeats the outermost ones: an interpolation never has
// to ask where the box ends, and the medium ends at the box's faces, not half a voxel before.

#pragma OPENCL FP_CONTRACT OFF

#if REAL_WIDTH == 1
#define EACH_LANE(DO) DO(0)
#define LANE(v, n) v
#define any_lane(condition) (condition)
#define all_lanes(condition) (condition)
#define least_lane(v) (v)
#define most_lanes(v) (v)
#else
#define LANE(v, n) TYNDALL_JOIN(v.s, n)
#define any_lane(condition) any(condition)
#define all_lanes(condition) all(condition)
#if REAL_WIDTH == 4
#define EACH_LANE(DO) DO(0) DO(1) DO(2) DO(3)
#elif REAL_WIDTH == 8
#define EACH_LANE(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)
#else
#define EACH_LANE(DO)                                                                                                    \
  DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7) DO(8) DO(9) DO(a) DO(b) DO(c) DO(d) DO(e) DO(f)
#endif
#endif

// min and max as the hardware has them, one instruction for all lanes; not for NaN.
#define lesser(a, b) ((a) < (b) ? (a) : (b))
#define greater(a, b) ((a) > (b) ? (a) : (b))

#if REAL_WIDTH > 1
inline float least_lane(real v)
{
#if REAL_WIDTH == 16
  const float8 eight = lesser(v.lo, v.hi);
  const float4 four = lesser(eight.lo, eight.hi);
#elif REAL_WIDTH == 8
  const float4 four = lesser(v.lo, v.hi);
#else
  const float4 four = v;
#endif
  const float2 two = lesser(four.lo, four.hi);
  return lesser(two.x, two.y);
}
inline float most_lanes(real v)
{
  return -least_lane(-v);
}
#endif

typedef struct
{
  real x, y, z;
} real3;

typedef struct
{
  real r, g, b;
} rgb;

// Packets of rays: where each enters the box, its direction in voxels per unit length, and how long it stays inside (0: it
// misses).
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

// The part of each ray from `from`, at most `farthest` long, that lies in the box.
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
  rays result;
  result.direction = direction;
  result.length = greater(out - in, (real)0.0f);
  *before = result.length > (real)0.0f ? in : (real)0.0f;
  result.entry.x = fma(*before, direction.x, from.x);
  result.entry.y = fma(*before, direction.y, from.y);
  result.entry.z = fma(*before, direction.z, from.z);
  return result;
}

// A length along each ray that advances by `step` voxels.
inline real step_length(real3 direction, float step)
{
  return (real)step /
    sqrt(fma(direction.x, direction.x, fma(direction.y, direction.y, direction.z * direction.z)));
}

inline real within(real v, int size)
{
  return lesser(greater(v, (real)0.0f), (real)(float)size);
}

inline real3 along(rays packet, real distance, int4 size)
{
  real3 p;
  p.x = within(fma(distance, packet.direction.x, packet.entry.x), size.x);
  p.y = within(fma(distance, packet.direction.y, packet.entry.y), size.y);
  p.z = within(fma(distance, packet.direction.z, packet.entry.z), size.z);
  return p;
}

// What eight voxel centres around a point make of it: the first one's index and how far the point is towards the others.
typedef struct
{
  integer first;
  real x, y, z;
} corners;

inline corners corners_around(real3 p, int4 size)
{
  const real x = floor(p.x + (real)0.5f);
  const real y = floor(p.y + (real)0.5f);
  const real z = floor(p.z + (real)0.5f);
  corners c;
  c.x = p.x + (real)0.5f - x;
  c.y = p.y + (real)0.5f - y;
  c.z = p.z + (real)0.5f - z;
  c.first = (to_integer(z) * (size.y + 2) + to_integer(y)) * (size.x + 2) + to_integer(x);
  return c;
}

// One ray's sample, all four values of a voxel at once. Neighbours along x lie side by side in memory, so that four loads
// of eight floats bring all corners.
inline float4 interpolate(global const float4* samples, int first, int row, int slice, float x, float y, float z)
{
  global const float4* near = samples + first;
  global const float4* far = near + slice;
  float8 a = (float8)(near[0], near[1]);
  float8 b = (float8)(far[0], far[1]);
  a = fma((float8)y, (float8)(near[row], near[row + 1]) - a, a);
  b = fma((float8)y, (float8)(far[row], far[row + 1]) - b, b);
  a = fma((float8)z, b - a, a);
  return fma((float4)x, a.hi - a.lo, a.lo);
}

// The same for a packet: colour and w of the sample at each ray's corners.
inline void gather(global const float4* samples, corners at, int4 size, rgb* colour, real* w)
{
  const int row = size.x + 2;
  const int slice = row * (size.y + 2);
#define FETCH(n)                                                                                                         \
  const float4 v##n =                                                                                                    \
    interpolate(samples, LANE(at.first, n), row, slice, LANE(at.x, n), LANE(at.y, n), LANE(at.z, n));
  EACH_LANE(FETCH)
#undef FETCH
#if REAL_WIDTH == 1
#define TRANSPOSED(c) v0.c
#elif REAL_WIDTH == 4
#define TRANSPOSED(c) (real)(v0.c, v1.c, v2.c, v3.c)
#elif REAL_WIDTH == 8
#define TRANSPOSED(c) (real)(v0.c, v1.c, v2.c, v3.c, v4.c, v5.c, v6.c, v7.c)
#else
#define TRANSPOSED(c)                                                                                                    \
  (real)(v0.c, v1.c, v2.c, v3.c, v4.c, v5.c, v6.c, v7.c, v8.c, v9.c, va.c, vb.c, vc.c, vd.c, ve.c, vf.c)
#endif
  colour->r = TRANSPOSED(x);
  colour->g = TRANSPOSED(y);
  colour->b = TRANSPOSED(z);
  *w = TRANSPOSED(w);
#undef TRANSPOSED
}

// Edge of a brick in voxels. Each brick has a number: how many bricks one has to go (as a chess king does) to one where
// anything extinguishes or shines; 0 for such a brick itself.
#define BRICK 8

// How many steps, from the sample at p on, every ray of the packet can take before one of them leaves the bricks around
// it that are known to be alike; *empty tells whether all those steps are through nothing. Rays that are done do not count.
inline int stretch_ahead(
  global const uchar* bricks, int4 brick_count, real3 p, real3 advance, integer done, int* empty)
{
  const integer bx = min(to_integer(p.x * (real)(1.0f / BRICK)), brick_count.x - 1);
  const integer by = min(to_integer(p.y * (real)(1.0f / BRICK)), brick_count.y - 1);
  const integer bz = min(to_integer(p.z * (real)(1.0f / BRICK)), brick_count.z - 1);
  const integer brick = (bz * brick_count.y + by) * brick_count.x + bx;
#define DISTANCE(n) LANE(distance, n) = bricks[LANE(brick, n)];
  integer distance;
  EACH_LANE(DISTANCE)
#undef DISTANCE
  const integer reach = distance > 0 ? distance - 1 : 0;
#define STEPS_LEFT(b, c)                                                                                                 \
  ((to_real(advance.c > (real)0.0f ? (b + reach + 1) * BRICK : (b - reach) * BRICK) - p.c) / at_least_tiny(advance.c))
  const real steps = lesser(lesser(STEPS_LEFT(bx, x), STEPS_LEFT(by, y)), STEPS_LEFT(bz, z));
#undef STEPS_LEFT
  *empty = all_lanes(done | (distance > 0));
  return 1 + (int)lesser(greater(least_lane(done ? (real)1e6f : steps), 0.0f), 1e6f);
}
