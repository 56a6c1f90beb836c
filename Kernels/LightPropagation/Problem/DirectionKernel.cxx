#include "LightPropagation/Problem/DirectionKernel.h"

#include "LightPropagation/Angular/AngularBasis.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Directions per face that are tested as incident ones, in addition to those of the set
constexpr int FromPerFace = 144;
constexpr double LeastPart = 1e-3;   ///< tolerance for rounding, relative to the mean
constexpr double MostDamping = 16.0; ///< damping s at which all moments vanish

/// Whether `omega` lies in one of the 48 parts of the sphere that are images of each other under rotations and
/// reflections of the cube. A quadrature and its functions, degree by degree, have that symmetry.
bool IsInOnePart(const std::array<double, 3>& omega)
{
  constexpr double Rounding = 1e-12;
  return omega[0] >= omega[1] - Rounding && omega[1] >= omega[2] - Rounding && omega[2] >= -Rounding;
}

std::vector<std::array<double, 3>> ComingFrom(const DirectionSet& set)
{
  std::vector<std::array<double, 3>> from = { { 1.0, 0.0, 0.0 } }; // beams are often parallel to an axis
  for (const DirectionSet& one : { set, EquiangularDirections(FromPerFace) })
  {
    for (const Direction& direction : one.directions)
    {
      if (IsInOnePart(direction.omega))
      {
        from.push_back(direction.omega);
      }
    }
  }
  return from;
}
}

DirectionKernel::DirectionKernel(const DirectionSet& set, int degree)
  : Degrees(degree + 1)
{
  const AngularBasis basis(set, degree);
  std::vector<std::vector<double>> functions;
  for (const Direction& direction : set.directions)
  {
    functions.push_back(basis.At(direction.omega));
  }
  for (const std::array<double, 3>& omega : ComingFrom(set))
  {
    const std::vector<double> there = basis.At(omega);
    for (const std::vector<double>& here : functions)
    {
      std::vector<double> parts(this->Degrees, 0.0);
      for (int i = 0; i < basis.Count(); ++i)
      {
        parts[AngularBasis::DegreeOf(i)] += here[i] * there[i];
      }
      this->Parts.insert(this->Parts.end(), parts.begin(), parts.end());
    }
  }
}

double DirectionKernel::Least(const std::vector<double>& moments) const
{
  double least = 1.0;
  for (std::size_t pair = 0; pair < this->Parts.size(); pair += this->Degrees)
  {
    double sum = 0.0;
    for (std::size_t l = 0; l < moments.size(); ++l)
    {
      sum += moments[l] * this->Parts[pair + l];
    }
    least = std::min(least, sum);
  }
  return least;
}

DeltaM WithoutNegatives(const DeltaM& truncated, const DirectionKernel& kernel)
{
  if (truncated.moments.size() < 2 || kernel.Least(truncated.moments) >= LeastPart)
  {
    return truncated;
  }
  const double g = truncated.forward + (1.0 - truncated.forward) * truncated.moments[1];
  const double forward = g < 0.0 ? 0.0 : truncated.forward; // there is no forward peak to remove
  const auto damped = [&](double s) {
    std::vector<double> moments = truncated.moments;
    for (std::size_t l = 0; l < moments.size(); ++l)
    {
      const double whole = truncated.forward + (1.0 - truncated.forward) * moments[l];
      moments[l] = (whole - forward) / (1.0 - forward) * std::exp(-s * static_cast<double>(l * (l + 1)));
    }
    return moments;
  };
  double low = 0.0, high = MostDamping;
  for (int i = 0; i < 20; ++i)
  {
    const double s = 0.5 * (low + high);
    (kernel.Least(damped(s)) >= LeastPart ? high : low) = s;
  }
  DeltaM positive = truncated;
  positive.moments = damped(high);
  positive.forward = (g - positive.moments[1]) / (1.0 - positive.moments[1]);
  return positive;
}
}
