// The paths of photons, leg by leg. Read after Numerics.cl and SquaredIndex.cl; the host gives
//   REAL_WIDTH  photons side by side: 1 on a GPU, 4 to 16 on a CPU
//   BENDS       1: the index varies; ORDER of the integrator then: 1, 2 or 4
//   LEVELS      1: there are octree levels
//   DIRECTIONS  1: directions are asked for
//
// A path obeys dr/dt = T, dT/dt = grad(n^2) / 2 with dt = ds / n, so that |T| = n. It becomes legs, straight lines of constant
// velocity:
//   order 2  from kick to kick of the leapfrog (drift, kick, drift): its polygon is the path itself
//   order 4  from step end to step end, each step of Yoshida's three leapfrogs
//   order 1  explicit Euler as in Pfeuti 2009, Eq. 2.10 and 2.11: dx/ds = v / n, dv/ds = grad n
// Where n does not vary within the reach of interpolation nothing is evaluated, and a leg is as long as that is so.
//
// Positions and velocities are in voxels, lengths in voxel diagonals.

#define NEVER 3e38f
#define AHEAD 4        // voxels along the axis of fastest change, by which memory is asked for early
#define OUTSIDE -3e38f // sigma of the padding round the grid

typedef struct
{
  index_grid grid;
  float spacing[3]; // over the voxel's diagonal
  float stepSize;   // voxels, of a step where the octree has single voxels
  float darkness;   // power below which nothing is left of a photon
  int eventLimit;   // walls and turns of a photon at most
  ulong copy;       // voxels of the padded grid
} march_info;

// What became of a photon.
typedef struct
{
  int face;      // it left through, -x, +x, ... +z; or one of the following
  int crossings; // stretches of it that were credited
  int steps;     // of the integrator
  float power[CHANNELS];
} photon_end;
#define STILL_GOING 6
#define DARK 7

// Everything that is read and written.
typedef struct
{
  const march_info* info;
  const __global float* sigma;        // [MEDIUM_CHANNELS][copy] extinction over a diagonal; its sign bit: the index varies
  const __global float* coefficients; // of n^2
  const __global uchar* nodes; // [copy] 0: the index does not vary, 1: it does, in a single voxel, 1 + k: in an octree's node of 2^k
  __global long* sums;                // [copy][RECORD] fixed point
  __global photon_end* ends;
  __global float4* vertices; // of a path: position in voxels, part of the power that is left; null: they are only counted
} march_arrays;

// The state of REAL_WIDTH photons, for all at once and one by one.
#define LANES(type, name) type name[REAL_WIDTH] __attribute__((aligned(64)))
#define VECTOR(array) (*(const real*)(array))
#define INTEGERS(array) (*(const integer*)(array))
typedef struct
{
  LANES(int, at); // voxel, in the padded grid
  LANES(int, alive); // -1 or 0
  LANES(int, stride_x); // of `at` to the next voxel
  LANES(int, stride_y);
  LANES(int, stride_z);
  LANES(int, ahead); // of `at` to where the photon will be a few voxels on
  LANES(float, wall_x); // time of the next wall
  LANES(float, wall_y);
  LANES(float, wall_z);
  LANES(float, across_x); // time from wall to wall
  LANES(float, across_y);
  LANES(float, across_z);
  LANES(float, now);     // time since the leg began
  LANES(float, turn);    // time when it ends; NEVER: when the index varies again
  LANES(float, settled); // time until which the last turn holds
  LANES(float, pace);    // diagonals per time
  LANES(float, step);    // time of the step under way
  LANES(int, steps);     // taken
  LANES(int, crossings); // stretches that were credited
  float power[CHANNELS][REAL_WIDTH] __attribute__((aligned(64)));
  float3 start[REAL_WIDTH];    // of the leg
  float3 velocity[REAL_WIDTH]; // along it
  float3 momentum[REAL_WIDTH]; // T; v of Euler; order 2 has it as the velocity
  float4 direction[REAL_WIDTH]; // 1, and the direction in space
} photon_lanes;

static int3 size_of(const march_info* info)
{
  return (int3)(info->grid.size[0], info->grid.size[1], info->grid.size[2]);
}

static float3 spacing_of(const march_info* info)
{
  return (float3)(info->spacing[0], info->spacing[1], info->spacing[2]);
}

static int3 voxel_of(const march_info* info, int at)
{
  const int row = info->grid.size[0] + 2, layer = row * (info->grid.size[1] + 2);
  const int z = at / layer;
  const int y = (at - z * layer) / row;
  return (int3)(at - z * layer - y * row - 1, y - 1, z - 1);
}

static int padded(const march_info* info, int3 voxel)
{
  const int row = info->grid.size[0] + 2;
  return ((voxel.z + 1) * (info->grid.size[1] + 2) + voxel.y + 1) * row + voxel.x + 1;
}

// Where a photon at p is, which on a wall is only known by `at`.
static int3 voxel_at(const march_info* info, float3 p, int at)
{
  const int3 guess = convert_int3_rtz(p);
  return padded(info, guess) == at ? guess : voxel_of(info, at);
}

// Times until a photon at p passes the walls of the box from `low` to `high`.
static float3 times_to_walls(float3 p, float3 low, float3 high, float3 u, float3 inverse)
{
  const float3 walls = u > 0.0f ? high : low;
  return u == 0.0f ? (float3)(NEVER) : fmax((walls - p) * inverse, 0.0f);
}

// A leg of photon k from `start` in the voxel where it is.
static void begin_leg(const march_info* info, photon_lanes* lanes, int k, float3 start, float3 u)
{
  const int row = info->grid.size[0] + 2, layer = row * (info->grid.size[1] + 2);
  const float3 low = convert_float3(voxel_at(info, start, lanes->at[k]));
  const float3 inverse = 1.0f / u;
  const float3 walls = times_to_walls(start, low, low + 1.0f, u, inverse);
  const float3 across = u == 0.0f ? (float3)(0.0f) : fabs(inverse);
  const int3 strides = u > 0.0f ? (int3)(1, row, layer) : -(int3)(1, row, layer);
  lanes->start[k] = start;
  lanes->velocity[k] = u;
  lanes->now[k] = 0.0f;
  lanes->wall_x[k] = walls.x;
  lanes->wall_y[k] = walls.y;
  lanes->wall_z[k] = walls.z;
  lanes->across_x[k] = across.x;
  lanes->across_y[k] = across.y;
  lanes->across_z[k] = across.z;
  lanes->stride_x[k] = strides.x;
  lanes->stride_y[k] = strides.y;
  lanes->stride_z[k] = strides.z;
  const float3 fast = fabs(u);
  lanes->ahead[k] = AHEAD * (fast.x > fast.y && fast.x > fast.z ? strides.x : fast.y > fast.z ? strides.y : strides.z);
  const float3 way = u * spacing_of(info);
  const float pace = sqrt(dot(way, way));
  lanes->pace[k] = pace;
#if DIRECTIONS
  lanes->direction[k] = (float4)(1.0f, way * (1.0f / pace));
#endif
}

#if BENDS
// The voxel of a place anywhere, one of the padding where it is beyond the grid.
static int3 voxel_of_place(const march_info* info, float3 p)
{
  return clamp(convert_int3(floor(p)), (int3)(-1), size_of(info));
}

// Time of a step from p in `voxel` where the index varies; 0 where it does not.
static float time_of_step(const march_arrays* arrays, int3 voxel, float3 p, float3 u)
{
  const march_info* info = arrays->info;
  const int node = arrays->nodes[padded(info, voxel)];
  if (node == 0)
  {
    return 0.0f;
  }
  const float shortest = info->stepSize / sqrt(dot(u, u));
#if LEVELS
  if (node > 1)
  {
    // To where it leaves the octree's node, and a little into the next one.
    const int3 low = (voxel >> (node - 1)) << (node - 1);
    const int3 high = min(low + (1 << (node - 1)), size_of(info));
    const float3 out = times_to_walls(p, convert_float3(low), convert_float3(high), u, 1.0f / u);
    return fmax(1.001f * fmin(fmin(out.x, out.y), out.z), shortest);
  }
#endif
  return shortest;
}

// dT/dt at p: half the gradient of n^2, which is by voxels, as a change of velocity in voxels.
static float3 pull(const march_arrays* arrays, float3 p)
{
  const float3 h = spacing_of(arrays->info);
  return 0.5f * squared_index(&arrays->info->grid, arrays->coefficients, p).xyz / (h * h);
}

#if ORDER == 1
// The step of explicit Euler from p; time is the length of path, in diagonals.
static float3 take_step(const march_arrays* arrays, photon_lanes* lanes, int k, int3 voxel, float3 p, float* step)
{
  const float3 h = spacing_of(arrays->info);
  const float4 squared = squared_index(&arrays->info->grid, arrays->coefficients, p);
  const float n = sqrt(squared.w);
  const float3 velocity = lanes->momentum[k] / n;
  *step = time_of_step(arrays, voxel, p, velocity);
  lanes->momentum[k] += *step * squared.xyz / (2.0f * n * h * h);
  return velocity;
}
#elif ORDER == 4
// Yoshida's step from p: the velocity with which it gets to its end on a straight line.
static float3 take_step(const march_arrays* arrays, photon_lanes* lanes, int k, int3 voxel, float3 p, float* step)
{
  const float outer = 1.35120719195965763f, inner = -1.70241438391931526f;
  float3 u = lanes->momentum[k];
  *step = time_of_step(arrays, voxel, p, u);
  if (*step == 0.0f)
  {
    return u;
  }
  float3 moved = 0.0f; // since p, which is too large to gain small steps without loss
  for (int part = 0; part < 3; ++part)
  {
    const float dt = *step * (part == 1 ? inner : outer);
    moved += 0.5f * dt * u;
    u += dt * pull(arrays, p + moved);
    moved += 0.5f * dt * u;
  }
  lanes->momentum[k] = u;
  return moved / *step;
}
#endif

// Photon k comes to where the index varies, or to the end of its leg.
static void take_turn(const march_arrays* arrays, photon_lanes* lanes, int k)
{
  const float now = lanes->now[k];
  const float3 p = lanes->start[k] + lanes->velocity[k] * now;
  float3 u = lanes->velocity[k];
#if ORDER == 2
  if (lanes->turn[k] > now)
  {
    lanes->step[k] = time_of_step(arrays, voxel_at(arrays->info, p, lanes->at[k]), p, u);
    lanes->turn[k] = lanes->step[k] > 0.0f ? now + 0.5f * lanes->step[k] : NEVER;
    lanes->settled[k] = now;
    return;
  }
  const float step = lanes->step[k];
  u += step * pull(arrays, p);
  const float3 end = p + 0.5f * step * u;
  const float next = time_of_step(arrays, voxel_of_place(arrays->info, end), end, u);
  lanes->step[k] = next;
  lanes->settled[k] = 0.5f * step;
  lanes->turn[k] = next > 0.0f ? 0.5f * (step + next) : NEVER;
#else
  float step;
  u = take_step(arrays, lanes, k, voxel_at(arrays->info, p, lanes->at[k]), p, &step);
  lanes->settled[k] = 0.0f;
  lanes->turn[k] = step > 0.0f ? step : NEVER;
#endif
  begin_leg(arrays->info, lanes, k, p, u);
  ++lanes->steps[k];
}
#endif

// A photon that has ended stands still in the padding, and credits nothing.
static void rest(photon_lanes* lanes, int k)
{
  lanes->alive[k] = 0;
  lanes->at[k] = 0;
  lanes->stride_x[k] = lanes->stride_y[k] = lanes->stride_z[k] = 0;
  lanes->wall_x[k] = lanes->wall_y[k] = lanes->wall_z[k] = 0.0f;
  lanes->across_x[k] = lanes->across_y[k] = lanes->across_z[k] = 0.0f;
  lanes->now[k] = lanes->pace[k] = 0.0f;
  lanes->ahead[k] = 0;
  lanes->turn[k] = NEVER;
}

// A photon, from its position (voxels) and unit direction, becomes photon k.
static void set_off(const march_arrays* arrays, photon_lanes* lanes, int k, const __global float* photon)
{
  const march_info* info = arrays->info;
  const float3 p = (float3)(photon[0], photon[1], photon[2]);
  float3 u = (float3)(photon[3], photon[4], photon[5]) / spacing_of(info);
  lanes->alive[k] = -1;
  lanes->at[k] = padded(info, clamp(convert_int3_rtn(p), (int3)(0), size_of(info) - 1));
  lanes->turn[k] = NEVER;
  lanes->settled[k] = 0.0f;
  lanes->step[k] = 0.0f;
  lanes->steps[k] = 0;
#if BENDS
  u *= sqrt(squared_index(&info->grid, arrays->coefficients, p).w);
  lanes->momentum[k] = u;
#endif
  begin_leg(info, lanes, k, p, u);
#if BENDS
  if (as_int(arrays->sigma[lanes->at[k]]) < 0)
  {
    take_turn(arrays, lanes, k);
  }
#endif
}
