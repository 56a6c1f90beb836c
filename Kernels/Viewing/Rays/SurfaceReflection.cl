// Splits primary rays at the surface where the index rises through a given value.
//
// The host gives
//   SURFACE  its reflectance: 0 no surface, 1 by Fresnel's equations, 2 constant

#pragma once
#include "Viewing/Rays/RayPackets.cl"

#if SURFACE
// Fresnel reflectance for unpolarised light from a medium of squared index n1 into one of squared index n2; `across` is
// the square of n sin(theta) (numerics.md, Eq. (110)).
inline real fresnel(real n1, real n2, real across)
{
  const real in = sqrt(greater(n1 - across, (real)0.0f)); // n cos(theta)
  const real out = sqrt(greater(n2 - across, (real)0.0f));
  const real s = (in - out) / greater(in + out, (real)1e-20f);
  const real p = fma(n2, in, -n1 * out) / greater(fma(n2, in, n1 * out), (real)1e-20f);
  return (real)0.5f * fma(s, s, p * p);
}

// Midpoint of the current step, velocity in its first half, half its time, and time since the midpoint of the previous
// step.
typedef struct
{
  real3 middle, velocity;
  real halfTime, since;
} met_step;

// Splits the rays that meet the surface in this step (`meets`) into a transmitted and a reflected part. The
// transmittance is known at the step's start, but the surface lies somewhat before or behind: the medium between the
// two acts on both parts or on one.
inline void split_at_surface(
  const surroundings* s, const met_step* step, integer meets, light* l, crossed* half_way, waiting* reflected)
{
  const int4 size = s->v->size;
  const float4 spacing = s->o->spacing;
  // Bisection in the time before the midpoint: at `outer` the index is below that of the surface, at `inner` it is not.
  real outer = step->halfTime + step->since;
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

  // Directions in world coordinates.
  const real after_start = step->halfTime - before;
  const real3 t = stretched(further(step->velocity, after_start, bend), spacing);
  const real3 gradient = stretched(bend, spacing);
  const real scale = (real)1.0f / sqrt(greater(product(gradient, gradient), (real)1e-30f));
  const real3 normal = { gradient.x * scale, gradient.y * scale, gradient.z * scale };
  const real inwards = product(t, normal);
#if SURFACE == 1
  const real3 steps = stretched(normal, s->v->inverseSpacing);
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
  reflected->velocity = chosen(meets, stretched(back, s->v->inverseSpacing), reflected->velocity);

  // Light.
  corners around;
  corners_of_samples(s, at, &around);
  const real speed = sqrt(product(t, t));
  const real3 towards = { t.x / speed, t.y / speed, t.z / speed };
  const real3 until_there = stretched(step->velocity, spacing);
  const real way = fabs(after_start) * sqrt(product(until_there, until_there));
  const sample there = take_sample(&s->scene, &around, SAMPLES_SIZE(s), towards);
  const real whole = mean_left(*l);
  const integer behind = after_start >= (real)0.0f;
#define SPLIT(sigma, left, later, EACH_SOURCE)                                  \
  {                                                                             \
    const real length = lesser(way, (real)1.0f / greater(sigma, (real)1e-20f)); \
    real remains;                                                               \
    const real weight = cross_length(sigma, length, &remains);                  \
    const real at_surface = left * (behind ? remains : (real)1.0f / remains);   \
    const real gained = part * weight * (behind ? left : -at_surface);          \
    EACH_SOURCE                                                                 \
    later = meets ? part * at_surface : later;                                  \
    left = meets ? left * ((real)1.0f - part) : left;                           \
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
#endif
