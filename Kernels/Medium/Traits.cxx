#include "Medium/Traits.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr float SameExtinction = 2e-7f; ///< relative: what rounding to float leaves of equal sums

/// One row of voxels, along x.
struct Row
{
  const Medium& medium;
  bool similarity;
  std::size_t first;
  int size;

  /// The largest of a field in the row, all channels; fields are not negative.
  float Largest(const Field& field) const
  {
    if (!field.values)
    {
      return 0.0f;
    }
    const float* begin = field.values + this->first * field.components;
    const int count = this->size * field.components;
    float largest = 0.0f;
    for (int i = 0; i < count; ++i)
    {
      largest = std::max(largest, begin[i]);
    }
    return largest;
  }

  bool IsEmptyAt(int x) const
  {
    float most = 0.0f;
    for (int c = 0; c < 3; ++c)
    {
      most = std::max({ most, this->medium.sigma_a.At(this->first + x, c), this->medium.sigma_s.At(this->first + x, c),
        this->medium.emission.At(this->first + x, c) });
    }
    return most == 0.0f;
  }

  bool IsGrey(const Field& field) const
  {
    bool grey = true;
    for (int x = 0; field.components == 3 && field.values && grey && x < this->size; ++x)
    {
      const float* rgb = field.values + (this->first + x) * 3;
      const float tolerance = SameExtinction * rgb[0];
      grey = std::abs(rgb[1] - rgb[0]) <= tolerance && std::abs(rgb[2] - rgb[0]) <= tolerance;
    }
    return grey;
  }

  bool IsGreyExtinction() const
  {
    bool grey = true;
    for (int x = 0; grey && x < this->size; ++x)
    {
      std::array<float, 3> sigma_t;
      for (int c = 0; c < 3; ++c)
      {
        const std::size_t voxel = this->first + x;
        sigma_t[c] = this->similarity ? this->medium.TransportSigmaT(voxel, c)
                                      : this->medium.sigma_a.At(voxel, c) + this->medium.sigma_s.At(voxel, c);
      }
      const float tolerance = SameExtinction * sigma_t[0];
      grey = std::abs(sigma_t[1] - sigma_t[0]) <= tolerance && std::abs(sigma_t[2] - sigma_t[0]) <= tolerance;
    }
    return grey;
  }
};

/// The box of what is not empty, row by row.
class FilledBox
{
public:
  explicit FilledBox(const Grid& grid)
    : Lower(grid.size)
    , Upper({ 0, 0, 0 })
  {
  }

  void Add(const Row& row, int y, int z)
  {
    this->Widen(1, y);
    this->Widen(2, z);
    int x = 0;
    while (x < this->Lower[0] && row.IsEmptyAt(x))
    {
      ++x;
    }
    this->Lower[0] = std::min(this->Lower[0], x);
    x = row.size;
    while (x > this->Upper[0] && row.IsEmptyAt(x - 1))
    {
      --x;
    }
    this->Upper[0] = std::max(this->Upper[0], x);
  }

  VoxelBox Box() const
  {
    VoxelBox box;
    for (int a = 0; a < 3 && this->Upper[0] > 0; ++a)
    {
      box.first[a] = this->Lower[a];
      box.size[a] = this->Upper[a] - this->Lower[a];
    }
    return box;
  }

private:
  void Widen(int axis, int to)
  {
    this->Lower[axis] = std::min(this->Lower[axis], to);
    this->Upper[axis] = std::max(this->Upper[axis], to + 1);
  }

  std::array<int, 3> Lower, Upper;
};
}

MediumTraits TraitsOf(const Medium& medium, bool similarity)
{
  MediumTraits traits;
  FilledBox filled(medium.grid);
  const std::array<int, 3>& n = medium.grid.size;
  for (int z = 0; z < n[2]; ++z)
  {
    for (int y = 0; y < n[1]; ++y)
    {
      const Row row = { medium, similarity, medium.grid.IndexOf({ 0, y, z }), n[0] };
      const bool absorbs = row.Largest(medium.sigma_a) > 0.0f;
      const bool scatters = row.Largest(medium.sigma_s) > 0.0f;
      const bool emits = row.Largest(medium.emission) > 0.0f;
      if (!absorbs && !scatters && !emits)
      {
        continue;
      }
      traits.absorbs = traits.absorbs || absorbs;
      traits.scatters = traits.scatters || scatters;
      traits.emits = traits.emits || emits;
      traits.grey =
        traits.grey && !medium.phase.HasColour() && row.IsGrey(medium.sigma_a) && row.IsGrey(medium.sigma_s);
      traits.greyExtinction = traits.greyExtinction && (traits.grey || row.IsGreyExtinction());
      if (emits && medium.emission.components == 3)
      {
        traits.emission.Add(medium.emission.values + 3 * row.first, static_cast<std::size_t>(row.size));
      }
      else if (emits)
      {
        traits.emission.Add(Rgb{ 1.0, 1.0, 1.0 });
      }
      filled.Add(row, y, z);
    }
  }
  traits.isotropic = medium.phase.IsIsotropic() || !traits.scatters;
  traits.filled = filled.Box();
  return traits;
}
}
