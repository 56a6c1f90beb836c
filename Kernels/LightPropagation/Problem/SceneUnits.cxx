#include "LightPropagation/Problem/SceneUnits.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"
#include "Numerics/NumberText.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tyndall
{
namespace
{
constexpr int UsualExponent = 40;       ///< powers up to 2^40 W, and down to 2^-40 W, are solved as they are
constexpr int UsualLengthExponent = 20; ///< the same of spacings

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
  const std::size_t count = medium.grid.VoxelCount() * static_cast<std::size_t>(medium.emission.components);
  const float* values = medium.emission.values;
  return values ? *std::max_element(values, values + count) : 0.0;
}

void Divide(Rgb& values, double unit)
{
  for (double& value : values)
  {
    value /= unit;
  }
}

void Multiply(std::vector<float>& values, double unit, const char* name)
{
  for (float& value : values)
  {
    const double watts = value * unit;
    value = static_cast<float>(watts);
    if (std::isinf(value))
    {
      throw InvalidInput("The " + std::string(name) + " would be " + Text("%.5g", watts) +
        ", which is more than a float holds. Give lights, sky and emission less power: light is in proportion to it.");
    }
  }
}

void Multiply(Rgb& values, double unit)
{
  Divide(values, 1.0 / unit);
}

/// W that a light sends into the box, or around it if it stands outside; the sum of its channels.
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

double PowerUnitOf(const Medium& medium, const Illumination& illumination)
{
  const Grid& grid = medium.grid;
  const std::array<double, 3> area = FaceAreas(grid);
  double power = 4.0 * Pi * LargestEmission(medium) * grid.VoxelVolume() * static_cast<double>(grid.VoxelCount());
  for (const Light& light : illumination.lights)
  {
    power += PowerInto(grid, light);
  }
  double radiance = Largest(illumination.sky);
  for (const Rgb& face : illumination.faces)
  {
    radiance = std::max(radiance, Largest(face));
  }
  const std::vector<float>& pixels = illumination.environment.radiance;
  if (!pixels.empty())
  {
    radiance += *std::max_element(pixels.begin(), pixels.end());
  }
  power += 2.0 * Pi * radiance * (area[0] + area[1] + area[2]);
  for (int c = 0; c < 3 && illumination.uncollided.IsThere(); ++c)
  {
    power += PowerLost(illumination.uncollided, medium, c);
  }
  if (!(power > 0.0) || std::isinf(power))
  {
    return 1.0;
  }
  const int exponent = std::ilogb(power);
  // All light together is then 2^40: next to what shines most, something else may shine 1e-36 times as much.
  return std::abs(exponent) <= UsualExponent ? 1.0 : std::exp2(exponent - UsualExponent);
}

SceneInUnits::SceneInUnits(const Medium& inWatts, const Illumination& shining, double unit)
  : medium(inWatts)
  , illumination(shining)
{
  if (inWatts.emission.values)
  {
    const std::size_t count = inWatts.grid.VoxelCount() * static_cast<std::size_t>(inWatts.emission.components);
    this->emission.resize(count);
    std::transform(inWatts.emission.values, inWatts.emission.values + count, this->emission.begin(),
      [=](float value) { return static_cast<float>(value / unit); });
    this->medium.emission.values = this->emission.data();
  }
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
  this->TakeUncollided(unit);
}

void SceneInUnits::TakeUncollided(double unit)
{
  UncollidedImage& image = this->illumination.uncollided;
  if (!image.IsThere())
  {
    return;
  }
  const std::size_t count = this->medium.grid.VoxelCount() * static_cast<std::size_t>(image.fluence.components);
  this->uncollided.resize(count);
  std::transform(image.fluence.values, image.fluence.values + count, this->uncollided.begin(),
    [=](float value) { return static_cast<float>(value / unit); });
  image.fluence.values = this->uncollided.data();
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

SceneInLengths::SceneInLengths(const Medium& inLengths, const Illumination& shining, double unit)
  : medium(inLengths)
  , illumination(shining)
{
  Grid& grid = this->medium.grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.spacing[axis] /= unit;
    grid.origin[axis] /= unit;
  }
  const auto scale = [&](Field& field, std::vector<float>& values) {
    if (field.values)
    {
      values.resize(grid.VoxelCount() * static_cast<std::size_t>(field.components));
      std::transform(field.values, field.values + values.size(), values.begin(),
        [=](float perLength) { return static_cast<float>(perLength * unit); });
      field.values = values.data();
    }
  };
  scale(this->medium.sigma_a, this->sigma_a);
  scale(this->medium.sigma_s, this->sigma_s);
  scale(this->medium.emission, this->emission);
  Check(this->medium); // they may be beyond floats now
  for (Light& light : this->illumination.lights)
  {
    std::for_each(light.position.begin(), light.position.end(), [=](double& length) { length /= unit; });
    std::for_each(light.size.begin(), light.size.end(), [=](double& length) { length /= unit; });
    if (light.type != LightType::Directional) // whose power is that of an area already
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
    Multiply(*watts, factor);
  }
  for (Rgb& watts : light.facePowerOut)
  {
    Multiply(watts, factor);
  }
  for (ConvergenceRow& row : light.convergence)
  {
    row.absorbed *= factor;
    row.escaped *= factor;
    row.leftOver *= factor;
  }
}
}
