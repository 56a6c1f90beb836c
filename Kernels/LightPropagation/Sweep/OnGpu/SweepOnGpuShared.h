// Arguments of the kernels of the sweep on GPUs, shared with C++.
#pragma once

#include "Device/SharedTypes.h"
#include "LightPropagation/Sweep/SweepShared.h"

SHARED_BEGIN
/// Lane: all rays that march in one sense along an axis. They cross one plane of the lane per launch, with one
/// work-item per voxel of the plane. The indices of maps and arrays are those in the buffers of the lane's batch
/// (GpuLanes.h).
typedef struct
{
  PlaneInfo planes;
  int axis;
  int backward; ///< 0: marches from the lower end of the axis, 1: from the upper end
  /// Number of planes that rays cross in the laps in which they start. There is one such lap, or several on a short
  /// periodic axis
  int patternPlanes;
  int around;               ///< whether the marching axis is periodic, so rays cross a voxel repeatedly
  int periodicU, periodicV; ///< whether the axes u and v, normal to the marching axis, are periodic
  int firstBundle, bundles;
  /// Index of the lane's first entry in the array of crossings (moves and segments of each bundle), [plane][bundle].
  int crossings;
  /// Index of the lane's first ray among the rays of all lanes: in `entering` (a float4 per ray and channel),
  /// `functions` and maps
  int firstRay;
  ulong map; ///< index of the first float of the lane's maps, [ray][channel][v][u]
  /// Index of the first float of the lane's path integrals; these are [function][channel][voxel] with angular moments
  ulong path;
  /// The lane's first float has the index 6 * deposit in the partial currents, and the index 3 * deposit in the net
  /// flux
  ulong deposit;
  /// Index of the first float of the lane's escaped power, [plane][-u, +u, -v, +v][channel][position along the face]
  ulong escaped;
  int positions; ///< number of positions along a face in `escaped`
  int rays;
  /// Index of the first float of the rays at the sides of the lane's planes, [plane][ray][channel] (SIDE_FLOATS), if
  /// light is given or summed per cell of the faces
  ulong sides;
} SweepLane;

/// Memory layout of the cells of the box's faces (BoxFaces.h) for a lane (the rays of one sense along an axis), within
/// one channel. On the faces -u, +u, -v, +v the cell at position i of plane p has the index first + p * plane + i *
/// along. `start` and `end` are the indices of the first cells of the faces where the lane's rays start and end,
/// [v][u].
typedef struct
{
  int first[4], plane[4], along[4];
  int start, end;
  /// 1: incident radiance is given per cell, in addition to the radiance that is uniform over each face
  int in;
  int spread; ///< 1: escaped power is spread over the cells that a ray represents (Deposit::spreadsAside)
} LaneFaceInfo;

/// Arguments of a launch of the kernel `cross_plane`.
typedef struct
{
  ulong sigmaFirst, sourceFirst; ///< index of the first channel's first value in sigma_t, in source
  /// Index of the first channel's first value in `path`. The index in the net flux is three times this number, and that
  /// in the partial currents six times
  ulong putFirst;
  ulong stride; ///< floats from one channel to the next
  /// For a streamed volume: index of the slot's first float in the array of the source, and in that of the path
  /// integrals; 0 if the volume is not streamed. A slot is a buffer for one slice
  ulong slotSource, slotPath;
  /// For a streamed volume: index of the slot's first float in arrays with one value per voxel and channel; 0 if the
  /// volume is not streamed
  ulong slotValues;
  int slotPlane; ///< index in the box of the slot's first plane; 0 if the volume is not streamed
  int plane;     ///< index of the plane that is crossed, counted from where rays start
  /// Index of the lane whose rays the work-items with get_global_id(2) = 0 carry; larger ids carry the following lanes
  int firstLane;
  /// 1: a further lap around a periodic axis, for which the array of crossings begins with this launch's lanes; 0: a
  /// lane's crossings begin at index SweepLane::crossings
  int ofRound;
  int firstChannel;
  int shines; ///< 1: the medium has a source (emission or scattered light)
  /// 1: lanes add to the arrays, because lanes run one after another or cross voxels repeatedly around a periodic axis;
  /// 0: each lane overwrites its own arrays
  int adds;
  /// 1: the moments of path integrals are in the volume's array, laid out as `moments`; 0: in the lane's own array,
  /// [function][channel][voxel]
  int inPlaces;
  int outerSides;       ///< bit i: light that crosses side i leaves the domain; used with SIDES
  MomentPlaces moments; ///< memory layout of the moments of source and path
} PlaneLaunch;
SHARED_END

#ifdef __OPENCL_C_VERSION__
// Number of floats per ray, channel and plane of a lane that store the power of the rays which enter or leave through
// the sides, [plane][ray][channel][SIDE_FLOATS]; planes are counted from where rays start. There is one float per
// column of the plane for the rays that cross the face normal to v, one per row for those that cross the face normal to
// u, and one for the ray that crosses both at once.
#define SIDE_FLOATS(plane) ((plane)->sizeU + (plane)->sizeV + 1)

// Index in the box of the k-th plane that the rays of a lane (one sense along an axis) cross, k >= 0.
static int plane_of(const __global SweepLane* lane, int k)
{
  // If k is beyond the planes of the axis, rays are in another lap around a periodic axis
  const int of_axis = k % lane->planes.sizeP;
  return lane->backward ? lane->planes.sizeP - 1 - of_axis : of_axis;
}
#endif
