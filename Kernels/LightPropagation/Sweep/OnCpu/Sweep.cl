// Carries rays through a range of planes, on a CPU. A work-item carries all rays of its unit (one way along the axis,
// some or all bundles) and deposits into the volume directly. Units of one launch never share a plane, so there are no
// races and the order of summation is fixed. The host defines what SweepLayout.cl requires.

#include "LightPropagation/Sweep/OnCpu/SweepCrossing.cl"
#include "LightPropagation/Sweep/OnCpu/SweepFaces.cl"
#include "LightPropagation/Sweep/OnCpu/SweepLayout.cl"
#include "LightPropagation/Sweep/OnCpu/SweepPackingOfMoments.cl"
#include "LightPropagation/Sweep/OnCpu/SweepPartialCurrents.cl"
#include "LightPropagation/Sweep/OnCpu/SweepSides.cl"
#include "LightPropagation/Sweep/Slices/SliceSlot.cl"

// Selects plane k of a chain.
static void go_to_plane(sweep_state* state, int k)
{
  const struct plane_place* place = state->places + k;
  state->planes = place->planes;
  state->thin = place->thin;
  state->escaped = place->escaped;
  state->rounding = place->rounding;
#if FACES
  go_to_faces(state, state->firstPlane + place->plane);
  state->facePlane = place->plane;
#endif
}

// Functions for one bundle, compiled once for each number of members.
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

// The volume that a unit sweeps, see `sweep`.
typedef struct
{
  const SweepInfo* info;
  const __global float *sigma, *source, *beams, *octants;
  __global float *path, *lost, *flux, *currents;
  int backward;
} swept_volume;

// Its planes [first, first + count), packed in scratch.
typedef struct
{
  __global float* planes;
  __global int* thin; // [plane][row]
  int first, count;
  const __global OwnLightInfo* own; // of the first plane crossed; [plane, counted from where rays start]
} packed_planes;

// Finds the rows in which all voxels are optically thin.
static BY_ROW void find_thin_rows(const PlaneInfo* layout, const __global float* plane, int2 rows, __global int* thin)
{
  for (int v = rows.x; v < rows.y; ++v)
  {
    const __global float* sigma = ROW_OF(plane, PlaneSigma, v);
    integer thick = (integer)0;
    for (int u = 0; u < layout->width; u += REAL_WIDTH)
    {
      thick |= load_real(u, sigma) >= layout->thin;
    }
    thin[v] = !any(thick);
  }
}

// Prepares rows [rows.x, rows.y) of planes for crossing.
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
    find_thin_rows(layout, plane, rows, packed->thin + j * layout->sizeV);
    for (int v = rows.x; v < rows.y; ++v)
    {
      __global float* row = ROW_OF(plane, 0, v);
      for (int at = 0; at < ROW; at += REAL_WIDTH)
      {
        // Vacuum is treated as a very thin medium, which avoids 0 / 0.
        const real s = fmax(load_real(at, row + PlaneSigma * ROW), (real)layout->vacuum);
        store_real(s, at, row + PlaneSigma * ROW);
        store_real((real)1.0f / s, at, row + PlaneInverse * ROW);
        store_real((real)0.0f, at, row + PlaneTaken * ROW);
      }
      clear(row + PLANE_PATH * ROW, (PLANE_OCTANTS - PLANE_PATH) * ROW);
      if (!info->shines)
      {
        clear(row + PlaneSource * ROW, (PLANE_PATH - PlaneSource) * ROW);
        clear(row + PLANE_OCTANTS * ROW, (PLANES - PLANE_OCTANTS) * ROW);
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
// Adds to a row the path of emitted and scattered light within its voxel of origin (numerics.md, Eq. (26)): (length -
// taken) / sigma, or a polynomial if that would cancel or `taken` was not stored.
static BY_ROW void add_own_light(const PlaneInfo* layout, __global float* row, const __global OwnLightInfo* light)
{
  for (int at = 0; at < ROW; at += REAL_WIDTH)
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

// Adds the sums of rows of the planes to the volume.
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
      add_own_light(
        layout, ROW_OF(packed->planes + j * plane_floats(layout), 0, v), packed->own + (backward ? count - 1 - j : j));
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
#if CURRENTS
    const int aside[2] = { axis == 0 ? 1 : 0, axis == 2 ? 1 : 2 };
    const __global float* entered = packed->planes + (PLANE_CURRENTS + CurrentFaces * c) * ROW;
    __global float* faces = volume->currents + 6 * c * stride;
    unpack(layout, entered, first, count, rows, 1.0f, faces + (2 * axis + backward) * stride, 0);
    for (int side = 0; side < 4; ++side)
    {
      unpack(layout, entered + (CurrentLowU + side) * ROW, first, count, rows, 1.0f,
        faces + (2 * aside[side / 2] + side % 2) * stride, 0);
    }
#endif
  }
}

static void cross_planes(sweep_state* state, int planes, __global float* maps, const __global float* outside,
  const __global float* radiance, const __global BundleInfo* bundle, const __global CrossingInfo* crossings,
  int all_bundles, const __global float* all_coefficients, int first_row, int end_row)
{
  __global float* map = maps + bundle->map;
  const __global float* rows = outside + bundle->outside;
  const __global float* values = radiance + bundle->border;
  const __global float* coefficients = all_coefficients + bundle->coefficients;
#define CROSS(n) \
  cross_planes_##n(state, planes, map, rows, values, bundle, crossings, all_bundles, coefficients, first_row, end_row)
  switch (bundle->members)
  {
    case 1: CROSS(1); break;
    case 2: CROSS(2); break;
    case 4: CROSS(4); break;
    case 8: CROSS(8); break;
  }
#undef CROSS
}

// Carries rays of several bundles through a chain of planes. If the planes hold much data (moments, or large chained
// planes), works tile by tile of rows, so that a tile stays in the cache for all bundles.
// @param planes  number of planes; 1 if CHAINED is 0
// @param crossings, coefficients  those of the first bundle
// @param packed  the planes, whose rows are packed tile by tile if ROWS_KEPT; the bundles are then all
//                there are
static void cross_bundles(sweep_state* state, const swept_volume* volume, const packed_planes* packed, int planes,
  __global float* maps, const __global float* outside, const __global float* radiance,
  const __global BundleInfo* bundles, int count, const __global CrossingInfo* crossings, int all_bundles,
  const __global float* coefficients)
{
  __global float* const kept = state->ring;
#if ANGULAR
  const int tile = RowsTogether, floats_of_bundle = BUNDLE_FLOATS(CHANNELS, ROW);
#else
  const int tile = state->tile, floats_of_bundle = state->rings * RingRows * RAYS_OF_ROW;
#endif
  if (tile == 0)
  {
    for (int b = 0; b < count; ++b)
    {
      cross_planes(state, planes, maps, outside, radiance, bundles + b, crossings + b, all_bundles, coefficients,
        FirstRow, INT_MAX);
    }
    return;
  }
  const int behind = ROWS_BEHIND(state->chained_before + planes);
#if ROWS_KEPT
  int ended = 0; // rows
#endif
  for (int row = FirstRow; row < state->sizeV + behind; row += tile)
  {
#if ROWS_KEPT
    begin_rows(volume, packed, (int2)(max(row, 0), min(row + tile, state->sizeV)));
#endif
    for (int b = 0; b < count; ++b)
    {
      state->ring = kept + b * floats_of_bundle;
#if ANGULAR
      state->sources = state->ring + state->rings * RingRows * RAYS_OF_ROW;
      state->paths = state->sources + MomentRows * RAYS_OF_ROW;
      state->ownPath = state->paths + MomentRows * RAYS_OF_ROW;
#endif
      cross_planes(
        state, planes, maps, outside, radiance, bundles + b, crossings + b, all_bundles, coefficients, row, row + tile);
    }
#if ROWS_KEPT
    const int end = clamp(row + tile - behind, ended, state->sizeV);
    end_rows(volume, packed, (int2)(ended, end));
    ended = end;
#endif
  }
  state->ring = kept;
}

static void clear_tallies(float (*escaped)[4][CHANNELS], float (*rounding)[4][CHANNELS])
{
  for (int i = 0; i < PLANES_TOGETHER; ++i)
  {
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

// sigma     1/length, [voxel]
// source    W / (length^3 sr), with its angular moments and beams (MomentPlacesShared.h)
// path      W length, with its angular moments, added to
// lost      rounding errors of path in this sweep (compensated summation), if rays wrap around the axis
// flux      W length, [channel][x, y, z][stride], added to
// currents  W, [channel][-x, +x, -y, +y, -z, +z][stride], added to: power that enters the voxel through that face
// maps      rays of both ways
// outside, radiance   incident rays, both ways, as maps
// coefficients  see BundleInfo, both ways as maps
// crossings [plane of the ray pattern][bundle]
// own       [unit][plane from where rays start], see add_own_light
// schedule  [launch][unit] first plane and end, counted from where rays start; planes beyond the last
//           wrap around; if streamed [launch][planes, slots][unit], see go_to_slot
// tally     escaped power, W, [plane, counted from where rays start][unit][-u, +u, -v, +v][channel]
// octants   see SweepRequest::octantSource
// face_out, face_in  see Deposit.h, SweepOperator.h; used if FaceInfo has out, in; face_out is the sweep's own array,
//           [unit][channel][cell] if rays spread
// function_places  see SweepPlan::FunctionPlaces
// sides_in, sides_out  [plane, counted from the box's first][ray], see SweepSides.cl; if SIDES
// outer_sides  bit i: light that crosses side i leaves the domain; if SIDES
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void sweep(SweepInfo info, const __global float* sigma,
  const __global float* source, __global float* path, __global float* lost, __global float* flux,
  __global float* currents, __global float* maps, const __global float* outside, const __global float* radiance,
  __global float* scratch, const __global UnitInfo* units, const __global BundleInfo* bundles,
  const __global float* coefficients, const __global CrossingInfo* crossings, const __global OwnLightInfo* own,
  const __global int2* schedule, __global float* tally, __global exact* face_out, const __global float* face_in,
  const __global float* octants, const __global int* function_places SIDES_ARGUMENTS)
{
  const int u = get_global_id(0);
  const int unit_count = get_global_size(0);
  const UnitInfo unit = units[u];
  const int2 range = schedule[(info.streamed ? 2 : 1) * info.launch * unit_count + u];
  const int first_plane = info.planes.firstP; // index in the grid of the box's first plane
  if (info.streamed)
  {
    const int2 slot = schedule[(2 * info.launch + 1) * unit_count + u];
    go_to_slot(&info, slot, &sigma, &source, &path, &lost, &flux, &currents, &octants);
  }
  const PlaneInfo layout = info.planes;

  sweep_state state;
  state.sizeU = layout.sizeU;
  state.sizeV = layout.sizeV;
  state.width = layout.width;
  state.shines = info.shines;
  state.border = info.border;
  state.roundAxis = info.roundAxis;
  state.periodicU = info.periodicU;
  state.periodicV = info.periodicV;
  state.ring = scratch + unit.scratch;
  state.rings = RINGS_OF(layout.chained);
#if ANGULAR
  const int together = min(unit.bundles, (int)BundlesTogether);
  const int rings = together * BUNDLE_FLOATS(CHANNELS, ROW);
#else
  state.tile = CHAINED ? layout.tile : 0;
  const int together = state.tile > 0 ? min(unit.bundles, (int)BundlesTogether) : unit.bundles;
  const int rings = (state.tile > 0 ? together : 1) * state.rings * RingRows * RAYS_OF_ROW;
#endif
  state.moving = state.ring + rings;
  __global float* planes = state.moving + RAYS_OF_ROW + PAD; // past the last row's border
  const FaceInfo faces = info.faces;
#if FACES
  state.faces = &faces;
  state.firstPlane = first_plane;
  state.faceOut = face_out + u * faces.unit;
  state.facePlanes = layout.sizeP;
  state.faceIn = face_in;
#endif
#if FACES || SIDES
  state.outside = planes;
#endif
  planes += SIDES || faces.in ? RAYS_OF_ROW + PAD : 0;
#if SIDES
  state.outerSides = outer_sides;
#endif
  __global int* thin = (__global int*)(planes + layout.together * plane_floats(&layout));
  float escaped[PLANES_TOGETHER][4][CHANNELS], rounding[PLANES_TOGETHER][4][CHANNELS];
#if ANGULAR
  const int higher_functions = info.moments.functions - 1;
  const ulong channel = (ulong)info.moments.groups * higher_functions * MomentGroup;
  const ulong higher = info.moments.second + info.firstChannel * channel;
  const __global float* higher_source = source + higher;
  __global float* higher_path = path + higher;
  const __global float* beams = source + info.moments.beams + info.first;
  const int moment_plane = layout.sizeV * info.packedMoments;
  __global float* packed_source = (__global float*)thin + layout.together * layout.sizeV + REAL_WIDTH;
  __global float* packed_path = packed_source + layout.together * moment_plane;
#else
  const __global float* beams = source;
#endif
#if ANGULAR
  state.functions = info.moments.functions;
  state.functionPlaces = function_places;
  for (int p = 0; p < 4; ++p)
  {
    state.parityEnds[p] = info.parityEnds[p];
  }
#endif
  for (int i = 0; i < MeanLengthTerms; ++i)
  {
    state.meanLength[i] = layout.meanLength[i];
  }
  sigma += info.sigmaFirst;
  source += info.first;
  path += info.first;
  lost += info.first;
  flux += 3 * info.first;
  currents += 6 * info.first;
  octants += 8 * info.first;
  maps += unit.backward * info.mapsEachWay;
  outside += unit.backward * info.outsideEachWay;
  radiance += unit.backward * info.radianceEachWay;
  coefficients += unit.backward * info.coefficientsEachWay;

  clear(state.ring, rings + RAYS_OF_ROW + PAD);
  if (info.empty && range.x == 0 && range.y > 0)
  {
    for (int b = unit.firstBundle; b < unit.firstBundle + unit.bundles; ++b)
    {
      clear(maps + bundles[b].map, bundles[b].members * CHANNELS * ROW * (layout.sizeV + 2) + PAD);
    }
  }

  const swept_volume volume = { &info, sigma, source, beams, octants, path, lost, flux, currents, unit.backward };
  const int2 all_rows = (int2)(0, layout.sizeV);
  for (int begin = range.x, count; begin < range.y; begin += count)
  {
    const int lap = begin / layout.sizeP * layout.sizeP; // planes marched in earlier laps
    count = min(min(layout.together, range.y - begin), lap + layout.sizeP - begin);
#if ANGULAR
    count = info.momentsInPlace ? count : min(count, of_one_group(&layout, begin - lap, unit.backward));
#endif
    const int first = unit.backward ? layout.sizeP - (begin - lap) - count : begin - lap;
    packed_planes packed = { planes, thin, first, count, own + u * info.patternPlanes + begin };
#if !ROWS_KEPT
    begin_rows(&volume, &packed, all_rows);
#endif
#if ANGULAR
    if (!info.momentsInPlace)
    {
      if (info.shines)
      {
        pack_moments(&info, packed_source, first, count, higher_source);
      }
      clear(packed_path, count * moment_plane);
    }
#endif
    clear_tallies(escaped, rounding);
    struct plane_place places[PLANES_TOGETHER];
    for (int k = begin; k < begin + count; ++k)
    {
      const int plane = unit.backward ? layout.sizeP - 1 - (k - lap) : k - lap;
      struct plane_place* place = places + (k - begin);
      place->planes = planes + (plane - first) * plane_floats(&layout);
      place->thin = thin + (plane - first) * layout.sizeV;
      place->escaped = escaped[k - begin];
      place->rounding = rounding[k - begin];
      place->plane = plane;
    }
    for (int k = begin, chained; k < begin + count; k += chained)
    {
#if CHAINED
      // Chains begin at the same planes wherever a range begins, so that rows and sums are processed in the same order.
      state.chained_before = (unit.planesBefore + k) % layout.chained;
      chained = min(layout.chained - state.chained_before, begin + count - k);
#else
      state.chained_before = 0;
      chained = 1;
#endif
      state.places = places + (k - begin);
#if SIDES
      const ulong sides_of_plane = (ulong)k * info.radianceEachWay * SIDE_FLOATS(&state);
      state.sidesIn = sides_in + sides_of_plane;
      state.sidesOut = sides_out + sides_of_plane;
#endif
#if ANGULAR
      const int plane = state.places->plane;
      if (info.momentsInPlace)
      {
        const ulong line = info.moments.channels * channel;
        const ulong across = info.axis == 2 ? 1 : info.sizeY; // lines from one row of the plane to the next
        const ulong along = info.axis == 2 ? info.sizeY : 1;
        const ulong here = line * ((layout.firstP + plane) * along + layout.firstV * across);
        state.momentSource = higher_source + here;
        state.momentPath = higher_path + here;
        state.momentStep = line * across;
        state.momentChannel = channel;
      }
      else
      {
        state.momentSource = packed_source + (plane - first) * moment_plane;
        state.momentPath = packed_path + (plane - first) * moment_plane;
        state.momentStep = info.packedMoments;
        state.momentChannel = info.packedMoments / CHANNELS;
      }
#endif
#if ROWS_KEPT
      packed.first = min(state.places[0].plane, state.places[chained - 1].plane);
      packed.count = chained;
      packed.planes = planes + (packed.first - first) * plane_floats(&layout);
      packed.thin = thin + (packed.first - first) * layout.sizeV;
      packed.own = own + u * info.patternPlanes + k;
#endif
      const __global CrossingInfo* of_plane = crossings + (unit.planesBefore + k) * info.bundles;
      for (int b = unit.firstBundle; b < unit.firstBundle + unit.bundles; b += together)
      {
        const int some = min(together, unit.firstBundle + unit.bundles - b);
        cross_bundles(&state, &volume, &packed, chained, maps, outside, radiance, bundles + b, some, of_plane + b,
          info.bundles, coefficients);
      }
    }
    for (int k = 0; k < count; ++k)
    {
      for (int side = 0; side < 4; ++side)
      {
        for (int c = 0; c < CHANNELS; ++c)
        {
          tally[(((begin + k) * unit_count + u) * 4 + side) * CHANNELS + c] = escaped[k][side][c];
        }
      }
    }
#if !ROWS_KEPT
    end_rows(&volume, &packed, all_rows);
#endif
#if ANGULAR
    if (!info.momentsInPlace)
    {
      unpack_moments(&info, packed_path, first, count, higher_path);
    }
#endif
  }
}
