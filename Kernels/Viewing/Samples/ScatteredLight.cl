// What the rays meet: every voxel's source radiance per unit length and its extinction, made from the medium's arrays
// and from the light that a solver left in them or that shadow rays find.
//
// The host gives
//   SHADOW_RAYS  1: `direct` holds what the lights scatter towards the eye
//   FLOW         1: the light's mean direction is packed, FLOW_WITH_G 1: times g
//   VARIED_G     1: g by voxel is packed apart
//   GLOW         1: emission is packed apart
//   BENDS        1: the refractive index varies
//   BRICKED      1: samples stand by bricks

#include "Numerics/Prefetch.cl"
#include "Viewing/Samples/Border.cl"
#include "Viewing/Samples/VoxelChannels.cl"
#include "Viewing/Scene/ViewShared.h"

#define LARGEST_FLOW 0.9999f

// What the medium and its light are made of, as the kernels' arguments.
typedef struct
{
  __global const float* absorption;
  __global const float* scattering;
  __global const float* emission;
  __global const float* fluence;
  __global const float* unscattered;
  __global const float* direct;
  __global const float* ior;
  ViewedComponents components;
} ingredients;

// In-scattered radiance of one channel. `fluence` holds everything, `unscattered` what of it came straight from a
// light; what is seen of the lights by shadow rays is taken out of fluence, so that it does not count twice.
inline float in_scattered(const ingredients* from, int voxel, int channel, int single)
{
  const float whole = channel_of(from->fluence, voxel, from->components.fluence, channel);
  const float first = channel_of(from->unscattered, voxel, from->components.unscattered, channel);
#if SHADOW_RAYS
  const float seen = from->direct[voxel * 6 + channel];
  const float from_lights = fmin(from->direct[voxel * 6 + 3 + channel], first);
  return seen + (single ? 0.0f : fmax(whole - from_lights, 0.0f) * PER_SPHERE);
#else
  return (single ? first : whole) * PER_SPHERE;
#endif
}

// Source of a voxel, by n^2 with BENDS: red, green, blue, and grey extinction; besides all of the extinction, and what
// is emitted, which with GLOW is no part of the source.
inline float4 source_of(const ingredients* from, int voxel, int single, float4* sigma_t, float4* emitted)
{
  const ViewedComponents of = from->components;
  float4 sigma_s = (float4)(0.0f);
  float4 source = (float4)(0.0f);
  *sigma_t = *emitted = (float4)(0.0f);
#define CHANNEL(c, n)                                                             \
  sigma_s.c = channel_of(from->scattering, voxel, of.scattering, n);              \
  sigma_t->c = sigma_s.c + channel_of(from->absorption, voxel, of.absorption, n); \
  emitted->c = channel_of(from->emission, voxel, of.emission, n);                 \
  source.c = sigma_s.c * in_scattered(from, voxel, n, single);
  CHANNEL(x, 0)
  CHANNEL(y, 1)
  CHANNEL(z, 2)
#undef CHANNEL
#if !GLOW
  source += *emitted;
#endif
#if BENDS
  const float square = from->ior[voxel] * from->ior[voxel];
  source /= square;
  *emitted /= square;
#endif
  source.w = sigma_t->x;
  return source;
}

#if BRICKED
// Rows of a brick are far from each other in memory: those of its next slice are asked for, by the ends of each row.
static void ask_for_next_slice(const ingredients* from, int4 size, int voxel)
{
  if (get_local_id(0) == 0 || get_local_id(0) == BrickEdge)
  {
    const size_t next = (size_t)voxel + size.x * size.y;
    PREFETCH(from->absorption + next * from->components.absorption, 0, 3);
    PREFETCH(from->scattering + next * from->components.scattering, 0, 3);
    PREFETCH(from->fluence + next * from->components.fluence, 0, 3);
  }
}

static void put_nothing(int place, __global float4* samples, __global float4* extinctions, __global float4* flow,
  __global float4* glow, __global float4* cosines)
{
  samples[place] = (float4)(0.0f);
#if COLOURED
  extinctions[place] = (float4)(0.0f);
#endif
#if FLOW
  flow[place] = (float4)(0.0f);
#endif
#if VARIED_G
  cosines[place] = (float4)(0.0f);
#endif
#if GLOW
  glow[place] = (float4)(0.0f);
#endif
}
#endif

// Of voxels that rays do not see (ViewTraits.h) nothing is packed.
//
// bricks   with BRICKED: of each record (SampleBricks.h)
// single   1: only light that scatters once
// samples  red, green, blue of the source, and grey extinction; with GREY source and extinction here and at the next
//          voxel along y
// flow     with FLOW: the light's mean direction; with FLOW_WITH_G times g, at most LARGEST_FLOW long
// cosines  with VARIED_G: red, green, blue of g
// glow     with GLOW: emission, which is then no part of `samples`
// ior      with BENDS: sources are divided by n^2
__kernel void pack_samples(int4 size, ViewedComponents of, int single, float g,
  __global const float* restrict absorption, __global const float* restrict scattering,
  __global const float* restrict emission, __global const float* restrict fluence,
  __global const float* restrict unscattered, __global const float* restrict direct,
  __global const float* restrict direction, __global const float* restrict ior,
  __global const float* restrict mean_cosines, __global float4* restrict samples, __global float4* restrict extinctions,
  __global float4* restrict flow, __global float4* restrict glow, __global float4* restrict cosines,
  __global const uchar* restrict seen, __global const int* restrict bricks)
{
#if BRICKED
  int3 sample;
  const int place = place_in_records();
  if (!find_sample_in_brick(bricks, size, &sample))
  {
    put_nothing(place, samples, extinctions, flow, glow, cosines);
    return;
  }
#else
  if (get_global_id(0) >= size.x + 2 || !is_seen(seen, size))
  {
    return;
  }
  const int3 sample = sample_of_item();
  const int place = padded_index(size);
#endif
  const int voxel = voxel_of(sample, size);
  const ingredients from = { absorption, scattering, emission, fluence, unscattered, direct, ior, of };
#if BRICKED
  ask_for_next_slice(&from, size, voxel);
#endif
  float4 sigma_t, emitted;
  const float4 source = source_of(&from, voxel, single, &sigma_t, &emitted);
#if GREY
  const int row = sample.y;
  float4 unused, also_unused;
  const float4 next = source_of(&from, row > 0 && row < size.y ? voxel + size.x : voxel, single, &unused, &also_unused);
  samples[place] = (float4)(source.x, source.w, next.x, next.w);
#else
  samples[place] = source;
#endif
#if COLOURED
  extinctions[place] = sigma_t;
#endif
#if FLOW
  const float3 mean = (float3)(direction[3 * voxel], direction[3 * voxel + 1], direction[3 * voxel + 2]);
  // No light is more than one beam.
  const float3 held = mean / fmax(length(mean), 1.0f);
#if FLOW_WITH_G
  const float here = of.meanCosines ? mean_cosines[voxel] : g;
  flow[place] = (float4)(held * (here * fmin(1.0f, LARGEST_FLOW / fmax(fabs(here) * length(held), 1e-30f))), 0.0f);
#else
  flow[place] = (float4)(held, 0.0f);
#endif
#endif
#if VARIED_G
  cosines[place] = (float4)(channel_of(mean_cosines, voxel, of.meanCosines, 0),
    channel_of(mean_cosines, voxel, of.meanCosines, 1), channel_of(mean_cosines, voxel, of.meanCosines, 2), 0.0f);
#endif
#if GLOW
  glow[place] = emitted;
#endif
}
