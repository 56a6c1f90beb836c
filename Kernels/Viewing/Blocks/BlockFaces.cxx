#include "Viewing/Blocks/BlockFaces.h"

#include "Medium/BoxFaces.h"

#include <algorithm>

namespace tyndall
{
std::vector<float> FacesOfBlock(
  const std::vector<float>& ofWhole, int components, const GridBlock& block, const std::array<int, 3>& size)
{
  Grid grid = block.whole;
  grid.size = size;
  std::vector<float> faces(BoxFaceCellCount(grid) * components, 0.0f);
  ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) {
    const PlaneAxes axes = AcrossAxis(cell.face / 2);
    const int plane = block.first[axes.axis] + (cell.face % 2 ? size[axes.axis] : 0);
    if (plane == (cell.face % 2 ? block.whole.size[axes.axis] : 0))
    {
      const BoxFaceLayout layout = LayoutOfFace(block.whole, cell.face);
      const std::size_t number = layout.first + (cell.u + block.first[axes.u]) * layout.step[axes.u] +
        (cell.v + block.first[axes.v]) * layout.step[axes.v];
      std::copy_n(ofWhole.begin() + number * components, components, faces.begin() + cell.number * components);
    }
  });
  return faces;
}
}
