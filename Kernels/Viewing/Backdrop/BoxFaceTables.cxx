#include "Viewing/Backdrop/BoxFaceTables.h"

#include <algorithm>

namespace tyndall
{
std::array<int, 2> FaceSize(const Grid& grid, int face)
{
  const PlaneAxes axes = AcrossAxis(face / 2);
  return { grid.size[axes.u], grid.size[axes.v] };
}

std::vector<cl_float4> WithBorders(const Grid& grid, const std::vector<cl_float4>& cells)
{
  std::vector<cl_float4> padded;
  std::size_t first = 0;
  for (int face = 0; face < 6; ++face)
  {
    const std::array<int, 2> size = FaceSize(grid, face);
    for (int j = -1; j <= size[1]; ++j)
    {
      for (int i = -1; i <= size[0]; ++i)
      {
        const std::size_t row = std::clamp(j, 0, size[1] - 1);
        padded.push_back(cells[first + row * size[0] + std::clamp(i, 0, size[0] - 1)]);
      }
    }
    first += static_cast<std::size_t>(size[0]) * size[1];
  }
  return padded;
}
}
