#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall
{
enum class ToneCurve
{
  Linear = 0, ///< radiance times exposure, cut at 1: for comparing numbers
  Filmic = 1, ///< K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2015: the fit to the Academy's reference transform
};

struct ToneMapping
{
  /// What radiance is multiplied by before the curve; 0 chooses it so that the picture's logarithmic mean luminance
  /// becomes the 0.18 of a photographer's grey card (Reinhard et al. 2002, "Photographic tone reproduction", equations
  /// 1 and 2).
  double exposure = 0.0; ///< [0, 1e30]
  ToneCurve curve = ToneCurve::Filmic;
};

/// @throws InvalidInput for an exposure out of its range
void Check(const ToneMapping& settings);

/// The exposure that `exposure` = 0 stands for. It is that of what is lit, not of the black behind it: a pixel that the
/// medium fills in part counts for that part, with the radiance of that part, so that thin smoke is exposed as thick
/// smoke is, and as before a background as bright. What fills less than ThinnestPart of a pixel may shine by itself,
/// and is taken to fill so much of it. Of the lit pixels those a thousand times darker than the 95th percentile, or
/// darker still, do not count: what is nearly black would make the rest white. 1 where no pixel is lit.
/// @param radiance  3 per pixel, not negative
/// @param alpha     one per pixel in [0, 1]; empty: all is filled, as by a background
double AutomaticExposure(const std::vector<float>& radiance, const std::vector<float>& alpha);
constexpr float ThinnestPart = 0.2f;

/// How much of a picture, in 16ths of pixels, has which luminance: 256 classes for every doubling. Of parts of a
/// picture they add up.
std::vector<int> LuminanceCounts(const std::vector<float>& radiance, const std::vector<float>& alpha);

/// The same exposure, of all that was counted.
double ExposureOfCounts(const std::vector<int>& luminanceCounts);

/// The radiance times exposure that a screen shows as a channel of this value: ToneMap makes 255 times that of it.
/// @param shown  [0, 1], encoded as sRGB
double ExposedAs(double shown, ToneCurve curve);

/// What a screen shows of it, [0, 255], before it is rounded.
/// @param exposed  radiance times exposure
float ShownValue(float exposed, ToneCurve curve);

/// Eight bits per channel, red, green, blue and alpha, for a screen that follows sRGB (IEC 61966-2-1). Colours are not
/// multiplied by alpha: laid over black, the picture is what the radiance says. What is brighter than a white of its
/// alpha, as thin smoke in the light is, has the alpha of its brightest channel: it hides more of what is behind it
/// than the medium does.
/// @param alpha  one per pixel in [0, 1]; empty: opaque
std::vector<std::uint8_t> ToneMap(
  const std::vector<float>& radiance, const std::vector<float>& alpha, const ToneMapping& settings);
}
