// Kernels that march photons through a medium and deposit their light (Pfeuti 2009, section 3.1.5, except for the
// accumulation). The host defines the macros of the included files, and
//   CHANNELS         channels of light; MEDIUM_CHANNELS of sigma_t, 1 or CHANNELS
//   WORKERS          0: one work-item per packet, and all add to the same sums; else the number of work-items, which
//                    fetch BLOCK photons at a time from a counter and each add to a separate copy of the sums
//   COUNTS           1: voxels also count photons and sum their weights; a photon's mark is 1 << CountShift plus its
//                    weight in units
//   CELLS            1: deposits go to coarse cells, which also count photons and sum the columns and rows of their
//                    origins; a photon's mark is column and row << 16
//   PATHS            1: vertices of paths are written, and nothing is deposited
//   BRICKS           1: medium and sums are stored by bricks (PhotonBricks.cl), without COUNTS and CELLS
//   TURNS            1: photons march in turns, and are stored between them; one batch, without PATHS and BLOCKS
//
// A step is followed from voxel wall to voxel wall (Amanatides and Woo 1987). In a voxel with optical thickness s
// along a diagonal, and b = max(s, 1), the sums gain the deposit a (numerics.md, Eqs. (35), (97)):
//   a = power b (path integral of transmittance, in diagonals),   0 <= a <= power
// Coarse cells, whose voxels differ in s, gain power times path length in diagonals (b = 1).
//
// A photon is counted each time it enters a voxel (or coarse cell), however many segments it then has inside.

#include "Photons/Marching/PhotonFlight.cl"

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

// Whether the path continues in the same direction in another block. The end of this segment is then no corner of the
// path.
static bool goes_on_elsewhere(const march_arrays* arrays, const photon_lanes* lanes, const photon_flight* flight)
{
#if BLOCKS
  return flight->sigma == OUTSIDE && face_left(arrays->info, lanes, 0) == Elsewhere;
#else
  return false;
#endif
}

// Adds the photon's position and remaining power to the vertices of its path.
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

// Follows a packet of photons (one per vector lane) over at most `events` path segments, or to their ends. Returns
// whether some photons have not ended. With PATHS, `vertices` counts the vertices of the path.
static bool follow(
  const march_arrays* arrays, photon_lanes* lanes, photon_flight* flight, int first, int events, int* vertices)
{
  // The deposit of a segment is added while the extinction for the next segment is fetched from memory.
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
      deposit_all(arrays, lanes, &gain); // added before any photon changes direction, since deposits record directions
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

// Terminates the photons of a packet that have not ended.
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

#if BLOCKS
// Loads a packet of photons that arrived from other blocks. Ends photons that are outside, dark or at the limit of path
// segments, and starts the next step of photons whose step has ended. With PATHS, counts the corners of their paths.
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
#endif

// Follows the photons with indices from `first` to `first + REAL_WIDTH`, and below `end`, to their ends or into another
// block. With PATHS, returns the number of vertices of the path; the path's start counts, the point where it enters the
// block does not.
//   photons  photons that start (PHOTON_FLOATS each) or, with `resumes`, PhotonOnItsWay
static int march_packet(const march_arrays* arrays, const __global float* photons, int resumes, int first, int end)
{
  photon_lanes lanes;
  photon_flight flight;
  int vertices = 0;
#if BLOCKS
  if (resumes)
  {
    resume_packet(arrays, (const __global PhotonOnItsWay*)photons, first, end, &lanes, &flight, &vertices);
  }
  else
#endif
  {
    load_packet(arrays, photons, first, end, &lanes, &flight);
#if PATHS
    add_vertex(arrays, &lanes, &flight, &vertices);
#endif
  }
  if (anywhere(flight.alive) && follow(arrays, &lanes, &flight, first, arrays->info->eventLimit, &vertices))
  {
    give_up_all(arrays, &lanes, &flight, first);
  }
  return vertices;
}

#if !BLOCKS
#define GONE
#elif PATHS
#define GONE , gone, counters, 0
#else
#define GONE , gone, counters + launch.batches, batch
#endif

#if PATHS
// Traces the parts of paths that lie in this block, one per work-item. If launch.writes is 0, counts the vertices of
// part i in places[i]; otherwise writes these vertices to vertices + places[i]. `marks` holds the indices of the
// photons.
__kernel void trace_paths(
  MarchInfo info, MarchLaunch launch, const __global float* sigma, const __global float* coefficients,
  const __global uchar* nodes, const __global int* cells, const __global float* photons, const __global ulong* marks,
  __global PhotonEnd* ends, __global int* places, __global float4* vertices, volatile __global int* counters
#if BLOCKS
  ,
  __global PhotonOnItsWay* gone
#endif
)
{
  const int i = get_global_id(0);
  const march_arrays arrays = { &info, sigma, coefficients, nodes, 0, ends, launch.writes ? vertices + places[i] : 0,
    marks, cells GONE };
  const int count = march_packet(&arrays, photons, launch.resumes, i, i + 1);
  places[i] = launch.writes ? places[i] : count;
}
#else

#if TURNS
// State of a packet of photons between two turns (launches over a limited number of path segments).
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

// Writes the size of a photon_packet in bytes, for the host.
__kernel void size_packet(__global int* bytes)
{
  bytes[0] = sizeof(photon_packet);
}

// Marches a packet of photons (one per vector lane) for one turn: over launch->events path segments from its current
// state.
//   going  receives the number of photons in the packet that have not ended
//   left   is increased by this number
static void take_turn(const march_arrays* arrays, const MarchLaunch* launch, const __global float* photons,
  __global photon_packet* packet, __global int* going, volatile __global int* left, int first, int end)
{
  photon_packet here;
  if (!launch->resumes)
  {
    load_packet(arrays, photons, first, end, &here.lanes, &here.flight);
  }
  else if (*going)
  {
    here = *packet;
  }
  else
  {
    return;
  }
  int vertices = 0;
  bool goes = anywhere(here.flight.alive);
  goes = goes && follow(arrays, &here.lanes, &here.flight, first, launch->events, &vertices);
  if (goes && launch->last)
  {
    give_up_all(arrays, &here.lanes, &here.flight, first);
  }
  *going = goes && !launch->last ? number_of(&here) : 0;
  if (*going)
  {
    *packet = here;
    atomic_add(left, *going);
  }
}
#define MARCH_PACKET(first, end)                                                                     \
  take_turn(&arrays, &launch, photons, packets + (first) / REAL_WIDTH, going + (first) / REAL_WIDTH, \
    counters + launch.batches, first, end)
#else
#define MARCH_PACKET(first, end) march_packet(&arrays, photons, launch.resumes, first, end)
#endif

// Marches photons launch.first to launch.first + launch.count within each batch: photons that start or, with
// launch.resumes, photons that arrived from another block.
//   batch_begin  batch b begins at batch_begin[b] and ends where the next one begins
//   counters     index of the next photon of each batch; then with BLOCKS the number of photons in `gone`, with TURNS
//                the number of photons that have not ended
__kernel void march_photons(
  MarchInfo info, MarchLaunch launch, const __global float* sigma, const __global float* coefficients,
  const __global uchar* nodes, const __global int* cells, const __global float* photons, const __global ulong* marks,
  __global PhotonEnd* ends, __global long* sums, const __global int* batch_begin, volatile __global int* counters
#if BLOCKS
  ,
  __global PhotonOnItsWay* gone
#elif TURNS
  ,
  __global photon_packet* packets, __global int* going
#endif
)
{
#if WORKERS > 0
  for (int copy = get_global_id(0); copy < launch.copies; copy += WORKERS)
  {
    const int batch = copy % launch.batches;
    const int begin = batch_begin[batch] + launch.first, left = min(launch.count, batch_begin[batch + 1] - begin);
    const march_arrays arrays = { &info, sigma, coefficients, nodes, sums + copy * launch.copyStride, ends, 0, marks,
      cells GONE };
    // A work-item marches blocks of consecutive photons, which are neighbours in space and share cache lines. The sums
    // do not depend on which work-item fetches a block.
    for (int block = atomic_add(counters + batch, BLOCK); block < left; block = atomic_add(counters + batch, BLOCK))
    {
      for (int i = begin + block; i < begin + min(block + BLOCK, left); i += REAL_WIDTH)
      {
        MARCH_PACKET(i, begin + left);
      }
    }
  }
#else
  const int batch = get_global_id(1), begin = batch_begin[batch] + launch.first;
  const int left = min(launch.count, batch_begin[batch + 1] - begin), i = get_global_id(0) * REAL_WIDTH;
  if (i < left)
  {
    const march_arrays arrays = { &info, sigma, coefficients, nodes, sums + batch * launch.copyStride, ends, 0, marks,
      cells GONE };
    MARCH_PACKET(begin + i, begin + left);
  }
#endif
}
#endif
