// Source of optically thick voxels in each octant of directions, in addition to the uniform source; see
// OctantSources.h. Faces d of a voxel are -x, +x, -y, +y, -z, +z.

#include "LightPropagation/Sweep/BeyondFacesShared.h"
#include "LightPropagation/Sweep/FallOfLight.cl"
#include "LightPropagation/ThickVoxels/OctantSourcesShared.h"

typedef struct
{
  // Coefficients alpha (antisymmetric in the two faces) and beta (symmetric) of VoxelResponse
  float differs, alike;
  float lost;
} layer_response;

// Response of a layer as thick as a voxel to light that enters it, interpolated in a table of VoxelResponse. For
// layers thinner than those of the table the values are proportional to the thickness.
static layer_response response_of(const __global float* values, float albedo, float tau)
{
  const float depth = clamp(2.0f * (log2(fmax(tau, 1e-30f)) - FirstDepth), 0.0f, ResponseDepths - 1.001f);
  const float place = clamp(sqrt(fmax(1.0f - albedo, 0.0f)) * (ResponseAlbedos - 1), 0.0f, ResponseAlbedos - 1.001f);
  const float u = place - floor(place), v = depth - floor(depth);
  const __global float* low = values + ResponseParts * ((int)place * ResponseDepths + (int)depth);
  const __global float* high = low + ResponseParts * ResponseDepths;
  const float thin = clamp(tau * exp2((float)-FirstDepth), 0.0f, 1.0f);
  layer_response found;
  found.differs = thin * mix(mix(low[0], low[ResponseParts], v), mix(high[0], high[ResponseParts], v), u);
  found.alike = thin * mix(mix(low[1], low[ResponseParts + 1], v), mix(high[1], high[ResponseParts + 1], v), u);
  found.lost = thin * mix(low[2], low[ResponseParts + 2], v);
  return found;
}

#define VOXEL_AT                                                              \
  const int at[3] = { get_global_id(0), get_global_id(1), get_global_id(2) }; \
  const ulong i = ((ulong)at[2] * info.size[1] + at[1]) * info.size[0] + at[0];

// Converts the power that entered through voxels' faces to mean incident radiance. One work-item per row of voxels and
// face.
//   currents  entered power, W, [face][voxel] from index 6 `first` on; set to 0
//   pattern   power of the rays that cross each face at uniform radiance, relative to its mean (SweepModel.h)
//   incoming  radiance, W / (length^2 sr), laid out as currents; replaced if `fresh` is 1, else added to
__kernel void take_incoming(OctantSourceInfo info, __global float* restrict currents,
  const __global float* restrict pattern, __global float* restrict incoming, int fresh)
{
  const int y = get_global_id(0), z = get_global_id(1), d = get_global_id(2);
  const int axis = d / 2;
  const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  const float area = info.perRadiance * info.spacing[u] * info.spacing[v];
  // The crossing pattern of a face is the sum of two terms: one for its position along u, one for its position along v.
  // The second is constant within the row; for faces normal to x, so is the first.
  const __global float* along = pattern + info.pattern[2 * axis];
  const float ofRow = pattern[info.pattern[2 * axis + 1] + (v == 1 ? y : z)];
  const ulong row = 6 * info.first + d * info.stride + ((ulong)z * info.size[1] + y) * info.size[0];
  for (int x = 0; x < info.size[0]; ++x)
  {
    const float even = area * ((axis == 0 ? along[y] : along[x]) + ofRow);
    const float radiance = even > 0.0f ? currents[row + x] / even : 0.0f;
    incoming[row + x] = fresh ? radiance : incoming[row + x] + radiance;
    currents[row + x] = 0.0f;
  }
}

// Index of a voxel's neighbour across face d; -1 if there is none in the box or subdomain.
static long next_voxel(const OctantSourceInfo* info, const int* at, ulong i, int d)
{
  const int axis = d / 2, size = info->size[axis];
  const long step = axis == 0 ? 1 : axis == 1 ? info->size[0] : (long)info->size[0] * info->size[1];
  const bool last = at[axis] == (d & 1 ? size - 1 : 0);
  const long ahead = d & 1 ? step : -step;
  return !last ? (long)i + ahead : info->periodic[axis] ? (long)i - ahead * (size - 1) : -1;
}

// Computes the sources by octant of one voxel; arguments as in find_octant_sources().
//   t, s       extinction and scattering coefficient, 1/length
//   responses  responses of layers as thick as the voxel along each axis
static void find_of_voxel(const OctantSourceInfo* info, const int* at, ulong i, float t, float s,
  const layer_response* responses, const __global float* source, const __global float* incoming,
  const __global float* beyond, __global float* of_lamps, int lamps, __global float* sources)
{
  float more[3][2];
  for (int axis = 0; axis < 3; ++axis)
  {
    const layer_response response = responses[axis];
    float net[2], in[2];
    for (int d = 0; d < 2; ++d)
    {
      in[d] = incoming[(2 * axis + d) * info->stride + i];
    }
    for (int d = 0; d < 2; ++d)
    {
      const long elsewhere = place_beyond(&info->beyond, info->size, at, 2 * axis + d);
      const long next = next_voxel(info, at, i, 2 * axis + d);
      float out = 0.0f;
      if (elsewhere >= 0)
      {
        out = beyond[elsewhere];
      }
      else if (next >= 0)
      {
        out = incoming[(2 * axis + 1 - d) * info->stride + next];
      }
      else if (t > 0.0f)
      {
        // The light that leaves through a face of the box is not recorded for each voxel: it is estimated from the
        // layer's response.
        float shines = source[i];
        for (int octant = 0; octant < 8; ++octant)
        {
          shines += (octant >> axis & 1) == d ? 0.25f * sources[octant * info->stride + i] : 0.0f;
        }
        out = (1.0f - response.lost) * in[1 - d] + response.lost * shines / t;
      }
      net[d] = in[d] - out;
    }
    const float differs = 0.5f * response.differs * (in[0] - in[1]);
    const float alike = 0.5f * response.alike * (net[0] + net[1]);
    for (int d = 0; d < 2; ++d)
    {
      const ulong face = (2 * axis + d) * info->stride + i;
      more[axis][d] = info->leftOut[axis] ? 0.0f : s * (alike + (d ? -differs : differs));
      if (lamps)
      {
        more[axis][d] += info->leftOut[axis] ? 0.0f : of_lamps[face];
        of_lamps[face] = 0.0f;
      }
    }
  }
  for (int octant = 0; octant < 8; ++octant)
  {
    float sum = 0.0f;
    for (int axis = 0; axis < 3; ++axis)
    {
      sum += more[axis][octant >> axis & 1];
    }
    sources[octant * info->stride + i] = sum;
  }
}

// Computes the sources by octant of light scattered from incident light (numerics.md, Eqs. (46e), (46f)). One work-item
// per row of voxels.
//   incoming  mean incident radiance at voxels' faces during the sweep, W / (length^2 sr)
//   source    uniform source of the sweep, W / (length^3 sr)
//   beyond    mean incident radiance of the voxels across a subdomain's faces, W / (length^2 sr)
//   of_lamps  source by face (e of numerics.md, Eq. (46e)) of light first scattered from lamps, W / (length^3 sr),
//             used if `lamps` is 1; set to 0
//   sources   W / (length^3 sr), [octant][voxel] from index 8 `first` on, in addition to the uniform source: on entry
//             the sources of the sweep, which are replaced. May be negative in the first scattering orders, because
//             some light leaves the voxel only in later ones
__kernel void find_octant_sources(OctantSourceInfo info, const __global float* sigma_t, const __global float* sigma_s,
  const __global float* source, const __global float* values, const __global float* incoming,
  const __global float* beyond, __global float* of_lamps, int lamps, __global float* sources, ulong channel)
{
  int at[3] = { 0, get_global_id(0), get_global_id(1) };
  ulong i = ((ulong)at[2] * info.size[1] + at[1]) * info.size[0];
  float last_t = -1.0f, last_s = -1.0f;
  layer_response responses[3];
  for (; at[0] < info.size[0]; ++at[0], ++i)
  {
    const float t = sigma_t[info.firstT + i], s = sigma_s[info.first + i];
    for (int axis = 0; axis < 3 && (t != last_t || s != last_s); ++axis)
    {
      if (axis > 0 && info.spacing[axis] == info.spacing[axis - 1])
      {
        responses[axis] = responses[axis - 1];
        continue;
      }
      responses[axis] = response_of(values, t > 0.0f ? s / t : 0.0f, t * info.spacing[axis]);
    }
    last_t = t;
    last_s = s;
    find_of_voxel(&info, at, i, t, s, responses, source + info.first, incoming + 6 * info.first,
      beyond + channel * info.beyond.stride, of_lamps + 6 * info.first, lamps, sources + 8 * info.first);
  }
}

// Adds the sources by face, e of numerics.md, Eq. (46e), of light first scattered from one lamp (Eq. (46h)). One
// work-item per voxel.
//   path, first_moments  deposit of the lamp, as in Sweep/SweepOperator.h; set to 0
//   of_lamps             source by face, W / (length^3 sr), laid out as first_moments, added to
//   all_path             path integrals of all lamps, W length, added to
__kernel void add_lamp(OctantSourceInfo info, const __global float* sigma_t, const __global float* sigma_s,
  __global float* path, __global float* first_moments, const __global float* falling, __global float* of_lamps,
  __global float* all_path)
{
  VOXEL_AT
  const float t = sigma_t[info.firstT + i], s = sigma_s[info.first + i], length = path[info.first + i];
  for (int axis = 0; axis < 3; ++axis)
  {
    const ulong low = 6 * info.first + 2 * axis * info.stride + i, high = low + info.stride;
    const float h = info.spacing[axis], tau = t * h;
    // Proximity of first scattering to the lower face, 1 - 2 d / tau, where d is its mean optical depth.
    const float towards = length > 0.0f ? 2.0f * (first_moments[low] - first_moments[high]) / length : 0.0f;
    const float r = clamp(fabs(towards), 0.0f, 0.9999f);
    first_moments[low] = first_moments[high] = 0.0f;
    if (tau <= 0.0f || r <= 0.0f || s <= 0.0f)
    {
      continue;
    }
    const float fall = fall_of(r) / tau;
    const float place = clamp(2.0f * (log2(fmax(fall, 1e-6f)) - FirstProfile), 0.0f, ResponseProfiles - 1.001f);
    const float v = place - floor(place);
    const __global float* nearest = falling + (int)place * ResponseValues;
    const layer_response slow = response_of(nearest, s / t, tau);
    const layer_response fast = response_of(nearest + ResponseValues, s / t, tau);
    // Factor that reduces the sources to 0 for light that hardly decays across the voxel, because the first-collision
    // source of such light is uniform.
    const float falls = fmin(fall * exp2((float)-FirstProfile), 1.0f);
    const float differs = falls * mix(slow.differs, fast.differs, v);
    const float alike = falls * mix(slow.alike, fast.alike, v);
    const float side = towards > 0.0f ? differs : -differs;
    // Source of a face per unit of its response coefficient: sigma_s / 2 times the radiance of isotropic light that
    // carries the power of first collisions through a face.
    const float per_face = 0.5f * M_1_PI_F * s * t * length * h / (info.spacing[0] * info.spacing[1] * info.spacing[2]);
    of_lamps[low] += per_face * (alike + side);
    of_lamps[high] += per_face * (alike - side);
  }
  all_path[info.first + i] += length;
  path[info.first + i] = 0.0f;
}
