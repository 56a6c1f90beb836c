// Shared by C++ and the kernels of LampBeams.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  /// Tallies per row of beams: entered, escaped through each of 6 faces, stranded (in flight at the end), emitted.
  LampRowSums = 9
};

/// Fixed-point units that represent a lamp's full power: 2^56; a sum of 64 times that power still fits.
#define LampPowerUnits 72057594037927936.0f

/// A lamp and the box. Lengths along axis a are in units of `spacing[a]`, unless said otherwise.
typedef struct
{
  int size[3];
  int first[3], stored[3];         ///< voxels that the arrays cover: all, or a block and its halo
  int followed[3], followedEnd[3]; ///< voxels in which beams are traced
  int periodic[3];
  int images[3]; ///< periodic images to either side whose light is corrected together with the rectangle's, by axis
  float spacing[3];
  float direction[3];       ///< unit, in space
  float cosine, sineSquare; ///< cosine and squared sine of the cone's half angle
  float intensity; ///< fraction of the traced power (LampOnGrid::Share) per steradian; at normal emission if LAMBERT
  float scale;     ///< fixed-point units per length
  float diagonal;  ///< diagonal of a voxel, length
  /// As in BoxFaceLayout: first cell by face; step by axis of the face, along each axis.
  int faceFirst[6], faceStep[3][3];
} LampInfo;

/// The beams of one pyramid at one tangent v.
typedef struct
{
  int axis, up; ///< marching axis, and 1: towards +, 0: towards -
  /// Reference tangents of the pyramid, to which the others are relative: the axis of a narrow cone.
  float baseU, baseV;
  float crossing[3]; ///< cross product of the reference direction and the cone's axis: along the marching axis, u, v
  float tangentU, tangentV; ///< of the first beam's centre, relative to the base; tangentV is that of all beams
  float widthU, widthV;     ///< width of a beam, in tangents
  int count;                ///< number of beams along u
  int outside;              ///< 1: the lamp is outside the box along the marching axis
  float from;               ///< start of the beams: the lamp's position along the axis, or the box's face, voxels
  float startU, startV;     ///< centre of the first beam at the start, voxels
  float openU, openV;       ///< width of a beam at the start, voxels
  int skipped;              ///< layers that beams cross before anything is counted and deposited
  int layers;               ///< layers that beams cross in all, at most
  int beside;    ///< bits 1, 2: the lamp is beside the box along u, v, so that beams may enter through the faces there
  float share;   ///< fraction of the lamp's power that the beams' origin emits
  float part[3]; ///< centre of the part of a rectangle that the beams come from
  /// Squared distances from it beyond which voxels receive its light, and beyond which beams may reach such voxels.
  float partFrom, partSeen;
  float whole[3]; ///< the same for the larger part that was divided into this one; there its light ends
  float wholeFrom, wholeSeen;
} BeamRow;

/// A beam between two of its steps, as it is sent from one block to another.
typedef struct
{
  int row, beam;   ///< its row, and its number in the row
  int layer, step; ///< the next layer, counted from the beam's first one, and the next step in it
  int begun;       ///< 0: it has not started
  float left;      ///< remaining power, fraction of the traced power of the lamp
  float rest;      ///< compensation of rounding errors in `left`
  float stays[2];  ///< fraction of its cross-section that has not left the box, along u and v
  float free;      ///< power that would remain in vacuum
  int voxel[3];    ///< voxel that contains its centre, or the nearest one of the grid
  int ended;       ///< 1: it has left the grid
} BeamOnItsWay;

/// A rectangular lamp, and the voxels of a grid, or of a block of it, that it illuminates. In lengths.
typedef struct
{
  float corner[3];   ///< corner of the block relative to the rectangle's centre, along its two edges and its normal
  float edges[3][3]; ///< unit vectors along the two edges and the normal
  float reach[2];    ///< half the edge lengths
  int size[3];       ///< size of the block, voxels
  /// Size of the whole grid, voxels, and number of periodic images to either side that also emit.
  int period[3], images[3];
  float spacing[3];
  float path;  ///< path per voxel and per steradian of the visible rectangle, W length, for a lamp of 1 W
  float scale; ///< fixed-point units per length
} RectangleInfo;
SHARED_END
