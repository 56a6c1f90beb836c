#include "Viewing/Backdrop/TableLight.h"

#include "Numerics/Constants.h"
#include "Numerics/Vectors.h"
#include "Viewing/Backdrop/BoxFaceTables.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tyndall
{
std::vector<cl_float4> TableLight(
  const Grid& grid, const Field& fluence, const Field& meanDirection, const Field& ior, int face, bool fromBelow)
{
  const int axis = face / 2;
  const double outwards = face % 2 ? 1.0 : -1.0;
  const std::array<int, 2> size = FaceSize(grid, face);
  const std::array<std::size_t, 3> strides = grid.Strides();
  std::vector<cl_float4> lit;
  lit.reserve(static_cast<std::size_t>(size[0] + 2) * (size[1] + 2));
  for (int j = -1; j <= size[1]; ++j)
  {
    for (int i = -1; i <= size[0]; ++i)
    {
      const std::size_t voxel = std::clamp(i, 0, size[0] - 1) * strides[AcrossAxis(axis).u] +
        std::clamp(j, 0, size[1] - 1) * strides[AcrossAxis(axis).v] +
        (face % 2 ? grid.size[axis] - 1 : 0) * strides[axis];
      const double n = ior.values ? ior.values[voxel] : 1.0;
      glm::dvec3 mean(0.0);
      if (meanDirection.values)
      {
        const float* m = meanDirection.values + 3 * voxel;
        mean = glm::dvec3(m[0], m[1], m[2]) / std::max(1.0, glm::length(glm::dvec3(m[0], m[1], m[2])));
      }
      const double even = fromBelow || !meanDirection.values ? 0.25 * (1.0 - glm::length(mean)) : 0.0;
      const double part = even + std::max(outwards * mean[axis], 0.0);
      const glm::dvec3 all(fluence.At(voxel, 0), fluence.At(voxel, 1), fluence.At(voxel, 2));
      lit.push_back(Float4(all * (part / (Pi * n * n)), 0.0));
    }
  }
  return lit;
}
}
