#include "Numerics/PyramidLayout.h"

#include "Device/Sizes.h"

#include <algorithm>

namespace tyndall
{
PyramidLayout::PyramidLayout(const std::array<int, 3>& grid)
{
  this->sizes.push_back(grid);
  this->offsets.push_back(0);
  while (*std::max_element(this->sizes.back().begin(), this->sizes.back().end()) > 1)
  {
    std::array<int, 3> size = this->sizes.back();
    for (int& nodes : size)
    {
      nodes = nodes / 2 + nodes % 2;
    }
    this->sizes.push_back(size);
    this->offsets.push_back(this->nodeCount);
    this->nodeCount +=
      static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  }
}

cl::NDRange PyramidRange(const std::array<int, 3>& nodes)
{
  const cl::NDRange group = PyramidGroup();
  std::array<std::size_t, 3> range;
  for (int axis = 0; axis < 3; ++axis)
  {
    range[axis] = RoundUp(Count(nodes[axis]), group.get()[axis]);
  }
  return cl::NDRange(range[0], range[1], range[2]);
}
}
