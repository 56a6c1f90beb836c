#include "Viewing/LitColor.h"

#include "Device/HostThreads.h"
#include "Distribution/BoxExchange.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <mutex>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr std::size_t VoxelsOfThread = 16384; ///< smallest number of voxels per thread
/// The exposure is determined from views with at most this number of pixels along each edge. A view is a parallel
/// projection along an axis of the grid, in which a pixel shows one column of voxels.
constexpr int ColumnsOfView = 64;
/// Lower limit on the largest optical depth k sigma_t distance of a voxel, with alpha = 1 - exp(-k sigma_t distance)
/// (LitColor.h). LitColor::distance is chosen so long that the limit is reached: 8 bits then resolve the opacities.
constexpr double ResolvedDepth = 2.0;
/// The factor k on a voxel's optical depth compensates for blending in display values (LitColor.h). It is chosen so
/// that a voxel blended over black has the right display value at this fraction of the largest radiance that a ray can
/// receive from it, see numerics.md, Eq. (112d).
constexpr double PartOfVeil = 0.25;
constexpr double AsGoodAsOpaque = 0.95; ///< opacity of a column of voxels from which on it is taken as 1

/// Source function of the voxels: (sigma_s fluence / (4 pi) + emission) / sigma_t.
struct SourceFunction
{
  std::vector<float> radiance;   ///< source function, 3 per voxel, W / (length^2 sr)
  std::vector<float> extinction; ///< extinction, mean of the channels, one per voxel, 1/length
};

/// Calls act(voxel) for all voxels, concurrently.
template <class Act>
void ForVoxels(std::size_t voxels, const Act& act)
{
  InThreads(voxels, VoxelsOfThread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t voxel = begin; voxel < end; ++voxel)
    {
      act(voxel);
    }
  });
}

double ShortestEdge(const Grid& grid)
{
  return *std::min_element(grid.spacing.begin(), grid.spacing.end());
}

/// Computes the source function and the extinction of one voxel. With coloured extinction each channel is weighted by
/// its own opacity, because one alpha serves all three.
/// @param edge  shortest edge of a voxel, in units of length
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
  ForVoxels(voxels, [&](std::size_t voxel) { FindSource(medium, fluence, voxel, edge, found); });
  return found;
}

/// Radiance and transmittance of a column of voxels, or of a section of it.
struct SeenColumn
{
  std::array<double, 3> radiance = {};
  double transmittance = 1.0;

  void GoOn(const SeenColumn& behind)
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      this->radiance[c] += this->transmittance * behind.radiance[c];
    }
    this->transmittance *= behind.transmittance;
  }
};

SeenColumn LookAlong(const SourceFunction& source, double edge, std::size_t first, std::ptrdiff_t step, int count)
{
  SeenColumn seen;
  std::size_t voxel = first;
  for (int i = 0; i < count; ++i, voxel += static_cast<std::size_t>(step))
  {
    const double opacity = -std::expm1(-source.extinction[voxel] * edge);
    SeenColumn here;
    for (std::size_t c = 0; c < 3; ++c)
    {
      here.radiance[c] = opacity * source.radiance[3 * voxel + c];
    }
    here.transmittance = 1.0 - opacity;
    seen.GoOn(here);
  }
  return seen;
}

/// Calls act(u, v) for those columns of voxels along an axis that lie in a box and that a view shows. A view shows a
/// regular subset of the grid's columns, at most ColumnsOfView along each edge.
template <class Act>
void ForColumnsOfView(const Grid& whole, int axis, const VoxelBox& box, const Act& act)
{
  const PlaneAxes plane = AcrossAxis(axis);
  const int every = std::max({ 1, whole.size[plane.u] / ColumnsOfView, whole.size[plane.v] / ColumnsOfView });
  for (int v = every / 2; v < whole.size[plane.v]; v += every)
  {
    for (int u = every / 2; u < whole.size[plane.u]; u += every)
    {
      const bool has =
        u >= box.first[plane.u] && u < EndOf(box, plane.u) && v >= box.first[plane.v] && v < EndOf(box, plane.v);
      if (has)
      {
        act(u, v);
      }
    }
  }
}

/// Radiance and transmittance, within this rank's block, of each column that a view along the axis shows, seen from the
/// lower and from the upper end of the axis.
std::vector<SeenColumn> SeenInBlock(const Domain& domain, int axis, const SourceFunction& source)
{
  const Grid grid = domain.OwnGrid();
  const std::array<std::size_t, 3> stride = grid.Strides();
  const PlaneAxes plane = AcrossAxis(axis);
  const VoxelBox& own = domain.Own();
  const auto along = static_cast<std::ptrdiff_t>(stride[axis]);
  std::vector<SeenColumn> seen;
  ForColumnsOfView(domain.Whole(), axis, own, [&](int u, int v) {
    const std::size_t near = (u - own.first[plane.u]) * stride[plane.u] + (v - own.first[plane.v]) * stride[plane.v];
    const std::size_t far = near + (grid.size[axis] - 1) * stride[axis];
    seen.push_back(LookAlong(source, grid.spacing[axis], near, along, grid.size[axis]));
    seen.push_back(LookAlong(source, grid.spacing[axis], far, -along, grid.size[axis]));
  });
  return seen;
}

/// Pixels of several views: radiance, 3 per pixel, and alpha.
struct SeenPixels
{
  std::vector<float> radiance, alpha;
};

/// Pixels of the two views along an axis, from its lower and from its upper end: composites the columns of all blocks.
/// @param byRank  columns of each rank's block, from SeenInBlock
SeenPixels BehindEachOther(
  const BlockPartition& partition, int axis, const std::vector<std::vector<SeenColumn>>& byRank)
{
  std::vector<std::size_t> order(byRank.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return partition.blocks[a].first[axis] < partition.blocks[b].first[axis]; });
  const std::size_t width = static_cast<std::size_t>(partition.whole.size[AcrossAxis(axis).u]);
  // Composited columns by their position in the plane across the axis, each as seen from the lower and from the upper
  // end.
  std::map<std::size_t, std::array<SeenColumn, 2>> columns;
  for (int side = 0; side < 2; ++side)
  {
    for (const std::size_t rank : order)
    {
      auto next = byRank[rank].begin() + side;
      ForColumnsOfView(partition.whole, axis, partition.blocks[rank], [&](int u, int v) {
        columns[v * width + u][side].GoOn(*next);
        next += 2;
      });
    }
    std::reverse(order.begin(), order.end());
  }
  SeenPixels seen;
  for (const auto& [place, sides] : columns)
  {
    for (const SeenColumn& column : sides)
    {
      seen.radiance.insert(seen.radiance.end(), column.radiance.begin(), column.radiance.end());
      seen.alpha.push_back(static_cast<float>(1.0 - column.transmittance));
    }
  }
  return seen;
}

/// Exposure that AutomaticExposure chooses for six parallel views, along each axis from both sides. The views show a
/// subset of the columns, and the first rank composites them. Collective.
double ExposureAlongAxes(const Domain& domain, const SourceFunction& source)
{
  Communicator& others = domain.Comm();
  SeenPixels seen;
  for (int axis = 0; axis < 3; ++axis)
  {
    std::vector<std::vector<SeenColumn>> byRank = { SeenInBlock(domain, axis, source) };
    if (others.Rank() > 0)
    {
      others.Send(0, MessageTag::ColumnsOfSight, byRank[0]);
      continue;
    }
    for (int rank = 1; rank < others.Ranks(); ++rank)
    {
      byRank.push_back(others.Receive<SeenColumn>(rank, MessageTag::ColumnsOfSight));
    }
    const SeenPixels ofAxis = BehindEachOther(domain.Partition(), axis, byRank);
    seen.radiance.insert(seen.radiance.end(), ofAxis.radiance.begin(), ofAxis.radiance.end());
    seen.alpha.insert(seen.alpha.end(), ofAxis.alpha.begin(), ofAxis.alpha.end());
  }
  return others.Sum({ others.Rank() == 0 ? AutomaticExposure(seen.radiance, seen.alpha) : 0.0 })[0];
}

/// Sets the radiance of a voxel without extinction to the mean of its neighbours' radiance, weighted by their
/// extinction.
/// @param grid    grid of `around`, which includes the voxel and its neighbours
/// @param place   indices of the voxel in this grid
/// @param around  source function on this grid
void FillFromNeighbours(
  const Grid& grid, const std::array<int, 3>& place, const SourceFunction& around, float* radiance)
{
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
        const double weight = around.extinction[neighbour]; // 0 for neighbours without extinction
        weights += weight;
        for (std::size_t c = 0; c < 3 && weight > 0.0; ++c)
        {
          sum[c] += weight * around.radiance[3 * neighbour + c];
        }
      }
    }
  }
  for (std::size_t c = 0; c < 3 && weights > 0.0; ++c)
  {
    radiance[c] = static_cast<float>(sum[c] / weights);
  }
}

/// Source function of this rank's block and its ghost cells. Collective.
SourceFunction WithNeighbours(const Domain& domain, const SourceFunction& own)
{
  std::vector<VoxelBox> wanted;
  for (const VoxelBox& block : domain.Partition().blocks)
  {
    wanted.push_back(block.VoxelCount() > 0 ? Grown(block, 1, domain.Whole()) : VoxelBox());
  }
  return { ValuesInBox(domain.Comm(), domain.Partition(), wanted, own.radiance, 3),
    ValuesInBox(domain.Comm(), domain.Partition(), wanted, own.extinction, 1) };
}

void FillEmptyVoxels(const Domain& domain, SourceFunction& source)
{
  const SourceFunction around = WithNeighbours(domain, source);
  const VoxelBox& own = domain.Own();
  const VoxelBox box = Grown(own, 1, domain.Whole());
  Grid grid = domain.Whole();
  grid.size = box.size;
  ForVoxels(source.extinction.size(), [&](std::size_t voxel) {
    if (source.extinction[voxel] == 0.0f)
    {
      FillFromNeighbours(grid, box.Within(own.VoxelAt(voxel)), around, &source.radiance[3 * voxel]);
    }
  });
}

/// Optical depths of all columns of the whole grid along an axis, row by row in the plane across the axis. Collective.
/// @param extinction  mean extinction of this rank's voxels, 1/length
std::vector<double> ColumnDepths(const Domain& domain, int axis, const std::vector<float>& extinction)
{
  const PlaneAxes plane = AcrossAxis(axis);
  const Grid& whole = domain.Whole();
  const VoxelBox& own = domain.Own();
  const std::array<std::size_t, 3> stride = domain.OwnGrid().Strides();
  const auto row = static_cast<std::size_t>(whole.size[plane.u]);
  const auto columns = static_cast<std::size_t>(own.VoxelCount() > 0 ? own.size[plane.u] * own.size[plane.v] : 0);
  std::vector<double> depths(row * static_cast<std::size_t>(whole.size[plane.v]), 0.0);
  InThreads(columns, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t column = begin; column < end; ++column)
    {
      const std::size_t u = column % own.size[plane.u], v = column / own.size[plane.u];
      std::size_t voxel = u * stride[plane.u] + v * stride[plane.v];
      double sum = 0.0;
      for (int i = 0; i < own.size[axis]; ++i, voxel += stride[axis])
      {
        sum += extinction[voxel];
      }
      depths[(own.first[plane.v] + v) * row + own.first[plane.u] + u] = sum * whole.spacing[axis];
    }
  });
  return domain.Sum(depths);
}

/// Largest opacity of the three axis-parallel columns through each voxel of this rank. It stands for the largest
/// opacity along any ray through the voxel. Values of AsGoodAsOpaque and above are set to 1. Collective.
/// @param extinction  mean extinction of this rank's voxels, 1/length
std::vector<float> LargestOpacities(const Domain& domain, const std::vector<float>& extinction)
{
  std::array<std::vector<double>, 3> depths;
  for (int axis = 0; axis < 3; ++axis)
  {
    depths[axis] = ColumnDepths(domain, axis, extinction);
  }
  const Grid grid = domain.OwnGrid();
  const VoxelBox& own = domain.Own();
  std::vector<float> opacities(extinction.size());
  ForVoxels(extinction.size(), [&](std::size_t voxel) {
    const std::array<int, 3> place = grid.VoxelAt(voxel);
    float most = 0.0f;
    for (int axis = 0; axis < 3; ++axis)
    {
      const PlaneAxes plane = AcrossAxis(axis);
      const auto column = static_cast<std::size_t>(own.first[plane.u] + place[plane.u]) +
        static_cast<std::size_t>(own.first[plane.v] + place[plane.v]) *
          static_cast<std::size_t>(domain.Whole().size[plane.u]);
      most = std::max(most, static_cast<float>(depths[axis][column]));
    }
    opacities[voxel] = std::min(static_cast<float>(-std::expm1(-most) / AsGoodAsOpaque), 1.0f);
  });
  return opacities;
}

/// Factor k, at least 1, by which each voxel's optical depth is multiplied to compensate for blending in display values
/// (numerics.md, Eq. (112d)).
/// @param radiance  largest radiance that a ray receives from the voxel, 3 per voxel
/// @param colour    tone-mapped radiance, 4 per voxel
/// @param most      largest opacity along a ray through the voxel
std::vector<float> VeilFactors(const std::vector<float>& radiance, const std::vector<std::uint8_t>& colour,
  const std::vector<float>& most, const ToneMapping& tones)
{
  ToneMapping ofVeil = tones;
  ofVeil.exposure *= PartOfVeil;
  const std::vector<std::uint8_t> veil = ToneMap(radiance, {}, ofVeil);
  std::vector<float> factors(colour.size() / 4, 1.0f);
  ForVoxels(factors.size(), [&](std::size_t voxel) {
    const std::uint8_t* const whole = &colour[4 * voxel];
    const std::uint8_t* const dimmed = &veil[4 * voxel];
    const double shown = whole[0] + whole[1] + whole[2];
    const double ratio = shown > 0.0 ? (dimmed[0] + dimmed[1] + dimmed[2]) / shown : 0.0;
    const double factor = std::log1p(-std::min(ratio, 0.99)) / std::log1p(-PartOfVeil * std::max(most[voxel], 1e-6f));
    factors[voxel] = static_cast<float>(std::max(factor, 1.0));
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

LitColor ColorLitMedium(const Domain& domain, const Medium& medium, const Field& fluence, const ToneMapping& tones)
{
  SourceFunction source;
  domain.Collective([&] {
    Check(tones);
    source = domain.IsEmpty() ? SourceFunction() : SourceFunctionOf(medium, fluence);
  });
  ToneMapping used = tones;
  used.exposure = tones.exposure > 0.0 ? tones.exposure : ExposureAlongAxes(domain, source);
  const std::vector<float> most = LargestOpacities(domain, source.extinction);
  ForVoxels(most.size(), [&](std::size_t voxel) {
    for (std::size_t c = 0; c < 3; ++c)
    {
      source.radiance[3 * voxel + c] *= most[voxel];
    }
  });
  FillEmptyVoxels(domain, source);

  LitColor lit;
  lit.exposure = used.exposure;
  lit.rgba = ToneMap(source.radiance, {}, used);
  const std::vector<float> factors = VeilFactors(source.radiance, lit.rgba, most, used);
  const double densest = domain.Max(LargestProduct(factors, source.extinction));
  const double edge = ShortestEdge(domain.Whole());
  lit.distance = densest > 0.0 ? std::max(edge, ResolvedDepth / densest) : edge;
  ForVoxels(factors.size(), [&](std::size_t voxel) {
    const double opacity = -std::expm1(-lit.distance * factors[voxel] * source.extinction[voxel]);
    lit.rgba[4 * voxel + 3] = static_cast<std::uint8_t>(255.0 * opacity + 0.5);
  });
  return lit;
}
}
