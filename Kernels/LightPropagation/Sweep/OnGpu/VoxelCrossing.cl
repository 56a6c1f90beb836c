// Functions that carry the rays of one bundle through a voxel of a plane, for the kernel in SweepOnGpu.cl, which lists
// the host's definitions. Rays enter a voxel from its neighbours. The voxel's work-item recomputes their attenuation in
// these neighbours (numerics.md, Eq. (30a)).

#pragma once
#include "LightPropagation/Sweep/OnGpu/SweepOnGpuShared.h"
#include "Numerics/Numerics.cl"

// Whether light that crosses a side leaves the domain. Sides 0 to 3 are the faces -u, +u, -v, +v.
#if SIDES
#define LEAVES_GRID(state, side) (((state)->outerSides >> (side)) & 1)
#else
#define LEAVES_GRID(state, side) true
#endif

// Effect of a segment (path through one voxel) on rays of power P with a source q: path += meanLength P, P' = P keep +
// P change + power q meanLength, where `power` is the power of a ray at radiance 1. The member `own` is the path
// integral that a unit source in the voxel causes within the voxel, divided by `power`.
typedef struct
{
  float meanLength, keep, change, own;
} segment_effect;

typedef struct
{
  float power[CHANNELS];
} colours;

// The plane that a work-item crosses, with the arrays at that plane.
typedef struct
{
  const __global SweepLane* lane;
  const __global float* sigma;  // extinction, 1/length, from the plane's voxel (0, 0) on
  const __global float* source; // source, W / (length^3 sr), from the plane's voxel (0, 0) on
  // Additional source, W / (length^3 sr), [octant][voxel], from the plane's voxel (0, 0) on; only if OCTANT_SOURCE is 1
  const __global float* octants;
  ulong stride;
  int sizeU, sizeV;
  int shines, adds; // whether the medium has a source; whether sums are added to the arrays (1) or written to them (0)
  float meanLength[MeanLengthTerms];
  float thin, vacuum;
#if SIDES
  // Power of the incoming rays at the plane's sides, W, [ray][channel][SIDE_FLOATS]
  const __global float* sidesIn;
  __global float* sidesOut;
  int outerSides;
#endif
} plane_state;

// One direction (member) of a bundle, with the sideways moves and segments of its rays in the plane.
typedef struct
{
  const __global float* rays; // power of the rays of this direction, W, [channel][v][u]
  // Incident power of a ray, W, [channel]: x through the face normal to u, y through the face normal to v.
  const __global float4* entering;
  // Source in this direction, W / (length^3 sr), [channel][v][u]; if ANGULAR
  const __global float* directed;
#if SIDES
  const __global float* sidesIn; // power of this direction's incoming rays at the sides, W, [channel][SIDE_FLOATS]
  __global float* sidesOut;
#endif
  float power;
  float length[3], part[3];
  int du[3], dv[3];
  bool bothAtOnce; // whether rays of this direction move along u and v at once in some segment
  int octants[2];  // the two octants of this direction; equal unless it has no component along u or v
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

// Additional source of a voxel in the octant of a bundle's direction (member), W / (length^3 sr).
static float shines_more(const plane_state* state, const member_state* member, int c, long voxel)
{
#if OCTANT_SOURCE
  const __global float* octants = state->octants + 8 * c * state->stride + voxel;
  return 0.5f * (octants[member->octants[0] * state->stride] + octants[member->octants[1] * state->stride]);
#else
  return 0.0f;
#endif
}

// Power of the rays after a segment in voxel (u, v), W (numerics.md, Eq. (23)).
static colours behind(
  const plane_state* state, const member_state* member, int u, int v, colours before, segment_effect effect)
{
  colours after;
  for (int c = 0; c < CHANNELS; ++c)
  {
    float kept = before.power[c] * effect.keep;
    if (state->shines)
    {
#if ANGULAR
      const float shines = member->directed[((ulong)c * state->sizeV + v) * state->sizeU + u];
#else
      const long voxel = voxel_of(state, u, v);
      const float shines = state->source[voxel + c * state->stride] + shines_more(state, member, c, voxel);
#endif
      kept += effect.meanLength * member->power * shines;
    }
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

// Power of the rays that enter the box through its sides, W. They come from position (u, v), outside the box.
static colours coming_in(const plane_state* state, const member_state* member, int u, int v)
{
  const bool beyondU = u < 0 || u >= state->sizeU, beyondV = v < 0 || v >= state->sizeV;
  colours rays;
  for (int c = 0; c < CHANNELS; ++c)
  {
#if SIDES
    const int from = beyondU && beyondV ? state->sizeU + state->sizeV : beyondU ? state->sizeU + v : u;
    rays.power[c] = member->sidesIn[c * SIDE_FLOATS(state) + from];
#else
    const float4 entering = member->entering[c];
    rays.power[c] = beyondU && beyondV ? (member->bothAtOnce ? 0.5f * (entering.x + entering.y) : entering.x)
      : beyondU                        ? entering.x
                                       : entering.y;
#endif
  }
  return rays;
}

#if SIDES
// Writes the power of the rays that leave the box from voxel (u, v) in the move before segment s.
static void give_sides(const plane_state* state, const member_state* member, int s, int u, int v, colours rays)
{
  const int du = member->du[s], dv = member->dv[s];
  const bool acrossU = (du < 0 && u == 0) || (du > 0 && u == state->sizeU - 1);
  const bool acrossV = (dv < 0 && v == 0) || (dv > 0 && v == state->sizeV - 1);
  for (int c = 0; c < CHANNELS; ++c)
  {
    __global float* side = member->sidesOut + c * SIDE_FLOATS(state);
    if (acrossU)
    {
      side[state->sizeU + v] = rays.power[c];
    }
    if (acrossV)
    {
      side[u] = rays.power[c];
    }
  }
}
#endif

// Position (u, v) wrapped around the periodic axes; may still be outside the plane.
static int2 go_round(const plane_state* state, int u, int v)
{
  const int size_u = state->sizeU, size_v = state->sizeV;
  const int past_u = u < 0 ? size_u : u >= size_u ? -size_u : 0;
  const int past_v = v < 0 ? size_v : v >= size_v ? -size_v : 0;
  return (int2)(state->lane->periodicU ? u + past_u : u, state->lane->periodicV ? v + past_v : v);
}

// Power of the rays behind the first segment of their path through the plane, W; this segment is in voxel (of_u, of_v).
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

// Power of the rays behind the second segment of their path through the plane, W; this segment is in voxel (of_u,
// of_v).
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

// Sums over all bundles in one voxel, accumulated by its work-item.
typedef struct
{
  float path[CHANNELS]; // path integral, W length; if ANGULAR, of one ray
  // Path integral that a unit source in the voxel causes within the voxel; if ANGULAR, of one ray.
  float own;
#if ANGULAR
  float moments[CHANNELS][FUNCTIONS];
#endif
  float flux[CHANNELS][3]; // net flux along u, v and the marching axis, W length
  // Mean over the voxel of the net flux along the marching axis that a unit source in this voxel causes.
  float ownFlux;
  float currents[CHANNELS][CurrentFaces];
  float escaped[4][CHANNELS]; // power that escapes through -u, +u, -v, +v, W
} voxel_sums;

// Adds the path integral and net flux of one segment to the sums.
// @param not_lost  power, W, that is subtracted from each ray's power in the path integral (not_lost_of())
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

// Adds to the sums the power of the rays that leave the box from voxel (u, v) in the move before segment s. At the
// box's edge, half of the power of rays that move along u and v at once leaves through each of the two faces, and half
// of the light incident next to the edge leaves again without crossing a voxel.
static void count_escaped(
  const plane_state* state, voxel_sums* sums, const member_state* member, int s, int u, int v, colours rays)
{
  const int du = member->du[s], dv = member->dv[s];
  const bool throughU = !state->lane->periodicU && (du > 0 ? u == state->sizeU - 1 : du < 0 && u == 0) &&
    LEAVES_GRID(state, du > 0 ? 1 : 0);
  const bool throughV = !state->lane->periodicV && (dv > 0 ? v == state->sizeV - 1 : dv < 0 && v == 0) &&
    LEAVES_GRID(state, dv > 0 ? 3 : 2);
  const float turned = throughU && throughV ? 0.5f : 0.0f;
  for (int c = 0; c < CHANNELS; ++c)
  {
#if SIDES == 2
    const __global float* in = member->sidesIn + c * SIDE_FLOATS(state);
    // Power of the incident rays at the faces normal to u and to v, for a move along u and v at once
    const float2 beyond = (float2)(in[state->sizeU + v], in[u]);
#else
    const float2 beyond = member->entering[c].xy;
#endif
    if (throughU)
    {
      const float power = member->part[s] * (rays.power[c] - turned * (rays.power[c] - beyond.y));
      sums->escaped[0][c] += du < 0 ? power : 0.0f;
      sums->escaped[1][c] += du > 0 ? power : 0.0f;
    }
    if (throughV)
    {
      const float power = member->part[s] * (rays.power[c] - turned * (rays.power[c] - beyond.x));
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

// Adds to the partial currents the power that enters voxel (u, v) through its faces in the move before segment s.
// Diagonal rays cross an edge between four voxels. Half of those that move from one neighbour of voxel (u, v) to
// another pass through voxel (u, v).
// @param come  power of the rays that arrive from the voxel where the move starts
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

// Power that is subtracted from each ray's power in the path integral, W. The voxel's octant source adds this power to
// the rays; the voxel then takes less power from the rays by the same amount, so that total power is conserved.
static colours not_lost_of(const plane_state* state, const member_state* member, long voxel)
{
  colours more = { { 0.0f } };
#if OCTANT_SOURCE
  for (int c = 0; c < CHANNELS && state->shines; ++c)
  {
    more.power[c] = shines_more(state, member, c, voxel) * member->power / fmax(state->sigma[voxel], state->vacuum);
  }
#endif
  return more;
}

// Carries the rays of one direction (member) of a bundle through voxel (u, v). Returns their power behind the plane, W.
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
#if SIDES
    give_sides(state, member, s, u, v, rays);
#endif
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

// Determines the two octants to which a direction (member m) of a bundle belongs; they are equal unless the direction
// has no component along u or v.
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
    const int2 move = move_of(bundle, m, crossing, s);
    member.du[s] = move.x;
    member.dv[s] = move.y;
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
