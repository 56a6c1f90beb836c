// Shared by C++ and the kernels of the diffusion system.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  DiffusionChunk = 4096, ///< values that a work-group sums up before the host adds the chunks in double
  AndersonSums = 8,      ///< of a chunk
  RowVector = 8,         ///< the widest vector that walks along rows of a level, floats
  RowsLead = 16          ///< floats before a level's first row
};

/// A level of multigrid, and how its arrays lie in memory: rows along x, each behind its left ghost (the last float of
/// what is before it) and followed by its right one, so that vectors may be loaded one voxel aside; planes are a little
/// further apart, for rows of neighbouring planes not to fall on the same lines of the caches.
typedef struct
{
  int size[3];
  int halved[3]; ///< to the next coarser level
  int pitch;     ///< floats from row to row
  int plane;     ///< from plane to plane
  int floats;    ///< of an array
  int together;  ///< rows that a work-item of a CPU walks along
} MultigridLevel;

/// The grid and arrays of one channel.
typedef struct
{
  int size[3];
  int periodic[3];
  int linear;        ///< 1: the light between voxels' centres is linear; 0: each voxel is as one
  int stride;        ///< of channels in the solver's arrays
  int flatStride;    ///< from axis to axis of flat_source: 0 where voxels' edges are equal, for it is the same
  int firstT, first; ///< where this channel begins: of sigma_t, of all others (currents: six times that, flux: three)
  int pattern[6];    ///< where the tables of crossings begin: [axis][other axes in order]
  float spacing[3];
  float halfRange;     ///< sum over directions of w mu / 4 pi, mu > 0: 1/4 but for the direction set
  float floor;         ///< optical length between voxels' centres below which they pass no more
  float incoming[6];   ///< W / length^2 through each face of the box
  float albedo[6];     ///< part that each face gives back of what leaves through it
  MultigridLevel rows; ///< how conductances lie in memory
} DiffusionLayout;

/// What is known of each cell of the box's faces (Medium/BoxFaces.h), by the solution and by the sweep, W.
enum
{
  BorderNet = 0,        ///< out less in, without the transport correction: right from voxel to voxel
  BorderShare = 1,      ///< the transport correction of that: right for a face of the box as a whole
  BorderSeeming = 2,    ///< out in the sweep, an estimate
  BorderWeight = 3,     ///< of the transport correction, where the voxel has several such faces, else -1; no power
  BorderCame = 4,       ///< came in in the sweep
  BorderWholeShare = 5, ///< the correction before the face gives back its part
  BorderValues = 6
};

/// Light by cells of the box's faces, W: rows of the array `faces`.
enum
{
  FaceCame = 0,  ///< came back in the sweep
  FaceGiven = 1, ///< of it, what comes back of light that was not swept
  FaceLeft = 2,  ///< left in the sweep
  FaceLeaves = 3 ///< leaves by the solution
};
SHARED_END
