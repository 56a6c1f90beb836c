#include "Viewing/Backdrop/BackdropTables.h"

#include "LightPropagation/Uncollided/EnvironmentPeaks.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"
#include "Viewing/Scene/BlockOfScene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tyndall
{
std::array<int, 2> FaceSize(const Grid& grid, int face)
{
  const PlaneAxes axes = AcrossAxis(face / 2);
  return { grid.size[axes.u], grid.size[axes.v] };
}

std::vector<cl_float4> WithBorders(const Grid& grid, const std::vector<cl_float4>& cells)
{
  std::vector<cl_float4> padded;
  std::size_t first = 0;
  for (int face = 0; face < 6; ++face)
  {
    const std::array<int, 2> size = FaceSize(grid, face);
    for (int j = -1; j <= size[1]; ++j)
    {
      for (int i = -1; i <= size[0]; ++i)
      {
        const std::size_t row = std::clamp(j, 0, size[1] - 1);
        padded.push_back(cells[first + row * size[0] + std::clamp(i, 0, size[0] - 1)]);
      }
    }
    first += static_cast<std::size_t>(size[0]) * size[1];
  }
  return padded;
}

int GroundFaces(const SolvedLight& light)
{
  int faces = 0;
  for (int face = 0; face < 6 && light.facePower.values; ++face)
  {
    faces |= IsBlack(light.faceAlbedo[face]) ? 0 : 1 << face;
  }
  return faces;
}

std::vector<cl_float4> GroundLight(const Grid& grid, const SolvedLight& light)
{
  if (GroundFaces(light) == 0)
  {
    return {};
  }
  std::vector<cl_float4> cells(BoxFaceCellCount(grid));
  ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) {
    for (int c = 0; c < 3; ++c)
    {
      const double leaves = light.facePower.At(cell.number, light.facePower.components == 3 ? c : 0);
      cells[cell.number].s[c] = static_cast<float>(light.faceAlbedo[cell.face][c] * leaves / Pi);
    }
  });
  return WithBorders(grid, cells);
}

std::vector<cl_float4> TableLight(
  const Grid& grid, const Field& fluence, const Field& meanDirection, const Field& ior, int face, bool fromBelow)
{
  const int axis = face / 2;
  const double outwards = face % 2 ? 1.0 : -1.0;
  const std::array<int, 2> size = FaceSize(grid, face);
  const std::array<std::size_t, 3> strides = grid.Strides();
  std::vector<cl_float4> lit;
  lit.reserve(static_cast<std::size_t>(size[0] + 2) * (size[1] + 2));
  for (int j = -1; j <= size[1]; ++j)
  {
    for (int i = -1; i <= size[0]; ++i)
    {
      const std::size_t voxel = std::clamp(i, 0, size[0] - 1) * strides[AcrossAxis(axis).u] +
        std::clamp(j, 0, size[1] - 1) * strides[AcrossAxis(axis).v] +
        (face % 2 ? grid.size[axis] - 1 : 0) * strides[axis];
      const double n = ior.values ? ior.values[voxel] : 1.0;
      glm::dvec3 mean(0.0);
      if (meanDirection.values)
      {
        const float* m = meanDirection.values + 3 * voxel;
        mean = glm::dvec3(m[0], m[1], m[2]) / std::max(1.0, glm::length(glm::dvec3(m[0], m[1], m[2])));
      }
      const double even = fromBelow || !meanDirection.values ? 0.25 * (1.0 - glm::length(mean)) : 0.0;
      const double part = even + std::max(outwards * mean[axis], 0.0);
      const glm::dvec3 all(fluence.At(voxel, 0), fluence.At(voxel, 1), fluence.At(voxel, 2));
      lit.push_back(Float4(all * (part / (Pi * n * n)), 0.0));
    }
  }
  return lit;
}

namespace
{
constexpr double AllOfIt = 2.0; ///< thickness of full correction, in units of ThickAtSurface
/// optical thickness behind a cell at which the correction begins and is complete, mean free paths
constexpr double Translucent = 1.5, Opaque = 3.0;
constexpr double EnoughLeft = 1e-5; ///< transmittance at which a march ends
constexpr int MostSteps = 200;
constexpr double FinestStep = 0.1; ///< voxels; smaller steps give the same result

/// Coefficients of one channel, as in the march.
struct Coefficients
{
  double sigma, source;
};

Coefficients CoefficientsOf(const Medium& medium, const SolvedLight& light, std::size_t voxel, int channel)
{
  const double scatters = medium.sigma_s.At(voxel, channel);
  const double sigma = scatters + medium.sigma_a.At(voxel, channel);
  return { sigma, scatters * light.fluence.At(voxel, channel) / (4.0 * Pi) + medium.emission.At(voxel, channel) };
}

/// Smooth step from 0 at `low` to 1 at `high`.
double Between(double low, double high, double x)
{
  const double part = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return part * part * (3.0 - 2.0 * part);
}

/// Optical thickness with the solver's transport coefficient, mean free paths.
double Thickness(const Medium& medium, std::size_t voxel, int channel, double length)
{
  return length * medium.TransportSigmaT(voxel, channel);
}

/// Fraction of the correction to apply, in [0, 1].
double PartAt(const Medium& medium, const BoxFaceCell& cell, int channel)
{
  const int axis = cell.face / 2;
  const double edge = medium.grid.spacing[axis];
  const double first = Thickness(medium, cell.voxel, channel, edge);
  const double thick = Between(ThickAtSurface, AllOfIt * ThickAtSurface, first);
  double all = 0.0;
  const auto step = static_cast<std::ptrdiff_t>(cell.inward) - static_cast<std::ptrdiff_t>(cell.voxel);
  for (int n = 0; thick > 0.0 && n < std::min(VoxelsBehindSurface, medium.grid.size[axis]); ++n)
  {
    all += Thickness(medium, cell.voxel + n * step, channel, edge);
  }
  return thick * Between(Translucent, Opaque, all);
}

/// The voxels behind a face cell, for one channel; the last one is continued.
struct Column
{
  std::array<Coefficients, 3> voxels;
  double edge;   ///< of a voxel along the face's normal, length
  double across; ///< mean edge of a voxel along the face, length

  /// Interpolates between voxel centres at a depth in voxels from the face; constant between the face and the first
  /// centre.
  Coefficients At(double depth) const
  {
    const double place = std::clamp(depth - 0.5, 0.0, 2.0);
    const std::size_t first = place < 1.0 ? 0 : 1;
    const double part = place - static_cast<double>(first);
    const Coefficients& a = this->voxels[first];
    const Coefficients& b = this->voxels[first + 1];
    return { a.sigma + part * (b.sigma - a.sigma), a.source + part * (b.source - a.source) };
  }
};

/// Radiance that the march finds there along a ray at cosine mu to the normal, divided by 1 - transmittance of its
/// path.
double Marched(const Column& column, double mu, double step)
{
  const double voxelsPerLength = std::hypot(mu / column.edge, std::sqrt(1.0 - mu * mu) / column.across);
  const double length = step / voxelsPerLength;
  double left = 1.0, radiance = 0.0;
  for (int n = 0; left > EnoughLeft && n < MostSteps; ++n)
  {
    const Coefficients there = column.At((n + 0.5) * length * mu / column.edge);
    const double tau = there.sigma * length;
    radiance += left * there.source * (tau > 1e-9 ? -std::expm1(-tau) / there.sigma : length);
    left *= std::exp(-tau);
  }
  return radiance / std::max(1.0 - left, 1e-6);
}

Column ColumnBehind(const Medium& medium, const SolvedLight& light, const BoxFaceCell& cell, int channel)
{
  const std::array<double, 3>& h = medium.grid.spacing;
  const int axis = cell.face / 2;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Column column;
  column.edge = h[axis];
  column.across = std::sqrt(2.0 / (1.0 / (h[u] * h[u]) + 1.0 / (h[v] * h[v])));
  const auto step = static_cast<std::ptrdiff_t>(cell.inward) - static_cast<std::ptrdiff_t>(cell.voxel);
  for (int n = 0; n < 3; ++n)
  {
    const std::size_t voxel = cell.voxel + std::min(n, medium.grid.size[axis] - 1) * step;
    column.voxels[n] = CoefficientsOf(medium, light, voxel, channel);
  }
  return column;
}

/// Correction of one cell and channel, for each of SurfaceCosines.
std::array<double, 4> Missing(
  const Medium& medium, const SolvedLight& light, const BoxFaceCell& cell, int channel, double step)
{
  std::array<double, 4> missing = {};
  const double part = PartAt(medium, cell, channel);
  if (part <= 0.0)
  {
    return missing;
  }
  const Column column = ColumnBehind(medium, light, cell, channel);
  const int components = light.surface.components;
  const int channels = components / static_cast<int>(SurfaceCosines.size());
  for (std::size_t n = 0; n < missing.size(); ++n)
  {
    const double leaves = light.surface.values[cell.number * components + n * channels + (channels == 3 ? channel : 0)];
    missing[n] = part * (leaves - Marched(column, SurfaceCosines[n], std::max(step, FinestStep)));
  }
  return missing;
}
}

std::vector<cl_float4> SurfaceLight(const Medium& medium, const SolvedLight& light, double step, const GridBlock* block)
{
  const Grid& grid = medium.grid;
  std::array<std::vector<cl_float4>, SurfaceCosines.size()> cells;
  cells.fill(std::vector<cl_float4>(BoxFaceCellCount(grid)));
  bool any = false;
  ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) {
    if (block && !IsOnFace(*block, grid.size, cell.face))
    {
      return;
    }
    for (int c = 0; c < 3; ++c)
    {
      const std::array<double, 4> missing = Missing(medium, light, cell, c, step);
      for (std::size_t n = 0; n < missing.size(); ++n)
      {
        cells[n][cell.number].s[c] = static_cast<float>(missing[n]);
        any |= missing[n] != 0.0;
      }
    }
  });
  std::vector<cl_float4> table;
  for (std::size_t n = 0; any && n < SurfaceCosines.size(); ++n)
  {
    const std::vector<cl_float4> padded = WithBorders(grid, cells[n]);
    table.insert(table.end(), padded.begin(), padded.end());
  }
  return table;
}

namespace
{
/// number of directions per face that separates the environment's peaks from the rest
constexpr int DirectionsOfPeaks = 25;

/// The environment with an additional column on either side.
std::vector<cl_float4> ClosedEnvironment(const Environment& environment)
{
  const int width = environment.width;
  std::vector<cl_float4> pixels(static_cast<std::size_t>(width + 2) * environment.height);
  for (int j = 0; j < environment.height; ++j)
  {
    for (int i = 0; i < width + 2; ++i)
    {
      const std::size_t from = 3 * (static_cast<std::size_t>(j) * width + (i + width - 1) % width);
      pixels[static_cast<std::size_t>(j) * (width + 2) + i] = { { environment.radiance[from],
        environment.radiance[from + 1], environment.radiance[from + 2], 0.0f } };
    }
  }
  return pixels;
}
}

EnvironmentPixels PixelsOf(const Environment& environment, bool peaksApart)
{
  EnvironmentPixels pixels;
  pixels.shown = ClosedEnvironment(environment);
  if (peaksApart)
  {
    // Small bright parts are treated as lamps: their unscattered light is shown separately.
    pixels.sharp = pixels.shown;
    pixels.shown = ClosedEnvironment(Split(environment, EquiangularDirections(DirectionsOfPeaks)).smooth);
    for (std::size_t i = 0; i < pixels.sharp.size(); ++i)
    {
      for (int c = 0; c < 3; ++c)
      {
        pixels.sharp[i].s[c] -= pixels.shown[i].s[c];
      }
    }
  }
  return pixels;
}
}
