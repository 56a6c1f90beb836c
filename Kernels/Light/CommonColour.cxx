#include "Light/CommonColour.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double SameColour = 3e-7; ///< relative: what rounding to float leaves of multiples of one colour

bool Grey(const Rgb& rgb)
{
  return rgb[0] == rgb[1] && rgb[1] == rgb[2];
}
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
  if (!std::all_of(illumination.faceAlbedo.begin(), illumination.faceAlbedo.end(), Grey))
  {
    colour.AddNone();
  }
  colour.Add(illumination.environment.radiance.data(), illumination.environment.radiance.size() / 3);
  return colour;
}
}
