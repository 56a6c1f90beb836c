// Shared by C++ and the kernels of LampBeams.cl.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  LampRowSums = 9 ///< tallies of a row of beams: entered, escaped through each face, stranded, ...
};

/// Fixed point units of all of a lamp's power: 2^56, beside which 64 rounds of it fit.
#define LampPowerUnits 72057594037927936.0f

/// A lamp in its box. Lengths along axis a are in voxels of `spacing[a]`.
typedef struct
{
  int size[3];
  int first[3], stored[3];         ///< the voxels that arrays hold: all, or those of a block and some beside it
  int followed[3], followedEnd[3]; ///< and those in which beams are followed (LampInBlock.cl)
  int periodic[3];
  int images[3]; ///< of a rectangle in a periodic box, to either side, that count as it does
  float spacing[3];
  float direction[3];               ///< unit, in space
  float cosine, sineSquare;         ///< of the cone's half angle
  float intensity;                  ///< part of the lamp's share, per steradian; at normal emission where LAMBERT
  float scale;                      ///< fixed point units per length
  float diagonal;                   ///< of a voxel
  int faceFirst[6], faceStep[3][3]; ///< as BoxFaceLayout has them: of each face; of an axis' faces, along each axis
} LampInfo;

/// The beams of one pyramid at one tangent v.
typedef struct
{
  int axis, up;             ///< marches along the axis, up or down
  float baseU, baseV;       ///< tangents of the pyramid that others are relative to: a narrow cone's axis
  float crossing[3];        ///< base's direction x the cone's axis, along axis, u, v
  float tangentU, tangentV; ///< of the first beam's middle, from the base; v's for all
  float widthU, widthV;     ///< of a beam, in tangents
  int count;                ///< of beams along u
  int outside;              ///< the lamp is outside the box's layers
  float from;               ///< where beams begin: the lamp's place along the axis, or the box's face
  float startU, startV;     ///< there the first beam's middle, voxels
  float openU, openV;       ///< and there the width of a beam
  int skipped;              ///< layers that they go before anything is counted and put down
  int layers;               ///< that they go in all, at most
  int beside;               ///< 1, 2: the lamp is beside the box along u, v; beams may enter through faces there
  float share;              ///< of the lamp's power, that the point has from which they come
  float part[3];            ///< of a rectangle's part: its middle,
  float partFrom, partSeen; ///< the square of the distance from which on voxels have its light, and where beams may
  float whole[3];           ///< come to them; the same of the part that was halved for it, from where on they have not
  float wholeFrom, wholeSeen;
} BeamRow;

/// A beam between two of its steps, on its way from one block of a grid to another.
typedef struct
{
  int row, beam;   ///< which it is
  int layer, step; ///< that comes next, counted from its first layer
  int begun;       ///< 0: it has not set off
  float left;      ///< of its power
  float rest;      ///< too small to be seen in it
  float stays[2];  ///< of its cross-section, along u and v, what has not left the box
  float free;      ///< what would be left of it in vacuum
  int voxel[3];    ///< that its middle is in then, or the nearest of the grid
  int ended;       ///< 1: it has left the grid
} BeamOnItsWay;

/// A rectangular lamp and the voxels of a grid, or a block of it, in its light. Lengths.
typedef struct
{
  float corner[3];          ///< of the block, from the rectangle's middle: along its two edges and its normal
  float edges[3][3];        ///< unit vectors along these
  float reach[2];           ///< half of the edges' lengths
  int size[3];              ///< of the block
  int period[3], images[3]; ///< voxels of the whole grid, and how many images to either side shine, too
  float spacing[3];
  float path;  ///< of a lamp of 1 W, W length in a voxel and steradian
  float scale; ///< fixed point units per length
} RectangleInfo;
SHARED_END
