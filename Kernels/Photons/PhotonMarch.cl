// Photons through a medium (Pfeuti 2009, section 3.1.5, but for the accumulation). Read after Numerics.cl, FixedPoint.cl,
// SquaredIndex.cl and PhotonLegs.cl; the host gives what those ask for, and
//   CHANNELS         of light; MEDIUM_CHANNELS of sigma_t, 1 or CHANNELS
//   WORKERS          0: a work-item a packet, all add to the same sums; else so many take packets in turn, each with its sums
//   PATHS            1: nothing is summed, vertices are written
//
// A leg is followed from voxel wall to voxel wall (Amanatides and Woo). In a voxel whose extinction over a diagonal is s,
// with b = max(s, 1), the sums gain
//   a = power b (path integral of transmittance, in diagonals),   0 <= a <= power,
// which is the power lost where a voxel is thick and the path where it is thin: neither loses digits in fixed point.

#define PHOTON_FLOATS (6 + CHANNELS) // position, unit direction, power in units
#define RECORD (CHANNELS + 3 * DIRECTIONS)
#define TINY 1e-20f

#if REAL_WIDTH == 1
#define truth(condition) (-(condition))
#define anywhere(mask) (mask)
#define bits_of(mask) ((mask) & 1)
#define as_integer as_int
#define gather(values, i) ((values)[i])
#else
#define truth(condition) (condition)
#define anywhere(mask) any(mask)
#define as_integer TYNDALL_JOIN(as_int, REAL_WIDTH)
#if REAL_WIDTH == 4
#define bits_of(mask) bits_of_4(mask)
#define gather(values, i) ((float4)((values)[(i).s0], (values)[(i).s1], (values)[(i).s2], (values)[(i).s3]))
#elif REAL_WIDTH == 8
#define bits_of(mask) (bits_of_4((mask).lo) | bits_of_4((mask).hi) << 4)
#define gather(values, i) \
  ((float8)((values)[(i).s0], (values)[(i).s1], (values)[(i).s2], (values)[(i).s3], (values)[(i).s4], (values)[(i).s5], \
    (values)[(i).s6], (values)[(i).s7]))
#else
#define bits_of(mask) \
  (bits_of_4((mask).lo.lo) | bits_of_4((mask).lo.hi) << 4 | bits_of_4((mask).hi.lo) << 8 | bits_of_4((mask).hi.hi) << 12)
#define gather(values, i) \
  ((float16)((values)[(i).s0], (values)[(i).s1], (values)[(i).s2], (values)[(i).s3], (values)[(i).s4], (values)[(i).s5], \
    (values)[(i).s6], (values)[(i).s7], (values)[(i).s8], (values)[(i).s9], (values)[(i).sa], (values)[(i).sb], \
    (values)[(i).sc], (values)[(i).sd], (values)[(i).se], (values)[(i).sf]))
#endif
#endif
#define masked(mask, value) as_real((mask) & as_integer(value))

static int bits_of_4(int4 mask)
{
  const int4 bits = mask & (int4)(1, 2, 4, 8);
  return bits.x | bits.y | bits.z | bits.w;
}

// The part of the state that changes between two turns, in registers.
typedef struct
{
  integer at, alive, crossings;
  real wall_x, wall_y, wall_z, now;
  real sigma;
  real power[CHANNELS];
} photon_flight;

static void land(const photon_flight* flight, photon_lanes* lanes)
{
  *(integer*)lanes->at = flight->at;
  *(integer*)lanes->crossings = flight->crossings;
  *(real*)lanes->wall_x = flight->wall_x;
  *(real*)lanes->wall_y = flight->wall_y;
  *(real*)lanes->wall_z = flight->wall_z;
  *(real*)lanes->now = flight->now;
  for (int c = 0; c < CHANNELS; ++c)
  {
    *(real*)lanes->power[c] = flight->power[c];
  }
}

static void take_off(const march_arrays* arrays, const photon_lanes* lanes, photon_flight* flight)
{
  flight->at = INTEGERS(lanes->at);
  flight->alive = INTEGERS(lanes->alive);
  flight->wall_x = VECTOR(lanes->wall_x);
  flight->wall_y = VECTOR(lanes->wall_y);
  flight->wall_z = VECTOR(lanes->wall_z);
  flight->now = VECTOR(lanes->now);
  flight->sigma = gather(arrays->sigma, flight->at);
}

// What the voxels take of the photons over `length`, and gain.
static void attenuate(const march_arrays* arrays, photon_flight* flight, real length, real* gained)
{
  real left, lost, factor;
  integer thick;
  for (int c = 0; c < CHANNELS; ++c)
  {
    if (c < MEDIUM_CHANNELS)
    {
      const real s = fabs(c == 0 ? flight->sigma : gather(arrays->sigma + c * arrays->info->copy, flight->at));
      const real tau = s * length;
      lost = extinguished(tau, &left);
      const real mean = tau > (real)TINY ? lost / tau : (real)1.0f; // transmittance, over the length
      factor = mean * length * fmax(s, (real)1.0f);
      thick = truth(tau > (real)0.5f);
    }
    gained[c] = flight->power[c] * factor;
    flight->power[c] = thick ? flight->power[c] * left : flight->power[c] - flight->power[c] * lost;
  }
}

typedef long4 __attribute__((aligned(8))) long4_anywhere;

// Add what one photon left in one voxel, `a` of each channel.
static void credit(__global long* record, const float* a, float4 direction)
{
#if RECORD == 4 && !ATOMICS
  *(__global long4_anywhere*)record += convert_long4(a[0] * direction);
#else
  float total = 0.0f;
  for (int c = 0; c < CHANNELS; ++c)
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

static void credit_all(const march_arrays* arrays, const photon_lanes* lanes, integer at, const real* gained)
{
  LANES(int, places);
  float amounts[CHANNELS][REAL_WIDTH] __attribute__((aligned(64)));
  *(integer*)places = at;
  for (int c = 0; c < CHANNELS; ++c)
  {
    *(real*)amounts[c] = gained[c];
  }
  for (int k = 0; k < REAL_WIDTH; ++k)
  {
    float a[CHANNELS];
    for (int c = 0; c < CHANNELS; ++c)
    {
      a[c] = amounts[c][k];
    }
    credit(arrays->sums + (ulong)places[k] * RECORD, a, lanes->direction[k]);
  }
}

// Most of the time of a march across a large grid is waiting for memory. It is asked for a few voxels ahead of the photons, as
// far as they go straight on. Whoever compiles this may not know how: then it does without.
static void ask_ahead(const march_arrays* arrays, const photon_lanes* lanes, integer at)
{
#if REAL_WIDTH > 1 && defined(__has_builtin)
#if __has_builtin(__builtin_prefetch)
  LANES(int, places);
  *(integer*)places = at + INTEGERS(lanes->ahead);
  for (int k = 0; k < REAL_WIDTH; ++k)
  {
    const long there = places[k];
    __builtin_prefetch((const void*)(uintptr_t)(arrays->sums + there * RECORD), 1);
    __builtin_prefetch((const void*)(uintptr_t)(arrays->sigma + there), 0);
  }
#endif
#endif
}

// Through the walls that are reached at time `next`.
static void cross_walls(const march_arrays* arrays, const photon_lanes* lanes, photon_flight* flight, real next)
{
  const integer x = truth(flight->wall_x <= next), y = truth(flight->wall_y <= next), z = truth(flight->wall_z <= next);
  flight->at += (x & INTEGERS(lanes->stride_x)) + (y & INTEGERS(lanes->stride_y)) + (z & INTEGERS(lanes->stride_z));
  flight->wall_x += masked(x, VECTOR(lanes->across_x));
  flight->wall_y += masked(y, VECTOR(lanes->across_y));
  flight->wall_z += masked(z, VECTOR(lanes->across_z));
  flight->now = next;
  flight->sigma = gather(arrays->sigma, flight->at);
}

// The photons that have come to an end or to a turn.
static integer to_attend(const march_arrays* arrays, const photon_lanes* lanes, const photon_flight* flight)
{
  real most = flight->power[0];
  for (int c = 1; c < CHANNELS; ++c)
  {
    most = fmax(most, flight->power[c]);
  }
  integer special = truth(flight->sigma == (real)OUTSIDE) | truth(most < (real)arrays->info->darkness);
#if BENDS
  const real turn = VECTOR(lanes->turn);
  special |= truth(turn <= flight->now) |
    (truth(as_integer(flight->sigma) < 0) & truth(turn == (real)NEVER) & truth(flight->now >= VECTOR(lanes->settled)));
#endif
  return special & flight->alive;
}

// The face through which a photon came to voxel `at` of the padding.
static int face_left(const march_info* info, int at)
{
  const int3 voxel = voxel_of(info, at);
  const int3 size = size_of(info);
  return voxel.x < 0 ? 0 : voxel.x >= size.x ? 1 : voxel.y < 0 ? 2 : voxel.y >= size.y ? 3 : voxel.z < 0 ? 4 : 5;
}

static void end_photon(const photon_lanes* lanes, int k, int face, __global photon_end* end)
{
  end->face = face;
  end->crossings = lanes->crossings[k];
  end->steps = lanes->steps[k];
  for (int c = 0; c < CHANNELS; ++c)
  {
    end->power[c] = lanes->power[c][k];
  }
}

static void attend(const march_arrays* arrays, photon_lanes* lanes, int special, int first)
{
  for (; special; special &= special - 1)
  {
    const int k = 31 - clz(special & -special);
    const int at = lanes->at[k];
    const bool outside = arrays->sigma[at] == OUTSIDE;
    float most = 0.0f;
    for (int c = 0; c < CHANNELS; ++c)
    {
      most = fmax(most, lanes->power[c][k]);
    }
    if (outside || most < arrays->info->darkness)
    {
      end_photon(lanes, k, outside ? face_left(arrays->info, at) : DARK, arrays->ends + first + k);
      rest(lanes, k);
    }
#if BENDS
    else
    {
      take_turn(arrays, lanes, k);
    }
#endif
  }
}

static void load_packet(const march_arrays* arrays, const __global float* photons, int first, int end,
  photon_lanes* lanes, photon_flight* flight)
{
  for (int k = 0; k < REAL_WIDTH; ++k)
  {
    const bool there = first + k < end;
    const __global float* photon = photons + (ulong)(there ? first + k : first) * PHOTON_FLOATS;
    for (int c = 0; c < CHANNELS; ++c)
    {
      lanes->power[c][k] = there ? photon[6 + c] : 0.0f;
    }
    set_off(arrays, lanes, k, photon);
    if (!there)
    {
      rest(lanes, k);
    }
  }
  flight->crossings = 0;
  for (int c = 0; c < CHANNELS; ++c)
  {
    flight->power[c] = *(const real*)lanes->power[c];
  }
  take_off(arrays, lanes, flight);
}

#if PATHS
static void add_vertex(const march_arrays* arrays, const photon_lanes* lanes, float now, float left, int* count)
{
  if (arrays->vertices)
  {
    arrays->vertices[*count] = (float4)(lanes->start[0] + lanes->velocity[0] * now, left);
  }
  ++*count;
}
#endif

// Follow photons `first` to `first + REAL_WIDTH`, but before `end`, to their ends. Returns the vertices of the path, with PATHS.
static int march_packet(const march_arrays* arrays, const __global float* photons, int first, int end)
{
  photon_lanes lanes;
  photon_flight flight;
  load_packet(arrays, photons, first, end, &lanes, &flight);
  int vertices = 0;
#if PATHS
  const float whole = flight.power[0];
  add_vertex(arrays, &lanes, 0.0f, 1.0f, &vertices);
#endif
  for (int event = 0; event < arrays->info->eventLimit; ++event)
  {
    real next = fmin(fmin(flight.wall_x, flight.wall_y), flight.wall_z);
#if BENDS
    next = fmin(next, VECTOR(lanes.turn));
#endif
    real gained[CHANNELS];
    attenuate(arrays, &flight, fmax(next - flight.now, (real)0.0f) * VECTOR(lanes.pace), gained);
    flight.crossings -= flight.alive;
#if !PATHS
    ask_ahead(arrays, &lanes, flight.at);
    credit_all(arrays, &lanes, flight.at, gained);
#endif
    cross_walls(arrays, &lanes, &flight, next);
    const integer special = to_attend(arrays, &lanes, &flight);
    if (anywhere(special))
    {
      land(&flight, &lanes);
#if PATHS
      add_vertex(arrays, &lanes, next, flight.power[0] / whole, &vertices);
#endif
      attend(arrays, &lanes, bits_of(special), first);
      take_off(arrays, &lanes, &flight);
      if (!anywhere(flight.alive))
      {
        return vertices;
      }
    }
  }
  land(&flight, &lanes);
  for (int k = 0; k < REAL_WIDTH; ++k)
  {
    if (lanes.alive[k])
    {
      end_photon(&lanes, k, STILL_GOING, arrays->ends + first + k);
    }
  }
  return vertices;
}

#if PATHS
// The path of photon i, a work-item each. Its `counts[i]` vertices go to vertices + offsets[i]; with `counting` they are only
// counted.
__kernel void trace_paths(march_info info, const __global float* sigma, const __global float* coefficients,
  const __global uchar* nodes, const __global float* photons, __global photon_end* ends, int counting,
  const __global int* offsets, __global float4* vertices, __global int* counts)
{
  const int i = get_global_id(0);
  const march_arrays arrays = { &info, sigma, coefficients, nodes, 0, ends, counting ? 0 : vertices + offsets[i] };
  counts[i] = march_packet(&arrays, photons, i, i + 1);
}
#else
// Photons `first` to `first + count`.
__kernel void march_photons(march_info info, const __global float* sigma, const __global float* coefficients,
  const __global uchar* nodes, const __global float* photons, __global photon_end* ends, __global long* sums,
  ulong copyStride, int first, int count)
{
#if WORKERS > 0
  const int worker = get_global_id(0);
  const march_arrays arrays = { &info, sigma, coefficients, nodes, sums + worker * copyStride, ends, 0 };
  // Blocks of neighbours stay together: they share cache lines.
  for (int block = worker * BLOCK; block < count; block += WORKERS * BLOCK)
  {
    for (int i = block; i < min(block + BLOCK, count); i += REAL_WIDTH)
    {
      march_packet(&arrays, photons, first + i, first + count);
    }
  }
#else
  const march_arrays arrays = { &info, sigma, coefficients, nodes, sums, ends, 0 };
  march_packet(&arrays, photons, first + get_global_id(0) * REAL_WIDTH, first + count);
#endif
}
#endif
