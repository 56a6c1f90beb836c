// Kernels that carry rays through one plane on a GPU: one work-item per voxel of the plane and sense of marching
// (numerics.md, section 4.8). In each of the up to three segments of the plane, a work-item reads the rays that enter
// its voxel from the maps of the previous plane and recomputes their attenuation in the neighbouring voxels: arithmetic
// is cheap on a GPU, so rays are read and written once per plane, without synchronisation other than the launch. Only a
// voxel's own work-item adds to its sums, bundle by bundle, so the order of summation is fixed. Physics and numerics
// are those of SweepBundle.cl.
//
// The host defines CHANNELS, NET_FLUX, OCTANT_SOURCE, ANGULAR as in SweepLayout.cl, and
//   CURRENTS   1: the power that enters each voxel through each face is computed
//   FUNCTIONS  number of angular functions; 1: fluence only
//   BEAMS      number of sources with their own angular distribution; only if ANGULAR
//   SIDES      0: rays that enter and leave through the sides of the box are not stored
//              1: they are stored (SweepOnGpuShared.h); the box is a block (subdomain), whose axes are open
//              2: they are stored; the box is the domain, with light given and summed per cell of its faces
//              (LaneFaces.cl)

#define REAL_WIDTH 1
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"
#include "LightPropagation/Sweep/OnGpu/VoxelCrossing.cl"

static void put(__global float* where, float value, int adds)
{
  *where = adds ? *where + value : value;
}

// Adds `value` to a path integral. If rays cross a voxel repeatedly, uses compensated (Kahan) summation, with the
// rounding error in `lost`.
static void put_path(const plane_state* state, __global float* path, __global float* lost, float value)
{
  if (!state->lane->around)
  {
    put(path, value, state->adds);
    return;
  }
  const float more = value - *lost;
  const float sum = *path + more;
  *lost = (sum - *path) - more;
  *path = sum;
}

#if ANGULAR
// Adds sums->path, the path integral of one ray, to the angular moments, and clears it for the next ray.
// @param functions  values of the angular functions in the ray's direction
static void gather_moments(
  voxel_sums* sums, const member_state* member, const __global float* functions, int shines, ulong plane, ulong here)
{
  for (int c = 0; c < CHANNELS; ++c)
  {
    float path = sums->path[c];
    if (shines)
    {
      path = multiply_add(sums->own, member->directed[c * plane + here], path);
    }
    for (int k = 0; k < FUNCTIONS; ++k)
    {
      sums->moments[c][k] = multiply_add(path, functions[k], sums->moments[c][k]);
    }
    sums->path[c] = 0.0f;
  }
}
#endif

// Carries all rays that march in one sense along an axis, bundle by bundle, through voxel (u, v).
// directed, functions  source along each ray and values of the angular functions, if ANGULAR
static void cross_bundles(const plane_state* state, voxel_sums* sums, const __global BundleInfo* bundles,
  const __global CrossingInfo* crossings, const __global float* before, __global float* after,
  const __global float4* entering, const __global float* directed, const __global float* functions, int u, int v)
{
  const __global SweepLane* lane = state->lane;
  const ulong plane = (ulong)state->sizeU * state->sizeV;
  const ulong here = (ulong)v * state->sizeU + u;
  int ray = 0;
  for (int b = 0; b < lane->bundles; ++b)
  {
    const __global BundleInfo* bundle = bundles + lane->firstBundle + b;
    const __global CrossingInfo* crossing = crossings + b;
    segment_effect effects[3];
#if ANGULAR
    sums->own = 0.0f;
#endif
    for (int s = 0; s < crossing->stages; ++s)
    {
      effects[s] = effect_at(state, u, v, crossing->length[s]);
      const float shines = bundle->power * (ANGULAR ? 1 : bundle->members) * effects[s].own;
      sums->own += shines;
      sums->ownFlux += shines * bundle->cosine;
    }
    for (int m = 0; m < bundle->members; ++m, ++ray)
    {
      member_state member = member_of(lane, bundle, crossing, m);
      member.rays = before + ray * plane * CHANNELS;
      member.entering = entering + ray * CHANNELS;
      member.directed = directed + ray * plane * CHANNELS;
#if SIDES
      const ulong sides_before = (ulong)ray * CHANNELS * SIDE_FLOATS(state);
      member.sidesIn = state->sidesIn + sides_before;
      member.sidesOut = state->sidesOut + sides_before;
#endif
      const float3 along = direction_of(bundle, m, lane->backward);
      const colours rays = cross_voxel(state, sums, &member, crossing->stages, effects, along, u, v);
#if ANGULAR
      gather_moments(sums, &member, functions + ray * (FUNCTIONS + BEAMS), state->shines, plane, here);
#endif
      for (int c = 0; c < CHANNELS; ++c)
      {
        after[(ray * CHANNELS + c) * plane + here] = rays.power[c];
      }
    }
  }
}

#if ANGULAR
// Adds the angular moments of one channel and voxel to `path`.
// @param places  memory layout of `path`: MomentPlaces if inPlaces is 1, else [function][channel][voxel]
static void put_moments(const plane_state* state, const PlaneLaunch* places, const float* moments, int c, ulong voxel,
  __global float* path, __global float* lost)
{
  for (int k = 0; k < FUNCTIONS; ++k)
  {
    const MomentPlaces* of = &places->moments;
    const ulong place = !places->inPlaces ? state->lane->path + ((ulong)k * CHANNELS + c) * state->stride + voxel
      : k == 0                            ? places->putFirst + c * state->stride + voxel
               : MOMENT_PLACE(*of, k, places->firstChannel + c, voxel / of->sizeX, voxel % of->sizeX);
    put_path(state, path + place, lost + place, moments[k]);
  }
}
#endif

// Writes the voxel's sums to the path integrals, flux and currents of the lane, or adds to these if state->adds is set.
static void put_sums(const plane_state* state, const PlaneLaunch* places, const voxel_sums* sums, ulong voxel, int u,
  int v, __global float* path, __global float* lost, __global float* flux, __global float* currents)
{
  const __global SweepLane* lane = state->lane;
  const ulong stride = state->stride;
  const int axis = lane->axis;
  const int asideU = axis == 0 ? 1 : 0, asideV = axis == 2 ? 1 : 2;
  for (int c = 0; c < CHANNELS; ++c)
  {
#if ANGULAR
    put_moments(state, places, sums->moments[c], c, voxel, path, lost);
#else
    float own = 0.0f, ownFlux = 0.0f;
    if (state->shines)
    {
      const float shines = state->source[voxel_of(state, u, v) + c * stride];
      own = sums->own * shines;
      ownFlux = sums->ownFlux * shines;
    }
    const ulong place = lane->path + c * stride + voxel;
    put_path(state, path + place, lost + place, sums->path[c] + own);
#if NET_FLUX
    __global float* components = flux + 3 * (lane->deposit + c * stride) + voxel;
    put(components + asideU * stride, sums->flux[c][0], state->adds);
    put(components + asideV * stride, sums->flux[c][1], state->adds);
    put(components + axis * stride, sums->flux[c][2] + (lane->backward ? -ownFlux : ownFlux), state->adds);
#endif
#endif
#if CURRENTS
    __global float* faces = currents + 6 * (lane->deposit + c * stride) + voxel;
    put(faces + (2 * axis + lane->backward) * stride, sums->currents[c][CurrentAxis], state->adds);
    if (!state->adds)
    {
      faces[(2 * axis + 1 - lane->backward) * stride] = 0.0f;
    }
    put(faces + 2 * asideU * stride, sums->currents[c][CurrentLowU], state->adds);
    put(faces + (2 * asideU + 1) * stride, sums->currents[c][CurrentHighU], state->adds);
    put(faces + 2 * asideV * stride, sums->currents[c][CurrentLowV], state->adds);
    put(faces + (2 * asideV + 1) * stride, sums->currents[c][CurrentHighV], state->adds);
#endif
  }
}

// Writes the power that escapes sideways from voxel (u, v), W. Each position along a side belongs to one voxel; a voxel
// at the box's edge has positions on two sides.
static void put_escaped(
  const plane_state* state, const voxel_sums* sums, int plane, int u, int v, __global float* escaped)
{
  const __global SweepLane* lane = state->lane;
  const bool at[4] = { u == 0, u == state->sizeU - 1, v == 0, v == state->sizeV - 1 };
  for (int side = 0; side < 4; ++side)
  {
    for (int c = 0; c < CHANNELS && at[side]; ++c)
    {
      const ulong row = ((ulong)plane * 4 + side) * CHANNELS + c;
      escaped[lane->escaped + row * lane->positions + (side < 2 ? v : u)] = sums->escaped[side][c];
    }
  }
}

// Carries the rays of several lanes (SweepLane: one sense along an axis) through one plane. One work-item per voxel of
// the plane and lane.
// sigma     extinction, 1/length, [voxel]
// source    W / (length^3 sr), [channel][voxel]
// octants   additional source per octant of directions, W / (length^3 sr), [channel][octant][voxel]
// path, flux, currents  path integrals and net flux, W length, and power that enters each voxel through each face, W:
//                       the kernel overwrites them or, if PlaneLaunch::adds is 1, adds to them
// lost      rounding errors of the path, laid out as path, if the marching axis is periodic
// before    power of the rays at the voxel that they enter in this plane, W, [ray][channel][v][u] for each lane
// after     power of the rays at the voxel that they enter in the next plane, W, laid out as `before`
// entering  incident power, W, [ray][channel]: through the face normal to u, through the face normal to v, and where
//           rays start
// directed  source in the direction of each ray, W / (length^3 sr), laid out as `before`; if ANGULAR
// functions values of the angular functions in the rays' directions, [ray][function, then beam]; if ANGULAR
// escaped   power that escapes sideways, W, [plane][-u, +u, -v, +v][channel][position along the face] for each lane
// sides_in, sides_out  power of the rays that enter and leave through the sides, W, in the layout of
//                      SweepOnGpuShared.h; if SIDES is not 0
__kernel void cross_plane(PlaneLaunch launch, const __global SweepLane* lanes, const __global float* sigma,
  const __global float* source, const __global float* octants, __global float* path, __global float* lost,
  __global float* flux, __global float* currents, const __global float* before, __global float* after,
  const __global float4* entering, const __global BundleInfo* bundles, const __global CrossingInfo* crossings,
  const __global float* directed, const __global float* functions, __global float* escaped,
  const __global float* sides_in, __global float* sides_out)
{
  const int u = get_global_id(0), v = get_global_id(1);
  const __global SweepLane* lane = lanes + launch.firstLane + get_global_id(2);
  if (u >= lane->planes.sizeU || v >= lane->planes.sizeV || launch.plane >= lane->patternPlanes)
  {
    return;
  }
  const int plane = plane_of(lane, launch.plane);
  const ulong first = (ulong)lane->planes.firstU * lane->planes.stepU +
    (ulong)lane->planes.firstV * lane->planes.stepV +
    (ulong)(lane->planes.firstP + plane - launch.slotPlane) * lane->planes.stepP;
  const ulong values = launch.putFirst + launch.slotValues, puts = launch.slotPath + (ANGULAR ? 0 : launch.putFirst);
  plane_state state;
  state.lane = lane;
  state.sigma = sigma + launch.sigmaFirst + first;
  state.source = source + launch.slotSource + launch.sourceFirst + first;
  state.octants = octants + 8 * (launch.slotValues + launch.sourceFirst) + first;
  state.stride = launch.stride;
  state.shines = launch.shines;
  state.adds = launch.adds;
  state.sizeU = lane->planes.sizeU;
  state.sizeV = lane->planes.sizeV;
  state.thin = lane->planes.thin;
  state.vacuum = lane->planes.vacuum;
  for (int i = 0; i < MeanLengthTerms; ++i)
  {
    state.meanLength[i] = lane->planes.meanLength[i];
  }
#if SIDES
  const ulong sides_of_plane = (ulong)launch.plane * lane->rays * CHANNELS * SIDE_FLOATS(&state);
  state.sidesIn = sides_in + lane->sides + sides_of_plane;
  state.sidesOut = sides_out + lane->sides + sides_of_plane;
  state.outerSides = launch.outerSides;
#endif
  voxel_sums sums = { { 0.0f } };
  cross_bundles(&state, &sums, bundles,
    crossings + (launch.ofRound ? 0 : lane->crossings) + launch.plane * lane->bundles, before + lane->map,
    after + lane->map, entering + lane->firstRay * CHANNELS, directed + lane->map,
    functions + lane->firstRay * (FUNCTIONS + BEAMS), u, v);
  put_sums(&state, &launch, &sums, first + voxel_of(&state, u, v), u, v, path + puts, lost + puts, flux + 3 * values,
    currents + 6 * values);
  put_escaped(&state, &sums, launch.plane, u, v, escaped);
}

#if ANGULAR
// Computes the source in the direction of each ray, for the voxels of a plane, from its angular moments and beams
// (numerics.md, Eq. (29b)). One work-item per voxel of the plane and lane (SweepLane).
__kernel void find_directed(PlaneLaunch launch, const __global SweepLane* lanes, const __global float* source,
  const __global float* functions, __global float* directed)
{
  const int u = get_global_id(0), v = get_global_id(1);
  const __global SweepLane* lane = lanes + launch.firstLane + get_global_id(2);
  const __global PlaneInfo* planes = &lane->planes;
  if (u >= planes->sizeU || v >= planes->sizeV || launch.plane >= lane->patternPlanes)
  {
    return;
  }
  const int plane = plane_of(lane, launch.plane);
  const ulong voxel = (ulong)(planes->firstU + u) * planes->stepU + (ulong)(planes->firstV + v) * planes->stepV +
    (ulong)(planes->firstP + plane - launch.slotPlane) * planes->stepP;
  const MomentPlaces* of = &launch.moments;
  source += launch.slotSource;
  const ulong size = (ulong)planes->sizeU * planes->sizeV;
  functions += lane->firstRay * (FUNCTIONS + BEAMS);
  for (int c = 0; c < CHANNELS; ++c)
  {
    const int channel = launch.firstChannel + c;
    float values[FUNCTIONS + BEAMS];
    values[0] = source[launch.sourceFirst + c * launch.stride + voxel];
    for (int k = 1; k < FUNCTIONS; ++k)
    {
      values[k] = source[MOMENT_PLACE(*of, k, channel, voxel / of->sizeX, voxel % of->sizeX)];
    }
    for (int b = 0; b < BEAMS; ++b)
    {
      values[FUNCTIONS + b] = source[of->beams + ((ulong)b * of->channels + channel) * launch.stride + voxel];
    }
    __global float* to = directed + lane->map + c * size + (ulong)v * planes->sizeU + u;
    for (int ray = 0; ray < lane->rays; ++ray)
    {
      const __global float* along = functions + ray * (FUNCTIONS + BEAMS);
      float shines = 0.0f;
      for (int k = 0; k < FUNCTIONS + BEAMS; ++k)
      {
        shines = multiply_add(values[k], along[k], shines);
      }
      to[ray * CHANNELS * size] = shines;
    }
  }
}
#endif
