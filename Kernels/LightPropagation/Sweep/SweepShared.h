// Shared by C++ and the sweep's kernels: their arguments.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  MaxMembers = 8,     ///< of a bundle
  RingRows = 4,       ///< a stage reads rows y - 1 to y + 1 while the stage before writes row y + 2
  MeanLengthTerms = 5 ///< of (1 - exp(-t)) / t = 1 + t (m0 + t (m1 + ...)) for thin voxels, see SweepPlan.cxx
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

/// Quantities of a plane: each channel has a source and a path, and a flux and currents where they are wanted.
#define PLANE_COUNT(channels, netFlux, currents) \
  (PlaneSource + (2 + ((netFlux) ? 3 : 0) + ((currents) ? CurrentFaces : 0)) * (channels))

typedef struct
{
  int members;
  int map;      ///< where its maps begin, in floats
  int border;   ///< where its radiances at the faces begin, in floats: [member][channel]
  int outside;  ///< where its rows outside begin, in floats: [member][channel][ROW]
  float power;  ///< that a ray carries at radiance 1
  float cosine; ///< of its directions with the axis it marches along, for the net flux
  float sineU, sineV;
  int move[MaxMembers][4]; ///< u from u, u from v, v from u, v from v: a signed permutation
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
  int block;    ///< planes packed together: 1 where rows are contiguous in memory, else a vector's worth
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

/// A launch of the kernel `sweep`.
typedef struct
{
  ulong sigmaFirst; ///< where the channel begins in sigma
  /// Where it begins in the other volumes (flux: three times, currents: six times that), and the way from one channel
  /// to the next.
  ulong first, stride;
  ulong mapsEachWay; ///< floats of the maps of one way along the axis
  uint outsideEachWay, radianceEachWay;
  int empty; ///< 1: the maps hold nothing yet, and are cleared where rays start
  int bundles;
  int patternPlanes; ///< planes of the ray pattern
  int launch;        ///< row of the schedule
  int axis;
  PlaneInfo planes;
} SweepInfo;
SHARED_END
