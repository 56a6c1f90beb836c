// Marches rays through one block of a larger grid, each to the block's boundary. The rays may bend, be reflected by a
// surface or be mirrored by a table. The block that contains the midpoint of a step computes this step. Likewise, the
// blocks that contain the entry point and the exit point compute the ray's entry into the domain and its exit.
// Positions are in voxels of the whole grid, so that the results equal those of a serial run.
//
// Macros set by the host:
//   ROUNDS  1

#include "Viewing/Rays/Arrival.cl"
#include "Viewing/Rays/BentRays.cl"
#include "Viewing/Rays/View.cl"
#include "Viewing/Samples/Sampling.cl"

// Largest number of rays that one ray splits off: one by the surface, one by the table.
#define BORN(s) ((SURFACE(s) > 0) + (s)->o->face.w)

// Initialises the state of a ray that is created in this block; the caller sets `pixel`, `where`, `at`, `velocity` and
// `left`.
inline void set_off(__global RayOnItsWay* ray, int kind, int state, int met, float entry_square, float far_depth)
{
  ray->kind = kind;
  ray->state = state;
  ray->steps = 0;
  ray->met = met;
  ray->radiance[0] = ray->radiance[1] = ray->radiance[2] = 0.0f;
  ray->halfWay[0] = ray->halfWay[1] = 0.0f;
  ray->halfWay[2] = ray->halfWay[3] = 1.0f;
  ray->square = 0.0f;
  ray->since = -1.0f;
  ray->entrySquare = entry_square;
  ray->seen = 1.0f;
  ray->depth = far_depth;
}

// STORE_TRIPLE stores the components of lane n of a real3 in an array member of a ray; LOAD_TRIPLE loads them from it.
#define STORE_TRIPLE(array, from, n) \
  ray->array[0] = LANE((from).x, n); \
  ray->array[1] = LANE((from).y, n); \
  ray->array[2] = LANE((from).z, n);
#define LOAD_TRIPLE(to, array, n)  \
  LANE((to).x, n) = ray->array[0]; \
  LANE((to).y, n) = ray->array[1]; \
  LANE((to).z, n) = ray->array[2];
#define STORE_VOXEL(from, n)              \
  ray->where[0] = (int)LANE((from).x, n); \
  ray->where[1] = (int)LANE((from).y, n); \
  ray->where[2] = (int)LANE((from).z, n);

// Creates the rays through pixels that enter the domain in this block, and those that miss the domain if this block
// shows the background. One work-item per packet of pixels, in rows from pass.view.picture.z on.
//   rays  one per pixel of these rows; `pixel` is -1 where no ray is created
__kernel void start_rays(RayPass pass, __global const float4* restrict bending, __global RayOnItsWay* restrict rays)
{
  const ViewInfo* v = &pass.view;
  const OpticsInfo* o = &pass.optics;
  const int column = get_global_id(0) * PACKET_WIDTH;
  const int row = get_global_id(1) * PACKET_HEIGHT + v->picture.z;
  if (column >= v->picture.x || row >= v->picture.y)
  {
    return;
  }
  const surroundings s = { v, o, { 0, 0, 0, 0, 0, 0, v->phase }, bending, 0 };
  real entry_square;
  const ray_packets t = enter(&s, rays_through(v, column, row), (real)ENDLESS, &entry_square);
  const integer enters = t.inside != (integer)0;
  const integer own = enters ? is_own(&s, t.at) : (integer)(v->block.first.w != 0 ? -1 : 0);
  const integer pixel = pixels_of(v, column, row), inside = in_picture(v, column, row);
#define START(n)                                                                                                  \
  if (LANE(inside, n))                                                                                            \
  {                                                                                                               \
    __global RayOnItsWay* ray = rays + (LANE(pixel, n) - v->picture.z * v->picture.x);                            \
    ray->pixel = LANE(own, n) ? LANE(pixel, n) : -1;                                                              \
    set_off(ray, RayIsPrimary, LANE(enters, n) ? RayGoesOn : RayMisses, 0, LANE(entry_square, n), v->marching.z); \
    STORE_VOXEL(t.at, n)                                                                                          \
    STORE_TRIPLE(at, t.at, n)                                                                                     \
    STORE_TRIPLE(velocity, t.velocity, n)                                                                         \
    ray->left[0] = ray->left[1] = ray->left[2] = 1.0f;                                                            \
  }
  EACH_LANE(START)
#undef START
}

// State of a packet of rays that are marched through this block.
typedef struct
{
  integer pixel, kind, state;
  ray_packets t;
  crossed half_way;
  watch w;
  seeing to;
} arrivals;

#if COLOURED
#define LOAD_LEFT(n)                     \
  LANE(a.to.l.left.r, n) = ray->left[0]; \
  LANE(a.to.l.left.g, n) = ray->left[1]; \
  LANE(a.to.l.left.b, n) = ray->left[2];
#define STORE_SPECTRUM(s, n)   \
  ray->left[0] = LANE(s.r, n); \
  ray->left[1] = LANE(s.g, n); \
  ray->left[2] = LANE(s.b, n);
#else
#define LOAD_LEFT(n) LANE(a.to.l.left, n) = ray->left[0];
#define STORE_SPECTRUM(s, n) ray->left[0] = ray->left[1] = ray->left[2] = LANE(s, n);
#endif

// Loads a packet of rays from index `first` on. If the packet extends beyond the `count` rays of the array, its excess
// rays count as ended.
inline arrivals load(__global const RayOnItsWay* rays, int first, int count)
{
  arrivals a;
  a.to.l = unlit((real)1.0f);
#define LOAD(n)                                                             \
  {                                                                         \
    __global const RayOnItsWay* ray = rays + min(first + 0x##n, count - 1); \
    LANE(a.pixel, n) = ray->pixel;                                          \
    LANE(a.kind, n) = ray->kind;                                            \
    LANE(a.state, n) = first + 0x##n < count ? ray->state : RayHasEnded;    \
    LOAD_TRIPLE(a.t.at, at, n)                                              \
    LOAD_TRIPLE(a.t.velocity, velocity, n)                                  \
    LANE(a.t.steps, n) = ray->steps;                                        \
    LOAD_LEFT(n)                                                            \
    LANE(a.to.l.radiance.r, n) = ray->radiance[0];                          \
    LANE(a.to.l.radiance.g, n) = ray->radiance[1];                          \
    LANE(a.to.l.radiance.b, n) = ray->radiance[2];                          \
    LANE(a.half_way.start, n) = ray->halfWay[0];                            \
    LANE(a.half_way.length, n) = ray->halfWay[1];                           \
    LANE(a.half_way.before, n) = ray->halfWay[2];                           \
    LANE(a.half_way.after, n) = ray->halfWay[3];                            \
    LANE(a.w.met, n) = ray->met;                                            \
    LANE(a.w.square, n) = ray->square;                                      \
    LANE(a.w.since, n) = ray->since;                                        \
    LANE(a.to.entrySquare, n) = ray->entrySquare;                           \
    LANE(a.to.left, n) = ray->seen;                                         \
    LANE(a.to.depth, n) = ray->depth;                                       \
  }
  EACH_LANE(LOAD)
#undef LOAD
  a.t.inside = a.state == (integer)RayGoesOn;
  a.t.end = (real)ENDLESS;
  a.t.stopped = (integer)0;
  a.w.forgotten = a.w.since < (real)0.0f;
  const waiting nothing = { a.t.at, a.t.velocity, unlit((real)0.0f).left };
  a.w.reflected = a.to.mirrored = nothing;
  return a;
}

// Stores a packet of rays in the elements from which `load` read it.
//   middle  midpoint of the next step, for rays that continue
inline void store(const arrivals* a, real3 middle, __global RayOnItsWay* rays, int first, int count)
{
  const integer goes_on = a->state == (integer)RayGoesOn;
  const real3 where = chosen(goes_on, middle, a->t.at);
#define STORE(n)                                                        \
  if (first + 0x##n < count)                                            \
  {                                                                     \
    __global RayOnItsWay* ray = rays + first + 0x##n;                   \
    ray->state = LANE(a->state, n);                                     \
    ray->steps = LANE(a->t.steps, n);                                   \
    STORE_VOXEL(where, n)                                               \
    ray->met = LANE(a->w.met, n);                                       \
    STORE_TRIPLE(at, a->t.at, n)                                        \
    STORE_TRIPLE(velocity, a->t.velocity, n)                            \
    STORE_SPECTRUM(a->to.l.left, n)                                     \
    ray->radiance[0] = LANE(a->to.l.radiance.r, n);                     \
    ray->radiance[1] = LANE(a->to.l.radiance.g, n);                     \
    ray->radiance[2] = LANE(a->to.l.radiance.b, n);                     \
    ray->halfWay[0] = LANE(a->half_way.start, n);                       \
    ray->halfWay[1] = LANE(a->half_way.length, n);                      \
    ray->halfWay[2] = LANE(a->half_way.before, n);                      \
    ray->halfWay[3] = LANE(a->half_way.after, n);                       \
    ray->square = LANE(a->w.square, n);                                 \
    ray->since = LANE(a->w.forgotten, n) ? -1.0f : LANE(a->w.since, n); \
    ray->seen = LANE(a->to.left, n);                                    \
    ray->depth = LANE(a->to.depth, n);                                  \
  }
  EACH_LANE(STORE)
#undef STORE
}

// Stores the rays that the rays of a packet have split off. `pixel` is -1 if there is none.
//   slot  index among the BORN(s) rays that may be split off each ray
inline void store_born(const surroundings* s, const arrivals* a, const waiting* born, int kind, int slot,
  __global RayOnItsWay* rays, int first, int count)
{
  ray_packets t;
  t.at = born->at;
  t.velocity = born->velocity;
  light l = unlit((real)0.0f);
  l.left = born->left;
  const integer shines = most_left(l) > (real)0.0f;
  const real3 where = middle_of_next(s, &t);
#define STORE(n)                                                                     \
  if (first + 0x##n < count)                                                         \
  {                                                                                  \
    __global RayOnItsWay* ray = rays + BORN(s) * (first + 0x##n) + slot;             \
    ray->pixel = LANE(shines, n) ? LANE(a->pixel, n) : -1;                           \
    set_off(ray, kind, RayGoesOn, -1, LANE(a->to.entrySquare, n), s->v->marching.z); \
    STORE_VOXEL(where, n)                                                            \
    STORE_TRIPLE(at, born->at, n)                                                    \
    STORE_TRIPLE(velocity, born->velocity, n)                                        \
    STORE_SPECTRUM(born->left, n)                                                    \
  }
  EACH_LANE(STORE)
#undef STORE
}

// Marches the rays with indices [range.x, range.y) of pass.view to the block's boundary or to their end. One work-item
// per packet of rays.
//   born  receives the split-off rays, BORN elements per ray (store_born)
__kernel void march_rays(RayPass pass, __global const float4* restrict samples,
  __global const float4* restrict extinctions, __global const float4* restrict flow,
  __global const float4* restrict glow, __global const float4* restrict cosines,
  __global const float* restrict phase_rows, __global const float4* restrict bending,
  __global const char* restrict bricks, __global const float4* restrict backdrop, __global RayOnItsWay* restrict rays,
  __global RayOnItsWay* restrict born)
{
  const ViewInfo* v = &pass.view;
  const OpticsInfo* o = &pass.optics;
  const int own = v->range.x + get_global_id(0) * REAL_WIDTH;
  if (own >= v->range.y)
  {
    return;
  }
  const surroundings s = { v, o, { samples, extinctions, flow, glow, cosines, phase_rows, v->phase }, bending, bricks };
  arrivals a = load(rays, own, v->range.y);
  const integer was_inside = (a.state == (integer)RayGoesOn) | (a.state == (integer)RayIsOut);
  const integer misses = a.state == (integer)RayMisses;
  march(&s, &a.t, &a.to.l, &a.half_way, &a.w);

  const integer spent = a.t.inside & ((most_left(a.to.l) <= (real)v->marching.y) | (a.t.steps >= (integer)o->limits.x));
  const integer out = was_inside & (a.t.inside == 0);
  const integer ends = spent | (out & is_own(&s, a.t.at)) | misses;
  arrive(&s, &a.t, ends, was_inside, a.kind == (integer)RayIsPrimary, backdrop, &a.half_way, &a.to);
  const integer ended = ends | (a.state == (integer)RayHasEnded);
  a.state = ended ? (integer)RayHasEnded : out ? (integer)RayIsOut : (integer)RayGoesOn;
  store(&a, middle_of_next(&s, &a.t), rays, own, v->range.y);
  if (SURFACE(&s))
  {
    store_born(&s, &a, &a.w.reflected, RayIsReflected, 0, born, own, v->range.y);
  }
  if (o->face.w)
  {
    store_born(&s, &a, &a.to.mirrored, RayIsMirrored, BORN(&s) - 1, born, own, v->range.y);
  }
}
