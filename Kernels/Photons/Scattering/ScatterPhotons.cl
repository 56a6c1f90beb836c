// Kernels that follow photons through scattering along curved rays (numerics.md, section 12.5), one photon at a time,
// in one channel. The host defines the macros of PhotonSteps.cl, with REAL_WIDTH 1, DIRECTIONS 1, CHANNELS 1, and
//   WORKERS   as in PhotonMarch.cl; ATOMICS: whether work-items share sums
//   BLOCK     number of consecutive photons that a work-item fetches at a time
//   GATHERS   1: sums include the net flux besides the power
//   PHASE     phase function: 0 isotropic, 1 Henyey-Greenstein, 2 Schlick, 3 table of cosines
//   VARIES    1: the parameter of phase functions 1 and 2 is given by voxel
//   COSINES   number of cosines in the table, minus one
//
// The optical depth to the next scattering is sampled, then reduced along the path until it is 0. Absorption is
// subtracted from the photon's power. From the first scattering on, the photon deposits its remaining power times path
// length. This estimates the fluence of scattered light without bias for voxels of any optical thickness.

#include "Numerics/FixedPoint.cl"
#include "Numerics/Philox.cl"
#include "Photons/Marching/PhotonSteps.cl"

#define RECORD (1 + 3 * GATHERS)
#define PHOTON_FLOATS 7
#define TINY 1e-20f
// Russian roulette is played when a photon's power falls below this fraction of its initial power. The photon then
// either ends, or its power becomes twice this threshold.
#define DIM 0.05f

// Scattering properties of the medium in one channel.
typedef struct
{
  const __global float2* optical; // sigma_s and sigma_a times a voxel's diagonal, per voxel of the padded grid
  // Parameter of the phase function, one value or one per voxel; or table of cosines of the scattering angle at
  // equidistant values of the cumulative probability.
  const __global float* phase;
#if BLOCKS
  __global ScatteredOnItsWay* gone; // photons that entered other blocks, in any order
  volatile __global int* gone_count;
#endif
} scattering;

static float cosine_of(const scattering* medium, ulong voxel, float u)
{
  const float s = 2.0f * u - 1.0f;
  if (PHASE == 0)
  {
    return s;
  }
  if (PHASE == 3)
  {
    const float position = u * COSINES;
    const int i = min((int)position, COSINES - 1);
    return mix(medium->phase[i], medium->phase[i + 1], position - i);
  }
  const float g = medium->phase[VARIES ? voxel : 0], above = 1.0f + g * s;
  if (PHASE == 2)
  {
    return (s + g) / above;
  }
  // Inverse cumulative distribution of Henyey and Greenstein, in a form without cancellation (numerics.md, Eq.
  // (99c)).
  const float sum = s + 0.5f * g * (s * s + 3.0f) + g * g * (s + 0.5f * g * (s * s - 1.0f));
  return sum / (above * above);
}

// Rotates the direction `way` by an angle with the given cosine, and by the azimuth `turn`, in [0, 1) full turns
// (orthonormal frame without a branch: Duff et al. 2017).
static float3 turned(float3 way, float cosine, float turn)
{
  const float sine = sqrt(fmax(0.0f, 1.0f - cosine * cosine));
  float around;
  const float along = sincos(6.28318531f * turn, &around);
  const float sign = copysign(1.0f, way.z), a = -1.0f / (sign + way.z), b = way.x * way.y * a;
  const float3 first = (float3)(1.0f + sign * way.x * way.x * a, sign * b, -sign * way.x);
  const float3 second = (float3)(b, sign + way.y * way.y * a, -way.y);
  return normalize(sine * (around * first + along * second) + cosine * way);
}

// Index of a voxel in the medium's arrays, from its index in the padded grid.
static ulong voxel_number(const MarchInfo* info, int at)
{
  const int3 voxel = voxel_of(info, at) - vload3(0, info->first);
  return ((ulong)voxel.z * info->grid.size[1] + voxel.y) * info->grid.size[0] + voxel.x;
}

static void leave(__global long* record, float amount, float4 direction)
{
  add_units(record, convert_long_rte(amount));
  if (GATHERS)
  {
    add_units(record + 1, convert_long_rte(amount * direction.y));
    add_units(record + 2, convert_long_rte(amount * direction.z));
    add_units(record + 3, convert_long_rte(amount * direction.w));
  }
}

static void begin(const march_arrays* arrays, photon_lanes* lanes, float3 place, float3 way)
{
  real p[3] = { place.x, place.y, place.z }, u[3] = { way.x, way.y, way.z };
  set_off(arrays, lanes, p, u);
}

// Whether a photon's speed is in the range in which it can be followed.
static bool moves(const photon_lanes* lanes)
{
  return lanes->pace[0] > SLOWEST_PACE && lanes->pace[0] < FASTEST_PACE;
}

// State of a photon between two scatterings, in addition to its path.
typedef struct
{
  ScatterEnd end; // final state that the photon would have if it ended now
  random_numbers random;
  float owed;  // absorbed power too small for end.power to hold, which is still to be subtracted from it
  float dim;   // power below which Russian roulette is played, in units of PackedPhotons::unit
  float depth; // scattering optical depth to the next scattering
  int events;  // number of path segments since the last scattering
} scattered_flight;

#if BLOCKS
// Whether rounding puts the point `place`, at which the photon is scattered, into a voxel of another block. If so,
// stores `place` and the new direction as the state with which the photon starts anew in that block.
static bool sets_off_elsewhere(const march_arrays* arrays, photon_lanes* lanes, float3 place, float3 direction)
{
  const MarchInfo* info = arrays->info;
  const real p[3] = { place.x, place.y, place.z };
  integer voxel[3];
  voxels_of_starts(info, p, voxel);
  FOR_AXES(a)
  {
    voxel[a] = clamp(voxel[a], info->first[a] - 1, info->first[a] + info->grid.size[a]);
  }
  const int at = padded(info, voxel);
  const bool elsewhere = arrays->sigma[at] == OUTSIDE;
  if (elsewhere)
  {
    lanes->at[0] = at;
    lanes->start[0][0] = place.x;
    lanes->start[1][0] = place.y;
    lanes->start[2][0] = place.z;
    lanes->velocity[0][0] = direction.x;
    lanes->velocity[1][0] = direction.y;
    lanes->velocity[2][0] = direction.z;
  }
  return elsewhere;
}

static void hand_on(
  const march_arrays* arrays, const photon_lanes* lanes, const scattered_flight* flight, __global ScatteredOnItsWay* to)
{
  hand_way_on(arrays, lanes, 0, &to->way);
  to->number = flight->random.stream;
  to->blocks = flight->random.block;
  to->drawn = flight->random.left;
  to->events = flight->events;
  to->scatterings = flight->end.scatterings;
  to->depth = flight->depth;
  to->dim = flight->dim;
  to->power = flight->end.power;
  to->owed = flight->owed;
  to->absorbedAtFirst = flight->end.absorbedAtFirst;
  to->exchanged = flight->end.exchanged;
}

static void take_over(const march_arrays* arrays, const ScatterInfo* how, const __global ScatteredOnItsWay* from,
  photon_lanes* lanes, scattered_flight* flight)
{
  const ScatterEnd end = { -1, from->scatterings, from->power, from->absorbedAtFirst, from->exchanged };
  flight->end = end;
  flight->random = random_after(how->seed, from->number, from->blocks, from->drawn);
  flight->owed = from->owed;
  flight->dim = from->dim;
  flight->depth = from->depth;
  flight->events = from->events;
  take_way_over(lanes, 0, &from->way);
  const integer voxel[3] = { from->way.voxel[0], from->way.voxel[1], from->way.voxel[2] };
  go_on_in(arrays, lanes, voxel);
  lanes->steps[0] = 0;
}
#endif

// Scatters the photon at a point ahead of it on its path, at a distance of `way` voxel diagonals.
static void scatter(
  const march_arrays* arrays, const scattering* medium, photon_lanes* lanes, float way, scattered_flight* flight)
{
  const float time = lanes->now[0] + way / lanes->pace[0];
  const float3 start = (float3)(lanes->start[0][0], lanes->start[1][0], lanes->start[2][0]);
  const float3 velocity = (float3)(lanes->velocity[0][0], lanes->velocity[1][0], lanes->velocity[2][0]);
  const float cosine =
    cosine_of(medium, PHASE && VARIES ? voxel_number(arrays->info, lanes->at[0]) : 0, draw(&flight->random));
  const float3 place = start + velocity * time;
  const float3 direction = turned(lanes->direction[0].yzw, cosine, draw(&flight->random));
#if BLOCKS
  if (sets_off_elsewhere(arrays, lanes, place, direction))
  {
    flight->end.face = flight->end.face < 0 ? Elsewhere : flight->end.face;
    return;
  }
#endif
  begin(arrays, lanes, place, direction);
}

// Russian roulette for a photon of low power: either its power is increased, or it ends. The expected power is
// unchanged.
static void roulette(scattered_flight* flight)
{
  ScatterEnd* end = &flight->end;
  if (end->power < flight->dim)
  {
    end->power -= flight->owed;
    flight->owed = 0.0f;
    const float after = draw(&flight->random) * 2.0f * flight->dim < end->power ? 2.0f * flight->dim : 0.0f;
    end->exchanged += after - end->power;
    end->power = after;
    end->face = after > 0.0f ? end->face : Dark;
  }
}

// Moves the photon to its next voxel wall or to the end of its step, whichever it reaches first, at time `next`.
static void move_on(const march_arrays* arrays, photon_lanes* lanes, float next)
{
  FOR_AXES(a)
  {
    const bool through = lanes->wall[a][0] <= next;
    lanes->at[0] += through ? lanes->stride[a][0] : 0;
    lanes->wall[a][0] += through ? lanes->across[a][0] : 0.0f;
  }
  lanes->now[0] = next;
}

// Handles a photon that has reached a voxel wall or the end of its step. Ends the photon if it has left the grid or
// block, and starts a new step if the old one has ended.
static void arrive(const march_arrays* arrays, photon_lanes* lanes, ScatterEnd* end)
{
  const float there = arrays->sigma[lanes->at[0]], now = lanes->now[0];
  if (there == OUTSIDE)
  {
    end->face = face_left(arrays->info, lanes, 0);
  }
#if BENDS
  else if (lanes->turn[0] <= now || (as_int(there) < 0 && lanes->turn[0] == NEVER && now >= lanes->settled[0]))
  {
    take_turns(arrays, lanes, -1);
  }
#endif
}

// Deposits and attenuates the photon's power over a path segment of `way` voxel diagonals.
//   sigma  optical thickness of the voxel's diagonal, by scattering and by absorption
static void leave_stretch(
  const march_arrays* arrays, const photon_lanes* lanes, float2 sigma, float way, scattered_flight* flight)
{
  ScatterEnd* end = &flight->end;
  float remains;
  const float tau = sigma.y * way, lost = extinguished(tau, &remains);
  if (end->scatterings > 0)
  {
    const float mean = tau > TINY ? lost / tau : 1.0f;
    leave(arrays->sums + (ulong)lanes->at[0] * RECORD, end->power * mean * way * fmax(sigma.x + sigma.y, 1.0f),
      lanes->direction[0]);
  }
  else
  {
    end->absorbedAtFirst += end->power * lost;
  }
  if (tau > 0.5f)
  {
    end->power *= remains;
    flight->owed *= remains;
    return;
  }
  // Compensated, since a float loses nothing by a product with 1 - 3e-8: over many paths that would be much.
  const float before = end->power, subtracted = flight->owed + before * lost;
  end->power = before - subtracted;
  flight->owed = subtracted - (before - end->power);
}

// Follows the photon to its next voxel wall or change of velocity, or to a scattering before that.
static void go_on(const march_arrays* arrays, const scattering* medium, const ScatterInfo* how, photon_lanes* lanes,
  scattered_flight* flight)
{
  ScatterEnd* end = &flight->end;
  float next = fmin(fmin(lanes->wall[0][0], lanes->wall[1][0]), lanes->wall[2][0]);
#if BENDS
  next = fmin(next, lanes->turn[0]);
#endif
  const float2 sigma = medium->optical[lanes->at[0]];
  const float length = fmax(next - lanes->now[0], 0.0f) * lanes->pace[0], spent = sigma.x * length;
  const bool collides = spent >= flight->depth;
  const float way = collides ? fmin(flight->depth / sigma.x, length) : length;
  leave_stretch(arrays, lanes, sigma, way, flight);
  if (!collides)
  {
    flight->depth -= spent;
    move_on(arrays, lanes, next);
    ++flight->events;
    arrive(arrays, lanes, end);
  }
  else if (end->scatterings == how->mostScatterings)
  {
    end->face = StillGoing;
  }
  else
  {
    ++end->scatterings;
    flight->events = 0;
    roulette(flight);
    scatter(arrays, medium, lanes, way, flight);
    flight->depth = -log(draw(&flight->random));
  }
}

// Starts a photon. Its index `number` selects its sequence of random numbers.
static void set_out(const march_arrays* arrays, const ScatterInfo* how, const __global float* photon, ulong number,
  photon_lanes* lanes, scattered_flight* flight)
{
  const ScatterEnd end = { -1, 0, photon[6], 0.0f, 0.0f };
  flight->end = end;
  flight->random = random_of(how->seed, number);
  flight->owed = 0.0f;
  flight->dim = DIM * end.power;
  flight->events = 0;
  begin(arrays, lanes, vload3(0, photon), vload3(1, photon));
  flight->depth = -log(draw(&flight->random));
}

// Follows a photon to its end, or into another block.
static void follow(const march_arrays* arrays, const scattering* medium, const ScatterInfo* how, photon_lanes* lanes,
  scattered_flight* flight)
{
  while (flight->end.face < 0)
  {
    if (flight->events >= arrays->info->eventLimit || !moves(lanes))
    {
      flight->end.face = StillGoing;
      break;
    }
    go_on(arrays, medium, how, lanes, flight);
  }
}

// Follows photon i. With how->resumes, photons have arrived from other blocks; otherwise they start in this block.
//   photons  for photons that start: position (voxels), unit direction and power (units of PackedPhotons::unit); for
//            photons that have arrived: ScatteredOnItsWay
//   numbers  indices of the photons that start
static ScatterEnd end_of(const march_arrays* arrays, const scattering* medium, const ScatterInfo* how,
  const __global float* photons, const __global ulong* numbers, int i)
{
  photon_lanes lanes;
  scattered_flight flight;
#if BLOCKS
  if (how->resumes)
  {
    const __global ScatteredOnItsWay* arrived = (const __global ScatteredOnItsWay*)photons + i;
    take_over(arrays, how, arrived, &lanes, &flight);
    if (flight.events > 0)
    {
      arrive(arrays, &lanes, &flight.end);
    }
    else
    {
      begin(arrays, &lanes, vload3(0, arrived->way.start), vload3(0, arrived->way.velocity));
    }
  }
  else
#endif
  {
    set_out(arrays, how, photons + (ulong)i * PHOTON_FLOATS, numbers[i], &lanes, &flight);
  }
  follow(arrays, medium, how, &lanes, &flight);
#if BLOCKS
  if (flight.end.face == Elsewhere)
  {
    hand_on(arrays, &lanes, &flight, medium->gone + atomic_add(medium->gone_count, 1));
  }
#endif
  flight.end.power -= flight.owed;
  return flight.end;
}

// Follows photons how.first to how.first + how.count to their ends or into other blocks.
//   numbers   index of each photon, which selects its sequence of random numbers
//   counters  two counters: index of the next photon to fetch; then, with BLOCKS, the number of photons in `gone`
__kernel void scatter_photons(MarchInfo info, ScatterInfo how, const __global float* sigma,
  const __global float* coefficients, const __global uchar* nodes, const __global float2* optical,
  const __global float* phase, const __global float* photons, const __global ulong* numbers, __global ScatterEnd* ends,
  __global long* sums, volatile __global int* counters
#if BLOCKS
  ,
  __global ScatteredOnItsWay* gone
#endif
)
{
#if BLOCKS
  const scattering medium = { optical, phase, gone, counters + 1 };
#else
  const scattering medium = { optical, phase };
#endif
#if WORKERS > 0
  const march_arrays arrays = { &info, sigma, coefficients, nodes, sums + get_global_id(0) * how.copyStride };
  // A work-item fetches blocks of photons from a counter. The sums do not depend on which work-item fetches a block.
  for (int block = atomic_add(counters, BLOCK); block < how.count; block = atomic_add(counters, BLOCK))
  {
    for (int i = how.first + block; i < how.first + min(block + BLOCK, how.count); ++i)
    {
      ends[i] = end_of(&arrays, &medium, &how, photons, numbers, i);
    }
  }
#else
  const march_arrays arrays = { &info, sigma, coefficients, nodes, sums };
  const int i = how.first + get_global_id(0);
  ends[i] = end_of(&arrays, &medium, &how, photons, numbers, i);
#endif
}
