#include "LightPropagation/Conservative/SolveMemory.h"

#include "Device/Sizes.h"
#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "LightPropagation/ThickVoxels/OctantSources.h"

#include <algorithm>
#include <array>

namespace tyndall
{
namespace
{
/// Parameters that determine the memory of a solve.
struct SolveExtent
{
  std::array<int, 3> size; ///< number of voxels along each axis, of the domain or of a rank's block
  const PropagationSettings& settings;
  int channels = 1;
  int degree = 0; ///< highest degree of the angular moments
  IterationScheme how = IterationScheme::SourceIteration;
  bool byOctant = false; ///< uses sources by octant (OctantSources)
  bool byCells = false;  ///< stores light by cell of the box faces
  /// Whether several ranks solve. Each rank then sweeps its block one bundle of rays (directions with equal segments)
  /// at a time.
  bool ofBlock = false;
};
SolveExtent ExtentOf(const PropagationProblem& problem, IterationScheme how)
{
  SolveExtent solve = { problem.TheGrid().size, problem.Settings(), problem.Channels(), problem.Scattering().Degree(),
    how };
  solve.byOctant = OctantSources::Matter(problem);
  solve.ofBlock = !problem.TheDomain().IsSerial();
  solve.byCells = Reflects(problem.Shining()) || problem.Settings().facePower;
  return solve;
}

/// Number of floats per voxel and channel for the medium and for the arrays that sweeps read and write.
std::size_t ArraysOfLight(const SolveExtent& solve)
{
  const std::size_t degree = Count(solve.degree);
  const std::size_t moments = (degree + 1) * (degree + 1);
  const std::size_t medium = 2 + (degree > 0 ? degree + 2 : 0);
  const std::size_t flux = solve.settings.netFlux ? 3 : 0;
  const std::size_t shown = degree > 0 && solve.settings.storeMoments ? moments : 0;
  const std::size_t beams = degree > 0 ? 5 : 0;
  const std::size_t lost =
    solve.settings.IsPeriodic() ? moments : 0; // compensation of rounding errors in sums along periodic axes
  return medium + 2 * moments + lost + 1 + flux + shown + beams + (solve.settings.firstMoments ? 6 : 0);
}

/// Number of floats per voxel and channel that the iteration needs beyond the arrays of sweeps.
std::size_t ArraysOfOrders(const SolveExtent& solve)
{
  const std::size_t degree = Count(solve.degree);
  const std::size_t moments = (degree + 1) * (degree + 1);
  constexpr std::size_t OfOctants = 28, OfCells = 2, OfBalance = 34;
  switch (solve.how)
  {
    case IterationScheme::Dsa: return OfBalance + 2 * moments + (solve.settings.netFlux ? 6 : 0);
    case IterationScheme::CoarseMeshDsa: return OfCells;
    default: return solve.byOctant ? OfOctants : 0;
  }
}

/// Number of voxels in the largest plane of voxels perpendicular to an axis.
/// @param leastRow  shorter rows count as this number of voxels
std::size_t LargestPlane(const SolveExtent& solve, int leastRow = 1)
{
  std::size_t largest = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const PlaneAxes across = AcrossAxis(axis);
    largest = std::max(largest, Count(std::max(solve.size[across.u], leastRow)) * Count(solve.size[across.v]));
  }
  return largest;
}

/// Number of positions at which the parallel rays of one direction leave the box through faces parallel to their
/// marching axis, over all planes of voxels; largest of the three axes.
std::size_t MostBesidePlanes(const SolveExtent& solve)
{
  std::size_t most = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const PlaneAxes across = AcrossAxis(axis);
    most = std::max(most, Count(solve.size[axis]) * (Count(solve.size[across.u]) + Count(solve.size[across.v]) + 1));
  }
  return most;
}

/// Bytes of ray state in a sweep. CPU: rays of all bundles (groups of directions with equal segments) along one axis,
/// in both directions, and the planes being crossed. GPU: rays of all axes (of a rank's block: of one bundle) on both
/// sides of a plane, their sources, and the light that enters and leaves sideways.
std::size_t BytesOfSweep(const Device& device, const SolveExtent& solve)
{
  const std::size_t directions = Count(std::max(solve.settings.directionsPerFace, 1));
  const std::size_t values = sizeof(float) * Count(solve.channels);
  if (device.IsCpu())
  {
    // Padding at most doubles the length of rows with more than ShortestRow / 2 voxels.
    return 2 * values * LargestPlane(solve, ShortestRow / 2) * (2 * directions + 16 * 4 * 16);
  }
  const std::size_t rays = solve.ofBlock ? PartsOf(directions, std::size_t{ 4 }) : 6 * directions;
  const std::size_t beside = solve.ofBlock || solve.byCells ? 2 * MostBesidePlanes(solve) : 0;
  return values * rays * (LargestPlane(solve) * (solve.degree > 0 ? 3 : 2) + beside);
}

std::size_t BytesOf(const Device& device, const SolveExtent& solve)
{
  std::array<int, 3> size = solve.size;
  size[0] = solve.degree > 0 ? RoundUp(size[0], int{ MomentGroup }) : size[0];
  const VolumeLayout layout = { Grid{ size }, solve.channels };
  return sizeof(float) * layout.Values() * (ArraysOfLight(solve) + ArraysOfOrders(solve)) + BytesOfSweep(device, solve);
}

/// Memory budget of a device, without regard to the memory that the solve needs.
/// @param asked  settings.memoryBudget, bytes; 0: nine tenths of the free memory, or no limit if the device shares the
///   host's memory
MemoryBudget BudgetAskedFor(const Device& device, std::size_t asked)
{
  MemoryBudget budget;
  if (asked > 0 || !device.SharesHostMemory()) // else the device uses host memory without a limit
  {
    const std::size_t left = device.MemoryLimit() - std::min(device.BytesInUse(), device.MemoryLimit());
    budget.bytes = asked > 0 ? asked : left / 10 * 9;
    budget.spills = true;
  }
  return budget;
}
}

std::size_t BytesOfSolve(const Device& device, const PropagationProblem& problem, IterationScheme how)
{
  return BytesOf(device, ExtentOf(problem, how));
}

MemoryBudget BudgetOfSolve(const Device& device, const PropagationProblem& problem, IterationScheme how)
{
  const SolveExtent solve = ExtentOf(problem, how);
  MemoryBudget budget = BudgetAskedFor(device, solve.settings.memoryBudget);
  const bool streams = !(solve.ofBlock && device.IsCpu()); // on a CPU, sweeps of blocks work on host memory in place
  if (streams && budget.spills && BytesOf(device, solve) > budget.bytes)
  {
    budget.hostFrom = sizeof(float) * Grid{ solve.size }.VoxelCount();
  }
  return budget;
}
}
