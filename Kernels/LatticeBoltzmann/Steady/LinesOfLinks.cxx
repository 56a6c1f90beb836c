#include "LatticeBoltzmann/Steady/LinesOfLinks.h"

#include "Device/Defines.h"
#include "Device/ExactValues.h"
#include "LatticeBoltzmann/LatticeShared.h"

namespace tyndall
{
namespace
{
constexpr double Thinnest = 0.05; ///< sigma_t h as which the preconditioner takes thinner voxels
}

std::string OptionsOfLines(const Device& device, const LatticeSettings& settings, const LatticeVoxels& voxels)
{
  return ExactOption(device) + Define("DIRECTIONS", settings.directions) + Define("BENDS", voxels.bends) +
    Define("PASSES_ALL", voxels.passesAll) + Define("REFLECTS", voxels.Reflects()) + Define("PUBLISHED", 0) +
    Define("ENDLESS", !voxels.endless.empty());
}

std::vector<double> GoesStraight(const LatticeBox& box, const LatticeVoxels& voxels)
{
  std::vector<double> straight;
  for (std::size_t i = 0; i < box.Count(); ++i)
  {
    const std::size_t known = box.Known(i);
    straight.push_back((1.0 - voxels.lost[known]) * (1.0 - voxels.turning[known]));
  }
  return straight;
}

std::array<std::size_t, 2> LinesOfPair(const std::array<int, 3>& size, int pair)
{
  std::vector<int> moving, still;
  for (int a = 0; a < 3; ++a)
  {
    (LatticeWays[2 * pair][a] != 0 ? moving : still).push_back(size[a]);
  }
  const auto lines = [](int first, int second) {
    return std::array<std::size_t, 2>{ static_cast<std::size_t>(first), static_cast<std::size_t>(second) };
  };
  return moving.size() == 1 ? lines(still[0], still[1]) : lines(moving[0] + moving[1], still[0]);
}

double LeastForDiffusion(const LatticeSettings& settings)
{
  return 1.0 / (0.5 + 1.0 / (3.0 * LatticeSquares(settings.directions) * Thinnest));
}
}
