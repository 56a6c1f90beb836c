#include "Medium/Traits.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double SameColour = 3e-7; ///< relative tolerance for rounding of multiples of one colour
}

void CommonColour::Add(const Rgb& rgb)
{
  for (int c = 0; c < 3; ++c)
  {
    this->Sum[c] += rgb[c];
  }
  if (!this->One || rgb == Rgb{})
  {
    return;
  }
  if (this->First == Rgb{})
  {
    this->First = rgb;
    return;
  }
  const int b = this->Brightest();
  for (int c = 0; c < 3; ++c)
  {
    const double expected = this->First[c] * rgb[b];
    this->One = this->One && std::abs(rgb[c] * this->First[b] - expected) <= SameColour * expected;
  }
}

void CommonColour::Add(const float* rgb, std::size_t count)
{
  for (std::size_t i = 0; i < count && this->One; ++i)
  {
    this->Add(Rgb{ rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2] });
  }
}

bool CommonColour::IsGrey() const
{
  return this->One && tyndall::IsGrey(this->First);
}

int CommonColour::Brightest() const
{
  return static_cast<int>(std::max_element(this->First.begin(), this->First.end()) - this->First.begin());
}

Rgb CommonColour::Relative() const
{
  const double most = this->First[this->Brightest()];
  return most > 0.0 ? Rgb{ this->First[0] / most, this->First[1] / most, this->First[2] / most } : Rgb{ 1.0, 1.0, 1.0 };
}

CommonColour ColourOf(const Illumination& illumination)
{
  CommonColour colour;
  colour.Add(illumination.sky);
  for (const Light& light : illumination.lights)
  {
    colour.Add(light.power);
  }
  for (const Rgb& face : illumination.faces)
  {
    colour.Add(face);
  }
  const auto& albedo = illumination.faceAlbedo;
  if (!std::all_of(albedo.begin(), albedo.end(), [](const Rgb& face) { return IsGrey(face); }))
  {
    colour.AddNone();
  }
  colour.Add(illumination.environment.radiance.data(), illumination.environment.radiance.size() / 3);
  return colour;
}

namespace
{
constexpr float SameExtinction = 2e-7f; ///< relative tolerance for rounding of sigma_a + sigma_s

/// The voxels of a row along x that lie in one brick.
struct Row
{
  const Medium& medium;
  bool similarity;
  std::size_t first;
  int size;

  /// Whether a field is above 0 in any voxel and channel of this row.
  bool Has(const Field& field) const
  {
    bool has = false;
    for (std::size_t i = this->first; field.values && !has && i < this->first + this->size; ++i)
    {
      has = field.At(i, 0) > 0.0f || field.At(i, 1) > 0.0f || field.At(i, 2) > 0.0f;
    }
    return has;
  }

  bool IsGrey(const Field& field) const
  {
    bool grey = true;
    for (int x = 0; field.HasColour() && field.values && grey && x < this->size; ++x)
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

/// Calls act(Row) for each row of voxels in filled bricks, in the order of voxels.
template <class Act>
void ForFilledRows(const Medium& medium, const FilledBricks& bricks, bool similarity, const Act& act)
{
  const std::array<int, 3>& n = medium.grid.size;
  for (int z = 0; z < n[2]; ++z)
  {
    for (int y = 0; y < n[1]; ++y)
    {
      const unsigned char* const filled = bricks.RowOf(y, z);
      for (int brick = 0; brick < bricks.count[0]; ++brick)
      {
        if (filled[brick])
        {
          const std::array<int, 3> at = { brick * BrickEdge, y, z };
          act(Row{ medium, similarity, medium.grid.IndexOf(at), std::min<int>(BrickEdge, n[0] - at[0]) });
        }
      }
    }
  }
}

/// Bounding box of the voxels with extinction or emission.
class FilledBox
{
public:
  explicit FilledBox(const Medium& medium)
    : Of(medium)
    , Lower(medium.grid.size)
    , Upper({ 0, 0, 0 })
  {
  }

  /// Determines the box from the filled bricks; only the outermost bricks are searched voxel by voxel.
  void Find(const FilledBricks& bricks)
  {
    const FilledBox ofBricks = this->BoxOf(bricks);
    for (int k = ofBricks.Lower[2]; k < ofBricks.Upper[2]; ++k)
    {
      for (int j = ofBricks.Lower[1]; j < ofBricks.Upper[1]; ++j)
      {
        for (int i = ofBricks.Lower[0]; i < ofBricks.Upper[0]; ++i)
        {
          if (ofBricks.IsAtSide({ i, j, k }) && bricks.RowOf(j * BrickEdge, k * BrickEdge)[i])
          {
            this->AddBrick({ i * BrickEdge, j * BrickEdge, k * BrickEdge });
          }
        }
      }
    }
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
  FilledBox BoxOf(const FilledBricks& bricks) const
  {
    FilledBox box(this->Of);
    for (std::size_t brick = 0; brick < bricks.filled.size(); ++brick)
    {
      if (bricks.filled[brick])
      {
        const int n = static_cast<int>(brick), nx = bricks.count[0], ny = bricks.count[1];
        box.Widen({ n % nx, n / nx % ny, n / (nx * ny) });
      }
    }
    return box;
  }

  void Widen(const std::array<int, 3>& at)
  {
    for (int a = 0; a < 3; ++a)
    {
      this->Lower[a] = std::min(this->Lower[a], at[a]);
      this->Upper[a] = std::max(this->Upper[a], at[a] + 1);
    }
  }

  bool IsAtSide(const std::array<int, 3>& at) const
  {
    bool side = false;
    for (int a = 0; a < 3; ++a)
    {
      side = side || at[a] == this->Lower[a] || at[a] + 1 == this->Upper[a];
    }
    return side;
  }

  void AddBrick(const std::array<int, 3>& first)
  {
    const std::array<int, 3>& n = this->Of.grid.size;
    for (int z = first[2]; z < std::min(first[2] + BrickEdge, n[2]); ++z)
    {
      for (int y = first[1]; y < std::min(first[1] + BrickEdge, n[1]); ++y)
      {
        for (int x = first[0]; x < std::min(first[0] + BrickEdge, n[0]); ++x)
        {
          const Row voxel = { this->Of, false, this->Of.grid.IndexOf({ x, y, z }), 1 };
          if (voxel.Has(this->Of.sigma_a) || voxel.Has(this->Of.sigma_s) || voxel.Has(this->Of.emission))
          {
            this->Widen({ x, y, z });
          }
        }
      }
    }
  }

  const Medium& Of;
  std::array<int, 3> Lower, Upper;
};

void AddGrey(const Row& row, MediumTraits& traits)
{
  traits.grey = traits.grey && row.IsGrey(row.medium.sigma_a) && row.IsGrey(row.medium.sigma_s);
  traits.greyExtinction = traits.greyExtinction && (traits.grey || row.IsGreyExtinction());
}

}

MediumTraits TraitsOf(const Medium& medium, bool similarity)
{
  return TraitsOf(medium, FindFilledBricks(medium), similarity);
}

MediumTraits TraitsOf(const Medium& medium, const FilledBricks& bricks, bool similarity)
{
  MediumTraits traits;
  traits.absorbs = bricks.absorption.largest > 0.0f;
  traits.scatters = bricks.scattering.largest > 0.0f;
  traits.emits = bricks.emission.largest > 0.0f;
  traits.grey = !medium.phase.HasColour() || bricks.filledCount == 0;
  const bool coloursEmit = traits.emits && medium.emission.HasColour();
  if (traits.emits && !coloursEmit)
  {
    traits.emission.Add(Rgb{ 1.0, 1.0, 1.0 });
  }
  if (medium.Channels() == 3)
  {
    ForFilledRows(medium, bricks, similarity, [&](const Row& row) {
      AddGrey(row, traits);
      if (coloursEmit && row.Has(medium.emission))
      {
        traits.emission.Add(medium.emission.values + 3 * row.first, static_cast<std::size_t>(row.size));
      }
    });
  }
  FilledBox filled(medium);
  filled.Find(bricks);
  traits.filled = filled.Box();
  traits.isotropic = medium.phase.IsIsotropic() || !traits.scatters;
  return traits;
}
}
