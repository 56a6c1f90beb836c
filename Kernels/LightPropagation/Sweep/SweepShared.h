// Arguments of the sweep's OpenCL kernels, shared with C++.
#pragma once

#include "Device/SharedTypes.h"
#include "LightPropagation/Sweep/MomentPlacesShared.h"

SHARED_BEGIN
enum
{
  MaxMembers = 8, ///< maximum number of members, i.e. symmetric directions, in a bundle
  /// Maximum number of frames in a bundle. A frame has the members whose directions differ only in signs; the
  /// directions of a second frame have u and v exchanged
  MaxFrames = 2,
  /// Rows in the ring buffer between two stages of crossing a plane (a stage takes each ray through one voxel): a stage
  /// reads rows y - 1 to y + 1 while the stage before it writes row y + 2
  RingRows = 4,
  /// Number of coefficients m of (1 - exp(-t)) / t = 1 + t (m0 + t (m1 + ...)) for thin voxels, see SweepPlan.cxx
  MeanLengthTerms = 5,
  /// Maximum number of bundles that cross a tile (block of rows) one after another, before the first of them crosses
  /// the next tile. Used with angular moments or chained planes
  BundlesTogether = 16,
  /// Number of rows for which a bundle's sources are stored: the rows on which all stages of crossing a plane work at
  /// the same time. A stage takes each ray through one voxel
  MomentRows = 8,
  /// Maximum number of planes in a chain, i.e. planes that a bundle crosses together, row by row
  MostChained = 2,
  /// Rows in a tile of a plane with angular moments; a tile stays in the cache while all bundles cross it
  RowsTogether = 8,
  /// Rows in a tile of chained planes (planes that a bundle crosses together, row by row); a tile stays in the cache
  /// while all bundles cross it
  RowsOfChain = 32,
  /// For chained planes, scratch memory holds this number of rows of a plane, a power of two. It has room for a tile,
  /// and for the rows by which the last stage of the chain lags behind the first stage
  RowsOfChainKept = 64,
  /// In chained planes (crossed together, row by row), rows of a map (powers of rays) are prefetched this number of
  /// rows ahead
  RowsAhead = 2,
  FloatsOfLine = 16, ///< number of floats in a cache line
  /// Lowest row at which the first stage of crossing a plane begins. If v is periodic, this stage also crosses up to
  /// two ghost rows before row 0, copies of the rows at the other end of the plane
  FirstRow = -2
};

/// Indices of the first quantities stored per row of a plane that is being crossed; path, flux and partial currents
/// follow (SweepLayout.cl).
enum
{
  PlaneSigma = 0,
  PlaneInverse = 1,
  /// Sum over rays of power times mean transmitted length. The sum of power times length minus this sum is sigma_t
  /// times the path integral that a unit source causes within its own voxel (numerics.md, Eq. (26))
  PlaneTaken = 2,
  PlaneSource = 3
};

/// Faces of a voxel through which a ray enters: normal to the marching axis, or the lower or upper face normal to u or
/// v.
enum
{
  CurrentAxis = 0,
  CurrentLowU = 1,
  CurrentHighU = 2,
  CurrentLowV = 3,
  CurrentHighV = 4,
  CurrentFaces = 5
};

/// Number of combinations of a ray's senses along u and v; bit 0 of the index is set for increasing u, bit 1 for
/// increasing v.
enum
{
  WaysAside = 4
};

/// Number of ring buffers of rows between the stages of `planes` chained planes, which a bundle crosses together. Each
/// plane has at most three stages.
#define RINGS_OF(planes) (3 * (planes)-1)

/// Number of floats that a bundle keeps from one tile of rows to the next: two ring buffers between stages; and for
/// MomentRows rows the sources and path integrals of all members, and the path integral that a unit source causes
/// within its own voxel.
#define BUNDLE_FLOATS(channels, row) \
  ((RINGS_OF(1) * RingRows + 2 * MomentRows) * MaxMembers * (channels) * (row) + MomentRows * (row))

typedef struct
{
  int members;
  int map; ///< index of the first float of the bundle's maps (power of its rays)
  /// Index of the bundle's first value in the incident power at faces normal to u, [member (direction)][channel]
  int border;
  /// Index of the bundle's first float in the rows of rays that enter through faces normal to v,
  /// [member][channel][row]; a member is one direction of the bundle
  int outside;
  float power;  ///< power of a ray of radiance 1 (numerics.md, Eq. (19)), length^2 sr
  float cosine; ///< cosine of the angle between the bundle's directions and the marching axis, for the net flux
  float sineU, sineV;
  /// Mean number of planes between two sideways moves of a ray, along u and along v; at most the number of planes of
  /// the axis
  float planesU, planesV;
  /// Per member (direction), the 2 x 2 signed permutation that maps the bundle's moves along its own axes to moves
  /// along u and v of the plane: u from u, u from v, v from u, v from v
  int move[MaxMembers][4];
  /// Number of frames; index of each frame's first member, followed by the end of the last frame. A frame is a set of
  /// at most four members of the bundle whose directions differ only in signs.
  int frames, firstOfFrame[MaxFrames + 1];
  /// Bit i is set if any angular function of parity i (even or odd along u and v) is not zero in the bundle's
  /// directions (SweepLayout.cl)
  int parities;
  /// Index of the bundle's first coefficient, for each sense of marching. Coefficients are the values of the angular
  /// functions for positive u and v, [frame (directions that differ only in signs)][function], sorted by parity as in
  /// FunctionOrder; then the angular distributions of beams, [member][beam].
  int coefficients;
} BundleInfo;

/// Moves and segments of a bundle's rays in one plane: each stage moves the rays sideways and takes them through one
/// voxel.
typedef struct
{
  int stages;
  int moveU[3], moveV[3];
  /// Fraction of each ray's power that moves sideways; the remainder stays in its column of voxels
  float part[3];
  float length[3];
} CrossingInfo;

/// Unit of work: bundles and sense of marching of the rays that one work-item carries.
typedef struct
{
  int backward; ///< 0: marches from the lower end of the axis, 1: from the upper end
  int firstBundle, bundles;
  int scratch; ///< index of the first float of the unit of work's scratch memory
  /// Number of planes from where the rays of this unit of work start to the first plane of the swept box
  int planesBefore;
} UnitInfo;

/// Memory layout of the swept planes within the grid. The index of voxel (u, v) of plane p is (firstU + u) * stepU +
/// (firstV + v) * stepV + (firstP + p) * stepP.
typedef struct
{
  int sizeU, sizeV, sizeP;
  int firstU, firstV, firstP;
  int stepU, stepV, stepP;
  int width;
  int quantities; ///< number of quantities per voxel of a plane that is packed (copied to scratch)
  int currents;   ///< 1: the power that enters each voxel through each face is summed
  /// Number of planes packed (copied to scratch) at once: 1 if rows are contiguous in memory, else the vector width
  int block;
  /// Number of planes packed (copied to scratch) before any of them is crossed: a multiple of `block`
  int together;
  int chained; ///< number of planes in a chain, which a bundle crosses together, row by row
  /// Number of rows in a tile, which all bundles cross one after another; 0: each bundle crosses all rows at once
  int tile;
  float vacuum; ///< sigma_t used instead of 0 in vacuum, 1/length; so small that exp(-tau) is 1 in float
  float thin;   ///< sigma_t below which the polynomial `meanLength` holds on all segments, 1/length
  float meanLength[MeanLengthTerms];
} PlaneInfo;

/// Path integral that a unit source in a voxel causes within that voxel: sum over segments of power (l - p1) / sigma_t,
/// where l is the length and p1 the mean transmitted length (numerics.md, Eq. (26)).
typedef struct
{
  float length; ///< sum over segments of power times length l
  /// For a thin voxel: coefficients of the path integral as a polynomial in sigma_t / PlaneInfo::thin
  float terms[MeanLengthTerms];
} OwnLightInfo;

/// Memory layout of the cells of the box's faces (BoxFaces.h). For the faces -u, +u, -v, +v, the cell at position i of
/// plane p (i along v for the faces normal to u, along u for those normal to v) has the index first + p * plane + i *
/// along.
typedef struct
{
  int first[4], plane[4], along[4];
  /// Index of the first channel's first cell; number of cells from one channel to the next
  ulong firstChannel, stride;
  /// Number of values in a copy of all cells. If `spread` is 1, each unit of work (rays carried by one work-item) has
  /// its own copy, because units of work run concurrently
  ulong unit;
  int out; ///< 1: the power that leaves through each cell of the box's faces is summed
  /// 1: the escaped power of a ray is spread over all face cells through which light represented by the ray leaves;
  /// used if `out` is 1
  int spread;
  /// 1: incident radiance is given per cell of the box's faces, in addition to the radiance that is uniform over each
  /// face
  int in;
} FaceInfo;

/// Number of floats of each array of a sweep for one sense of marching (forward or backward).
typedef struct
{
  ulong maps;
  ulong outside;      ///< power of rays that enter through the faces normal to v: one row per member and channel
  ulong radiance;     ///< power of rays that enter through the faces normal to u: one value per member and channel
  ulong coefficients; ///< values of the angular functions
} EachWay;

/// Arguments of a launch of the kernel `sweep`.
typedef struct
{
  ulong sigmaFirst; ///< index of the first channel's first value in sigma_t
  /// `first`: index of the first channel's first value in source and path. The index in the flux is three times this
  /// number, and that in the partial currents six times. `stride`: floats from one channel to the next.
  ulong first, stride;
  EachWay eachWay;
  int empty;  ///< 1: the maps (powers of rays) are uninitialised, and are cleared where rays start
  int shines; ///< 1: the medium has a source (emission or scattered light)
  int skips;  ///< 1: angular moments of path integrals, except the first, are not needed where there is no medium
  int border; ///< 1: light is incident on the faces parallel to the marching axis
  /// 1: rays wrap around the marching axis, so sums are added to each plane repeatedly, with compensated summation
  int roundAxis;
  int periodicU, periodicV; ///< 1: the box is periodic along u, along v
  int bundles;
  int patternPlanes; ///< number of planes after which the sideways moves of rays repeat
  int launch;        ///< index of this launch in the schedule
  int axis;
  PlaneInfo planes;
  FaceInfo faces;
  MomentPlaces moments;
  int sizeY; ///< voxels along y of the grid or, if the volume is streamed, of a slot (device buffer for a slice)
  /// 1: the kernel reads and adds to angular moments in their array; 0: they are packed (copied to scratch) like the
  /// other quantities of a plane
  int momentsInPlace;
  int packedMoments; ///< number of floats in a row of moments that is packed (copied to scratch)
  int parityEnds[4]; ///< end of the range of angular functions of each parity (SweepLayout.cl)
  int firstChannel;
  /// 1: the volumes are streamed in slices through slots, device buffers that hold a few planes (SliceStream.h)
  int streamed;
  /// If the volume is streamed: number of floats in a slot (device buffer for a slice) of the source, and in a slot of
  /// the path integral
  ulong sourceSlot, pathSlot;
  int outerSides; ///< for a subdomain: bit i is set if light that crosses side i of -u, +u, -v, +v leaves the domain
} SweepInfo;

/// Arguments of the kernels on the maps of rays (SweepMaps.cl). Maps are [sense][bundle][row][member][channel] (a
/// member is one direction of a bundle), with `row` floats for each row of rays: the first `border` floats are
/// padding, then `sizeU` rays follow.
typedef struct
{
  ulong eachWay; ///< number of floats of the maps for one sense of marching
  int bundles, channels;
  int row, border;
  int sizeU, width; ///< number of voxels in a row, and that number rounded up to whole vectors
  /// Per sense of marching: index of the first channel's first cell of the face where rays start (or end)
  ulong face[2];
  ulong faceStride; ///< number of cells from one channel to the next
} MapsInfo;
SHARED_END

#ifdef __OPENCL_C_VERSION__
// Sideways move, in voxels along u and v, of the rays of one member (direction) of a bundle before a stage of crossing
// a plane. A stage takes the rays through one voxel.
static inline int2 move_of(
  const __global BundleInfo* bundle, int member, const __global CrossingInfo* crossing, int stage)
{
  const __global int* move = bundle->move[member];
  const int u = crossing->moveU[stage], v = crossing->moveV[stage];
  return (int2)(move[0] * u + move[1] * v, move[2] * u + move[3] * v);
}
#endif
