#include "Refraction/Voxelization/SampleLattice.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
/// Maximum length of grid and meshes together, in lattice units. A sum of three products of three coordinates then fits
/// into 63 bits.
constexpr double Longest = 1 << 20;
constexpr int TileColumns = 64;
constexpr int TileRows = 16;

/// Index of the first sample at or above a coordinate (lattice units), which may be negative; samples are at (index +
/// 1/2) pitch.
int FirstSampleFrom(int coordinate, int pitch)
{
  const int above = coordinate - pitch / 2 + pitch - 1;
  return above >= 0 ? above / pitch : -((-above + pitch - 1) / pitch);
}

struct Interval
{
  double low, high;
};

/// Interval along the axis columns.across that a triangle covers where its coordinate along the axis columns.up is
/// between `low` and `high`. Widened by one lattice unit to allow for rounding.
Interval AcrossBetween(
  const std::array<const SampleLattice::Point*, 3>& corners, const SampleColumns& columns, double low, double high)
{
  Interval interval = { HUGE_VAL, -HUGE_VAL };
  const auto take = [&](double across) {
    interval.low = std::min(interval.low, across - 1.0);
    interval.high = std::max(interval.high, across + 1.0);
  };
  for (int side = 0; side < 3; ++side)
  {
    const SampleLattice::Point& from = *corners[side];
    const SampleLattice::Point& to = *corners[(side + 1) % 3];
    const double fromUp = from[columns.up];
    const double toUp = to[columns.up];
    if (fromUp >= low && fromUp <= high)
    {
      take(from[columns.across]);
    }
    for (double limit : { low, high })
    {
      if ((fromUp < limit) != (toUp < limit))
      {
        const double part = (limit - fromUp) / (toUp - fromUp);
        take(from[columns.across] + part * (to[columns.across] - from[columns.across]));
      }
    }
  }
  return interval;
}
}

SampleLattice::SampleLattice(const Grid& grid, int samples, const std::vector<const TriangleMesh*>& meshes)
  : Origin(grid.origin)
  , SamplesOfVoxel(samples)
{
  double longest = 0.0; // longest edge of grid and meshes together, in fine voxels
  for (int axis = 0; axis < 3; ++axis)
  {
    double low = grid.origin[axis];
    double high = low + grid.Length(axis);
    for (const TriangleMesh* mesh : meshes)
    {
      for (const std::array<double, 3>& point : mesh->points)
      {
        low = std::min(low, point[axis]);
        high = std::max(high, point[axis]);
      }
    }
    longest = std::max(longest, (high - low) / grid.spacing[axis] * samples);
  }
  Require(longest < Longest / 2.0,
    "The mesh is " + Text("%g", longest / samples) + " voxels long. With " + std::to_string(samples) +
      (samples == 1 ? " sample" : " samples") + " an edge of a voxel it can be " +
      std::to_string(static_cast<int>(Longest / 2.0) / samples) +
      " at most. Make the box larger, or cut away what is far outside of it.");
  while (2.0 * this->UnitsOfSample * (longest + 1.0) <= Longest)
  {
    this->UnitsOfSample *= 2;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    this->UnitsOfLength[axis] = samples * this->UnitsOfSample / grid.spacing[axis];
  }
}

SampleLattice SampleLattice::From(const std::array<int, 3>& voxel) const
{
  SampleLattice moved = *this;
  moved.FirstVoxel = voxel;
  return moved;
}

std::vector<SampleLattice::Point> SampleLattice::Rounded(const std::vector<std::array<double, 3>>& points) const
{
  std::vector<Point> rounded(points.size());
  const int unitsOfVoxel = this->SamplesOfVoxel * this->UnitsOfSample;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double units = (points[i][axis] - this->Origin[axis]) * this->UnitsOfLength[axis];
      rounded[i][axis] = static_cast<cl_int>(std::floor(units + 0.5)) - this->FirstVoxel[axis] * unitsOfVoxel;
    }
  }
  return rounded;
}

bool SampleLattice::Closes(const TriangleMesh& mesh) const
{
  TriangleMesh rounded;
  rounded.triangles = mesh.triangles;
  rounded.points.reserve(mesh.points.size());
  for (const Point& point : this->Rounded(mesh.points))
  {
    rounded.points.push_back(
      { static_cast<double>(point[0]), static_cast<double>(point[1]), static_cast<double>(point[2]) });
  }
  return Examine(rounded).boundaryEdges == 0;
}

SampleColumns::SampleColumns(const Grid& grid, int axis, int samplesOfVoxel, int unitsOfSample)
  : axis(axis)
  , across(AcrossAxis(axis).u)
  , up(AcrossAxis(axis).v)
  , samplesOfVoxel(samplesOfVoxel)
  , samples(grid.size[axis] * samplesOfVoxel)
  , count{ grid.size[this->across] * samplesOfVoxel, grid.size[this->up] * samplesOfVoxel }
  , pitch(unitsOfSample)
{
}

LatticeMesh::LatticeMesh(Device& device, const SampleLattice& lattice, const TriangleMesh& mesh)
  : HostPoints(lattice.Rounded(mesh.points))
  , HostTriangles(mesh.triangles)
  , DevicePoints(device, HostPoints.data()->data(), 3 * HostPoints.size(), "the mesh's points")
  , DeviceTriangles(device, HostTriangles.data()->data(), 3 * HostTriangles.size(), "the mesh's triangles")
{
}

std::vector<cl_uint4> LatticeMesh::Tiles(const SampleColumns& columns, int firstRow, int endRow) const
{
  SampleBox rows;
  // Along the columns the range of samples is empty and sets no limit: a crossing beyond a column's end counts as a
  // crossing at its end.
  rows.first[columns.axis] = 0;
  rows.end[columns.axis] = 0;
  rows.first[columns.across] = 0;
  rows.end[columns.across] = columns.count[0];
  rows.first[columns.up] = firstRow;
  rows.end[columns.up] = endRow;
  return this->Tiles(columns, rows);
}

std::vector<cl_uint4> LatticeMesh::Tiles(const SampleColumns& columns, const SampleBox& box) const
{
  std::vector<cl_uint4> tiles;
  const int pitch = columns.pitch;
  for (std::size_t t = 0; t < this->HostTriangles.size(); ++t)
  {
    std::array<const SampleLattice::Point*, 3> corners;
    std::transform(this->HostTriangles[t].begin(), this->HostTriangles[t].end(), corners.begin(),
      [&](int corner) { return &this->HostPoints[static_cast<std::size_t>(corner)]; });
    const bool anyDepth = box.first[columns.axis] == box.end[columns.axis];
    const auto [lowest, highest] =
      std::minmax({ (*corners[0])[columns.axis], (*corners[1])[columns.axis], (*corners[2])[columns.axis] });
    if (!anyDepth && (highest < box.first[columns.axis] * pitch || lowest > box.end[columns.axis] * pitch))
    {
      continue;
    }
    // A sample exactly at the triangle's upper end (`high`) is excluded, because the infinitesimal move of samples
    // (Voxelization.cl) takes it out of the triangle.
    const auto range = [&](int axis, int limitLow, int limitHigh) {
      const auto [low, high] = std::minmax({ (*corners[0])[axis], (*corners[1])[axis], (*corners[2])[axis] });
      return std::array<int, 2>{ std::max(FirstSampleFrom(low, pitch), limitLow),
        std::min(FirstSampleFrom(high, pitch), limitHigh) };
    };
    const std::array<int, 2> row = range(columns.up, box.first[columns.up], box.end[columns.up]);
    const std::array<int, 2> column = range(columns.across, box.first[columns.across], box.end[columns.across]);
    const bool small = column[1] - column[0] <= TileColumns && row[1] - row[0] <= TileRows;
    const auto add = [&](int firstColumn, int endColumn, int first, int end) {
      tiles.push_back({ { static_cast<cl_uint>(t), static_cast<cl_uint>(firstColumn), static_cast<cl_uint>(first),
        static_cast<cl_uint>((endColumn - firstColumn) << 16 | (end - first)) } });
    };
    if (row[0] >= row[1] || column[0] >= column[1])
    {
      continue; // the triangle lies between columns, or outside the box
    }
    if (small)
    {
      add(column[0], column[1], row[0], row[1]);
      continue;
    }
    for (int first = row[0]; first < row[1]; first += TileRows)
    {
      const int end = std::min(first + TileRows, row[1]);
      const Interval interval = AcrossBetween(corners, columns, (first + 0.5) * pitch, (end - 0.5) * pitch);
      const int endColumn = std::min(column[1], static_cast<int>(std::floor(interval.high / pitch)) + 1);
      for (int c = std::max(column[0], static_cast<int>(std::floor(interval.low / pitch))); c < endColumn;
           c += TileColumns)
      {
        add(c, std::min(c + TileColumns, endColumn), first, end);
      }
    }
  }
  return tiles;
}
}
