#include "LightPropagation/Accuracy/ErrorEstimate.h"

#include "Device/Errors.h"
#include "Medium/BoxFaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr double MostCorrelated = 0.99; ///< largest correlation of errors in neighbouring voxels that is distinguished
constexpr double FinePart = 0.8;        ///< fraction of the progress that is attributed to the solve on the fine grid

/// Number of directions per cube face of the second coarse solve, whose difference from the first coarse solve gives
/// the angular error. It is smaller than `directionsPerFace`, unless that is 1. If directions form an even number of
/// rows on a face, they also do so in the second solve.
int OtherDirections(int directionsPerFace)
{
  const int edge = static_cast<int>(std::lround(std::sqrt(static_cast<double>(directionsPerFace))));
  const int step = edge % 2 == 0 && edge > 2 ? 2 : 1;
  const int other = edge == 1 ? 2 : step * std::max(1, static_cast<int>(std::lround(0.6 * edge / step)));
  return other * other;
}

/// Ratio of the angular error of a solution with `directions` per cube face to its difference from the solution with
/// `others` per cube face.
/// @param order  order of convergence: error ~ (number of directions)^-order
double PartOfDifference(int directions, int others, double order)
{
  const double ratio = std::pow(static_cast<double>(others) / directions, order);
  return ratio < 1.0 ? ratio / (1.0 - ratio) : ratio / (ratio - 1.0);
}

/// Smooths an array [outer][count][inner] along its middle index: replaces each value by the mean of itself and its
/// neighbours.
void SmoothAlong(std::vector<double>& values, std::size_t count, std::size_t inner)
{
  const std::vector<double> rough = values;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const std::size_t place = i / inner % count;
    double sum = rough[i];
    int terms = 1;
    if (place > 0)
    {
      sum += rough[i - inner];
      ++terms;
    }
    if (place + 1 < count)
    {
      sum += rough[i + inner];
      ++terms;
    }
    values[i] = sum / terms;
  }
}

void Smooth(std::vector<double>& values, const Grid& grid, int channels)
{
  auto inner = static_cast<std::size_t>(channels);
  for (int size : grid.size)
  {
    SmoothAlong(values, static_cast<std::size_t>(size), inner);
    inner *= static_cast<std::size_t>(size);
  }
}

/// Whether a solve stopped after its first scattering order, before it converged. The error of the missing orders
/// cannot be estimated from one order.
bool IsStoppedTooSoonToTell(const LightField& light)
{
  return light.convergence.size() == 1 && light.convergence.front().residual > 0.0;
}

/// Variance of the fluence of fine voxels: the variance of the coarse voxel that contains a fine voxel, times the
/// squared ratio of their fluences, since brighter voxels (next to lamps) have larger errors.
/// @param averages, variance  fluence of the coarse voxels that overlap this rank's subdomain, and its variance
std::vector<double> InVoxels(const LightField& light, const std::vector<float>& averages,
  const std::vector<double>& variance, const Coarsening& seen)
{
  const auto channels = static_cast<std::size_t>(light.channels);
  std::vector<double> squares(light.fluence.size());
  for (std::size_t i = 0; i < squares.size(); ++i)
  {
    const std::size_t parent = seen.Parent(i / channels) * channels + i % channels;
    const double part = averages[parent] > 0.0f ? static_cast<double>(light.fluence[i]) / averages[parent] : 1.0;
    squares[i] = variance[parent] * part * part;
  }
  return squares;
}

double SumOfSquares(const std::vector<float>& values)
{
  return std::accumulate(
    values.begin(), values.end(), 0.0, [](double sum, double value) { return sum + value * value; });
}

double SumOf(const std::vector<double>& values)
{
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Computes the two components of the error of the fluence of coarse voxels, and the variance of this fluence, from a
/// fine solve and two coarse solves.
struct ErrorOfAverages
{
  /// factors that convert differences between solves to the errors due to voxel size and due to the number of
  /// directions
  double inSpace, partOfDifference;

  double InSpace(double fine, double same) const { return this->inSpace * (fine - same); }
  double InDirections(double same, double other) const { return this->partOfDifference * (same - other); }
  std::vector<double> Signed(
    const std::vector<float>& fine, const std::vector<float>& same, const std::vector<float>& other) const
  {
    std::vector<double> errors(fine.size());
    for (std::size_t i = 0; i < fine.size(); ++i)
    {
      errors[i] = this->InSpace(fine[i], same[i]) + this->InDirections(same[i], other[i]);
    }
    return errors;
  }
  std::vector<double> Variance(
    const std::vector<float>& fine, const std::vector<float>& same, const std::vector<float>& other) const
  {
    std::vector<double> variance(fine.size());
    for (std::size_t i = 0; i < fine.size(); ++i)
    {
      const double space = this->InSpace(fine[i], same[i]), directions = this->InDirections(same[i], other[i]);
      variance[i] = space * space + directions * directions;
    }
    return variance;
  }
};

/// Fluence of coarse voxels and its variance, for the coarse voxels that a rank owns or for all that overlap its
/// subdomain.
struct VarianceOfAverages
{
  const std::vector<float>& averages; ///< fluence of coarse voxels
  std::vector<double> variance;       ///< variance of the fluence
};

/// Sets fluenceError and relativeError of `light`. The squared errors of voxels are smoothed over neighbouring coarse
/// voxels and then scaled, so that their sum, relative to the sum of squared fluences, is the larger of two values: one
/// computed over coarse voxels, one over fine voxels (InVoxels). Coarse voxels alone do not resolve the decrease of
/// light next to lamps.
void WriteError(LightField& light, const CoarseBlocks& blocks, const VarianceOfAverages& own, VarianceOfAverages seen)
{
  const Coarsening& toSeen = blocks.Seen();
  std::vector<double> sums = blocks.Comm().Sum({ SumOfSquares(light.fluence), SumOfSquares(own.averages),
    SumOf(own.variance), SumOf(InVoxels(light, seen.averages, seen.variance, toSeen)) });
  const double fluences = sums[0], ofAverages = sums[1];
  const double asAverages = ofAverages > 0.0 ? fluences * sums[2] / ofAverages : 0.0;
  const double all = std::max(asAverages, sums[3]);
  Smooth(seen.variance, toSeen.Coarse(), light.channels);
  const std::vector<double> squares = InVoxels(light, seen.averages, seen.variance, toSeen);
  const double smoothed = blocks.Comm().Sum({ SumOf(squares) })[0], scale = smoothed > 0.0 ? all / smoothed : 1.0;
  const double residual = light.convergence.empty() ? 0.0 : light.convergence.back().residual;
  light.fluenceError.resize(light.fluence.size());
  double errors = 0.0;
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    const double fluence = light.fluence[i];
    const double square = scale * squares[i] + residual * residual * fluence * fluence;
    light.fluenceError[i] = static_cast<float>(std::sqrt(square));
    errors += square;
  }
  errors = blocks.Comm().Sum({ errors })[0];
  light.relativeError = fluences > 0.0 ? std::sqrt(errors / fluences) : 0.0;
}

/// Mean length over which errors have the same sign: the geometric mean, over the axes, of h (1 + r) / (1 - r) for the
/// correlation r of errors in neighbouring coarse voxels of edge h (numerics.md, Eq. (84b)). 0 without errors.
/// Collective.
/// @param errors  signed errors in the coarse voxels of blocks.Seen(), by channel
double CorrelationLength(const CoarseBlocks& blocks, const std::vector<double>& errors, int channels)
{
  const VoxelBox& own = blocks.Coarse().blocks[blocks.Comm().Rank()];
  const Grid& whole = blocks.Coarse().whole;
  const Grid seen = blocks.Seen().Coarse();
  const std::array<std::size_t, 3> strides = seen.Strides();
  std::vector<double> sums(6, 0.0); // by axis: products with the next voxel, and mean squares of both
  for (std::size_t i = 0; i < own.VoxelCount(); ++i)
  {
    const std::array<int, 3> at = own.VoxelAt(i);
    const std::size_t place = seen.IndexOf(blocks.SeenBox().Within(at));
    for (int axis = 0; axis < 3; ++axis)
    {
      for (int c = 0; c < channels && at[axis] + 1 < whole.size[axis]; ++c)
      {
        const double here = errors[place * channels + c], next = errors[(place + strides[axis]) * channels + c];
        sums[axis] += here * next;
        sums[3 + axis] += 0.5 * (here * here + next * next);
      }
    }
  }
  sums = blocks.Comm().Sum(sums);
  double logarithms = 0.0;
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (sums[3 + axis] > 0.0)
    {
      const double r = std::clamp(sums[axis] / sums[3 + axis], 0.0, MostCorrelated);
      logarithms += std::log(whole.spacing[axis] * (1.0 + r) / (1.0 - r));
      ++axes;
    }
  }
  return axes > 0 ? std::exp(logarithms / axes) : 0.0;
}

/// Smooths values in the cells of the box's faces within each face.
/// @param values  [cell][component] (BoxFaces.h)
void SmoothInFaces(std::vector<double>& values, const Grid& grid)
{
  const std::size_t width = values.size() / BoxFaceCellCount(grid);
  std::vector<double> smooth;
  for (int face = 0; face < 6; ++face)
  {
    const PlaneAxes axes = AcrossAxis(face / 2);
    const auto across = static_cast<std::size_t>(grid.size[axes.u]);
    const auto along = static_cast<std::size_t>(grid.size[axes.v]);
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(smooth.size());
    std::vector<double> ofFace(first, first + static_cast<std::ptrdiff_t>(across * along * width));
    SmoothAlong(ofFace, across, width);
    SmoothAlong(ofFace, along, across * width);
    smooth.insert(smooth.end(), ofFace.begin(), ofFace.end());
  }
  values = std::move(smooth);
}

/// Sets surfaceError, an error of first order in the voxel size, to the difference from the surface radiance of a
/// coarse grid. The squared errors of coarse cells are smoothed over neighbouring cells; the error of a cell is
/// proportional to its radiance. surfaceError stays empty if either grid has no surface radiance.
/// @param between  map between the whole grids
void WriteSurfaceError(LightField& light, const LightField& coarse, const Coarsening& between)
{
  const std::size_t cells = BoxFaceCellCount(between.Fine()), coarseCells = BoxFaceCellCount(between.Coarse());
  const std::size_t width = light.surfaceRadiance.size() / cells;
  if (width == 0 || coarse.surfaceRadiance.size() != coarseCells * width)
  {
    return;
  }
  std::vector<std::size_t> parents(cells);
  std::vector<double> means(coarseCells * width), counts(coarseCells), squares(coarseCells * width);
  ForBoxFaceCells(between.Fine(), [&](const BoxFaceCell& cell) {
    const std::array<int, 3> voxel = between.Coarse().VoxelAt(between.Parent(cell.voxel));
    parents[cell.number] = LayoutOfFace(between.Coarse(), cell.face).CellAt(voxel);
    counts[parents[cell.number]] += 1.0;
  });
  for (std::size_t i = 0; i < light.surfaceRadiance.size(); ++i)
  {
    const std::size_t parent = parents[i / width];
    means[parent * width + i % width] += light.surfaceRadiance[i] / counts[parent];
  }
  std::transform(means.begin(), means.end(), coarse.surfaceRadiance.begin(), squares.begin(),
    [](double fine, double other) { return (fine - other) * (fine - other); });
  SmoothInFaces(squares, between.Coarse());
  light.surfaceError.resize(light.surfaceRadiance.size());
  for (std::size_t i = 0; i < light.surfaceError.size(); ++i)
  {
    const std::size_t k = parents[i / width] * width + i % width;
    light.surfaceError[i] =
      means[k] <= 0.0 ? 0.0f : static_cast<float>(std::sqrt(squares[k]) * light.surfaceRadiance[i] / means[k]);
  }
}

/// Sets the error of a plane-parallel solve, which has only an angular error. The error is the difference from the
/// fluence of a solve with fewer polar cosines.
void WriteErrorOfCosines(LightField& light, const LightField& few)
{
  double errors = 0.0, fluences = 0.0;
  light.fluenceError.resize(light.fluence.size());
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    light.fluenceError[i] = std::abs(light.fluence[i] - few.fluence[i]);
    errors += static_cast<double>(light.fluenceError[i]) * light.fluenceError[i];
    fluences += static_cast<double>(light.fluence[i]) * light.fluence[i];
  }
  light.relativeError = fluences > 0.0 ? std::sqrt(errors / fluences) : 0.0;
}
}

void RefuseAsPublished(bool published, const std::string& property)
{
  Require(!published,
    property +
      " is for the conservative scheme: as published the error need not fall with voxels and directions. Set " +
      property + " to 0, or Scheme to conservative.");
}

ErrorParts WriteErrorEstimate(LightField& light, const CoarseBlocks& blocks, const std::vector<float>& same,
  const std::vector<float>& other, double partOfDifference, double orderInSpace)
{
  const double ratio = blocks.Ratio();
  const ErrorOfAverages errors = { ratio > 1.0 ? 1.0 / (std::pow(ratio, orderInSpace) - 1.0) : 0.0, partOfDifference };
  const std::vector<float> fine = blocks.Average(light.fluence, light.channels);
  double ofSpace = 0.0, ofDirections = 0.0;
  for (std::size_t i = 0; i < fine.size(); ++i)
  {
    const double space = errors.InSpace(fine[i], same[i]), directions = errors.InDirections(same[i], other[i]);
    ofSpace += space * space;
    ofDirections += directions * directions;
  }
  const std::vector<double> sums = blocks.Comm().Sum({ ofSpace, ofDirections, SumOfSquares(fine) });
  const std::vector<float> seen = blocks.SeenOf(fine, light.channels);
  const std::vector<float> seenSame = blocks.SeenOf(same, light.channels);
  const std::vector<float> seenOther = blocks.SeenOf(other, light.channels);
  light.errorLength = CorrelationLength(blocks, errors.Signed(seen, seenSame, seenOther), light.channels);
  WriteError(
    light, blocks, { fine, errors.Variance(fine, same, other) }, { seen, errors.Variance(seen, seenSame, seenOther) });
  const double scale = sums[2] > 0.0 ? 1.0 / sums[2] : 0.0;
  return { std::sqrt(scale * sums[0]), std::sqrt(scale * sums[1]),
    light.convergence.empty() ? 0.0 : light.convergence.back().residual };
}

LightField SolveWithErrorEstimate(const SceneBlock& scene, const PropagationSettings& settings, const Monitor& monitor,
  const PropagationSolver& solve, const ErrorOrders& orders)
{
  LightField light = solve(scene, settings, OfPart(monitor, 0.0, FinePart));
  if (light.polarNodes > 0)
  {
    PropagationSettings fewer = settings;
    fewer.polarNodes = 3 * light.polarNodes / 4;
    WriteErrorOfCosines(light, solve(scene, fewer, OfPart(monitor, FinePart, 1.0)));
    return light;
  }
  if (IsStoppedTooSoonToTell(light))
  {
    light.relativeError = std::numeric_limits<double>::quiet_NaN();
    return light;
  }

  const CoarseBlocks blocks(scene.domain.Comm(), scene.domain.Partition());
  const CoarseScene coarse(blocks, scene);
  PropagationSettings plain = settings;
  plain.netFlux = false;
  plain.storedDirections = 1;
  const int directions = light.directionsPerFace > 0 ? light.directionsPerFace : settings.directionsPerFace;
  plain.directionsPerFace = directions;
  plain.adaptDirections = false;
  plain.uncollidedDirections = light.uncollidedDirections; // the number chosen for the fine grid
  const LightField many = solve(coarse.Scene(), plain, OfPart(monitor, FinePart, 0.95));
  plain.directionsPerFace = OtherDirections(directions);
  if (light.uncollidedDirections > 0)
  {
    plain.uncollidedDirections = OtherDirections(light.uncollidedDirections);
  }
  const std::vector<float> few = solve(coarse.Scene(), plain, OfPart(monitor, 0.95, 1.0)).fluence;

  WriteErrorEstimate(light, blocks, many.fluence, few,
    PartOfDifference(directions, plain.directionsPerFace, orders.inDirections), orders.inSpace);
  WriteSurfaceError(light, many, Coarsening(scene.domain.Whole()));
  return light;
}
}
