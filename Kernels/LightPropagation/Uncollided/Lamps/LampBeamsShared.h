// Arguments of the kernels of LampBeams.cl and LampSums.cl, shared with C++.
#pragma once

#include "Device/SharedTypes.h"

SHARED_BEGIN
enum
{
  /// Number of tallies per row of beams: the powers that entered, that escaped through each of 6 faces, that are in
  /// transit at the end, and that were emitted.
  LampRowSums = 9
};

/// Number of fixed-point units, 2^56, that represents the traced power (the share of a lamp's power that may reach the
/// box). A sum of 64 times the traced power still fits in 64 bits.
#define LampPowerUnits 72057594037927936.0f

/// A lamp and the box that its beams cross. Lengths along axis a are in units of `spacing[a]`, unless said otherwise.
typedef struct
{
  int size[3];
  int first[3], stored[3];         ///< voxels that the arrays cover: all, or a block and its halo
  int followed[3], followedEnd[3]; ///< voxels in which beams are traced
  int periodic[3];
  /// Number of periodic images of a rectangular lamp, on either side along each axis, whose light in vacuum is
  /// corrected together with that of the lamp itself
  int images[3];
  float spacing[3];
  float direction[3];       ///< axis of a spot's cone or normal of a rectangle, unit vector in space
  float cosine, sineSquare; ///< cosine and squared sine of the half angle of a spot's cone
  /// Fraction of the traced power (LampOnGrid::Share) that is emitted per steradian; if LAMBERT, its value along the
  /// normal
  float intensity;
  /// Fixed-point units per unit of the path integral, which is a fraction of the traced power times length
  float scale;
  float diagonal; ///< diagonal of a voxel, in units of length
  /// Layout of the cells of the box's faces, as in BoxFaceLayout: faceFirst is the index of the first cell of each
  /// face; faceStep[a][b] is the index difference between neighbouring cells along axis b in a face normal to axis a.
  int faceFirst[6], faceStep[3][3];
} LampInfo;

/// Row of beams: the beams of one pyramid at one tangent v, which differ in their tangent u.
typedef struct
{
  int axis, up; ///< marching axis of the pyramid, and sense: 1 towards +, 0 towards -
  /// Reference tangents of the pyramid, to which tangentU and tangentV are relative: those of the cone's axis if the
  /// cone is narrow; otherwise 0
  float baseU, baseV;
  /// Components along the marching axis, u and v of the cross product of two directions: that of the reference
  /// tangents, and that of the cone's axis; 0 if the two are parallel, as for a narrow cone
  float crossing[3];
  /// Tangents of the first beam's centre, relative to the reference tangents baseU, baseV; all beams have the same
  /// tangentV
  float tangentU, tangentV;
  float widthU, widthV; ///< width of a beam along u and v, as a difference of tangents
  int count;            ///< number of beams along u
  int outside;          ///< 1: the lamp is outside the box along the marching axis
  float from;           ///< start of the beams: the lamp's position along the axis, or the box's face, voxels
  float startU, startV; ///< centre of the first beam at the start, voxels
  float openU, openV;   ///< width of a beam at the start, voxels
  int skipped;          ///< number of layers of voxels that beams cross before they deposit light and are tallied
  int layers;           ///< maximum number of layers of voxels that beams cross
  /// Bit 0: the lamp is outside the box along u, so that beams may enter through the faces normal to u. Bit 1: the same
  /// along v
  int beside;
  float share;   ///< fraction of the lamp's power emitted by the point from which the beams originate
  float part[3]; ///< centre of the part of a rectangle that this point represents
  /// Squared distances from `part`. partFrom: this row's beams do not light nearer voxels. partSeen: a beam crosses no
  /// voxel that it lights as long as its centre is nearer.
  float partFrom, partSeen;
  float whole[3]; ///< centre of the larger part of which `part` is a subdivision
  /// Squared distances from `whole`. wholeFrom: this row's beams do not light farther voxels. wholeSeen: a beam crosses
  /// no voxel that it lights once its centre is farther.
  float wholeFrom, wholeSeen;
} BeamRow;

/// State of a beam between two of its steps, as sent from one block to another.
typedef struct
{
  int row, beam;   ///< index of the beam's row, and of the beam in the row
  int layer, step; ///< next layer, counted from the beam's first layer, and next step in it
  int begun;       ///< 0: the beam has not started
  float left;      ///< remaining power, as a fraction of the traced power of the lamp
  float rest;      ///< compensation of rounding errors in `left`
  float stays[2];  ///< fraction of the beam's cross-section that has not left the box, along u and v
  float free;      ///< power that would remain in vacuum, as a fraction of the traced power
  int voxel[3];    ///< voxel that contains the beam's centre, or the nearest voxel of the grid
  int ended;       ///< 1: the beam has left the grid
} BeamOnItsWay;

/// A rectangular lamp, and the voxels of a grid, or of a block of it, that it illuminates. Lengths are in the dataset's
/// unit.
typedef struct
{
  float corner[3];   ///< corner of the block relative to the rectangle's centre, along its two edges and its normal
  float edges[3][3]; ///< unit vectors along the two edges and the normal
  float reach[2];    ///< half the lengths of the two edges
  int size[3];       ///< size of the block, voxels
  /// Size of the whole grid, voxels; number of periodic images of the lamp, on either side along each axis, that also
  /// emit.
  int period[3], images[3];
  float spacing[3];
  /// Path integral in a voxel in vacuum, for a lamp of 1 W, divided by the solid angle that the rectangle subtends at
  /// the voxel, W length / sr
  float path;
  float scale; ///< fixed-point units per unit of the path integral, length
} RectangleInfo;
SHARED_END
