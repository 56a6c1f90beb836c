// March of rays that bend where the refractive index n varies.
//
// With dt = ds / n, s the path length, a ray obeys dr/dt = T, dT/dt = grad(n^2) / 2, |T| = n, as photons do. The
// integrator is a leapfrog (numerics.md, Eq. (91)) that reads the gradient at the midpoint of each step. Where the
// index is constant, steps are straight and the gradient is not read.

#pragma once
#include "Viewing/Rays/RayPackets.cl"

// Whether, and how, a surface reflects rays (OpticsInfo)
#define SURFACE(s) ((s)->o->limits.w)

#if BENDS
// Fresnel reflectance for unpolarised light from a medium of squared index n1 into one of squared index n2
// (numerics.md, Eq. (110)).
//   across  (n sin(theta))^2, theta the angle to the surface's normal
inline real fresnel(real n1, real n2, real across)
{
  const real in = sqrt(greater(n1 - across, (real)0.0f)); // n cos(theta) in the first medium, whose squared index is n1
  const real out = sqrt(greater(n2 - across, (real)0.0f));
  const real s = (in - out) / greater(in + out, (real)1e-20f);
  const real p = fma(n2, in, -n1 * out) / greater(fma(n2, in, n1 * out), (real)1e-20f);
  return (real)0.5f * fma(s, s, p * p);
}

// A leapfrog step that crosses the reflecting surface (where n rises through surfaceIndex): its midpoint, the velocity
// in its first half, half its duration, and the time since the midpoint of the previous step.
typedef struct
{
  real3 middle, velocity;
  real halfTime, since;
} met_step;

// Time between the moment at which the rays meet the reflecting surface and the step's midpoint, found by bisection.
inline real time_since_surface(const surroundings* s, const met_step* step)
{
  // Bisection bounds: the refractive index is below that of the surface at `outer`, and at least that of the surface at
  // `inner`.
  real outer = step->halfTime + step->since;
  real inner = (real)0.0f;
  real3 bend;
  for (int n = 0; n < s->o->limits.z; ++n)
  {
    const real between = (real)0.5f * (outer + inner);
    const real square = index_at(s, kept_within(further(step->middle, -between, step->velocity), s->v->size), &bend);
    const integer below = square < (real)s->o->surface.x;
    outer = below ? between : outer;
    inner = below ? inner : between;
  }
  return (real)0.5f * (outer + inner);
}

// Reflectance of the surface where rays meet it.
//   at       points on the surface, voxels
//   t        velocities of the rays there, world coordinates
//   normal   unit normals of the surface, world coordinates
//   inwards  component of t along the normal
inline real reflectance(const surroundings* s, real3 at, real3 t, real3 normal, real inwards)
{
  if (SURFACE(s) != 1)
  {
    return (real)s->o->surface.y;
  }
  const real3 steps = stretched(normal, s->v->inverseSpacing);
  const real away = (real)s->o->surface.z / sqrt(greater(product(steps, steps), (real)1e-30f));
  real3 unused;
  const real n1 = index_at(s, kept_within(further(at, -away, steps), s->v->size), &unused);
  const real n2 = index_at(s, kept_within(further(at, away, steps), s->v->size), &unused);
  const real across = fma(-inwards, inwards, product(t, t));
  return fresnel(lesser(n1, (real)s->o->surface.x), greater(n2, (real)s->o->surface.x), across);
}

// Splits the rays `meets`, which meet the reflecting surface in this step, into a transmitted and a reflected part. The
// transmittance is known at the step's start only, and the surface lies somewhat before or behind this point. The
// medium in between attenuates both parts or one of them.
inline void split_at_surface(
  const surroundings* s, const met_step* step, integer meets, light* l, crossed* half_way, waiting* reflected)
{
  const int4 size = s->v->size;
  const float4 spacing = s->o->spacing;
  const real before = time_since_surface(s, step);
  real3 bend;
  const real3 at = kept_within(further(step->middle, -before, step->velocity), size);
  index_at(s, at, &bend);

  // Velocity and gradient of n^2 at the surface, in world coordinates.
  const real after_start = step->halfTime - before;
  const real3 t = stretched(further(step->velocity, after_start, bend), spacing);
  const real3 gradient = stretched(bend, spacing);
  const real scale = (real)1.0f / sqrt(greater(product(gradient, gradient), (real)1e-30f));
  const real3 normal = { gradient.x * scale, gradient.y * scale, gradient.z * scale };
  const real inwards = product(t, normal);
  const real part = reflectance(s, at, t, normal, inwards);
  const real3 back = further(t, (real)-2.0f * inwards, normal);
  reflected->at = chosen(meets, at, reflected->at);
  reflected->velocity = chosen(meets, stretched(back, s->v->inverseSpacing), reflected->velocity);

  // The medium between the step's start and the surface adds light to the radiance and attenuates the reflected ray.
  corners around;
  corners_of_samples(s, at, &around);
  const real speed = sqrt(product(t, t));
  const real3 towards = { t.x / speed, t.y / speed, t.z / speed };
  const real3 until_there = stretched(step->velocity, spacing);
  const real way = fabs(after_start) * sqrt(product(until_there, until_there));
  const sample there = take_sample(&s->scene, &around, SAMPLES_SIZE(s), towards);
  const real whole = mean_left(*l);
  const integer behind = after_start >= (real)0.0f;
#define SPLIT(sigma, left, later, EACH_SOURCE)                                   \
  {                                                                              \
    const real length = lesser(way, (real)1.0f / greater(sigma, (real)1e-20f));  \
    real remains;                                                                \
    const real weight = cross_length(sigma, length, THIN_STEPS(s->v), &remains); \
    const real at_surface = left * (behind ? remains : (real)1.0f / remains);    \
    const real gained = part * weight * (behind ? left : -at_surface);           \
    EACH_SOURCE                                                                  \
    later = meets ? part * at_surface : later;                                   \
    left = meets ? left * ((real)1.0f - part) : left;                            \
  }
#define GAIN(c) l->radiance.c = meets ? fma(there.source.c, gained, l->radiance.c) : l->radiance.c;
#if COLOURED
  SPLIT(there.sigma.r, l->left.r, reflected->left.r, GAIN(r))
  SPLIT(there.sigma.g, l->left.g, reflected->left.g, GAIN(g))
  SPLIT(there.sigma.b, l->left.b, reflected->left.b, GAIN(b))
#else
  SPLIT(there.sigma, l->left, reflected->left, GAIN(r) GAIN(g) GAIN(b))
#endif
#undef GAIN
#undef SPLIT
  lose_half(meets & (whole > (real)0.5f) & (mean_left(*l) <= (real)0.5f), depth_of(at, s->v, spacing), half_way);
}

// Samples n^2 at the current points of rays that have just started or come from straight steps, since no bent step
// before has sampled it.
//   moves  rays that take the next step; other lanes are not changed
__attribute__((always_inline)) inline void sample_unknown_index(
  const surroundings* s, const ray_packets* t, integer moves, watch* w)
{
  const integer asks = moves & w->forgotten;
  if (any_lane(asks))
  {
    real3 unused;
    const real there = index_at(s, t->at, &unused);
    w->square = asks ? there : w->square;
    w->since = asks ? (real)0.0f : w->since;
    w->forgotten = asks ? (integer)0 : w->forgotten;
  }
}

// Splits the rays that meet the reflecting surface in a bent step (split_at_surface): since the previous sample, their
// n^2 has risen through the value of the surface. Records n^2 for the next step.
//   middle, half_time  the step's midpoint, and half its duration t
//   square             n^2 at the midpoint
//   moves              rays that take the step
__attribute__((always_inline)) inline void detect_surface(const surroundings* s, real3 middle, real half_time,
  real square, const ray_packets* t, integer moves, light* l, crossed* half_way, watch* w)
{
  const integer meets = moves & (w->met == 0) & (w->square < (real)s->o->surface.x) &
    (square >= (real)s->o->surface.x) & (most_left(*l) > (real)s->v->marching.y);
  if (any_lane(meets))
  {
    const met_step step = { middle, t->velocity, half_time, w->since };
    split_at_surface(s, &step, meets, l, half_way, &w->reflected);
    w->met |= meets;
  }
  w->square = moves ? square : w->square;
  w->since = moves ? half_time : w->since;
}
#endif

// Distance to the nearest face of the box, voxels.
inline real room_around(real3 p, int4 size)
{
#define ROOM(c) lesser(p.c, (real)(float)size.c - p.c)
  return lesser(lesser(ROOM(x), ROOM(y)), ROOM(z));
#undef ROOM
}

// Marks rays that have reached a face of the box at the end of their step as outside the box.
//   last     rays whose step ends at a face
//   returns  the rays that have left
inline integer leave(ray_packets* t, integer last, int4 size)
{
  const real to_go = time_to_face(t->at, t->velocity, size) * sqrt(product(t->velocity, t->velocity));
  const integer gone = last & (to_go < (real)1e-3f);
  t->inside = gone ? (integer)0 : t->inside;
  return gone;
}

#if ROUNDS
#define FETCH_AHEAD(s, p) fetch_ahead((s)->scene.samples, in_block(s, p), SAMPLES_SIZE(s));
#else
#define FETCH_AHEAD(s, p)                      \
  fetch_ahead((s)->bending, p, INDEX_SIZE(s)); \
  fetch_ahead((s)->scene.samples, p, SAMPLES_SIZE(s));
#endif

#if BENDS
// Shortens a bent step so that it ends where a ray reaches a face of the box or an opaque surface.
//   moves      rays that take the step
//   may_leave  whether any ray can reach a face of the box
//   time       duration t of the step for each ray; replaced
//   last       receives the rays whose step ends at a face
//   returns    the rays whose step ends at an opaque surface
__attribute__((always_inline)) inline integer shorten_step(
  const surroundings* s, const ray_packets* t, integer moves, int may_leave, real* time, integer* last)
{
  *last = (integer)0;
  if (may_leave)
  {
    const real until = time_to_face(t->at, t->velocity, s->v->size);
    *last = moves & (until <= *time);
    *time = lesser(*time, until);
  }
  integer stops = (integer)0;
  if (s->v->has.x)
  {
    const real to_end = time_to_end(t, t->velocity, s);
    stops = moves & (to_end <= *time);
    *time = lesser(*time, to_end);
  }
  return stops;
}

// Marks the rays that end with this bent step, at a face of the box (leave) or at an opaque surface.
//   last, stops  rays whose step ends at a face, and at an opaque surface, see shorten_step
//   returns      those of the rays `moves` that take another step
__attribute__((always_inline)) inline integer end_step(
  const surroundings* s, integer moves, int may_leave, integer last, integer stops, ray_packets* t)
{
  if (may_leave)
  {
    moves = leave(t, last, s->v->size) ? (integer)0 : moves;
  }
  if (s->v->has.x)
  {
    t->inside = stops ? (integer)0 : t->inside;
    t->stopped |= stops;
    moves = stops ? (integer)0 : moves;
  }
  return moves;
}

// Takes a few leapfrog steps along bent rays. Samples outside the box are never read.
//   done  rays that have ended and are not moved
__attribute__((always_inline)) inline void bend(
  const surroundings* s, integer done, ray_packets* t, light* l, crossed* half_way, watch* w)
{
  const int4 size = s->v->size;
  const float4 spacing = s->o->spacing;
  const float stride = s->v->marching.x;
  const int steps = s->o->limits.y;
  integer moves = done == 0;
  // Rays are tested against the faces of the box only if one of them can reach a face within these steps.
  const int may_leave = any_lane(moves & (room_around(t->at, size) < (real)(stride * (float)(steps + 1) + 1.0f)));
  if (SURFACE(s))
  {
    sample_unknown_index(s, t, moves, w);
  }
  real start = depth_of(t->at, s->v, spacing);
  for (int n = 0; n < steps; ++n)
  {
#if ROUNDS
    moves &= is_own(s, middle_of_next(s, t));
    if (!any_lane(moves))
    {
      break;
    }
    t->steps += moves ? (integer)1 : (integer)0;
#endif
    const real per_voxel = (real)1.0f / sqrt(greater(product(t->velocity, t->velocity), (real)1e-30f));
    real time = moves ? (real)stride * per_voxel : (real)0.0f;
    const real3 soon = further(t->at, (real)5.0f * per_voxel, t->velocity);
    FETCH_AHEAD(s, soon)
    integer last;
    const integer stops = shorten_step(s, t, moves, may_leave, &time, &last);
    const real half_time = (real)0.5f * time;
    const real3 middle = kept_within(further(t->at, half_time, t->velocity), size);
    corners around;
    corners_of_index(s, middle, &around);
    rgb xyz;
    real square;
    gather(s->bending, &around, INDEX_SIZE(s), &xyz, &square);
    const real3 turn = { xyz.r, xyz.g, xyz.b };
    if (SURFACE(s))
    {
      detect_surface(s, middle, half_time, square, t, moves, l, half_way, w);
    }
#if ROUNDS
    corners_of_samples(s, middle, &around);
#endif
    const real3 world = stretched(further(t->velocity, half_time, turn), spacing);
    const real pace = sqrt(product(world, world));
    const sample met = take_sample(&s->scene, &around, SAMPLES_SIZE(s), divided(world, greater(pace, (real)1e-20f)));
    t->velocity = further(t->velocity, time, turn);
    t->at = kept_within(further(middle, half_time, t->velocity), size);
    moves = end_step(s, moves, may_leave, last, stops, t);
    const real end = depth_of(t->at, s->v, spacing);
    cross_sample(s->v, met, time * pace, start, end - start, l, half_way);
    start = end;
  }
}
#endif

// Steps through a region of constant index, or skips it if it is empty. Returns the number of steps.
//   packet  the rays from their current positions on
//   ahead   the bricks ahead of the rays
//   leaves  rays that leave the box if they travel the packet's whole length
__attribute__((always_inline)) inline int go_straight(const surroundings* s, const rays* packet, real step,
  stretch ahead, integer done, integer leaves, ray_packets* t, light* l, crossed* half_way)
{
  const int4 size = s->v->size;
  const int steps = max(min(ahead.steps, (int)ceil(most_lanes(packet->length / step))), 1);
  if (!ahead.empty || !s->v->has.w)
  {
    const real soon = step_length(packet->direction, 5.0f);
    const real3 towards = stretched(packet->direction, s->o->spacing);
    const real start = depth_of(t->at, s->v, s->o->spacing);
    const real3 forward = { (real)s->v->forward.x, (real)s->v->forward.y, (real)s->v->forward.z };
    const real slope = product(towards, forward);
    for (int n = 0; n < steps; ++n)
    {
      const real so_far = step * (real)(float)n;
      const real length = lesser(greater(packet->length - so_far, (real)0.0f), step);
      corners at;
      corners_of_samples(s, along(*packet, fma(length, (real)0.5f, so_far)), &at);
      const sample met = take_sample(&s->scene, &at, SAMPLES_SIZE(s), towards);
      fetch_ahead(s->scene.samples, in_block(s, along(*packet, so_far + soon)), SAMPLES_SIZE(s));
      cross_sample(s->v, met, length, fma(so_far, slope, start), length * slope, l, half_way);
    }
  }
  const real end = step * (real)(float)steps;
  t->inside = ((done == 0) & leaves & (end >= packet->length)) ? (integer)0 : t->inside;
  t->at = kept_within(along(*packet, end), size);
#if ROUNDS
  const integer taken = to_integer(lesser(ceil(packet->length / step), (real)(float)steps));
  t->steps += done ? (integer)0 : taken;
#endif
  return steps;
}

// Marches rays until they leave the box, have too little transmittance left, or exceed the maximum number of steps.
__attribute__((always_inline)) inline void march(
  const surroundings* s, ray_packets* t, light* l, crossed* half_way, watch* w)
{
  const ViewInfo* v = s->v;
  const int4 size = v->size;
  const float enough = v->marching.y;
  for (int n = 0; n < s->o->limits.x;)
  {
    integer done = (t->inside == 0) | (most_left(*l) <= (real)enough);
#if ROUNDS
    done |= (t->steps >= (integer)s->o->limits.x) | (is_own(s, middle_of_next(s, t)) == 0);
#endif
    if (all_lanes(done))
    {
      break;
    }
    const real3 world = stretched(t->velocity, s->o->spacing);
    rays packet;
    packet.entry = t->at;
    packet.direction = divided(t->velocity, sqrt(greater(product(world, world), (real)1e-30f)));
    packet.length = done ? (real)0.0f : time_to_face(t->at, packet.direction, size);
    integer stops = (integer)0;
    if (v->has.x)
    {
      const real to_end = time_to_end(t, packet.direction, s);
      stops = (done == 0) & (to_end <= packet.length);
      packet.length = lesser(packet.length, to_end);
    }
    const real step = step_length(packet.direction, v->marching.x);
    integer leaves = (integer)-1;
#if ROUNDS
    const real own = done ? (real)0.0f : own_stretch(s, t->at, packet.direction, step);
    leaves = packet.length <= own;
    packet.length = lesser(packet.length, own);
#endif
    const stretch ahead = stretch_ahead(s->bricks, v->bricks, in_block(s, along(packet, (real)0.5f * step)),
      strides_per_voxel(packet.direction, step), done);
#if BENDS
    if (ahead.bends)
    {
      bend(s, done, t, l, half_way, w);
      n += s->o->limits.y;
      continue;
    }
    w->forgotten = done ? w->forgotten : (integer)-1;
#endif
    n += go_straight(s, &packet, step, ahead, done, leaves, t, l, half_way);
    t->stopped |= stops & (t->inside == 0);
  }
}
