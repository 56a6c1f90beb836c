#pragma once

#include <cstdint>
#include <vector>

namespace tyndall
{
enum class ToneCurve
{
  Linear = 0, ///< radiance times exposure, cut at 1: displayed values can be compared as numbers
  /// Curve fitted to the reference transform of the Academy (AMPAS): K. Narkowicz, "ACES Filmic Tone Mapping Curve",
  /// 2015.
  Filmic = 1,
};

struct ToneMapping
{
  /// Factor applied to radiance before the tone curve. With 0, the factor is chosen such that the picture's logarithmic
  /// mean luminance becomes 0.18, the value of a photographer's grey card (Reinhard et al. 2002, "Photographic tone
  /// reproduction", equations 1 and 2).
  double exposure = 0.0; ///< range [0, 1e30]
  ToneCurve curve = ToneCurve::Filmic;
};

/// Checks the settings of tone mapping.
/// @throws InvalidInput for an exposure out of its range
void Check(const ToneMapping& settings);

/// The exposure that ToneMap uses if ToneMapping::exposure is 0. Lit pixels determine it, not the black background. A
/// pixel that the medium covers in part counts with its coverage as weight, and with the radiance of its covered part.
/// This radiance is computed with a coverage of at least ThinnestPart, because the pixel may show a bright emitter.
/// Thin smoke is therefore exposed like thick smoke, or like smoke in front of an equally bright background. Lit pixels
/// darker than a thousandth of the 95th percentile do not count: nearly black pixels would overexpose the others.
/// Returns 1 if no pixel is lit.
/// @param radiance  3 per pixel, >= 0
/// @param alpha     coverage, one per pixel in [0, 1]; empty: all pixels are fully covered, as by a background
double AutomaticExposure(const std::vector<float>& radiance, const std::vector<float>& alpha);
constexpr float ThinnestPart = 0.2f;

/// Luminance histogram of a picture: covered area, in sixteenths of a pixel, per class of luminance, with 256 classes
/// per factor of two. Histograms of parts of a picture can be added.
/// @param radiance, alpha  as in AutomaticExposure
std::vector<int> LuminanceCounts(const std::vector<float>& radiance, const std::vector<float>& alpha);

/// Exposure that AutomaticExposure chooses, computed from a histogram by LuminanceCounts.
double ExposureOfCounts(const std::vector<int>& luminanceCounts);

/// Exposed radiance (radiance times exposure) that is displayed as `shown`: inverse of the tone curve.
/// @param shown  display value in [0, 1], sRGB-encoded; ToneMap writes 255 times this value
double ExposedAs(double shown, ToneCurve curve);

/// Display value of a channel, [0, 255], before rounding to an integer.
/// @param exposed  radiance times exposure
float ShownValue(float exposed, ToneCurve curve);

/// Converts a picture to eight bits per channel, red, green, blue and alpha, for an sRGB display (IEC 61966-2-1).
/// Colours are not multiplied by alpha: composited over black, the picture shows the tone-mapped radiance. Some pixels
/// are brighter than white at their alpha, such as thin smoke in bright light. They are given the alpha of their
/// brightest channel, and then hide more of the background than the medium does.
/// @param radiance  3 per pixel, W / (length^2 sr)
/// @param alpha  one per pixel in [0, 1]; empty: opaque
std::vector<std::uint8_t> ToneMap(
  const std::vector<float>& radiance, const std::vector<float>& alpha, const ToneMapping& settings);
}
