#include "Photons/Importance/ImportanceMap.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace tyndall
{
namespace
{
/// Maximum number of passes that move density above the upper limit to other cells. Each pass leaves fewer cells above
/// the limit.
constexpr int RoundsOfSharing = 64;

std::string LightName(int light)
{
  return light == EnvironmentLight ? "the environment" : "light " + std::to_string(light);
}

void CheckSquare(const ImportanceMap& map, std::size_t square)
{
  const float* density = map.density.data() + square * map.Cells();
  const std::size_t size = static_cast<std::size_t>(map.size);
  const auto place = [&](std::size_t i) {
    return "column " + std::to_string(i % size) + ", row " + std::to_string(i / size);
  };
  std::size_t zeros = 0, firstZero = 0;
  for (std::size_t i = map.Cells(); i-- > 0;)
  {
    if (!(density[i] >= 0.0f) || std::isinf(density[i]))
    {
      throw InvalidInput("The importance of " + LightName(map.lights[square]) + " is " + Text("%g", density[i]) +
        " in " + place(i) + "; it must be finite and not negative.");
    }
    zeros += density[i] == 0.0f ? 1 : 0;
    firstZero = density[i] == 0.0f ? i : firstZero;
  }
  Require(zeros < map.Cells(),
    "The importance of " + LightName(map.lights[square]) +
      " is 0 everywhere, so no photon could set out. Leave the map out to spread photons evenly.");
  if (zeros > 0)
  {
    throw InvalidInput("The importance of " + LightName(map.lights[square]) + " is 0 in " + std::to_string(zeros) +
      " cells, first in " + place(firstZero) +
      ": no photon would set out there, and its light would be missing. Give " + "every cell some importance.");
  }
}

/// Scales densities to a mean of 1 and limits each to `most`; the excess is distributed among the other cells.
std::vector<double> Capped(const float* density, std::size_t cells, double most)
{
  std::vector<double> capped(density, density + cells);
  const double largest = *std::max_element(capped.begin(), capped.end());
  const auto total = [&] { return std::accumulate(capped.begin(), capped.end(), 0.0); };
  // Densities are first divided by the largest one, so that their sum does not overflow
  std::for_each(capped.begin(), capped.end(), [&](double& d) { d /= largest; });
  const double scale = cells / total();
  std::for_each(capped.begin(), capped.end(), [&](double& d) { d *= scale; });
  for (int round = 0; round < RoundsOfSharing; ++round)
  {
    double full = 0.0, rest = 0.0;
    for (double& d : capped)
    {
      (d >= most ? full : rest) += d >= most ? most : d;
    }
    if (rest == 0.0 || *std::max_element(capped.begin(), capped.end()) <= most)
    {
      break;
    }
    const double share = (cells - full) / rest;
    std::for_each(capped.begin(), capped.end(), [&](double& d) { d = d >= most ? most : d * share; });
  }
  return capped;
}
}

int ImportanceMap::SquareOf(int light) const
{
  const auto square = std::find(this->lights.begin(), this->lights.end(), light);
  return square == this->lights.end() ? -1 : static_cast<int>(square - this->lights.begin());
}

void Check(const ImportanceMap& map)
{
  const std::size_t needed = map.Cells() * map.lights.size();
  Require((map.size >= 1 || map.lights.empty()) && map.density.size() == needed,
    "The importance map has " + std::to_string(map.density.size()) + " cells; " + std::to_string(map.lights.size()) +
      " lights of " + std::to_string(map.size) + " x " + std::to_string(map.size) + " need " + std::to_string(needed) +
      ", at least one each.");
  for (std::size_t square = 0; square < map.lights.size(); ++square)
  {
    CheckSquare(map, square);
  }
}

ImportanceSampler::ImportanceSampler(const float* density, int size, double most)
  : Size(size)
  , Table(size, size, Capped(density, static_cast<std::size_t>(size) * static_cast<std::size_t>(size), most))
{
}

ImportanceSampler::Place ImportanceSampler::At(double u, double v) const
{
  const DensityTable::Place at = this->Table.At(u, v);
  return { (at.column + at.across) / this->Size, (at.row + at.along) / this->Size, this->DensityOf(at.column, at.row) };
}

double ImportanceSampler::DensityOf(int column, int row) const
{
  return this->Table.WeightOf(column, row) * this->Size * this->Size / this->Table.Total();
}
}
