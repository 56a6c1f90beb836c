// The layout of a sweep, shared by the files that include it. The host gives
//   REAL_WIDTH  4, 8 or 16 floats of a vector
//   CHANNELS  1 or 3 colours that share sigma_t
//   ROW       floats in a padded row; the floats after a row's voxels and before the next row's are its border
//   ANGULAR   1 where light is gathered and scattered in angular moments, 0: fluence alone
//   BEAMS     sources with an angular distribution of their own, besides the moments; where ANGULAR
//   NET_FLUX  1 where the net flux is wanted
//   CURRENTS  1 where the power that enters each voxel through each face is wanted
//   OCTANT_SOURCE  1 where voxels may shine otherwise into each octant; where ANGULAR is 0
//   PERIODIC  1 where the box may be periodic along u or v; SweepInfo says along which it is
//   FACES     1 where light may leave and come in by cells of the box's faces (SweepFaces.cl); FaceInfo says which
//   CHAIN_KEEPS  rows of planes that scratch has room for, a power of two; 0: all; may be left out
//   SIDES     1 where the box is a block of a larger one (SweepSides.cl); may be left out
// What costs next to nothing to ask is not among them but in SweepInfo: a sweep of the light that comes in and those of
// what it scatters are one program, which takes seconds to compile.
//
// Rays carry power (W), so that leaving through any face needs no further factor. A map row holds the rays by the voxel
// they enter, for all members of a bundle and all channels: float [member][channel][ROW].

#pragma once
#include "LightPropagation/Sweep/SweepShared.h"
#include "Numerics/Exact.cl"
#include "Numerics/Numerics.cl"

#ifndef SIDES
#define SIDES 0
#endif
#ifndef CHAIN_KEEPS
#define CHAIN_KEEPS 0
#endif
#define PAD REAL_WIDTH
#define LAG 2 // rows a stage stays behind the one before
#define PLANES_TOGETHER (REAL_WIDTH > MostChained ? REAL_WIDTH : MostChained) // at most
#define FLUX (NET_FLUX ? 3 : 0)

// The quantities of one plane, behind those of SweepShared.h.
#define PLANE_BEAMS (PlaneSource + CHANNELS)
#define PLANE_PATH (PLANE_BEAMS + BEAMS * CHANNELS) // the path integral of power, W length
#define PLANE_FLUX (PLANE_PATH + CHANNELS)
#define PLANE_CURRENTS (PLANE_FLUX + FLUX * CHANNELS) // power that enters through CurrentFaces, W
#define PLANE_OCTANTS (PLANE_CURRENTS + (CURRENTS ? CurrentFaces : 0) * CHANNELS) // by WaysAside, W / (length^3 sr)
#define PLANES PLANE_COUNT(CHANNELS, BEAMS, NET_FLUX, CURRENTS, OCTANT_SOURCE)
#define RAYS_OF_ROW (MaxMembers * CHANNELS * ROW)

// Whether planes may be crossed row by row one behind the other, up to PLANES_CHAINED: not where what comes in or goes
// out beside rows is kept by plane, or rows come from the other side.
#define CHAINED (!ANGULAR && !FACES && !SIDES && !PERIODIC)
// Of functions that are called once a row, or less often: with copies of them in unrolled loops compiling took a third
// longer. Where planes may be chained calls cost 10% of a sweep of 64 voxels a row.
#if CHAINED
#define BY_ROW
#else
#define BY_ROW __attribute__((noinline))
#endif
#define PERIODIC_U (PERIODIC && state->periodicU)
#define PERIODIC_V (PERIODIC && state->periodicV)
#define ROWS_KEPT (CHAINED ? CHAIN_KEEPS : 0)

// A plane is [row][quantity][ROW]: what is needed at once lies together, and no stride is a power of two. Where
// ROWS_KEPT, it is those of its rows that bundles in turns are at, in as many places, used again and again.
#if ROWS_KEPT
#define PLACE_OF_ROW(row) ((row) & (ROWS_KEPT - 1))
#else
#define PLACE_OF_ROW(row) (row)
#endif
#define ROW_OF(planes, quantity, row) ((planes) + (PLACE_OF_ROW(row) * PLANES + (quantity)) * ROW)

#if ANGULAR
// Where voxel x is among so many functions from the second on, as MomentPlacesShared.h has them.
#define IN_ROW(x, higher) ((x) / MomentGroup * ((higher)*MomentGroup) + (x) % MomentGroup)
#endif

// Planes of a chain, their stages, and how far the last one stays behind.
#define PLANES_CHAINED (CHAINED ? MostChained : 1)
#define STAGES (3 * PLANES_CHAINED)
#define ROWS_BEHIND(planes) (LAG * (3 * (planes)-1) + 2) // a plane, that a stage may end at at most
typedef struct
{
  int plane, stage; // of the plane
} stage_of_chain;

#if ROWS_KEPT // are those of a turn, and those that its last stage is behind
typedef char kept_rows_suffice[ROWS_KEPT >= RowsOfChain + ROWS_BEHIND(MostChained) ? 1 : -1];
#endif

// A plane that is crossed.
struct plane_place
{
  __global float* planes;
  __global int* thin;
  float (*escaped)[CHANNELS];
  float (*rounding)[CHANNELS];
  int plane; // of the box
};

// Where a work-item is: its planes, its rows, its buffers.
typedef struct
{
  int sizeU, sizeV;                 // voxels of the plane
  int width;                        // sizeU rounded up to whole vectors
  int shines, border, roundAxis;    // as SweepInfo has them
  int periodicU, periodicV;         // likewise
  const struct plane_place* places; // of planes that are crossed one behind the other
  __global float* planes;           // of the plane that is being crossed
  __global int* thin;               // [row] of it, 1 where all voxels are thin
  float meanLength[MeanLengthTerms];
  int chained_before; // planes of a chain that were crossed before those of `places`
#if CHAINED
  const __global float* asked; // floats that are needed soon, and how many lines of them to ask for by vector
  int asks;
#endif
  int tile;             // rows that bundles cross in turns; 0: each crosses all of them
  int rings;            // one behind each stage but the last
  __global float* ring; // so many of RingRows rows of RAYS_OF_ROW floats
#if ANGULAR
  __global float* sources; // MomentRows rows of RAYS_OF_ROW floats: W / (length^3 sr) in the members' directions
  __global float* paths;   // the same: W length, of the members
  __global float* ownPath; // MomentRows rows: of a source of 1 in its own voxel
  // Of the plane, from the second function on: source and path, and the way from one row or channel to the next.
  const __global float* momentSource;
  __global float* momentPath;
  ulong momentStep, momentChannel;
  // The angular functions, and where each is in a group of moments, by parity along u and v: even and even, odd and
  // even, even and odd, odd and odd; and where those of each parity end.
  int functions;
  const __global int* functionPlaces;
  int parityEnds[4];
#endif
  __global float* moving;     // the rays of a row of which a part moves
  float (*escaped)[CHANNELS]; // of the plane, through -u, +u, -v, +v, W; with the rounding errors
  float (*rounding)[CHANNELS];
#if FACES
  const FaceInfo* faces;
  ulong faceFirst[4];        // of the plane that is being crossed, first channel
  int firstPlane;            // of the box, in the grid
  __global exact* faceOut;   // the unit's own
  int facePlane, facePlanes; // that is being crossed; all of them
  const __global float* faceIn;
#endif
#if FACES || SIDES
  __global float* outside; // the row of rays that come in through the faces across v, of the bundle in this plane
#endif
#if SIDES
  const __global float* sidesIn; // of the plane that is being crossed (SweepSides.cl)
  __global float* sidesOut;
  int outerSides;
#endif
} sweep_state;

#if REAL_WIDTH == 16
#define LANES (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#elif REAL_WIDTH == 8
#define LANES (int8)(0, 1, 2, 3, 4, 5, 6, 7)
#else
#define LANES (int4)(0, 1, 2, 3)
#endif

// Sum of the first `count` floats of a row.
static float sum_of_row(const __global float* row, int count)
{
  real sum = (real)0.0f;
  for (int x = 0; x < count; x += REAL_WIDTH)
  {
    sum += select(load_real(x, row), (real)0.0f, LANES >= count - x);
  }
  return sum_of(sum);
}

static void add_exactly(float* sum, float* rounding, float value) // Kahan
{
  const float y = value - *rounding;
  const float t = *sum + y;
  *rounding = (t - *sum) - y;
  *sum = t;
}
