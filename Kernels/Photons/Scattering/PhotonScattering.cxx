#include "Photons/Scattering/PhotonScattering.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
namespace
{
/// Scattering and absorption over a diagonal, of the padded grid; 0 in the padding.
std::vector<float> OpticalOf(const MarchMedium& through, const Medium& medium)
{
  const std::array<int, 3>& size = medium.grid.size;
  std::vector<float> values(2 * through.PaddedCount(), 0.0f);
  const double diagonal = through.Diagonal();
  std::size_t voxel = 0;
  for (int z = 0; z < size[2]; ++z)
  {
    for (int y = 0; y < size[1]; ++y)
    {
      for (int x = 0; x < size[0]; ++x, ++voxel)
      {
        const std::size_t at = (static_cast<std::size_t>(z + 1) * (size[1] + 2) + y + 1) * (size[0] + 2) + x + 1;
        values[2 * at] = static_cast<float>(std::min(diagonal * medium.sigma_s.At(voxel, 0), 1e30));
        values[2 * at + 1] = static_cast<float>(std::min(diagonal * medium.sigma_a.At(voxel, 0), 1e30));
      }
    }
  }
  return values;
}
}

double ScatteringStepPart(const Field& ior, const std::array<int, 3>& size)
{
  constexpr double Seen = 0.5, Least = 0.1; // of the largest jump between neighbours, over the lesser n^2, by a step
  double jump = 0.0;
  const std::array<std::size_t, 3> stride = { 1, static_cast<std::size_t>(size[0]),
    static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) };
  const std::size_t voxels = ior.values ? stride[2] * static_cast<std::size_t>(size[2]) : 0;
  for (std::size_t i = 0; i < voxels; ++i)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      if (i / stride[a] % static_cast<std::size_t>(size[a]) + 1 < static_cast<std::size_t>(size[a]))
      {
        const double here = std::pow(ior.At(i, 0), 2), there = std::pow(ior.At(i + stride[a], 0), 2);
        jump = std::max(jump, std::abs(here - there) / std::min(here, there));
      }
    }
  }
  return std::clamp(Seen / std::max(jump, 1e-9), Least, 1.0);
}

PhotonScattering::PhotonScattering(const MarchMedium& through, const Medium& medium, double stepPart)
  : Through(through)
  , StepPart(stepPart)
  , Optical(through.device, OpticalOf(through, medium), "how voxels scatter")
  , Phase(through.device, medium)
{
}
}
