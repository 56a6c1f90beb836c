// Functions that carry the rays of one bundle through one plane. A bundle is a set of directions (members) that are
// mirror images of each other. This file is compiled once for each number of MEMBERS.
//
// A plane is crossed in up to three stages, one per segment. Between two stages all rays of the map move sideways by
// one voxel, or stay. A move costs only an offset of the address from which rays are loaded. The stages process rows
// one after another, each stage LAG rows behind the previous stage, so that intermediate rows stay in the cache; the
// last stage writes the map in place.

#define NAME_OF(a, b) TYNDALL_JOIN(a, b)
#define CROSS_VOXELS NAME_OF(cross_voxels_, MEMBERS)
#define CROSS_CHANNEL NAME_OF(cross_channel_, MEMBERS)
#define SEGMENT_ROWS NAME_OF(segment_rows_, MEMBERS)
#define MEMBER_WAYS NAME_OF(member_ways_, MEMBERS)
#define BEGIN_CHAIN NAME_OF(begin_chain_, MEMBERS)
#define CROSS_STAGE NAME_OF(cross_stage_, MEMBERS)
#define STAGE_ROW NAME_OF(stage_row_, MEMBERS)
#define COUNT_ESCAPED NAME_OF(count_escaped_, MEMBERS)
#define FILL_BORDER NAME_OF(fill_border_, MEMBERS)
#define CROSS_PLANES NAME_OF(cross_planes_, MEMBERS)
#define TAKE_ROW NAME_OF(take_row_, MEMBERS)
#define ENTER_ROW NAME_OF(enter_row_, MEMBERS)
#define COUNT_CURRENTS NAME_OF(count_currents_, MEMBERS)
#define MOVE_PART NAME_OF(move_part_, MEMBERS)
#define CROSS_MOMENTS NAME_OF(cross_moments_, MEMBERS)
#define PASS_EMPTY NAME_OF(pass_empty_, MEMBERS)
#define ENTER_ASIDE NAME_OF(enter_aside_, MEMBERS)
#define FILL_OUTSIDE NAME_OF(fill_outside_, MEMBERS)
#define FIND_SOURCES NAME_OF(find_sources_, MEMBERS)
#define GATHER_MOMENTS NAME_OF(gather_moments_, MEMBERS)
#define BLOCK (MEMBERS * CHANNELS * ROW)
#define FIRST(member, channel) (((member)*CHANNELS + (channel)) * ROW + PAD)

#if ANGULAR
#include "LightPropagation/Sweep/OnCpu/SweepMoments.cl"
// Calls FUNCTION with the bundle's number of frames as a constant. A frame is a set of up to four directions (members)
// that differ only in signs: one member makes one frame, eight members make two.
#define FOR_FRAMES(FUNCTION, y, slot)                       \
  if (MEMBERS == 8 || (MEMBERS > 1 && bundle->frames == 2)) \
  {                                                         \
    FUNCTION(state, y, slot, bundle, coefficients, 2);      \
  }                                                         \
  else                                                      \
  {                                                         \
    FUNCTION(state, y, slot, bundle, coefficients, 1);      \
  }
#else

// Rows of the plane's quantities that rays read or add to while they cross one segment (path through one voxel).
typedef struct
{
  const __global float *inverse, *source, *octants;
  __global float *path, *flux;
  // Power that enters the plane's voxels, W, [channel][CurrentFaces]; null: not computed
  __global float* entered;
  bool deposit, thin;
  float power, cosine; // power of a ray at radiance 1, length^2 sr, and cosine of its angle to the marching axis
} SEGMENT_ROWS;

// Components, normal to the marching axis, of the directions (members) of a bundle.
typedef struct
{
  float alongU[MEMBERS], alongV[MEMBERS]; // components along u and v, for the net flux
  // The two quadrants of the (u, v) plane to which each direction belongs (ways_aside())
  int2 aside[MEMBERS];
} MEMBER_WAYS;

// For one channel and a vector of voxels, carries the rays of all directions (members) of a bundle through one segment,
// i.e. through one voxel each.
// own_path  path integral that a unit source in a voxel causes within that voxel, times the cosine of the angle between
//           the rays and the marching axis
static inline __attribute__((always_inline)) void CROSS_CHANNEL(const SEGMENT_ROWS* rows, const MEMBER_WAYS* ways,
  int x, int c, const real_crossing* crossing, real own_path, const __global float** in, __global float* out)
{
  const real mean_length = crossing->meanLength, shine = mean_length * rows->power;
  const real source = load_real(x, rows->source + c * ROW), gain = shine * source;
  real sum = (real)0.0f, all_more = (real)0.0f, sum_u = (real)0.0f, sum_v = (real)0.0f;
#pragma unroll
  for (int m = 0; m < MEMBERS; ++m)
  {
    const real ray = load_real(x, in[m] + c * ROW);
    sum += ray;
#if NET_FLUX
    sum_u = multiply_add(ray, (real)ways->alongU[m], sum_u);
    sum_v = multiply_add(ray, (real)ways->alongV[m], sum_v);
#endif
#if OCTANT_SOURCE
    const __global float* octants = rows->octants + WaysAside * c * ROW;
    const real more =
      0.5f * (load_real(x, octants + ways->aside[m].x * ROW) + load_real(x, octants + ways->aside[m].y * ROW));
    all_more += more;
    const real shines = multiply_add(shine, more, gain);
#else
    const real shines = gain;
#endif
    const real kept = rows->thin ? ray + shines : multiply_add(ray, crossing->keep, shines);
    store_real(multiply_add(ray, crossing->change, kept), x, out + FIRST(m, c));
  }
  if (rows->entered)
  {
    __global float* here = rows->entered + CurrentFaces * c * ROW;
    store_real(load_real(x, here) + sum, x, here);
  }
  if (!rows->deposit)
  {
    return;
  }
#if OCTANT_SOURCE
  // The octant source adds power to the rays. The path integral is reduced accordingly, so that total power is
  // conserved
  sum -= all_more * load_real(x, rows->inverse) * rows->power;
#endif
  __global float* path = rows->path + c * ROW;
  store_real(multiply_add(mean_length, sum, load_real(x, path)), x, path);
#if NET_FLUX
  __global float* flux = rows->flux + 3 * c * ROW;
  store_real(multiply_add(mean_length, sum_u, load_real(x, flux)), x, flux);
  store_real(multiply_add(mean_length, sum_v, load_real(x, flux + ROW)), x, flux + ROW);
  const real sum_w = multiply_add(mean_length * rows->cosine, sum, load_real(x, flux + 2 * ROW));
  store_real(multiply_add(own_path, source, sum_w), x, flux + 2 * ROW);
#endif
}

// Carries all rays of a row through one segment each (numerics.md, Eqs. (23), (24); Gruson et al. 2012, Eq. 3, in
// conservative form). P is the power of a ray before the segment, P' its power behind it, p1 the mean transmitted
// length, q the source, and `power` the power of a ray at radiance 1:
//   path += p1 P,  P' = P - sigma p1 P + power q p1
// Light of the source also has a path integral within the voxel where it starts. It does not depend on P, and is added
// by add_own_light in Sweep.cl.
// @param entered  rows of the power that enters the plane's voxels, W, [channel][CurrentFaces]; null if not computed
static inline __attribute__((always_inline)) void CROSS_VOXELS(sweep_state* state, int y, bool deposit, bool thin,
  const __global float** in, __global float* out, float length, const __global BundleInfo* bundle,
  __global float* entered)
{
  const __global float* sigma_row = ROW_OF(state->planes, PlaneSigma, y);
  const __global float* inverse_row = ROW_OF(state->planes, PlaneInverse, y);
  __global float* taken_row = ROW_OF(state->planes, PlaneTaken, y);
  const SEGMENT_ROWS rows = { inverse_row, ROW_OF(state->planes, PlaneSource, y),
    ROW_OF(state->planes, PLANE_OCTANTS, y), ROW_OF(state->planes, PLANE_PATH, y), ROW_OF(state->planes, PLANE_FLUX, y),
    entered, deposit, thin, bundle->power, bundle->cosine };
  MEMBER_WAYS ways;
#pragma unroll
  for (int m = 0; m < MEMBERS; ++m)
  {
    ways.alongU[m] = bundle->move[m][0] * bundle->sineU + bundle->move[m][1] * bundle->sineV;
    ways.alongV[m] = bundle->move[m][2] * bundle->sineU + bundle->move[m][3] * bundle->sineV;
#if OCTANT_SOURCE
    ways.aside[m] = ways_aside(bundle, m);
#endif
  }
  for (int x = 0; x < state->width; x += REAL_WIDTH)
  {
    if (CHAINED)
    {
      ask_for_lines(state);
    }
    const real_crossing crossing = cross_length(state, x, sigma_row, inverse_row, length, thin);
    if (deposit && !thin)
    {
      const real taken = multiply_add(crossing.meanLength, (real)(rows.power * MEMBERS), load_real(x, taken_row));
      store_real(taken, x, taken_row);
    }
    // Path integral that a unit source in a voxel causes within that voxel, (length - mean_length) / sigma, times the
    // cosine. In the net flux, contributions of mirror-image directions cancel normal to the marching axis. Along the
    // axis they do not cancel, because a ray and its mirror image may cross the voxel in different segments.
    const real own_path =
      NET_FLUX ? own_path_of(x, &crossing, inverse_row, length) * (rows.power * MEMBERS * rows.cosine) : (real)0.0f;
#pragma unroll
    for (int c = 0; c < CHANNELS; ++c)
    {
      CROSS_CHANNEL(&rows, &ways, x, c, &crossing, own_path, in, out);
    }
  }
}

#endif

// Carries the rays of a row through one segment, i.e. through one voxel each: by CROSS_MOMENTS if there are angular
// moments, else by CROSS_VOXELS.
// @param slot  index of the row among the MomentRows rows for which sources along the bundle's rays are stored
// @param first  whether this segment is the row's first in the plane
static void STAGE_ROW(sweep_state* state, int y, int slot, bool first, bool deposit, const __global float** in,
  __global float* out, float length, const __global BundleInfo* bundle)
{
#if ANGULAR
#define CROSS_ROW(thin) CROSS_MOMENTS(state, y, slot, first, deposit, thin, in, out, length, bundle)
#else
  __global float* const entered =
    state->currents && first && deposit ? ROW_OF(state->planes, PLANE_CURRENTS + CurrentAxis, y) : 0;
#define CROSS_ROW(thin) CROSS_VOXELS(state, y, deposit, thin, in, out, length, bundle, entered)
#endif
  if (IS_THIN(state->words[y]))
  {
    CROSS_ROW(true);
  }
  else
  {
    CROSS_ROW(false);
  }
#undef CROSS_ROW
  for (int i = 0; PERIODIC_U && i < MEMBERS * CHANNELS; ++i)
  {
    out[i * ROW + PAD - 1] = out[i * ROW + PAD + state->sizeU - 1];
    out[i * ROW + PAD + state->sizeU] = out[i * ROW + PAD];
  }
}

// Adds the power of the rays that leave the box from row y in a move of (du, dv) voxels to the escaped power. `row`
// holds the rays; the fraction `part` of their power moves. Of rays that move along u and v at once, half cross along u
// first and half along v first. At the box's edge, half of their power therefore leaves through each of the two faces,
// and half of the light incident next to the edge leaves again without crossing a voxel.
// across_u, across_v  power of the rays that enter through the faces normal to u and v, W, without light given per
//                     cell: across_u is [member][channel], across_v a row of rays
static BY_ROW void COUNT_ESCAPED(sweep_state* state, const __global float* row, int y, int m, int du, int dv,
  float part, const __global BundleInfo* bundle, const __global float* across_u, const __global float* across_v)
{
  const bool through_v =
    !PERIODIC_V && ((dv < 0 && y == 0) || (dv > 0 && y == state->sizeV - 1)) && LEAVES_GRID(state, dv > 0 ? 3 : 2);
  const bool through_u = !PERIODIC_U && du != 0 && LEAVES_GRID(state, du > 0 ? 1 : 0);
  const int edge = du > 0 ? state->sizeU - 1 : 0;
  for (int c = 0; c < CHANNELS; ++c)
  {
    const __global float* rays = row + FIRST(m, c);
    const float turned = through_u && through_v ? 0.5f : 0.0f;
    if (through_u)
    {
      const int side = du > 0 ? 1 : 0;
      float beyond = across_v[FIRST(m, c)];
#if FACES
      if (state->faces->in)
      {
        beyond += bundle->power * light_of_cell(state, dv > 0 ? 2 : 3, edge, c);
      }
#endif
      add_exactly(
        &state->escaped[side][c], &state->rounding[side][c], part * (rays[edge] - turned * (rays[edge] - beyond)));
#if FACES
      if (state->faces->out)
      {
        const face_planes of = planes_of_ray(state, bundle->move[m][0] != 0 ? bundle->planesU : bundle->planesV);
        leave_through(state, side, y, c, of, part * (1.0f - turned) * rays[edge]);
        leave_through(state, side, dv > 0 ? 0 : state->sizeV - 1, c, of, part * turned * beyond);
      }
#endif
    }
    if (through_v)
    {
      const int side = dv > 0 ? 3 : 2;
      float beyond = across_u[m * CHANNELS + c];
#if FACES
      if (state->faces->in && turned > 0.0f)
      {
        beyond += bundle->power * light_of_cell(state, du > 0 ? 0 : 1, y, c);
      }
#endif
      const float all = sum_of_row(rays, state->sizeU);
      add_exactly(&state->escaped[side][c], &state->rounding[side][c], part * (all - turned * (rays[edge] - beyond)));
#if FACES
      if (state->faces->out)
      {
        const face_planes of = planes_of_ray(state, bundle->move[m][2] != 0 ? bundle->planesU : bundle->planesV);
        leave_all_through(state, side, c, of, rays, part);
        leave_through(state, side, edge, c, of, -part * turned * rays[edge]);
        leave_through(state, side, du > 0 ? 0 : state->sizeU - 1, c, of, part * turned * beyond);
      }
#endif
    }
  }
}

// Moves the fraction `part` of the power of each ray in a row (numerics.md, Eq. (22)). The result is a mean of the rays
// that arrive, `in`, weighted by `part`, and the rays that were there before, `own`. `in` then points to the result.
static BY_ROW void MOVE_PART(sweep_state* state, float part, const __global float* own, const __global float** in)
{
  for (int m = 0; m < MEMBERS; ++m)
  {
    for (int c = 0; c < CHANNELS; ++c)
    {
      const __global float* stay = own + FIRST(m, c);
      const __global float* come = in[m] + c * ROW;
      __global float* out = state->moving + FIRST(m, c);
      for (int x = 0; x < state->width; x += REAL_WIDTH)
      {
        const real stays = load_real(x, stay);
        store_real(multiply_add(load_real(x, come) - stays, (real)part, stays), x, out);
      }
    }
    in[m] = state->moving + FIRST(m, 0);
  }
}

// Fills the columns at both ends of every row in the ring buffers with the power of the rays that enter through the
// faces normal to u. Ring buffers hold the rows of rays between one stage (crossing of one voxel) and the next.
static BY_ROW void FILL_BORDER(sweep_state* state, const __global float* radiance)
{
  for (int i = 0; i < MEMBERS * CHANNELS; ++i)
  {
    for (int r = 0; r < state->rings * RingRows; ++r)
    {
      __global float* row = state->ring + r * RAYS_OF_ROW + i * ROW + PAD;
      row[-1] = radiance[i];
      row[state->width] = radiance[i];
    }
  }
}

#if FACES
// Fills the columns beside row y with the power of the rays that enter through the faces normal to u, including the
// light incident per cell.
static BY_ROW void ENTER_ASIDE(sweep_state* state, int y, const __global float* radiance,
  const __global BundleInfo* bundle, const __global CrossingInfo* crossing, int s, __global float* out)
{
  for (int m = 0; m < MEMBERS; ++m)
  {
    const int2 move = move_of(bundle, m, crossing, s);
    const int du = move.x, dv = move.y;
    for (int c = 0; c < CHANNELS && du != 0; ++c)
    {
      const float light = light_of_cells(state, du > 0 ? 0 : 1, y, dv, c);
      out[FIRST(m, c) + (du > 0 ? -1 : state->sizeU)] = radiance[m * CHANNELS + c] + bundle->power * light;
    }
  }
}

// Computes the row of rays that enter through the faces normal to v, including the light incident per cell.
static BY_ROW void FILL_OUTSIDE(sweep_state* state, const __global float* outside, const __global float* radiance,
  const __global BundleInfo* bundle, const __global CrossingInfo* crossing)
{
  const int size = state->sizeU;
  for (int s = 1; !PERIODIC_V && s < crossing->stages; ++s)
  {
    for (int m = 0; m < MEMBERS; ++m)
    {
      const int2 move = move_of(bundle, m, crossing, s);
      const int du = move.x, dv = move.y;
      const int side = dv > 0 ? 2 : 3;
      for (int c = 0; c < CHANNELS && dv != 0; ++c)
      {
        __global float* row = state->outside + FIRST(m, c);
        const __global float* alike = outside + FIRST(m, c);
        for (int x = 0; x < size; ++x)
        {
          const float light = PERIODIC_U
            ? 0.5f * (light_of_cell(state, side, x, c) + light_of_cell(state, side, (x + du + size) % size, c))
            : light_of_cells(state, side, x, du, c);
          row[x] = alike[x] + bundle->power * light;
        }
        if (PERIODIC_U)
        {
          row[-1] = row[size - 1];
          row[size] = row[0];
          continue;
        }
        // At an edge of the box, half of the light enters through each of the two faces.
        const int corner = dv > 0 ? 0 : state->sizeV - 1;
        const int column = du > 0 ? 0 : size - 1;
        const float half_light = du == 0
          ? 0.0f
          : 0.5f * (light_of_cell(state, side, column, c) + light_of_cell(state, du > 0 ? 0 : 1, corner, c));
        row[-1] = alike[-1] + bundle->power * half_light;
        row[size] = alike[size] + bundle->power * half_light;
      }
    }
  }
}
#endif

// Adds to the partial currents the power that enters the voxels of row y through each face (SweepPartialCurrents.cl).
// Rays of all directions that enter through the same face are summed first.
// @param own  rays of row y before the move
static BY_ROW void COUNT_CURRENTS(sweep_state* state, int y, int s, const __global float** in,
  const __global float* own, const __global BundleInfo* bundle, const __global CrossingInfo* crossing)
{
  const bool first = s == 0;
  const float part = crossing->part[s];
  const __global float* through[CurrentFaces][MEMBERS];
  int counts[CurrentFaces] = { 0, 0, 0, 0, 0 };
  for (int m = 0; m < MEMBERS; ++m)
  {
    const int2 move = move_of(bundle, m, crossing, s);
    const int du = first ? 0 : move.x, dv = first ? 0 : move.y;
    if (du != 0 && dv != 0)
    {
      add_through_edge(state, y, du, dv, in[m], own + FIRST(m, 0), part);
      continue;
    }
    const int face = first ? CurrentAxis
      : du != 0            ? (du > 0 ? CurrentLowU : CurrentHighU)
                           : (dv > 0 ? CurrentLowV : CurrentHighV);
    through[face][counts[face]++] = in[m];
  }
  for (int face = 0; face < CurrentFaces; ++face)
  {
    int done = 0;
    if (counts[face] == MEMBERS)
    {
      add_currents(state, y, face, through[face], MEMBERS, part);
      done = MEMBERS;
    }
    else if (MEMBERS > 1 && counts[face] == MEMBERS / 2)
    {
      add_currents(state, y, face, through[face], MEMBERS / 2, part);
      done = MEMBERS / 2;
    }
    for (; done < counts[face]; ++done)
    {
      add_current(state, y, face, through[face][done], part);
    }
  }
}

// Sets `in` to the row from which a stage reads the rays of each member (direction). Tallies the power of the rays that
// leave the box.
// @param own  rays of row y after the previous stage; null: this is the first stage, which reads rays from the map and
// does not move them
static void TAKE_ROW(sweep_state* state, int y, bool inside, int s, const __global float* map,
  const __global float* ring, const __global float* own, const __global float* beside, const __global float* outside,
  const __global float* radiance, const __global BundleInfo* bundle, const __global CrossingInfo* crossing,
  const __global float** in)
{
  const int height = state->sizeV;
#pragma unroll
  for (int m = 0; m < MEMBERS; ++m)
  {
    const int2 move = move_of(bundle, m, crossing, s);
    const int du = move.x, dv = move.y;
    const int from = y - dv;
    const __global float* row;
    if (!own)
    {
      row = map + (from < 0 ? (from % height + height) % height : from) * BLOCK;
    }
    else
    {
      row = ring + (from & (RingRows - 1)) * RAYS_OF_ROW;
      if (inside && (du != 0 || dv != 0))
      {
#if SIDES
        give_sides(state, bundle, m, own, y, du, dv);
#endif
        COUNT_ESCAPED(state, own, y, m, du, dv, crossing->part[s], bundle, radiance, outside);
      }
    }
    if (!PERIODIC_V && (from < 0 || from >= height))
    {
      row = beside;
    }
    in[m] = row + FIRST(m, 0) - du;
  }
}

// Fills the columns beside a row with the power of the rays that enter through the faces normal to u before stage s of
// a plane.
static void ENTER_ROW(sweep_state* state, int y, int s, const __global float* radiance,
  const __global BundleInfo* bundle, const __global CrossingInfo* crossing, __global float* out)
{
#if FACES
  if (state->faces->in && !PERIODIC_U)
  {
    ENTER_ASIDE(state, y, radiance, bundle, crossing, s, out);
  }
#elif SIDES
  for (int m = 0; m < MEMBERS; ++m)
  {
    const int du = move_of(bundle, m, crossing, s).x;
    if (du != 0)
    {
      take_across_u(state, bundle, m, y, du, out);
    }
  }
#endif
}

// Begins to carry a bundle through a chain of planes: lists the chain's stages (each moves rays sideways and takes them
// through one voxel), and fills the rows and columns of rays that enter sideways. Parameters as for CROSS_PLANES.
// Returns the row of rays that enter through the faces normal to v.
static const __global float* BEGIN_CHAIN(sweep_state* state, int planes, __global float* map,
  const __global float* outside, const __global float* radiance, const __global BundleInfo* bundle,
  const __global CrossingInfo* crossings, bool begins, chain_of_stages* chain)
{
  if (begins && state->border)
  {
    FILL_BORDER(state, radiance);
  }
  const int bundles = state->allBundles;
  chain->stages = chain->before = 0;
  for (int k = 1; k <= state->chained_before; ++k)
  {
    chain->before += crossings[-k * bundles].stages;
  }
  for (int k = 0; k < planes; ++k)
  {
    for (int s = 0; s < crossings[k * bundles].stages; ++s)
    {
      chain->of[chain->stages].plane = k;
      chain->of[chain->stages++].stage = s;
    }
  }
  go_to_plane(state, 0);
  // If v is periodic, the first rows are crossed again as ghost rows beyond the last row. Their rays are copied to the
  // ghost rows in advance, because the first rows are overwritten before the ghost rows are crossed.
  for (int i = 0; PERIODIC_V && begins && i < (chain->stages - 1) * BLOCK; ++i)
  {
    map[state->sizeV * BLOCK + i] = map[(i / BLOCK % state->sizeV) * BLOCK + i % BLOCK];
  }
#if FACES
  if (state->faces->in)
  {
    FILL_OUTSIDE(state, outside, radiance, bundle, crossings);
    return state->outside;
  }
#elif SIDES
  if (chain->stages > 1)
  {
    take_across_v(state, bundle, MEMBERS * CHANNELS);
  }
  return state->outside;
#endif
  return outside;
}

// Carries row y of a bundle's rays through stage g of a chain of planes. A stage moves rays sideways and takes them
// through one voxel. Parameters as for CROSS_PLANES.
// @param beside  row of rays that enter through the faces normal to v
static inline __attribute__((always_inline)) void CROSS_STAGE(sweep_state* state, const chain_of_stages* chain, int g,
  int y, __global float* map, const __global float* beside, const __global float* outside,
  const __global float* radiance, const __global BundleInfo* bundle, const __global CrossingInfo* crossings,
  const __global float* coefficients)
{
  const int height = state->sizeV, stages = chain->stages, s = chain->of[g].stage;
  const bool inside = y >= 0 && y < height;
  const int wrapped = inside ? y : (y % height + height) % height;
  const __global CrossingInfo* crossing = crossings + chain->of[g].plane * state->allBundles;
  // ring buffer with the rows of rays that the previous stage wrote
  const __global float* ring = state->ring + (g - 1) * (RingRows * RAYS_OF_ROW);
  const __global float* own = g > 0 ? ring + (y & (RingRows - 1)) * RAYS_OF_ROW : 0;
  const __global float* in[MEMBERS];
  TAKE_ROW(state, y, inside, s, map, ring, own, beside, outside, radiance, bundle, crossing, in);
  __global float* out =
    g == stages - 1 ? map + y * BLOCK : state->ring + (g * RingRows + (y & (RingRows - 1))) * RAYS_OF_ROW;
  // Adds the power that enters the voxels to the partial currents. At stage 0 without angular moments, CROSS_CHANNEL
  // does this instead.
  if (state->currents && inside && (ANGULAR || s > 0))
  {
    COUNT_CURRENTS(state, y, s, in, own, bundle, crossing);
  }
  if (crossing->part[s] < 1.0f)
  {
    MOVE_PART(state, crossing->part[s], own, in);
  }
  const int slot = y & (MomentRows - 1);
#if ANGULAR
  if (s == 0 && state->shines)
  {
    FOR_FRAMES(FIND_SOURCES, wrapped, slot)
  }
  else if (s == 0)
  {
    clear_rows(state->sources + slot * RAYS_OF_ROW + PAD, MEMBERS * CHANNELS, state->width);
  }
#endif
  STAGE_ROW(state, wrapped, slot, s == 0, inside, in, out, crossing->length[s], bundle);
  if (s < crossing->stages - 1)
  {
    ENTER_ROW(state, wrapped, s + 1, radiance, bundle, crossing, out);
  }
#if ANGULAR
  if (inside && s == stages - 1)
  {
    FOR_FRAMES(GATHER_MOMENTS, y, slot)
  }
#endif
}

// Carries the rays of a bundle through a chain of planes. All stages of all planes proceed row by row, so that rays are
// read from the map and written to it only once.
//
// @param planes   number of planes; 1 if CHAINED is 0
// @param map      power of the bundle's rays, W, [row][member][channel][float], with two rows more than the plane
// @param outside  row of rays that enter through the faces normal to v, W, [member][channel][float]
// @param radiance power of rays that enter through the faces normal to u, W, [member][channel]
// @param crossings  sideways moves and segment lengths in the first plane; those in the following planes are
//   state->allBundles apart
// @param coefficients  values of the bundle's angular functions
// @param first_row, end_row  range of rows that the first stage crosses in this call; the first of successive calls
// begins at FirstRow
static void CROSS_PLANES(sweep_state* state, int planes, __global float* map, const __global float* outside,
  const __global float* radiance, const __global BundleInfo* bundle, const __global CrossingInfo* crossings,
  const __global float* coefficients, int first_row, int end_row)
{
  chain_of_stages chain;
  const __global float* const beside =
    BEGIN_CHAIN(state, planes, map, outside, radiance, bundle, crossings, first_row <= FirstRow, &chain);
  const int height = state->sizeV, stages = chain.stages;
  const int beyond = PERIODIC_V ? stages - 1 : 0;
  const int end = min(height + beyond + LAG * (chain.before + stages - 1), end_row);
  for (int r = max(-beyond, first_row); r < end; ++r)
  {
    for (int g = 0; g < stages; ++g)
    {
      const int y = r - LAG * (chain.before + g);
      const int reach = PERIODIC_V ? stages - 1 - g : 0;
      if (y < -reach || y >= height + reach)
      {
        continue;
      }
      if (CHAINED)
      {
        go_to_plane(state, chain.of[g].plane);
        ask_ahead(state, map, r + RowsAhead < min(end_row, height) ? r + RowsAhead : -1, BLOCK, g, stages);
      }
      CROSS_STAGE(state, &chain, g, y, map, beside, outside, radiance, bundle, crossings, coefficients);
    }
  }
}

#undef ENTER_ROW
#undef TAKE_ROW
#undef ENTER_ASIDE
#undef FILL_OUTSIDE
#undef FOR_FRAMES
#undef CROSS_MOMENTS
#undef PASS_EMPTY
#undef FIND_SOURCES
#undef GATHER_MOMENTS
#undef FIRST
#undef BLOCK
#undef COUNT_CURRENTS
#undef MOVE_PART
#undef CROSS_PLANES
#undef FILL_BORDER
#undef COUNT_ESCAPED
#undef STAGE_ROW
#undef CROSS_VOXELS
#undef CROSS_CHANNEL
#undef SEGMENT_ROWS
#undef MEMBER_WAYS
#undef BEGIN_CHAIN
#undef CROSS_STAGE
#undef NAME_OF
