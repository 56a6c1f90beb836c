// Shared by C++ and the kernels of EmissionRays.cl and EmissionFans.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
/// A medium and the box of what shines in it.
typedef struct
{
  int size[3];
  float spacing[3];
  int sourceFirst[3], sourceSize[3]; ///< the box of what shines
  int fewest;                        ///< rays of a voxel to it, at first; a power of two, at least 32
  int fewestClose;                   ///< the same of voxels in it and next to it
  float uneven;                      ///< difference of two halves of them, to their sum, that will do
  int mirrored;                      ///< bits of axes across whose middle all is alike (EmissionMirrors.h)
  int near;                          ///< half voxels from the box's middle, below which no fan is asked
} EmissionInfo;

/// Fans of rays into one 24th of space, from points in the box of what shines. The scene is turned so that the first
/// axis is that along which the voxels lie farthest from the box, and all three lead away from it.
typedef struct
{
  int order[3], turned;      ///< axes of the scene, and bits of those that are turned round
  int first[3];              ///< the first voxel along each axis, in the turned scene
  int layers;                ///< of voxels along the first axis, up to the face that it leads to
  int faceFirst;             ///< that face's first cell
  int lines, rows;           ///< of a fan along the second and third axis; lines a multiple of 16
  float firstLine, firstRow; ///< tangents, voxels a layer
  float spacing;             ///< of lines and of rows, in tangents
  int bandFirst, bandRows;   ///< the rows that are kept at a time
  int pointFirst, points;    ///< of the fans that are kept at a time
  int halfOfPoints;          ///< the first half of all
  int strides[3], base;      ///< of sigma_t as it is laid out for the fans, in the turned scene
  float emitted;             ///< integral of emission over the box
} FanInfo;

enum
{
  FanMargin = 16, ///< voxels before and behind those that are laid out for fans: one is loaded, but never counts
  FanPointFloats =
    6 ///< place along the turned axes, voxels; depth in a layer; what is added to the tangents, in spacings
};
SHARED_END
