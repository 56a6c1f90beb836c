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
/// Voxels per row and number of rows of a face: along y and z, x and z, or x and y.
std::array<int, 2> FaceSize(const Grid& grid, int face);

/// Adds to each face of a table over the box's face cells (BoxFaces.h) a border of one cell that repeats the outermost
/// cells.
std::vector<cl_float4> WithBorders(const Grid& grid, const std::vector<cl_float4>& cells);

/// Radiance of the reflecting faces, seen from inside (numerics.md, Eq. (111a)): albedo / pi times the power per area
/// that leaves through each cell. W / (length^2 sr), [face][row][cell of the row] with borders (WithBorders). Empty if
/// no face reflects or facePower is not known.
std::vector<cl_float4> GroundLight(const Grid& grid, const SolvedLight& light);

/// Bit mask of the reflecting faces, bit 0 for -x to bit 5 for +z.
int GroundFaces(const SolvedLight& light);

/// Radiance of a white table on a face of the box: irradiance by the light in the voxels at the face, divided by pi and
/// n^2. With a border of one voxel that repeats the outermost ones.
///
/// Computed from fluence and mean direction by numerics.md, Eq. (111).
/// @param ior        refractive index; null: 1
/// @param fromBelow  light may enter through the table's face, because there is an environment
std::vector<cl_float4> TableLight(
  const Grid& grid, const Field& fluence, const Field& meanDirection, const Field& ior, int face, bool fromBelow);

/// Correction for rays that enter the box through optically thick voxels (numerics.md, Eq. (112)): the outgoing
/// radiance that the solver computed there (`surface`), minus the radiance that the march finds at the same place with
/// the thick voxels' light interpolated from centre to centre. It is applied gradually from an optical thickness
/// ThickAtSurface of the voxel on, and fully at twice that, and only where the medium behind is some mean free paths
/// thick: light through a thin medium is not that of a half-space.
///
/// W / (length^2 sr), [cosine][face][row][cell of the row], each face with a border of one cell that repeats the
/// outermost. Empty if no correction is needed.
///
/// @param step   step of the march, voxels
/// @param block  the medium's place in a larger grid: only its faces on the domain's boundary are corrected. Its arrays
///   must cover VoxelsBehindSurface voxels behind them, or all of the domain. Null: the medium is the whole domain
std::vector<cl_float4> SurfaceLight(
  const Medium& medium, const SolvedLight& light, double step, const GridBlock* block = nullptr);

/// An environment's pixels for the kernels' look-up, with an additional column on either side for periodic
/// interpolation.
struct EnvironmentPixels
{
  /// Seen together with scattered light: the whole environment, or that without its peaks.
  std::vector<cl_float4> shown;
  std::vector<cl_float4> sharp; ///< the peaks, which only unscattered light shows, if they are separate
};

/// @param peaksApart  separate the peaks, as is needed with angular moments (numerics.md, section 14.7)
EnvironmentPixels PixelsOf(const Environment& environment, bool peaksApart);
}
