#include "ThickScenes.h"

#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace bench
{
namespace
{
using namespace tyndall;

constexpr int BlockEdge = 8; ///< voxels
constexpr double BlockContrast = 100.0;
constexpr double Deviation = 1.5; ///< of the logarithm

const char* NameOf(ThickMedium kind)
{
  switch (kind)
  {
    case ThickMedium::Blocks: return "blocks 1:100";
    case ThickMedium::LogNormal: return "log-normal";
    default: return "homogeneous";
  }
}

std::vector<double> Blocks(int edge)
{
  std::vector<double> values;
  ForGridVoxels({ edge, edge, edge }, [&](std::size_t, int x, int y, int z) {
    values.push_back((x / BlockEdge + y / BlockEdge + z / BlockEdge) % 2 == 0 ? 1.0 : 1.0 / BlockContrast);
  });
  return values;
}

/// Means of each value and the next two along x, y and z, of numbers by chance.
std::vector<double> LogNormal(int edge)
{
  std::mt19937 random(20261124);
  std::normal_distribution<double> normal(0.0, Deviation * std::sqrt(27.0));
  std::vector<double> values(static_cast<std::size_t>(edge) * edge * edge);
  std::generate(values.begin(), values.end(), [&] { return normal(random); });
  std::size_t step = 1;
  for (int axis = 0; axis < 3; ++axis, step *= edge)
  {
    const std::vector<double> rough = values;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      values[i] = (rough[i] + rough[(i + step) % rough.size()] + rough[(i + 2 * step) % rough.size()]) / 3.0;
    }
  }
  std::transform(values.begin(), values.end(), values.begin(), [](double value) { return std::exp(value); });
  return values;
}

/// Extinction over its mean.
std::vector<double> ShapeOf(ThickMedium kind, int edge)
{
  std::vector<double> values = kind == ThickMedium::Blocks ? Blocks(edge)
    : kind == ThickMedium::LogNormal                       ? LogNormal(edge)
                                                           : std::vector<double>(std::size_t(edge) * edge * edge, 1.0);
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  std::transform(values.begin(), values.end(), values.begin(), [mean](double value) { return value / mean; });
  return values;
}
}

ThickScene::ThickScene(ThickMedium kind, int edge, double tau, double albedo)
  : name(NameOf(kind) + tyndall::Text(", tau %g", tau) + tyndall::Text(", albedo %g", albedo))
{
  for (const double shape : ShapeOf(kind, edge))
  {
    const double extinction = tau * shape;
    this->SigmaS.push_back(static_cast<float>(albedo * extinction));
    this->SigmaA.push_back(static_cast<float>(extinction - albedo * extinction));
  }
  this->medium.grid.size = { edge, edge, edge };
  this->medium.grid.spacing = { 1.0 / edge, 1.0 / edge, 1.0 / edge };
  this->medium.sigma_a = { this->SigmaA.data(), 1 };
  this->medium.sigma_s = { this->SigmaS.data(), 1 };
  this->light.faces[4] = { 1.0, 1.0, 1.0 };
}
}
