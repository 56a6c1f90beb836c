// Shared by C++ and the kernels of the sweep on GPUs: kernel arguments.
#pragma once

#include "Device/SharedTypes.h"
#include "LightPropagation/Sweep/SweepShared.h"

SHARED_BEGIN
/// A lane: all rays that march one way along an axis. They cross one of its planes per launch, one work-item per voxel
/// of the plane. Maps and arrays belong to the lane's batch (GpuLanes.h).
typedef struct
{
  PlaneInfo planes;
  int axis;
  int backward; ///< 0 marches from the lower end of the axis, 1 from the upper
  /// Planes in which the rays of a sweep start: those of the axis, or of several laps round a periodic axis
  int patternPlanes;
  int around;               ///< whether the marching axis is periodic, so rays cross a voxel repeatedly
  int periodicU, periodicV; ///< whether the axes across the marching axis are periodic
  int firstBundle, bundles;
  int crossings; ///< index of the first crossing of its first plane, [plane][bundle]
  /// Index of its first ray among the rays of all lanes: in `entering` (a float4 per ray and channel), `functions`
  /// and maps
  int firstRay;
  ulong map;     ///< index of the first float of its maps, [ray][channel][v][u]
  ulong path;    ///< index of the first float of its path integrals; with angular moments [function][channel][stride]
  ulong deposit; ///< index of its first float in the currents, divided by 6, and in the flux, divided by 3
  /// Index of the first float of its escaped power, [plane][-u, +u, -v, +v][channel][position along the face]
  ulong escaped;
  int positions; ///< number of positions along a face in `escaped`
  int rays;
  /// Index of the first float of its sides, [plane][ray][channel] (LanePlane.cl), if light is given or counted by
  /// cells
  ulong sides;
} SweepLane;

/// Memory layout of the cells of the box's faces (BoxFaces.h) for a lane, within one channel: the faces -u, +u, -v, +v
/// as in FaceInfo, and the faces where the lane's rays start and end, [v][u].
typedef struct
{
  int first[4], plane[4], along[4];
  int start, end;
  int in;     ///< 1: incident light is given by cells, in addition to that which is uniform over each face
  int spread; ///< 1: Deposit::spreadsAside
} LaneFaceInfo;

/// A launch of the kernel `cross_plane`.
typedef struct
{
  ulong sigmaFirst, sourceFirst; ///< index of the first channel's first value
  ulong putFirst;                ///< the same in `path` (in the flux three times, in the currents six times this index)
  ulong stride;                  ///< floats from one channel to the next
  ulong slotSource, slotPath;    ///< for a streamed volume: index of the first float of the slot of source, of path
  ulong slotValues; ///< the same for arrays with one value per voxel and channel; 0 if the volume is not streamed
  int slotPlane;    ///< index in the box of the slot's first plane; 0 if the volume is not streamed
  int plane;        ///< plane that is crossed, counted from where rays start
  int firstLane;    ///< lane of the first work-items
  /// 1: the array of crossings starts with those of this launch's lanes, for a lap round a periodic axis; 0: see
  /// SweepLane::crossings
  int ofRound;
  int firstChannel;
  int shines; ///< 1: the medium has a source (emission or scattered light)
  /// 1: lanes add to the arrays, one after the other or repeatedly round a periodic axis; 0: each lane writes its own
  int adds;
  int inPlaces;         ///< 1: moments lie as in the volume; 0: [function][channel][stride] in the lane's own arrays
  int outerSides;       ///< bit i: light that crosses side i leaves the domain; if SIDES
  MomentPlaces moments; ///< layout of the moments of source and path
} PlaneLaunch;
SHARED_END
