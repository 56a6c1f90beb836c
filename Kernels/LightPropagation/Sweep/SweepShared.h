// Shared by C++ and the sweep's kernels: their arguments.
#pragma once

#include "Device/SharedTypes.h"
#include "LightPropagation/Sweep/MomentPlacesShared.h"

SHARED_BEGIN
enum
{
  MaxMembers = 8,       ///< of a bundle
  MaxFrames = 2,        ///< of a bundle: u and v as they are, and exchanged
  RingRows = 4,         ///< a stage reads rows y - 1 to y + 1 while the stage before writes row y + 2
  MeanLengthTerms = 5,  ///< of (1 - exp(-t)) / t = 1 + t (m0 + t (m1 + ...)) for thin voxels, see SweepPlan.cxx
  BundlesTogether = 16, ///< that cross planes in turns: where light has angular moments, or planes are chained
  MomentRows = 8,       ///< of which a bundle's sources are kept: of the rows that its stages are at
  MostChained = 2,      ///< planes that a bundle crosses row by row one behind the other
  RowsTogether = 8,     ///< of a plane with many moments: they stay in the cache for all bundles
  RowsOfChain = 32,     ///< of a chain, that bundles cross in turns: the planes' rows stay in the cache for all of them
  RowsOfChainKept = 64, ///< a power of two: of a turn, and those that its last stage is behind
  RowsAhead = 2,        ///< from where a chain begins a row to the row of its map that is asked for
  FloatsOfLine = 16,    ///< of a cache
  FirstRow = -2         ///< of a plane, that a first stage may begin at
};

/// The first quantities of a plane that is being crossed; behind them path, flux and partial currents (SweepLayout.cl).
enum
{
  PlaneSigma = 0,
  PlaneInverse = 1,
  PlaneTaken = 2, ///< sum over rays of power times mean transmitted length: what is missing of the source's own light
  PlaneSource = 3
};

/// Through which face of its voxel a ray comes: the one across the axis it marches along, or a low or high one aside.
enum
{
  CurrentAxis = 0,
  CurrentLowU = 1,
  CurrentHighU = 2,
  CurrentLowV = 3,
  CurrentHighV = 4,
  CurrentFaces = 5
};

/// Ways that rays go along u and v: 1 for u upwards, 2 for v upwards.
enum
{
  WaysAside = 4
};

/// Quantities of a plane: each channel has its source and its path, beams, and a flux and currents where they are
/// wanted, and what shines besides by octant.
#define PLANE_COUNT(channels, beams, netFlux, currents, octants) \
  (PlaneSource +                                                 \
    (2 + (beams) + ((netFlux) ? 3 : 0) + ((currents) ? CurrentFaces : 0) + ((octants) ? WaysAside : 0)) * (channels))

/// Rings of rows between the stages of so many planes that are crossed one behind the other: three stages at most each.
#define RINGS_OF(planes) (3 * (planes)-1)

/// Floats that a bundle keeps from one tile of rows to the next: two rings, and of MomentRows rows the members' sources
/// and paths, and the path of a source of 1 in its own voxel.
#define BUNDLE_FLOATS(channels, row) \
  ((RINGS_OF(1) * RingRows + 2 * MomentRows) * MaxMembers * (channels) * (row) + MomentRows * (row))

typedef struct
{
  int members;
  int map;      ///< where its maps begin, in floats
  int border;   ///< where its radiances at the faces begin, in floats: [member][channel]
  int outside;  ///< where its rows outside begin, in floats: [member][channel][ROW]
  float power;  ///< that a ray carries at radiance 1
  float cosine; ///< of its directions with the axis it marches along, for the net flux
  float sineU, sineV;
  float planesU, planesV;  ///< from one move along u, v to the next; at most those of the axis
  int move[MaxMembers][4]; ///< u from u, u from v, v from u, v from v: a signed permutation
  /// Members whose directions differ by signs alone, at most four, are a frame; where its members begin, and where the
  /// last one's end.
  int frames, firstOfFrame[MaxFrames + 1];
  int parities; ///< bit i: of the functions, those of parity i are not all zero (SweepLayout.cl)
  /// Where its coefficients begin, in floats, of each way: of the angular functions by [frame][function], in the order
  /// of the axis, for positive u and v; of beams by [member][beam].
  int coefficients;
} BundleInfo;

/// How rays of a bundle cross a plane.
typedef struct
{
  int stages;
  int moveU[3], moveV[3];
  float part[3]; ///< of each ray's power that moves; the rest stays
  float length[3];
} CrossingInfo;

/// What a work-item marches.
typedef struct
{
  int backward; ///< 0 marches from the lower end of the axis, 1 from the upper
  int firstBundle, bundles;
  int scratch;      ///< where its scratch begins, in floats
  int planesBefore; ///< of the ray pattern, that its rays have crossed before their first plane here
} UnitInfo;

/// How planes lie in the volume: voxel (u, v) of plane p is
/// (firstU + u) * stepU + (firstV + v) * stepV + (firstP + p) * stepP.
typedef struct
{
  int sizeU, sizeV, sizeP;
  int firstU, firstV, firstP;
  int stepU, stepV, stepP;
  int width;
  int block;    ///< planes packed at once: 1 where rows are contiguous in memory, else a vector's worth
  int together; ///< planes packed before any of them is crossed: a multiple of those
  int chained;  ///< of them, that a bundle crosses row by row one behind the other
  int tile;     ///< rows of those that bundles cross in turns; 0: each crosses all of them
  float vacuum; ///< 1/length, least sigma_t, in place of 0: exp(-tau) is 1 in float
  float thin;   ///< 1/length, below which meanLength holds on all segments
  float meanLength[MeanLengthTerms];
} PlaneInfo;

/// Path of the medium's own light in the voxel where it starts, per unit of source: the sum over segments of
/// power (l - p1) / sigma (numerics.md, Eq. (26)).
typedef struct
{
  float length;                 ///< sum of power l
  float terms[MeanLengthTerms]; ///< where the voxel is thin, the whole sum as a polynomial of sigma / PlaneInfo::thin
} OwnLightInfo;

/// Where the cells of the box's faces are (BoxFaces.h): of the faces -u, +u, -v, +v cell `i` of a row of plane p, along
/// the other of u and v, is first + p * plane + i * along.
typedef struct
{
  int first[4], plane[4], along[4];
  ulong firstChannel, stride; ///< where the first channel begins, and the way to the next
  ulong unit;                 ///< values of one unit's own cells, where it spreads: units cross planes side by side
  int out;                    ///< 1: the power that leaves through each cell is wanted
  int spread;                 ///< 1: of each ray, in all cells that it stands for; where out
  int in;                     ///< 1: light comes in by cells, besides that which is the same for a whole face
} FaceInfo;

/// A launch of the kernel `sweep`.
typedef struct
{
  ulong sigmaFirst; ///< where the channel begins in sigma
  /// Where it begins in the other volumes (flux: three times, currents: six times that), and the way from one channel
  /// to the next.
  ulong first, stride;
  ulong mapsEachWay; ///< floats of the maps of one way along the axis
  uint outsideEachWay, radianceEachWay, coefficientsEachWay;
  int empty;     ///< 1: the maps hold nothing yet, and are cleared where rays start
  int shines;    ///< 1: the medium does (emission or scattered light)
  int border;    ///< 1: light comes in through the faces that rays pass sideways
  int roundAxis; ///< 1: rays go round the axis: planes are added to many times, and what rounding loses is kept
  int periodicU, periodicV; ///< 1: the box is periodic along u, along v
  int bundles;
  int patternPlanes; ///< planes of the ray pattern
  int launch;        ///< row of the schedule
  int axis;
  PlaneInfo planes;
  FaceInfo faces;
  MomentPlaces moments;
  int sizeY;          ///< voxels of the grid along y, or of a slot
  int momentsInPlace; ///< 1: they are read and added to where they are; 0: they are packed like the rest of a plane
  int packedMoments;  ///< floats of a packed row of moments
  int parityEnds[4];  ///< where those of each parity end among the angular functions (SweepLayout.cl)
  int firstChannel;
  int streamed;               ///< 1: slices of the volumes are in slots (SliceStream.h)
  ulong sourceSlot, pathSlot; ///< floats of a slot of source and of path, where streamed
} SweepInfo;
SHARED_END
