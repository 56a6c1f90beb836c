#include "LightPropagation/Problem/SceneUnits.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace tyndall
{
namespace
{
/// If the total power is between 2^-40 W and 2^40 W, it is scaled by a factor below 2
constexpr int UsualExponent = 40;
/// Grids whose longest voxel edge is between 2^-20 and 2^20 keep their unit of length
constexpr int UsualLengthExponent = 20;

double Largest(const Rgb& values)
{
  return std::max({ values[0], values[1], values[2] });
}

std::array<double, 3> FaceAreas(const Grid& grid)
{
  return { grid.Length(1) * grid.Length(2), grid.Length(2) * grid.Length(0), grid.Length(0) * grid.Length(1) };
}

double LargestEmission(const Medium& medium)
{
  float largest = 0.0f;
  for (std::size_t i = 0; i < medium.grid.VoxelCount() && medium.emission.values; ++i)
  {
    for (int c = 0; c < (medium.emission.HasColour() ? 3 : 1); ++c)
    {
      largest = std::max(largest, medium.emission.At(i, c));
    }
  }
  return largest;
}

void Divide(Rgb& values, double unit)
{
  for (double& value : values)
  {
    value /= unit;
  }
}

/// Replaces each value of a field by change(value). The new values are stored in `values`.
template <class Change>
void Copy(Field& field, std::size_t voxels, std::vector<float>& values, const Change& change)
{
  if (!field.values || voxels == 0)
  {
    return;
  }
  const int components = field.HasColour() ? 3 : 1;
  values.resize(voxels * static_cast<std::size_t>(components));
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = static_cast<float>(change(field.At(i / components, static_cast<int>(i % components))));
  }
  field = { values.data(), components };
}

void Multiply(std::vector<float>& values, double unit, const char* name)
{
  const auto isBeyond = [=](float value) { return std::abs(value * unit) > std::numeric_limits<float>::max(); };
  if (std::count_if(values.begin(), values.end(), isBeyond) > 0) // count_if is vectorised, unlike any_of
  {
    const double watts = *std::max_element(values.begin(), values.end()) * unit;
    throw InvalidInput("The " + std::string(name) + " would be " + Text("%.5g", watts) +
      ", which is more than a float holds. Give lights, sky and emission less power: light is in proportion to it.");
  }
  std::transform(
    values.begin(), values.end(), values.begin(), [=](float value) { return static_cast<float>(value * unit); });
}

/// Upper bound of the power that a light sends into the box, W, summed over channels.
double PowerInto(const Grid& grid, const Light& light)
{
  if (light.type != LightType::Directional)
  {
    return Sum(light.power);
  }
  const std::array<double, 3> area = FaceAreas(grid);
  const std::array<double, 3> d = DirectionOf(light);
  return Sum(light.power) * (std::abs(d[0]) * area[0] + std::abs(d[1]) * area[1] + std::abs(d[2]) * area[2]);
}
}

AllThatShines ShiningOn(const Grid& grid, const Medium& medium, const Illumination& illumination)
{
  const std::array<double, 3> area = FaceAreas(grid);
  AllThatShines all;
  const auto take = [&all](double value) { all.first = all.first > 0.0 ? all.first : value; };
  for (const Light& light : illumination.lights)
  {
    all.power += PowerInto(grid, light);
    take(Largest(light.power));
  }
  double radiance = Largest(illumination.sky);
  take(radiance);
  for (const Rgb& face : illumination.faces)
  {
    radiance = std::max(radiance, Largest(face));
    take(Largest(face));
  }
  const std::vector<float>& pixels = illumination.environment.radiance;
  if (!pixels.empty())
  {
    const double brightest = *std::max_element(pixels.begin(), pixels.end());
    radiance += brightest;
    take(brightest);
  }
  const double emission = LargestEmission(medium);
  take(emission);
  all.power += 4.0 * Pi * emission * grid.VoxelVolume() * static_cast<double>(grid.VoxelCount()) +
    2.0 * Pi * radiance * (area[0] + area[1] + area[2]);
  if (illumination.uncollided.IsThere())
  {
    // Uncollided light given as input is scaled by a power of two only, so that no digits of its floats change
    all.first = 0.0;
    for (int c = 0; c < 3; ++c)
    {
      all.power += PowerLost(illumination.uncollided, medium, c);
      for (const Rgb& escaped : illumination.uncollided.escaped)
      {
        all.power += escaped[c]; // light is not faint if the medium absorbs almost none of it
      }
    }
  }
  return all;
}

double PowerUnitFor(const AllThatShines& all)
{
  const double digits = all.first > 0.0 ? std::scalbn(all.first, -std::ilogb(all.first)) : 1.0;
  if (!(all.power > 0.0) || std::isinf(all.power))
  {
    return 1.0;
  }
  const int exponent = std::ilogb(all.power);
  // In this unit the total power is about 2^40, so that a source 1e-36 times as strong as the strongest is still
  // represented.
  return std::abs(exponent) <= UsualExponent ? digits : std::scalbn(digits, exponent - UsualExponent);
}

void CheckBrightness(const Grid& grid, const AllThatShines& all)
{
  const double shortest = *std::min_element(grid.spacing.begin(), grid.spacing.end());
  const double fluence = all.power / shortest / shortest; // all power through a voxel's smallest face
  Require(!(all.power > 0.0) || !(fluence < std::numeric_limits<float>::min()),
    "No voxel's fluence is above " + Text("%.5g", fluence) +
      " W/length^2, which is less than a float holds. Give lights, sky and emission more power, or put lamps nearer: "
      "light is in proportion to it.");
}

SceneInUnits::SceneInUnits(const Medium& inWatts, const Illumination& shining, double unit)
  : medium(inWatts)
  , illumination(shining)
{
  const std::size_t voxels = inWatts.grid.VoxelCount();
  const auto inUnits = [=](float value) { return value / unit; };
  Copy(this->medium.emission, voxels, this->emission, inUnits);
  for (Light& light : this->illumination.lights)
  {
    Divide(light.power, unit);
  }
  Divide(this->illumination.sky, unit);
  for (Rgb& face : this->illumination.faces)
  {
    Divide(face, unit);
  }
  for (float& pixel : this->illumination.environment.radiance)
  {
    pixel = static_cast<float>(pixel / unit);
  }
  UncollidedImage& image = this->illumination.uncollided;
  if (!image.IsThere() || voxels == 0) // on a rank without voxels the image has no values
  {
    return;
  }
  Copy(image.fluence, voxels, this->uncollided, inUnits);
  for (Rgb& face : image.escaped)
  {
    Divide(face, unit);
  }
}

double LengthUnitOf(const Grid& grid)
{
  const int exponent = std::ilogb(*std::max_element(grid.spacing.begin(), grid.spacing.end()));
  return std::abs(exponent) <= UsualLengthExponent ? 1.0 : std::exp2(exponent);
}

Grid InUnit(Grid grid, double unit)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.spacing[axis] /= unit;
    grid.origin[axis] /= unit;
  }
  return grid;
}

SceneInLengths::SceneInLengths(const Medium& inLengths, const Illumination& shining, double unit)
  : medium(inLengths)
  , illumination(shining)
{
  this->medium.grid = InUnit(inLengths.grid, unit);
  const std::size_t voxels = this->medium.grid.VoxelCount();
  const auto perUnit = [=](float perLength) { return perLength * unit; };
  Copy(this->medium.sigma_a, voxels, this->sigma_a, perUnit);
  Copy(this->medium.sigma_s, voxels, this->sigma_s, perUnit);
  Copy(this->medium.emission, voxels, this->emission, perUnit);
  if (voxels > 0)
  {
    Check(this->medium); // scaled values may overflow floats
  }
  for (Light& light : this->illumination.lights)
  {
    std::for_each(light.position.begin(), light.position.end(), [=](double& length) { length /= unit; });
    std::for_each(light.size.begin(), light.size.end(), [=](double& length) { length /= unit; });
    if (light.type != LightType::Directional) // the power of directional lights is per area already
    {
      Divide(light.power, unit * unit);
    }
  }
  for (Rgb& face : this->illumination.uncollided.escaped)
  {
    Divide(face, unit * unit);
  }
}

void ToWatts(LightField& light, double unit)
{
  Multiply(light.fluence, unit, "fluence");
  Multiply(light.fluenceDirect, unit, "fluence_direct");
  Multiply(light.fluenceError, unit, "fluence_error");
  Multiply(light.netFlux, unit, "net_flux");
  Multiply(light.firstMoments, unit, "first moments");
  Multiply(light.scatteredRadiance, unit, "scattered_radiance");
  Multiply(light.surfaceRadiance, unit, "surface_radiance");
  Multiply(light.scatteredMoments, unit, "scattered_moments");
  Multiply(light.facePower, unit, "face_power");
  MultiplyPowers(light, unit);
}

void MultiplyPowers(LightField& light, double factor)
{
  EnergyBalance& balance = light.balance;
  for (Rgb* watts : { &balance.entered, &balance.emitted, &balance.absorbed, &balance.escaped, &balance.leftOver })
  {
    *watts = Times(*watts, factor);
  }
  for (Rgb& watts : light.facePowerOut)
  {
    watts = Times(watts, factor);
  }
  for (ConvergenceRow& row : light.convergence)
  {
    row.absorbed *= factor;
    row.escaped *= factor;
    row.leftOver *= factor;
  }
}
}
