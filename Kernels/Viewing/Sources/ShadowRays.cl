// What the lights send straight to each voxel, and what is scattered of it towards the eye. The host gives
//   PHASE, PHASE_CHANNELS  see PhaseFunction.cl
//   AUREOLE      tables of what is scattered forwards more than once: 0, 1, or 3 for red, green and blue
//   BESIDE       1: also in voxels beside such that scatter
//   GIVEN        1: the medium is a block of a larger grid, and optical lengths towards a light are added up from what
//                each block finds of them

#include "Viewing/Samples/Beside.cl"
#include "Viewing/Samples/BlockRays.cl"
#include "Viewing/Samples/PhaseFunction.cl"
#include "Viewing/Samples/Sampling.cl"
#include "Viewing/Samples/VoxelChannels.cl"
#include "Viewing/Scene/ViewShared.h"

// A packet's way to a light: unit vectors to it and distances (world), and what would arrive through vacuum.
typedef struct
{
  real3 d;
  real distance, arriving;
} way_to_light;

inline way_to_light towards(const SmallLight* light, real3 place, real scatters, float nearest_square)
{
  const real point = (real)light->place.w;
  const real3 to = { fma(point, (real)light->place.x - place.x, (real)((light->place.w - 1.0f) * light->axis.x)),
    fma(point, (real)light->place.y - place.y, (real)((light->place.w - 1.0f) * light->axis.y)),
    fma(point, (real)light->place.z - place.z, (real)((light->place.w - 1.0f) * light->axis.z)) };
  const real square = greater(fma(to.x, to.x, fma(to.y, to.y, to.z * to.z)), (real)1e-30f);
  const real distance = sqrt(square);
  const real inverse = (real)1.0f / distance;
  const real3 d = { to.x * inverse, to.y * inverse, to.z * inverse };
  const real to_axis = -fma(d.x, (real)light->axis.x, fma(d.y, (real)light->axis.y, d.z * (real)light->axis.z));
  real arriving = point > (real)0.0f ? (real)1.0f / greater(square, (real)nearest_square) : (real)1.0f;
  arriving *= light->power.w > 0.0f ? greater(to_axis, (real)0.0f) : (real)1.0f;
  // tan(angle / 2) = sine / (1 + cosine): a cosine alone does not tell small angles from 0.
  const real3 across = { fma(d.y, (real)light->axis.z, -d.z * light->axis.y),
    fma(d.z, (real)light->axis.x, -d.x * light->axis.z), fma(d.x, (real)light->axis.y, -d.y * light->axis.x) };
  const real sine = sqrt(fma(across.x, across.x, fma(across.y, across.y, across.z * across.z)));
  const real most = fma((real)light->axis.w, (real)1.0f + to_axis, (real)(light->axis.w > 0.0f ? 0.0f : 2.0f));
  arriving = sine <= most ? arriving : (real)0.0f;
  arriving = scatters > (real)0.0f ? arriving : (real)0.0f;
  const way_to_light way = { d, point > (real)0.0f ? distance : (real)1e30f, arriving };
  return way;
}

#if MANY_STEPS
#define PASS(sigma, sum, rest) add_to(&sum, &rest, sigma* length);
#else
#define PASS(sigma, sum, rest) sum = fma(sigma, length, sum);
#endif
// Optical length of the medium on the way, by channel where COLOURED, else in `r`; 30 and more is as good as any.
//   centre  of voxels; with GIVEN of the whole, and only what of the way lies in the block counts
inline rgb depths_on_the_way(const ShadowInfo* info, const way_to_light* way, real3 centre,
  __global const float4* samples, __global const float4* extinctions, __global const char* bricks)
{
  const real3 direction = { way->d.x / (real)info->spacing.x, way->d.y / (real)info->spacing.y,
    way->d.z / (real)info->spacing.z };
  real before;
#if GIVEN
  integer enters, leaves;
  const rays packet =
    clip_to_block(centre, direction, way->distance, &info->block, info->step, &before, &enters, &leaves);
#else
  const rays packet = clip_to_box(centre, direction, way->distance, info->size, &before);
#endif
  const real stride = step_length(direction, info->step);
  const real3 strides = strides_per_voxel(direction, stride);
  const int steps = (int)ceil(most_lanes(way->arriving > (real)0.0f ? packet.length / stride : (real)0.0f));
  rgb depths = { (real)0.0f, (real)0.0f, (real)0.0f };
  rgb rests = depths; // see add_to
  for (int m = 0; m < steps;)
  {
    const real so_far = stride * (real)(float)m;
#if COLOURED
    const real least = lesser(lesser(depths.r, depths.g), depths.b);
#else
    const real least = depths.r;
#endif
    const integer done = (so_far >= packet.length) | (least > (real)30.0f) | (way->arriving <= (real)0.0f);
    if (all_lanes(done))
    {
      break;
    }
    const stretch ahead =
      stretch_ahead(bricks, info->bricks, along(packet, fma(stride, (real)0.5f, so_far)), strides, done);
    const int stop = min(m + ahead.steps, steps);
    for (m = ahead.empty ? stop : m; m < stop; ++m)
    {
      const real start = stride * (real)(float)m;
      const real length = lesser(greater(packet.length - start, (real)0.0f), stride);
      corners at;
      find_corners(along(packet, fma(length, (real)0.5f, start)), info->size, &at);
      rgb colour;
      real w;
#if COLOURED
      gather(extinctions, &at, info->size, &colour, &w);
      PASS(colour.r, depths.r, rests.r)
      PASS(colour.g, depths.g, rests.g)
      PASS(colour.b, depths.b, rests.b)
#else
      gather_samples(samples, &at, info->size, &colour, &w);
      PASS(w, depths.r, rests.r)
#endif
    }
  }
  return depths;
}
#undef PASS

// What arrives of a light's power through the medium, W / length^2.
inline rgb arriving_through(const SmallLight* light, real arriving, rgb depths)
{
  rgb left;
#if COLOURED
  extinguished(depths.r, &left.r);
  extinguished(depths.g, &left.g);
  extinguished(depths.b, &left.b);
#else
  extinguished(depths.r, &left.r);
  left.g = left.b = left.r;
#endif
  const rgb power = { arriving * left.r * (real)light->power.x, arriving * left.g * (real)light->power.y,
    arriving * left.b * (real)light->power.z };
  return power;
}

// The phase function of one channel, per steradian, by the cosine of the scattering angle.
inline real phase_of_channel(real cosine, real first, real second, real part, __global const float* rows)
{
#if PHASE == 1
  const real base = greater(fma((real)(-2.0f) * first, cosine, (real)1.0f + first * first), (real)1e-12f);
  return (real)PER_SPHERE * ((real)1.0f - first * first) / (base * sqrt(base));
#else
  return (real)PER_SPHERE * scattered_of_channel((real)1.0f, -cosine, first, second, part, rows);
#endif
}

inline rgb phase_at(real cosine, phase_parameters p, __global const float* rows)
{
  rgb f;
  f.r = phase_of_channel(cosine, p.first.r, p.second.r, p.part.r, rows);
#if PHASE_CHANNELS == 3
  const int apart = PHASE == 5 ? (SpreadRows + 2) * (CosineRows + 2) : 0;
  f.g = phase_of_channel(cosine, p.first.g, p.second.g, p.part.g, rows + apart);
  f.b = phase_of_channel(cosine, p.first.b, p.second.b, p.part.b, rows + 2 * apart);
#else
  f.g = f.b = f.r;
#endif
  return f;
}

#if AUREOLE
// Of a table of Aureole.h times the depth: by the cosine, and by the root of the depth.
inline real aureole_at(real cosine, real depth, __global const float* rows)
{
  const real deep = sqrt(lesser(depth * (real)(1.0f / AureoleDepth), (real)1.0f)) * (real)(float)AureoleRows;
  return depth * between_cosines(rows, deep, cosine, AureoleColumns);
}

// Optical length of all scattering, straight on or not, over that of the extinction that rays are marched with: taken
// as the voxel's own on the whole way.
inline real scattering_over_depth(__global const float* absorption, __global const float* scattering,
  __global const float* straight_on, const ViewedComponents* of, integer voxel, int channel)
{
  real over;
#define RATIO(n)                                                                                        \
  {                                                                                                     \
    const float s = channel_of(scattering, LANE(voxel, n), of->scattering, channel);                    \
    const float turned = s * (1.0f - channel_of(straight_on, LANE(voxel, n), of->straightOn, channel)); \
    const float all = turned + channel_of(absorption, LANE(voxel, n), of->absorption, channel);         \
    LANE(over, n) = all > 0.0f ? s / all : 0.0f;                                                        \
  }
  EACH_LANE(RATIO)
#undef RATIO
  return over;
}
#endif

// How the voxels of a packet scatter.
inline phase_parameters phases_of(const ShadowInfo* info, integer voxel, __global const float* mean_cosines)
{
  phase_parameters p = parameters_of(&info->phase);
  const int components = info->components.meanCosines;
  if (components > 0) // g differs by voxel
  {
#define READ(n)                                                                 \
  LANE(p.first.r, n) = channel_of(mean_cosines, LANE(voxel, n), components, 0); \
  LANE(p.first.g, n) = channel_of(mean_cosines, LANE(voxel, n), components, 1); \
  LANE(p.first.b, n) = channel_of(mean_cosines, LANE(voxel, n), components, 2);
    EACH_LANE(READ)
#undef READ
  }
  return p;
}

// The voxels of a packet along x; beyond the row's end its last one, which is then written several times alike.
inline integer packet_along_x(int first, int size)
{
#if REAL_WIDTH == 16
  return min(first + (integer)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15), size - 1);
#elif REAL_WIDTH == 8
  return min(first + (integer)(0, 1, 2, 3, 4, 5, 6, 7), size - 1);
#elif REAL_WIDTH == 4
  return min(first + (integer)(0, 1, 2, 3), size - 1);
#else
  return first;
#endif
}

// Three numbers of each of a packet's voxels.
inline rgb triples_of(__global const float* values, integer voxel, int stride, int first)
{
  rgb found;
#define READ(n)                                                   \
  LANE(found.r, n) = values[stride * LANE(voxel, n) + first];     \
  LANE(found.g, n) = values[stride * LANE(voxel, n) + first + 1]; \
  LANE(found.b, n) = values[stride * LANE(voxel, n) + first + 2];
  EACH_LANE(READ)
#undef READ
  return found;
}

#if GIVEN
// What the block adds to the optical lengths between the voxels of a box of the whole and the light `firstLight`.
// Work-items by packets of a slice.
//   depths  3 per voxel, see depths_on_the_way
__kernel void find_depths(ShadowInfo info, __global const SmallLight* restrict lights,
  __global const float4* restrict samples, __global const float4* restrict extinctions,
  __global const char* restrict bricks, __global float* restrict depths)
{
  const int first = get_global_id(0) * REAL_WIDTH;
  const int j = get_global_id(1) + info.firstRow;
  const int k = get_global_id(2) + info.firstSlice;
  if (first >= info.askedSize.x || j >= info.askedSize.y)
  {
    return;
  }
  const integer i = packet_along_x(first, info.askedSize.x);
  const real3 centre = { to_real(i + info.asked.x) + (real)0.5f, (real)((float)(j + info.asked.y) + 0.5f),
    (real)((float)(k + info.asked.z) + 0.5f) };
  const real3 place = { centre.x * (real)info.spacing.x, centre.y * (real)info.spacing.y,
    centre.z * (real)info.spacing.z };
  const SmallLight light = lights[info.firstLight];
  const way_to_light way = towards(&light, place, (real)1.0f, info.nearestSquare);
  const rgb found = depths_on_the_way(&info, &way, centre, samples, extinctions, bricks);
  const integer voxel = i + (k * info.askedSize.y + j) * info.askedSize.x;
#define KEEP(n)                                         \
  {                                                     \
    __global float* kept = depths + 3 * LANE(voxel, n); \
    kept[0] = LANE(found.r, n);                         \
    kept[1] = LANE(found.g, n);                         \
    kept[2] = LANE(found.b, n);                         \
  }
  EACH_LANE(KEEP)
#undef KEEP
}
#endif

// Scatters towards the eye what the lights send straight to each voxel's centre. Work-items by packets of a slice.
//   direct  6 per voxel: sum of irradiance times phase function, W / (length^2 sr), and sum of irradiance, W /
//           length^2; with AUREOLE instead what scattering forwards more than once adds, W / (length^2 sr). Added to
//           what is there where firstLight is not the first
//   given   with GIVEN: 3 for each voxel from the first row of the launch on, optical lengths towards the only light
__kernel void see_lights(ShadowInfo info, __global const SmallLight* restrict lights,
  __global const float* restrict scattering, __global const float* restrict mean_cosines,
  __global const float* restrict phase_rows, __global const float4* restrict samples,
  __global const float4* restrict extinctions, __global const char* restrict bricks,
  __global const float* restrict absorption, __global const float* restrict straight_on,
  __global const float* restrict aureole, __global const float* restrict given, __global float* restrict direct)
{
  const int first = get_global_id(0) * REAL_WIDTH;
  const int j = get_global_id(1) + info.firstRow;
  const int k = get_global_id(2) + info.firstSlice;
  if (first >= info.size.x || j >= info.size.y)
  {
    return;
  }
  const integer i = packet_along_x(first, info.size.x);
  const integer voxel = i + (k * info.size.y + j) * info.size.x;
  real scatters = (real)0.0f;
  const int components = info.components.scattering;
#define SCATTERS(n)                                                           \
  LANE(scatters, n) = channel_of(scattering, LANE(voxel, n), components, 0) + \
    channel_of(scattering, LANE(voxel, n), components, 1) + channel_of(scattering, LANE(voxel, n), components, 2);
  EACH_LANE(SCATTERS)
#undef SCATTERS
#if BESIDE
#define SCATTERS_BESIDE(n)                                                                                     \
  if (!(LANE(scatters, n) > 0.0f))                                                                             \
  {                                                                                                            \
    LANE(scatters, n) = is_beside_scattering(scattering, LANE(voxel, n), components, info.size) ? 1.0f : 0.0f; \
  }
  EACH_LANE(SCATTERS_BESIDE)
#undef SCATTERS_BESIDE
#endif
  const int4 begin = info.block.first;
  const real3 centre = { to_real(i + begin.x) + (real)0.5f, (real)((float)(j + begin.y) + 0.5f),
    (real)((float)(k + begin.z) + 0.5f) }; // in the whole
  const real3 place = { centre.x * (real)info.spacing.x, centre.y * (real)info.spacing.y,
    centre.z * (real)info.spacing.z };
  // Towards the eye: back along the view axis where rays are parallel.
  const real perspective = (real)(1.0f - info.eye.w);
  const real3 out = { fma(perspective, (real)info.eye.x - place.x, (real)(-info.eye.w * info.forward.x)),
    fma(perspective, (real)info.eye.y - place.y, (real)(-info.eye.w * info.forward.y)),
    fma(perspective, (real)info.eye.z - place.z, (real)(-info.eye.w * info.forward.z)) };
  const real out_scale = (real)1.0f / sqrt(greater(fma(out.x, out.x, fma(out.y, out.y, out.z * out.z)), (real)1e-30f));

  const phase_parameters scatters_by = phases_of(&info, voxel, mean_cosines);
  rgb towards_eye = { (real)0.0f, (real)0.0f, (real)0.0f };
  rgb irradiance = towards_eye;
  if (info.firstLight > 0)
  {
    towards_eye = triples_of(direct, voxel, 6, 0);
    irradiance = triples_of(direct, voxel, 6, 3);
  }
  for (int n = info.firstLight; n < info.lights && any_lane(scatters > (real)0.0f); ++n)
  {
    const SmallLight light = lights[n];
    const way_to_light way = towards(&light, place, scatters, info.nearestSquare);
    if (!any_lane(way.arriving > (real)0.0f))
    {
      continue;
    }
#if GIVEN
    const int before = info.size.x * (info.firstRow + info.size.y * info.firstSlice);
    const rgb depths = triples_of(given, voxel - before, 3, 0);
#else
    const rgb depths = depths_on_the_way(&info, &way, centre, samples, extinctions, bricks);
#endif
    const rgb arrived = arriving_through(&light, way.arriving, depths);
    // The light travels along -d.
    const real cosine = -(fma(way.d.x, out.x, fma(way.d.y, out.y, way.d.z * out.z))) * out_scale;
    const rgb phase = phase_at(cosine, scatters_by, phase_rows);
#if AUREOLE
    const int apart = AUREOLE == 3 ? (AureoleRows + 2) * (AureoleColumns + 2) : 0;
#if COLOURED
#define DEPTH(c) depths.c
#else
#define DEPTH(c) depths.r
#endif
#define SPREAD(c, n)                                                                                     \
  irradiance.c = fma(arrived.c,                                                                          \
    aureole_at(cosine,                                                                                   \
      DEPTH(c) * scattering_over_depth(absorption, scattering, straight_on, &info.components, voxel, n), \
      aureole + n * apart),                                                                              \
    irradiance.c);
    SPREAD(r, 0)
    SPREAD(g, 1)
    SPREAD(b, 2)
#undef SPREAD
#undef DEPTH
#else
    irradiance.r += arrived.r;
    irradiance.g += arrived.g;
    irradiance.b += arrived.b;
#endif
    towards_eye.r = fma(arrived.r, phase.r, towards_eye.r);
    towards_eye.g = fma(arrived.g, phase.g, towards_eye.g);
    towards_eye.b = fma(arrived.b, phase.b, towards_eye.b);
  }

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
