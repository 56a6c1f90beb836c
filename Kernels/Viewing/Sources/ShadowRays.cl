// Direct light of the lamps in each voxel, and its scattering towards the eye.
//
// Macros set by the host:
//   PHASE, PHASE_CHANNELS  see PhaseFunction.cl
//   AUREOLE  number of tables of repeated forward scattering: 0, 1, or 3 for red, green and blue

#include "Viewing/Samples/PhaseFunction.cl"
#include "Viewing/Samples/Sampling.cl"
#include "Viewing/Samples/VoxelChannels.cl"
#include "Viewing/Scene/ViewShared.h"

// Shadow rays of a packet of voxels: unit vectors to the light, distances to it (world coordinates), and its
// unattenuated irradiance per unit of SmallLight::power.
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
  // Whether a direction lies in the cone is tested with tan(angle / 2) = sine / (1 + cosine), because the cosine alone
  // does not resolve small angles.
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
// Directions of shadow rays, voxels per unit length.
inline real3 direction_of(const ShadowInfo* info, const way_to_light* way)
{
  const real3 direction = { way->d.x / (real)info->spacing.x, way->d.y / (real)info->spacing.y,
    way->d.z / (real)info->spacing.z };
  return direction;
}

// Optical length along the shadow rays: three channels with COLOURED, else `r` only. The march stops above 30, where
// the transmittance is negligible.
//   packet  section of the rays to march through
//   sigma   packed samples: coloured extinctions with COLOURED, else sources and extinctions
inline rgb depths_on_the_way(const ShadowInfo* info, const way_to_light* way, rays packet, __global const float4* sigma,
  __global const char* bricks)
{
  const real stride = step_length(packet.direction, info->step);
  const real3 strides = strides_per_voxel(packet.direction, stride);
  const int steps = (int)ceil(most_lanes(way->arriving > (real)0.0f ? packet.length / stride : (real)0.0f));
  rgb depths = { (real)0.0f, (real)0.0f, (real)0.0f };
  rgb rests = depths; // Kahan compensation of the optical lengths, see add_to
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
      gather(sigma, &at, info->size, &colour, &w);
      PASS(colour.r, depths.r, rests.r)
      PASS(colour.g, depths.g, rests.g)
      PASS(colour.b, depths.b, rests.b)
#else
      gather_samples(sigma, &at, info->size, &colour, &w);
      PASS(w, depths.r, rests.r)
#endif
    }
  }
  return depths;
}
#undef PASS

// Irradiance by a light after attenuation by the medium, W / length^2.
//   arriving  irradiance without attenuation per unit of power
//   depths    optical lengths along the shadow rays
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

// Phase function of one channel, per steradian, at a cosine of the scattering angle.
//   first, second, part  g of the first and of the second lobe, and fraction of light scattered in the first
//                        (PhaseInfo)
//   rows  table of the phase function, with PHASE 2 and 5
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
// Value of a table by AureoleTable at a cosine of the scattering angle and at the optical length `depth` of scattering
// along the beam, multiplied by `depth`.
inline real aureole_at(real cosine, real depth, __global const float* rows)
{
  const real deep = sqrt(lesser(depth * (real)(1.0f / AureoleDepth), (real)1.0f)) * (real)(float)AureoleRows;
  return depth * between_cosines(rows, deep, cosine, AureoleColumns);
}

// Factor from the optical length of a ray, in which a fraction of the scattering is treated as unscattered, to the
// optical length of all scattering along the ray. The voxel's own factor is used for the whole ray.
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

// Adds to `radiance`, W / (length^2 sr), the light that repeated forward scattering adds to the first scattering of a
// lamp's beam (AureoleTable in SeenSources.h).
//   arrived  irradiance by the light, W / length^2
//   depths   optical lengths along the shadow rays
//   cosine   cosine of the angle between the beam and the direction towards the eye
//   aureole  tables by AureoleTable, one per channel with AUREOLE 3
inline void add_aureole(const ShadowInfo* info, __global const float* absorption, __global const float* scattering,
  __global const float* straight_on, __global const float* aureole, integer voxel, rgb arrived, rgb depths, real cosine,
  rgb* radiance)
{
  const int apart = AUREOLE == 3 ? (AureoleRows + 2) * (AureoleColumns + 2) : 0;
#if COLOURED
#define DEPTH(c) depths.c
#else
#define DEPTH(c) depths.r
#endif
#define SPREAD(c, n)                                                                                      \
  radiance->c = fma(arrived.c,                                                                            \
    aureole_at(cosine,                                                                                    \
      DEPTH(c) * scattering_over_depth(absorption, scattering, straight_on, &info->components, voxel, n), \
      aureole + n * apart),                                                                               \
    radiance->c);
  SPREAD(r, 0)
  SPREAD(g, 1)
  SPREAD(b, 2)
#undef SPREAD
#undef DEPTH
}
#endif

// Parameters of the phase function in a packet's voxels.
inline phase_parameters phases_of(const ShadowInfo* info, integer voxel, __global const float* mean_cosines)
{
  phase_parameters p = parameters_of(&info->phase);
  const int components = info->components.meanCosines;
  if (components > 0) // g varies by voxel
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

// Indices along x of the adjacent voxels that a packet holds, one per lane (vector element). Lanes beyond the row's end
// repeat its last voxel, so that several lanes write equal values.
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

// Reads three adjacent numbers, from index `first` on, of the `stride` numbers of each voxel of a packet.
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

// Writes three adjacent numbers, from index `first` on, of the `stride` numbers of each voxel of a packet.
inline void put_triples(__global float* values, integer voxel, int stride, int first, rgb triple)
{
#define WRITE(n)                                                   \
  values[stride * LANE(voxel, n) + first] = LANE(triple.r, n);     \
  values[stride * LANE(voxel, n) + first + 1] = LANE(triple.g, n); \
  values[stride * LANE(voxel, n) + first + 2] = LANE(triple.b, n);
  EACH_LANE(WRITE)
#undef WRITE
}

// Computes the optical lengths, within this block, of the paths between the voxels of a box of the whole grid and the
// light `firstLight`. One work-item per packet of voxels.
//   depths  3 per voxel, for red, green and blue; without COLOURED only the first, the others are 0
__kernel void find_depths(ShadowInfo info, __global const SmallLight* restrict lights,
  __global const float4* restrict sigma, __global const char* restrict bricks, __global float* restrict depths)
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
  real before;
  integer enters, leaves;
  const rays packet =
    clip_to_block(centre, direction_of(&info, &way), way.distance, &info.block, info.step, &before, &enters, &leaves);
  put_triples(depths, i + (k * info.askedSize.y + j) * info.askedSize.x, 3, 0,
    depths_on_the_way(&info, &way, packet, sigma, bricks));
}

// Scattering coefficients of a packet's voxels, 1/length, summed over the channels. With info->beside, a voxel that
// does not scatter but has a scattering neighbour receives 1, because rays interpolate between such voxels.
inline real scattering_of_voxels(const ShadowInfo* info, __global const float* scattering, integer voxel)
{
  real scatters = (real)0.0f;
  const int components = info->components.scattering;
#define SCATTERS(n)                                                           \
  LANE(scatters, n) = channel_of(scattering, LANE(voxel, n), components, 0) + \
    channel_of(scattering, LANE(voxel, n), components, 1) + channel_of(scattering, LANE(voxel, n), components, 2);
  EACH_LANE(SCATTERS)
#undef SCATTERS
  if (info->beside)
  {
#define SCATTERS_BESIDE(n)                                                                                      \
  if (!(LANE(scatters, n) > 0.0f))                                                                              \
  {                                                                                                             \
    LANE(scatters, n) = is_beside_scattering(scattering, LANE(voxel, n), components, info->size) ? 1.0f : 0.0f; \
  }
    EACH_LANE(SCATTERS_BESIDE)
#undef SCATTERS_BESIDE
  }
  return scatters;
}

// Vectors from points towards the eye, not normalised; opposite to the view axis in a parallel projection.
//   place  points in world coordinates
inline real3 way_to_eye(const ShadowInfo* info, real3 place)
{
  const real perspective = (real)(1.0f - info->eye.w);
  const real3 out = { fma(perspective, (real)info->eye.x - place.x, (real)(-info->eye.w * info->forward.x)),
    fma(perspective, (real)info->eye.y - place.y, (real)(-info->eye.w * info->forward.y)),
    fma(perspective, (real)info->eye.z - place.z, (real)(-info->eye.w * info->forward.z)) };
  return out;
}

// Optical lengths between a packet's voxels and a light, see depths_on_the_way.
//   centre  centres of the voxels, in voxels of the whole grid
//   given   the lengths that see_lights receives, returned if info->isGiven; otherwise the lengths are computed
inline rgb depths_to_light(const ShadowInfo* info, const way_to_light* way, real3 centre, integer voxel,
  __global const float* given, __global const float4* sigma, __global const char* bricks)
{
  if (info->isGiven)
  {
    return triples_of(given, voxel - info->size.x * (info->firstRow + info->size.y * info->firstSlice), 3, 0);
  }
  real before;
  const rays packet = clip_to_box(centre, direction_of(info, way), way->distance, info->size, &before);
  return depths_on_the_way(info, way, packet, sigma, bricks);
}

// Computes the direct light of the lamps at each voxel's centre, and its scattering towards the eye. One work-item per
// packet of voxels.
//   direct  6 per voxel: sum of irradiance times phase function, W / (length^2 sr), and sum of irradiance, W /
//           length^2; with AUREOLE, in place of the irradiance, the radiance added by repeated forward scattering, W /
//           (length^2 sr). The light is added to the present values if firstLight > 0
//   sigma   packed samples, see depths_on_the_way
//   given   if info.isGiven: optical lengths towards the single light, summed over all blocks of a larger grid, 3 per
//           voxel from the launch's first row on
__kernel void see_lights(ShadowInfo info, __global const SmallLight* restrict lights,
  __global const float* restrict scattering, __global const float* restrict mean_cosines,
  __global const float* restrict phase_rows, __global const float4* restrict sigma,
  __global const char* restrict bricks, __global const float* restrict absorption,
  __global const float* restrict straight_on, __global const float* restrict aureole,
  __global const float* restrict given, __global float* restrict direct)
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
  const real scatters = scattering_of_voxels(&info, scattering, voxel);
  const int4 begin = info.block.first;
  const real3 centre = { to_real(i + begin.x) + (real)0.5f, (real)((float)(j + begin.y) + 0.5f),
    (real)((float)(k + begin.z) + 0.5f) }; // in voxels of the whole grid
  const real3 place = { centre.x * (real)info.spacing.x, centre.y * (real)info.spacing.y,
    centre.z * (real)info.spacing.z };
  const real3 out = way_to_eye(&info, place);
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
    const rgb depths = depths_to_light(&info, &way, centre, voxel, given, sigma, bricks);
    const rgb arrived = arriving_through(&light, way.arriving, depths);
    // The light travels along -way.d.
    const real cosine = -(fma(way.d.x, out.x, fma(way.d.y, out.y, way.d.z * out.z))) * out_scale;
    const rgb phase = phase_at(cosine, scatters_by, phase_rows);
#if AUREOLE
    add_aureole(&info, absorption, scattering, straight_on, aureole, voxel, arrived, depths, cosine, &irradiance);
#else
    irradiance.r += arrived.r;
    irradiance.g += arrived.g;
    irradiance.b += arrived.b;
#endif
    towards_eye.r = fma(arrived.r, phase.r, towards_eye.r);
    towards_eye.g = fma(arrived.g, phase.g, towards_eye.g);
    towards_eye.b = fma(arrived.b, phase.b, towards_eye.b);
  }

  put_triples(direct, voxel, 6, 0, towards_eye);
  put_triples(direct, voxel, 6, 3, irradiance);
}
