// Carries rays through one plane, on a GPU: one work-item per voxel of the plane and way along the axis (numerics.md,
// section 4.8). In each of the up to three segments of the plane, a work-item reads the rays that enter its voxel from
// the maps of the previous plane and recomputes what its neighbours did to them: arithmetic is cheap on a GPU, and so
// rays are read and written once per plane, without synchronisation other than the launch. Each voxel is added to only
// by its own work-item, bundle by bundle, so the order of summation is fixed. Physics and numerics are those of
// SweepBundle.cl.
//
// The host defines CHANNELS, SOURCE, NET_FLUX, CURRENTS, OCTANT_SOURCE as in SweepLayout.cl, and
//   ADDS    1: lanes run one after the other and add to the arrays; 0: each lane writes its own arrays
//   AROUND  1: the axis is periodic, so rays cross a voxel repeatedly and their lane adds to its own arrays
//   DEGREE  degree of the angular moments of light and source; 0: fluence only
//   SIDES   see VoxelSides.cl
//   BEAMS   number of sources with their own angular distribution; only if DEGREE is not 0

#define MOMENTS ((DEGREE + 1) * (DEGREE + 1))

#define REAL_WIDTH 1
#include "LightPropagation/Sweep/OnGpu/LanePlane.cl"
#include "LightPropagation/Sweep/OnGpu/VoxelCrossing.cl"

#if ADDS || AROUND
#define PUT(where, value) ((where) += (value))
#else
#define PUT(where, value) ((where) = (value))
#endif

// Adds to a path; with compensated (Kahan) summation if rays cross a voxel repeatedly.
static void put_path(__global float* path, __global float* lost, float value)
{
#if AROUND
  const float more = value - *lost;
  const float sum = *path + more;
  *lost = (sum - *path) - more;
  *path = sum;
#else
  PUT(*path, value);
#endif
}

#if DEGREE
// Adds the path of the ray that was just computed to the moments, and resets it for the next ray.
// @param functions  angular functions in the ray's direction
static void gather_moments(
  voxel_sums* sums, const member_state* member, const __global float* functions, ulong plane, ulong here)
{
  for (int c = 0; c < CHANNELS; ++c)
  {
    float path = sums->path[c];
#if SOURCE
    path = multiply_add(sums->own, member->directed[c * plane + here], path);
#endif
    for (int k = 0; k < MOMENTS; ++k)
    {
      sums->moments[c][k] = multiply_add(path, functions[k], sums->moments[c][k]);
    }
    sums->path[c] = 0.0f;
  }
}
#endif

// Carries all bundles of the lane through voxel (u, v).
// directed, functions  of the lane's rays, if DEGREE
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
#if DEGREE
    sums->own = 0.0f;
#endif
    for (int s = 0; s < crossing->stages; ++s)
    {
      effects[s] = effect_at(state, u, v, crossing->length[s]);
      const float shines = bundle->power * (DEGREE ? 1 : bundle->members) * effects[s].own;
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
#if DEGREE
      gather_moments(sums, &member, functions + ray * (MOMENTS + BEAMS), plane, here);
#endif
      for (int c = 0; c < CHANNELS; ++c)
      {
        after[(ray * CHANNELS + c) * plane + here] = rays.power[c];
      }
    }
  }
}

#if DEGREE
// @param places  layout of the moments in `path`, with ADDS; otherwise it is [function][channel][stride]
static void put_moments(const plane_state* state, const PlaneLaunch* places, const float* moments, int c, ulong voxel,
  __global float* path, __global float* lost)
{
  for (int k = 0; k < MOMENTS; ++k)
  {
#if ADDS
    const MomentPlaces* of = &places->moments;
    const ulong place = k == 0 ? places->putFirst + c * state->stride + voxel
                               : MOMENT_PLACE(*of, k, places->firstChannel + c, voxel / of->sizeX, voxel % of->sizeX);
#else
    const ulong place = state->lane->path + ((ulong)k * CHANNELS + c) * state->stride + voxel;
#endif
    put_path(path + place, lost + place, moments[k]);
  }
}
#endif

// Writes the voxel's sums to the lane's arrays.
static void put_sums(const plane_state* state, const PlaneLaunch* places, const voxel_sums* sums, ulong voxel, int u,
  int v, __global float* path, __global float* lost, __global float* flux, __global float* currents)
{
  const __global SweepLane* lane = state->lane;
  const ulong stride = state->stride;
  const int axis = lane->axis;
  const int asideU = axis == 0 ? 1 : 0, asideV = axis == 2 ? 1 : 2;
  for (int c = 0; c < CHANNELS; ++c)
  {
#if DEGREE
    put_moments(state, places, sums->moments[c], c, voxel, path, lost);
#else
    float own = 0.0f, ownFlux = 0.0f;
#if SOURCE
    const float shines = state->source[voxel_of(state, u, v) + c * stride];
    own = sums->own * shines;
    ownFlux = sums->ownFlux * shines;
#endif
    const ulong place = lane->path + c * stride + voxel;
    put_path(path + place, lost + place, sums->path[c] + own);
#if NET_FLUX
    __global float* components = flux + 3 * (lane->deposit + c * stride) + voxel;
    PUT(components[asideU * stride], sums->flux[c][0]);
    PUT(components[asideV * stride], sums->flux[c][1]);
    PUT(components[axis * stride], sums->flux[c][2] + (lane->backward ? -ownFlux : ownFlux));
#endif
#endif
#if CURRENTS
    __global float* faces = currents + 6 * (lane->deposit + c * stride) + voxel;
    PUT(faces[(2 * axis + lane->backward) * stride], sums->currents[c][CurrentAxis]);
#if !ADDS && !AROUND
    faces[(2 * axis + 1 - lane->backward) * stride] = 0.0f;
#endif
    PUT(faces[2 * asideU * stride], sums->currents[c][CurrentLowU]);
    PUT(faces[(2 * asideU + 1) * stride], sums->currents[c][CurrentHighU]);
    PUT(faces[2 * asideV * stride], sums->currents[c][CurrentLowV]);
    PUT(faces[(2 * asideV + 1) * stride], sums->currents[c][CurrentHighV]);
#endif
  }
}

// Writes the power that leaves sideways from voxel (u, v). A position along a side has one voxel; a voxel at the box's
// edge has two positions.
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

// sigma     1/length, [voxel]
// source    W / (length^3 sr), [channel][stride]
// octants   see SweepRequest::octantSource
// path, flux, currents  as of the kernel `sweep`
// lost      as path, if AROUND
// before    the lanes' maps: power of the rays, by the voxel that they enter in this plane, W
// after     the same for the next plane
// entering  incident power, W, [ray][channel]: through u's face, through v's face, and where rays start
// directed  laid out as `before`: source in the direction of each ray, W / (length^3 sr); if DEGREE
// functions angular functions in the rays' directions, [ray][function, then beam]; if DEGREE
// escaped   power that leaves sideways, W, see SweepLane
// sides_in, sides_out  [plane, counted from where rays start], see VoxelSides.cl; if SIDES
// outer_sides  bit i: light that crosses side i leaves the domain; if SIDES
__kernel void cross_plane(PlaneLaunch launch, const __global SweepLane* lanes, const __global float* sigma,
  const __global float* source, const __global float* octants, __global float* path, __global float* lost,
  __global float* flux, __global float* currents, const __global float* before, __global float* after,
  const __global float4* entering, const __global BundleInfo* bundles, const __global CrossingInfo* crossings,
  const __global float* directed, const __global float* functions, __global float* escaped SIDES_ARGUMENTS)
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
  const ulong values = launch.putFirst + launch.slotValues, puts = launch.slotPath + (DEGREE ? 0 : launch.putFirst);
  plane_state state;
  state.lane = lane;
  state.sigma = sigma + launch.sigmaFirst + first;
  state.source = source + launch.slotSource + launch.sourceFirst + first;
  state.octants = octants + 8 * (launch.slotValues + launch.sourceFirst) + first;
  state.stride = launch.stride;
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
  state.outerSides = outer_sides;
#endif
  voxel_sums sums = { { 0.0f } };
  cross_bundles(&state, &sums, bundles,
    crossings + (launch.ofRound ? 0 : lane->crossings) + launch.plane * lane->bundles, before + lane->map,
    after + lane->map, entering + lane->firstRay * CHANNELS, directed + lane->map,
    functions + lane->firstRay * (MOMENTS + BEAMS), u, v);
  put_sums(&state, &launch, &sums, first + voxel_of(&state, u, v), u, v, path + puts, lost + puts, flux + 3 * values,
    currents + 6 * values);
  put_escaped(&state, &sums, launch.plane, u, v, escaped);
}

#if DEGREE
// Evaluates the source in the direction of each ray, for the voxels of a plane, from its angular moments and beams. One
// work-item per voxel of the plane and lane.
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
  functions += lane->firstRay * (MOMENTS + BEAMS);
  for (int c = 0; c < CHANNELS; ++c)
  {
    const int channel = launch.firstChannel + c;
    float values[MOMENTS + BEAMS];
    values[0] = source[launch.sourceFirst + c * launch.stride + voxel];
    for (int k = 1; k < MOMENTS; ++k)
    {
      values[k] = source[MOMENT_PLACE(*of, k, channel, voxel / of->sizeX, voxel % of->sizeX)];
    }
    for (int b = 0; b < BEAMS; ++b)
    {
      values[MOMENTS + b] = source[of->beams + ((ulong)b * of->channels + channel) * launch.stride + voxel];
    }
    __global float* to = directed + lane->map + c * size + (ulong)v * planes->sizeU + u;
    for (int ray = 0; ray < lane->rays; ++ray)
    {
      const __global float* along = functions + ray * (MOMENTS + BEAMS);
      float shines = 0.0f;
      for (int k = 0; k < MOMENTS + BEAMS; ++k)
      {
        shines = multiply_add(values[k], along[k], shines);
      }
      to[ray * CHANNELS * size] = shines;
    }
  }
}
#endif
