// Memory layout of a sweep on CPUs, shared by the files that include this one. The host defines
//   REAL_WIDTH  number of floats in a vector: 4, 8 or 16
//   CHANNELS  number of channels that share sigma_t: 1 or 3
//   ROW       floats in a padded row; the padding between the voxels of two rows is their border
//   ANGULAR   1: light is represented by angular moments; 0: fluence only
//   BEAMS     number of sources with their own angular distribution, besides the moments; if ANGULAR
//   NET_FLUX  1: the net flux is computed
//   OCTANT_SOURCE  1: voxels may have an additional source per octant; only if ANGULAR is 0
//   PERIODIC  1: the box may be periodic along u or v; SweepInfo tells along which
//   FACES     1: escaped power may be summed, and incident radiance given, per cell of the box's faces (SweepSides.cl);
//             FaceInfo tells which
//   ROWS_KEPT  number of rows of a plane that scratch memory holds at a time, a power of two; 0: all rows. Only for
//              chained planes, i.e. planes that a bundle crosses together
//   SIDES     1: the box is a block of a larger domain (SweepSides.cl)
// A program takes seconds to compile. Options whose test at run time costs little are therefore members of SweepInfo,
// so that sweeps of incident light and of scattered light share one program.
//
// Rays carry power (W), so escaped power is a plain sum over rays at every face. A row of a map holds the power of the
// rays that enter a row of voxels, for all directions (members) of a bundle and all channels: float
// [member][channel][row].

#pragma once
#include "LightPropagation/Sweep/SweepShared.h"
#include "Numerics/Exact.cl"
#include "Numerics/Numerics.cl"

#define PAD REAL_WIDTH
// Number of rows by which a stage lags behind the previous one. A stage takes each ray through one voxel; a plane has
// at most three stages.
#define LAG 2
// Maximum number of planes that are copied to scratch memory together
#define PLANES_TOGETHER (REAL_WIDTH > MostChained ? REAL_WIDTH : MostChained)
#define FLUX (NET_FLUX ? 3 : 0)

// Indices of the quantities stored for each row of a plane, after those of SweepShared.h.
#define PLANE_BEAMS (PlaneSource + CHANNELS)
#define PLANE_PATH (PLANE_BEAMS + BEAMS * CHANNELS) // path integral of power, W length
#define PLANE_FLUX (PLANE_PATH + CHANNELS)
// Additional source in each of the four quadrants of directions (signs along u and v, WaysAside), W / (length^3 sr)
#define PLANE_OCTANTS (PLANE_FLUX + FLUX * CHANNELS)
// Power that enters the voxel through each of its CurrentFaces faces, W; only if PlaneInfo::currents is 1
#define PLANE_CURRENTS (PLANE_OCTANTS + (OCTANT_SOURCE ? WaysAside : 0) * CHANNELS)
#define RAYS_OF_ROW (MaxMembers * CHANNELS * ROW)

// Whether a bundle may cross several planes (up to PLANES_CHAINED) together, row by row, as a chain. This is impossible
// if rays that enter or leave sideways are stored for each plane, or if rows wrap around a periodic axis.
#define CHAINED (!ANGULAR && !FACES && !SIDES && !PERIODIC)
// BY_ROW is the attribute of functions that are called at most once per row. They are not inlined, because inlining in
// unrolled loops makes compilation a third slower. If planes may be chained, the compiler may inline them, because
// calls would cost 10% of a sweep with 64 voxels per row.
#if CHAINED
#define BY_ROW
#else
#define BY_ROW __attribute__((noinline))
#endif
#define PERIODIC_U (PERIODIC && state->periodicU)
#define PERIODIC_V (PERIODIC && state->periodicV)
#define KEPT_ROWS (CHAINED ? ROWS_KEPT : 0)

// Rows of a plane are stored as [row][quantity][float], so that data used together is contiguous and no stride is a
// power of two. If KEPT_ROWS is not 0, only the rows that bundles are crossing are stored, in a ring buffer of
// KEPT_ROWS rows.
#define PLACE_OF_ROW(row) (KEPT_ROWS ? (row) & (KEPT_ROWS - 1) : (row))
// Row v of a quantity in the packed plane `planes`; `layout` is a PlaneInfo or a sweep_state.
#define ROW_IN(layout, planes, quantity, v) ((planes) + (PLACE_OF_ROW(v) * (layout)->quantities + (quantity)) * ROW)
#define ROW_OF(planes, quantity, v) ROW_IN(state, planes, quantity, v)

#if ANGULAR
// Index, in a row of moments, of the moment of voxel x for the second angular function; `higher` is the number of
// functions from the second on. The order is [group][function][voxel of the group] (MomentPlacesShared.h).
#define IN_ROW(x, higher) ((x) / MomentGroup * ((higher)*MomentGroup) + (x) % MomentGroup)
// Number of floats in a row of one channel, in the volume's array with the moments of all functions from the second on.
#define MOMENTS_OF_CHANNEL(info) ((ulong)(info)->moments.groups * ((info)->moments.functions - 1) * MomentGroup)
#endif

// Maximum number of planes that a bundle crosses together, as a chain.
#define PLANES_CHAINED (CHAINED ? MostChained : 1)
#define STAGES (3 * PLANES_CHAINED)
// Maximum number of rows by which the last stage of a chain lags behind the first stage. A chain is `planes` planes
// that a bundle crosses together.
#define ROWS_BEHIND(planes) (LAG * (3 * (planes)-1) + 2)
typedef struct
{
  int stages; // number of stages of the planes that are crossed now, listed in `of`
  int before; // number of stages of the chain's planes that were crossed before, not listed in `of`
  struct
  {
    int plane, stage; // index of the plane in the chain, and of the stage in that plane
  } of[STAGES];
} chain_of_stages;

// Flag word of a row of a packed plane. Bit 0: some voxel is not optically thin, sigma_t >= PlaneInfo::thin. Bits 1 to
// SEGMENTS, one per segment of the row: some voxel of the segment has a medium or a source. These bits are always set
// if SweepInfo::skips is 0.
#define SEGMENTS 30
#define IS_THIN(word) (((word)&1) == 0)
#define IS_FILLED(word, x, bits) ((word) >> (1 + ((x) >> (bits))) & 1)

// Whether a mask (0 or -1 per lane) selects any lane. PoCL compiles the built-in function any to one branch per lane.
static bool any_lane(integer mask)
{
#if REAL_WIDTH == 16
  const int8 eight = mask.lo | mask.hi;
  const int4 four = eight.lo | eight.hi;
#elif REAL_WIDTH == 8
  const int4 four = mask.lo | mask.hi;
#else
  const int4 four = mask;
#endif
  const int2 two = four.lo | four.hi;
  return (two.x | two.y) != 0;
}

// Binary logarithm of the number of voxels in a segment of a row. A segment is one vector or, in longer rows, several
// vectors.
static int segment_bits(int width)
{
  int bits = 2;
  while ((1 << bits) < REAL_WIDTH || (width - 1) >> bits >= SEGMENTS)
  {
    ++bits;
  }
  return bits;
}

// Compile-time check of the number of rows in scratch memory: there must be room for one tile (block of rows that all
// bundles cross one after another) and for the rows by which the last stage of a chain lags behind the first stage.
typedef char kept_rows_suffice[!KEPT_ROWS || KEPT_ROWS >= RowsOfChain + ROWS_BEHIND(MostChained) ? 1 : -1];

// A plane that is being crossed: its packed quantities, flag words of its rows (IS_THIN, IS_FILLED) and escaped power.
struct plane_place
{
  __global float* planes;
  __global int* words; // of rows (IS_THIN, IS_FILLED)
  float (*escaped)[CHANNELS];
  float (*rounding)[CHANNELS];
  int plane; // index of the plane in the box
};

// State of a work-item: the planes, rows and buffers that it works on.
typedef struct
{
  int sizeU, sizeV;                 // number of voxels of the plane along u, v
  int quantities, currents;         // see PlaneInfo
  int width;                        // sizeU rounded up to whole vectors
  int shines, border, roundAxis;    // flags, see SweepInfo
  int periodicU, periodicV;         // flags, see SweepInfo
  int allBundles;                   // number of bundles of all work-items
  const struct plane_place* places; // the planes of a chain, which a bundle crosses together
  __global float* planes;           // quantities of the plane that is being crossed
  __global int* words;              // words of the rows of that plane (IS_THIN, IS_FILLED), [row]
  int segmentBits;                  // segment_bits()
  float meanLength[MeanLengthTerms];
  int chained_before; // number of planes of the chain that were crossed before those in `places`
  // Prefetch of maps, if CHAINED: address of the next cache line, and number of cache lines per vector of voxels
  const __global float* asked;
  int asks;
  int tile;             // rows in a tile, which all bundles cross before the next tile; 0: each bundle crosses all rows
  int rings;            // number of ring buffers of rows of rays: one after each stage except the last
  __global float* ring; // rows of rays that one stage hands to the next, W, [ring buffer][RingRows][RAYS_OF_ROW]
#if ANGULAR
  // Sources in the directions (members) of a bundle, W / (length^3 sr), MomentRows rows of RAYS_OF_ROW floats
  __global float* sources;
  __global float* paths; // path integrals of the bundle's directions, W length, laid out as sources
  // Path integral that a unit source in a voxel causes within that voxel, MomentRows rows.
  __global float* ownPath;
  // Angular moments of the plane's source and of its path integral, without the moment of the first function; number of
  // floats from one row of moments to the next, and from one channel to the next.
  const __global float* momentSource;
  __global float* momentPath;
  ulong momentStep, momentChannel;
  // Number of angular functions; for each function the index of its moment in a group of moments
  // (MomentPlacesShared.h); end of each parity's range in this list. The functions are sorted by parity along u and v:
  // even-even, odd-even, even-odd, odd-odd.
  int functions;
  const __global int* functionPlaces;
  int parityEnds[4];
#endif
  __global float* moving;     // result of MOVE_PART: a row of rays of which only a fraction moved sideways
  float (*escaped)[CHANNELS]; // escaped power of the plane through -u, +u, -v, +v, W, and its rounding errors
  float (*rounding)[CHANNELS];
#if FACES
  const FaceInfo* faces;
  // For each of the faces -u, +u, -v, +v: index of the first cell that adjoins the current plane, in the first channel
  ulong faceFirst[4];
  int firstPlane;            // index in the grid of the first plane of the box
  __global exact* faceOut;   // escaped power per cell of the box's faces, W, to which the work-item adds
  int facePlane, facePlanes; // index in the box of the plane that is being crossed; number of planes of the box
  const __global float* faceIn;
#endif
#if FACES || SIDES
  __global float* outside; // row of the bundle's rays that enter this plane through the faces normal to v
#endif
#if SIDES
  const __global float* sidesIn; // rays at the sides of the plane that is being crossed (SweepSides.cl)
  __global float* sidesOut;
  int outerSides;
#endif
} sweep_state;

#if SIDES
typedef float leaving_float;
#else
typedef exact leaving_float;
#endif

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

// Adds `value` to *sum, with compensated (Kahan) summation; *rounding is the accumulated rounding error.
static void add_exactly(float* sum, float* rounding, float value)
{
  const float y = value - *rounding;
  const float t = *sum + y;
  *rounding = (t - *sum) - y;
  *sum = t;
}
