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
  float uneven;                      ///< accepted difference of the two halves of a voxel's rays, relative to their sum
  int mirrored;                      ///< bit mask of axes across which the scene is symmetric (EmissionMirrors.h)
  int near; ///< distance from the emitting box's centre, half voxels, below which fans are not used
} EmissionInfo;

/// Fans of rays from points in the emitting box into one 24th of the sphere of directions. The axes of the scene are
/// permuted and reflected so that the voxels are farthest from the emitting box along the first axis, and all three
/// axes point away from the box.
typedef struct
{
  int order[3], turned;      ///< permutation of the scene's axes, and bit mask of the reflected ones
  int first[3];              ///< first far voxel along each axis, in the permuted scene
  int layers;                ///< number of layers of far voxels across the first axis, up to the face of the grid
  int faceFirst;             ///< first cell of the face at the end of the layers, see FanFaceFirst
  int lines, rows;           ///< number of rays of a fan along the second and third axis; lines is a multiple of 16
  float firstLine, firstRow; ///< smallest tangents along the second and third axis, voxels per layer
  float spacing;             ///< difference of tangents between adjacent lines, and between adjacent rows
  int bandFirst, bandRows;   ///< first row in memory, and number of rows in memory
  int pointFirst, points;    ///< first fan in memory, and number of fans in memory
  int halfOfPoints;          ///< number of fans in the first of the two halves that are compared
  int strides[3], base;      ///< strides, and index of voxel (0, 0, 0), of the copy of sigma_t in the permuted scene
  float emitted;             ///< integral of emission over the emitting box, W / sr
} FanInfo;

enum
{
  FanMargin = 16, ///< unused floats before and after sigma_t's copy, which vector loads may read
  /// Floats per origin of a fan: position along the three permuted axes, voxels; depth in a layer at which light is
  /// sampled, 0 to 1; offsets added to the tangents of lines and of rows, in units of `spacing`.
  FanPointFloats = 6
};
SHARED_END
