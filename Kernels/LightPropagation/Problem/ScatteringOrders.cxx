#include "LightPropagation/Problem/ScatteringOrders.h"

#include "LightPropagation/Angular/RayBundles.h"
#include "Medium/VoxelSums.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tyndall
{
namespace
{
/// The default, not the user's: which method is used must not depend on the tolerance.
const double UsualTolerance = PropagationSettings().tolerance;
/// The distance beyond a face at which diffuse light would be zero, mean free paths (numerics.md, Eq. (86)).
constexpr double Extrapolation = 1.42 / 2.0;
constexpr double ThickVoxel = 10.0; ///< mean free paths along its longest edge, with which diffusion may gain nothing

/// What an accelerated solve takes, in plain scattering orders of the same scene (`./run bench thick`): to set it up
/// and to finish it, and of each row a sweep and its correction. UncollidedDirections.cxx has an older figure of its
/// own.
struct AcceleratedTime
{
  double setUp, rows, correction;
  double InOrders() const { return this->setUp + this->rows * (1.0 + this->correction); }
};
constexpr AcceleratedTime InEvenMedia = { 7.0, 6.0, 3.0 };
constexpr AcceleratedTime InUnevenMedia = { 7.0, 7.0, 3.0 };
/// Sweeps are dear in moments, and a slab's diffusion system is small: of these the sums alone were measured.
constexpr AcceleratedTime InMoments = { 5.0, 8.0, 1.0 };
constexpr AcceleratedTime InMomentsOfThickVoxels = { 8.0, 8.0, 3.0 };
constexpr AcceleratedTime InSlab = { 3.0, 5.0, 1.0 };
/// Rows are as many as CellRows has.
constexpr AcceleratedTime InCells = { 3.0, 0.0, 0.4 };
constexpr double CellFall = 0.3;   ///< of what is left, from row to row, times the albedo: 5 rows at 0.5, 7 at 0.9 to 1
constexpr double CellAtMost = 1.0; ///< optical width where the medium is thickest
constexpr int MostHalvings = 3;
constexpr double PlainSetUp = 0.8; ///< of orders one after the other: measured 0.8 in 100^3 voxels, 2 in 40^3

/// Of each channel, as light diffuses.
std::vector<ThickLines> DiffusingLines(const PropagationProblem& problem)
{
  const Grid& grid = problem.TheGrid();
  std::vector<ThickLines> lines;
  for (int c = 0; c < problem.Channels(); ++c)
  {
    const auto sigma_t = [&](std::size_t i) { return double(problem.TheMedium().TransportSigmaT(i, c)); };
    lines.emplace_back(grid, SumAlongLines(grid, sigma_t));
  }
  return lines;
}

/// What leaks out along an axis.
double LeakAlong(double longest, double extrapolations)
{
  const double extrapolated = longest + extrapolations;
  return Pi * Pi / 3.0 / (extrapolated * extrapolated);
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

/// Of what is scattered as sweeps carry it, in the mean.
double AlbedoOf(const PropagationProblem& problem, int channel)
{
  const Medium& medium = problem.TheMedium();
  const double scattering =
    SumOverVoxels(medium.grid, [&](std::size_t i) { return double(problem.Scattering().SigmaS(i, channel)); });
  const double albedo = SumOverVoxels(medium.grid, [&](std::size_t i) {
    const double s = problem.Scattering().SigmaS(i, channel);
    return s > 0.0 ? s * s / (s + medium.sigma_a.At(i, channel)) : 0.0;
  });
  return scattering > 0.0 ? albedo / scattering : 0.0;
}

/// What leaks out along axes that are not periodic, of the slowest mode, over what is extinguished (numerics.md,
/// Eq. (86)).
/// @param longest  lines as light diffuses, of the channel
double Leak(const PropagationProblem& problem, int channel, const std::array<double, 3>& longest)
{
  const Grid& grid = problem.TheMedium().grid;
  // Light diffuses as far as transport has it, but is scattered more often: each order does less.
  const bool inMoments = problem.Scattering().Degree() > 0;
  const std::array<double, 3> scattered = inMoments
    ? ThickLines(
        grid, SumAlongLines(grid, [&](std::size_t i) { return double(problem.Scattering().SigmaT(i, channel)); }))
        .along
    : longest;
  double leak = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double along = LeakAlong(longest[axis], BothExtrapolations(problem, axis, channel, longest[axis]));
    const double part = inMoments && longest[axis] > 0.0 ? longest[axis] / scattered[axis] : 1.0;
    leak += problem.Settings().periodic[axis] ? 0.0 : along * part;
  }
  return leak;
}

/// As sweeps carry light, 1/length, of all voxels and channels.
double ThickestExtinction(const PropagationProblem& problem)
{
  double largest = 0.0;
  for (int c = 0; c < problem.Channels(); ++c)
  {
    for (std::size_t i = 0; i < problem.TheGrid().VoxelCount(); ++i)
    {
      largest = std::max<double>(largest, problem.Scattering().SigmaT(i, c));
    }
  }
  return largest;
}

bool HasThickVoxels(const PropagationProblem& problem)
{
  const Grid& grid = problem.TheGrid();
  const double longest = *std::max_element(grid.spacing.begin(), grid.spacing.end());
  return longest * ThickestExtinction(problem) > ThickVoxel;
}

/// Light is scattered alike into all directions, no voxel is so thick that diffusion has to tell what leaves it, and
/// nothing comes back through the box's faces, which cells would have to forecast.
bool CanUseCells(const PropagationProblem& problem)
{
  if (problem.Scattering().Degree() > 0 || problem.IsSlab() || Reflects(problem.Shining()))
  {
    return false;
  }
  return AreThinEnough(problem.TheGrid(), CellHalvings(problem));
}

/// Rows of diffusion on cells: it corrects what is scattered, so the less that is, the faster it converges.
AcceleratedTime TimeInCells(double albedo)
{
  const double rows = albedo > 0.0 ? std::log(UsualTolerance) / std::log(CellFall * albedo) : 0.0;
  return { InCells.setUp, rows, InCells.correction };
}

double OrdersUntilDone(double ratio)
{
  return ratio <= 0.0 ? 0.0 : ratio >= 1.0 ? 1e30 : std::log(UsualTolerance) / std::log(ratio);
}

AcceleratedTime AcceleratedTimeOf(const PropagationProblem& problem, const std::vector<ThickLines>& lines)
{
  if (CanUseCells(problem))
  {
    double albedo = 0.0;
    for (int c = 0; c < problem.Channels(); ++c)
    {
      albedo = std::max(albedo, AlbedoOf(problem, c));
    }
    return TimeInCells(albedo);
  }
  if (problem.IsSlab())
  {
    return InSlab;
  }
  if (problem.Scattering().Degree() > 0)
  {
    return HasThickVoxels(problem) ? InMomentsOfThickVoxels : InMoments;
  }
  const bool uneven =
    std::any_of(lines.begin(), lines.end(), [](const ThickLines& ofChannel) { return ofChannel.uneven; });
  return uneven ? InUnevenMedia : InEvenMedia;
}

double OrdersAlong(const PropagationProblem& problem, const std::vector<ThickLines>& lines)
{
  double slowest = 0.0;
  for (int c = 0; c < problem.Channels(); ++c)
  {
    slowest = std::max(slowest, AlbedoOf(problem, c) / (1.0 + Leak(problem, c, lines[c].along)));
  }
  return OrdersUntilDone(slowest);
}
}

double OrdersNeeded(const PropagationProblem& problem)
{
  return OrdersAlong(problem, DiffusingLines(problem));
}

bool ScatteredManyTimes(const PropagationProblem& problem)
{
  const std::vector<ThickLines> lines = DiffusingLines(problem);
  return PlainSetUp + OrdersAlong(problem, lines) > AcceleratedTimeOf(problem, lines).InOrders();
}

bool ScatteredManyTimes(const std::vector<IsotropicChannel>& channels, bool inCells)
{
  double slowest = 0.0, albedo = 0.0;
  bool uneven = false;
  for (const IsotropicChannel& channel : channels)
  {
    double leak = 0.0;
    for (const double along : channel.lines.along)
    {
      leak += LeakAlong(along, 2.0 * Extrapolation);
    }
    slowest = std::max(slowest, channel.albedo / (1.0 + leak));
    albedo = std::max(albedo, channel.albedo);
    uneven = uneven || channel.lines.uneven;
  }
  const AcceleratedTime time = inCells ? TimeInCells(albedo) : uneven ? InUnevenMedia : InEvenMedia;
  return PlainSetUp + OrdersUntilDone(slowest) > time.InOrders();
}

bool AreThinEnough(const Grid& grid, const std::array<int, 3>& halvings)
{
  bool thin = true, any = false;
  for (int axis = 0; axis < 3; ++axis)
  {
    thin = thin && (halvings[axis] > 0 || grid.size[axis] == 1);
    any = any || halvings[axis] > 0;
  }
  return thin && any;
}

std::array<int, 3> CellHalvings(const PropagationProblem& problem)
{
  return CellHalvings(problem.TheGrid(), ThickestExtinction(problem));
}

std::array<int, 3> CellHalvings(const Grid& grid, double thickest)
{
  std::array<int, 3> halvings = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    const double tau = thickest * grid.spacing[axis];
    int& times = halvings[axis];
    while (times < MostHalvings && tau * (2 << times) <= CellAtMost && grid.size[axis] > 1 << times)
    {
      ++times;
    }
  }
  return halvings;
}

OrdersAdded HowOrdersAreAdded(const PropagationProblem& problem)
{
  const PropagationSettings& settings = problem.Settings();
  const bool accelerated = settings.source == PropagationSource::Linear ||
    (settings.acceleration == PropagationAcceleration::Automatic && settings.maximumOrders == 0 &&
      problem.Traits().scatters && ScatteredManyTimes(problem));
  return !accelerated ? OrdersAdded::OneByOne : CanUseCells(problem) ? OrdersAdded::ByCells : OrdersAdded::ByBalance;
}
}
