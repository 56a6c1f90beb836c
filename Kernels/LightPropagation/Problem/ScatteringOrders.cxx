#include "LightPropagation/Problem/ScatteringOrders.h"

#include "Device/HostThreads.h"
#include "Medium/VoxelSums.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tyndall
{
namespace
{
/// A medium is uneven if the optical thickness of the thickest line of voxels, divided by the mean over all lines
/// (weighted by thickness), is above this ratio.
constexpr double Uneven = 1.5;

/// Residual at which the number of orders is estimated: the default tolerance. The choice of a scheme must not depend
/// on the user's tolerance.
const double UsualTolerance = PropagationSettings().tolerance;
/// Extrapolation distance: distance beyond a face at which the diffuse flux extrapolates to zero, mean free paths
/// (numerics.md, Eq. (86)).
constexpr double Extrapolation = 1.42 / 2.0;
/// Optical thickness along a voxel's longest edge above which accelerated solves with angular moments take longer
/// (InMomentsOfThickVoxels).
constexpr double ThickVoxel = 10.0;
/// Optical thickness along two edges of a voxel, and albedo, above which successive scattering orders may grow if
/// sources by octant are used. They grow above 8 mean free paths and an albedo of 0.55 (numerics.md, section 6.5).
constexpr double GrowingThickness = 6.0, GrowingAlbedo = 0.5;

/// Ratio of a voxel's longest to its shortest edge above which DSA may not converge, and number of orders up to which
/// source iteration is used there instead.
constexpr double VeryFlat = 100.0, MostOrdersOfFlat = 1000.0;

/// Cost of an accelerated solve (`./run bench thick`). Times are relative to that of one scattering order of source
/// iteration in the same scene: `setUp` is the time of set-up and finish, `rows` the number of iterations, and
/// `correction` the time of an iteration's correction, in addition to its sweep. LightSources.cxx uses fixed totals
/// instead: 18 orders for DSA, 12 for coarse-mesh DSA.
struct AcceleratedTime
{
  double setUp, rows, correction;
  double InOrders() const { return this->setUp + this->rows * (1.0 + this->correction); }
};
constexpr AcceleratedTime InEvenMedia = { 7.0, 6.0, 3.0 };
constexpr AcceleratedTime InUnevenMedia = { 7.0, 7.0, 3.0 };
/// Times with angular moments, whose sweeps are expensive, and of a slab, whose diffusion system is small. For these,
/// only the totals were measured.
constexpr AcceleratedTime InMoments = { 5.0, 8.0, 1.0 };
constexpr AcceleratedTime InMomentsOfThickVoxels = { 8.0, 8.0, 3.0 };
constexpr AcceleratedTime InSlab = { 3.0, 5.0, 1.0 };
/// Times of coarse-mesh DSA (a diffusion correction on cells of several voxels). The number of iterations is 0 here and
/// set by TimeInCells().
constexpr AcceleratedTime InCells = { 3.0, 0.0, 0.4 };
/// An iteration of coarse-mesh DSA reduces the error by this factor times the albedo: 5 iterations at albedo 0.5, 7 at
/// 0.9 to 1.
constexpr double CellFall = 0.3;
/// Maximum optical thickness of a cell of coarse-mesh DSA where the extinction is largest
constexpr double CellAtMost = 1.0;
constexpr int MostHalvings = 3;
/// Set-up time of source iteration, relative to the time of one order: measured 0.8 in 100^3 voxels, 2 in 40^3.
constexpr double PlainSetUp = 0.8;

/// Sums of a quantity over the lines of voxels along each axis: [axis][position on the other two axes, the lower one
/// fastest].
using LineSums = std::array<std::vector<double>, 3>;

/// Sums value(voxel) along the lines of voxels of a grid.
/// @param value  function of the voxel's index; called from several threads
template <class Value>
LineSums SumAlongLines(const Grid& grid, const Value& value)
{
  const std::array<int, 3>& n = grid.size;
  LineSums lines;
  for (int axis = 0; axis < 3; ++axis)
  {
    lines[axis].assign(n[axis] > 0 ? grid.VoxelCount() / static_cast<std::size_t>(n[axis]) : 0, 0.0);
  }
  const auto addRows = [&](int y, int z, double* alongX, double* alongOther) {
    std::size_t i = grid.IndexOf({ 0, y, z });
    for (int x = 0; x < n[0]; ++x, ++i)
    {
      const double here = value(i);
      *alongX += here;
      alongOther[x] += here;
    }
  };
  InThreads(n[2], 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z)
    {
      for (int y = 0; y < n[1]; ++y)
      {
        addRows(y, static_cast<int>(z), &lines[0][z * n[1] + y], lines[1].data() + z * n[0]);
      }
    }
  });
  // Sums along z in a separate pass, because lines along z cross the planes that the threads above divide
  InThreads(n[1], 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
    {
      for (int z = 0; z < n[2]; ++z)
      {
        double unused = 0.0;
        addRows(static_cast<int>(y), z, &unused, lines[2].data() + y * n[0]);
      }
    }
  });
  return lines;
}

/// Mean optical thickness of lines of voxels along each axis. Light stays longest in the thickest lines, but leaks into
/// their neighbours. The estimate is therefore a geometric mean of the thickest line (exponent 1/3) and of the mean
/// line, weighted by thickness (exponent 2/3). With it, the predicted number of scattering orders is within two thirds
/// of the actual one for log-normal media of tau 1 to 12 and albedo 0.8 to 0.98; the thickest line alone overestimates
/// it up to three times (numerics.md, Eq. (86a)).
struct ThickLines
{
  ThickLines() = default; ///< lines in vacuum
  /// @param sigma_t  sums of the extinction along lines (SumAlongLines), 1/length
  ThickLines(const Grid& grid, const LineSums& sigma_t);

  std::array<double, 3> along = {};
  /// Whether the optical thickness of the thickest line of voxels is much larger than the mean over all lines
  bool uneven = false;
};

/// Properties of one channel from which the number of scattering orders is estimated.
struct ScatteringOfChannel
{
  /// Optical thickness of lines of voxels, with the transport extinction, by which light diffuses.
  ThickLines diffusing;
  /// Optical thickness of lines of voxels, with the extinction that sweeps use; unused if the degree of the angular
  /// moments is 0
  ThickLines swept;
  double albedo = 0.0; ///< mean albedo, from the scattering and extinction coefficients that sweeps use
};

/// Properties of a scene from which the number of scattering orders is estimated.
struct ScatteringOfScene
{
  Grid grid;
  std::array<bool, 3> periodic = {};
  std::array<Rgb, 6> faceAlbedo = {};
  int degree = 0; ///< degree of the angular moments
  bool isSlab = false;
  double thickest = 0.0; ///< largest extinction of any voxel and channel that the sweeps use, 1/length
  std::vector<ScatteringOfChannel> channels;
};

ThickLines::ThickLines(const Grid& grid, const LineSums& sigma_t)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    double all = 0.0, squares = 0.0;
    for (const double line : sigma_t[axis])
    {
      all += line;
      squares += line * line;
    }
    const double thickest = *std::max_element(sigma_t[axis].begin(), sigma_t[axis].end());
    const double mean = all > 0.0 ? squares / all : 0.0;
    this->along[axis] = grid.spacing[axis] * std::cbrt(mean * mean * thickest);
    this->uneven = this->uneven || thickest > Uneven * mean;
  }
}

/// Leakage of the slowest diffusion mode along an axis, relative to the extinction (numerics.md, Eq. (86)).
double LeakAlong(double longest, double extrapolations)
{
  const double extrapolated = longest + extrapolations;
  return Pi * Pi / 3.0 / (extrapolated * extrapolated);
}

/// Sum of the extrapolation distances at both faces normal to an axis, mean free paths. The distance grows with the
/// albedo of the face. Its limit is that of a perfect mirror: the medium's thickness plus the extrapolation distance at
/// the opposite face.
double BothExtrapolations(const ScatteringOfScene& scene, int axis, int channel, double longest)
{
  const auto beyond = [&](int face) {
    const double albedo = scene.faceAlbedo[2 * axis + face][channel];
    return albedo > 0.0 ? Extrapolation * (1.0 + albedo) / (1.0 - albedo) : Extrapolation;
  };
  const double low = beyond(0), high = beyond(1);
  return std::min(low, longest + high) + std::min(high, longest + low);
}

/// Optical thickness of the domain's lines of voxels. Collective.
/// @param value  value(voxel): extinction of this rank's voxels, 1/length
template <class Value>
ThickLines LinesOf(const Domain& domain, const Value& value)
{
  const LineSums own = SumAlongLines(domain.OwnGrid(), value);
  const VoxelBox& block = domain.Own();
  const std::array<int, 3>& n = domain.Whole().size;
  LineSums all;
  for (int axis = 0; axis < 3; ++axis)
  {
    const PlaneAxes axes = AcrossAxis(axis);
    all[axis].assign(static_cast<std::size_t>(n[axes.u]) * n[axes.v], 0.0);
    auto next = own[axis].begin();
    for (int v = 0; v < block.size[axes.v] && next != own[axis].end(); ++v)
    {
      const std::size_t row = static_cast<std::size_t>(block.first[axes.v] + v) * n[axes.u] + block.first[axes.u];
      std::copy_n(next, block.size[axes.u], all[axis].begin() + static_cast<std::ptrdiff_t>(row));
      next += block.size[axes.u];
    }
    all[axis] = domain.Sum(all[axis]);
  }
  return { domain.Whole(), all };
}

/// Mean albedo of a channel, weighted by sigma_s, from the coefficients that the sweeps use. Collective.
double AlbedoOf(const PropagationProblem& problem, int channel)
{
  const Medium& medium = problem.TheMedium();
  const double scattering =
    SumOverVoxels(medium.grid, [&](std::size_t i) { return double(problem.Scattering().SigmaS(i, channel)); });
  const double albedo = SumOverVoxels(medium.grid, [&](std::size_t i) {
    const double s = problem.Scattering().SigmaS(i, channel);
    return s > 0.0 ? s * s / (s + medium.sigma_a.At(i, channel)) : 0.0;
  });
  const std::vector<double> sums = problem.TheDomain().Sum(std::vector<double>{ scattering, albedo });
  return sums[0] > 0.0 ? sums[1] / sums[0] : 0.0;
}

/// Leakage of the slowest diffusion mode along all open axes, relative to the extinction (numerics.md, Eq. (86)).
double Leak(const ScatteringOfScene& scene, int channel)
{
  const std::array<double, 3>& longest = scene.channels[channel].diffusing.along;
  // With angular moments, light diffuses according to the transport extinction, but collides according to the larger
  // extinction of the sweeps. The leakage in each scattering order is therefore smaller.
  const bool inMoments = scene.degree > 0;
  const std::array<double, 3>& scattered = scene.channels[channel].swept.along;
  double leak = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double along = LeakAlong(longest[axis], BothExtrapolations(scene, axis, channel, longest[axis]));
    const double part = inMoments && longest[axis] > 0.0 ? longest[axis] / scattered[axis] : 1.0;
    leak += scene.periodic[axis] ? 0.0 : along * part;
  }
  return leak;
}

/// Largest extinction of any voxel and channel of the domain, as the sweeps use it, 1/length. Collective.
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
  return problem.TheDomain().Max(largest);
}

bool HasThickVoxels(const ScatteringOfScene& scene)
{
  return *std::max_element(scene.grid.spacing.begin(), scene.grid.spacing.end()) * scene.thickest > ThickVoxel;
}

bool Reflects(const ScatteringOfScene& scene)
{
  return std::any_of(scene.faceAlbedo.begin(), scene.faceAlbedo.end(), [](const Rgb& face) { return Sum(face) > 0.0; });
}

/// Whether each cell of coarse-mesh DSA consists of several voxels along every axis on which the grid has more than one
/// voxel, i.e. whether voxels are optically thin enough for such cells.
/// @param halvings  base-2 logarithm of the number of voxels per cell along each axis
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

/// Whether coarse-mesh DSA can be used: scattering is isotropic, the scene is no slab, no face reflects (cells would
/// have to predict the reflected light), and voxels are thin enough for cells of several voxels.
bool CanUseCells(const ScatteringOfScene& scene)
{
  return scene.degree == 0 && !scene.isSlab && !Reflects(scene) &&
    AreThinEnough(scene.grid, CellHalvings(scene.grid, scene.thickest));
}

/// Time of coarse-mesh DSA at an albedo. The correction concerns scattered light only: the lower the albedo, the fewer
/// iterations are needed.
AcceleratedTime TimeInCells(double albedo)
{
  const double rows = albedo > 0.0 ? std::log(UsualTolerance) / std::log(CellFall * albedo) : 0.0;
  return { InCells.setUp, rows, InCells.correction };
}

double OrdersUntilDone(double ratio)
{
  return ratio <= 0.0 ? 0.0 : ratio >= 1.0 ? 1e30 : std::log(UsualTolerance) / std::log(ratio);
}

AcceleratedTime AcceleratedTimeOf(const ScatteringOfScene& scene)
{
  if (CanUseCells(scene))
  {
    double albedo = 0.0;
    for (const ScatteringOfChannel& channel : scene.channels)
    {
      albedo = std::max(albedo, channel.albedo);
    }
    return TimeInCells(albedo);
  }
  if (scene.isSlab)
  {
    return InSlab;
  }
  if (scene.degree > 0)
  {
    return HasThickVoxels(scene) ? InMomentsOfThickVoxels : InMoments;
  }
  const bool uneven = std::any_of(scene.channels.begin(), scene.channels.end(),
    [](const ScatteringOfChannel& channel) { return channel.diffusing.uneven; });
  return uneven ? InUnevenMedia : InEvenMedia;
}

ScatteringOfScene ScatteringOf(const PropagationProblem& problem)
{
  const Domain& domain = problem.TheDomain();
  const TruncatedScattering& swept = problem.Scattering();
  ScatteringOfScene scene = { problem.Whole(), problem.Settings().periodic, problem.Shining().faceAlbedo,
    swept.Degree(), problem.IsSlab(), ThickestExtinction(problem), {} };
  for (int c = 0; c < problem.Channels(); ++c)
  {
    ScatteringOfChannel channel;
    channel.diffusing =
      LinesOf(domain, [&](std::size_t i) { return double(problem.TheMedium().TransportSigmaT(i, c)); });
    if (scene.degree > 0)
    {
      channel.swept = LinesOf(domain, [&](std::size_t i) { return double(swept.SigmaT(i, c)); });
    }
    channel.albedo = AlbedoOf(problem, c);
    scene.channels.push_back(channel);
  }
  return scene;
}

double OrdersNeeded(const ScatteringOfScene& scene)
{
  double slowest = 0.0;
  for (std::size_t c = 0; c < scene.channels.size(); ++c)
  {
    slowest = std::max(slowest, scene.channels[c].albedo / (1.0 + Leak(scene, static_cast<int>(c))));
  }
  return OrdersUntilDone(slowest);
}

bool ScatteredManyTimes(const ScatteringOfScene& scene)
{
  return PlainSetUp + OrdersNeeded(scene) > AcceleratedTimeOf(scene).InOrders();
}

/// Whether any voxel is so thick, and scatters so much, that source iteration with sources by octant may diverge.
/// Collective.
bool OctantOrdersMayGrow(const PropagationProblem& problem)
{
  const TruncatedScattering& scattering = problem.Scattering();
  const Grid& grid = problem.TheGrid();
  std::array<double, 3> edges = grid.spacing;
  std::sort(edges.begin(), edges.end());
  const double thick = GrowingThickness / edges[1];
  const bool allowed = problem.Settings().source != PropagationSource::Constant && scattering.Degree() == 0;
  bool any = false;
  for (int c = 0; c < problem.Channels() && allowed; ++c)
  {
    for (std::size_t i = 0; i < grid.VoxelCount() && !any; ++i)
    {
      const double sigma_t = scattering.SigmaT(i, c);
      any = sigma_t > thick && scattering.SigmaS(i, c) > GrowingAlbedo * sigma_t;
    }
  }
  return problem.TheDomain().Any(any);
}

/// Whether DSA may not converge, while source iteration does in an acceptable number of orders.
bool PlainOrdersAreSafer(const ScatteringOfScene& scene)
{
  return HasVeryFlatVoxels(scene.grid) && OrdersNeeded(scene) <= MostOrdersOfFlat;
}

/// Whether the settings request acceleration, or let it depend on the scene. Without scattering there is nothing to
/// accelerate.
bool MayBeAccelerated(const PropagationSettings& settings, bool scatters)
{
  return scatters &&
    (settings.source == PropagationSource::Linear ||
      (settings.acceleration == PropagationAcceleration::Automatic && settings.maximumOrders == 0));
}
}

double OrdersNeeded(const PropagationProblem& problem)
{
  return OrdersNeeded(ScatteringOf(problem));
}

bool ScatteredManyTimes(const PropagationProblem& problem)
{
  return ScatteredManyTimes(ScatteringOf(problem));
}

std::array<int, 3> CellHalvings(const PropagationProblem& problem)
{
  return CellHalvings(problem.Whole(), ThickestExtinction(problem));
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

bool HasVeryFlatVoxels(const Grid& grid)
{
  const auto [least, most] = std::minmax_element(grid.spacing.begin(), grid.spacing.end());
  return *most > VeryFlat * *least;
}

IterationScheme ChooseIterationScheme(const PropagationProblem& problem)
{
  const PropagationSettings& settings = problem.Settings();
  if (!MayBeAccelerated(settings, problem.Traits().scatters))
  {
    return IterationScheme::SourceIteration;
  }
  const ScatteringOfScene scene = ScatteringOf(problem);
  const bool plain = !ScatteredManyTimes(scene) || PlainOrdersAreSafer(scene);
  if (settings.source != PropagationSource::Linear && plain && !OctantOrdersMayGrow(problem))
  {
    return IterationScheme::SourceIteration;
  }
  return CanUseCells(scene) && settings.alongRays ? IterationScheme::CoarseMeshDsa : IterationScheme::Dsa;
}
}
