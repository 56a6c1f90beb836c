// What the rays meet: every voxel's source radiance per unit length and its extinction, made from the medium's arrays
// and from the light that a solver left in them or that shadow rays find.
//
// Define
//   ABSORPTION, SCATTERING, EMISSION, FLUENCE, UNSCATTERED   components of each array: 0 (there is none), 1 or 3
//   SHADOW_RAYS  1: `direct` holds what the lights scatter towards the eye
//   FLOW         1: the light's mean direction is packed
//   GLOW         1: emission is packed apart
//   BENDS        1: the refractive index varies

#include "Viewing/Sampling.cl"

#define PER_SPHERE 0.0795774715f // 1 / (4 pi)
#define LARGEST_FLOW 0.9999f

inline float channel_of(__global const float* values, int voxel, int components, int channel)
{
  return components == 0 ? 0.0f : values[voxel * components + (components == 3 ? channel : 0)];
}

// Voxels by work-items of a plane with its border: the work-item's own place, and the voxel that is repeated there.
inline int padded_index(int4 size)
{
  return ((int)get_global_id(2) * (size.y + 2) + (int)get_global_id(1)) * (size.x + 2) + (int)get_global_id(0);
}
inline int voxel_index(int4 size)
{
  const int i = clamp((int)get_global_id(0) - 1, 0, size.x - 1);
  const int j = clamp((int)get_global_id(1) - 1, 0, size.y - 1);
  const int k = clamp((int)get_global_id(2) - 1, 0, size.z - 1);
  return (k * size.y + j) * size.x + i;
}

// In-scattered radiance of one channel. `fluence` holds everything, `unscattered` what of it came straight from a
// light; what is seen of the lights by shadow rays is taken out of fluence, so that it does not count twice.
inline float in_scattered(__global const float* fluence, __global const float* unscattered,
  __global const float* direct, int voxel, int channel, int single)
{
  const float whole = channel_of(fluence, voxel, FLUENCE, channel);
  const float first = channel_of(unscattered, voxel, UNSCATTERED, channel);
#if SHADOW_RAYS
  const float seen = direct[voxel * 6 + channel];
  const float from_lights = fmin(direct[voxel * 6 + 3 + channel], first);
  return seen + (single ? 0.0f : fmax(whole - from_lights, 0.0f) * PER_SPHERE);
#else
  return (single ? first : whole) * PER_SPHERE;
#endif
}

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
} ingredients;

// Source of a voxel, by n^2 with BENDS: red, green, blue, and grey extinction; besides all of the extinction, and what
// is emitted, which with GLOW is no part of the source.
inline float4 source_of(const ingredients* from, int voxel, int single, float4* sigma_t, float4* emitted)
{
  float4 sigma_s = (float4)(0.0f);
  float4 source = (float4)(0.0f);
  *sigma_t = *emitted = (float4)(0.0f);
#define CHANNEL(c, n)                                                          \
  sigma_s.c = channel_of(from->scattering, voxel, SCATTERING, n);              \
  sigma_t->c = sigma_s.c + channel_of(from->absorption, voxel, ABSORPTION, n); \
  emitted->c = channel_of(from->emission, voxel, EMISSION, n);                 \
  source.c = sigma_s.c * in_scattered(from->fluence, from->unscattered, from->direct, voxel, n, single);
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

// single   1: only light that scatters once
// samples  red, green, blue of the source, and grey extinction; with GREY source and extinction here and at the next
//          voxel along y
// flow     with FLOW: the light's mean direction times g, at most LARGEST_FLOW long
// glow     with GLOW: emission, which is then no part of `samples`
// ior      with BENDS: sources are divided by n^2
__kernel void pack_samples(int4 size, int single, float g, __global const float* restrict absorption,
  __global const float* restrict scattering, __global const float* restrict emission,
  __global const float* restrict fluence, __global const float* restrict unscattered,
  __global const float* restrict direct, __global const float* restrict direction, __global const float* restrict ior,
  __global float4* restrict samples, __global float4* restrict extinctions, __global float4* restrict flow,
  __global float4* restrict glow)
{
  if (get_global_id(0) >= size.x + 2)
  {
    return;
  }
  const int voxel = voxel_index(size);
  const int place = padded_index(size);
  const ingredients from = { absorption, scattering, emission, fluence, unscattered, direct, ior };
  float4 sigma_t, emitted;
  const float4 source = source_of(&from, voxel, single, &sigma_t, &emitted);
#if GREY
  const int row = get_global_id(1);
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
  flow[place] = (float4)(held * (g * fmin(1.0f, LARGEST_FLOW / fmax(fabs(g) * length(held), 1e-30f))), 0.0f);
#endif
#if GLOW
  glow[place] = emitted;
#endif
}

// Whether anything extinguishes or shines in a brick, or bends with BENDS, or does so close enough to be interpolated
// into it:
// 1 it is empty, -1 it is not, 0 rays bend.
__kernel void find_empty_bricks(int4 size, int4 brick_count, __global const float4* restrict samples,
  __global const float4* restrict extinctions, __global const float4* restrict glow,
  __global const float4* restrict bending, __global char* restrict bricks)
{
  const int i = get_global_id(0);
  const int j = get_global_id(1);
  const int k = get_global_id(2);
  if (i >= brick_count.x)
  {
    return;
  }
  const int row = size.x + 2;
  const int slice = row * (size.y + 2);
  const int x0 = i * BRICK, x1 = min(x0 + BRICK + 1, size.x + 1);
  const int y0 = j * BRICK, y1 = min(y0 + BRICK + 1, size.y + 1);
  const int z0 = k * BRICK, z1 = min(z0 + BRICK + 1, size.z + 1);
  int filled = 0;
  int bends = 0;
#if BENDS
#define LOOK_ON (!filled || !bends)
#else
#define LOOK_ON (!filled)
#endif
  for (int z = z0; z <= z1 && LOOK_ON; ++z)
  {
    for (int y = y0; y <= y1 && LOOK_ON; ++y)
    {
      for (int x = x0; x <= x1; ++x)
      {
        const int place = z * slice + y * row + x;
#if GREY
        filled |= any(samples[place].xy != (float2)(0.0f));
#else
        filled |= any(samples[place] != (float4)(0.0f));
#endif
#if COLOURED
        filled |= any(extinctions[place] != (float4)(0.0f));
#endif
#if GLOW
        filled |= any(glow[place] != (float4)(0.0f));
#endif
#if BENDS
        bends |= any(bending[place].xyz != (float3)(0.0f));
#endif
      }
    }
  }
#undef LOOK_ON
  bricks[(k * brick_count.y + j) * brick_count.x + i] = bends ? 0 : filled ? -1 : 1;
}

// A light as the shadow rays see it: parallel light, or a point of one.
typedef struct
{
  float4 place; // world, from the box's lower corner; w: 1 a point, 0 parallel light
  float4 axis;  // unit vector, the way the light travels; w: cosine of the cone's half angle, -2 for a whole sphere
  float4 power; // irradiance, or radiant intensity along the axis; w: 1 falls with the cosine to the axis, else 0
} small_light;

// Scatters towards the eye what the lights send straight to each voxel's centre.
//   direct  6 a voxel: sum of irradiance times phase function, W / (length^2 sr), and sum of irradiance, W / length^2
// Work-items by voxels of a slice. nearest_square keeps a voxel that holds a light finite: the mean of 1/r^2 over a
// sphere of the voxel's volume is 3/R^2.
__kernel void see_lights(int4 size, int4 brick_count, float4 spacing, float4 eye, float4 forward, float g, float step,
  float nearest_square, int light_count, __global const small_light* restrict lights,
  __global const float* restrict scattering, __global const float4* restrict samples,
  __global const float4* restrict extinctions, __global const char* restrict bricks, int first_slice, int first_row,
  __global float* restrict direct)
{
  // The voxels of this packet, along x.
  const int first = get_global_id(0) * REAL_WIDTH;
  const int j = get_global_id(1) + first_row;
  const int k = get_global_id(2) + first_slice;
  if (first >= size.x || j >= size.y)
  {
    return;
  }
#if REAL_WIDTH == 16
  const integer i = min(first + (integer)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15), size.x - 1);
#elif REAL_WIDTH == 8
  const integer i = min(first + (integer)(0, 1, 2, 3, 4, 5, 6, 7), size.x - 1);
#elif REAL_WIDTH == 4
  const integer i = min(first + (integer)(0, 1, 2, 3), size.x - 1);
#else
  const integer i = first;
#endif
  const integer voxel = i + (k * size.y + j) * size.x;
  real scatters = (real)0.0f;
#define SCATTERS(n)                                                           \
  LANE(scatters, n) = channel_of(scattering, LANE(voxel, n), SCATTERING, 0) + \
    channel_of(scattering, LANE(voxel, n), SCATTERING, 1) + channel_of(scattering, LANE(voxel, n), SCATTERING, 2);
  EACH_LANE(SCATTERS)
#undef SCATTERS
  rgb towards_eye = { (real)0.0f, (real)0.0f, (real)0.0f };
  rgb irradiance = { (real)0.0f, (real)0.0f, (real)0.0f };
  const real3 centre = { to_real(i) + (real)0.5f, (real)((float)j + 0.5f), (real)((float)k + 0.5f) };
  const real3 place = { centre.x * (real)spacing.x, centre.y * (real)spacing.y, centre.z * (real)spacing.z };
  // Towards the eye: back along the view axis where rays are parallel.
  const real perspective = (real)(1.0f - eye.w);
  real3 out = { fma(perspective, (real)eye.x - place.x, (real)(-eye.w * forward.x)),
    fma(perspective, (real)eye.y - place.y, (real)(-eye.w * forward.y)),
    fma(perspective, (real)eye.z - place.z, (real)(-eye.w * forward.z)) };
  const real out_scale = (real)1.0f / sqrt(greater(fma(out.x, out.x, fma(out.y, out.y, out.z * out.z)), (real)1e-30f));

  for (int n = 0; n < light_count && any_lane(scatters > (real)0.0f); ++n)
  {
    const small_light light = lights[n];
    const real point = (real)light.place.w;
    // To the light, and what would arrive through vacuum.
    const real3 to = { fma(point, (real)light.place.x - place.x, (real)((light.place.w - 1.0f) * light.axis.x)),
      fma(point, (real)light.place.y - place.y, (real)((light.place.w - 1.0f) * light.axis.y)),
      fma(point, (real)light.place.z - place.z, (real)((light.place.w - 1.0f) * light.axis.z)) };
    const real square = greater(fma(to.x, to.x, fma(to.y, to.y, to.z * to.z)), (real)1e-30f);
    const real distance = sqrt(square);
    const real inverse = (real)1.0f / distance;
    const real3 d = { to.x * inverse, to.y * inverse, to.z * inverse };
    const real to_axis = -fma(d.x, (real)light.axis.x, fma(d.y, (real)light.axis.y, d.z * (real)light.axis.z));
    real arriving = point > (real)0.0f ? (real)1.0f / greater(square, (real)nearest_square) : (real)1.0f;
    arriving *= light.power.w > 0.0f ? greater(to_axis, (real)0.0f) : (real)1.0f;
    arriving = to_axis >= (real)light.axis.w ? arriving : (real)0.0f;
    arriving = scatters > (real)0.0f ? arriving : (real)0.0f;
    if (!any_lane(arriving > (real)0.0f))
    {
      continue;
    }

    // What the medium on the way takes.
#if MANY_STEPS
#define PASS(sigma, sum, rest) add_to(&sum, &rest, sigma* length);
#else
#define PASS(sigma, sum, rest) sum = fma(sigma, length, sum);
#endif
    const real3 direction = { d.x / (real)spacing.x, d.y / (real)spacing.y, d.z / (real)spacing.z };
    real before;
    const rays packet = clip_to_box(centre, direction, point > (real)0.0f ? distance : (real)1e30f, size, &before);
    const real stride = step_length(direction, step);
    const real3 strides = strides_per_voxel(direction, stride);
    const int steps = (int)ceil(most_lanes(arriving > (real)0.0f ? packet.length / stride : (real)0.0f));
    rgb depths = { (real)0.0f, (real)0.0f, (real)0.0f };
    rgb rests = depths; // see add_to
    real depth = (real)0.0f;
    for (int m = 0; m < steps;)
    {
      const real so_far = stride * (real)(float)m;
#if COLOURED
      const real least = lesser(lesser(depths.r, depths.g), depths.b);
#else
      const real least = depth;
#endif
      const integer done = (so_far >= packet.length) | (least > (real)30.0f) | (arriving <= (real)0.0f);
      if (all_lanes(done))
      {
        break;
      }
      const stretch ahead =
        stretch_ahead(bricks, brick_count, along(packet, fma(stride, (real)0.5f, so_far)), strides, done);
      const int stop = min(m + ahead.steps, steps);
      for (m = ahead.empty ? stop : m; m < stop; ++m)
      {
        const real start = stride * (real)(float)m;
        const real length = lesser(greater(packet.length - start, (real)0.0f), stride);
        corners at;
        find_corners(along(packet, fma(length, (real)0.5f, start)), size, &at);
        rgb colour;
        real w;
#if COLOURED
        gather(extinctions, &at, size, &colour, &w);
        PASS(colour.r, depths.r, rests.r)
        PASS(colour.g, depths.g, rests.g)
        PASS(colour.b, depths.b, rests.b)
#else
        gather_samples(samples, &at, size, &colour, &w);
        PASS(w, depth, rests.r)
#endif
      }
    }

#undef PASS

    // Henyey and Greenstein's phase function; the light travels along -d.
    const real cosine = -(fma(d.x, out.x, fma(d.y, out.y, d.z * out.z))) * out_scale;
    const real base = greater(fma((real)(-2.0f * g), cosine, (real)(1.0f + g * g)), (real)1e-12f);
    const real phase = (real)(PER_SPHERE * (1.0f - g * g)) / (base * sqrt(base));
#if COLOURED
    real left;
    extinguished(depths.r, &left);
    const real red = arriving * left * (real)light.power.x;
    extinguished(depths.g, &left);
    const real green = arriving * left * (real)light.power.y;
    extinguished(depths.b, &left);
    const real blue = arriving * left * (real)light.power.z;
#else
    real left;
    extinguished(depth, &left);
    const real red = arriving * left * (real)light.power.x;
    const real green = arriving * left * (real)light.power.y;
    const real blue = arriving * left * (real)light.power.z;
#endif
    irradiance.r += red;
    irradiance.g += green;
    irradiance.b += blue;
    towards_eye.r = fma(red, phase, towards_eye.r);
    towards_eye.g = fma(green, phase, towards_eye.g);
    towards_eye.b = fma(blue, phase, towards_eye.b);
  }

  // Lanes beyond the last voxel repeat it, and write the same again.
#define KEEP(n)                                         \
  {                                                     \
    __global float* kept = direct + 6 * LANE(voxel, n); \
    kept[0] = LANE(towards_eye.r, n);                   \
    kept[1] = LANE(towards_eye.g, n);                   \
    kept[2] = LANE(towards_eye.b, n);                   \
    kept[3] = LANE(irradiance.r, n);                    \
    kept[4] = LANE(irradiance.g, n);                    \
    kept[5] = LANE(irradiance.b, n);                    \
  }
  EACH_LANE(KEEP)
#undef KEEP
}
