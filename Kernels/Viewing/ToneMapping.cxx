#include "Viewing/ToneMapping.h"

#include "Device/Errors.h"
#include "Device/HostThreads.h"
#include "Numerics/NumberText.h"
#include "Numerics/Srgb.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <mutex>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr std::size_t PixelsOfThread = 32768; ///< smallest number of pixels per thread
/// Largest exposure that is accepted. With it, radiance times exposure may overflow a float to infinity, but never
/// becomes NaN.
constexpr double LargestExposure = 1e30;

double Filmic(double x)
{
  return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

/// Inverse y -> x of the curve Filmic, for y in [0, 1]: the positive root of a quadratic equation.
double FilmicInverse(double y)
{
  const double a = 2.51 - 2.43 * y, b = 0.03 - 0.59 * y;
  return (-b + std::sqrt(b * b + 0.56 * a * y)) / (2.0 * a);
}

/// Table of the display value, 0 to 255, as a function of exposed radiance. The index consists of the leading bits of
/// the float: 4096 entries per factor of two between Darkest and Brightest.
class ScreenValues
{
public:
  explicit ScreenValues(ToneCurve curve)
  {
    for (std::uint32_t entry = Index(Darkest); entry <= Index(Brightest); ++entry)
    {
      const std::uint32_t middle = (entry << Shift) + (1u << (Shift - 1));
      float exposed;
      std::memcpy(&exposed, &middle, sizeof(exposed));
      const double shown = curve == ToneCurve::Filmic ? Filmic(exposed) : exposed;
      this->Values.push_back(static_cast<float>(255.0 * EncodeSrgb(std::min(shown, 1.0))));
    }
    this->Values.front() = 0.0f;
  }

  float operator()(float exposed) const
  {
    return this->Values[Index(std::min(std::max(exposed, Darkest), Brightest)) - Index(Darkest)];
  }

private:
  static constexpr int Shift = 23 - 12;
  static constexpr float Darkest = 1.0f / (1 << 17); // exposed radiance that is displayed as 0
  static constexpr float Brightest = 64.0f;          // exposed radiance that every curve displays as white

  static std::uint32_t Index(float value)
  {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof(bits));
    return bits >> Shift;
  }

  std::vector<float> Values;
};

const ScreenValues& ScreenValuesOf(ToneCurve curve)
{
  static const ScreenValues linear(ToneCurve::Linear);
  static const ScreenValues filmic(ToneCurve::Filmic);
  return curve == ToneCurve::Filmic ? filmic : linear;
}
}

void Check(const ToneMapping& settings)
{
  Require(settings.exposure >= 0.0 && settings.exposure <= LargestExposure,
    "The exposure (Exposure) is " + Text("%g", settings.exposure) + "; it must be from 0 (automatic) to " +
      Text("%g", LargestExposure) + ".");
}

std::vector<int> LuminanceCounts(const std::vector<float>& radiance, const std::vector<float>& alpha)
{
  constexpr float Parts = 16.0f; // count by which a fully covered pixel increases its class of the luminance histogram
  // The class of a luminance in the histogram is its float as an integer, without this many low bits.
  constexpr int Shift = 23 - 8;
  std::vector<int> count((1u << (31 - Shift)), 0);
  std::mutex mutex;
  InThreads(radiance.size() / 3, PixelsOfThread, [&](std::size_t begin, std::size_t end) {
    std::vector<int> here(count.size(), 0);
    for (std::size_t i = 3 * begin; i < 3 * end; i += 3)
    {
      const float filled = alpha.empty() ? 1.0f : alpha[i / 3];
      const float luminance = (0.2126f * radiance[i] + 0.7152f * radiance[i + 1] + 0.0722f * radiance[i + 2]) /
        std::max(filled, ThinnestPart);
      if (luminance > 0.0f && std::isfinite(luminance))
      {
        std::uint32_t bits;
        std::memcpy(&bits, &luminance, sizeof(bits));
        here[bits >> Shift] += std::max(static_cast<int>(Parts * filled + 0.5f), 1);
      }
    }
    const std::lock_guard<std::mutex> lock(mutex);
    std::transform(here.begin(), here.end(), count.begin(), count.begin(), std::plus<int>());
  });
  return count;
}

double ExposureOfCounts(const std::vector<int>& count)
{
  const double lit = std::accumulate(count.begin(), count.end(), 0.0);
  // Binary logarithm of the luminance at the centre of a class of the histogram.
  const auto logarithm = [](std::size_t entry) {
    return static_cast<double>(entry >> 8) - 127.0 + std::log2(1.0 + ((entry & 255) + 0.5) / 256.0);
  };

  // Mean logarithm over those classes of the histogram that are not much darker than the 95th percentile.
  const double darkest = std::log2(1e-3);
  double sum = 0.0;
  double counted = 0.0;
  double seen = 0.0;
  double bright = 1e300;
  for (std::size_t entry = count.size(); entry-- > 0;)
  {
    if (count[entry] == 0)
    {
      continue;
    }
    seen += count[entry];
    bright = bright == 1e300 && seen >= 0.05 * lit ? logarithm(entry) : bright;
    if (logarithm(entry) > bright + darkest || bright == 1e300)
    {
      sum += count[entry] * logarithm(entry);
      counted += count[entry];
    }
  }
  return counted > 0.0 ? 0.18 * std::exp2(-sum / counted) : 1.0;
}

double AutomaticExposure(const std::vector<float>& radiance, const std::vector<float>& alpha)
{
  return ExposureOfCounts(LuminanceCounts(radiance, alpha));
}

double ExposedAs(double shown, ToneCurve curve)
{
  const double linear = DecodeSrgb(shown);
  return curve == ToneCurve::Filmic ? FilmicInverse(linear) : linear;
}

float ShownValue(float exposed, ToneCurve curve)
{
  return std::min(ScreenValuesOf(curve)(exposed), 255.0f);
}

std::vector<std::uint8_t> ToneMap(
  const std::vector<float>& radiance, const std::vector<float>& alpha, const ToneMapping& settings)
{
  const double asked = settings.exposure > 0.0 ? settings.exposure : AutomaticExposure(radiance, alpha);
  const auto exposure = static_cast<float>(std::min(asked, LargestExposure));
  const ScreenValues& screen = ScreenValuesOf(settings.curve);
  const std::size_t pixels = radiance.size() / 3;
  std::vector<std::uint8_t> colour(4 * pixels);
  InThreads(pixels, PixelsOfThread, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel)
    {
      std::array<float, 3> shown;
      std::transform(radiance.begin() + static_cast<std::ptrdiff_t>(3 * pixel),
        radiance.begin() + static_cast<std::ptrdiff_t>(3 * pixel + 3), shown.begin(),
        [&](float value) { return std::floor(std::min(screen(value * exposure), 255.0f) + 0.5f); });
      const float hidden = alpha.empty() ? 255.0f : std::floor(255.0f * alpha[pixel] + 0.5f);
      const float opaque = std::max({ hidden, shown[0], shown[1], shown[2] });
      const float scale = opaque > 0.0f ? 255.0f / opaque : 0.0f;
      for (int c = 0; c < 3; ++c)
      {
        colour[4 * pixel + c] = static_cast<std::uint8_t>(shown[c] * scale + 0.5f);
      }
      colour[4 * pixel + 3] = static_cast<std::uint8_t>(opaque);
    }
  });
  return colour;
}
}
