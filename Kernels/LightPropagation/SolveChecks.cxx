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
constexpr double MissedAtMost =
  0.3; ///< of the light that enters; a box of one voxel misses up to a fifth of one face's
constexpr double ImbalanceAtMost = 1e-2; ///< beyond any rounding

std::string Text(const char* format, double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}
}

/// W that sweeps bring along the directions of scattered light.
Rgb FusedSolver::PowerInSweeps() const
{
  Rgb expected = {};
  const SweepBoundary boundary = this->BoundaryOfOrder(0);
  const Grid& grid = this->TheMedium.grid;
  for (std::size_t d = 0; boundary && d < this->Directions.directions.size(); ++d)
  {
    const Direction& direction = this->Directions.directions[d];
    for (int axis = 0; axis < 3; ++axis)
    {
      const Rgb radiance = boundary(static_cast<int>(d), 2 * axis + (direction.omega[axis] > 0.0 ? 0 : 1));
      const double area =
        this->Settings.periodic[axis] ? 0.0 : grid.Length((axis + 1) % 3) * grid.Length((axis + 2) % 3);
      for (int c = 0; c < this->Channels; ++c)
      {
        expected[c] += direction.weight * std::abs(direction.omega[axis]) * area * radiance[c];
      }
    }
  }
  return expected;
}

/// Rays start on the lattice of the voxels. Through sides that are thin for the planes they march by hardly one comes.
void FusedSolver::CheckEntering(const Rgb& entered, const Rgb& expected) const
{
  const Grid& grid = this->TheMedium.grid;
  for (int c = 0; c < this->Channels; ++c)
  {
    const double part = expected[c] > 0.0 ? entered[c] / expected[c] : 1.0;
    if (!(std::abs(part - 1.0) <= MissedAtMost))
    {
      throw InvalidInput("Rays bring " + Text("%.3g", 100.0 * part) +
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
