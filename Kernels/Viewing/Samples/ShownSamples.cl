// Packs the samples for camera rays if scattered light is given by angular moments. A sample is then not a source but
// the ratio of source to extinction. The ratio varies slowly where source and extinction decay steeply, as behind the
// surface of a cloud. The march multiplies it by the interpolated extinction (numerics.md, section 14.7).
//
// Macros set by the host:
//   SHOWN    0 no source; 1 diffuse light and first-scattered light of lamps; 2 repeated forward scattering of lamps'
//            light
//   BEAMS    1: `direct` holds light of lamps
//   AUREOLE  0: `direct` has no values for SHOWN 2
//   COLOURED, BENDS, GLOW  as in ScatteredLight.cl

#include "Viewing/Samples/SampleLayout.cl"
#include "Viewing/Samples/VoxelChannels.cl"
#include "Viewing/Scene/ViewShared.h"

#define DARKEST 80.0f

// Extinction of a voxel, and its albedo (scattering over extinction).
typedef struct
{
  float4 sigma_t, albedo;
} coefficients;

inline coefficients coefficients_of(__global const float* absorption, __global const float* scattering,
  __global const float* straight_on, const ViewedComponents* of, int voxel)
{
  coefficients here;
  here.sigma_t.w = here.albedo.w = 0.0f;
#define CHANNEL(c, n)                                                                    \
  {                                                                                      \
    const float s = channel_of(scattering, voxel, of->scattering, n);                    \
    const float turned = s * (1.0f - channel_of(straight_on, voxel, of->straightOn, n)); \
    here.sigma_t.c = turned + channel_of(absorption, voxel, of->absorption, n);          \
    here.albedo.c = here.sigma_t.c > 0.0f ? s / here.sigma_t.c : 0.0f;                   \
  }
  CHANNEL(x, 0)
  CHANNEL(y, 1)
  CHANNEL(z, 2)
#undef CHANNEL
  return here;
}

inline float4 triple(__global const float* values, int voxel)
{
  return (float4)(values[3 * voxel], values[3 * voxel + 1], values[3 * voxel + 2], 0.0f);
}

#if SHOWN
// Averages over the scattering voxels in the 3 x 3 x 3 neighbourhood of a voxel: albedo and, with SHOWN 1, diffuse
// light, W / (length^2 sr). Both are 0 if none of these voxels scatters.
typedef struct
{
  float4 albedo, light;
} neighbour_means;

inline neighbour_means means_around(__global const float* absorption, __global const float* scattering,
  __global const float* straight_on, __global const float* diffuse, const ViewedComponents* of, int voxel, int4 size)
{
  float4 albedos = (float4)(0.0f), lights = (float4)(0.0f);
  float count = 0.0f;
#define ADD(neighbour)                                                                   \
  albedos += coefficients_of(absorption, scattering, straight_on, of, neighbour).albedo; \
  lights += SHOWN == 1 ? triple(diffuse, neighbour) : (float4)(0.0f);                    \
  count += 1.0f;
  FOR_SCATTERING_AROUND(voxel, size, scattering, of->scattering, ADD)
#undef ADD
  const neighbour_means means = { albedos / fmax(count, 1.0f), lights / fmax(count, 1.0f) };
  return means;
}
#endif

// Packs the samples from the light of each voxel, W / (length^2 sr): `diffuse` with 3 values per voxel and `direct`
// with 6 (ShadowRays.cl). A voxel that does not scatter receives the mean light of its scattering neighbours. If it
// does not absorb either, it also receives their mean albedo.
//   samples  SHOWN 1: diffuse light times albedo; SHOWN 2: lamps' light scattered more than once, divided by that
//            scattered once; w: grey extinction
//   beams    -ln of (lamps' light times albedo)
//   info     components.straightOn is 0: the extinction includes all scattering, and straight_on is not read. Otherwise
//            the extinction omits the fraction straight_on of scattering, which the solver treated as unscattered
__kernel void pack_shown(PackInfo info, __global const float* restrict absorption,
  __global const float* restrict scattering, __global const float* restrict emission,
  __global const float* restrict straight_on, __global const float* restrict diffuse,
  __global const float* restrict direct, __global const float* restrict ior, __global float4* restrict samples,
  __global float4* restrict extinctions, __global float4* restrict beams, __global float4* restrict glow,
  __global const uchar* restrict seen)
{
  const int4 size = info.size;
  const ViewedComponents of = info.components;
  if (get_global_id(0) >= size.x + 2 || !is_seen(seen, size))
  {
    return;
  }
  const int voxel = voxel_index(size);
  const int place = padded_index(size);
  const coefficients here = coefficients_of(absorption, scattering, straight_on, &of, voxel);
  float4 source = (float4)(0.0f);
  float perSquare = 1.0f;
#if BENDS
  perSquare = 1.0f / (ior[voxel] * ior[voxel]);
#endif
#if SHOWN
  float4 albedo = here.albedo;
#if SHOWN == 1
  float4 light = triple(diffuse, voxel);
#endif
  if (!scatters_at(scattering, voxel, of.scattering))
  {
    const neighbour_means around = means_around(absorption, scattering, straight_on, diffuse, &of, voxel, size);
    // The albedo of a voxel that absorbs but does not scatter is 0.
    albedo = any(here.sigma_t.xyz > (float3)(0.0f)) ? here.albedo : around.albedo;
#if SHOWN == 1
    light = around.light;
#endif
  }
#if SHOWN == 1
  source = light * albedo * perSquare;
#endif
#if BEAMS
  const float4 first = (float4)(direct[6 * voxel], direct[6 * voxel + 1], direct[6 * voxel + 2], 0.0f);
  const float4 dimmest = (float4)(exp(-DARKEST));
  beams[place] = -log(fmax(first * albedo * perSquare, dimmest));
#if SHOWN == 2 && AUREOLE
  const float4 more = (float4)(direct[6 * voxel + 3], direct[6 * voxel + 4], direct[6 * voxel + 5], 0.0f);
  source = select((float4)(0.0f), more / fmax(first, 1e-37f), first * albedo * perSquare > dimmest);
#endif
#endif
#endif
  source.w = here.sigma_t.x;
  samples[place] = source;
#if COLOURED
  extinctions[place] = here.sigma_t;
#endif
#if GLOW
  float4 emitted = (float4)(0.0f);
#if SHOWN == 1
  emitted = (float4)(channel_of(emission, voxel, of.emission, 0), channel_of(emission, voxel, of.emission, 1),
              channel_of(emission, voxel, of.emission, 2), 0.0f) *
    perSquare;
#endif
  glow[place] = emitted;
#endif
}
