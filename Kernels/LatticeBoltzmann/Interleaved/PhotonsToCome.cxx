#include "LatticeBoltzmann/Interleaved/PhotonsToCome.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Order of magnitude of the fluence, W / length^2, of light with the given power.
double UsualFluence(const Rgb& power, const Grid& grid)
{
  const double x = grid.Length(0), y = grid.Length(1), z = grid.Length(2), area = x * y + y * z + z * x;
  const double usual = Sum(power) / area;
  return usual > 1e-30 && usual < 1e30 ? usual : 1.0;
}
}

PhotonsToCome::PhotonsToCome(const PackedPhotons& packed, int given, const Grid& grid)
  : channels(given)
{
  const double usual = UsualFluence(packed.entered, grid);
  const bool colours = packed.channels == 3;
  Rgb colour = colours ? Rgb{ 1.0, 0.75, 0.5 } : packed.colour;
  std::for_each(colour.begin(), colour.end(), [&](double& value) { value *= usual; });
  this->escaped.fill(colour);
  for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
  {
    for (int c = 0; c < this->channels; ++c)
    {
      const std::size_t period = colours ? 5 + static_cast<std::size_t>(c) : 5;
      const auto place = static_cast<double>(i % period);
      this->fluence.push_back(static_cast<float>(colour[c] * (1.0 + 0.125 * place)));
    }
  }
}

UncollidedImage PhotonsToCome::Image() const
{
  UncollidedImage image;
  image.fluence = { this->fluence.data(), this->channels };
  image.escaped = this->escaped;
  return image;
}

PhotonChannelMap::PhotonChannelMap(
  const PhotonsToCome& photons, const UncollidedImage& solved, int channels, int channel)
{
  const Rgb& escaped = photons.escaped[0];
  const auto brightest = std::max_element(escaped.begin(), escaped.end()) - escaped.begin();
  const auto colour = static_cast<std::size_t>(channels == 1 ? brightest : channel);
  this->from = photons.channels == 1 ? 0 : static_cast<int>(colour);
  const double given = photons.fluence[static_cast<std::size_t>(this->from)];
  this->fluence = given > 0.0 ? solved.fluence.At(0, channel) / given : 0.0;
  this->power = escaped[colour] > 0.0 ? solved.escaped[0][static_cast<std::size_t>(channel)] / escaped[colour] : 0.0;
}

std::vector<float> ScattersOf(const Medium& medium, int channel, double unit, const std::vector<double>& begins)
{
  std::vector<float> scatters(medium.grid.VoxelCount());
  for (std::size_t i = 0; i < scatters.size(); ++i)
  {
    scatters[i] = static_cast<float>(begins[i] * unit * medium.grid.spacing[0] * medium.sigma_s.At(i, channel));
  }
  return scatters;
}
}
