#pragma once

#include "Viewing/MediumRayCaster.h"

#include <vector>

namespace tyndall
{
/// What is to be added to the light that a march finds from where it enters the box through thick voxels: the march
/// takes the light of a voxel from centre to centre, and from the outermost centre on as constant; seen is the light of
/// the last mean free path. The radiance that leaves, as solvers tell it (`surface`), less what the march makes of the
/// same place, step by step. From ThickAtSurface on, all of it where voxels are twice as thick, and where some mean
/// free paths of medium are behind: what shines through thin media is not that of a half-space.
///
/// W / (length^2 sr), [cosine][face][row][cell of the row], each face with a border of one cell that repeats the
/// outermost. Empty where there is nothing to add.
///
/// @param step  of the march, voxels
std::vector<cl_float4> SurfaceLight(const Medium& medium, const SolvedLight& light, double step);
}
