// Shared by C++ and the kernels of the diffusion system.
#pragma once

#include "Device/SharedTypes.h"

/// The reciprocal weight of the transport correction has a term that grows with the optical length tau of a voxel
/// (numerics.md, Eq. (55)). This is that term, divided by tau.
#define TRANSPORT_FALL(tau) ((tau) * (0.25f + 0.075f * (tau) / (1.0f + 0.015625f * (tau) * (tau))))

SHARED_BEGIN
enum
{
  DiffusionChunk = 4096, ///< number of values that one work-group sums; the host adds the sums of chunks in double
  /// Number of sums over each chunk of values that Anderson mixing needs: seven, and one of padding
  AndersonSums = 8,
  RowVector = 8, ///< width of the widest SIMD vector along rows of a multigrid level, floats
  RowsLead = 16  ///< padding before the first row of a multigrid level, floats
};

/// Optical thickness of the thickest voxel of a row that lies next to a thinner one.
enum
{
  NoSkin = 0,     ///< no voxel of the row is optically thick and next to a thinner one
  ThickSkin = 1,  ///< at most 100 mean free paths
  OpaqueSkin = 2, ///< over 100 mean free paths
  EndlessSkin = 3 ///< over 1e9 mean free paths: most of the voxel's fluence is rounding error
};

/// A box of voxels of a multigrid level and the memory layout of its arrays. Voxels form rows along x. One float before
/// and one after each row are ghosts, so that vectors may be loaded with an offset of one voxel. Planes are padded so
/// that rows of neighbouring planes do not map to the same cache lines.
typedef struct
{
  int size[3];
  int first[3], end[3]; ///< range of the voxels that this rank owns; all others are ghost voxels
  int halved[3];        ///< 1: the next coarser level joins pairs of voxels along this axis
  int shift[3];  ///< voxel x of the next coarser level's box begins at voxel (x << halved) + shift of this level's box
  int single[3]; ///< 1: the whole grid of the level has one voxel along this axis
  int pitch;     ///< distance between rows, floats
  int plane;     ///< distance between planes, floats
  int floats;    ///< number of floats in an array of the level
  int together;  ///< number of consecutive rows that a work-item processes on a CPU
} MultigridLevel;

/// Geometry and constants of the diffusion system of one channel, and the offsets of the channel in the solver's
/// arrays.
typedef struct
{
  int size[3];
  int periodic[3];
  /// 1: the system includes lamps' first-scattered light that crosses faces without another collision (LampPassing.cl).
  int passing;
  int moments; ///< 1: sweeps treat forward scattering as unscattered light, or have angular moments
  int faces;   ///< 1: sweeps tally outgoing and reflected power by cell of the box's faces
  int skin;    ///< 1: the grid has optically thick voxels next to thinner ones
  int linear;  ///< 1: light varies linearly between voxel centres; 0: it is constant in each voxel
  int stride;  ///< floats from one channel to the next in the solver's arrays
  /// Floats from one axis to the next in flat_source; 0 if voxels are cubes, so that axes share one array
  int flatStride;
  /// Offset of the channel: firstT in sigma_t, first in all other arrays (times 6 in currents, times 3 in flux).
  int firstT, first;
  /// Index of the first entry of each table of the crossing pattern (power of the rays that cross a face, relative to
  /// the mean; SweepModel.h), [axis perpendicular to the face][first, second of the other two axes].
  int pattern[6];
  float spacing[3];
  /// Half-range flux of the quadrature: sum of w mu / (4 pi) over directions with mu > 0; 1/4 except for the error of
  /// the quadrature.
  float halfRange;
  float floor; ///< minimum optical length between voxel centres: conductance does not grow below it
  /// Factor of the absorption in the weight of the transport correction: 3 (numerics.md, Eq. (55)), or 0 if scattering
  /// is computed in angular moments.
  float absorbingWeight;
  float incoming[6];   ///< incident power per area through each face of the box, W / length^2
  float albedo[6];     ///< albedo of each face of the box
  MultigridLevel rows; ///< memory layout of the conductances
} DiffusionLayout;

/// Node (group of directions) in the sum for the partial current of a sweep whose source is constant in each voxel.
/// Along one axis, s(tau) of numerics.md, Eq. (51), is the sum over nodes of
///   weight (tau / 2 + cosine x / (exp(x) - 1)),   x = extinction times chord.
typedef struct
{
  float cosine; ///< cosine of the directions to the axis, 0 to 1
  float chord;  ///< length of path in a voxel over which the sweep attenuates their radiance
  float weight; ///< solid angle of the directions divided by 4 pi, times `cosine`
} FlatSourceNode;

/// Values for each cell of the box's faces (Medium/BoxFaces.h), W, in the array `borders`.
enum
{
  BorderNet = 0, ///< outgoing minus incoming power, without the transport correction; accurate for each voxel
  /// Transport correction (the sweep's deviation from diffusion) to be added to BorderNet; accurate only in sums over a
  /// face of the box
  BorderShare = 1,
  BorderSeeming = 2, ///< outgoing power in the sweep (estimated, numerics.md, Eq. (61))
  /// Weight of the transport correction if several faces of the voxel lie on the box's boundary, else -1;
  /// dimensionless.
  BorderWeight = 3,
  BorderCame = 4,       ///< incoming power in the sweep
  BorderWholeShare = 5, ///< transport correction, as BorderShare, without the factor for reflection at the face
  BorderValues = 6
};

/// Rows of the array `faces`: power by cell of the box's faces, W.
enum
{
  FaceCame = 0,  ///< power that the face reflected into the last sweep
  FaceGiven = 1, ///< reflected power of uncollided light, which sweeps do not trace
  FaceLeft = 2,  ///< outgoing power in the sweep
  FaceLeaves = 3 ///< outgoing power of the diffusion solution
};
SHARED_END
