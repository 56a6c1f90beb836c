// Primary rays, one work-item a packet of neighbouring pixels:
//   radiance = integral over the ray of T(t) q(t) dt + T(end) background,  T(t) = exp(-integral of sigma_t)
// with q = sigma_s times in-scattered radiance plus emission, both interpolated between voxel centres.
//
// Needs Numerics.cl and Sampling.cl before it. Define besides
//   SKIP_BRICKS  1: rays leap over bricks in which nothing extinguishes or shines
//   ENVIRONMENT  1: the background is a picture; 0: one colour
//   THIN_STEPS   1: no step's optical length is above 2

// Field by field the same as MediumRayCaster.cxx's.
typedef struct
{
  float4 eye;             // voxels; w: 0 the rays come from one point, 1 they are parallel
  float4 forward;         // unit vector, world
  float4 right;           // to the picture's right edge; of the world at unit distance, or where parallel of the world
  float4 up;              // to its upper edge
  float4 inverse_spacing; // voxels per length
  float4 background;      // W / (length^2 sr), added to the environment; w: 0 nothing is to be seen behind the medium
  float4 marching;        // step in voxels, transmittance at which to stop, depth where nothing is
  int4 picture;           // width, height in pixels, first row of packets
  int4 size;              // voxels
  int4 bricks;            // bricks
  int4 environment;       // width, height in pixels
} view;

// Pixels of a packet.
#if REAL_WIDTH == 16
#define PACKET_WIDTH 4
#define PACKET_HEIGHT 4
#define ACROSS (real)(0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3)
#define UPWARDS (real)(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3)
#elif REAL_WIDTH == 8
#define PACKET_WIDTH 4
#define PACKET_HEIGHT 2
#define ACROSS (real)(0, 1, 2, 3, 0, 1, 2, 3)
#define UPWARDS (real)(0, 0, 0, 0, 1, 1, 1, 1)
#elif REAL_WIDTH == 4
#define PACKET_WIDTH 2
#define PACKET_HEIGHT 2
#define ACROSS (real)(0, 1, 0, 1)
#define UPWARDS (real)(0, 0, 1, 1)
#else
#define PACKET_WIDTH 1
#define PACKET_HEIGHT 1
#define ACROSS 0.0f
#define UPWARDS 0.0f
#endif

#if ENVIRONMENT
// Angle of (x, y) from +x, in [-pi, pi], to 1e-7. PoCL's atan2 is scalar and costs ten times this.
inline real angle_of(real y, real x)
{
  const real ax = fabs(x);
  const real ay = fabs(y);
  const real a = lesser(ax, ay) / greater(greater(ax, ay), (real)1e-30f);
  const real s = a * a;
  real p = fma((real)-0.00466877331f, s, (real)0.0241661895f);
  p = fma(p, s, (real)-0.0593671008f);
  p = fma(p, s, (real)0.099060969f);
  p = fma(p, s, (real)-0.14016585f);
  p = fma(p, s, (real)0.199692354f);
  p = fma(p, s, (real)-0.333319597f);
  p = fma(p, s, (real)0.999999898f) * a;
  p = ay > ax ? (real)M_PI_2_F - p : p;
  p = x < (real)0.0f ? (real)M_PI_F - p : p;
  return copysign(p, y);
}

// Radiance seen along each (world) direction, as Lookup in Lights.h has it. The picture has a column more on both sides,
// so that it closes around z.
inline rgb look_up(global const float4* environment, real3 d, int4 size)
{
  const real polar = angle_of(sqrt(fma(d.x, d.x, d.y * d.y)), d.z);
  real turn = angle_of(d.y, d.x) * (real)(0.5f * M_1_PI_F);
  turn = turn < (real)0.0f ? turn + (real)1.0f : turn;
  const real column = fma(turn, (real)(float)size.x, (real)-0.5f);
  const real row = fma(polar, (real)(-M_1_PI_F * (float)size.y), (real)((float)size.y - 0.5f));
  const real left = floor(column);
  const real below = floor(row);
  const real x = column - left;
  const real y = row - below;
  const integer i = to_integer(lesser(greater(left, (real)-1.0f), (real)(float)(size.x - 1))) + 1;
  const real last = (real)(float)(size.y - 1);
  const integer j0 = to_integer(lesser(greater(below, (real)0.0f), last)) * (size.x + 2) + i;
  const integer j1 = to_integer(lesser(greater(below + (real)1.0f, (real)0.0f), last)) * (size.x + 2) + i;
  rgb seen;
#define SEE(n)                                                                                                           \
  {                                                                                                                      \
    global const float4* lower = environment + LANE(j0, n);                                                              \
    global const float4* upper = environment + LANE(j1, n);                                                              \
    const float4 a = fma((float4)LANE(x, n), lower[1] - lower[0], lower[0]);                                             \
    const float4 b = fma((float4)LANE(x, n), upper[1] - upper[0], upper[0]);                                             \
    const float4 c = fma((float4)LANE(y, n), b - a, a);                                                                  \
    LANE(seen.r, n) = c.x;                                                                                               \
    LANE(seen.g, n) = c.y;                                                                                               \
    LANE(seen.b, n) = c.z;                                                                                               \
  }
  EACH_LANE(SEE)
#undef SEE
  return seen;
}
#endif

// What is left of a ray's light, and what it has gathered.
typedef struct
{
#if COLOURED
  rgb left;
#else
  real left;
#endif
  rgb radiance;
} light;

inline real mean_left(light l)
{
#if COLOURED
  return (l.left.r + l.left.g + l.left.b) * (real)(1.0f / 3.0f);
#else
  return l.left;
#endif
}

inline real most_left(light l)
{
#if COLOURED
  return greater(greater(l.left.r, l.left.g), l.left.b);
#else
  return l.left;
#endif
}

// Over a length of constant coefficients: what a unit of source adds to the radiance, and what is left of the light behind.
//   length (1 - exp(-tau)) / tau; tau = 0 is vacuum, where the fraction is 1.
inline real cross_length(real sigma, real length, real* remains)
{
#if THIN_STEPS
  // (1 - exp(-tau)) / tau on [0, 2], to 1e-7.
  const real tau = sigma * length;
  real p = fma(tau, (real)-1.17129066e-05f, (real)0.000167222737f);
  p = fma(p, tau, (real)-0.00134923449f);
  p = fma(p, tau, (real)0.00830663089f);
  p = fma(p, tau, (real)-0.0416579582f);
  p = fma(p, tau, (real)0.166665584f);
  p = fma(p, tau, (real)-0.49999997f);
  const real fraction = fma(p, tau, (real)1.0f);
  *remains = fma(-tau, fraction, (real)1.0f);
#else
  const real tau = greater(sigma * length, (real)1e-30f);
  const real fraction = extinguished(tau, remains) / tau;
#endif
  return length * fraction;
}

// The step in which half of a ray's light was lost: where it starts, how long it is, and what was left before and after.
typedef struct
{
  real start, length, before, after;
} crossed;

// What is met in one step: where the step starts and how long it is, and the coefficients in its middle.
typedef struct
{
  real start, length;
  rgb source;
#if COLOURED
  rgb sigma;
#else
  real sigma;
#endif
} sample;

__attribute__((always_inline)) inline sample take_sample(rays packet, real step, int n, global const float4* samples, global const float4* extinctions,
  int4 size)
{
  sample s;
  s.start = step * (real)(float)n;
  s.length = lesser(greater(packet.length - s.start, (real)0.0f), step);
  corners at;
  find_corners(along(packet, fma(s.length, (real)0.5f, s.start)), size, &at);
  real grey;
  gather(samples, &at, size, &s.source, &grey);
#if COLOURED
  real unused;
  gather(extinctions, &at, size, &s.sigma, &unused);
#else
  s.sigma = grey;
#endif
  return s;
}

// Rays that have less light left than `enough` stop. Nothing but the last product waits for what was left before.
__attribute__((always_inline)) inline void cross_sample(sample s, float enough, light* l, crossed* half_way)
{
  const integer goes_on = most_left(*l) > (real)enough;
  const real before = mean_left(*l);
#if COLOURED
#define CROSS(c)                                                                                                         \
  {                                                                                                                      \
    real remains;                                                                                                        \
    const real weight = cross_length(s.sigma.c, s.length, &remains);                                                     \
    l->radiance.c = fma(s.source.c * weight, goes_on ? l->left.c : (real)0.0f, l->radiance.c);                           \
    l->left.c *= goes_on ? remains : (real)1.0f;                                                                         \
  }
  CROSS(r)
  CROSS(g)
  CROSS(b)
#undef CROSS
#else
  real remains;
  const real weight = cross_length(s.sigma, s.length, &remains) * l->left;
  l->radiance.r = goes_on ? fma(s.source.r, weight, l->radiance.r) : l->radiance.r;
  l->radiance.g = goes_on ? fma(s.source.g, weight, l->radiance.g) : l->radiance.g;
  l->radiance.b = goes_on ? fma(s.source.b, weight, l->radiance.b) : l->radiance.b;
  l->left = goes_on ? l->left * remains : l->left;
#endif
  const real after = mean_left(*l);
  const integer crossing = (before > (real)0.5f) & (after <= (real)0.5f);
  half_way->start = crossing ? s.start : half_way->start;
  half_way->length = crossing ? s.length : half_way->length;
  half_way->before = crossing ? before : half_way->before;
  half_way->after = crossing ? after : half_way->after;
}

// ln(a/b) = 2 (a-b)/(a+b) but for the third order.
inline real distance_to_half(crossed c)
{
  const real part = (c.before - (real)0.5f) * (c.before + c.after) /
    ((c.before + (real)0.5f) * greater(c.before - c.after, (real)1e-30f));
  return fma(part, c.length, c.start);
}

// samples      red, green, blue of q, W / (length^3 sr), and grey sigma_t, 1/length
// extinctions  coloured sigma_t
// radiance     3 a pixel, W / (length^2 sr)
// alpha        1 - mean transmittance
// depth        where the mean transmittance falls to a half, along the view axis
kernel void cast_rays(view v, global const float4* restrict samples, global const float4* restrict extinctions,
  global const char* restrict bricks, global const float4* restrict environment, global float* restrict radiance,
  global float* restrict alpha, global float* restrict depth)
{
  // The rays.
  const int column = get_global_id(0) * PACKET_WIDTH;
  const int row = (get_global_id(1) + v.picture.z) * PACKET_HEIGHT;
  if (column >= v.picture.x || row >= v.picture.y)
  {
    return;
  }
  const real i = (real)(float)column + ACROSS;
  const real j = (real)(float)row + UPWARDS;
  const real x = (i + (real)0.5f) * (real)(2.0f / (float)v.picture.x) - (real)1.0f;
  const real y = (j + (real)0.5f) * (real)(2.0f / (float)v.picture.y) - (real)1.0f;
  const real3 offset = { fma(x, (real)v.right.x, y * (real)v.up.x), fma(x, (real)v.right.y, y * (real)v.up.y),
    fma(x, (real)v.right.z, y * (real)v.up.z) };
  const real spread = (real)(1.0f - v.eye.w);
  real3 d = { fma(spread, offset.x, (real)v.forward.x), fma(spread, offset.y, (real)v.forward.y),
    fma(spread, offset.z, (real)v.forward.z) };
  const real cosine = (real)1.0f / sqrt(fma(d.x, d.x, fma(d.y, d.y, d.z * d.z)));
  d.x *= cosine;
  d.y *= cosine;
  d.z *= cosine;
  const real3 from = { fma((real)(v.eye.w * v.inverse_spacing.x), offset.x, (real)v.eye.x),
    fma((real)(v.eye.w * v.inverse_spacing.y), offset.y, (real)v.eye.y),
    fma((real)(v.eye.w * v.inverse_spacing.z), offset.z, (real)v.eye.z) };
  const real3 direction = { d.x * (real)v.inverse_spacing.x, d.y * (real)v.inverse_spacing.y,
    d.z * (real)v.inverse_spacing.z };
  real before;
  const rays packet = clip_to_box(from, direction, (real)1e30f, v.size, &before);

  // The march.
  const real step = step_length(direction, v.marching.x);
  const real soon = step_length(direction, 5.0f);
  const int steps = (int)ceil(most_lanes(packet.length / step));
#if SKIP_BRICKS
  const real3 strides = strides_per_voxel(direction, step);
#endif
  light l;
#if COLOURED
  l.left.r = l.left.g = l.left.b = (real)1.0f;
#else
  l.left = (real)1.0f;
#endif
  l.radiance.r = l.radiance.g = l.radiance.b = (real)0.0f;
  crossed half_way = { (real)0.0f, (real)0.0f, (real)1.0f, (real)1.0f };
  for (int n = 0; n < steps;)
  {
    int stop = steps;
    const real so_far = step * (real)(float)n;
    const integer done = (so_far >= packet.length) | (most_left(l) <= (real)v.marching.y);
    if (all_lanes(done))
    {
      break;
    }
#if SKIP_BRICKS
    int empty;
    const real3 ahead = along(packet, fma(step, (real)0.5f, so_far));
    stop = n + stretch_ahead(bricks, v.bricks, ahead, strides, done, &empty);
    if (empty)
    {
      n = stop;
      continue;
    }
    stop = min(stop, steps);
#else
    stop = min(n + BRICK, steps);
#endif
    for (; n < stop; ++n)
    {
      // What is sampled does not depend on how much light is left, so that the next sample overlaps this one.
      const sample s = take_sample(packet, step, n, samples, extinctions, v.size);
      fetch_ahead(samples, along(packet, s.start + soon), v.size);
      cross_sample(s, v.marching.y, &l, &half_way);
    }
  }

  // What is behind, and the picture.
  const real left = mean_left(l);
  rgb behind = { (real)v.background.x, (real)v.background.y, (real)v.background.z };
#if ENVIRONMENT
  const rgb seen = look_up(environment, d, v.environment);
  behind.r += seen.r;
  behind.g += seen.g;
  behind.b += seen.b;
#endif
#if COLOURED
  behind.r *= l.left.r * (real)v.background.w;
  behind.g *= l.left.g * (real)v.background.w;
  behind.b *= l.left.b * (real)v.background.w;
#else
  behind.r *= left * (real)v.background.w;
  behind.g *= left * (real)v.background.w;
  behind.b *= left * (real)v.background.w;
#endif
  l.radiance.r += behind.r;
  l.radiance.g += behind.g;
  l.radiance.b += behind.b;
  const real opaque = (real)1.0f - left;
  const real where = left > (real)0.5f ? (real)v.marching.z : (distance_to_half(half_way) + before) * cosine;
  const integer pixel = (integer)(row * v.picture.x + column) + to_integer(UPWARDS) * v.picture.x + to_integer(ACROSS);
  const integer inside = (i < (real)(float)v.picture.x) & (j < (real)(float)v.picture.y);
#define PAINT(n)                                                                                                         \
  if (LANE(inside, n))                                                                                                   \
  {                                                                                                                      \
    const int p = LANE(pixel, n);                                                                                        \
    radiance[3 * p] = LANE(l.radiance.r, n);                                                                             \
    radiance[3 * p + 1] = LANE(l.radiance.g, n);                                                                         \
    radiance[3 * p + 2] = LANE(l.radiance.b, n);                                                                         \
    alpha[p] = LANE(opaque, n);                                                                                          \
    depth[p] = LANE(where, n);                                                                                           \
  }
  EACH_LANE(PAINT)
#undef PAINT
}
