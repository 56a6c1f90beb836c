#include "Viewing/Scene/GridBlock.h"

#include "Medium/BoxFaces.h"

#include <algorithm>
#include <array>

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

namespace
{
/// Whether a camera ray can pass from block b into block a: it must be able to cross, in this direction, the separating
/// plane along every axis that has one.
bool CanHide(const GridBlock& b, const GridBlock& a, const Camera& camera)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool below = a.end[axis] <= b.begin[axis];
    const bool above = b.end[axis] <= a.begin[axis];
    const double eye = (camera.position[axis] - a.whole.origin[axis]) / a.whole.spacing[axis];
    const double forward = camera.focalPoint[axis] - camera.position[axis];
    if ((below && (camera.parallelProjection ? forward >= 0.0 : eye <= b.begin[axis])) ||
      (above && (camera.parallelProjection ? forward <= 0.0 : eye >= b.end[axis])))
    {
      return false;
    }
  }
  return true;
}
}

std::vector<int> FrontToBack(const std::vector<GridBlock>& blocks, const Camera& camera)
{
  std::vector<int> waiting, order;
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    waiting.push_back(static_cast<int>(i));
  }
  while (!waiting.empty())
  {
    const auto isHidden = [&](int a) {
      return std::any_of(
        waiting.begin(), waiting.end(), [&](int b) { return b != a && CanHide(blocks[b], blocks[a], camera); });
    };
    auto front = std::find_if_not(waiting.begin(), waiting.end(), isHidden);
    front = front == waiting.end() ? waiting.begin() : front;
    order.push_back(*front);
    waiting.erase(front);
  }
  return order;
}
}
