#include "Photons/Marching/PhotonBricks.h"

#include "Device/HostMemory.h"
#include "Device/HostThreads.h"
#include "Device/Sizes.h"

#include <algorithm>

namespace tyndall
{
namespace
{
// As in PhotonMedium.cl.
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
          act(record, voxel, static_cast<std::size_t>(high[0] - low[0]));
        }
      }
    }
  });
}

PhotonBricks::Coefficients PhotonBricks::Pack(
  const Medium& medium, double diagonal, int channels, int aComponents, int sComponents) const
{
  const std::size_t ofA = tyndall::Count(aComponents), ofS = tyndall::Count(sComponents);
  const std::size_t all = tyndall::Count(channels);
  Coefficients packed = { Zeros(this->RecordCount * all), Zeros(this->RecordCount * ofA),
    Zeros(this->RecordCount * ofS) };
  for (std::size_t c = 0; c < all; ++c)
  {
    packed.extinction[c * this->RecordCount] = OutsideOfGrid;
  }
  const auto over = static_cast<float>(diagonal);
  // Copies a whole row at a time: rows of a brick are far apart in memory.
  this->ForFilled([&](std::size_t record, std::size_t voxel, std::size_t count) {
    std::copy_n(medium.sigma_a.values + voxel * ofA, count * ofA, packed.sigmaA.data() + record * ofA);
    std::copy_n(medium.sigma_s.values + voxel * ofS, count * ofS, packed.sigmaS.data() + record * ofS);
    for (std::size_t c = 0; c < all; ++c)
    {
      float* const values = packed.extinction.data() + c * this->RecordCount + record;
      for (std::size_t i = 0; i < count; ++i)
      {
        const int channel = static_cast<int>(c);
        const float extinction = medium.sigma_a.At(voxel + i, channel) + medium.sigma_s.At(voxel + i, channel);
        values[i] = std::min(over * extinction, ThickestVoxel);
      }
    }
  });
  return packed;
}
}
