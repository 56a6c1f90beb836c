#pragma once

#include <array>
#include <string>

/// What vtkVDBReader and vtkVDBWriter agree on.
namespace tyndall
{
/// Metadata of a grid that was an image: its extent of points, which the grid itself does not say (voxels may be background
/// up to the border), and its origin and spacing, which it does not say to the last bit (OpenVDB computes the scale of a
/// transform as the difference of two positions).
constexpr const char* ImageMinKey = "image_extent_min";
constexpr const char* ImageMaxKey = "image_extent_max";
constexpr const char* ImageOriginKey = "image_origin";
constexpr const char* ImageSpacingKey = "image_spacing";

/// Name of the field data that holds metadata `key` of a grid; of the file, if the grid's name is empty.
inline std::string FieldName(const std::string& grid, const std::string& key)
{
  return "vdb:" + grid + ":" + key;
}

/// World position of the centre of voxel 0, along one world axis, in an image with that origin.
/// @param steps  world vectors of a step of one voxel along i, j, k
/// @param half   -0.5 to go from the centre to the origin
inline double CentreOfFirstVoxel(
  double origin, const std::array<std::array<double, 3>, 3>& steps, int axis, double half = 0.5)
{
  return origin + half * (steps[0][axis] + steps[1][axis] + steps[2][axis]);
}
}
