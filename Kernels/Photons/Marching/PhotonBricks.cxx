#include "Photons/Marching/PhotonBricks.h"

#include "Device/HostMemory.h"
#include "Device/HostThreads.h"

#include <algorithm>

namespace tyndall
{
namespace
{
// As PhotonMedium.cl has them.
constexpr float OutsideOfGrid = -3e38f;
constexpr float ThickestVoxel = 1e30f;
}

PhotonBricks::PhotonBricks(Device& device, const FilledBricks& bricks, const Grid& grid)
  : Voxels(grid)
  , BrickCount(bricks.count)
  , RecordCount(1)
{
  this->Begin.reserve(bricks.filled.size());
  for (const unsigned char filled : bricks.filled)
  {
    const auto record = static_cast<cl_int>(this->RecordCount);
    this->Begin.push_back(filled ? record : -record);
    this->RecordCount += filled ? BrickVoxels : 1;
  }
  this->OnDevice = Buffer<cl_int>(device, this->Begin, "bricks of the medium");
}

template <class Act>
void PhotonBricks::ForFilled(const Act& act) const
{
  InThreads(this->Begin.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t brick = begin; brick < end; ++brick)
    {
      if (this->Begin[brick] < 0)
      {
        continue;
      }
      const int n = static_cast<int>(brick), nx = this->BrickCount[0], ny = this->BrickCount[1];
      const std::array<int, 3> low = { n % nx * BrickEdge, n / nx % ny * BrickEdge, n / (nx * ny) * BrickEdge };
      std::array<int, 3> high;
      for (int a = 0; a < 3; ++a)
      {
        high[a] = std::min(low[a] + BrickEdge, this->Voxels.size[a]);
      }
      for (int z = low[2]; z < high[2]; ++z)
      {
        for (int y = low[1]; y < high[1]; ++y)
        {
          const std::size_t voxel = this->Voxels.IndexOf({ low[0], y, z });
          const auto record =
            static_cast<std::size_t>(this->Begin[brick] + ((z - low[2]) * BrickEdge + (y - low[1])) * BrickEdge);
          for (int x = low[0]; x < high[0]; ++x)
          {
            const auto along = static_cast<std::size_t>(x - low[0]);
            act(record + along, voxel + along);
          }
        }
      }
    }
  });
}

std::vector<float> PhotonBricks::Extinction(const Medium& medium, double diagonal, int channels) const
{
  std::vector<float> sigma = Zeros(this->RecordCount * static_cast<std::size_t>(channels));
  for (int c = 0; c < channels; ++c)
  {
    float* const values = sigma.data() + static_cast<std::size_t>(c) * this->RecordCount;
    values[0] = OutsideOfGrid;
    const auto over = static_cast<float>(diagonal);
    this->ForFilled([&](std::size_t record, std::size_t voxel) {
      const float extinction = medium.sigma_a.At(voxel, c) + medium.sigma_s.At(voxel, c);
      values[record] = std::min(over * extinction, ThickestVoxel);
    });
  }
  return sigma;
}

std::vector<float> PhotonBricks::Coefficient(const Field& field, int components) const
{
  const auto each = static_cast<std::size_t>(components);
  std::vector<float> values = Zeros(this->RecordCount * each);
  this->ForFilled([&](std::size_t record, std::size_t voxel) {
    std::copy_n(field.values + voxel * each, each, values.begin() + static_cast<std::ptrdiff_t>(record * each));
  });
  return values;
}
}
