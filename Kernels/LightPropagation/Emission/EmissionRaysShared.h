// Shared by C++ and the kernels of EmissionRays.cl and EmissionFans.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// A medium and the bounding box of a localised emission in it.
typedef struct
{
  int size[3];
  float spacing[3];
  int sourceFirst[3], sourceSize[3]; ///< the emitting box
  int fewest;                        ///< initial number of rays per voxel; a power of two, at least 32
  int fewestClose;                   ///< the same for voxels in the emitting box and next to it
  float uneven;                      ///< accepted difference of the two halves of a voxel's rays, relative to their sum
  int mirrored;                      ///< bit mask of axes across which the scene is symmetric (EmissionMirrors.h)
  int near;                          ///< distance from the box's centre, half voxels, below which fans are not used
} EmissionInfo;

/// Fans of rays from points in the emitting box into one 24th of space. The axes of the scene are permuted and
/// reflected so that the first one is that along which the voxels are farthest from the box, and all three point away
/// from it.
typedef struct
{
  int order[3], turned;      ///< permutation of the scene's axes, and bit mask of the reflected ones
  int first[3];              ///< first far voxel along each axis, in the permuted scene
  int layers;                ///< number of layers of voxels along the first axis, up to the face at its end
  int faceFirst;             ///< that face's first cell
  int lines, rows;           ///< number of rays of a fan along the second and third axis; lines is a multiple of 16
  float firstLine, firstRow; ///< smallest tangents, in voxels per layer
  float spacing;             ///< spacing of lines and of rows, in tangents
  int bandFirst, bandRows;   ///< the rows that are in memory at a time
  int pointFirst, points;    ///< the fans that are in memory at a time
  int halfOfPoints;          ///< number of fans in the first half
  int strides[3], base;      ///< strides of the copy of sigma_t for the fans, in the permuted scene
  float emitted;             ///< integral of emission over the box
} FanInfo;

enum
{
  FanMargin = 16, ///< padding before and behind the voxels in the copy of sigma_t: it is loaded, but never used
  /// Floats per origin of a fan: position along the permuted axes, voxels; sample depth in a layer; offsets added to
  /// the tangents, in spacings.
  FanPointFloats = 6
};
SHARED_END
