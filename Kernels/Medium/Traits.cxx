#include "Medium/Traits.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double SameColour = 3e-7;     ///< relative: what rounding to float leaves of multiples of one colour
constexpr float SameExtinction = 2e-7f; ///< the same of sums

bool Grey(const Rgb& rgb)
{
  return rgb[0] == rgb[1] && rgb[1] == rgb[2];
}

/// One row of voxels, along x.
struct Row
{
  const Medium& medium;
  float similarity;
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
        sigma_t[c] = this->medium.sigma_a.At(this->first + x, c) +
          static_cast<float>(this->medium.sigma_s.At(this->first + x, c) * this->similarity);
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
  return this->One && Grey(this->First);
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

MediumTraits TraitsOf(const Medium& medium, double similarity)
{
  MediumTraits traits;
  FilledBox filled(medium.grid);
  const std::array<int, 3>& n = medium.grid.size;
  for (int z = 0; z < n[2]; ++z)
  {
    for (int y = 0; y < n[1]; ++y)
    {
      const Row row = { medium, static_cast<float>(similarity), (static_cast<std::size_t>(z) * n[1] + y) * n[0], n[0] };
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
      traits.grey = traits.grey && row.IsGrey(medium.sigma_a) && row.IsGrey(medium.sigma_s);
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
  traits.isotropic = medium.g == 0.0 || !traits.scatters;
  traits.filled = filled.Box();
  return traits;
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
  colour.Add(illumination.environment.radiance.data(), illumination.environment.radiance.size() / 3);
  return colour;
}

namespace left_out
{
const char* const Grey = "colour: medium and light are grey, one channel does";
const char* const OneColour = "colour: the medium is grey and all light has one colour, one channel stands for three";
const char* const GreyExtinction = "sigma_t a channel: red, green and blue share one, and its transmittance";
const char* const NoScattering = "scattering: sigma_s is zero";
const char* const NoAbsorption = "absorption: sigma_a is zero";
const char* const NoEmission = "emission: the medium does not shine";
const char* const OneOrder = "scattering orders after the first: nothing is scattered";
const char* const NetFlux = "net_flux: not asked for";
const char* const Isotropic = "anisotropy: light is scattered evenly";
const char* const ConstantIndex = "refraction: the refractive index is constant, rays are straight";
const char* const EmptyBricks = "empty bricks: rays leap over 8x8x8 voxels that are empty";
const char* const NoLights = "uncollided flux of lamps: there are no lights";
const char* const NoEmissionPeaks = "uncollided flux of bright emission: no small bright part outshines all else, or "
                                    "an axis is periodic, or EmissionError is 0";
const char* const DarkOutside = "boundary radiance: no environment, sky or face shines";
const char* const EvenOutside = "uncollided flux of the boundaries: what comes from outside is the same from "
                                "everywhere and goes with scattered light";

std::string EmptySlabs(const VoxelBox& filled, const Grid& grid)
{
  const double part = 1.0 - static_cast<double>(filled.VoxelCount()) / static_cast<double>(grid.VoxelCount());
  return "empty slabs: " + std::to_string(std::lround(100.0 * part)) +
    "% of the voxels lie outside the box that the medium fills";
}

std::string DarkDirections(double lit)
{
  return "dark directions: no light comes from outside along " + std::to_string(std::lround(100.0 * (1.0 - lit))) +
    "% of the rays";
}

std::string MirrorImages(int classes, int directions)
{
  return "mirror images: nothing changes along periodic axes of one voxel, " + std::to_string(classes) + " of " +
    std::to_string(directions) + " directions stand for all";
}

std::string DirectionsAlongSlab(int perFace)
{
  return "directions too few for a slab, or along it: solved with " + std::to_string(perFace) + " a face";
}
}
}
