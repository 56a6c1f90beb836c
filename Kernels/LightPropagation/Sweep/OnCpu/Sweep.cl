// Kernel that carries rays through a range of planes, on a CPU. A work-item carries the rays of its unit of work (one
// sense of marching, some or all bundles) and adds their deposits to the volume's arrays directly. Units of work in the
// same launch never share a plane, so there are no races and the order of summation is fixed. The host defines the
// options of SweepLayout.cl.

#include "LightPropagation/Sweep/OnCpu/SweepCrossing.cl"
#include "LightPropagation/Sweep/OnCpu/SweepLayout.cl"
#include "LightPropagation/Sweep/OnCpu/SweepPacking.cl"
#include "LightPropagation/Sweep/OnCpu/SweepPartialCurrents.cl"
#include "LightPropagation/Sweep/OnCpu/SweepSides.cl"

// Makes plane k of a chain (planes that a bundle crosses together) the current plane of the work-item.
static void go_to_plane(sweep_state* state, int k)
{
  const struct plane_place* place = state->places + k;
  state->planes = place->planes;
  state->words = place->words;
  state->escaped = place->escaped;
  state->rounding = place->rounding;
#if FACES
  go_to_faces(state, state->firstPlane + place->plane);
  state->facePlane = place->plane;
#endif
}

#if OCTANT_SOURCE
// Returns the quadrants of the (u, v) plane (WaysAside) that contain a direction (member) of a bundle. A direction with
// no component along u or v is on the border of two quadrants. For all other directions, both results are the same
// quadrant.
static inline int2 ways_aside(const __global BundleInfo* bundle, int m)
{
  const float2 signs = signs_of(bundle, m);
  const int way = (signs.x > 0.0f ? 1 : 0) + (signs.y > 0.0f ? 2 : 0);
  const bool exchanged = bundle->move[m][0] == 0;
  const int between = (fabs(exchanged ? bundle->sineV : bundle->sineU) < 1e-5f ? 1 : 0) +
    (fabs(exchanged ? bundle->sineU : bundle->sineV) < 1e-5f ? 2 : 0);
  return (int2)(way, way ^ between);
}
#endif

// Functions that carry the rays of one bundle, compiled once for each number of directions (members) in a bundle.
#define MEMBERS 1
#include "LightPropagation/Sweep/OnCpu/SweepBundle.cl"
#undef MEMBERS
#define MEMBERS 2
#include "LightPropagation/Sweep/OnCpu/SweepBundle.cl"
#undef MEMBERS
#define MEMBERS 4
#include "LightPropagation/Sweep/OnCpu/SweepBundle.cl"
#undef MEMBERS
#define MEMBERS 8
#include "LightPropagation/Sweep/OnCpu/SweepBundle.cl"
#undef MEMBERS

// Arrays of the volume that a work-item sweeps: the arguments of the kernel `sweep` with the same names. They point to
// the first of the channels that are swept together.
typedef struct
{
  const SweepInfo* info;
  const __global float *sigma, *source, *beams, *octants;
  __global float *path, *lost, *flux, *currents;
#if ANGULAR
  const __global float* moments; // angular moments of the source, from the second function on
  __global float* momentPath;    // angular moments of the path integral, from the second function on
#endif
  int backward;
} swept_volume;

// Arguments of the kernel `sweep` that describe rays: maps (power of each ray), incident power, bundles and sideways
// moves. They point to the values for the work-item's sense of marching.
typedef struct
{
  __global float* maps;
  const __global float *outside, *radiance, *coefficients;
  const __global BundleInfo* bundles;
  const __global CrossingInfo* crossings;
  const __global float* entering;
  __global leaving_float* leaving;
} swept_rays;

// Arrays in a work-item's scratch memory, besides the arrays to which sweep_state points.
typedef struct
{
  __global float* planes;
  __global int* words; // words of rows (IS_THIN, IS_FILLED), [plane][row]
#if ANGULAR
  __global float *momentSource, *momentPath; // packed moments of source and path, [plane][row]
#endif
} unit_scratch;

// Packed planes: planes [first, first + count) of the volume, copied to scratch memory in padded rows.
typedef struct
{
  __global float* planes;
  __global int* words; // words of rows (IS_THIN, IS_FILLED), [plane][row]
  int first, count;
  // Path integral that a unit source in a voxel causes within that voxel; one element per plane, in marching order
  const __global OwnLightInfo* own;
} packed_planes;

// Determines the flag words (IS_THIN, IS_FILLED) of rows [rows.x, rows.y) of a packed plane.
static BY_ROW void find_words(const SweepInfo* info, const __global float* plane, int2 rows, __global int* words)
{
  const PlaneInfo* layout = &info->planes;
  const int bits = segment_bits(layout->width), looks = ANGULAR && info->skips;
  for (int v = rows.x; v < rows.y; ++v)
  {
    const __global float* row = ROW_IN(layout, plane, 0, v);
    integer thick = (integer)0;
    int word = looks ? 0 : -2;
    for (int u = 0; u < layout->width; u += REAL_WIDTH)
    {
      const real sigma = load_real(u, row + PlaneSigma * ROW);
      thick |= sigma >= layout->thin;
      if (looks)
      {
        integer filled = sigma > (real)0.0f;
        for (int c = 0; info->shines && c < CHANNELS; ++c)
        {
          filled |= load_real(u, row + (PlaneSource + c) * ROW) != (real)0.0f;
        }
        word |= any_lane(filled) ? 2 << (u >> bits) : 0;
      }
    }
    words[v] = word | (any_lane(thick) ? 1 : 0);
  }
}

// Copies the rows rows.x to rows.y - 1 of several planes to scratch memory, from which the kernels that follow rays
// read them. Sets the path integrals, net flux and partial currents of these rows to 0.
static BY_ROW void begin_rows(const swept_volume* volume, const packed_planes* packed, int2 rows)
{
  const SweepInfo* info = volume->info;
  const PlaneInfo* layout = &info->planes;
  const int first = packed->first, count = packed->count;
  pack(layout, packed->planes + PlaneSigma * ROW, first, count, rows, volume->sigma);
  for (int c = 0; info->shines && c < CHANNELS; ++c)
  {
    pack(layout, packed->planes + (PlaneSource + c) * ROW, first, count, rows, volume->source + c * info->stride);
    for (int b = 0; b < BEAMS; ++b)
    {
      pack(layout, packed->planes + (PLANE_BEAMS + b * CHANNELS + c) * ROW, first, count, rows,
        volume->beams + (b * info->moments.channels + c) * info->stride);
    }
  }
  for (int j = 0; j < count; ++j)
  {
    __global float* plane = packed->planes + j * plane_floats(layout);
    find_words(info, plane, rows, packed->words + j * layout->sizeV);
    for (int v = rows.x; v < rows.y; ++v)
    {
      __global float* row = ROW_IN(layout, plane, 0, v);
      for (int at = 0; at < layout->width; at += REAL_WIDTH)
      {
        // Vacuum is treated as a very thin medium, to avoid 0 / 0.
        const real s = fmax(load_real(at, row + PlaneSigma * ROW), (real)layout->vacuum);
        store_real(s, at, row + PlaneSigma * ROW);
        store_real((real)1.0f / s, at, row + PlaneInverse * ROW);
        store_real((real)0.0f, at, row + PlaneTaken * ROW);
      }
      clear_rows(row + PLANE_PATH * ROW, PLANE_OCTANTS - PLANE_PATH, layout->width);
      clear_rows(row + PLANE_CURRENTS * ROW, layout->currents * CurrentFaces * CHANNELS, layout->width);
      if (!info->shines)
      {
        clear_rows(row + PlaneSource * ROW, PLANE_PATH - PlaneSource, layout->width);
        clear_rows(row + PLANE_OCTANTS * ROW, PLANE_CURRENTS - PLANE_OCTANTS, layout->width);
      }
    }
  }
#if OCTANT_SOURCE
  if (info->shines)
  {
    pack_octants(info, packed->planes, first, count, rows, volume->octants, volume->backward);
  }
#endif
}

#if !ANGULAR
// Adds to a row the path integral of emitted and scattered light within the voxel where it starts (numerics.md, Eq.
// (26)): source times (length - taken) / sigma_t. Here `length` is the sum over rays of power times path length, and
// `taken` is the sum over rays of power times mean transmitted length. In optically thin voxels, where the subtraction
// would lose all digits and `taken` is not stored, a polynomial is used instead.
static BY_ROW void add_own_light(const PlaneInfo* layout, __global float* row, const __global OwnLightInfo* light)
{
  for (int at = 0; at < layout->width; at += REAL_WIDTH)
  {
    const real sigma = load_real(at, row + PlaneSigma * ROW);
    const real taken = load_real(at, row + PlaneTaken * ROW);
    const real closed = ((real)light->length - taken) * load_real(at, row + PlaneInverse * ROW);
    const real thinness = sigma / layout->thin;
    real polynomial = (real)light->terms[MeanLengthTerms - 1];
#pragma unroll
    for (int i = MeanLengthTerms - 2; i >= 0; --i)
    {
      polynomial = multiply_add(polynomial, thinness, (real)light->terms[i]);
    }
    const real own = select(closed, polynomial, sigma < (real)layout->thin);
    for (int c = 0; c < CHANNELS; ++c)
    {
      __global float* sum = row + (PLANE_PATH + c) * ROW;
      store_real(multiply_add(own, load_real(at, row + (PlaneSource + c) * ROW), load_real(at, sum)), at, sum);
    }
  }
}
#endif

// Adds the path integrals, net flux and partial currents of rows [rows.x, rows.y) of packed planes to the arrays of the
// volume.
static BY_ROW void end_rows(const swept_volume* volume, const packed_planes* packed, int2 rows)
{
  const SweepInfo* info = volume->info;
  const PlaneInfo* layout = &info->planes;
  const ulong stride = info->stride;
  const int axis = info->axis, backward = volume->backward, first = packed->first, count = packed->count;
#if !ANGULAR
  for (int j = 0; info->shines && j < count; ++j)
  {
    for (int v = rows.x; v < rows.y; ++v)
    {
      add_own_light(layout, ROW_IN(layout, packed->planes + j * plane_floats(layout), 0, v),
        packed->own + (backward ? count - 1 - j : j));
    }
  }
#endif
  for (int c = 0; c < CHANNELS; ++c)
  {
    unpack(layout, packed->planes + (PLANE_PATH + c) * ROW, first, count, rows, 1.0f, volume->path + c * stride,
      info->roundAxis ? volume->lost + c * stride : 0);
#if NET_FLUX
    const __global float* fluxes = packed->planes + (PLANE_FLUX + 3 * c) * ROW;
    __global float* flux = volume->flux + 3 * c * stride;
    unpack(layout, fluxes, first, count, rows, 1.0f, flux + (axis == 0 ? 1 : 0) * stride, 0);
    unpack(layout, fluxes + ROW, first, count, rows, 1.0f, flux + (axis == 2 ? 1 : 2) * stride, 0);
    unpack(layout, fluxes + 2 * ROW, first, count, rows, backward ? -1.0f : 1.0f, flux + axis * stride, 0);
#endif
    if (!layout->currents)
    {
      continue;
    }
    const int aside[2] = { axis == 0 ? 1 : 0, axis == 2 ? 1 : 2 };
    const __global float* entered = packed->planes + (PLANE_CURRENTS + CurrentFaces * c) * ROW;
    __global float* faces = volume->currents + 6 * c * stride;
    unpack(layout, entered, first, count, rows, 1.0f, faces + (2 * axis + backward) * stride, 0);
    for (int side = 0; side < 4; ++side)
    {
      unpack(layout, entered + (CurrentLowU + side) * ROW, first, count, rows, 1.0f,
        faces + (2 * aside[side / 2] + side % 2) * stride, 0);
    }
  }
}

// Carries the rays of bundle `b` row by row through a chain, i.e. planes that it crosses together.
// @param crossings  sideways moves and segment lengths of all bundles, from the chain's first plane on
static void cross_planes(sweep_state* state, int planes, const swept_rays* rays, int b,
  const __global CrossingInfo* crossings, int first_row, int end_row)
{
  const __global BundleInfo* bundle = rays->bundles + b;
  __global float* map = rays->maps + bundle->map;
  const __global float* rows = rays->outside + bundle->outside;
  const __global float* values = rays->radiance + bundle->border;
  const __global float* coefficients = rays->coefficients + bundle->coefficients;
#define CROSS(n) \
  cross_planes_##n(state, planes, map, rows, values, bundle, crossings + b, coefficients, first_row, end_row)
  switch (bundle->members)
  {
    case 1: CROSS(1); break;
    case 2: CROSS(2); break;
    case 4: CROSS(4); break;
    case 8: CROSS(8); break;
  }
#undef CROSS
}

// Carries the rays of `count` bundles, from bundle `first` on, row by row through a chain, i.e. planes that each bundle
// crosses together. If the planes hold moments, or are large, all bundles cross one tile (a block of rows) before any
// bundle crosses the next tile, so that the tile stays in the cache.
// @param planes  number of planes; 1 if CHAINED is 0
// @param packed  the planes; if KEPT_ROWS is not 0, this function packs their rows tile by tile, and `count` must be
//   the number of all bundles
static void cross_bundles(sweep_state* state, const swept_volume* volume, const packed_planes* packed, int planes,
  const swept_rays* rays, int first, int count, const __global CrossingInfo* crossings)
{
  __global float* const kept = state->ring;
#if ANGULAR
  const int tile = RowsTogether, floats_of_bundle = BUNDLE_FLOATS(CHANNELS, ROW);
#else
  const int tile = state->tile, floats_of_bundle = state->rings * RingRows * RAYS_OF_ROW;
#endif
  if (tile == 0)
  {
    for (int b = first; b < first + count; ++b)
    {
      cross_planes(state, planes, rays, b, crossings, FirstRow, INT_MAX);
    }
    return;
  }
  const int behind = ROWS_BEHIND(state->chained_before + planes);
  int ended = 0; // number of rows that all bundles have crossed and whose sums were added to the volume
  for (int row = FirstRow; row < state->sizeV + behind; row += tile)
  {
    if (KEPT_ROWS)
    {
      begin_rows(volume, packed, (int2)(max(row, 0), min(row + tile, state->sizeV)));
    }
    for (int b = 0; b < count; ++b)
    {
      state->ring = kept + b * floats_of_bundle;
#if ANGULAR
      state->sources = state->ring + state->rings * RingRows * RAYS_OF_ROW;
      state->paths = state->sources + MomentRows * RAYS_OF_ROW;
      state->ownPath = state->paths + MomentRows * RAYS_OF_ROW;
#endif
      cross_planes(state, planes, rays, first + b, crossings, row, row + tile);
    }
    if (KEPT_ROWS)
    {
      const int end = clamp(row + tile - behind, ended, state->sizeV);
      end_rows(volume, packed, (int2)(ended, end));
      ended = end;
    }
  }
  state->ring = kept;
}

// For streamed volumes: moves the pointers of the volume to a slot, one of the device buffers that each hold a slice of
// the volume (SliceStream.h). The steps between voxels in PlaneInfo are already those of a slot.
// @param slot  x: number of the slot; y: index in the box of the slot's first plane
static void go_to_slot(SweepInfo* info, int2 slot, swept_volume* volume)
{
  info->planes.firstP = -slot.y;
  const ulong voxels = slot.x * info->stride * CHANNELS;
  volume->sigma += slot.x * info->stride;
  volume->source += slot.x * info->sourceSlot;
  volume->path += slot.x * info->pathSlot;
  volume->lost += slot.x * info->pathSlot;
  volume->flux += 3 * voxels;
  volume->currents += 6 * voxels;
  volume->octants += 8 * voxels;
}

// Moves the pointers of a volume to the first channel that is swept.
static void go_to_channel(swept_volume* volume)
{
  const SweepInfo* info = volume->info;
  volume->beams = volume->source;
#if ANGULAR
  const ulong higher = info->moments.second + info->firstChannel * MOMENTS_OF_CHANNEL(info);
  volume->moments = volume->source + higher;
  volume->momentPath = volume->path + higher;
  volume->beams += info->moments.beams + info->first;
#endif
  volume->sigma += info->sigmaFirst;
  volume->source += info->first;
  volume->path += info->first;
  volume->lost += info->first;
  volume->flux += 3 * info->first;
  volume->currents += 6 * info->first;
  volume->octants += 8 * info->first;
}

// Sets the members of sweep_state that are the same for all planes, except the pointers.
static void begin_state(sweep_state* state, const SweepInfo* info)
{
  const PlaneInfo* layout = &info->planes;
  state->sizeU = layout->sizeU;
  state->sizeV = layout->sizeV;
  state->quantities = layout->quantities;
  state->currents = layout->currents;
  state->width = layout->width;
  state->segmentBits = segment_bits(layout->width);
  state->shines = info->shines;
  state->border = info->border;
  state->roundAxis = info->roundAxis;
  state->periodicU = info->periodicU;
  state->periodicV = info->periodicV;
  state->allBundles = info->bundles;
  state->tile = CHAINED ? layout->tile : 0;
  for (int i = 0; i < MeanLengthTerms; ++i)
  {
    state->meanLength[i] = layout->meanLength[i];
  }
#if FACES
  state->faces = &info->faces;
  state->firstPlane = layout->firstP;
  state->facePlanes = layout->sizeP;
#endif
#if SIDES
  state->outerSides = info->outerSides;
#endif
#if ANGULAR
  state->functions = info->moments.functions;
  for (int p = 0; p < 4; ++p)
  {
    state->parityEnds[p] = info->parityEnds[p];
  }
#endif
}

// Number of bundles that cross a tile (block of rows) one after another before the first of them crosses the next tile.
// Further bundles cross the planes afterwards.
static int bundles_together(const sweep_state* state, int bundles)
{
  return ANGULAR || state->tile > 0 ? min(bundles, (int)BundlesTogether) : bundles;
}

// Divides a work-item's scratch memory into arrays, and sets the power of the rays in it to 0.
// @param together  number of bundles that cross planes together (bundles_together())
static unit_scratch lay_scratch(sweep_state* state, const SweepInfo* info, __global float* scratch, int together)
{
  const PlaneInfo* layout = &info->planes;
  state->ring = scratch;
  state->rings = RINGS_OF(layout->chained);
  const int rings = ANGULAR ? together * BUNDLE_FLOATS(CHANNELS, ROW)
                            : (state->tile > 0 ? together : 1) * state->rings * RingRows * RAYS_OF_ROW;
  state->moving = state->ring + rings;
  clear_rows(state->ring, (rings + RAYS_OF_ROW) / ROW, layout->width + 2 * PAD);
  unit_scratch parts;
  parts.planes = state->moving + RAYS_OF_ROW + PAD; // begins after the padding of the last row
#if FACES || SIDES
  state->outside = parts.planes;
#endif
  parts.planes += SIDES || info->faces.in ? RAYS_OF_ROW + PAD : 0;
  parts.words = (__global int*)(parts.planes + layout->together * plane_floats(layout));
#if ANGULAR
  parts.momentSource = (__global float*)parts.words + layout->together * layout->sizeV + REAL_WIDTH;
  parts.momentPath = parts.momentSource + layout->together * (layout->sizeV * info->packedMoments);
#endif
  return parts;
}

// Packs planes (copies them to scratch memory) and their moments. If KEPT_ROWS is not 0, cross_bundles() packs the rows
// instead, tile by tile.
static void begin_planes(const swept_volume* volume, const packed_planes* packed, const unit_scratch* scratch)
{
  const SweepInfo* info = volume->info;
  if (!KEPT_ROWS)
  {
    begin_rows(volume, packed, (int2)(0, info->planes.sizeV));
  }
#if ANGULAR
  if (!info->momentsInPlace)
  {
    if (info->shines)
    {
      pack_moments(info, packed->words, scratch->momentSource, packed->first, packed->count, volume->moments);
    }
    clear_moments(info, packed->words, packed->count, scratch->momentPath);
  }
#endif
}

// Adds the path integrals, net flux, partial currents and moments of the packed planes to the arrays of the volume. If
// KEPT_ROWS is not 0, cross_bundles() has already done this.
static void end_planes(const swept_volume* volume, const packed_planes* packed, const unit_scratch* scratch)
{
  if (!KEPT_ROWS)
  {
    end_rows(volume, packed, (int2)(0, volume->info->planes.sizeV));
  }
#if ANGULAR
  if (!volume->info->momentsInPlace)
  {
    unpack_moments(volume->info, packed->words, scratch->momentPath, packed->first, packed->count, volume->momentPath);
  }
#endif
}

#if ANGULAR
// Sets the pointers in `state` to the angular moments of a plane of the box: in the volume's arrays, or packed in
// scratch memory.
static void go_to_moments(
  sweep_state* state, const swept_volume* volume, const unit_scratch* scratch, int plane, int first_packed)
{
  const SweepInfo* info = volume->info;
  const PlaneInfo* layout = &info->planes;
  const ulong channel = MOMENTS_OF_CHANNEL(info);
  if (info->momentsInPlace)
  {
    const ulong line = info->moments.channels * channel;
    // Number of lines (rows of voxels along x) from one row of the plane to the next
    const ulong across = info->axis == 2 ? 1 : info->sizeY;
    const ulong along = info->axis == 2 ? info->sizeY : 1;
    const ulong here = line * ((layout->firstP + plane) * along + layout->firstV * across);
    state->momentSource = volume->moments + here;
    state->momentPath = volume->momentPath + here;
    state->momentStep = line * across;
    state->momentChannel = channel;
    return;
  }
  const int moment_plane = layout->sizeV * info->packedMoments;
  state->momentSource = scratch->momentSource + (plane - first_packed) * moment_plane;
  state->momentPath = scratch->momentPath + (plane - first_packed) * moment_plane;
  state->momentStep = info->packedMoments;
  state->momentChannel = info->packedMoments / CHANNELS;
}
#endif

// Lists packed planes in the order in which rays cross them, and clears their tallies of escaped power.
// @param escaped, rounding  escaped power, W, and its rounding errors, [plane][side][channel]
static void place_planes(struct plane_place* places, const swept_volume* volume, const packed_planes* packed,
  float (*escaped)[4][CHANNELS], float (*rounding)[4][CHANNELS])
{
  const PlaneInfo* layout = &volume->info->planes;
  for (int i = 0; i < packed->count; ++i)
  {
    const int j = volume->backward ? packed->count - 1 - i : i;
    places[i].planes = packed->planes + j * plane_floats(layout);
    places[i].words = packed->words + j * layout->sizeV;
    places[i].escaped = escaped[i];
    places[i].rounding = rounding[i];
    places[i].plane = packed->first + j;
    for (int side = 0; side < 4; ++side)
    {
      for (int c = 0; c < CHANNELS; ++c)
      {
        escaped[i][side][c] = 0.0f;
        rounding[i][side][c] = 0.0f;
      }
    }
  }
}

// Planes i to i + count - 1 of `packed`, counted in the order in which rays cross them.
static packed_planes part_of(const packed_planes* packed, const swept_volume* volume, int i, int count)
{
  const PlaneInfo* layout = &volume->info->planes;
  const int j = volume->backward ? packed->count - i - count : i;
  const packed_planes part = { packed->planes + j * plane_floats(layout), packed->words + j * layout->sizeV,
    packed->first + j, count, packed->own + i };
  return part;
}

// Number of planes to pack (copy to scratch memory) together, from plane `begin` on. They end before plane `end` and
// before the end of the lap (passage through all planes of a periodic axis) that began at plane `lap`. Planes are
// counted from where rays start.
static int planes_to_pack(const SweepInfo* info, int begin, int end, int lap, int backward)
{
  const PlaneInfo* layout = &info->planes;
  const int count = min(min(layout->together, end - begin), lap + layout->sizeP - begin);
#if ANGULAR
  return info->momentsInPlace ? count : min(count, of_one_group(layout, begin - lap, backward));
#else
  return count;
#endif
}

// Carries a work-item's rays through packed planes, chain by chain; a chain is one plane or two that a bundle crosses
// together.
// @param places  the packed planes in marching order
// @param begin  index of the first of these planes, counted from where rays start
static void cross_chains(sweep_state* state, const swept_volume* volume, const swept_rays* rays, const UnitInfo* unit,
  const packed_planes* packed, const unit_scratch* scratch, const struct plane_place* places, int begin)
{
  const SweepInfo* info = volume->info;
  const int end_bundle = unit->firstBundle + unit->bundles, together = bundles_together(state, unit->bundles);
  for (int i = 0, chained; i < packed->count; i += chained)
  {
    const int k = begin + i;
    // Chains (planes that a bundle crosses together) begin at the same planes however the planes are divided among
    // launches, so that the order of summation is always the same.
    state->chained_before = CHAINED ? (unit->planesBefore + k) % info->planes.chained : 0;
    chained = CHAINED ? min(info->planes.chained - state->chained_before, packed->count - i) : 1;
    state->places = places + i;
#if SIDES
    const ulong sides_of_plane = k * info->eachWay.radiance * SIDE_FLOATS(state);
    state->sidesIn = rays->entering + sides_of_plane;
    state->sidesOut = rays->leaving + sides_of_plane;
#endif
#if ANGULAR
    go_to_moments(state, volume, scratch, places[i].plane, packed->first);
#endif
    const packed_planes chain = part_of(packed, volume, i, chained);
    const __global CrossingInfo* of_plane = rays->crossings + (unit->planesBefore + k) * info->bundles;
    for (int b = unit->firstBundle; b < end_bundle; b += together)
    {
      cross_bundles(state, volume, &chain, chained, rays, b, min(together, end_bundle - b), of_plane);
    }
  }
}

// Carries the rays of the units of work of a launch through their planes. One work-item per unit of work (UnitInfo: one
// sense of marching, some or all bundles).
// sigma     extinction, 1/length, [voxel]
// source    W / (length^3 sr), with its angular moments and beams (MomentPlacesShared.h)
// octants   additional source per octant of directions, W / (length^3 sr), [channel][octant][voxel]
// path      path integrals, W length, with their angular moments; the kernel adds to them
// lost      rounding errors of path in this sweep (compensated summation), if rays wrap around the marching axis
// flux      net flux, W length, [channel][x, y, z][voxel]; the kernel adds to it
// currents  power that enters the voxel through each face, W, [channel][-x, +x, -y, +y, -z, +z][voxel]; the kernel adds
//           to it
// maps      power of each ray, W, for both senses of marching (or for the only one)
// border    power of incident rays, W: first rows of rays that enter through the faces normal to v, for both senses of
//           marching; then values for the faces normal to u, for both senses
// coefficients  values of the angular functions in the directions of the bundles (BundleInfo::coefficients), for both
//               senses
// crossings  sideways moves and segment lengths, [plane of the ray pattern][bundle]
// own       path integrals that a unit source in a voxel causes within that voxel, [unit][plane,
//           counted from where rays start]
// schedule  first plane and end, counted from where rays start, [launch][unit]; planes beyond the last plane wrap
//           around; if the volume is streamed, [launch][planes, slots][unit], with the argument `slot` of go_to_slot()
//           for each unit
// tally     escaped power, W, [plane, counted from where rays start][unit][-u, +u, -v, +v][channel]
// entering  if SIDES: power of the rays that enter through the sides (SweepSides.cl); else, if FaceInfo::in, incident
//           radiance per cell of the box's faces (SweepRequest::faceIn)
// leaving   if SIDES: power of the rays that leave; else, if FaceInfo::out, escaped power per cell,
//           [unit][channel][cell] if FaceInfo::spread, else [channel][cell]
// function_places  index of each angular function within a group of moments, sorted by parity
//                  (sweep_state::functionPlaces)
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void sweep(SweepInfo info, const __global float* sigma,
  const __global float* source, const __global float* octants, __global float* path, __global float* lost,
  __global float* flux, __global float* currents, __global float* maps, const __global float* border,
  __global float* scratch, const __global UnitInfo* units, const __global BundleInfo* bundles,
  const __global float* coefficients, const __global CrossingInfo* crossings, const __global OwnLightInfo* own,
  const __global int2* schedule, __global float* tally, const __global float* entering, __global leaving_float* leaving,
  const __global int* function_places)
{
  const int u = get_global_id(0);
  const int unit_count = get_global_size(0);
  const UnitInfo unit = units[u];
  const int way = unit.backward;
  const int2 range = schedule[(info.streamed ? 2 : 1) * info.launch * unit_count + u];
  const EachWay* each = &info.eachWay;
  const swept_rays rays = { maps + way * each->maps, border + way * each->outside,
    border + 2 * each->outside + way * each->radiance, coefficients + way * each->coefficients, bundles, crossings,
    entering, leaving };
  sweep_state state;
  begin_state(&state, &info);
#if FACES
  state.faceOut = leaving + u * info.faces.unit;
  state.faceIn = entering;
#endif
#if ANGULAR
  state.functionPlaces = function_places;
#endif
  swept_volume volume = { &info, sigma, source, 0, octants, path, lost, flux, currents };
  volume.backward = way;
  if (info.streamed)
  {
    go_to_slot(&info, schedule[(2 * info.launch + 1) * unit_count + u], &volume);
  }
  go_to_channel(&volume);
  const unit_scratch parts = lay_scratch(&state, &info, scratch + unit.scratch, bundles_together(&state, unit.bundles));
  for (int b = unit.firstBundle; info.empty && range.x == 0 && range.y > 0 && b < unit.firstBundle + unit.bundles; ++b)
  {
    clear_rows(
      rays.maps + bundles[b].map, bundles[b].members * CHANNELS * (info.planes.sizeV + 2), info.planes.width + 2 * PAD);
  }
  float escaped[PLANES_TOGETHER][4][CHANNELS], rounding[PLANES_TOGETHER][4][CHANNELS];
  struct plane_place places[PLANES_TOGETHER];
  for (int begin = range.x, count; begin < range.y; begin += count)
  {
    // Index of the plane, counted from where rays start, at which the current lap around a periodic axis began.
    const int lap = begin / info.planes.sizeP * info.planes.sizeP;
    count = planes_to_pack(&info, begin, range.y, lap, way);
    const packed_planes packed = { parts.planes, parts.words,
      way ? info.planes.sizeP - (begin - lap) - count : begin - lap, count, own + u * info.patternPlanes + begin };
    begin_planes(&volume, &packed, &parts);
    place_planes(places, &volume, &packed, escaped, rounding);
    cross_chains(&state, &volume, &rays, &unit, &packed, &parts, places, begin);
    for (int i = 0; i < count * 4 * CHANNELS; ++i)
    {
      const int k = i / (4 * CHANNELS), slot = i % (4 * CHANNELS);
      tally[((begin + k) * unit_count + u) * 4 * CHANNELS + slot] = escaped[k][slot / CHANNELS][slot % CHANNELS];
    }
    end_planes(&volume, &packed, &parts);
  }
}
