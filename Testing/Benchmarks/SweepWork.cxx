#include "SweepWork.h"

#include "LightPropagation/RayPattern.h"

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

// stage_row, a segment of a bundle: tau, the exponential, mean length, thin or not (3), taken, shine; sigma, 1/sigma, taken.
constexpr Count OfSegment = { 1 + Exponential.operations + 1 + 3 + 1 + 1, 1 + Exponential.flops + 1 + 2 + 1, 3, 1 };
// The same for each channel: the source's gain, the deposit; source, path.
constexpr Count OfSegmentChannel = { 2, 3, 2, 1 };
// For each ray: into the sum, what is left of it.
constexpr Count OfRay = { 3, 5, 1, 1 };
// begin_planes and end_planes, a voxel each way along each axis: clamp, division; add_own_light.
constexpr Count OfPlane = { 2 + 8, 1 + 8, 5, 3 };
// The same for each channel: own light, unpacking.
constexpr Count OfPlaneChannel = { 2, 4, 5, 4 };
// collect, a voxel and channel.
constexpr Count OfCollect = { 9, 11, 4, 3 };

void Add(SweepWork& work, const Count& count, double times)
{
  work.operations += times * count.operations;
  work.flops += times * count.flops;
  work.cached += times * sizeof(float) * (count.loads + count.stores);
}
}

SweepWork CountSweepWork(const Grid& grid, int directionsPerFace, int channels)
{
  constexpr double waysAndAxes = 6.0;
  const DirectionSet set = SoundDirections(directionsPerFace);
  SweepWork work;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const Bundle& bundle : BundlesAlong(axis, grid, set, 1))
    {
      double segments = 0.0;
      for (int k = 0; k < grid.size[axis]; ++k)
      {
        segments += 2.0 * bundle.Crossing(k).count / grid.size[axis]; // both ways
      }
      Add(work, OfSegment, segments);
      Add(work, OfSegmentChannel, segments * channels);
      Add(work, OfRay, segments * channels * static_cast<double>(bundle.members.size()));
    }
  }
  Add(work, OfPlane, waysAndAxes);
  Add(work, OfPlaneChannel, waysAndAxes * channels);
  Add(work, OfCollect, channels);
  // sigma_t and source are read, path is read and written; collect reads four and writes three.
  work.bytes = sizeof(float) * (waysAndAxes * (1 + 3 * channels) + channels * (4 + 3));

  const double updates = static_cast<double>(set.directions.size()) * channels;
  work.operations /= updates;
  work.flops /= updates;
  work.bytes /= updates;
  work.cached /= updates;
  return work;
}
}
