#include "LightPropagation/Problem/ScatteringOrders.h"

#include "LightPropagation/Angular/RayBundles.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// The default, not the user's: which method is used must not depend on the tolerance.
const double UsualTolerance = PropagationSettings().tolerance;
/// The distance beyond a face at which diffuse light would be zero, mean free paths (numerics.md, Eq. (86)).
constexpr double Extrapolation = 1.42 / 2.0;
constexpr double ManyOrders = 40.0;       ///< source iteration that is dearer than acceleration
constexpr double ManyOrdersInSlab = 12.0; ///< the same in a slab, whose diffusion system is small

/// Optical thickness of the thickest line of voxels along an axis.
double LongestLine(const Medium& medium, int axis, int channel)
{
  const Grid& grid = medium.grid;
  const std::array<std::size_t, 3> step = { 1, static_cast<std::size_t>(grid.size[0]),
    static_cast<std::size_t>(grid.size[0]) * grid.size[1] };
  const int u = AcrossAxis(axis).u;
  const int v = AcrossAxis(axis).v;
  double longest = 0.0;
  for (int j = 0; j < grid.size[v]; ++j)
  {
    for (int i = 0; i < grid.size[u]; ++i)
    {
      double tau = 0.0;
      for (int k = 0; k < grid.size[axis]; ++k)
      {
        tau += medium.TransportSigmaT(i * step[u] + j * step[v] + k * step[axis], channel);
      }
      longest = std::max(longest, tau * grid.spacing[axis]);
    }
  }
  return longest;
}

/// Of both faces across an axis. A face that reflects sends light back as if the medium went on there, at most as a
/// mirror image of all that there is.
double BothExtrapolations(const PropagationProblem& problem, int axis, int channel, double longest)
{
  const auto beyond = [&](int face) {
    const double albedo = problem.Shining().faceAlbedo[2 * axis + face][channel];
    return albedo > 0.0 ? Extrapolation * (1.0 + albedo) / (1.0 - albedo) : Extrapolation;
  };
  const double low = beyond(0), high = beyond(1);
  return std::min(low, longest + high) + std::min(high, longest + low);
}

/// Of what is scattered, in the mean.
double AlbedoOf(const Medium& medium, int channel)
{
  double scattering = 0.0, albedo = 0.0;
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    const double s = medium.TransportSigmaS(i, channel);
    scattering += s;
    albedo += s > 0.0 ? s * s / (s + medium.sigma_a.At(i, channel)) : 0.0;
  }
  return scattering > 0.0 ? albedo / scattering : 0.0;
}
}

double OrdersNeeded(const PropagationProblem& problem)
{
  double slowest = 0.0;
  for (int c = 0; c < problem.Channels(); ++c)
  {
    double leak = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double longest = LongestLine(problem.TheMedium(), axis, c);
      const double extrapolated = longest + BothExtrapolations(problem, axis, c, longest);
      leak += problem.Settings().periodic[axis] ? 0.0 : Pi * Pi / 3.0 / (extrapolated * extrapolated);
    }
    slowest = std::max(slowest, AlbedoOf(problem.TheMedium(), c) / (1.0 + leak));
  }
  return slowest <= 0.0 ? 0.0 : slowest >= 1.0 ? 1e30 : std::log(UsualTolerance) / std::log(slowest);
}

bool ScatteredManyTimes(const PropagationProblem& problem)
{
  return OrdersNeeded(problem) > (problem.IsSlab() ? ManyOrdersInSlab : ManyOrders);
}

bool ToBeAccelerated(const PropagationProblem& problem)
{
  const PropagationSettings& settings = problem.Settings();
  return settings.source == PropagationSource::Linear ||
    (settings.acceleration == PropagationAcceleration::Automatic && settings.maximumOrders == 0 &&
      problem.Traits().scatters && ScatteredManyTimes(problem));
}
}
