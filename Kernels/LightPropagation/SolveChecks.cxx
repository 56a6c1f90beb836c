// What a solve must not hand on in silence: light that few rays stand for, and power that went nowhere.
#include "FusedSolver.h"

#include "../Device/Errors.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace tyndall
{
namespace
{
constexpr double MissedAtMost = 0.3; ///< by whole rays; a box of one voxel misses up to a fifth of one face's
constexpr double ImbalanceAtMost = 1e-2; ///< beyond any rounding

std::string Text(const char* format, double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}
}

/// What enters a face along rays that march along another axis is few rays where the box is thin for the planes that they march by.
/// Their power is right, but not where they enter.
void FusedSolver::CheckRays(const DirectionSet& set, RayStarts starts, const SweepBoundary& boundary) const
{
  const Grid& grid = this->TheMedium.grid;
  const std::array<bool, 3>& periodic = this->Settings.periodic;
  Rgb whole = {}, exact = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    const PlaneAxes axes = AcrossAxis(axis);
    const double planes = PlanesOfPattern(grid.size[axis], periodic[axis]);
    for (const Bundle& bundle : BundlesAlong(axis, grid, periodic, set, this->Settings.mapResolution, starts))
    {
      const std::array<double, 2> moves = { bundle.tangentU * planes, bundle.tangentV * planes };
      if (planes <= 2.0)
      {
        continue; // so few that it hardly matters in which
      }
      const std::array<double, 2> wholeMoves = { std::floor(bundle.startU + moves[0] + 1e-9),
        std::floor(bundle.startV + moves[1] + 1e-9) };
      for (const Member& member : bundle.members)
      {
        for (const int direction : { member.direction, member.opposite })
        {
          const bool swapped = member.uFromU == 0;
          const auto add = [&](int through, double exactRays, double wholeRays) {
            const bool upwards = set.directions[direction].omega[through] > 0.0;
            const Rgb radiance = boundary(direction, 2 * through + (upwards ? 0 : 1));
            for (int c = 0; c < this->Channels && !periodic[through]; ++c)
            {
              exact[c] += exactRays * radiance[c] * bundle.power;
              whole[c] += wholeRays * radiance[c] * bundle.power;
            }
          };
          const double across = static_cast<double>(grid.size[axes.u]) * grid.size[axes.v];
          add(axis, across, across);
          add(axes.u, moves[swapped] * grid.size[axes.v], wholeMoves[swapped] * grid.size[axes.v]);
          add(axes.v, moves[!swapped] * grid.size[axes.u], wholeMoves[!swapped] * grid.size[axes.u]);
        }
      }
    }
  }
  for (int c = 0; c < this->Channels; ++c)
  {
    if (std::abs(whole[c] - exact[c]) > MissedAtMost * exact[c])
    {
      throw InvalidInput("Whole rays bring " + Text("%.3g", 100.0 * whole[c] / exact[c]) +
        "% of the light that shines through the box's faces: too few of them meet the faces that shine, for voxels "
        "of " +
        Text("%g", grid.spacing[0]) + " x " + Text("%g", grid.spacing[1]) + " x " + Text("%g", grid.spacing[2]) +
        " are too unequal, or directions too few. Resample to voxels of more equal edges, or raise MapResolution, "
        "DirectionsPerFace or FirstFlightDirections.");
    }
  }
}

void FusedSolver::CheckBalance() const
{
  const double error = this->Result.balance.RelativeError(this->Channels);
  if (error <= ImbalanceAtMost)
  {
    return;
  }
  const Grid& grid = this->TheMedium.grid;
  std::size_t thickest = 0;
  float largest = 0.0f;
  for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < this->Channels; ++c)
    {
      if (this->SigmaT(i, c) > largest)
      {
        largest = this->SigmaT(i, c);
        thickest = i;
      }
    }
  }
  const double tau = largest * *std::max_element(grid.spacing.begin(), grid.spacing.end());
  const std::string what = std::isfinite(error)
    ? "The light does not balance: " + Text("%.2g", error) + " of the power is lost or made"
    : std::string("The light is not a number");
  throw InvalidInput(what + ", more than floats can carry through this medium. Its thickest voxel, " +
    VoxelName(grid, thickest) + ", has optical thickness " + Text("%.3g", tau) +
    "; beyond some hundred it is opaque, so give it less.");
}
}
