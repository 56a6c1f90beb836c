#include "SweepWork.h"

#include "LightPropagation/Angular/RayBundles.h"
#include "LightPropagation/Sweep/SweepPlan.h"

#include <algorithm>

namespace bench
{
namespace
{
using namespace tyndall;

struct Count
{
  double operations, flops, loads, stores; ///< loads and stores of floats
};

// Of `extinguished`: clamp, n (3), r (2 multiply-adds), polynomial (5), q (2), 2^n (3), left (1), lost (2).
constexpr Count Exponential = { 19, 26, 0, 0 };

// cross_voxels, a segment of a bundle: tau, the exponential, mean length, thin or not (3), taken, shine; sigma,
// 1/sigma, taken.
constexpr Count OfSegment = { 1 + Exponential.operations + 1 + 3 + 1 + 1, 1 + Exponential.flops + 1 + 2 + 1, 3, 1 };
// In a thin row: tau, the polynomial (5), mean length, change, shine; sigma.
constexpr Count OfThinSegment = { 9, 14, 1, 0 };
// The same for each channel: the source's gain, the deposit; source, path.
constexpr Count OfSegmentChannel = { 2, 3, 2, 1 };
// For each ray: into the sum, what is left of it.
constexpr Count OfRay = { 3, 5, 1, 1 };
constexpr Count OfThinRay = { 3, 4, 1, 1 };
// begin_rows and end_rows, a voxel each way along each axis: clamp, division; add_own_light.
constexpr Count OfPlane = { 2 + 8, 1 + 8, 5, 3 };
// The same for each channel: own light, unpacking.
constexpr Count OfPlaneChannel = { 2, 4, 5, 4 };
// scatter_order, a voxel and channel.
constexpr Count OfCollect = { 9, 11, 4, 3 };

void Add(SweepWork& work, const Count& count, double times)
{
  work.operations += times * count.operations;
  work.flops += times * count.flops;
  work.cached += times * sizeof(float) * (count.loads + count.stores);
}

/// Part of the rows of an axis' planes whose voxels are all thinner than `thin`, 1/length.
double ThinRows(const Medium& medium, const PlaneAxes& axes, double thin)
{
  const std::array<int, 3>& n = medium.grid.size;
  const std::array<std::size_t, 3> step = { 1, static_cast<std::size_t>(n[0]), static_cast<std::size_t>(n[0]) * n[1] };
  std::size_t rows = 0;
  for (int p = 0; p < n[axes.axis]; ++p)
  {
    for (int v = 0; v < n[axes.v]; ++v)
    {
      double most = 0.0;
      for (int u = 0; u < n[axes.u]; ++u)
      {
        const std::size_t i = p * step[axes.axis] + v * step[axes.v] + u * step[axes.u];
        most = std::max<double>(most, medium.sigma_a.At(i, 0) + medium.sigma_s.At(i, 0));
      }
      rows += most < thin ? 1 : 0;
    }
  }
  return static_cast<double>(rows) / (static_cast<double>(n[axes.axis]) * n[axes.v]);
}
}

SweepWork CountSweepWork(const Device& device, const Medium& medium, int directionsPerFace, int channels)
{
  constexpr double waysAndAxes = 6.0;
  const Grid& grid = medium.grid;
  const DirectionSet set = FittedDirections(directionsPerFace);
  SweepWork work;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<Bundle> bundles = BundlesAlong(axis, grid, {}, set, 1);
    SweepDescription sweep = { grid };
    sweep.channels = channels;
    const SweepPlan plan(device, sweep, { axis, bundles });
    const double thin = ThinRows(medium, plan.axes, plan.plane.thin);
    for (const Bundle& bundle : bundles)
    {
      double segments = 0.0;
      for (int k = 0; k < grid.size[axis]; ++k)
      {
        segments += 2.0 * bundle.Crossing(k).count / grid.size[axis]; // both ways
      }
      const double rays = segments * channels * static_cast<double>(bundle.members.size());
      Add(work, OfThinSegment, segments * thin);
      Add(work, OfSegment, segments * (1.0 - thin));
      Add(work, OfSegmentChannel, segments * channels);
      Add(work, OfThinRay, rays * thin);
      Add(work, OfRay, rays * (1.0 - thin));
    }
  }
  Add(work, OfPlane, waysAndAxes);
  Add(work, OfPlaneChannel, waysAndAxes * channels);
  Add(work, OfCollect, channels);
  // sigma_t and source are read, path is read and written; scatter_order reads four and writes three.
  work.bytes = sizeof(float) * (waysAndAxes * (1 + 3 * channels) + channels * (4 + 3));

  const double updates = static_cast<double>(set.directions.size()) * channels;
  work.operations /= updates;
  work.flops /= updates;
  work.bytes /= updates;
  work.cached /= updates;
  return work;
}
}
