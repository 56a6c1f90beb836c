// Shared by C++ and the kernels of EmissionRays.cl and EmissionFans.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// A medium and the bounding box of a localised emission in it, as kernel argument.
typedef struct
{
  int size[3];
  float spacing[3];
  int sourceFirst[3], sourceSize[3]; ///< bounding box of the emission: lowest voxel, size in voxels
  int fewest;                        ///< initial number of rays per voxel, a power of two, at least 32
  int fewestClose;                   ///< initial number of rays per voxel in the emitting box and next to it
  /// Accepted difference between the light of the first and the second half of a voxel's rays, relative to the sum
  float uneven;
  int mirrored; ///< bit mask of axes across which the scene is symmetric (EmissionRays.h)
  /// Distance of a voxel from the emitting box's centre, half voxels, below which it traces its own rays instead of
  /// sharing fans of rays
  int near;
} EmissionInfo;

/// Fans of rays from points in the emitting box into one 24th of the sphere of directions. The axes of the scene are
/// permuted and reflected so that the voxels are farthest from the emitting box along the first axis, and all three
/// axes point away from the box.
typedef struct
{
  int order[3], turned; ///< permutation of the scene's axes, and bit mask of the reflected ones
  /// First voxel far enough from the emission to use fans, along each axis of the permuted scene
  int first[3];
  /// Number of layers, across the first axis, of voxels far enough from the emission to use fans, up to the face of the
  /// grid; 0: none
  int layers;
  /// Index of the first cell of the face at the end of the layers; the cells of all faces of the grid are numbered
  /// together
  int faceFirst;
  /// Number of rays of a fan along the second axis (lines, a multiple of 16) and the third axis (rows)
  int lines, rows;
  float firstLine, firstRow; ///< smallest tangents along the second and third axis, voxels per layer
  float spacing;             ///< difference of the tangents of adjacent rays along either axis
  int bandFirst, bandRows;   ///< first of the rows of rays that one launch of follow_fan() traces, and their number
  int pointFirst, points;    ///< first of the fans that one launch of follow_fan() traces, and their number
  /// Number of fans in the current set that belong to the first half of all fans, which is compared with the second
  /// half; 0 if the first half is complete
  int halfOfPoints;
  int strides[3], base; ///< strides, and index of voxel (0, 0, 0), of the copy of sigma_t in the permuted scene
  float emitted;        ///< integral of emission over the emitting box, W / sr
} FanInfo;

enum
{
  FanMargin = 16, ///< unused floats before and after sigma_t's copy, which vector loads may read
  /// Floats per origin of a fan: position along the three permuted axes, voxels; depth in a layer at which light is
  /// sampled, 0 to 1; offsets added to the tangents of lines and of rows, as multiples of `spacing`.
  FanPointFloats = 6
};
SHARED_END
