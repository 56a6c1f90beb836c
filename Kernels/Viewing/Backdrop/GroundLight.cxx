#include "Viewing/Backdrop/GroundLight.h"

#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Viewing/Backdrop/BoxFaceTables.h"

namespace tyndall
{
int GroundFaces(const SolvedLight& light)
{
  int faces = 0;
  for (int face = 0; face < 6 && light.facePower.values; ++face)
  {
    faces |= IsBlack(light.faceAlbedo[face]) ? 0 : 1 << face;
  }
  return faces;
}

std::vector<cl_float4> GroundLight(const Grid& grid, const SolvedLight& light)
{
  if (GroundFaces(light) == 0)
  {
    return {};
  }
  std::vector<cl_float4> cells(BoxFaceCellCount(grid));
  ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) {
    for (int c = 0; c < 3; ++c)
    {
      const double leaves = light.facePower.At(cell.number, light.facePower.components == 3 ? c : 0);
      cells[cell.number].s[c] = static_cast<float>(light.faceAlbedo[cell.face][c] * leaves / Pi);
    }
  });
  return WithBorders(grid, cells);
}
}
