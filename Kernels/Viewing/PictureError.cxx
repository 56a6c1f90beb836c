#include "Viewing/PictureError.h"

#include "Distribution/CoarseBlocks.h"
#include "Distribution/Domain.h"
#include "Light/LightField.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
/// Ratio of a picture's error to its difference from the coarse picture. Errors are of second order in the step
/// (Richardson extrapolation), and proportional to the transmittance at which rays end.
constexpr double PartOfDifference = 1.0 / 3.0;

int ChannelsOf(const Field& moments)
{
  const int degree = DegreeOf(moments);
  return moments.components / ((degree + 1) * (degree + 1));
}

/// Light in the angular moments above the last degree that is stored, relative to the light in the last degree. The
/// light that moments show was scattered at least twice, and each scattering multiplies moments by those of the phase
/// function. These decrease from degree to degree by the mean ratio r = straightOn^(1 / (degree + 1)). Returns the sum
/// of r^2, r^4, ...
double HigherDegrees(double straightOn, int degree)
{
  const double square = std::min(std::pow(std::abs(straightOn), 2.0 / (degree + 1)), 0.999);
  return square / (1.0 - square);
}

/// Angular moments of the light with changed moments of the last degree. The change is such that PartOfDifference times
/// the resulting difference of pictures is the light in higher degrees.
std::vector<float> ForHigherDegrees(const SolvedLight& light, std::size_t voxels)
{
  const Field& moments = light.scatteredMoments;
  const int degree = DegreeOf(moments), channels = ChannelsOf(moments);
  std::vector<float> changed(moments.values, moments.values + voxels * moments.components);
  for (std::size_t i = 0; i < changed.size(); ++i)
  {
    const int place = static_cast<int>(i % moments.components);
    if (degree > 0 && place >= degree * degree * channels)
    {
      const double straightOn = light.straightOn.At(i / moments.components, place % channels);
      changed[i] *= static_cast<float>(1.0 - HigherDegrees(straightOn, degree) / PartOfDifference);
    }
  }
  return changed;
}

/// Angular moments of the light's error: the moments of the light, multiplied by fluenceError / fluence.
std::vector<float> MomentsOfError(const SolvedLight& light, std::size_t voxels)
{
  const Field& moments = light.scatteredMoments;
  const int channels = ChannelsOf(moments), components = moments.components;
  std::vector<float> scaled(moments.values, moments.values + voxels * components);
  for (std::size_t i = 0; i < scaled.size(); ++i)
  {
    const std::size_t voxel = i / components;
    const int channel = static_cast<int>(i % components) % channels;
    const double fluence = light.fluence.At(voxel, channel), error = light.fluenceError.At(voxel, channel);
    scaled[i] = fluence > 0.0 ? static_cast<float>(scaled[i] * (error / fluence)) : 0.0f;
  }
  return scaled;
}

/// Values of a field, each transformed.
/// @param tuples  number of voxels, or of cells of the box's faces
template <class Transform>
std::vector<float> Transformed(const Field& field, std::size_t tuples, const Transform& transform)
{
  std::vector<float> values(field.values, field.values + (field.values ? tuples * field.components : 0));
  std::transform(values.begin(), values.end(), values.begin(), transform);
  return values;
}

/// Isotropic light that is the error of `light`, in units of its largest error, and a medium that emits the variance of
/// this light for errors that have the same sign over light.errorLength (numerics.md, Eq. (112h)).
class ErrorAndVariance
{
public:
  /// @param largest  largest fluenceError of the whole domain, W / length^2
  ErrorAndVariance(const Medium& given, const SolvedLight& light, double largest)
    : emitting(given)
  {
    const std::size_t voxels = given.grid.VoxelCount(), cells = BoxFaceCellCount(given.grid);
    const auto relative = [=](float error) { return static_cast<float>(error / largest); };
    const auto squared = [=](float error) { return static_cast<float>(std::pow(error / largest, 2.0)); };
    this->Errors = Transformed(light.fluenceError, voxels, relative);
    this->Surface = Transformed(light.surfaceError, cells, relative);
    this->Squares = Transformed(light.surfaceError, cells, squared);
    this->error.fluence = { this->Errors.data(), light.fluenceError.components };
    this->error.surface = { this->Surface.empty() ? nullptr : this->Surface.data(), light.surfaceError.components };
    this->variance = this->error; // its fluence is not scattered, but the ray caster shows no surface without fluence
    this->variance.surface.values = this->Squares.empty() ? nullptr : this->Squares.data();
    const int channels =
      std::max({ given.sigma_a.components, given.sigma_s.components, light.fluenceError.components });
    for (std::size_t i = 0; i < voxels * channels; ++i)
    {
      const std::size_t voxel = i / channels;
      const int c = static_cast<int>(i % channels);
      const double scatters = given.sigma_s.At(voxel, c), sigma = scatters + given.sigma_a.At(voxel, c);
      const double source = scatters * this->error.fluence.At(voxel, c) / (4.0 * Pi);
      const double length = sigma > 0.0 ? 2.0 / sigma * std::tanh(0.5 * sigma * light.errorLength) : light.errorLength;
      this->Extinction.push_back(static_cast<float>(2.0 * sigma));
      this->Source.push_back(static_cast<float>(source * source * length));
    }
    this->emitting.sigma_s = {};
    this->emitting.sigma_a = { this->Extinction.data(), channels };
    this->emitting.emission = { this->Source.data(), channels };
  }
  ErrorAndVariance(const ErrorAndVariance&) = delete;

  SolvedLight error, variance;
  Medium emitting;

private:
  std::vector<float> Errors, Surface, Squares, Extinction, Source;
};

/// A camera for a picture of CoarserSettings whose rays are those of every second pixel in a picture of `size` pixels.
Camera OfEverySecondPixel(Camera camera, const std::array<int, 2>& size)
{
  const double aspect = camera.aspect > 0.0 ? camera.aspect : static_cast<double>(size[0]) / size[1];
  std::array<double, 2> wider;
  for (int axis = 0; axis < 2; ++axis)
  {
    const double all = 2.0 * ((size[axis] + 1) / 2); // width of the coarse picture, in pixels of `size`
    wider[axis] = all / size[axis];
    camera.shift[axis] = ((camera.shift[axis] - 1.0) * size[axis] - 1.0 + all) / all;
  }
  camera.aspect = aspect * wider[0] / wider[1];
  camera.parallelScale *= wider[1];
  camera.viewAngle = 360.0 / Pi * std::atan(wider[1] * std::tan(camera.viewAngle * Pi / 360.0));
  return camera;
}
}

ViewSettings CoarserSettings(ViewSettings settings)
{
  for (int& pixels : settings.imageSize)
  {
    pixels = (pixels + 1) / 2;
  }
  settings.stepSize *= 2.0;
  settings.rectangleSamples = (settings.rectangleSamples + 1) / 2;
  settings.minimumTransmittance = std::min(4.0 * settings.minimumTransmittance, 0.5);
  return settings;
}

PictureErrorCasters::PictureErrorCasters(Device& device, const Medium& medium, const SolvedLight& light,
  const Illumination& illumination, const ViewSettings& settings, const Field& ior, const BlockOfScene* block)
{
  const std::size_t voxels = medium.grid.VoxelCount();
  const bool byMoments = ShownDegree(light, settings) >= 0;
  ViewSettings coarser = CoarserSettings(settings);
  SolvedLight other = light;
  std::vector<float> moments = byMoments ? ForHigherDegrees(light, voxels) : std::vector<float>();
  other.scatteredMoments.values = byMoments ? moments.data() : light.scatteredMoments.values;
  this->coarse = std::make_unique<MediumRayCaster>(device, medium, other, illumination, coarser, ior, block);
  const bool lightsOnly = settings.singleScatteringOnly && settings.shadowRays;
  if (!light.fluence.values || lightsOnly)
  {
    return;
  }
  if (!light.fluenceError.values || (settings.singleScatteringOnly && !byMoments))
  {
    this->lightLeftOut = std::string("error of the light, in picture_error: ") +
      (light.fluenceError.values ? "that of uncollided light alone is not known"
                                 : "the input has no fluence_error, which solvers write with EstimateError");
    return;
  }
  // Lamps are dark here because shadow rays compute their light again; the background has no error.
  Medium dark = medium;
  dark.emission = {};
  Illumination unlit = illumination;
  unlit.lights.clear();
  other.fluence = light.fluenceError;
  other.fluenceDirect = {};
  other.meanDirection = settings.shadowRays && !illumination.lights.empty() ? Field() : light.meanDirection;
  other.surface = light.surfaceError;
  other.lampsApart.clear();
  if (byMoments)
  {
    moments = MomentsOfError(light, voxels);
    other.scatteredMoments.values = moments.data();
  }
  coarser.shadowRays = false;
  coarser.showBackground = false;
  this->ofLight = std::make_unique<MediumRayCaster>(device, dark, other, unlit, coarser, ior, block);
  const double largest = block ? block->shared.largestError : LargestError(medium, light);
  if (light.errorLength > 0.0 && largest > 0.0)
  {
    const ErrorAndVariance of(medium, light, largest);
    this->even = std::make_unique<MediumRayCaster>(device, dark, of.error, unlit, coarser, ior, block);
    this->variance = std::make_unique<MediumRayCaster>(device, of.emitting, of.variance, unlit, coarser, ior, block);
  }
}

bool PictureErrorCasters::Adopt(const ViewSettings& settings)
{
  ViewSettings coarser = CoarserSettings(settings);
  bool adopted = this->coarse->Adopt(coarser);
  coarser.shadowRays = false;
  coarser.showBackground = false;
  for (MediumRayCaster* caster : { this->ofLight.get(), this->even.get(), this->variance.get() })
  {
    adopted = (!caster || caster->Adopt(coarser)) && adopted;
  }
  return adopted;
}

void PictureErrorCasters::Estimate(Picture& picture, const Camera& camera, const Monitor& monitor) const
{
  EstimatePictureError(picture, camera, [&](auto which, const Camera& seenBy, const std::array<int, 2>&) {
    return this->*which ? (this->*which)->Render(seenBy, monitor) : Picture();
  });
}

void EstimatePictureError(Picture& picture, const Camera& camera, const RenderForError& render)
{
  const std::array<int, 2> size = { picture.width, picture.height };
  Grid pixels, blocks;
  pixels.size = { size[0], size[1], 1 };
  blocks.size = { (size[0] + 1) / 2, (size[1] + 1) / 2, 1 };
  blocks.spacing = { 1.0 * size[0] / blocks.size[0], 1.0 * size[1] / blocks.size[1], 1.0 };
  const Camera second = OfEverySecondPixel(camera, size);
  const std::array<int, 2> half = { blocks.size[0], blocks.size[1] };
  const Picture coarse = render(&PictureErrorCasters::coarse, second, half);
  const Picture ofLight = render(&PictureErrorCasters::ofLight, second, half);
  const Picture even = render(&PictureErrorCasters::even, second, half);
  const Picture variance = render(&PictureErrorCasters::variance, second, half);
  std::vector<float> error(coarse.radiance.size());
  for (std::size_t i = 0; i < error.size(); ++i)
  {
    const std::size_t block = i / 3, column = block % half[0], row = block / half[0];
    const double fine = picture.radiance[3 * (2 * row * size[0] + 2 * column) + i % 3];
    const double ofRays = PartOfDifference * (fine - coarse.radiance[i]);
    const double light = ofLight.radiance.empty() ? 0.0 : ofLight.radiance[i];
    const double square = variance.radiance.empty() ? 0.0 : std::pow(even.radiance[i], 2.0);
    const double left = square > 0.0 ? std::sqrt(std::clamp(variance.radiance[i] / square, 0.0, 1.0)) : 1.0;
    error[i] = static_cast<float>(std::hypot(ofRays, left * light));
  }
  // The error is smoothed over neighbouring blocks of pixels, and is proportional to the radiance within a block, like
  // the error of fluence.
  Domain domain(pixels);
  LightField shown;
  shown.channels = 3;
  shown.fluence = std::move(picture.radiance);
  const CoarseBlocks ofPixels(domain.Comm(), domain.Partition(), blocks);
  WriteErrorEstimate(
    shown, ofPixels, error, std::vector<float>(error.size()), 1.0, std::numeric_limits<double>::infinity());
  picture.radiance = std::move(shown.fluence);
  picture.error = std::move(shown.fluenceError);
  picture.relativeError = shown.relativeError;
}
}
