#include "IO/VDB/VDBGeometry.h"

#include "Device/Errors.h"

#include "vtkImageData.h"
#include "vtkMatrix3x3.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr const char* ExtentMinKey = "image_extent_min";
constexpr const char* ExtentMaxKey = "image_extent_max";
constexpr const char* CellsKey = "image_cells";
constexpr const char* OriginKey = "image_origin";
constexpr const char* SpacingKey = "image_spacing";

using Steps = std::array<std::array<double, 3>, 3>; ///< world vectors of a step by one voxel along i, j, k

template <typename T>
const T* NoteOf(const VDBGrid& grid, const char* key)
{
  const auto metadata = grid.Metadata.getMetadata<openvdb::TypedMetadata<T>>(key);
  return metadata ? &metadata->value() : nullptr;
}

std::int64_t LastVoxel(std::int64_t first, std::int64_t last)
{
  return std::max(first, last - 1);
}

double LengthOf(const std::array<double, 3>& vector)
{
  return std::sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]);
}

/// One world coordinate of the centre of voxel 0 of an image.
/// @param origin  the same coordinate of the image's origin, which is a corner of voxel 0
/// @param half    0.5, half a voxel edge; with -0.5 the function is inverted: from the centre to the origin
double CentreOfFirstVoxel(double origin, const Steps& steps, int axis, double half = 0.5)
{
  return origin + half * (steps[0][axis] + steps[1][axis] + steps[2][axis]);
}

std::array<std::int64_t, 6> ExtentOfAll(const std::vector<const VDBGrid*>& grids)
{
  VDBGeometry all;
  for (const VDBGrid* grid : grids)
  {
    const auto extent = ExtentOf(*grid);
    if (extent[0] > extent[1])
    {
      continue;
    }
    const bool first = all.Empty();
    for (int axis = 0; axis < 3; ++axis)
    {
      std::int64_t& low = all.Extent[2 * axis];
      std::int64_t& high = all.Extent[2 * axis + 1];
      low = first ? extent[2 * axis] : std::min(low, extent[2 * axis]);
      high = first ? extent[2 * axis + 1] : std::max(high, extent[2 * axis + 1]);
    }
  }
  return all.Extent;
}

/// Sets origin and spacing of an image to the exact values in the grid's metadata, unless the grid's transform has
/// changed since these were recorded.
void ApplyNotes(VDBGeometry& geometry, const VDBGrid& grid, bool aligned)
{
  const auto* origin = NoteOf<openvdb::Vec3d>(grid, OriginKey);
  const auto* spacing = NoteOf<openvdb::Vec3d>(grid, SpacingKey);
  if (!origin || !spacing)
  {
    return;
  }
  Steps steps = grid.Axes;
  bool same = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double rounding = 4e-16 * (std::abs(grid.Translation[axis]) + 4.0 * geometry.Spacing[axis]);
    same = same && std::abs((*spacing)[axis] - geometry.Spacing[axis]) <= rounding;
    steps[axis][axis] = aligned ? geometry.Direction[4 * axis] * (*spacing)[axis] : steps[axis][axis];
  }
  for (int row = 0; row < 3; ++row)
  {
    same = same && CentreOfFirstVoxel((*origin)[row], steps, row) == grid.Translation[row];
  }
  if (same)
  {
    geometry.Origin = { (*origin)[0], (*origin)[1], (*origin)[2] };
    geometry.Spacing = { (*spacing)[0], (*spacing)[1], (*spacing)[2] };
  }
}
}

bool IsGeometry(const std::string& key)
{
  return key == ExtentMinKey || key == ExtentMaxKey || key == CellsKey || key == OriginKey || key == SpacingKey;
}

VDBBox VoxelsOf(const std::array<std::int64_t, 6>& extent)
{
  return { { extent[0], extent[2], extent[4] },
    { LastVoxel(extent[0], extent[1]), LastVoxel(extent[2], extent[3]), LastVoxel(extent[4], extent[5]) } };
}

double CellsOf(const std::array<std::int64_t, 6>& extent)
{
  const VDBBox box = VoxelsOf(extent);
  double cells = extent[0] > extent[1] ? 0.0 : 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    cells *= static_cast<double>(box.Max[axis] - box.Min[axis] + 1);
  }
  return cells;
}

std::array<std::int64_t, 6> ExtentOf(const VDBGrid& grid)
{
  std::array<std::int64_t, 6> extent = { 0, -1, 0, -1, 0, -1 };
  const VDBBox& active = grid.Tree.ActiveBox;
  const auto* min = NoteOf<openvdb::Vec3i>(grid, ExtentMinKey);
  const auto* max = NoteOf<openvdb::Vec3i>(grid, ExtentMaxKey);
  bool noted = min && max;
  for (int axis = 0; axis < 3 && noted; ++axis)
  {
    extent[2 * axis] = (*min)[axis];
    extent[2 * axis + 1] = (*max)[axis];
    noted = (*min)[axis] <= (*max)[axis] &&
      (active.Empty() ||
        ((*min)[axis] <= active.Min[axis] && active.Max[axis] <= LastVoxel((*min)[axis], (*max)[axis])));
  }
  for (int axis = 0; axis < 3 && !noted; ++axis)
  {
    extent[2 * axis] = active.Empty() ? 0 : active.Min[axis];
    extent[2 * axis + 1] = active.Empty() ? -1 : active.Max[axis] + 1;
  }
  return extent;
}

bool NotesExtent(const VDBGrid& grid, const std::array<std::int64_t, 6>& extent)
{
  const auto* cells = NoteOf<openvdb::Int64>(grid, CellsKey);
  return cells && static_cast<double>(*cells) == CellsOf(extent) && ExtentOf(grid) == extent &&
    NoteOf<openvdb::Vec3i>(grid, ExtentMinKey) && NoteOf<openvdb::Vec3i>(grid, ExtentMaxKey);
}

bool SharesTransform(const VDBGrid& a, const VDBGrid& b)
{
  for (int i = 0; i < 3; ++i)
  {
    const double size = LengthOf(a.Axes[i]);
    for (int j = 0; j < 3; ++j)
    {
      if (!(std::abs(a.Axes[i][j] - b.Axes[i][j]) <= 1e-9 * size))
      {
        return false;
      }
    }
    const double near = 1e-6 * size + 1e-12 * std::abs(a.Translation[i]);
    if (!(std::abs(a.Translation[i] - b.Translation[i]) <= near))
    {
      return false;
    }
  }
  return true;
}

VDBGeometry GeometryOf(const std::vector<const VDBGrid*>& grids)
{
  VDBGeometry geometry;
  geometry.Extent = ExtentOfAll(grids);
  const VDBGrid& grid = *grids.front();
  bool aligned = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto& step = grid.Axes[axis];
    const bool along = step[(axis + 1) % 3] == 0.0 && step[(axis + 2) % 3] == 0.0;
    aligned = aligned && along;
    geometry.Spacing[axis] = along ? std::abs(step[axis]) : LengthOf(step);
    for (int row = 0; row < 3; ++row)
    {
      geometry.Direction[3 * row + axis] = step[row] / geometry.Spacing[axis];
    }
  }
  for (int row = 0; row < 3; ++row)
  {
    geometry.Origin[row] = CentreOfFirstVoxel(grid.Translation[row], grid.Axes, row, -0.5);
  }
  ApplyNotes(geometry, grid, aligned);
  return geometry;
}

VDBGeometry BoxAround(const std::vector<const VDBGrid*>& grids)
{
  VDBGeometry box;
  const std::array<std::int64_t, 6> extent = ExtentOfAll(grids);
  if (extent[0] > extent[1])
  {
    return box;
  }
  const VDBGrid& grid = *grids.front();
  const VDBBox voxels = VoxelsOf(extent);
  const double edge = std::min({ LengthOf(grid.Axes[0]), LengthOf(grid.Axes[1]), LengthOf(grid.Axes[2]) });
  for (int row = 0; row < 3; ++row)
  {
    double low = grid.Translation[row], high = low;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double step = grid.Axes[axis][row];
      const double first = (static_cast<double>(voxels.Min[axis]) - 0.5) * step;
      const double last = (static_cast<double>(voxels.Max[axis]) + 0.5) * step;
      low += std::min(first, last);
      high += std::max(first, last);
    }
    box.Origin[row] = low;
    box.Spacing[row] = edge;
    box.Extent[2 * row] = 0;
    box.Extent[2 * row + 1] =
      std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil((high - low) / edge - 1e-6)), 1);
  }
  return box;
}

VDBPlacement PlacementOf(vtkImageData* image)
{
  VDBPlacement place;
  const int* extent = image->GetExtent();
  const double* origin = image->GetOrigin();
  const double* spacing = image->GetSpacing();
  vtkMatrix3x3* direction = image->GetDirectionMatrix();
  Steps steps;
  openvdb::Mat4d matrix = openvdb::Mat4d::identity(); // OpenVDB multiplies row vectors by the matrix
  bool aligned = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    place.Voxels.min()[axis] = extent[2 * axis];
    place.Voxels.max()[axis] = static_cast<int>(LastVoxel(extent[2 * axis], extent[2 * axis + 1]));
    for (int row = 0; row < 3; ++row)
    {
      steps[axis][row] = direction->GetElement(row, axis) * spacing[axis];
      matrix(axis, row) = steps[axis][row];
      aligned = aligned && (row == axis ? steps[axis][row] > 0.0 : steps[axis][row] == 0.0);
    }
  }
  openvdb::Vec3d centre;
  for (int row = 0; row < 3; ++row)
  {
    centre[row] = CentreOfFirstVoxel(origin[row], steps, row);
    matrix(3, row) = centre[row];
    Require(std::isfinite(centre[row]) && spacing[row] > 0.0 && std::isfinite(spacing[row]),
      "The image's spacing must not be 0, and its spacing and origin must be finite.");
  }
  openvdb::math::MapBase::Ptr map;
  if (aligned)
  {
    map.reset(new openvdb::math::ScaleTranslateMap(openvdb::Vec3d(spacing), centre));
  }
  else
  {
    map.reset(new openvdb::math::AffineMap(matrix));
  }
  place.Transform.reset(new openvdb::math::Transform(map));
  place.Notes.insertMeta(ExtentMinKey, openvdb::Vec3IMetadata(openvdb::Vec3i(extent[0], extent[2], extent[4])));
  place.Notes.insertMeta(ExtentMaxKey, openvdb::Vec3IMetadata(openvdb::Vec3i(extent[1], extent[3], extent[5])));
  place.Notes.insertMeta(CellsKey, openvdb::Int64Metadata(image->GetNumberOfCells()));
  place.Notes.insertMeta(OriginKey, openvdb::Vec3DMetadata(openvdb::Vec3d(origin)));
  place.Notes.insertMeta(SpacingKey, openvdb::Vec3DMetadata(openvdb::Vec3d(spacing)));
  return place;
}
}
