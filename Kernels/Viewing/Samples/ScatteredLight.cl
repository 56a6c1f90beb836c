// Packs the samples for camera rays: source radiance per unit length and extinction of every voxel, from the medium's
// arrays and from light that a solver or shadow rays computed.
//
// Macros set by the host:
//   FLOW     how the light's mean direction is packed: 0 not at all; 1 as it is; 2 multiplied by g, with a length of at
//            most LARGEST_FLOW; 3 as it is, with g by voxel in a separate array
//   GLOW     1: emission is packed separately
//   BENDS    1: the refractive index varies
//   BRICKED  1: samples are stored in bricks

#include "Numerics/Prefetch.cl"
#include "Viewing/Samples/SampleLayout.cl"
#include "Viewing/Samples/VoxelChannels.cl"
#include "Viewing/Scene/ViewShared.h"

#define LARGEST_FLOW 0.9999f

// Input arrays of the medium and its light, as passed to the kernels.
typedef struct
{
  __global const float* absorption;
  __global const float* scattering;
  __global const float* emission;
  __global const float* fluence;
  __global const float* unscattered;
  __global const float* direct;
  __global const float* ior;
  const PackInfo* info;
} ingredients;

// In-scattered radiance of one channel, W / (length^2 sr). The lamps' light (`direct`), which shadow rays computed, is
// scattered towards the eye with the phase function; all other light is scattered isotropically. The lamps' part of the
// fluence is subtracted from the total fluence, so that it does not count twice.
inline float in_scattered(const ingredients* from, int voxel, int channel)
{
  const int single = from->info->single;
  const float whole = channel_of(from->fluence, voxel, from->info->components.fluence, channel);
  const float first = channel_of(from->unscattered, voxel, from->info->components.unscattered, channel);
  if (from->info->components.direct)
  {
    const float seen = from->direct[voxel * 6 + channel];
    const float from_lights = fmin(from->direct[voxel * 6 + 3 + channel], first);
    return seen + (single ? 0.0f : fmax(whole - from_lights, 0.0f) * PER_SPHERE);
  }
  return (single ? first : whole) * PER_SPHERE;
}

// Source of a voxel, W / (length^3 sr) (red, green, blue), and its grey extinction in w; with BENDS the source is
// divided by n^2.
//   sigma_t  receives the extinction of all channels
//   emitted  receives the emission, which with GLOW is not included in the source
inline float4 source_of(const ingredients* from, int voxel, float4* sigma_t, float4* emitted)
{
  const ViewedComponents of = from->info->components;
  float4 sigma_s = (float4)(0.0f);
  float4 source = (float4)(0.0f);
  *sigma_t = *emitted = (float4)(0.0f);
#define CHANNEL(c, n)                                                             \
  sigma_s.c = channel_of(from->scattering, voxel, of.scattering, n);              \
  sigma_t->c = sigma_s.c + channel_of(from->absorption, voxel, of.absorption, n); \
  emitted->c = channel_of(from->emission, voxel, of.emission, n);                 \
  source.c = sigma_s.c * in_scattered(from, voxel, n);
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
// Prefetches the voxels of the brick's next slice at both ends of each row, because the rows of a brick are far apart
// in memory.
static void ask_for_next_slice(const ingredients* from, int4 size, int voxel)
{
  if (get_local_id(0) == 0 || get_local_id(0) == BrickEdge)
  {
    const size_t next = (size_t)voxel + size.x * size.y;
    PREFETCH(from->absorption + next * from->info->components.absorption, 0, 3);
    PREFETCH(from->scattering + next * from->info->components.scattering, 0, 3);
    PREFETCH(from->fluence + next * from->info->components.fluence, 0, 3);
  }
}
#endif

// Packs samples. Voxels that rays do not see (ViewTraits.h) are skipped.
//   bricks   with BRICKED: for each record (the samples of one brick), index of its brick; -1: none
//   samples  source (red, green, blue) and grey extinction; with GREY source and extinction of this voxel and of the
//            next voxel along y
//   flow     with FLOW 1 and 3: the light's mean direction; with FLOW 2: times g
//   cosines  with FLOW 3: g of red, green, blue
//   glow     with GLOW: emission, which is then not part of `samples`
//   ior      refractive index; with BENDS sources are divided by its square
__kernel void pack_samples(PackInfo info, __global const float* restrict absorption,
  __global const float* restrict scattering, __global const float* restrict emission,
  __global const float* restrict fluence, __global const float* restrict unscattered,
  __global const float* restrict direct, __global const float* restrict direction, __global const float* restrict ior,
  __global const float* restrict mean_cosines, __global float4* restrict samples, __global float4* restrict extinctions,
  __global float4* restrict flow, __global float4* restrict glow, __global float4* restrict cosines,
  __global const uchar* restrict seen, __global const int* restrict bricks)
{
  const int4 size = info.size;
#if BRICKED
  int3 sample;
  const int place = place_in_records();
  // record 0, which all empty bricks share, has zeros only: the factor is 0
  const float there = find_sample_in_brick(bricks, size, &sample) ? 1.0f : 0.0f;
#else
  if (get_global_id(0) >= size.x + 2 || !is_seen(seen, size))
  {
    return;
  }
  const float there = 1.0f;
  const int3 sample = sample_of_item();
  const int place = padded_index(size);
#endif
  const int voxel = voxel_of(sample, size);
  const ingredients from = { absorption, scattering, emission, fluence, unscattered, direct, ior, &info };
#if BRICKED
  ask_for_next_slice(&from, size, voxel);
#endif
  float4 sigma_t, emitted;
  const float4 source = source_of(&from, voxel, &sigma_t, &emitted);
#if GREY
  const int row = sample.y;
  float4 unused, also_unused;
  const float4 next = source_of(&from, row > 0 && row < size.y ? voxel + size.x : voxel, &unused, &also_unused);
  samples[place] = there * (float4)(source.x, source.w, next.x, next.w);
#else
  samples[place] = there * source;
#endif
#if COLOURED
  extinctions[place] = there * sigma_t;
#endif
#if FLOW
  const float3 mean = (float3)(direction[3 * voxel], direction[3 * voxel + 1], direction[3 * voxel + 2]);
  // A mean direction longer than 1 is shortened to length 1.
  const float3 held = mean / fmax(length(mean), 1.0f);
#if FLOW == 2
  const float here = info.components.meanCosines ? mean_cosines[voxel] : info.g;
  flow[place] =
    there * (float4)(held * (here * fmin(1.0f, LARGEST_FLOW / fmax(fabs(here) * length(held), 1e-30f))), 0.0f);
#else
  flow[place] = there * (float4)(held, 0.0f);
#endif
#endif
#if FLOW == 3
  cosines[place] = there *
    (float4)(channel_of(mean_cosines, voxel, info.components.meanCosines, 0),
      channel_of(mean_cosines, voxel, info.components.meanCosines, 1),
      channel_of(mean_cosines, voxel, info.components.meanCosines, 2), 0.0f);
#endif
#if GLOW
  glow[place] = there * emitted;
#endif
}
