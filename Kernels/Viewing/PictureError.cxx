#include "Viewing/PictureError.h"

#include "Distribution/CoarseBlocks.h"
#include "Distribution/Domain.h"
#include "Light/LightField.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
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
  other.surface = {};
  other.lampsApart.clear();
  if (byMoments)
  {
    moments = MomentsOfError(light, voxels);
    other.scatteredMoments.values = moments.data();
  }
  coarser.shadowRays = false;
  coarser.showBackground = false;
  this->ofLight = std::make_unique<MediumRayCaster>(device, dark, other, unlit, coarser, ior, block);
}

bool PictureErrorCasters::Adopt(const ViewSettings& settings)
{
  ViewSettings coarser = CoarserSettings(settings);
  bool adopted = this->coarse->Adopt(coarser);
  if (this->ofLight)
  {
    coarser.shadowRays = false;
    coarser.showBackground = false;
    adopted = this->ofLight->Adopt(coarser) && adopted;
  }
  return adopted;
}

void PictureErrorCasters::Estimate(Picture& picture, const Camera& camera, const Monitor& monitor) const
{
  EstimatePictureError(
    picture, camera, this->ofLight != nullptr, [&](bool light, const Camera& seenBy, const std::array<int, 2>&) {
      return (light ? this->ofLight : this->coarse)->Render(seenBy, monitor);
    });
}

void EstimatePictureError(Picture& picture, const Camera& camera, bool knowsLight, const RenderForError& render)
{
  const std::array<int, 2> size = { picture.width, picture.height };
  Grid pixels, blocks;
  pixels.size = { size[0], size[1], 1 };
  blocks.size = { (size[0] + 1) / 2, (size[1] + 1) / 2, 1 };
  blocks.spacing = { 1.0 * size[0] / blocks.size[0], 1.0 * size[1] / blocks.size[1], 1.0 };
  const Camera second = OfEverySecondPixel(camera, size);
  const std::array<int, 2> half = { blocks.size[0], blocks.size[1] };
  const Picture coarse = render(false, second, half);
  const Picture ofLight = knowsLight ? render(true, second, half) : Picture();
  std::vector<float> error(coarse.radiance.size());
  for (std::size_t i = 0; i < error.size(); ++i)
  {
    const std::size_t block = i / 3, column = block % half[0], row = block / half[0];
    const double fine = picture.radiance[3 * (2 * row * size[0] + 2 * column) + i % 3];
    const double ofRays = PartOfDifference * (fine - coarse.radiance[i]);
    error[i] = static_cast<float>(std::hypot(ofRays, knowsLight ? ofLight.radiance[i] : 0.0));
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
