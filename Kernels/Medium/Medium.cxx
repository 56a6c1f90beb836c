#include "Medium/Medium.h"

#include "Device/Errors.h"
#include "Device/HostThreads.h"
#include "Medium/FilledBricks.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
bool AnyVoxelIsThickerThan(double meanFreePaths, const Medium& medium)
{
  const double longest = *std::max_element(medium.grid.spacing.begin(), medium.grid.spacing.end());
  const int channels = medium.Channels();
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      if (longest * medium.TransportSigmaT(i, c) > meanFreePaths)
      {
        return true;
      }
    }
  }
  return false;
}

std::string VoxelName(const Grid& grid, std::size_t voxel)
{
  const std::array<int, 3> at = grid.VoxelAt(voxel);
  return "(" + std::to_string(at[0]) + ", " + std::to_string(at[1]) + ", " + std::to_string(at[2]) + ")";
}

void CheckComponents(const Field& field, const char* name)
{
  if (field.components != 1 && field.components != 3)
  {
    throw InvalidInput(std::string(name) + " has " + std::to_string(field.components) +
      " components a voxel; give it 1 (grey) or 3 (red, green, blue).");
  }
}

namespace
{
/// Largest spacing, in units of length. The smallest spacing is its inverse. Products of several areas then stay within
/// the range of doubles.
constexpr double LongestSpacing = 1e30;
constexpr double MostUnequal = 1e9; ///< largest ratio of the longest to the shortest spacing

/// Checks the values of a field. @throws InvalidInput for the first invalid value
void CheckField(const Field& field, const FilledBricks::Values& found, const char* name, const Grid& grid)
{
  const std::size_t count = found.sound ? 0 : grid.VoxelCount() * static_cast<std::size_t>(field.components);
  for (std::size_t i = 0; i < count; ++i)
  {
    if (!(field.values[i] >= 0.0f) || std::isinf(field.values[i]))
    {
      throw InvalidInput(std::string(name) + " is " + Text("%g", field.values[i]) + " in voxel " +
        VoxelName(grid, i / static_cast<std::size_t>(field.components)) +
        " (the first such voxel); it must be finite and not negative. Clean the input, for example with a Calculator.");
    }
  }
}

void CheckMeanCosines(const Medium& medium)
{
  const Field& g = medium.phase.G();
  if (!g.values)
  {
    return; // if g is not given by voxel, the phase function has checked it
  }
  CheckComponents(g, "g");
  const std::size_t count = medium.grid.VoxelCount() * static_cast<std::size_t>(g.components);
  if (!AnyInThreads(count, [&](std::size_t i) { return !(std::abs(g.values[i]) < 1.0f); }))
  {
    return;
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    if (!(std::abs(g.values[i]) < 1.0f))
    {
      throw InvalidInput("The mean cosine g is " + Text("%g", g.values[i]) + " in voxel " +
        VoxelName(medium.grid, i / static_cast<std::size_t>(g.components)) +
        " (the first such voxel); it must lie between -1 and 1, and be neither.");
    }
  }
}

/// Checks that sigma_a + sigma_s is at most LargestExtinction in each voxel.
void CheckExtinction(const Medium& medium, const FilledBricks& bricks)
{
  if (!medium.sigma_a.values && !medium.sigma_s.values)
  {
    return; // a grid without values may have more voxels than can be indexed
  }
  const int channels = medium.phase.HasColour() ? 3 : std::max(medium.sigma_a.components, medium.sigma_s.components);
  const auto extinctionOf = [&](std::size_t i, int c) {
    const double g = std::abs(medium.phase.MeanCosine(i, c));
    return medium.sigma_a.At(i, c) + (1.0 + g) * medium.sigma_s.At(i, c);
  };
  // sigma_a + (1 + |g|) sigma_s needs no test if sigma_a and sigma_s are at most `little`, since 1 + |g| is at most 2.
  constexpr float little = static_cast<float>(LargestExtinction / 4.0);
  if (bricks.absorption.largest <= little && bricks.scattering.largest <= little)
  {
    return;
  }
  for (std::size_t i = 0; i < medium.grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < channels; ++c)
    {
      const double sigma_t = extinctionOf(i, c);
      if (sigma_t > LargestExtinction)
      {
        throw InvalidInput("sigma_a and sigma_s add up to " + Text("%.3g", sigma_t) + " in voxel " +
          VoxelName(medium.grid, i) + " (the first such voxel), more than solvers can do (" +
          Text("%.3g", LargestExtinction) + "). From a thickness of some hundred on a voxel is opaque: give it less.");
      }
    }
  }
}
}

void Check(const Grid& grid)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double spacing = grid.spacing[axis];
    if (grid.size[axis] < 1)
    {
      throw InvalidInput("The grid has no voxels along " + std::string(1, "xyz"[axis]) + "; it needs at least one.");
    }
    if (!(spacing >= 1.0 / LongestSpacing && spacing <= LongestSpacing))
    {
      throw InvalidInput("The grid's spacing along " + std::string(1, "xyz"[axis]) + " is " + Text("%.3g", spacing) +
        "; it must be from 1e-30 to 1e30. Use another unit of length.");
    }
  }
  const auto [shortest, longest] = std::minmax_element(grid.spacing.begin(), grid.spacing.end());
  Require(!(*longest > MostUnequal * *shortest),
    "The grid's spacing is " + Text("%.3g", grid.spacing[0]) + ", " + Text("%.3g", grid.spacing[1]) + ", " +
      Text("%.3g", grid.spacing[2]) + ": one is more than " + Text("%.3g", MostUnequal) +
      " times another, which floats cannot follow rays through. Resample to voxels of more equal edges.");
}

namespace
{
/// Checks grid and components, which must be valid before values are read.
void CheckShape(const Medium& medium)
{
  Check(medium.grid);
  for (const auto& [field, name] : { std::pair(&medium.sigma_a, "sigma_a"), std::pair(&medium.sigma_s, "sigma_s"),
         std::pair(&medium.emission, "emission") })
  {
    if (field->values)
    {
      CheckComponents(*field, name);
    }
  }
}

void CheckValues(const Medium& medium, const FilledBricks& bricks)
{
  CheckField(medium.sigma_a, bricks.absorption, "sigma_a", medium.grid);
  CheckField(medium.sigma_s, bricks.scattering, "sigma_s", medium.grid);
  CheckMeanCosines(medium);
  CheckExtinction(medium, bricks);
  CheckField(medium.emission, bricks.emission, "emission", medium.grid);
}
}

void Check(const Medium& medium)
{
  CheckShape(medium);
  const bool values = medium.sigma_a.values || medium.sigma_s.values || medium.emission.values;
  CheckValues(medium,
    values ? FindFilledBricks(medium) : FilledBricks()); // without values there may be more voxels than can be indexed
}

FilledBricks CheckedBricks(const Medium& medium)
{
  CheckShape(medium);
  FilledBricks bricks = FindFilledBricks(medium);
  CheckValues(medium, bricks);
  return bricks;
}
}
