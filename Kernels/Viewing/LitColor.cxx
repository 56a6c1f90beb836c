#include "Viewing/LitColor.h"

#include "Device/HostThreads.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <mutex>

namespace tyndall
{
namespace
{
constexpr std::size_t VoxelsOfThread = 16384; ///< at least
constexpr int ColumnsOfView = 64;             ///< along each edge of a view, at most
constexpr double ResolvedDepth = 2.0;         ///< k sigma_t distance of the most opaque voxel, at least
constexpr double PartOfVeil = 0.25;           ///< of the most light of a ray, where what is shown is right as well
constexpr double Opaque = 0.95;               ///< opacities above are as good as 1

/// What voxels send to the eye.
struct SourceFunction
{
  std::vector<float> radiance;   ///< 3 per voxel, W/(length^2 sr)
  std::vector<float> extinction; ///< mean of the channels, 1/length
};

double ShortestEdge(const Grid& grid)
{
  return *std::min_element(grid.spacing.begin(), grid.spacing.end());
}

/// Of coloured extinction each channel is weighted by its own opacity, so that one alpha serves all three.
void FindSource(const Medium& medium, const Field& fluence, std::size_t voxel, double edge, SourceFunction& found)
{
  std::array<double, 3> sigma_t, opacity;
  for (int c = 0; c < 3; ++c)
  {
    sigma_t[c] = static_cast<double>(medium.sigma_a.At(voxel, c)) + medium.sigma_s.At(voxel, c);
    opacity[c] = -std::expm1(-sigma_t[c] * edge);
  }
  const double mean = (opacity[0] + opacity[1] + opacity[2]) / 3.0;
  for (int c = 0; c < 3 && mean > 0.0; ++c)
  {
    const double sent =
      medium.sigma_s.At(voxel, c) * std::max(fluence.At(voxel, c), 0.0f) / (4.0 * Pi) + medium.emission.At(voxel, c);
    found.radiance[3 * voxel + c] =
      static_cast<float>(sigma_t[c] > 0.0 ? sent / sigma_t[c] * (opacity[c] / mean) : 0.0);
  }
  found.extinction[voxel] = static_cast<float>((sigma_t[0] + sigma_t[1] + sigma_t[2]) / 3.0);
}

SourceFunction SourceFunctionOf(const Medium& medium, const Field& fluence)
{
  const std::size_t voxels = medium.grid.VoxelCount();
  SourceFunction found;
  found.radiance.assign(3 * voxels, 0.0f);
  found.extinction.assign(voxels, 0.0f);
  const double edge = ShortestEdge(medium.grid);
  InThreads(voxels, VoxelsOfThread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t voxel = begin; voxel < end; ++voxel)
    {
      FindSource(medium, fluence, voxel, edge, found);
    }
  });
  return found;
}

/// Adds radiance that comes out of a column of voxels, seen from its first one.
void AddColumn(const SourceFunction& source, double edge, std::size_t first, std::ptrdiff_t step, int count,
  std::vector<float>& seen)
{
  std::array<double, 3> sum = {};
  double transmittance = 1.0;
  std::size_t voxel = first;
  for (int i = 0; i < count && transmittance > 1e-3; ++i, voxel += static_cast<std::size_t>(step))
  {
    const double opacity = -std::expm1(-source.extinction[voxel] * edge);
    for (std::size_t c = 0; c < 3; ++c)
    {
      sum[c] += transmittance * opacity * source.radiance[3 * voxel + c];
    }
    transmittance *= 1.0 - opacity;
  }
  seen.insert(seen.end(), sum.begin(), sum.end());
}

/// Radiance of views along the axes from both sides: every few columns.
std::vector<float> SeenAlongAxes(const Grid& grid, const SourceFunction& source)
{
  const std::array<std::size_t, 3> stride = grid.Strides();
  std::vector<float> seen;
  for (int axis = 0; axis < 3; ++axis)
  {
    const PlaneAxes plane = AcrossAxis(axis);
    const int every = std::max({ 1, grid.size[plane.u] / ColumnsOfView, grid.size[plane.v] / ColumnsOfView });
    const auto along = static_cast<std::ptrdiff_t>(stride[axis]);
    for (int v = every / 2; v < grid.size[plane.v]; v += every)
    {
      for (int u = every / 2; u < grid.size[plane.u]; u += every)
      {
        const std::size_t near = u * stride[plane.u] + v * stride[plane.v];
        const std::size_t far = near + (grid.size[axis] - 1) * stride[axis];
        AddColumn(source, grid.spacing[axis], near, along, grid.size[axis], seen);
        AddColumn(source, grid.spacing[axis], far, -along, grid.size[axis], seen);
      }
    }
  }
  return seen;
}

/// Gives an empty voxel the mean of its neighbours' radiance, each as much as it is dense.
void FillFromNeighbours(const Grid& grid, std::size_t voxel, SourceFunction& source)
{
  const std::array<int, 3> place = grid.VoxelAt(voxel);
  std::array<int, 3> low, high;
  for (int axis = 0; axis < 3; ++axis)
  {
    low[axis] = std::max(place[axis] - 1, 0);
    high[axis] = std::min(place[axis] + 1, grid.size[axis] - 1);
  }
  std::array<double, 3> sum = {};
  double weights = 0.0;
  for (int k = low[2]; k <= high[2]; ++k)
  {
    for (int j = low[1]; j <= high[1]; ++j)
    {
      for (int i = low[0]; i <= high[0]; ++i)
      {
        const std::size_t neighbour = grid.IndexOf({ i, j, k });
        const double weight = source.extinction[neighbour]; // 0 of other empty ones
        weights += weight;
        for (std::size_t c = 0; c < 3 && weight > 0.0; ++c)
        {
          sum[c] += weight * source.radiance[3 * neighbour + c];
        }
      }
    }
  }
  for (std::size_t c = 0; c < 3 && weights > 0.0; ++c)
  {
    source.radiance[3 * voxel + c] = static_cast<float>(sum[c] / weights);
  }
}

void FillEmptyVoxels(const Grid& grid, SourceFunction& source)
{
  InThreads(source.extinction.size(), VoxelsOfThread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t voxel = begin; voxel < end; ++voxel)
    {
      if (source.extinction[voxel] == 0.0f)
      {
        FillFromNeighbours(grid, voxel, source);
      }
    }
  });
}

/// Optical depths of the columns along an axis, by the rows that they stand on.
std::vector<float> ColumnDepths(const Grid& grid, int axis, const std::vector<float>& extinction)
{
  const PlaneAxes plane = AcrossAxis(axis);
  const std::array<std::size_t, 3> stride = grid.Strides();
  const auto row = static_cast<std::size_t>(grid.size[plane.u]);
  std::vector<float> depths(row * static_cast<std::size_t>(grid.size[plane.v]));
  InThreads(depths.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t column = begin; column < end; ++column)
    {
      std::size_t voxel = column % row * stride[plane.u] + column / row * stride[plane.v];
      double sum = 0.0;
      for (int i = 0; i < grid.size[axis]; ++i, voxel += stride[axis])
      {
        sum += extinction[voxel];
      }
      depths[column] = static_cast<float>(sum * grid.spacing[axis]);
    }
  });
  return depths;
}

/// The opacity of the densest of the three columns through each voxel: about the most that rays see of the medium.
std::vector<float> LargestOpacities(const Grid& grid, const std::vector<float>& extinction)
{
  std::array<std::vector<float>, 3> depths;
  for (int axis = 0; axis < 3; ++axis)
  {
    depths[axis] = ColumnDepths(grid, axis, extinction);
  }
  std::vector<float> opacities(extinction.size());
  InThreads(extinction.size(), VoxelsOfThread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t voxel = begin; voxel < end; ++voxel)
    {
      const std::array<int, 3> place = grid.VoxelAt(voxel);
      float most = 0.0f;
      for (int axis = 0; axis < 3; ++axis)
      {
        const PlaneAxes plane = AcrossAxis(axis);
        const auto column = static_cast<std::size_t>(place[plane.u]) +
          static_cast<std::size_t>(place[plane.v]) * static_cast<std::size_t>(grid.size[plane.u]);
        most = std::max(most, depths[axis][column]);
      }
      opacities[voxel] = std::min(static_cast<float>(-std::expm1(-most) / Opaque), 1.0f);
    }
  });
  return opacities;
}

/// Makes voxels as bright as they are seen at most.
void Dim(const std::vector<float>& opacities, std::vector<float>& radiance)
{
  InThreads(opacities.size(), VoxelsOfThread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = 3 * begin; i < 3 * end; ++i)
    {
      radiance[i] *= opacities[i / 3];
    }
  });
}

/// k of Eq. (112d) for each voxel.
/// @param radiance  what is seen of it at most, where it covers rays as much as `most`
/// @param colour  what the screen shows of that, 4 per voxel
std::vector<float> VeilFactors(const std::vector<float>& radiance, const std::vector<std::uint8_t>& colour,
  const std::vector<float>& most, const ToneMapping& tones)
{
  ToneMapping ofVeil = tones;
  ofVeil.exposure *= PartOfVeil;
  const std::vector<std::uint8_t> veil = ToneMap(radiance, {}, ofVeil);
  std::vector<float> factors(colour.size() / 4, 1.0f);
  InThreads(factors.size(), VoxelsOfThread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t voxel = begin; voxel < end; ++voxel)
    {
      const std::uint8_t* const whole = &colour[4 * voxel];
      const std::uint8_t* const dimmed = &veil[4 * voxel];
      const double shown = whole[0] + whole[1] + whole[2];
      const double ratio = shown > 0.0 ? (dimmed[0] + dimmed[1] + dimmed[2]) / shown : 0.0;
      const double factor = std::log1p(-std::min(ratio, 0.99)) / std::log1p(-PartOfVeil * std::max(most[voxel], 1e-6f));
      factors[voxel] = static_cast<float>(std::max(factor, 1.0));
    }
  });
  return factors;
}

double LargestProduct(const std::vector<float>& a, const std::vector<float>& b)
{
  double largest = 0.0;
  std::mutex mutex;
  InThreads(a.size(), VoxelsOfThread, [&](std::size_t begin, std::size_t end) {
    double here = 0.0;
    for (std::size_t i = begin; i < end; ++i)
    {
      here = std::max(here, static_cast<double>(a[i]) * b[i]);
    }
    const std::lock_guard<std::mutex> lock(mutex);
    largest = std::max(largest, here);
  });
  return largest;
}
}

LitColor ColorLitMedium(const Medium& medium, const Field& fluence, const ToneMapping& tones)
{
  Check(tones);
  SourceFunction source = SourceFunctionOf(medium, fluence);
  ToneMapping used = tones;
  used.exposure = tones.exposure > 0.0 ? tones.exposure : AutomaticExposure(SeenAlongAxes(medium.grid, source));
  const std::vector<float> most = LargestOpacities(medium.grid, source.extinction);
  Dim(most, source.radiance);
  FillEmptyVoxels(medium.grid, source);

  LitColor lit;
  lit.exposure = used.exposure;
  lit.rgba = ToneMap(source.radiance, {}, used);
  const std::vector<float> factors = VeilFactors(source.radiance, lit.rgba, most, used);
  const double densest = LargestProduct(factors, source.extinction);
  const double edge = ShortestEdge(medium.grid);
  lit.distance = densest > 0.0 ? std::max(edge, ResolvedDepth / densest) : edge;
  InThreads(factors.size(), VoxelsOfThread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t voxel = begin; voxel < end; ++voxel)
    {
      const double opacity = -std::expm1(-lit.distance * factors[voxel] * source.extinction[voxel]);
      lit.rgba[4 * voxel + 3] = static_cast<std::uint8_t>(255.0 * opacity + 0.5);
    }
  });
  return lit;
}
}
