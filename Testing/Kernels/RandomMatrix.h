#pragma once

#include "LightPropagation/Diffusion/MultigridSolver.h"

#include <array>
#include <cmath>
#include <random>
#include <vector>

/// A diffusion matrix by chance, and its product with values in double.
class RandomMatrix
{
public:
  /// @param contrast  of conductances and losses, at most
  RandomMatrix(const std::array<int, 3>& size, const std::array<bool, 3>& periodic, double contrast)
    : Size(size)
    , Count(static_cast<std::size_t>(size[0]) * size[1] * size[2])
    , Conductance(3 * this->Count)
  {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> power(-1.0, 0.0);
    for (std::size_t i = 0; i < this->Count; ++i)
    {
      this->Loss.push_back(static_cast<float>(0.1 * std::pow(contrast, power(random))));
      for (int axis = 0; axis < 3; ++axis)
      {
        const bool passes = size[axis] > 1 && (periodic[axis] || this->At(i)[axis] > 0);
        this->Conductance[axis * this->Count + i] =
          passes ? static_cast<float>(std::pow(contrast, power(random))) : 0.0f;
      }
    }
  }

  std::vector<double> Times(const std::vector<double>& x) const
  {
    std::vector<double> product(this->Count);
    for (std::size_t i = 0; i < this->Count; ++i)
    {
      product[i] += this->Loss[i] * x[i];
      for (int axis = 0; axis < 3; ++axis)
      {
        const std::size_t j = this->Before(i, axis);
        const double flow = this->Conductance[axis * this->Count + i] * (x[i] - x[j]);
        product[i] += flow;
        product[j] -= flow;
      }
    }
    return product;
  }

  void LoadInto(tyndall::MultigridSolver& solver) const
  {
    solver.Conductance().Write(tyndall::InRows(solver.Rows(), this->Conductance, 3).data());
    solver.Loss().Write(tyndall::InRows(solver.Rows(), this->Loss).data());
    solver.Coarsen();
  }

  const std::vector<float>& Losses() const { return this->Loss; }
  /// Of low faces across an axis.
  std::vector<float> Conductances(int axis) const
  {
    const auto begin = this->Conductance.begin() + static_cast<std::ptrdiff_t>(axis * this->Count);
    return { begin, begin + static_cast<std::ptrdiff_t>(this->Count) };
  }

private:
  std::array<int, 3> At(std::size_t i) const
  {
    const int in = static_cast<int>(i);
    return { in % this->Size[0], in / this->Size[0] % this->Size[1], in / (this->Size[0] * this->Size[1]) };
  }
  std::size_t Before(std::size_t i, int axis) const
  {
    std::array<int, 3> at = this->At(i);
    at[axis] = (at[axis] + this->Size[axis] - 1) % this->Size[axis];
    return (static_cast<std::size_t>(at[2]) * this->Size[1] + at[1]) * this->Size[0] + at[0];
  }

  std::array<int, 3> Size;
  std::size_t Count;
  std::vector<float> Conductance, Loss;
};
