#pragma once

#include "Device/Buffer.h"

namespace tyndall
{
/// Where light is put down: everything is added to.
struct Deposit
{
  /// W length, [channel][stride], added to; of sweeps with angular moments [function][channel][stride], the first of
  /// which is the path itself
  const Buffer<float>* path = nullptr;
  const Buffer<float>* flux = nullptr; ///< W length, [channel][x, y, z][stride], added to; null: not wanted
  /// W, [channel][-x, +x, -y, +y, -z, +z][stride], added to: power that enters each voxel through each of its faces
  /// (numerics.md, Eq. (29)); null: not wanted
  const Buffer<float>* partialCurrents = nullptr;
  /// First moments of the deposit, W length, [channel][-x, +x, -y, +y, -z, +z][stride], added to by lamps: the
  /// distance, in voxels from the middle towards each face (0 to 1/2), of the mean place where the light is lost that
  /// `path` stands for, times its path (numerics.md, Eq. (37)). 0 in voxels thinner than ThinForFirstMoments. Null: not
  /// wanted.
  const Buffer<float>* firstMoments = nullptr;
  /// W that leaves through each cell of the box's faces, [channel][cell] (BoxFaces.h), added to; null: not wanted. The
  /// whole grid is swept then.
  const Buffer<float>* faceOut = nullptr;
  /// Rays that run nearly along a face reach it every so many cells, and stand for what leaves through all of them:
  /// their power is spread over these. False: it leaves through the cell that a ray comes to, as light comes in.
  bool spreadsAside = false;
};

/// Optical length of voxels below which lamps' light is taken as lost evenly.
constexpr float ThinForFirstMoments = 0.02f;
}
