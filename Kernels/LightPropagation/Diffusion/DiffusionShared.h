// Shared by C++ and the kernels of the diffusion system.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  DiffusionChunk = 4096, ///< number of values that one work-group sums; the host adds the chunks in double
  AndersonSums = 8,      ///< number of sums per chunk
  RowVector = 8,         ///< widest SIMD vector used along rows of a level, floats
  RowsLead = 16          ///< padding before a level's first row, floats
};

/// A box of voxels of a multigrid level and the memory layout of its arrays. Voxels form rows along x. Each row has a
/// ghost on its left (the last float before it) and on its right, so that vectors may be loaded with an offset of one
/// voxel. Planes are padded so that rows of neighbouring planes do not map to the same cache lines.
typedef struct
{
  int size[3];
  int first[3], end[3]; ///< range of the voxels that this rank owns; the others are ghost voxels
  int halved[3];        ///< 1: halved to the next coarser level, by axis
  int shift[3];         ///< voxel x of the next coarser level's box has the voxels from (x << halved) + shift on
  int single[3];        ///< 1: the whole grid of the level has one voxel along this axis
  int pitch;            ///< distance of rows, floats
  int plane;            ///< distance of planes, floats
  int floats;           ///< size of an array, floats
  int together;         ///< number of rows per work-item on a CPU
} MultigridLevel;

/// The grid, and the offsets of one channel in the arrays.
typedef struct
{
  int size[3];
  int periodic[3];
  int linear;     ///< 1: light varies linearly between voxel centres; 0: it is constant in each voxel
  int stride;     ///< stride of channels in the solver's arrays
  int flatStride; ///< stride of axes in flat_source; 0 if all voxel edges are equal, so that axes share it
  /// Offset of this channel: in sigma_t, in all others (currents: six times that, flux: three times).
  int firstT, first;
  int pattern[6]; ///< offset of the crossing tables: [axis][other axes in order]
  float spacing[3];
  /// Sum over directions of w mu / 4 pi, mu > 0: exactly 1/4, except for the error of the quadrature.
  float halfRange;
  float floor;           ///< minimum optical length between voxel centres: conductance does not grow below it
  float absorbingWeight; ///< of the optical length of absorption in the weight of the transport correction
  float incoming[6];     ///< incident power through each face of the box, W / length^2
  float albedo[6];       ///< albedo of each face of the box
  MultigridLevel rows;   ///< memory layout of the conductances
} DiffusionLayout;

/// Values for each cell of the box's faces (Medium/BoxFaces.h), from the solution and from the sweep, W.
enum
{
  BorderNet = 0,     ///< outgoing minus incoming power, without the transport correction; accurate for each voxel
  BorderShare = 1,   ///< transport correction of BorderNet; accurate only summed over a face of the box
  BorderSeeming = 2, ///< outgoing power in the sweep; an estimate
  BorderWeight = 3,  ///< weight of the transport correction if the voxel has several such faces, else -1; not a power
  BorderCame = 4,    ///< incoming power in the sweep
  BorderWholeShare = 5, ///< transport correction before reflection at the face
  BorderValues = 6
};

/// Power by cell of the box's faces, W: rows of the array `faces`.
enum
{
  FaceCame = 0,  ///< reflected power in the sweep
  FaceGiven = 1, ///< part of the reflected power whose light was not swept
  FaceLeft = 2,  ///< outgoing power in the sweep
  FaceLeaves = 3 ///< outgoing power of the solution
};
SHARED_END
