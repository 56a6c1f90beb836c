// Marches photons through a medium and deposits their light (Pfeuti 2009, section 3.1.5, but for the accumulation). The
// host defines the macros of the included files, and
//   CHANNELS         channels of light; MEDIUM_CHANNELS of sigma_t, 1 or CHANNELS
//   WORKERS          0: one work-item per packet, all add to the same sums; else the number of work-items, which fetch
//                    blocks of photons from a counter and add each to its own sums
//   COUNTS           1: voxels also count photons and sum their weights; a photon's mark is 1 << CountShift plus its
//                    weight in units
//   CELLS            1: deposits go to coarse cells, which also count photons and sum the columns and rows of their
//                    origins; a photon's mark is column and row << 16
//   PATHS            1: vertices of paths are written, and nothing is deposited
//   BRICKS           1: medium and sums are stored by bricks (PhotonBricks.cl), without COUNTS and CELLS
//   TURNS            1: photons march in turns, and are stored between them; one batch, without PATHS
//   BLOCKS           1: photons march to the end of their block of the grid (PhotonsOnward.cl), without BRICKS and
//                    TURNS
//
// A step is followed from voxel wall to voxel wall (Amanatides and Woo 1987). In a voxel with optical thickness s along
// a diagonal, and b = max(s, 1), the sums gain (numerics.md, Eqs. (35), (97))
//   a = power b (path integral of transmittance, in diagonals),   0 <= a <= power
// Cells, whose voxels differ, gain power times path in diagonals.
//
// A photon is counted when it enters a voxel (a cell), once for any number of segments in it, and again when it
// re-enters.

#define MARKS (COUNTS || CELLS || (BLOCKS && PATHS))

#include "Numerics/FixedPoint.cl"
#include "Numerics/Numerics.cl"
#include "Numerics/Prefetch.cl"
#include "Photons/Marching/PhotonLanes.cl"
#include "Photons/Marching/PhotonSteps.cl"
#include "Refraction/Index/SquaredIndex.cl"

#define PHOTON_FLOATS (6 + CHANNELS) // position, unit direction, power in units
#if CELLS
#define RECORD (CHANNELS + 5) // photons, sums of column, row and their squares
#else
#define RECORD (CHANNELS + 3 * DIRECTIONS + COUNTS)
#endif
#define TINY 1e-20f

// The part of the state that changes between two velocity changes, in registers.
typedef struct
{
  integer at, alive, crossings;
  real wall[3], now;
  real sigma;
  real power[CHANNELS];
  real owed[CHANNELS]; // Kahan compensation: the power is `power + owed`
#if COUNTS || CELLS
  integer counted; // voxel or cell that counted the photon last
#endif
#if BRICKS
  integer voxel[3], last;
#endif
} photon_flight;

// The deposit of one path segment.
typedef struct
{
  integer at; // record of the sums
  real amount[CHANNELS];
#if COUNTS || CELLS
  integer entered; // mask of the photons that entered this voxel or cell
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

// Attenuates the photons over `length` (diagonals), and computes the deposit of each, `gained`.
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
      const real mean = tau > (real)TINY ? lost / tau : (real)1.0f; // mean transmittance over the length
      factor = mean * length;
#if !CELLS
      factor *= greater(s, (real)1.0f);
#endif
      thick = truth(tau > (real)0.5f);
    }
    gained[c] = flight->power[c] * factor;
    // Through many optically thin voxels, rounding errors have the same sign in each: compensated summation (Kahan).
    const real taken = flight->power[c] * lost - flight->owed[c];
    const real rest = thick ? flight->power[c] * left : flight->power[c] - taken;
    flight->owed[c] = thick ? (real)0.0f : (flight->power[c] - rest) - taken;
    flight->power[c] = rest;
  }
}

typedef long4 __attribute__((aligned(8))) long4_anywhere;

// Adds the deposit of one photon, a[channel], to a voxel's record.
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
// Counts one photon in a voxel or cell if it entered it (entered: -1, else 0).
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

// Memory access dominates the time of a march through a large grid. Prefetches records a few voxels ahead of the
// photons on a straight line. Grids stored by bricks are small enough without.
static void ask_ahead(const march_arrays* arrays, const photon_lanes* lanes, integer at)
{
#if REAL_WIDTH > 1 && !BRICKS
  const integer there = at + INTEGERS(lanes->ahead);
#if CELLS // cells are few, and their sums are already in caches
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
#include "Photons/Marching/PhotonsOnward.cl"
#endif

// Computes the deposits of the photons over `length` in their voxels.
static void leave_light(const march_arrays* arrays, photon_flight* flight, real length, photon_gain* gain)
{
  attenuate(arrays, flight, length, gain->amount);
#if CELLS
  gain->at = gather(int, arrays->cells, flight->at);
#else
  gain->at = flight->at;
#endif
#if COUNTS || CELLS
  // Segments of photons that start on a wall, or have ended, have zero length.
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

// The power of a photon's brightest channel.
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
// The photons that start a new step here: their step has ended, or they have entered a region of varying index.
static integer to_turn(const photon_lanes* lanes, const photon_flight* flight)
{
  const real turn = VECTOR(lanes->turn);
  return truth(turn <= flight->now) |
    (truth(as_integer(flight->sigma) < 0) & truth(turn == (real)NEVER) & truth(flight->now >= VECTOR(lanes->settled)));
}
#endif

// The photons that have ended, or start a new step.
static integer to_attend(const march_arrays* arrays, const photon_lanes* lanes, const photon_flight* flight)
{
  integer special = truth(flight->sigma == (real)OUTSIDE) | truth(brightest(flight) < (real)arrays->info->darkness);
#if BENDS
  special |= to_turn(lanes, flight);
#endif
  return special & flight->alive;
}

// In a block: the photons that have reached the limit of path segments, or the number after which they wait. There,
// unlike in a serial march, photons of a packet may have different numbers of segments behind them.
static integer halted(const march_arrays* arrays, const photon_flight* flight)
{
#if BLOCKS
  const int most = min(arrays->info->eventLimit, arrays->info->pause);
  return flight->alive & truth(flight->crossings >= (integer)most);
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
// Gives up the photons of a mask whose velocity is out of range after a change.
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

// Ends the photons of a mask, or starts their next steps.
static void attend(
  const march_arrays* arrays, photon_lanes* lanes, const photon_flight* flight, integer mask, int first)
{
  const integer outside = truth(flight->sigma == (real)OUTSIDE);
  const integer dark = truth(brightest(flight) < (real)arrays->info->darkness);
#if BLOCKS
  const bool waits = arrays->info->pause < arrays->info->eventLimit;
  const integer halt = halted(arrays, flight), ended = mask & (outside | dark | (waits ? halt : (integer)0));
#else
  const integer ended = mask & (outside | dark);
#endif
  if (anywhere(ended))
  {
    const int beyond = bits_of(outside);
#if BLOCKS
    const int nothing = bits_of(dark);
    keep_owed(lanes, flight);
#endif
    FOR_LANES(k, ended)
    {
#if BLOCKS // a waiting photon continues from where it is
      const int face = beyond >> k & 1 ? face_left(arrays->info, lanes, k) : nothing >> k & 1 ? Dark : Elsewhere;
#else
      const int face = beyond >> k & 1 ? face_left(arrays->info, lanes, k) : Dark;
#endif
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
  const integer spent = mask & INTEGERS(lanes->alive) & halt;
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

#if PATHS
static float total_power(const photon_flight* flight)
{
  float sum = 0.0f;
  FOR_CHANNELS(c)
  {
    sum += flight->power[c];
  }
  return sum;
}

// Whether the path continues straight into another block, so that it has no corner here.
static bool goes_on_elsewhere(const march_arrays* arrays, const photon_lanes* lanes, const photon_flight* flight)
{
#if BLOCKS
  return flight->sigma == OUTSIDE && face_left(arrays->info, lanes, 0) == Elsewhere;
#else
  return false;
#endif
}

// Adds the photon's position to its path.
static void add_vertex(const march_arrays* arrays, const photon_lanes* lanes, const photon_flight* flight, int* count)
{
  if (arrays->vertices)
  {
    const float3 start = (float3)(lanes->start[0][0], lanes->start[1][0], lanes->start[2][0]);
    const float3 velocity = (float3)(lanes->velocity[0][0], lanes->velocity[1][0], lanes->velocity[2][0]);
    arrays->vertices[*count] = (float4)(start + velocity * lanes->now[0], total_power(flight));
  }
  ++*count;
}
#endif

// Follows a packet, some photons of which have not ended, over at most `events` path segments, or to their ends.
// Returns whether some have not ended. With PATHS, `vertices` counts the vertices of the path.
static bool follow(
  const march_arrays* arrays, photon_lanes* lanes, photon_flight* flight, int first, int events, int* vertices)
{
  // A deposit is added one segment later, while the extinction of the next one is fetched from memory.
  photon_gain gain;
  bool owed = false;
  for (int event = 0; event < events; ++event)
  {
    real next = lesser(lesser(flight->wall[0], flight->wall[1]), flight->wall[2]);
#if BENDS
    next = lesser(next, VECTOR(lanes->turn));
#endif
#if !PATHS
    if (owed)
    {
      deposit_all(arrays, lanes, &gain);
    }
    ask_ahead(arrays, lanes, flight->at);
#endif
    leave_light(arrays, flight, greater(next - flight->now, (real)0.0f) * VECTOR(lanes->pace), &gain);
    flight->crossings -= flight->alive;
    owed = true;
    cross_walls(arrays, lanes, flight, next);
    const integer corner = to_attend(arrays, lanes, flight);
    const integer special = corner | halted(arrays, flight);
    if (anywhere(special))
    {
#if !PATHS
      deposit_all(arrays, lanes, &gain); // before directions change
      owed = false;
#endif
      land(flight, lanes);
#if PATHS
      if (corner && !goes_on_elsewhere(arrays, lanes, flight))
      {
        add_vertex(arrays, lanes, flight, vertices);
      }
#endif
      attend(arrays, lanes, flight, special, first);
      take_off(arrays, lanes, flight);
      if (!anywhere(flight->alive))
      {
        return false;
      }
    }
  }
#if !PATHS
  if (owed)
  {
    deposit_all(arrays, lanes, &gain);
  }
#endif
  return true;
}

// Gives up the photons that have not ended.
static void give_up_all(const march_arrays* arrays, photon_lanes* lanes, const photon_flight* flight, int first)
{
  land(flight, lanes);
  for (int k = 0; k < REAL_WIDTH; ++k)
  {
    if (lanes->alive[k])
    {
      end_photon(lanes, k, StillGoing, arrays->ends + first + k);
    }
  }
}

// Follows photons `first` to `first + REAL_WIDTH`, but only those before `end`, to their ends. Returns the number of
// vertices of the path, with PATHS.
static int march_packet(const march_arrays* arrays, const __global float* photons, int first, int end)
{
  photon_lanes lanes;
  photon_flight flight;
  load_packet(arrays, photons, first, end, &lanes, &flight);
  int vertices = 0;
#if PATHS
  add_vertex(arrays, &lanes, &flight, &vertices);
#endif
  if (anywhere(flight.alive) && follow(arrays, &lanes, &flight, first, arrays->info->eventLimit, &vertices))
  {
    give_up_all(arrays, &lanes, &flight, first);
  }
  return vertices;
}

#if BLOCKS
// Loads photons that arrived from other blocks, as load_packet does those that start. With PATHS, counts their corners.
static void resume_packet(const march_arrays* arrays, const __global PhotonOnItsWay* arrived, int first, int end,
  photon_lanes* lanes, photon_flight* flight, int* vertices)
{
  take_over(arrays, arrived, first, end, lanes, flight);
  take_off(arrays, lanes, flight);
  const integer corner = to_attend(arrays, lanes, flight);
  const integer special = corner | halted(arrays, flight);
  if (anywhere(special))
  {
    land(flight, lanes);
#if PATHS
    if (corner)
    {
      add_vertex(arrays, lanes, flight, vertices);
    }
#endif
    attend(arrays, lanes, flight, special, first);
    take_off(arrays, lanes, flight);
  }
}

// Returns the number of vertices of the path, with PATHS, including the photon's start but not its entry into the
// block.
static int march_packet_in_block(const march_arrays* arrays, const __global float* photons,
  const __global PhotonOnItsWay* arrived, int resumes, int first, int end)
{
  photon_lanes lanes;
  photon_flight flight;
  int vertices = 0;
  if (resumes)
  {
    resume_packet(arrays, arrived, first, end, &lanes, &flight, &vertices);
  }
  else
  {
    load_packet(arrays, photons, first, end, &lanes, &flight);
#if PATHS
    add_vertex(arrays, &lanes, &flight, &vertices);
#endif
  }
  if (anywhere(flight.alive))
  {
    follow(arrays, &lanes, &flight, first, arrays->info->eventLimit, &vertices);
  }
  return vertices;
}

#if PATHS
// Traces parts of paths, one per work-item, of the starting `photons` or, with `resumes`, of the photons in `arrived`.
// Writes counts[i] vertices to vertices + offsets[i]; with `counting`, only counts them. Marks identify photons.
__kernel void trace_in_block(MarchInfo info, const __global float* sigma, const __global float* coefficients,
  const __global uchar* nodes, const __global float* photons, const __global ulong* marks,
  const __global PhotonOnItsWay* arrived, __global PhotonOnItsWay* gone, volatile __global int* gone_count,
  __global PhotonEnd* ends, int counting, const __global int* offsets, __global float4* vertices, __global int* counts,
  int resumes)
{
  const int i = get_global_id(0);
  const march_arrays arrays = { &info, sigma, coefficients, nodes, 0, ends, counting ? 0 : vertices + offsets[i], marks,
    0, gone, gone_count };
  counts[i] = march_packet_in_block(&arrays, photons, arrived, resumes, i, i + 1);
}
#else
// Marches photons `first` to `first + count`, of one batch, to their ends or into another block: the starting `photons`
// or, with `resumes`, those in `arrived`. Photons that continue elsewhere are appended to `gone` in any order;
// gone_count is their number. Copies of the batch's sums begin at `copyBegin` and are `copyStride` apart.
__kernel void march_block(MarchInfo info, const __global float* sigma, const __global float* coefficients,
  const __global uchar* nodes, const __global float* photons, const __global ulong* marks,
  const __global PhotonOnItsWay* arrived, __global PhotonOnItsWay* gone, volatile __global int* gone_count,
  __global PhotonEnd* ends, __global long* sums, ulong copyBegin, ulong copyStride, volatile __global int* next,
  int resumes, int first, int count, const __global int* cells)
{
  const int end = first + count;
#if WORKERS > 0
  const march_arrays arrays = { &info, sigma, coefficients, nodes, sums + copyBegin + get_global_id(0) * copyStride,
    ends, 0, marks, cells, gone, gone_count };
  for (int block = atomic_add(next, BLOCK); block < count; block = atomic_add(next, BLOCK))
  {
    for (int i = first + block; i < first + min(block + BLOCK, count); i += REAL_WIDTH)
    {
      march_packet_in_block(&arrays, photons, arrived, resumes, i, end);
    }
  }
#else
  const march_arrays arrays = { &info, sigma, coefficients, nodes, sums + copyBegin, ends, 0, marks, cells, gone,
    gone_count };
  march_packet_in_block(&arrays, photons, arrived, resumes, first + get_global_id(0) * REAL_WIDTH, end);
#endif
}
#endif

#elif PATHS
// Traces the path of photon i, one per work-item. Writes counts[i] vertices to vertices + offsets[i]; with `counting`,
// only counts them.
__kernel void trace_paths(MarchInfo info, const __global float* sigma, const __global float* coefficients,
  const __global uchar* nodes, const __global float* photons, const __global int* cells, __global PhotonEnd* ends,
  int counting, const __global int* offsets, __global float4* vertices, __global int* counts)
{
  const int i = get_global_id(0);
  const march_arrays arrays = { &info, sigma, coefficients, nodes, 0, ends, counting ? 0 : vertices + offsets[i], 0,
    cells };
  counts[i] = march_packet(&arrays, photons, i, i + 1);
}
#elif TURNS
// State of a packet between two turns.
typedef struct
{
  photon_lanes lanes;
  photon_flight flight;
} photon_packet;

// Number of photons in a packet that have not ended.
static int number_of(const photon_packet* packet)
{
  int number = 0;
  for (int k = 0; k < REAL_WIDTH; ++k)
  {
    number += packet->lanes.alive[k] != 0;
  }
  return number;
}

// Size of a photon_packet in bytes, for the host.
__kernel void size_packet(__global int* bytes)
{
  bytes[0] = sizeof(photon_packet);
}

// Marches a packet for one turn: over `events` path segments from its current state.
static void take_turn(const march_arrays* arrays, const __global float* photons, __global photon_packet* packet,
  __global int* going, int first, int end, int turn, int events, int last)
{
  photon_packet here;
  if (turn == 0)
  {
    load_packet(arrays, photons, first, end, &here.lanes, &here.flight);
  }
  else
  {
    here = *packet;
  }
  int vertices = 0;
  bool goes = anywhere(here.flight.alive);
  goes = goes && follow(arrays, &here.lanes, &here.flight, first, events, &vertices);
  if (goes && last)
  {
    give_up_all(arrays, &here.lanes, &here.flight, first);
  }
  *going = goes && !last ? number_of(&here) : 0;
  if (*going)
  {
    *packet = here;
  }
}

// One turn of all `count` photons, which are of one batch (march_photons).
//   packets  state of the packets; going: number of photons in each that have not ended
//   left     their total is added to it
//   turn     number of the turn; last: photons that have not ended are given up after it
__kernel void march_turn(MarchInfo info, const __global float* sigma, const __global float* coefficients,
  const __global uchar* nodes, const __global float* photons, const __global ulong* marks, const __global int* cells,
  __global PhotonEnd* ends, __global long* sums, ulong copyStride, __global photon_packet* packets, __global int* going,
  volatile __global int* left, volatile __global int* next, int count, int turn, int events, int last)
{
  int still = 0;
#if WORKERS > 0
  const march_arrays arrays = { &info, sigma, coefficients, nodes, sums + get_global_id(0) * copyStride, ends, 0, marks,
    cells };
  for (int block = atomic_add(next, BLOCK); block < count; block = atomic_add(next, BLOCK))
  {
    for (int i = block; i < min(block + BLOCK, count); i += REAL_WIDTH)
#else
  const march_arrays arrays = { &info, sigma, coefficients, nodes, sums, ends, 0, marks, cells };
  {
    const int i = get_global_id(0) * REAL_WIDTH;
#endif
    {
      const int packet = i / REAL_WIDTH;
      if (turn == 0 || going[packet])
      {
        take_turn(&arrays, photons, packets + packet, going + packet, i, count, turn, events, last);
        still += going[packet];
      }
    }
  }
  if (still > 0)
  {
    atomic_add(left, still);
  }
}
#else
// Marches photons `first` to `first + count` within each batch. Batch b begins at batch_begin[b] and ends where the
// next one begins. There are `copies` of the sums, at least as many as batches; copy c belongs to batch c modulo their
// number.
__kernel void march_photons(MarchInfo info, const __global float* sigma, const __global float* coefficients,
  const __global uchar* nodes, const __global float* photons, const __global ulong* marks, const __global int* cells,
  __global PhotonEnd* ends, __global long* sums, ulong copyStride, int copies, int batches,
  const __global int* batch_begin, volatile __global int* next, int first, int count)
{
#if WORKERS > 0
  for (int copy = get_global_id(0); copy < copies; copy += WORKERS)
  {
    const int batch = copy % batches;
    const int begin = batch_begin[batch] + first, left = min(count, batch_begin[batch + 1] - begin);
    const march_arrays arrays = { &info, sigma, coefficients, nodes, sums + copy * copyStride, ends, 0, marks, cells };
    // Blocks keep neighbouring photons together, as these share cache lines. Which work-item takes a block does not
    // affect the sums.
    for (int block = atomic_add(next + batch, BLOCK); block < left; block = atomic_add(next + batch, BLOCK))
    {
      for (int i = block; i < min(block + BLOCK, left); i += REAL_WIDTH)
      {
        march_packet(&arrays, photons, begin + i, begin + left);
      }
    }
  }
#else
  const int batch = get_global_id(1), begin = batch_begin[batch] + first;
  const int left = min(count, batch_begin[batch + 1] - begin), i = get_global_id(0) * REAL_WIDTH;
  if (i < left)
  {
    const march_arrays arrays = { &info, sigma, coefficients, nodes, sums + batch * copyStride, ends, 0, marks, cells };
    march_packet(&arrays, photons, begin + i, begin + left);
  }
#endif
}
#endif
