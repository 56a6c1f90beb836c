#pragma once

#include "Device/Buffer.h"

namespace tyndall
{
/// Output arrays of a sweep. All of them are added to.
struct Deposit
{
  /// Path integral, W length, [channel][stride]; with angular moments [function][channel][stride], where the first
  /// function is the path integral
  const Buffer<float>* path = nullptr;
  const Buffer<float>* flux = nullptr; ///< net flux, W length, [channel][x, y, z][stride]; null: not computed
  /// Power that enters each voxel through each of its faces (numerics.md, Eq. (29)), W, [channel][-x, +x, -y, +y, -z,
  /// +z][stride]; null: not computed
  const Buffer<float>* partialCurrents = nullptr;
  /// First moments of the deposit, W length, [channel][-x, +x, -y, +y, -z, +z][stride], added to by lamps: path
  /// integral times the distance from the voxel's centre towards each face, in voxels (0 to 1/2), of the mean position
  /// at which its light is lost (numerics.md, Eq. (37)). 0 in voxels thinner than ThinForFirstMoments. Null: not
  /// computed.
  const Buffer<float>* firstMoments = nullptr;
  /// Escaped power, W, by cell of the box's faces, [channel][cell] (BoxFaces.h); null: not computed. Requires that the
  /// whole grid is swept.
  const Buffer<float>* faceOut = nullptr;
  /// True: a ray nearly parallel to a face, which meets it only every few cells, spreads its power over the cells it
  /// represents. False: all its power leaves through the cell that it meets, as for incident light.
  bool spreadsAside = false;
};

/// Optical thickness of a voxel below which the light of lamps is taken as lost uniformly in it.
constexpr float ThinForFirstMoments = 0.02f;
}
