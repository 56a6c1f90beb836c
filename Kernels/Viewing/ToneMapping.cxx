#include "ToneMapping.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tyndall
{
namespace
{
constexpr int Levels = 1 << 14;

double EncodeSrgb(double linear)
{
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

/// sRGB's curve at Levels equal steps of linear light, in units of 1/255.
const std::vector<float>& SrgbTable()
{
  static const std::vector<float> table = [] {
    std::vector<float> values(Levels + 1);
    for (int i = 0; i <= Levels; ++i)
    {
      values[i] = static_cast<float>(255.0 * EncodeSrgb(static_cast<double>(i) / Levels));
    }
    return values;
  }();
  return table;
}

float Filmic(float x)
{
  return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
}
}

double AutomaticExposure(const std::vector<float>& radiance)
{
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 2 < radiance.size(); i += 3)
  {
    const float luminance = 0.2126f * radiance[i] + 0.7152f * radiance[i + 1] + 0.0722f * radiance[i + 2];
    if (luminance > 0.0f && std::isfinite(luminance))
    {
      sum += std::log2(luminance);
      ++count;
    }
  }
  return count > 0 ? 0.18 * std::exp2(-sum / static_cast<double>(count)) : 1.0;
}

std::vector<std::uint8_t> ToneMap(
  const std::vector<float>& radiance, const std::vector<float>& alpha, const ToneMapping& settings)
{
  const float exposure = static_cast<float>(settings.exposure > 0.0 ? settings.exposure : AutomaticExposure(radiance));
  const bool filmic = settings.curve == ToneCurve::Filmic;
  const std::vector<float>& table = SrgbTable();
  const std::size_t pixels = radiance.size() / 3;
  std::vector<std::uint8_t> colour(4 * pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
  {
    const float opaque = alpha.empty() ? 1.0f : alpha[pixel];
    const float scale = opaque > 0.0f ? 1.0f / opaque : 0.0f;
    for (int c = 0; c < 3; ++c)
    {
      // Beyond 1e6 every curve is white, and the fit's squares would overflow.
      const float exposed = std::min(radiance[3 * pixel + c] * exposure, 1e6f);
      const float shown = std::min(filmic ? Filmic(exposed) : exposed, 1.0f);
      const float encoded = table[static_cast<int>(shown * Levels + 0.5f)];
      colour[4 * pixel + c] = static_cast<std::uint8_t>(std::min(encoded * scale, 255.0f) + 0.5f);
    }
    colour[4 * pixel + 3] = static_cast<std::uint8_t>(255.0f * opaque + 0.5f);
  }
  return colour;
}
}
