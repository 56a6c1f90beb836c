// Rays through one plane, on a GPU: a work-item a voxel of the plane and way along the axis (numerics.md, section 4.8).
// It reads the rays that come into its voxel in each of the up to three segments of the plane, from the maps of the
// plane before, and computes what its neighbours did to them anew: arithmetic is what a GPU has to spare, and rays are
// read and written once a plane without anything between work-items but the launch. Each voxel is added to by its own
// work-item alone, bundle by bundle, so sums have one order. Physics and numbers are those of SweepBundle.cl.
//
// The host gives CHANNELS, SOURCE, NET_FLUX, CURRENTS, OCTANT_SOURCE as SweepLayout.cl has them, and
//   ADDS    1: lanes follow one another and add to what is there; 0: each writes arrays of its own
//   AROUND  1: the axis is periodic, and rays come to a voxel again and again: their lane adds to its own arrays
//   DEGREE  of the angular moments in which light is gathered, and shines; 0, or not given: fluence alone
//   BEAMS   sources with an angular distribution of their own; where DEGREE is not 0

#define REAL_WIDTH 1
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"
#include "Numerics/Numerics.cl"

#ifndef DEGREE // kernels that do not depend on them
#define DEGREE 0
#define BEAMS 0
#define AROUND 0
#endif
#define MOMENTS ((DEGREE + 1) * (DEGREE + 1))

#if ADDS || AROUND
#define PUT(where, value) ((where) += (value))
#else
#define PUT(where, value) ((where) = (value))
#endif

// A path, with what rounding takes of it where rays come again and again.
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

// The plane of the grid that a lane crosses as its k-th.
static int plane_of(const __global SweepLane* lane, int k)
{
  const int of_axis = AROUND ? k % lane->planes.sizeP : k;
  return lane->backward ? lane->planes.sizeP - 1 - of_axis : of_axis;
}

// What a segment does to rays, see SweepCrossing.cl; `own`: path of the light that a source of 1 adds in its own voxel.
typedef struct
{
  float meanLength, keep, change, own;
} segment_effect;

typedef struct
{
  float power[CHANNELS];
} colours;

// Where a work-item is.
typedef struct
{
  const __global SweepLane* lane;
  const __global float* sigma;   // of the plane's voxel (0, 0)
  const __global float* source;  // the same
  const __global float* octants; // the same, where OCTANT_SOURCE
  ulong stride;
  int sizeU, sizeV;
  float meanLength[MeanLengthTerms];
  float thin, vacuum;
} plane_state;

// A bundle in the plane, and one of its members.
typedef struct
{
  const __global float* rays;      // of the member, [channel][v][u]
  const __global float4* entering; // [channel] through u's, v's face
  const __global float* directed;  // where DEGREE, as rays: what shines along it, W / (length^3 sr)
  float power;
  float length[3], part[3];
  int du[3], dv[3];
  bool bothAtOnce; // moves along u and v
  int octants[2];  // it goes between: the same but for rays that go neither way along u or v
} member_state;

static segment_effect effect_of(const plane_state* state, float sigma, float length)
{
  segment_effect effect;
  const float tau = sigma * length;
  if (sigma < state->thin)
  {
    float rest = state->meanLength[MeanLengthTerms - 1];
    for (int i = MeanLengthTerms - 2; i >= 0; --i)
    {
      rest = multiply_add(rest, tau, state->meanLength[i]);
    }
    const float mean = multiply_add(rest, tau, 1.0f);
    effect.meanLength = mean * length;
    effect.keep = 1.0f;
    effect.change = -tau * mean;
    effect.own = -length * length * rest;
    return effect;
  }
  float left;
  const float lost = extinguished(tau, &left);
  effect.meanLength = lost / sigma;
  effect.keep = tau < 1.0f ? 1.0f : 0.0f;
  effect.change = tau < 1.0f ? -lost : left;
  effect.own = (length - effect.meanLength) / sigma;
  return effect;
}

static bool is_inside(const plane_state* state, int u, int v)
{
  return u >= 0 && u < state->sizeU && v >= 0 && v < state->sizeV;
}

static long voxel_of(const plane_state* state, int u, int v)
{
  return (long)u * state->lane->planes.stepU + (long)v * state->lane->planes.stepV;
}

static segment_effect effect_at(const plane_state* state, int u, int v, float length)
{
  return effect_of(state, fmax(state->sigma[voxel_of(state, u, v)], state->vacuum), length);
}

// By how much more than the source a voxel shines into a member's octant.
static float shines_more(const plane_state* state, const member_state* member, int c, long voxel)
{
#if OCTANT_SOURCE
  const __global float* octants = state->octants + 8 * c * state->stride + voxel;
  return 0.5f * (octants[member->octants[0] * state->stride] + octants[member->octants[1] * state->stride]);
#else
  return 0.0f;
#endif
}

// Rays behind a segment in voxel (u, v).
static colours behind(
  const plane_state* state, const member_state* member, int u, int v, colours before, segment_effect effect)
{
  colours after;
  for (int c = 0; c < CHANNELS; ++c)
  {
    float kept = before.power[c] * effect.keep;
#if SOURCE
#if DEGREE
    const float shines = member->directed[((ulong)c * state->sizeV + v) * state->sizeU + u];
#else
    const long voxel = voxel_of(state, u, v);
    const float shines = state->source[voxel + c * state->stride] + shines_more(state, member, c, voxel);
#endif
    kept += effect.meanLength * member->power * shines;
#endif
    after.power[c] = multiply_add(before.power[c], effect.change, kept);
  }
  return after;
}

static colours rays_at(const plane_state* state, const member_state* member, int u, int v)
{
  colours rays;
  for (int c = 0; c < CHANNELS; ++c)
  {
    rays.power[c] = member->rays[((ulong)c * state->sizeV + v) * state->sizeU + u];
  }
  return rays;
}

// Rays that come in through the sides of the box, to go on from (u, v) outside of it.
static colours coming_in(const plane_state* state, const member_state* member, int u, int v)
{
  const bool beyondU = u < 0 || u >= state->sizeU, beyondV = v < 0 || v >= state->sizeV;
  colours rays;
  for (int c = 0; c < CHANNELS; ++c)
  {
    const float4 entering = member->entering[c];
    rays.power[c] = beyondU && beyondV ? (member->bothAtOnce ? 0.5f * (entering.x + entering.y) : entering.x)
      : beyondU                        ? entering.x
                                       : entering.y;
  }
  return rays;
}

// Round the periodic axes, to a voxel of the plane or still outside it.
static int2 go_round(const plane_state* state, int u, int v)
{
  const int size_u = state->sizeU, size_v = state->sizeV;
  const int past_u = u < 0 ? size_u : u >= size_u ? -size_u : 0;
  const int past_v = v < 0 ? size_v : v >= size_v ? -size_v : 0;
  return (int2)(state->lane->periodicU ? u + past_u : u, state->lane->periodicV ? v + past_v : v);
}

// Behind the plane's first segment.
static colours behind_first(const plane_state* state, const member_state* member, int of_u, int of_v)
{
  const int2 at = go_round(state, of_u, of_v);
  const int u = at.x, v = at.y;
  if (!is_inside(state, u, v))
  {
    return coming_in(state, member, u, v);
  }
  return behind(state, member, u, v, rays_at(state, member, u, v), effect_at(state, u, v, member->length[0]));
}

static colours mixed(colours stay, colours come, float part)
{
  for (int c = 0; c < CHANNELS; ++c)
  {
    stay.power[c] = part < 1.0f ? multiply_add(come.power[c] - stay.power[c], part, stay.power[c]) : come.power[c];
  }
  return stay;
}

// Behind the second one.
static colours behind_second(const plane_state* state, const member_state* member, int of_u, int of_v)
{
  const int2 at = go_round(state, of_u, of_v);
  const int u = at.x, v = at.y;
  if (!is_inside(state, u, v))
  {
    return coming_in(state, member, u, v);
  }
  colours rays = behind_first(state, member, u - member->du[1], v - member->dv[1]);
  if (member->part[1] < 1.0f)
  {
    rays = mixed(behind_first(state, member, u, v), rays, member->part[1]);
  }
  return behind(state, member, u, v, rays, effect_at(state, u, v, member->length[1]));
}

// What a voxel's work-item adds up over all bundles.
typedef struct
{
  float path[CHANNELS]; // where DEGREE of one ray
  float own;            // path of a source of 1 in its own voxel, the same
#if DEGREE
  float moments[CHANNELS][MOMENTS];
#endif
  float flux[CHANNELS][3]; // along u, v and the axis
  float ownFlux;           // along the axis
  float currents[CHANNELS][CurrentFaces];
  float escaped[4][CHANNELS]; // through -u, +u, -v, +v
} voxel_sums;

// @param not_lost  of what shines besides in the voxel itself: that is not lost there
static void put_down(voxel_sums* sums, colours rays, colours not_lost, float meanLength, float3 along)
{
  for (int c = 0; c < CHANNELS; ++c)
  {
    const float path = meanLength * (rays.power[c] - not_lost.power[c]);
    sums->path[c] += path;
#if NET_FLUX
    sums->flux[c][0] = multiply_add(meanLength * rays.power[c], along.x, sums->flux[c][0]);
    sums->flux[c][1] = multiply_add(meanLength * rays.power[c], along.y, sums->flux[c][1]);
    sums->flux[c][2] = multiply_add(path, along.z, sums->flux[c][2]);
#endif
  }
}

// Power of the rays that leave the box from voxel (u, v) by the move before segment s, see COUNT_ESCAPED.
static void count_escaped(
  const plane_state* state, voxel_sums* sums, const member_state* member, int s, int u, int v, colours rays)
{
  const int du = member->du[s], dv = member->dv[s];
  const bool throughU = !state->lane->periodicU && (du > 0 ? u == state->sizeU - 1 : du < 0 && u == 0);
  const bool throughV = !state->lane->periodicV && (dv > 0 ? v == state->sizeV - 1 : dv < 0 && v == 0);
  const float turned = throughU && throughV ? 0.5f : 0.0f;
  for (int c = 0; c < CHANNELS; ++c)
  {
    const float4 entering = member->entering[c];
    if (throughU)
    {
      const float power = member->part[s] * (rays.power[c] - turned * (rays.power[c] - entering.y));
      sums->escaped[0][c] += du < 0 ? power : 0.0f;
      sums->escaped[1][c] += du > 0 ? power : 0.0f;
    }
    if (throughV)
    {
      const float power = member->part[s] * (rays.power[c] - turned * (rays.power[c] - entering.x));
      sums->escaped[2][c] += dv < 0 ? power : 0.0f;
      sums->escaped[3][c] += dv > 0 ? power : 0.0f;
    }
  }
}

#if CURRENTS
static void add_current(voxel_sums* sums, int face, colours rays, float part)
{
  for (int c = 0; c < CHANNELS; ++c)
  {
    for (int f = CurrentLowU; f < CurrentFaces; ++f)
    {
      sums->currents[c][f] += f == face ? part * rays.power[c] : 0.0f;
    }
  }
}

// Power that enters voxel (u, v) by the move before segment s: see SweepPartialCurrents.cl. Of rays through the edge
// between four voxels those on their way to the voxels beside pass this one, too.
// @param come  the rays that come from where the move began
static void count_currents(
  const plane_state* state, voxel_sums* sums, const member_state* member, int s, int u, int v, colours come)
{
  const int du = member->du[s], dv = member->dv[s];
  const int uFace = du > 0 ? CurrentLowU : CurrentHighU;
  const int vFace = dv > 0 ? CurrentLowV : CurrentHighV;
  const float part = member->part[s];
  if (du == 0 || dv == 0)
  {
    add_current(sums, du != 0 ? uFace : vFace, come, part);
    return;
  }
  add_current(sums, uFace, come, 0.5f * part);
  add_current(sums, vFace, come, 0.5f * part);
  add_current(sums, uFace, behind_first(state, member, u - du, v), 0.5f * part);
  add_current(sums, vFace, behind_first(state, member, u, v - dv), 0.5f * part);
}
#endif

// Of what shines besides in a voxel itself, see put_down.
static colours not_lost_of(const plane_state* state, const member_state* member, long voxel)
{
  colours more = { { 0.0f } };
#if OCTANT_SOURCE
  for (int c = 0; c < CHANNELS; ++c)
  {
    more.power[c] = shines_more(state, member, c, voxel) * member->power / fmax(state->sigma[voxel], state->vacuum);
  }
#endif
  return more;
}

// One member of a bundle through voxel (u, v), and on to the next plane.
static colours cross_voxel(const plane_state* state, voxel_sums* sums, const member_state* member, int stages,
  const segment_effect* effects, float3 along, int u, int v)
{
  colours rays = rays_at(state, member, u, v);
  const colours not_lost = not_lost_of(state, member, voxel_of(state, u, v));
#if CURRENTS
  for (int c = 0; c < CHANNELS; ++c)
  {
    sums->currents[c][CurrentAxis] += rays.power[c];
  }
#endif
  put_down(sums, rays, not_lost, effects[0].meanLength, along);
  rays = behind(state, member, u, v, rays, effects[0]);
  for (int s = 1; s < stages; ++s)
  {
    count_escaped(state, sums, member, s, u, v, rays);
    const int fromU = u - member->du[s], fromV = v - member->dv[s];
    const colours come =
      s == 1 ? behind_first(state, member, fromU, fromV) : behind_second(state, member, fromU, fromV);
#if CURRENTS
    count_currents(state, sums, member, s, u, v, come);
#endif
    rays = mixed(rays, come, member->part[s]);
    put_down(sums, rays, not_lost, effects[s].meanLength, along);
    rays = behind(state, member, u, v, rays, effects[s]);
  }
  return rays;
}

// The octants that rays go into that are so turned, see SweepBundle.cl.
static void find_octants(const __global SweepLane* lane, const __global BundleInfo* bundle, int m, int* octants)
{
  const int u = lane->axis == 0 ? 1 : 0, v = lane->axis == 2 ? 1 : 2;
  const bool exchanged = bundle->move[m][0] == 0;
  const bool between_u = fabs(exchanged ? bundle->sineV : bundle->sineU) < 1e-5f;
  const bool between_v = fabs(exchanged ? bundle->sineU : bundle->sineV) < 1e-5f;
  octants[0] = (lane->backward ? 0 : 1 << lane->axis) + (bundle->move[m][0] + bundle->move[m][1] > 0 ? 1 << u : 0) +
    (bundle->move[m][2] + bundle->move[m][3] > 0 ? 1 << v : 0);
  octants[1] = octants[0] ^ ((between_u ? 1 << u : 0) + (between_v ? 1 << v : 0));
}

static member_state member_of(
  const __global SweepLane* lane, const __global BundleInfo* bundle, const __global CrossingInfo* crossing, int m)
{
  member_state member;
#if OCTANT_SOURCE
  find_octants(lane, bundle, m, member.octants);
#endif
  member.power = bundle->power;
  member.bothAtOnce = false;
  for (int s = 0; s < 3; ++s)
  {
    member.length[s] = crossing->length[s];
    member.part[s] = crossing->part[s];
    member.du[s] = bundle->move[m][0] * crossing->moveU[s] + bundle->move[m][1] * crossing->moveV[s];
    member.dv[s] = bundle->move[m][2] * crossing->moveU[s] + bundle->move[m][3] * crossing->moveV[s];
    member.bothAtOnce = member.bothAtOnce || (crossing->moveU[s] != 0 && crossing->moveV[s] != 0);
  }
  return member;
}

static float3 direction_of(const __global BundleInfo* bundle, int m, int backward)
{
  return (float3)(bundle->move[m][0] * bundle->sineU + bundle->move[m][1] * bundle->sineV,
    bundle->move[m][2] * bundle->sineU + bundle->move[m][3] * bundle->sineV,
    backward ? -bundle->cosine : bundle->cosine);
}

#if DEGREE
// Of the ray that was just crossed, and the next one's sums begin.
// @param functions  along it
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

// All of the lane's bundles through voxel (u, v).
// directed, functions  of the lane's rays, where DEGREE
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
// @param places  of the path with ADDS, else they lie [function][channel][stride]
static void put_moments(const plane_state* state, const PlaneLaunch* places, const float* moments, int c, ulong voxel,
  __global float* path, __global float* lost)
{
  for (int k = 0; k < MOMENTS; ++k)
  {
#if ADDS
    const MomentPlaces* of = &places->moments;
    path[k == 0 ? places->putFirst + c * state->stride + voxel
                : MOMENT_PLACE(*of, k, places->firstChannel + c, voxel / of->sizeX, voxel % of->sizeX)] += moments[k];
#else
    const ulong place = state->lane->path + ((ulong)k * CHANNELS + c) * state->stride + voxel;
    put_path(path + place, lost + place, moments[k]);
#endif
  }
}
#endif

// What the voxel has found, to where the lane puts it.
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

// Power that left from voxel (u, v) sideways: each place beside the box has one voxel, those of the box's edges two.
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
// lost      as path, where AROUND
// before    the lanes' maps: rays by the voxel that they enter in this plane, W
// after     and in the next
// entering  [ray][channel] W of the rays that come in through u's, v's face, and where they start
// directed  as before: what shines along each ray, W / (length^3 sr); where DEGREE, as is
// functions [ray][function, then beam] along them
// escaped   W, see SweepLane
__kernel void cross_plane(PlaneLaunch launch, const __global SweepLane* lanes, const __global float* sigma,
  const __global float* source, const __global float* octants, __global float* path, __global float* lost,
  __global float* flux, __global float* currents, const __global float* before, __global float* after,
  const __global float4* entering, const __global BundleInfo* bundles, const __global CrossingInfo* crossings,
  const __global float* directed, const __global float* functions, __global float* escaped)
{
  const int u = get_global_id(0), v = get_global_id(1);
  const __global SweepLane* lane = lanes + launch.firstLane + get_global_id(2);
  if (u >= lane->planes.sizeU || v >= lane->planes.sizeV || launch.plane >= lane->patternPlanes)
  {
    return;
  }
  const int plane = plane_of(lane, launch.plane);
  const ulong first = (ulong)lane->planes.firstU * lane->planes.stepU +
    (ulong)lane->planes.firstV * lane->planes.stepV + (ulong)(lane->planes.firstP + plane) * lane->planes.stepP;
  plane_state state;
  state.lane = lane;
  state.sigma = sigma + launch.sigmaFirst + first;
  state.source = source + launch.sourceFirst + first;
  state.octants = octants + 8 * launch.sourceFirst + first;
  state.stride = launch.stride;
  state.sizeU = lane->planes.sizeU;
  state.sizeV = lane->planes.sizeV;
  state.thin = lane->planes.thin;
  state.vacuum = lane->planes.vacuum;
  for (int i = 0; i < MeanLengthTerms; ++i)
  {
    state.meanLength[i] = lane->planes.meanLength[i];
  }
  voxel_sums sums = { { 0.0f } };
  cross_bundles(&state, &sums, bundles,
    crossings + (launch.ofRound ? 0 : lane->crossings) + launch.plane * lane->bundles, before + lane->map,
    after + lane->map, entering + lane->firstRay * CHANNELS, directed + lane->map,
    functions + lane->firstRay * (MOMENTS + BEAMS), u, v);
  put_sums(&state, &launch, &sums, first + voxel_of(&state, u, v), u, v, path + (DEGREE ? 0 : launch.putFirst), lost,
    flux + 3 * launch.putFirst, currents + 6 * launch.putFirst);
  put_escaped(&state, &sums, launch.plane, u, v, escaped);
}

#if DEGREE
// What the plane's voxels shine along each ray, from a source of angular moments and beams. A work-item a voxel of the
// plane and lane.
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
    (ulong)(planes->firstP + plane) * planes->stepP;
  const MomentPlaces* of = &launch.moments;
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

// The rays of a lane where they start. A work-item a float of its maps.
__kernel void start_rays(
  int first_lane, const __global SweepLane* lanes, const __global float4* entering, __global float* maps)
{
  const __global SweepLane* lane = lanes + first_lane + get_global_id(1);
  const ulong plane = (ulong)lane->planes.sizeU * lane->planes.sizeV;
  const ulong i = get_global_id(0);
  if (i < plane * lane->rays * CHANNELS)
  {
    maps[lane->map + i] = entering[lane->firstRay * CHANNELS + i / plane].z;
  }
}

// Sums of rows of floats, a work-item each, in their order and with what rounding takes.
__kernel void sum_rows(const __global float* rows, ulong first, int length, __global float* sums, ulong first_sum)
{
  const __global float* row = rows + first + (ulong)get_global_id(0) * length;
  float sum = 0.0f, rounding = 0.0f;
  for (int i = 0; i < length; ++i)
  {
    const float y = row[i] - rounding;
    const float t = sum + y;
    rounding = (t - sum) - y;
    sum = t;
  }
  sums[first_sum + get_global_id(0)] = sum;
}

// What the lanes found, each in an array of its own, added up in their order. A work-item a value.
__kernel void add_lanes(const __global float* of_lanes, int lanes, ulong values, __global float* sum, ulong first)
{
  const ulong i = get_global_id(0);
  float all = 0.0f;
  for (int lane = 0; lane < lanes; ++lane)
  {
    all += of_lanes[lane * values + i];
  }
  sum[first + i] += all;
}

#if DEGREE
// The same of angular moments. A work-item a voxel, of a function and channel.
__kernel void add_moments_of_lanes(
  PlaneLaunch launch, const __global float* of_lanes, int lanes, __global float* sum, ulong first)
{
  const ulong voxel = get_global_id(0), stride = launch.stride;
  const int k = get_global_id(1) / CHANNELS, c = get_global_id(1) % CHANNELS;
  const MomentPlaces* of = &launch.moments;
  float all = 0.0f;
  for (int lane = 0; lane < lanes; ++lane)
  {
    all += of_lanes[(((ulong)lane * MOMENTS + k) * CHANNELS + c) * stride + voxel];
  }
  sum[k == 0 ? first + c * stride + voxel
             : MOMENT_PLACE(*of, k, launch.firstChannel + c, voxel / of->sizeX, voxel % of->sizeX)] += all;
}
#endif
