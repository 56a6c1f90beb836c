// Flight of a packet of photons (one per vector lane) between two changes of velocity: attenuation, deposits, crossing
// of walls, and termination or change of velocity at the end of a step. Part of PhotonMarch.cl, which lists the macros
// that the host defines.

#pragma once
#define MARKS (COUNTS || CELLS || (BLOCKS && PATHS))

#include "Numerics/FixedPoint.cl"
#include "Numerics/Numerics.cl"
#include "Numerics/Prefetch.cl"
#include "Photons/Marching/PhotonLanes.cl"
#include "Photons/Marching/PhotonSteps.cl"
#include "Refraction/Index/SquaredIndex.cl"

// Floats per photon: position, unit direction, power in units of PackedPhotons::unit
#define PHOTON_FLOATS (6 + CHANNELS)
#if CELLS
// Integers in the record of a coarse cell: deposits of the channels, number of photons, sums of column and row of their
// origins, and sums of the squares of both.
#define RECORD (CHANNELS + 5)
#else
#define RECORD (CHANNELS + 3 * DIRECTIONS + COUNTS)
#endif
#define TINY 1e-20f

// Part of a packet's state that changes within a step, kept in registers. photon_lanes has the complete state.
typedef struct
{
  // `at`: index of the voxel's extinction; `alive`: -1, or 0 for a photon that has ended; `crossings`: number of path
  // segments so far
  integer at, alive, crossings;
  real wall[3], now; // times since the step began: arrival at the next wall of each axis, and now
  // Optical thickness of the voxel's diagonal; sign bit set where the refractive index varies
  real sigma;
  real power[CHANNELS]; // remaining power, in units of PackedPhotons::unit
  real owed[CHANNELS];  // Kahan compensation: the exact power is `power + owed`
#if COUNTS || CELLS
  integer counted; // index of the voxel or coarse cell in which the photon was last counted
#endif
#if BRICKS
  integer voxel[3], last;
#endif
} photon_flight;

// Deposit of one path segment of each photon.
typedef struct
{
  integer at;            // index, in the sums, of the voxel's record
  real amount[CHANNELS]; // power times path integral of transmittance, in fixed-point units of the sums
#if COUNTS || CELLS
  integer entered; // mask of the photons that entered the voxel or coarse cell in this segment
#endif
} photon_gain;

static void land(const photon_flight* flight, photon_lanes* lanes)
{
  PUT_INTEGERS(lanes->at, flight->at);
  PUT_INTEGERS(lanes->crossings, flight->crossings);
  PUT(lanes->now, flight->now);
  FOR_AXES(a)
  {
    PUT(lanes->wall[a], flight->wall[a]);
#if BRICKS
    PUT_INTEGERS(lanes->voxel[a], flight->voxel[a]);
#endif
  }
#if BRICKS
  PUT_INTEGERS(lanes->last, flight->last);
#endif
  FOR_CHANNELS(c)
  {
    PUT(lanes->power[c], flight->power[c]);
  }
}

static void take_off(const march_arrays* arrays, const photon_lanes* lanes, photon_flight* flight)
{
  flight->at = INTEGERS(lanes->at);
  flight->alive = INTEGERS(lanes->alive);
  FOR_AXES(a)
  {
    flight->wall[a] = VECTOR(lanes->wall[a]);
#if BRICKS
    flight->voxel[a] = INTEGERS(lanes->voxel[a]);
#endif
  }
#if BRICKS
  flight->last = INTEGERS(lanes->last);
#endif
  flight->now = VECTOR(lanes->now);
  flight->sigma = gather(float, arrays->sigma, flight->at);
}

// Attenuates the photons over path lengths `length` (diagonals), and computes their deposits, `gained`.
static void attenuate(const march_arrays* arrays, photon_flight* flight, real length, real* gained)
{
  real left, lost, factor;
  integer thick;
  FOR_CHANNELS(c)
  {
    if (c < MEDIUM_CHANNELS)
    {
      const real s = fabs(c == 0 ? flight->sigma : gather(float, arrays->sigma + c * arrays->info->copy, flight->at));
      const real tau = s * length;
      lost = extinguished(tau, &left);
      const real mean = tau > (real)TINY ? lost / tau : (real)1.0f; // mean transmittance over the path length
      factor = mean * length;
#if !CELLS
      factor *= greater(s, (real)1.0f);
#endif
      thick = truth(tau > (real)0.5f);
    }
    gained[c] = flight->power[c] * factor;
    // Rounding errors in optically thin voxels all have the same sign and add up. Compensated summation (Kahan) keeps
    // them small.
    const real taken = flight->power[c] * lost - flight->owed[c];
    const real rest = thick ? flight->power[c] * left : flight->power[c] - taken;
    flight->owed[c] = thick ? (real)0.0f : (flight->power[c] - rest) - taken;
    flight->power[c] = rest;
  }
}

typedef long4 __attribute__((aligned(8))) long4_anywhere;

// Adds the deposit of one photon, a[channel] in fixed-point units of the sums, to a voxel's record.
static void deposit(__global long* record, const float* a, float4 direction)
{
#if CHANNELS == 1 && DIRECTIONS && !ATOMICS
  *(__global long4_anywhere*)record += convert_long4(a[0] * direction);
#else
  float total = 0.0f;
  FOR_CHANNELS(c)
  {
    total += a[c];
    add_units(record + c, (long)a[c]);
  }
#if DIRECTIONS
  add_units(record + CHANNELS, (long)(total * direction.y));
  add_units(record + CHANNELS + 1, (long)(total * direction.z));
  add_units(record + CHANNELS + 2, (long)(total * direction.w));
#endif
#endif
}

#if COUNTS || CELLS
// Counts a photon in the record of the voxel or cell that it has entered.
//   entered  -1 if the photon has entered the voxel or cell in this segment, else 0
static void count_photon(__global long* record, ulong mark, int entered)
{
#if COUNTS
#if ATOMICS
  if (entered)
#endif
  {
    add_units(record + RECORD - 1, (long)mark & entered);
  }
#else
  if (entered)
  {
    const long column = mark & 0xffff, row = mark >> 16;
    add_units(record + CHANNELS, 1);
    add_units(record + CHANNELS + 1, column);
    add_units(record + CHANNELS + 2, row);
    add_units(record + CHANNELS + 3, column * column);
    add_units(record + CHANNELS + 4, row * row);
  }
#endif
}
#define COUNT(record, k, lane) count_photon(record, lanes->mark[k], gain->entered lane);
#else
#define COUNT(record, k, lane)
#endif

static void deposit_all(const march_arrays* arrays, const photon_lanes* lanes, const photon_gain* gain)
{
#define DEPOSIT(k, lane)                                                  \
  {                                                                       \
    float a[CHANNELS];                                                    \
    FOR_CHANNELS(c)                                                       \
    {                                                                     \
      a[c] = gain->amount[c] lane;                                        \
    }                                                                     \
    __global long* record = arrays->sums + (ulong)gain->at lane * RECORD; \
    deposit(record, a, lanes->direction[k]);                              \
    COUNT(record, k, lane)                                                \
  }
  LANE_BY_LANE(DEPOSIT)
#undef DEPOSIT
}

// Prefetches extinction and records of the sums a few voxels ahead of the photons, on a straight line, because memory
// access dominates the time of a march through a large grid. Grids stored by bricks are small and are not prefetched.
static void ask_ahead(const march_arrays* arrays, const photon_lanes* lanes, integer at)
{
#if REAL_WIDTH > 1 && !BRICKS
  const integer there = at + INTEGERS(lanes->ahead);
#if CELLS // coarse cells are few, and their sums are already in caches
#define ASK_FOR_RECORD(lane) PREFETCH(arrays->cells + (long)there lane, 0, 3);
#else
#define ASK_FOR_RECORD(lane) PREFETCH(arrays->sums + (long)there lane * RECORD, 1, 3);
#endif
#define ASK(k, lane)   \
  ASK_FOR_RECORD(lane) \
  PREFETCH(arrays->sigma + (long)there lane, 0, 3);
  LANE_BY_LANE(ASK)
#undef ASK
#endif
}

#if BLOCKS
static void keep_owed(photon_lanes* lanes, const photon_flight* flight)
{
  FOR_CHANNELS(c)
  {
    PUT(lanes->owed[c], flight->owed[c]);
  }
#if CELLS
  PUT_INTEGERS(lanes->counted, flight->counted);
#endif
}

// Appends photon k, which has entered a voxel of another block, to `gone`, the photons that leave this block.
static void hand_on(const march_arrays* arrays, const photon_lanes* lanes, int k)
{
  __global PhotonOnItsWay* photon = arrays->gone + atomic_add(arrays->gone_count, 1);
  hand_way_on(arrays, lanes, k, &photon->way);
  FOR_CHANNELS(c)
  {
    photon->power[c] = lanes->power[c][k];
    photon->owed[c] = lanes->owed[c][k];
  }
  photon->batch = arrays->batch;
  photon->crossings = lanes->crossings[k];
  photon->steps = lanes->steps[k];
#if CELLS
  photon->counted = lanes->counted[k];
#endif
#if MARKS
  photon->mark = lanes->mark[k];
#endif
}

static void take_one_over(photon_lanes* lanes, int k, const __global PhotonOnItsWay* photon)
{
  take_way_over(lanes, k, &photon->way);
  FOR_CHANNELS(c)
  {
    lanes->power[c][k] = photon->power[c];
    lanes->owed[c][k] = photon->owed[c];
  }
  lanes->crossings[k] = photon->crossings;
  lanes->steps[k] = photon->steps;
#if CELLS
  lanes->counted[k] = photon->counted;
#endif
#if MARKS
  lanes->mark[k] = photon->mark;
#endif
}

// Loads a packet of photons that arrived from other blocks: those with indices from `first` to `first + REAL_WIDTH`,
// and below `end`.
static void take_over(const march_arrays* arrays, const __global PhotonOnItsWay* arrived, int first, int end,
  photon_lanes* lanes, photon_flight* flight)
{
  LANES_3(int, voxel);
  for (int k = 0; k < REAL_WIDTH; ++k)
  {
    const __global PhotonOnItsWay* photon = arrived + (first + k < end ? first + k : first);
    take_one_over(lanes, k, photon);
    FOR_AXES(a)
    {
      voxel[a][k] = photon->way.voxel[a];
    }
  }
  integer places[3];
  FOR_AXES(a)
  {
    places[a] = INTEGERS(voxel[a]);
  }
  go_on_in(arrays, lanes, places);
  for (int k = end - first; k < REAL_WIDTH; ++k)
  {
    rest(lanes, k);
  }
  flight->crossings = INTEGERS(lanes->crossings);
  FOR_CHANNELS(c)
  {
    flight->power[c] = VECTOR(lanes->power[c]);
    flight->owed[c] = VECTOR(lanes->owed[c]);
  }
#if CELLS // a coarse cell may extend over several blocks
  flight->counted = INTEGERS(lanes->counted);
#elif COUNTS
  flight->counted = -1;
#endif
}
#endif

// Computes the deposits of the photons in their voxels over path lengths `length`, and attenuates them.
static void leave_light(const march_arrays* arrays, photon_flight* flight, real length, photon_gain* gain)
{
  attenuate(arrays, flight, length, gain->amount);
#if CELLS
  gain->at = gather(int, arrays->cells, flight->at);
#else
  gain->at = flight->at;
#endif
#if COUNTS || CELLS
  // Photons that start on a wall, and terminated photons, have a path segment of zero length. It is not counted.
  gain->entered = truth(gain->at != flight->counted) & truth(length > (real)0.0f);
  flight->counted = gain->entered ? gain->at : flight->counted;
#endif
}

// Moves photons through the walls that they reach at time `next`.
static void cross_walls(const march_arrays* arrays, const photon_lanes* lanes, photon_flight* flight, real next)
{
#if BRICKS
  cross_in_bricks(arrays, lanes, next, flight->voxel, &flight->last, flight->wall, &flight->at);
#else
  FOR_AXES(a)
  {
    const integer through = truth(flight->wall[a] <= next);
    flight->at += through & INTEGERS(lanes->stride[a]);
    flight->wall[a] += masked(through, VECTOR(lanes->across[a]));
  }
#endif
  flight->now = next;
  flight->sigma = gather(float, arrays->sigma, flight->at);
}

// Power of each photon's brightest channel, in units of PackedPhotons::unit.
static real brightest(const photon_flight* flight)
{
  real most = flight->power[0];
  for (int c = 1; c < CHANNELS; ++c)
  {
    most = greater(most, flight->power[c]);
  }
  return most;
}

#if BENDS
// Mask of the photons that must start a new step, because their step has ended or they have entered a region of varying
// refractive index.
static integer to_turn(const photon_lanes* lanes, const photon_flight* flight)
{
  const real turn = VECTOR(lanes->turn);
  return truth(turn <= flight->now) |
    (truth(as_integer(flight->sigma) < 0) & truth(turn == (real)NEVER) & truth(flight->now >= VECTOR(lanes->settled)));
}
#endif

// Mask of the photons that `attend` must handle: they end, because they are outside or dark, or they start a new step.
static integer to_attend(const march_arrays* arrays, const photon_lanes* lanes, const photon_flight* flight)
{
  integer special = truth(flight->sigma == (real)OUTSIDE) | truth(brightest(flight) < (real)arrays->info->darkness);
#if BENDS
  special |= to_turn(lanes, flight);
#endif
  return special & flight->alive;
}

// Mask of the photons in a block that have reached the limit of path segments. On an undivided grid the mask is not
// needed: all photons of a packet have the same number of segments, and `follow` applies the limit.
static integer halted(const march_arrays* arrays, const photon_flight* flight)
{
#if BLOCKS
  return flight->alive & truth(flight->crossings >= (integer)arrays->info->eventLimit);
#else
  return (integer)0;
#endif
}

static void end_photon(const photon_lanes* lanes, int k, int face, __global PhotonEnd* end)
{
  end->face = face;
  end->crossings = lanes->crossings[k];
  end->steps = lanes->steps[k];
  FOR_CHANNELS(c)
  {
    end->power[c] = lanes->power[c][k];
  }
}

#if BENDS
// Terminates the photons selected by a mask whose speed is out of range after a change of velocity.
static void give_up_lost(const march_arrays* arrays, photon_lanes* lanes, integer mask, int first)
{
  const real pace = VECTOR(lanes->pace);
  const integer lost = mask & ~(truth(pace > (real)SLOWEST_PACE) & truth(pace < (real)FASTEST_PACE));
  if (anywhere(lost))
  {
    FOR_LANES(k, lost)
    {
      end_photon(lanes, k, StillGoing, arrays->ends + first + k);
      rest(lanes, k);
    }
  }
}
#endif

// Handles the photons that a mask selects. A photon ends if it has left the grid or the block, if its power is below
// MarchInfo::darkness, or, in a block, if it has reached the limit of path segments. A photon that enters another block
// is passed on to it. A photon starts a new step if its step has ended or if it has entered a region of varying
// refractive index.
static void attend(
  const march_arrays* arrays, photon_lanes* lanes, const photon_flight* flight, integer mask, int first)
{
  const integer outside = truth(flight->sigma == (real)OUTSIDE);
  const integer dark = truth(brightest(flight) < (real)arrays->info->darkness);
  const integer ended = mask & (outside | dark);
  if (anywhere(ended))
  {
    const int beyond = bits_of(outside);
#if BLOCKS
    keep_owed(lanes, flight);
#endif
    FOR_LANES(k, ended)
    {
      const int face = beyond >> k & 1 ? face_left(arrays->info, lanes, k) : Dark;
#if BLOCKS
      if (face == Elsewhere)
      {
        hand_on(arrays, lanes, k);
      }
#endif
      end_photon(lanes, k, face, arrays->ends + first + k);
      rest(lanes, k);
    }
  }
#if BENDS
  const integer turning = mask & ~ended & to_turn(lanes, flight);
  if (anywhere(turning))
  {
    take_turns(arrays, lanes, turning);
    give_up_lost(arrays, lanes, turning, first);
  }
#endif
#if BLOCKS
  const integer spent = mask & INTEGERS(lanes->alive) & halted(arrays, flight);
  FOR_LANES(k, spent)
  {
    end_photon(lanes, k, StillGoing, arrays->ends + first + k);
    rest(lanes, k);
  }
#endif
}

static void load_packet(const march_arrays* arrays, const __global float* photons, int first, int end,
  photon_lanes* lanes, photon_flight* flight)
{
  LANES_3(float, position);
  LANES_3(float, direction);
  for (int k = 0; k < REAL_WIDTH; ++k)
  {
    const bool there = first + k < end;
    const __global float* photon = photons + (ulong)(there ? first + k : first) * PHOTON_FLOATS;
    FOR_AXES(a)
    {
      position[a][k] = photon[a];
      direction[a][k] = photon[3 + a];
    }
    FOR_CHANNELS(c)
    {
      lanes->power[c][k] = there ? photon[6 + c] : 0.0f;
    }
#if MARKS
    lanes->mark[k] = there ? arrays->marks[first + k] : 0;
#endif
  }
  real p[3], u[3];
  FOR_AXES(a)
  {
    p[a] = VECTOR(position[a]);
    u[a] = VECTOR(direction[a]);
  }
  set_off(arrays, lanes, p, u);
  for (int k = end - first; k < REAL_WIDTH; ++k)
  {
    rest(lanes, k);
  }
  PUT_INTEGERS(lanes->crossings, (integer)0);
#if BENDS
  give_up_lost(arrays, lanes, INTEGERS(lanes->alive), first);
#endif
  flight->crossings = 0;
#if COUNTS || CELLS
  flight->counted = -1;
#endif
  FOR_CHANNELS(c)
  {
    flight->power[c] = VECTOR(lanes->power[c]);
    flight->owed[c] = 0.0f;
  }
  take_off(arrays, lanes, flight);
}
