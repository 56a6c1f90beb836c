// Shared by C++ and the kernels of the sweep on GPUs: their arguments.
#pragma once

#include "Device/SharedTypes.h"
#include "LightPropagation/Sweep/SweepShared.h"

SHARED_BEGIN
/// All rays that march one way along an axis: they cross a plane of it in one launch, a work-item a voxel of the plane.
/// Its maps and arrays are those of its batch (GpuLanes.h).
typedef struct
{
  PlaneInfo planes;
  int axis;
  int backward;             ///< 0 marches from the lower end of the axis, 1 from the upper
  int patternPlanes;        ///< that rays of a sweep start in: those of the axis, or of several laps round it
  int periodicU, periodicV; ///< across it
  int firstBundle, bundles;
  int crossings; ///< where those of its first plane begin, [plane][bundle]
  int firstRay;  ///< of all lanes' rays, each a float4 [channel] in `entering`; its maps begin there, too
  ulong map;     ///< floats before its maps, [ray][channel][v][u]
  ulong path;    ///< floats before its path, or, with angular moments, [function][channel][stride]
  ulong deposit; ///< the same of currents over six, and of flux over three
  ulong escaped; ///< where its tally begins, [plane][-u, +u, -v, +v][channel][position along the face]
  int positions; ///< of that
  int rays;
  ulong sides; ///< floats before its sides, [plane][ray][channel] (VoxelSides.cl), where light comes or goes by cells
} SweepLane;

/// Where the cells of the box's faces are for a lane (BoxFaces.h), of a channel: those of the faces -u, +u, -v, +v as
/// FaceInfo has them, and those of the faces where its rays start and end, [v][u].
typedef struct
{
  int first[4], plane[4], along[4];
  int start, end;
} LaneFaceInfo;

/// A launch of the kernel `cross_plane`.
typedef struct
{
  ulong sigmaFirst, sourceFirst; ///< where the first channel begins
  ulong putFirst;                ///< the same in `path` (flux: three times, currents: six times that)
  ulong stride;                  ///< from one channel to the next
  ulong slotSource, slotPath;    ///< of slots that slices of the volume lie in: floats before that of source, of path
  ulong slotValues;              ///< and before that of one value a voxel and channel; 0, where the volume lies whole
  int slotPlane;                 ///< of the box's planes, that the slot begins with; 0, where the volume lies whole
  int plane;                     ///< from where rays start
  int firstLane;                 ///< that of the first work-items
  int ofRound;                   ///< 1: the crossings begin with this launch's lanes, and planes; 0: see SweepLane
  int firstChannel;
  MomentPlaces moments; ///< of source and path, where light has angular moments
} PlaneLaunch;
SHARED_END
