#pragma once

#include "Device/OpenCL.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Medium/Medium.h"
#include "Viewing/Scene/GridBlock.h"
#include "Viewing/Scene/SolvedLight.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Voxels of a face's rows, and how many rows it has: along y and z, x and z, or x and y.
std::array<int, 2> FaceSize(const Grid& grid, int face);

/// Values of the cells of the box's faces (BoxFaces.h), each face with a border of one cell that repeats the outermost.
std::vector<cl_float4> WithBorders(const Grid& grid, const std::vector<cl_float4>& cells);

/// Radiance that the faces of the box show from within which give back light (numerics.md, Eq. (111a)): albedo / pi
/// times what leaves through each cell. W / (length^2 sr), [face][row][cell of the row] with borders (WithBorders).
/// Empty where no face does, or it is not known what leaves.
std::vector<cl_float4> GroundLight(const Grid& grid, const SolvedLight& light);

/// A bit for each face, -x to +z, that gives back light.
int GroundFaces(const SolvedLight& light);

/// Irradiance on a face of the box by the light in the voxels on it, over pi and n^2: the radiance of a white table.
/// With a border of one voxel that repeats the outermost ones.
///
/// By fluence and mean direction, as numerics.md, Eq. (111).
/// @param ior        null: 1
/// @param fromBelow  light may come from the table's side: an environment shines
std::vector<cl_float4> TableLight(
  const Grid& grid, const Field& fluence, const Field& meanDirection, const Field& ior, int face, bool fromBelow);

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

/// An environment's pixels as rays look them up: with a column more on both sides, so that it closes.
struct EnvironmentPixels
{
  std::vector<cl_float4> shown; ///< what rays see that meet the medium; all of it, or what is not among the peaks
  std::vector<cl_float4> sharp; ///< the peaks, where they are apart
};

/// @param peaksApart  as where angular moments are shown (numerics.md, section 14.7)
EnvironmentPixels PixelsOf(const Environment& environment, bool peaksApart);
}
