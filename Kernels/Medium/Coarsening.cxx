#include "Medium/Coarsening.h"

#include "Device/HostThreads.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// One axis of the complete fine and coarse grids, in units of fine voxels.
struct CoarsenedAxis
{
  CoarsenedAxis(int fineOfAll, int coarseOfAll)
    : count(static_cast<std::size_t>(fineOfAll))
    , width(static_cast<double>(fineOfAll) / coarseOfAll)
  {
  }
  /// Lower end of a coarse voxel, in fine voxels; its upper end is `width` higher.
  double BeginOf(std::size_t coarse) const { return static_cast<double>(coarse) * this->width; }
  /// Whether fine voxel `fine` exists and begins below position `end`.
  bool Reaches(std::size_t fine, double end) const { return fine < this->count && fine < end - 1e-9; }

  std::size_t count; ///< number of fine voxels along the complete axis
  double width;      ///< width of a coarse voxel in fine voxels
};

/// Range of voxels along an axis that an array covers.
struct Part
{
  std::size_t first, size;
};

/// Means over coarse voxels along one axis. The input array [outer][fine voxel][inner] covers the fine voxels `from`
/// along the axis, and the result [outer][coarse voxel][inner] covers the coarse voxels `to`.
std::vector<float> AverageAlong(const CoarsenedAxis& axis, const float* values, std::size_t outer, const Part& from,
  const Part& to, std::size_t inner)
{
  std::vector<float> means(outer * to.size * inner);
  std::vector<double> sums(inner);
  for (std::size_t o = 0; o < outer; ++o)
  {
    for (std::size_t t = 0; t < to.size; ++t)
    {
      std::fill(sums.begin(), sums.end(), 0.0);
      const double begin = axis.BeginOf(to.first + t);
      const double end = begin + axis.width;
      for (std::size_t f = static_cast<std::size_t>(begin); axis.Reaches(f, end); ++f)
      {
        const double part = std::min<double>(end, f + 1) - std::max<double>(begin, f);
        const float* const row = values + (o * from.size + f - from.first) * inner;
        for (std::size_t i = 0; i < inner; ++i)
        {
          sums[i] += part * row[i];
        }
      }
      for (std::size_t i = 0; i < inner; ++i)
      {
        means[(o * to.size + t) * inner + i] = static_cast<float>(sums[i] / axis.width);
      }
    }
  }
  return means;
}

float Mix(float first, float second, float part)
{
  return first + part * (second - first);
}

Grid Halved(Grid grid)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = grid.Length(axis);
    grid.size[axis] = std::max(1, grid.size[axis] / 2);
    grid.spacing[axis] = length / grid.size[axis];
  }
  return grid;
}
}

Coarsening::Coarsening(const Grid& fine, const Grid& coarse)
  : FineGrid(fine)
  , CoarseGrid(coarse)
  , FinePart{ {}, fine.size }
  , CoarsePart{ {}, coarse.size }
  , FineOfAll(fine.size)
  , CoarseOfAll(coarse.size)
{
}

Coarsening::Coarsening(const Grid& fine)
  : Coarsening(fine, Halved(fine))
{
}

Coarsening Coarsening::PartOf(const VoxelBox& fine, const VoxelBox& coarse) const
{
  Coarsening part = *this;
  part.FineGrid = GridOfBox(fine, this->FineGrid);
  part.CoarseGrid = GridOfBox(coarse, this->CoarseGrid);
  part.FinePart = fine;
  part.CoarsePart = coarse;
  return part;
}

VoxelBox Coarsening::FineBox(const VoxelBox& coarse) const
{
  VoxelBox fine;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (coarse.VoxelCount() > 0)
    {
      const CoarsenedAxis of(this->FineOfAll[axis], this->CoarseOfAll[axis]);
      const auto first = static_cast<std::size_t>(coarse.first[axis]);
      const std::size_t last = first + static_cast<std::size_t>(coarse.size[axis]) - 1;
      const double end = of.BeginOf(last) + of.width;
      auto to = static_cast<std::size_t>(of.BeginOf(last));
      while (of.Reaches(to, end))
      {
        ++to;
      }
      fine.first[axis] = static_cast<int>(of.BeginOf(first));
      fine.size[axis] = static_cast<int>(to) - fine.first[axis];
    }
  }
  return fine;
}

VoxelBox Coarsening::CoarseBox(const VoxelBox& fine) const
{
  VoxelBox coarse;
  for (int axis = 0; axis < 3; ++axis)
  {
    const long all = this->FineOfAll[axis], fewer = this->CoarseOfAll[axis];
    // Index of the first coarse voxel whose centre is not below the lower side of fine voxel `side`. In units of fine
    // voxels, the centre of coarse voxel c is at (2 c + 1) all / (2 fewer), where `all` and `fewer` are the numbers of
    // fine and coarse voxels.
    const auto firstFrom = [=](long side) {
      return static_cast<int>((2 * fewer * side - all + 2 * all - 1) / (2 * all));
    };
    coarse.first[axis] = firstFrom(fine.first[axis]);
    coarse.size[axis] = firstFrom(fine.first[axis] + fine.size[axis]) - coarse.first[axis];
  }
  return coarse.VoxelCount() > 0 ? coarse : VoxelBox();
}

VoxelBox Coarsening::ParentBox(const VoxelBox& fine) const
{
  VoxelBox coarse;
  for (int axis = 0; axis < 3 && fine.VoxelCount() > 0; ++axis)
  {
    const auto parentOf = [&](int voxel) {
      return static_cast<int>((2L * voxel + 1) * this->CoarseOfAll[axis] / (2L * this->FineOfAll[axis]));
    };
    coarse.first[axis] = parentOf(fine.first[axis]);
    coarse.size[axis] = parentOf(fine.first[axis] + fine.size[axis] - 1) + 1 - coarse.first[axis];
  }
  return coarse;
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
  const auto part = [](const VoxelBox& box, int axis) {
    return Part{ static_cast<std::size_t>(box.first[axis]), static_cast<std::size_t>(box.size[axis]) };
  };
  std::vector<float> means;
  std::size_t inner = static_cast<std::size_t>(components);
  std::size_t outer = this->FinePart.VoxelCount();
  for (int axis = 0; axis < 3 && this->CoarsePart.VoxelCount() > 0; ++axis)
  {
    const Part from = part(this->FinePart, axis), to = part(this->CoarsePart, axis);
    outer /= from.size;
    means = AverageAlong(
      { this->FineOfAll[axis], this->CoarseOfAll[axis] }, axis == 0 ? values : means.data(), outer, from, to, inner);
    inner *= to.size;
  }
  return means;
}

std::vector<float> Coarsening::Average(const Field& values, const Field& weights) const
{
  const int components = values.HasColour() || weights.HasColour() ? 3 : 1;
  std::vector<float> products(this->FineGrid.VoxelCount() * components), plain(products.size());
  if (products.empty())
  {
    return products;
  }
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

/// Interpolation weights of a fine voxel along an axis: 1 - part for coarse voxel `first` and part for coarse voxel
/// `second`. Both are indices in the array of coarse values, which may cover only a box of the coarse grid.
struct Coarsening::Between
{
  std::size_t first, second;
  float part;
};

std::vector<Coarsening::Between> Coarsening::BetweenAlong(int axis) const
{
  const int fine = this->FineOfAll[axis], coarse = this->CoarseOfAll[axis], begin = this->CoarsePart.first[axis];
  std::vector<Between> places(static_cast<std::size_t>(this->FinePart.size[axis]));
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const double middle = this->FinePart.first[axis] + static_cast<double>(i) + 0.5;
    const double place = std::clamp(middle * coarse / fine - 0.5, 0.0, coarse - 1.0);
    const int first = static_cast<int>(place);
    places[i] = { static_cast<std::size_t>(first - begin),
      static_cast<std::size_t>(std::min(first + 1, coarse - 1) - begin), static_cast<float>(place - first) };
  }
  return places;
}

/// Interpolates a row of coarse values along x, at position (y, z), between the four nearest coarse rows.
void Coarsening::MixRows(
  const std::vector<float>& values, const Between& y, const Between& z, std::vector<float>& row) const
{
  const std::size_t layer = row.size() * static_cast<std::size_t>(this->CoarsePart.size[1]);
  const float* const low = values.data() + z.first * layer;
  const float* const high = values.data() + z.second * layer;
  const std::size_t near = y.first * row.size(), far = y.second * row.size();
  for (std::size_t i = 0; i < row.size(); ++i)
  {
    row[i] = Mix(Mix(low[near + i], low[far + i], y.part), Mix(high[near + i], high[far + i], y.part), z.part);
  }
}

std::vector<float> Coarsening::Refine(const std::vector<float>& values, int components) const
{
  const auto xs = this->BetweenAlong(0), ys = this->BetweenAlong(1), zs = this->BetweenAlong(2);
  const auto count = static_cast<std::size_t>(components);
  std::vector<float> refined(this->FinePart.VoxelCount() * count);
  InThreads(ys.size() * zs.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<float> row(static_cast<std::size_t>(this->CoarsePart.size[0]) * count);
    for (std::size_t line = begin; line < end; ++line)
    {
      this->MixRows(values, ys[line % ys.size()], zs[line / ys.size()], row);
      float* out = refined.data() + line * xs.size() * count;
      for (const Between& x : xs)
      {
        for (std::size_t c = 0; c < count; ++c)
        {
          *out++ = Mix(row[x.first * count + c], row[x.second * count + c], x.part);
        }
      }
    }
  });
  return refined;
}

std::size_t Coarsening::Parent(std::size_t fineVoxel) const
{
  std::size_t parent = 0, stride = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto size = static_cast<std::size_t>(this->FinePart.size[axis]);
    const auto fine = static_cast<std::size_t>(this->FinePart.first[axis]) + fineVoxel % size;
    const auto all = static_cast<std::size_t>(this->FineOfAll[axis]);
    const auto coarse = static_cast<std::size_t>(this->CoarseOfAll[axis]);
    parent += ((2 * fine + 1) * coarse / (2 * all) - this->CoarsePart.first[axis]) * stride;
    fineVoxel /= size;
    stride *= static_cast<std::size_t>(this->CoarsePart.size[axis]);
  }
  return parent;
}
}
