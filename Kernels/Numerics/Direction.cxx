#include "Numerics/Direction.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"

#include <Eigen/Dense>

#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
/// Smallest number of directions whose weights are not negative when the nine moments 1, omega and omega omega are
/// prescribed.
constexpr int FewestForMoments = 16;
constexpr int MostDirections = 65536;

void CheckCount(int count, int fewest)
{
  if (count < fewest || count > MostDirections)
  {
    throw InvalidInput("The number of directions on the spiral is " + std::to_string(count) + "; it must be from " +
      std::to_string(fewest) + " to " + std::to_string(MostDirections) + ".");
  }
}
}

std::vector<Direction> SpiralDirections(int count)
{
  CheckCount(count, 1);
  const double turn = Pi * (3.0 - std::sqrt(5.0));
  std::vector<Direction> directions(count);
  for (int i = 0; i < count; ++i)
  {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double around = std::sqrt(1.0 - z * z);
    directions[i] = { { around * std::cos(turn * i), around * std::sin(turn * i), z }, 4.0 * Pi / count };
  }
  return directions;
}

std::vector<Direction> WeightedSpiralDirections(int count)
{
  CheckCount(count, FewestForMoments);
  std::vector<Direction> directions = SpiralDirections(count);
  // Rows: 1, omega and five independent products of its components, whose integrals are prescribed.
  Eigen::MatrixXd moments(9, count);
  for (int i = 0; i < count; ++i)
  {
    const auto& [x, y, z] = directions[i].omega;
    moments.col(i) << 1.0, x, y, z, x * x - 1.0 / 3.0, y * y - 1.0 / 3.0, x * y, y * z, z * x;
  }
  Eigen::VectorXd wanted = Eigen::VectorXd::Zero(9);
  wanted[0] = 4.0 * Pi;
  const Eigen::VectorXd even = Eigen::VectorXd::Constant(count, 4.0 * Pi / count);
  const Eigen::MatrixXd gram = moments * moments.transpose();
  const Eigen::VectorXd change = moments.transpose() * gram.ldlt().solve(wanted - moments * even);
  for (int i = 0; i < count; ++i)
  {
    directions[i].weight += change[i];
  }
  return directions;
}
}
