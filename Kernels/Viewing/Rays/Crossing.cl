// Radiative transfer along rays:
//   radiance = integral over the ray of T(t) q(t) dt + T(end) background,  T(t) = exp(-integral of sigma_t)
// with q = sigma_s times in-scattered radiance plus emission; q and sigma_t are interpolated between voxel centres.
//
// Macros set by the host:
//   PHASE, PHASE_CHANNELS  phase function for light whose mean direction is known, see PhaseFunction.cl
//   FLOW        with PHASE, contents of the array `flow`, as in ScatteredLight.cl
//   GLOW        1: emission is stored separately from scattered light
//   SHOWN       value of SHOWN with which ShownSamples.cl packed the samples, or 0 if ScatteredLight.cl did; BEAMS 1:
//               `flow` holds the lamps' light
//   BLOCK       1: the medium is a block of a larger grid, whose rays are straight; may be omitted

#pragma once
#include "Viewing/Rays/View.cl"
#include "Viewing/Samples/PhaseFunction.cl"
#include "Viewing/Samples/Sampling.cl"

#if COLOURED
typedef rgb spectrum;
#else
typedef real spectrum;
#endif

// Packed samples of the medium and its light at voxel centres, with a border of one voxel.
typedef struct
{
  __global const float4*
    samples; // red, green, blue of q, W / (length^3 sr), and grey sigma_t, 1/length; with GREY see Sampling.cl
  __global const float4* extinctions; // sigma_t of red, green, blue, 1/length, with COLOURED
  __global const float4* flow;        // x, y, z of the light's mean direction, see FLOW
  __global const float4* glow;        // emission, W / (length^3 sr), with GLOW
  __global const float4* cosines;     // mean cosine g for red, green and blue, with FLOW 3
  __global const float* phaseRows;    // table of the phase function, with PHASE 2 and 5
  PhaseInfo phase;
} scenery;

inline real product(real3 a, real3 b)
{
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}

// Transmittance of a ray from its start to the current point, and the radiance accumulated on this path.
typedef struct
{
  spectrum left;
  rgb radiance;
#if MANY_STEPS
  spectrum leftRest; // Kahan compensation of `left`, see add_to
  rgb radianceRest;
#endif
#if BLOCK
  rgb before; // transmittance of the blocks in front of this block
#endif
} light;

inline real mean_of(rgb s)
{
  return (s.r + s.g + s.b) * (real)(1.0f / 3.0f);
}

// Transmittance from the eye to the current point, averaged over the channels.
inline real mean_left(light l)
{
#if BLOCK && COLOURED
  const rgb all = { l.before.r * l.left.r, l.before.g * l.left.g, l.before.b * l.left.b };
  return mean_of(all);
#elif BLOCK
  return mean_of(l.before) * l.left;
#elif COLOURED
  return mean_of(l.left);
#else
  return l.left;
#endif
}

inline real most_left(light l)
{
#if BLOCK && COLOURED
  return greater(greater(l.before.r * l.left.r, l.before.g * l.left.g), l.before.b * l.left.b);
#elif BLOCK
  return greater(greater(l.before.r, l.before.g), l.before.b) * l.left;
#elif COLOURED
  return greater(greater(l.left.r, l.left.g), l.left.b);
#else
  return l.left;
#endif
}

// Transmittance of this block, with which it attenuates radiance from blocks behind it.
inline rgb passed_of(light l)
{
#if COLOURED
  return l.left;
#else
  const rgb passed = { l.left, l.left, l.left };
  return passed;
#endif
}

#if BLOCK
// Transmittance of the blocks in front of this one at a pixel; 1 if there are none.
//   limits  array: one depth per pixel at which rays end, if v->has.x; then three transmittances per pixel, if v->has.y
inline rgb starts_of(const ViewInfo* v, __global const float* limits, int column, int row)
{
  rgb part = { (real)1.0f, (real)1.0f, (real)1.0f };
  if (v->has.y == 0)
  {
    return part;
  }
  __global const float* starts = limits + (v->has.x ? PIXELS(v) : 0);
  const integer pixel = nearest_pixels(v, column, row);
#define FETCH(n)                                    \
  LANE(part.r, n) = starts[3 * LANE(pixel, n)];     \
  LANE(part.g, n) = starts[3 * LANE(pixel, n) + 1]; \
  LANE(part.b, n) = starts[3 * LANE(pixel, n) + 2];
  EACH_LANE(FETCH)
#undef FETCH
  return part;
}
#endif

inline spectrum scaled(spectrum s, real factor)
{
#if COLOURED
  s.r *= factor;
  s.g *= factor;
  s.b *= factor;
  return s;
#else
  return s * factor;
#endif
}

inline light unlit(real left)
{
  light l;
#if COLOURED
  l.left.r = l.left.g = l.left.b = left;
#else
  l.left = left;
#endif
  l.radiance.r = l.radiance.g = l.radiance.b = (real)0.0f;
#if MANY_STEPS
  l.leftRest = scaled(l.left, (real)0.0f);
  l.radianceRest = l.radiance;
#endif
  return l;
}

// Adds the background radiance `behind` times the factor `part`, attenuated by the ray's transmittance.
inline void add_background(rgb behind, real part, light* l)
{
#if COLOURED
  l->radiance.r += behind.r * (l->left.r * part);
  l->radiance.g += behind.g * (l->left.g * part);
  l->radiance.b += behind.b * (l->left.b * part);
#else
  const real left = l->left * part;
  l->radiance.r += behind.r * left;
  l->radiance.g += behind.g * left;
  l->radiance.b += behind.b * left;
#endif
}

// Adds the correction `missing` for light at the surface of thick voxels (surface_light in Backdrop.cl), multiplied by
// 1 - transmittance of the ray.
inline void add_surface_light(rgb missing, light* l)
{
#if COLOURED
#define MET(c) ((real)1.0f - l->left.c)
#else
#define MET(c) ((real)1.0f - l->left)
#endif
#define ADD(c) l->radiance.c = greater(fma(missing.c, MET(c), l->radiance.c), (real)0.0f);
  ADD(r)
  ADD(g)
  ADD(b)
#undef ADD
#undef MET
}

// Whether the optical length of every step of the picture is at most 2
#define THIN_STEPS(v) ((v)->marching.w > 0.0f)

// Crosses a segment of constant coefficients. Returns the radiance gained per unit of source, length (1 - exp(-tau)) /
// tau with tau = sigma length; for tau = 0 that is `length`. `remains` receives exp(-tau).
//   thin  whether tau is at most 2 in all lanes
inline real cross_length(real sigma, real length, int thin, real* remains)
{
  if (!thin)
  {
    const real tau = greater(sigma * length, (real)1e-30f);
    const real fraction = extinguished(tau, remains) / tau;
    return length * fraction;
  }
  // Polynomial for (1 - exp(-tau)) / tau on [0, 2], error 1e-7.
  const real tau = sigma * length;
  real p = fma(tau, (real)-1.17129066e-05f, (real)0.000167222737f);
  p = fma(p, tau, (real)-0.00134923449f);
  p = fma(p, tau, (real)0.00830663089f);
  p = fma(p, tau, (real)-0.0416579582f);
  p = fma(p, tau, (real)0.166665584f);
  p = fma(p, tau, (real)-0.49999997f);
  const real fraction = fma(p, tau, (real)1.0f);
  *remains = fma(-tau, fraction, (real)1.0f);
  return length * fraction;
}

// The step in which a ray's transmittance falls below 1/2: where it starts and how long it is, along the ray or along
// the view axis, and the transmittance before and after it.
typedef struct
{
  real start, length, before, after;
} crossed;

// Source and extinction of the medium at the midpoint of a step.
typedef struct
{
  rgb source;
  spectrum sigma;
} sample;

#if PHASE
// 4 pi times the phase function for scattering towards the eye, averaged over light that is spread about its mean
// direction (numerics.md, section 14.1).
//   v  unit vectors along the rays, away from the eye
__attribute__((always_inline)) inline rgb scattered_towards_eye(
  const scenery* scene, const corners* at, int4 size, real3 v)
{
  rgb flow;
  real none;
  gather(scene->flow, at, size, &flow, &none);
  const real3 b = { flow.r, flow.g, flow.b };
  const real square = product(b, b);
  const real along = product(b, v);
#if FLOW == 2 && PHASE == 1
  const real f = henyey_greenstein(square, along);
  const rgb even = { f, f, f };
  return even;
#elif FLOW == 2
  const real f = schlick(square, along, scene->phaseRows);
  const rgb even = { f, f, f };
  return even;
#else
  phase_parameters p = parameters_of(&scene->phase);
#if FLOW == 3
  gather(scene->cosines, at, size, &p.first, &none);
#endif
  return scattered_of_channels(square, along, p, scene->phaseRows);
#endif
}
#endif

#if SHOWN
#if COLOURED
#define SIGMA_OF(c) s->sigma.c
#else
#define SIGMA_OF(c) s->sigma
#endif
// With SHOWN, samples hold ratios of source to extinction. Multiplies them by the interpolated extinction, so that `s`
// holds sources.
__attribute__((always_inline)) inline void multiply_by_extinction(
  const scenery* scene, const corners* at, int4 size, sample* s)
{
  real none;
#if BEAMS
  rgb beams, left;
  gather(scene->flow, at, size, &beams, &none);
  extinguished(beams.r, &left.r);
  extinguished(beams.g, &left.g);
  extinguished(beams.b, &left.b);
#if SHOWN == 1
#define RATIO(c) (s->source.c + left.c)
#else
#define RATIO(c) (s->source.c * left.c)
#endif
#else
#define RATIO(c) s->source.c
#endif
  s->source.r = RATIO(r) * SIGMA_OF(r);
  s->source.g = RATIO(g) * SIGMA_OF(g);
  s->source.b = RATIO(b) * SIGMA_OF(b);
#undef RATIO
#if GLOW
  rgb glow;
  gather(scene->glow, at, size, &glow, &none);
  s->source.r += glow.r;
  s->source.g += glow.g;
  s->source.b += glow.b;
#endif
}
#undef SIGMA_OF
#endif

// Interpolates source and extinction at the point of each ray.
//   at  the eight voxel centres around the points, with their weights
//   v   unit vectors along the rays, away from the eye
__attribute__((always_inline)) inline sample take_sample(const scenery* scene, const corners* at, int4 size, real3 v)
{
  sample s;
  real grey;
  gather_samples(scene->samples, at, size, &s.source, &grey);
#if COLOURED
  real unused;
  gather(scene->extinctions, at, size, &s.sigma, &unused);
#else
  s.sigma = grey;
#endif
#if PHASE
  const rgb part = scattered_towards_eye(scene, at, size, v);
#if GLOW
  rgb glow;
  real none;
  gather(scene->glow, at, size, &glow, &none);
  s.source.r = fma(s.source.r, part.r, glow.r);
  s.source.g = fma(s.source.g, part.g, glow.g);
  s.source.b = fma(s.source.b, part.b, glow.b);
#else
  s.source.r *= part.r;
  s.source.g *= part.g;
  s.source.b *= part.b;
#endif
#endif
#if SHOWN
  multiply_by_extinction(scene, at, size, &s);
#endif
  return s;
}

#if MANY_STEPS
// Subtracts the fraction `part` from the transmittance `left`. Multiplying by 1 - part would be less exact: in single
// precision 1 - 1e-9 is 1.
//   rest  compensation of rounding errors (Kahan summation), which add_to updates
inline void lose(real* left, real* rest, real part)
{
  add_to(left, rest, -lesser(part, (real)1.0f) * *left);
  *left = greater(*left, (real)0.0f);
}
#endif

// Crosses one step with the coefficients s: adds radiance, reduces the transmittance, and records in half_way the step
// in which it falls below 1/2. Only the last product depends on the transmittance before the step, so the processor can
// overlap successive steps.
//   length  path length of the step
//   start, gain  position of the step and its extent, along the ray or along the view axis
__attribute__((always_inline)) inline void cross_sample(
  const ViewInfo* v, sample s, real length, real start, real gain, light* l, crossed* half_way)
{
  const integer goes_on = most_left(*l) > (real)v->marching.y;
  const int thin = THIN_STEPS(v);
  const real before = mean_left(*l);
#if MANY_STEPS
#if COLOURED
#define SIGMA(c) s.sigma.c
#define LEFT(c) l->left.c
#else
#define SIGMA(c) s.sigma
#define LEFT(c) l->left
#endif
#define GATHER(c)                                                                                        \
  {                                                                                                      \
    real remains;                                                                                        \
    const real weight = goes_on ? cross_length(SIGMA(c), length, thin, &remains) * LEFT(c) : (real)0.0f; \
    add_to(&l->radiance.c, &l->radianceRest.c, s.source.c* weight);                                      \
  }
  GATHER(r)
  GATHER(g)
  GATHER(b)
#undef GATHER
#undef SIGMA
#undef LEFT
  real unused;
#define LOSE(sigma, left, rest) \
  lose(&left, &rest, goes_on ? sigma* cross_length(sigma, length, thin, &unused) : (real)0.0f);
#if COLOURED
  LOSE(s.sigma.r, l->left.r, l->leftRest.r)
  LOSE(s.sigma.g, l->left.g, l->leftRest.g)
  LOSE(s.sigma.b, l->left.b, l->leftRest.b)
#else
  LOSE(s.sigma, l->left, l->leftRest)
#endif
#undef LOSE
#elif COLOURED
#define CROSS(c)                                                                               \
  {                                                                                            \
    real remains;                                                                              \
    const real weight = cross_length(s.sigma.c, length, thin, &remains);                       \
    l->radiance.c = fma(s.source.c * weight, goes_on ? l->left.c : (real)0.0f, l->radiance.c); \
    l->left.c *= goes_on ? remains : (real)1.0f;                                               \
  }
  CROSS(r)
  CROSS(g)
  CROSS(b)
#undef CROSS
#else
  real remains;
  const real weight = cross_length(s.sigma, length, thin, &remains) * l->left;
  l->radiance.r = goes_on ? fma(s.source.r, weight, l->radiance.r) : l->radiance.r;
  l->radiance.g = goes_on ? fma(s.source.g, weight, l->radiance.g) : l->radiance.g;
  l->radiance.b = goes_on ? fma(s.source.b, weight, l->radiance.b) : l->radiance.b;
  l->left = goes_on ? l->left * remains : l->left;
#endif
  const real after = mean_left(*l);
  const integer crossing = (before > (real)0.5f) & (after <= (real)0.5f);
  half_way->start = crossing ? start : half_way->start;
  half_way->length = crossing ? gain : half_way->length;
  half_way->before = crossing ? before : half_way->before;
  half_way->after = crossing ? after : half_way->after;
}

// Records that the transmittance of the rays `where` falls to 1/2 or less at the depth `place` of the surface or table.
// The record is a step in which it falls from 1 to 0.
inline void lose_half(integer where, real place, crossed* half_way)
{
  half_way->start = where ? place : half_way->start;
  half_way->length = where ? (real)0.0f : half_way->length;
  half_way->before = where ? (real)1.0f : half_way->before;
  half_way->after = where ? (real)0.0f : half_way->after;
}

// Distance at which the transmittance is 1/2, by interpolation within a step: ln(a/b) = 2 (a-b)/(a+b) up to terms of
// third order, a and b being transmittances.
inline real distance_to_half(crossed c)
{
  const real part = (c.before - (real)0.5f) * (c.before + c.after) /
    ((c.before + (real)0.5f) * greater(c.before - c.after, (real)1e-30f));
  return fma(part, c.length, c.start);
}
