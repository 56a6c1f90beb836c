#pragma once

#include "Device/OpenCL.h"
#include "Viewing/Scene/GridBlock.h"
#include "Viewing/Scene/SolvedLight.h"

#include <vector>

namespace tyndall
{
/// What is to be added to the light of a march that enters the box through thick voxels (numerics.md, Eq. (112)): the
/// radiance that leaves there, as solvers give it (`surface`), less what the march finds in the same place, which takes
/// a thick voxel's light from centre to centre. From ThickAtSurface on, all of it where voxels are twice as thick, and
/// where some mean free paths of medium are behind: light through thin media is not that of a half-space.
///
/// W / (length^2 sr), [cosine][face][row][cell of the row], each face with a border of one cell that repeats the
/// outermost. Empty where there is nothing to add.
///
/// @param step   of the march, voxels
/// @param block  of which the medium is one: only where it is at a face of the whole; null: of none. It has
///   VoxelsBehindSurface from there on, or all of the whole's
std::vector<cl_float4> SurfaceLight(
  const Medium& medium, const SolvedLight& light, double step, const GridBlock* block = nullptr);
}
