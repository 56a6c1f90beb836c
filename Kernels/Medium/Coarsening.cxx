#include "Medium/Coarsening.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Means along one axis of an array of [outer][count][inner] values, to [outer][fewer][inner].
std::vector<float> AverageAlong(
  const float* values, std::size_t outer, std::size_t count, std::size_t fewer, std::size_t inner)
{
  std::vector<float> means(outer * fewer * inner);
  std::vector<double> sums(inner);
  const double width = static_cast<double>(count) / static_cast<double>(fewer);
  for (std::size_t o = 0; o < outer; ++o)
  {
    for (std::size_t to = 0; to < fewer; ++to)
    {
      std::fill(sums.begin(), sums.end(), 0.0);
      const double begin = to * width;
      const double end = begin + width;
      for (std::size_t from = static_cast<std::size_t>(begin); from < count && from < end - 1e-9; ++from)
      {
        const double part = std::min<double>(end, from + 1) - std::max<double>(begin, from);
        const float* const row = values + (o * count + from) * inner;
        for (std::size_t i = 0; i < inner; ++i)
        {
          sums[i] += part * row[i];
        }
      }
      for (std::size_t i = 0; i < inner; ++i)
      {
        means[(o * fewer + to) * inner + i] = static_cast<float>(sums[i] / width);
      }
    }
  }
  return means;
}
}

Coarsening::Coarsening(const Grid& fine, const Grid& coarse)
  : FineGrid(fine)
  , CoarseGrid(coarse)
{
}

Coarsening::Coarsening(const Grid& fine)
  : FineGrid(fine)
  , CoarseGrid(fine)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->CoarseGrid.size[axis] = std::max(1, fine.size[axis] / 2);
    this->CoarseGrid.spacing[axis] = fine.Length(axis) / this->CoarseGrid.size[axis];
  }
}

double Coarsening::Ratio() const
{
  double ratio = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (this->FineGrid.size[axis] > 1)
    {
      const double ofAxis = this->CoarseGrid.spacing[axis] / this->FineGrid.spacing[axis];
      ratio = ratio == 1.0 ? ofAxis : std::min(ratio, ofAxis);
    }
  }
  return ratio;
}

std::vector<float> Coarsening::Average(const float* values, int components) const
{
  const auto from = [&](int axis) { return static_cast<std::size_t>(this->FineGrid.size[axis]); };
  const auto to = [&](int axis) { return static_cast<std::size_t>(this->CoarseGrid.size[axis]); };
  const auto inner = static_cast<std::size_t>(components);
  const std::vector<float> x = AverageAlong(values, from(2) * from(1), from(0), to(0), inner);
  const std::vector<float> xy = AverageAlong(x.data(), from(2), from(1), to(1), to(0) * inner);
  return AverageAlong(xy.data(), 1, from(2), to(2), to(1) * to(0) * inner);
}

std::vector<float> Coarsening::Average(const Field& values, const Field& weights) const
{
  const int components = values.HasColour() || weights.HasColour() ? 3 : 1;
  std::vector<float> products(this->FineGrid.VoxelCount() * components), plain(products.size());
  float least = values.At(0, 0), largest = least;
  for (std::size_t i = 0; i < products.size(); ++i)
  {
    const float value = values.At(i / components, static_cast<int>(i % components));
    plain[i] = weights.At(i / components, static_cast<int>(i % components));
    products[i] = plain[i] * value;
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
  std::vector<float> means = this->Average(products.data(), components);
  const std::vector<float> sums = this->Average(plain.data(), components);
  for (std::size_t i = 0; i < means.size(); ++i)
  {
    means[i] = sums[i] > 0.0f ? std::clamp(means[i] / sums[i], least, largest) : 0.0f;
  }
  return means;
}

std::size_t Coarsening::Parent(std::size_t fineVoxel) const
{
  std::size_t parent = 0, stride = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto size = static_cast<std::size_t>(this->FineGrid.size[axis]);
    const auto coarse = static_cast<std::size_t>(this->CoarseGrid.size[axis]);
    parent += (2 * (fineVoxel % size) + 1) * coarse / (2 * size) * stride;
    fineVoxel /= size;
    stride *= coarse;
  }
  return parent;
}
}
