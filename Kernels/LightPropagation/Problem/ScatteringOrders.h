#pragma once

#include "Device/HostThreads.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "Medium/Grid.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Sums of a quantity over the lines of voxels along each axis, by axis and position on the other two axes, the lower
/// one fastest.
using LineSums = std::array<std::vector<double>, 3>;

/// @param value  value(voxel); called from several threads
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
  InThreads(n[1], 1, [&](std::size_t begin, std::size_t end) { // lines along z end in other planes
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

/// Optical thickness of lines of voxels along each axis. Light stays longest in the thickest lines, but leaks into
/// their neighbours. The estimate therefore averages the thickest line (weight 1/3) and all lines, each weighted by its
/// thickness (2/3). With it, the predicted number of scattering orders is within two thirds of the actual one for
/// log-normal media of tau 1 to 12 and albedo 0.8 to 0.98; the thickest line alone overestimates it up to three times
/// (numerics.md, Eq. (86a)).
struct ThickLines
{
  ThickLines() = default; ///< vacuum
  /// @param sigma_t  sums of the extinction, 1/length
  ThickLines(const Grid& grid, const LineSums& sigma_t);

  std::array<double, 3> along = {};
  bool uneven = false; ///< the thickest line is much thicker than the mean
};

/// Properties of one channel from which the number of scattering orders is estimated.
struct ScatteringOfChannel
{
  ThickLines diffusing; ///< thickness for diffusing light (transport extinction)
  ThickLines swept;     ///< thickness in the extinction that the sweeps use; unused without angular moments
  double albedo = 0.0;  ///< mean albedo, in the coefficients that the sweeps use
};

/// Properties of a scene from which the number of scattering orders is estimated.
struct ScatteringOfScene
{
  Grid grid;
  std::array<bool, 3> periodic = {};
  std::array<Rgb, 6> faceAlbedo = {};
  int degree = 0; ///< of angular moments
  bool isSlab = false;
  double thickest = 0.0; ///< largest extinction of any voxel and channel that the sweeps use, 1/length
  std::vector<ScatteringOfChannel> channels;
};
/// Collective, as are all functions here that take a problem.
ScatteringOfScene ScatteringOf(const PropagationProblem& problem);

/// Estimated number of scattering orders (source iterations) until about 1e-4 of the light is left: the rate of
/// diffusion in a slab with extrapolated boundaries (numerics.md, Eq. (86)), applied to thick lines of voxels.
double OrdersNeeded(const ScatteringOfScene& scene);
double OrdersNeeded(const PropagationProblem& problem);

/// Whether source iteration is predicted to take longer than an accelerated solve. Costs of set-up, sweeps and
/// corrections were measured (`./run bench thick`).
bool ScatteredManyTimes(const ScatteringOfScene& scene);
bool ScatteredManyTimes(const PropagationProblem& problem);

/// Iteration scheme for the fluence of all scattering orders.
enum class IterationScheme
{
  SourceIteration, ///< one sweep per scattering order; Conservative/SourceIteration.h
  /// Source iteration with a diffusion correction on cells of several voxels, for optically thin voxels
  CoarseMeshDsa,
  Dsa, ///< diffusion synthetic acceleration on the voxels; Conservative/Acceleration/DiffusionAcceleration.h
};
/// Fastest scheme for a serial solve. Collective.
IterationScheme FastestScheme(const PropagationProblem& problem);
/// Fastest scheme available on the problem's domain. Collective.
IterationScheme ChooseIterationScheme(const PropagationProblem& problem);
/// Whether the settings request acceleration, or let it depend on the scene.
bool MayBeAccelerated(const PropagationSettings& settings, bool scatters);

/// Base-2 logarithm of the number of voxels per cell of coarse-mesh DSA along each axis, such that a cell is at most
/// about one mean free path wide where the medium is thickest. All 0: voxels are too thick for cells of several voxels.
std::array<int, 3> CellHalvings(const PropagationProblem& problem);
/// @param thickest  the largest extinction, 1/length
std::array<int, 3> CellHalvings(const Grid& grid, double thickest);
/// Whether cells consist of several voxels along each axis on which the grid has more than one voxel.
bool AreThinEnough(const Grid& grid, const std::array<int, 3>& halvings);
}
