// Rays that bend where the refractive index varies, that a surface of index reflects, and that end on a table.
//
// With dt = ds / n a ray follows dr/dt = T, dT/dt = grad(n^2) / 2, |T| = n (as in Photons/): a leapfrog whose gradient is taken
// in the middle of each step. Where the index is constant that is a straight step, and the gradient is not fetched.
// Along a bent ray L / n^2 is conserved but for what the medium does: sources and backgrounds are divided by n^2 of their place,
// and the picture is multiplied by n^2 where the ray enters.
//
// Needs Numerics.cl, Sampling.cl, View.cl, Background.cl and Crossing.cl before it. Define besides
//   SKIP_BRICKS  1: rays leap over bricks in which nothing extinguishes, shines or bends
//   BENDS        1: the index varies
//   SURFACE      what a surface of index reflects: 0 nothing, 1 as Fresnel's equations have it, 2 a fixed part
//   TABLE        1: a face of the box is a table

#define REACH_OF_TABLE 2e-3f // voxels; what rounding leaves between a ray's end and the face

// Field by field the same as MediumRayCaster.cxx's.
typedef struct
{
  float4 spacing; // length per voxel
  float4 surface; // n^2 of the surface, reflectance, voxels from it to where the indices on its sides are taken
  float4 table;   // diffuse reflectance, mirrored part
  int4 face;      // axis of the table, 1 at the upper end and 0 at the lower, voxels of its longer rows
  float4 flip;    // what the table does to directions
  int4 limits;    // steps of a ray, steps of a bent stretch, halvings of the step in which the surface is met
} optics;

// Where rays are (voxels), how fast (voxels per unit of t) and whether inside of the box.
typedef struct
{
  real3 at, velocity;
  integer inside;
} travellers;

// Rays that are marched later; without light left there are none.
typedef struct
{
  real3 at, velocity;
  spectrum left;
} waiting;

// What each march is given, besides the rays.
typedef struct
{
  const view* v;
  const optics* o;
  scenery scene;
  global const float4* bending; // half the gradient of n^2 by squared spacing (x, y, z), n^2 (w)
  global const char* bricks;
} surroundings;

inline real3 further(real3 p, real t, real3 velocity)
{
  const real3 q = { fma(t, velocity.x, p.x), fma(t, velocity.y, p.y), fma(t, velocity.z, p.z) };
  return q;
}

inline real3 kept_within(real3 p, int4 size)
{
  const real3 q = { within(p.x, size.x), within(p.y, size.y), within(p.z, size.z) };
  return q;
}

inline real3 stretched(real3 p, float4 by)
{
  const real3 q = { p.x * (real)by.x, p.y * (real)by.y, p.z * (real)by.z };
  return q;
}

inline real3 chosen(integer first, real3 a, real3 b)
{
  const real3 c = { first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z };
  return c;
}

// Until each ray that goes straight on leaves the box.
inline real time_to_face(real3 p, real3 velocity, int4 size)
{
  const real3 v = { at_least_tiny(velocity.x), at_least_tiny(velocity.y), at_least_tiny(velocity.z) };
#define TO_FACE(c) (((v.c > (real)0.0f ? (real)(float)size.c : (real)0.0f) - p.c) / v.c)
  return greater(lesser(lesser(TO_FACE(x), TO_FACE(y)), TO_FACE(z)), (real)0.0f);
#undef TO_FACE
}

inline real depth_of(real3 p, const view* v, float4 spacing)
{
  const real3 from_eye = { p.x - (real)v->eye.x, p.y - (real)v->eye.y, p.z - (real)v->eye.z };
  const real3 forward = { (real)(v->forward.x * spacing.x), (real)(v->forward.y * spacing.y),
    (real)(v->forward.z * spacing.z) };
  return product(from_eye, forward);
}

#if BENDS
inline real index_at(const surroundings* s, real3 p, real3* bend)
{
  corners at;
  find_corners(p, s->v->size, &at);
  rgb xyz;
  real square;
  gather(s->bending, &at, s->v->size, &xyz, &square);
  bend->x = xyz.r;
  bend->y = xyz.g;
  bend->z = xyz.b;
  return square;
}
#endif

#if SURFACE
// Unpolarised light from an index of square n1 to one of n2, the square of n sin(theta) being `across`.
inline real fresnel(real n1, real n2, real across)
{
  const real in = sqrt(greater(n1 - across, (real)0.0f));   // n cos(theta)
  const real out = sqrt(greater(n2 - across, (real)0.0f));
  const real s = (in - out) / greater(in + out, (real)1e-20f);
  const real p = fma(n2, in, -n1 * out) / greater(fma(n2, in, n1 * out), (real)1e-20f);
  return (real)0.5f * fma(s, s, p * p);
}

// The last step's middle and velocity until there, half its time, and the time from the middle before.
typedef struct
{
  real3 middle, velocity;
  real half_time, since;
} met_step;

// Splits the rays that meet the surface in this step (`meets`). Light is known where the step starts; the surface lies a little
// before or behind that: what the medium does between the two belongs to both parts or to one.
inline void split_at_surface(
  const surroundings* s, const met_step* step, integer meets, light* l, crossed* half_way, waiting* reflected)
{
  const int4 size = s->v->size;
  const float4 spacing = s->o->spacing;
  // Times before the middle: `outer` where the index is below the surface's, `inner` where it is not.
  real outer = step->half_time + step->since;
  real inner = (real)0.0f;
  real3 bend;
  for (int n = 0; n < s->o->limits.z; ++n)
  {
    const real between = (real)0.5f * (outer + inner);
    const real square = index_at(s, kept_within(further(step->middle, -between, step->velocity), size), &bend);
    const integer below = square < (real)s->o->surface.x;
    outer = below ? between : outer;
    inner = below ? inner : between;
  }
  const real before = (real)0.5f * (outer + inner);
  const real3 at = kept_within(further(step->middle, -before, step->velocity), size);
  index_at(s, at, &bend);

  // Directions in the world.
  const real after_start = step->half_time - before;
  const real3 t = stretched(further(step->velocity, after_start, bend), spacing);
  const real3 gradient = stretched(bend, spacing);
  const real scale = (real)1.0f / sqrt(greater(product(gradient, gradient), (real)1e-30f));
  const real3 normal = { gradient.x * scale, gradient.y * scale, gradient.z * scale };
  const real inwards = product(t, normal);
#if SURFACE == 1
  const real3 steps = stretched(normal, s->v->inverse_spacing);
  const real away = (real)s->o->surface.z / sqrt(greater(product(steps, steps), (real)1e-30f));
  real3 unused;
  const real n1 = index_at(s, kept_within(further(at, -away, steps), size), &unused);
  const real n2 = index_at(s, kept_within(further(at, away, steps), size), &unused);
  const real across = fma(-inwards, inwards, product(t, t));
  const real part = fresnel(lesser(n1, (real)s->o->surface.x), greater(n2, (real)s->o->surface.x), across);
#else
  const real part = (real)s->o->surface.y;
#endif
  const real3 back = further(t, (real)-2.0f * inwards, normal);
  reflected->at = chosen(meets, at, reflected->at);
  reflected->velocity = chosen(meets, stretched(back, s->v->inverse_spacing), reflected->velocity);

  // Light.
  corners around;
  find_corners(at, size, &around);
  const real speed = sqrt(product(t, t));
  const real3 towards = { t.x / speed, t.y / speed, t.z / speed };
  const real3 until_there = stretched(step->velocity, spacing);
  const real way = fabs(after_start) * sqrt(product(until_there, until_there));
  const sample there = take_sample(&s->scene, &around, size, towards);
  const real whole = mean_left(*l);
  const integer behind = after_start >= (real)0.0f;
#define SPLIT(sigma, left, later, EACH_SOURCE)                                                                           \
  {                                                                                                                      \
    const real length = lesser(way, (real)1.0f / greater(sigma, (real)1e-20f));                                          \
    real remains;                                                                                                        \
    const real weight = cross_length(sigma, length, &remains);                                                           \
    const real at_surface = left * (behind ? remains : (real)1.0f / remains);                                            \
    const real gained = part * weight * (behind ? left : -at_surface);                                                   \
    EACH_SOURCE                                                                                                          \
    later = meets ? part * at_surface : later;                                                                           \
    left = meets ? left * ((real)1.0f - part) : left;                                                                    \
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
  const integer halved = meets & (whole > (real)0.5f) & (mean_left(*l) <= (real)0.5f);
  half_way->start = halved ? depth_of(at, s->v, spacing) : half_way->start;
  half_way->length = halved ? (real)0.0f : half_way->length;
  half_way->before = halved ? (real)1.0f : half_way->before;
  half_way->after = halved ? (real)0.0f : half_way->after;
}

// What a primary ray remembers of n^2, so that it sees where it meets the surface.
typedef struct
{
  integer met;  // it did
  real square;  // n^2 in the middle of the last bent step
  real since;   // time since then
  int forgotten; // n^2 is to be asked for first
} watch;
#endif

#if BENDS
// A few steps by the leapfrog.
__attribute__((always_inline)) inline void bend(const surroundings* s, integer done, travellers* t, light* l,
  crossed* half_way
#if SURFACE
  ,
  watch* w, waiting* reflected
#endif
)
{
  const int4 size = s->v->size;
  const float4 spacing = s->o->spacing;
  const float stride = s->v->marching.x;
  const float enough = s->v->marching.y;
  const int steps = s->o->limits.y;
  integer moves = done == 0;
  // Most stretches lie so far inside that nothing can leave.
  const real room_x = lesser(t->at.x, (real)(float)size.x - t->at.x);
  const real room_y = lesser(t->at.y, (real)(float)size.y - t->at.y);
  const real room_z = lesser(t->at.z, (real)(float)size.z - t->at.z);
  const real room = lesser(lesser(room_x, room_y), room_z);
  const int may_leave = any_lane(moves & (room < (real)(stride * (float)(steps + 1) + 1.0f)));
#if SURFACE
  if (w->forgotten)
  {
    real3 unused;
    w->square = index_at(s, t->at, &unused);
    w->since = (real)0.0f;
    w->forgotten = 0;
  }
#endif
  real start = depth_of(t->at, s->v, spacing);
  for (int n = 0; n < steps; ++n)
  {
    const real per_voxel = (real)1.0f / sqrt(greater(product(t->velocity, t->velocity), (real)1e-30f));
    real time = moves ? (real)stride * per_voxel : (real)0.0f;
    const real3 soon = further(t->at, (real)5.0f * per_voxel, t->velocity);
    fetch_ahead(s->bending, soon, size);
    fetch_ahead(s->scene.samples, soon, size);
    integer last = (integer)0;
    if (may_leave)
    {
      const real until = time_to_face(t->at, t->velocity, size);
      last = moves & (until <= time);
      time = lesser(time, until);
    }
    const real half_time = (real)0.5f * time;
    const real3 middle = further(t->at, half_time, t->velocity);
    corners around;
    find_corners(middle, size, &around);
    rgb xyz;
    real square;
    gather(s->bending, &around, size, &xyz, &square);
    const real3 turn = { xyz.r, xyz.g, xyz.b };
#if SURFACE
    const integer meets = moves & (w->met == 0) & (w->square < (real)s->o->surface.x) &
      (square >= (real)s->o->surface.x) & (most_left(*l) > (real)enough);
    if (any_lane(meets))
    {
      const met_step step = { middle, t->velocity, half_time, w->since };
      split_at_surface(s, &step, meets, l, half_way, reflected);
      w->met |= meets;
    }
    w->square = square;
    w->since = half_time;
#endif
    const real3 world = stretched(further(t->velocity, half_time, turn), spacing);
    const real pace = sqrt(product(world, world));
    real3 towards = world;
#if PHASE
    const real inverse = (real)1.0f / greater(pace, (real)1e-20f);
    towards.x *= inverse;
    towards.y *= inverse;
    towards.z *= inverse;
#endif
    const sample met = take_sample(&s->scene, &around, size, towards);
    t->velocity = further(t->velocity, time, turn);
    t->at = further(middle, half_time, t->velocity);
    if (may_leave)
    {
      t->at = kept_within(t->at, size);
      const real to_go = time_to_face(t->at, t->velocity, size) *
        sqrt(product(t->velocity, t->velocity));
      const integer gone = last & (to_go < (real)1e-3f);
      t->inside = gone ? (integer)0 : t->inside;
      moves = gone ? (integer)0 : moves;
    }
    const real end = depth_of(t->at, s->v, spacing);
    cross_sample(met, time * pace, start, end - start, enough, l, half_way);
    start = end;
  }
}
#endif

// Marches rays until they leave the box, have too little light left or have gone round for long.
__attribute__((always_inline)) inline void march(const surroundings* s, travellers* t, light* l, crossed* half_way
#if SURFACE
  ,
  watch* w, waiting* reflected
#endif
)
{
  const view* v = s->v;
  const int4 size = v->size;
  const float enough = v->marching.y;
  for (int n = 0; n < s->o->limits.x;)
  {
    const integer done = (t->inside == 0) | (most_left(*l) <= (real)enough);
    if (all_lanes(done))
    {
      break;
    }
    const real3 world = stretched(t->velocity, s->o->spacing);
    const real slowness = (real)1.0f / sqrt(greater(product(world, world), (real)1e-30f));
    rays packet;
    packet.entry = t->at;
    packet.direction.x = t->velocity.x * slowness;
    packet.direction.y = t->velocity.y * slowness;
    packet.direction.z = t->velocity.z * slowness;
    packet.length = done ? (real)0.0f : time_to_face(t->at, packet.direction, size);
    const real step = step_length(packet.direction, v->marching.x);
    const real soon = step_length(packet.direction, 5.0f);
    const stretch ahead = stretch_ahead(s->bricks, v->bricks, along(packet, (real)0.5f * step),
      strides_per_voxel(packet.direction, step), done);
#if BENDS
    if (ahead.bends)
    {
#if SURFACE
      bend(s, done, t, l, half_way, w, reflected);
#else
      bend(s, done, t, l, half_way);
#endif
      n += s->o->limits.y;
      continue;
    }
#endif
#if SURFACE
    w->forgotten = 1;
#endif
    const int steps = max(min(ahead.steps, (int)ceil(most_lanes(packet.length / step))), 1);
#if SKIP_BRICKS
    if (!ahead.empty)
#endif
    {
      const real3 towards = stretched(packet.direction, s->o->spacing);
      const real start = depth_of(t->at, v, s->o->spacing);
      const real3 forward = { (real)v->forward.x, (real)v->forward.y, (real)v->forward.z };
      const real slope = product(towards, forward);
      for (int m = 0; m < steps; ++m)
      {
        const real so_far = step * (real)(float)m;
        const real length = lesser(greater(packet.length - so_far, (real)0.0f), step);
        corners at;
        find_corners(along(packet, fma(length, (real)0.5f, so_far)), size, &at);
        const sample met = take_sample(&s->scene, &at, size, towards);
        fetch_ahead(s->scene.samples, along(packet, so_far + soon), size);
        cross_sample(met, length, fma(so_far, slope, start), length * slope, enough, l, half_way);
      }
    }
    const real end = step * (real)(float)steps;
    t->inside = ((done == 0) & (end >= packet.length)) ? (integer)0 : t->inside;
    t->at = kept_within(along(packet, end), size);
    n += steps;
  }
}

#if TABLE
// Radiance per reflectance of the table where rays meet it, between voxel centres.
inline rgb table_light(const surroundings* s, global const float4* lit, real3 p)
{
  const int axis = s->o->face.x;
  const int row = s->o->face.z + 2;
  const real x = (axis == 0 ? p.y : p.x) + (real)0.5f;
  const real y = (axis == 2 ? p.y : p.z) + (real)0.5f;
  const integer i = to_integer(x);
  const integer j = to_integer(y);
  const real across = x - to_real(i);
  const real up = y - to_real(j);
  const integer first = j * row + i;
  rgb seen;
#define SEE(n)                                                                                                           \
  {                                                                                                                      \
    global const float4* lower = lit + LANE(first, n);                                                                   \
    global const float4* upper = lower + row;                                                                            \
    const float4 a = fma((float4)LANE(across, n), lower[1] - lower[0], lower[0]);                                        \
    const float4 b = fma((float4)LANE(across, n), upper[1] - upper[0], upper[0]);                                        \
    const float4 c = fma((float4)LANE(up, n), b - a, a);                                                                 \
    LANE(seen.r, n) = c.x;                                                                                               \
    LANE(seen.g, n) = c.y;                                                                                               \
    LANE(seen.b, n) = c.z;                                                                                               \
  }
  EACH_LANE(SEE)
#undef SEE
  return seen;
}

// Rays that leave the box through the table.
inline integer meet_table(const surroundings* s, const travellers* t, integer left_box)
{
  const int axis = s->o->face.x;
  const real sign = (real)(s->o->face.y ? 1.0f : -1.0f);
  const real place = axis == 0 ? t->at.x : axis == 1 ? t->at.y : t->at.z;
  const real heading = axis == 0 ? t->velocity.x : axis == 1 ? t->velocity.y : t->velocity.z;
  const float face = s->o->face.y ? (float)(axis == 0 ? s->v->size.x : axis == 1 ? s->v->size.y : s->v->size.z) : 0.0f;
  return left_box & (fabs(place - (real)face) < (real)REACH_OF_TABLE) & (heading * sign > (real)0.0f);
}
#endif

#define PASSES (1 + (SURFACE > 0) + TABLE)

// lit      irradiance by pi and n^2 on the table, a float4 a voxel with a border
// bending  see surroundings
kernel void cast_bent_rays(view v, optics o, global const float4* restrict samples,
  global const float4* restrict extinctions, global const float4* restrict flow, global const float4* restrict glow,
  global const float4* restrict bending, global const float4* restrict lit, global const char* restrict bricks,
  global const float4* restrict environment, global float* restrict radiance, global float* restrict alpha,
  global float* restrict depth)
{
  const int column = get_global_id(0) * PACKET_WIDTH;
  const int row = (get_global_id(1) + v.picture.z) * PACKET_HEIGHT;
  if (column >= v.picture.x || row >= v.picture.y)
  {
    return;
  }
  const surroundings s = { &v, &o, { samples, extinctions, flow, glow }, bending, bricks };
  const camera_rays seen = rays_through(&v, column, row);
  const real3 direction = stretched(seen.d, v.inverse_spacing);
  real before;
  const rays packet = clip_to_box(seen.from, direction, (real)1e30f, v.size, &before);

  travellers t = { packet.entry, direction, packet.length > (real)0.0f };
  real entry_square = (real)1.0f;
#if BENDS
  real3 unused;
  entry_square = index_at(&s, t.at, &unused);
  entry_square = t.inside ? entry_square : (real)1.0f;
  const real index = sqrt(entry_square);
  t.velocity.x *= index;
  t.velocity.y *= index;
  t.velocity.z *= index;
#endif
  light l = unlit((real)1.0f);
  crossed half_way = { (real)0.0f, (real)0.0f, (real)1.0f, (real)1.0f };
  real left = (real)1.0f;                  // of primary rays
  real where = (real)v.marching.z;
#if SURFACE
  watch w = { (integer)0, (real)0.0f, (real)0.0f, 1 };
  waiting reflected = { t.at, t.velocity, unlit((real)0.0f).left };
#endif
#if TABLE
  waiting on_table = { t.at, t.velocity, unlit((real)0.0f).left };
#endif
  for (int pass = 0; pass < PASSES; ++pass)
  {
    integer enters = t.inside;
    if (pass > 0)
    {
#if SURFACE && TABLE
      const int second = pass == 1;
      l.left = second ? reflected.left : on_table.left;
      t.at = second ? reflected.at : on_table.at;
      t.velocity = second ? reflected.velocity : on_table.velocity;
#elif SURFACE
      l.left = reflected.left;
      t.at = reflected.at;
      t.velocity = reflected.velocity;
#elif TABLE
      l.left = on_table.left;
      t.at = on_table.at;
      t.velocity = on_table.velocity;
#endif
      enters = most_left(l) > (real)0.0f;
      if (!any_lane(enters))
      {
        continue;
      }
      t.inside = enters;
#if SURFACE
      w.met = (integer)-1;
#endif
    }
#if SURFACE
    march(&s, &t, &l, &half_way, &w, &reflected);
#else
    march(&s, &t, &l, &half_way);
#endif

    // What is behind.
    const real3 world = stretched(t.velocity, o.spacing);
    const real slowness = (real)1.0f / sqrt(greater(product(world, world), (real)1e-30f));
    real3 towards = { world.x * slowness, world.y * slowness, world.z * slowness };
    real part = (real)1.0f;
    real square = entry_square;
#if BENDS
    real3 unused;
    square = index_at(&s, t.at, &unused);
    square = (enters & (t.inside == 0)) ? square : entry_square;
#endif
    real through = mean_left(l);
#if TABLE
    const integer ends = meet_table(&s, &t, enters & (t.inside == 0));
    if (any_lane(ends))
    {
      rgb shine = table_light(&s, lit, t.at);
      shine.r *= (real)o.table.x;
      shine.g *= (real)o.table.y;
      shine.b *= (real)o.table.z;
      add_background(shine, ends ? (real)1.0f : (real)0.0f, &l);
      towards = chosen(ends, stretched(towards, o.flip), towards);
      part = ends ? (real)o.table.w : part;
      if (pass == 0)
      {
        on_table.at = t.at;
        on_table.velocity = stretched(t.velocity, o.flip);
        on_table.left = scaled(l.left, ends ? part : (real)0.0f);
        part = ends ? (real)0.0f : part;
        const integer seen_table = ends & (through > (real)0.5f);
        half_way.start = seen_table ? depth_of(t.at, &v, o.spacing) : half_way.start;
        half_way.length = seen_table ? (real)0.0f : half_way.length;
        half_way.after = seen_table ? (real)0.0f : half_way.after;
        through = ends ? (real)0.0f : through;
      }
    }
#endif
    if (pass == 0)
    {
      left = through;
      where = left > (real)0.5f ? (real)v.marching.z : distance_to_half(half_way);
    }
    add_background(look_behind(&v, towards, environment), part * (real)v.background.w / square, &l);
  }

  l.radiance.r *= entry_square;
  l.radiance.g *= entry_square;
  l.radiance.b *= entry_square;
  const canvas picture = { radiance, alpha, depth };
  paint(&v, picture, column, row, l.radiance, (real)1.0f - left, where);
}
