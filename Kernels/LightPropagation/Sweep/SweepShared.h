// Shared by C++ and the sweep's kernels: kernel arguments.
#pragma once

#include "Device/SharedTypes.h"
#include "LightPropagation/Sweep/MomentPlacesShared.h"

SHARED_BEGIN
enum
{
  MaxMembers = 8,      ///< of a bundle
  MaxFrames = 2,       ///< of a bundle: u and v in order, and exchanged
  RingRows = 4,        ///< a stage reads rows y - 1 to y + 1 while the stage before writes row y + 2
  MeanLengthTerms = 5, ///< of (1 - exp(-t)) / t = 1 + t (m0 + t (m1 + ...)) for thin voxels, see SweepPlan.cxx
  /// Bundles that cross the same planes in turn, if there are angular moments or planes are chained
  BundlesTogether = 16,
  MomentRows = 8,   ///< rows for which a bundle's sources are stored: those that its stages are working on
  MostChained = 2,  ///< most planes in a chain: planes that a bundle crosses together, row by row
  RowsTogether = 8, ///< rows in a tile of a plane with many moments; a tile stays in the cache for all bundles
  /// Rows in a tile of a chain, which bundles cross in turn; a tile stays in the cache for all bundles
  RowsOfChain = 32,
  RowsOfChainKept = 64, ///< rows of a tile, and those by which its last stage lags behind; a power of two
  RowsAhead = 2,        ///< rows by which the prefetch of a chain's map is ahead
  FloatsOfLine = 16,    ///< floats in a cache line
  FirstRow = -2         ///< lowest row of a plane at which a first stage may begin
};

/// The first quantities of a plane that is being crossed; path, flux and partial currents follow (SweepLayout.cl).
enum
{
  PlaneSigma = 0,
  PlaneInverse = 1,
  /// Sum over rays of power times mean transmitted length: subtracted to obtain the path of a voxel's own source
  PlaneTaken = 2,
  PlaneSource = 3
};

/// Face through which a ray enters a voxel: across the marching axis, or the lower or upper face across u or v.
enum
{
  CurrentAxis = 0,
  CurrentLowU = 1,
  CurrentHighU = 2,
  CurrentLowV = 3,
  CurrentHighV = 4,
  CurrentFaces = 5
};

/// Number of combinations of a ray's ways along u and v; index: bit 0 for u upwards, bit 1 for v upwards.
enum
{
  WaysAside = 4
};

/// Number of quantities of a plane. Each channel has a source, a path and beams; a flux, currents and a source by
/// octant if used.
#define PLANE_COUNT(channels, beams, netFlux, currents, octants) \
  (PlaneSource +                                                 \
    (2 + (beams) + ((netFlux) ? 3 : 0) + ((currents) ? CurrentFaces : 0) + ((octants) ? WaysAside : 0)) * (channels))

/// Number of rings of rows between the stages of `planes` chained planes, with at most three stages per plane.
#define RINGS_OF(planes) (3 * (planes)-1)

/// Floats that a bundle keeps from one tile of rows to the next: two rings; for MomentRows rows the members' sources
/// and paths, and the path of a unit source in its own voxel.
#define BUNDLE_FLOATS(channels, row) \
  ((RINGS_OF(1) * RingRows + 2 * MomentRows) * MaxMembers * (channels) * (row) + MomentRows * (row))

typedef struct
{
  int members;
  int map;      ///< index of the first float of its maps
  int border;   ///< index of the first of its radiances at the faces, [member][channel]
  int outside;  ///< index of the first float of its rows outside, [member][channel][ROW]
  float power;  ///< power of a ray at radiance 1, length^2 sr
  float cosine; ///< cosine between its directions and the marching axis, for the net flux
  float sineU, sineV;
  float planesU, planesV;  ///< planes from one move along u, v to the next; at most those of the axis
  int move[MaxMembers][4]; ///< u from u, u from v, v from u, v from v: a signed permutation
  /// A frame is a set of at most four members whose directions differ only in signs. firstOfFrame: index of each
  /// frame's first member, then the end of the last frame.
  int frames, firstOfFrame[MaxFrames + 1];
  int parities; ///< bit i: the functions of parity i are not all zero (SweepLayout.cl)
  /// Index of its first coefficient, for each way: values of the angular functions for positive u and v,
  /// [frame][function] in the order of the axis; then those of beams, [member][beam].
  int coefficients;
} BundleInfo;

/// How rays of a bundle cross a plane.
typedef struct
{
  int stages;
  int moveU[3], moveV[3];
  float part[3]; ///< part of each ray's power that moves; the rest stays
  float length[3];
} CrossingInfo;

/// Unit of work: the rays that one work-item carries.
typedef struct
{
  int backward; ///< 0 marches from the lower end of the axis, 1 from the upper
  int firstBundle, bundles;
  int scratch;      ///< index of its scratch's first float
  int planesBefore; ///< planes of the ray pattern that its rays have crossed before the first plane of this unit
} UnitInfo;

/// Memory layout of planes in the volume. The index of voxel (u, v) of plane p is
/// (firstU + u) * stepU + (firstV + v) * stepV + (firstP + p) * stepP.
typedef struct
{
  int sizeU, sizeV, sizeP;
  int firstU, firstV, firstP;
  int stepU, stepV, stepP;
  int width;
  int block;    ///< planes packed at once: 1 if rows are contiguous in memory, else the vector width
  int together; ///< planes packed before any of them is crossed: a multiple of `block`
  int chained;  ///< planes of `together` that form a chain, which a bundle crosses row by row
  int tile;     ///< rows in a tile, which bundles cross in turn; 0: each bundle crosses all rows
  float vacuum; ///< 1/length, smallest sigma_t, used instead of 0: exp(-tau) is 1 in float
  float thin;   ///< 1/length, extinction below which the polynomial `meanLength` holds on all segments
  float meanLength[MeanLengthTerms];
} PlaneInfo;

/// Path of emitted and scattered light within its voxel of origin, per unit of source: the sum over segments of power
/// (l - p1) / sigma (numerics.md, Eq. (26)).
typedef struct
{
  float length;                 ///< sum over segments of power l
  float terms[MeanLengthTerms]; ///< for a thin voxel, the whole sum as a polynomial in sigma / PlaneInfo::thin
} OwnLightInfo;

/// Memory layout of the cells of the box's faces (BoxFaces.h). For the faces -u, +u, -v, +v: cell `i` of a row of plane
/// p, along the other of u and v, has the index first + p * plane + i * along.
typedef struct
{
  int first[4], plane[4], along[4];
  ulong firstChannel, stride; ///< index of the first channel's first cell; cells from one channel to the next
  ulong unit;                 ///< values in one unit's own copy of the cells, if `spread`: units run concurrently
  int out;                    ///< 1: the power that leaves through each cell is counted
  int spread;                 ///< 1: that power is spread over all cells that the ray represents; used if `out`
  /// 1: incident light is given by cells, in addition to that which is uniform over each face
  int in;
} FaceInfo;

/// Floats of each array of a sweep for one way (forward or backward) along its axis.
typedef struct
{
  ulong maps;
  ulong outside;      ///< rows of rays that enter through the faces across v
  ulong radiance;     ///< rays that enter through the faces across u: one for each member and channel
  ulong coefficients; ///< values of angular functions
} EachWay;

/// A launch of the kernel `sweep`.
typedef struct
{
  ulong sigmaFirst; ///< index of the channel's first value in sigma
  /// Index of its first value in the other volumes (in the flux three times, in the currents six times this index), and
  /// floats from one channel to the next.
  ulong first, stride;
  EachWay eachWay;
  int empty;     ///< 1: the maps are uninitialised and are cleared where rays start
  int shines;    ///< 1: the medium has a source (emission or scattered light)
  int border;    ///< 1: light is incident on the faces that rays pass sideways
  int roundAxis; ///< 1: rays wrap around the axis: planes are added to many times, with compensated summation
  int periodicU, periodicV; ///< 1: the box is periodic along u, along v
  int bundles;
  int patternPlanes; ///< number of planes of the ray pattern
  int launch;        ///< row of the schedule
  int axis;
  PlaneInfo planes;
  FaceInfo faces;
  MomentPlaces moments;
  int sizeY;          ///< extent along y of the grid or, if streamed, of a slot, voxels
  int momentsInPlace; ///< 1: moments are read and added to in place; 0: they are packed like the rest of a plane
  int packedMoments;  ///< floats of a packed row of moments
  int parityEnds[4];  ///< end of each parity's range of angular functions (SweepLayout.cl)
  int firstChannel;
  int streamed;               ///< 1: the volumes are streamed in slices through slots (SliceStream.h)
  ulong sourceSlot, pathSlot; ///< floats of a slot of source and of path, if streamed
  int outerSides;             ///< for a block of a larger domain: bit i: light that crosses side i leaves the domain
} SweepInfo;

/// A launch of the kernels that work on the maps of rays (SweepMaps.cl). Maps are [way][bundle][row][member][channel]
/// with `row` floats for each row of a ray; rays are in its first sizeU floats after `border`.
typedef struct
{
  ulong eachWay; ///< floats for one way
  int bundles, channels;
  int row, border;
  int sizeU, width; ///< voxels of a row; the same rounded up to whole vectors
  ulong face[2];    ///< by way: index of the first channel's first cell of the face where rays start, or end
  ulong faceStride; ///< cells from one channel to the next
} MapsInfo;
SHARED_END

#ifdef __OPENCL_C_VERSION__
// Move of a bundle's member before a stage of a crossing, voxels along u and v.
static inline int2 move_of(
  const __global BundleInfo* bundle, int member, const __global CrossingInfo* crossing, int stage)
{
  const __global int* move = bundle->move[member];
  const int u = crossing->moveU[stage], v = crossing->moveV[stage];
  return (int2)(move[0] * u + move[1] * v, move[2] * u + move[3] * v);
}
#endif
