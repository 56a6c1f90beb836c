#include "Reconstruction/Distributed/PyramidBlocks.h"

#include "Distribution/BoxExchange.h"
#include "Numerics/PyramidLayout.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// A block and the margin, from edge to edge.
VoxelBox BoxAround(const VoxelBox& block, const Grid& whole, int margin, int edge)
{
  VoxelBox box = block.VoxelCount() > 0 ? Grown(block, margin, whole) : VoxelBox();
  for (int axis = 0; axis < 3 && box.VoxelCount() > 0; ++axis)
  {
    const int end = (EndOf(box, axis) + edge - 1) / edge * edge;
    box.first[axis] = box.first[axis] / edge * edge;
    box.size[axis] = std::min(end, whole.size[axis]) - box.first[axis];
  }
  return box;
}
}

PyramidBlocks::PyramidBlocks(const BlockPartition& ofVoxels, int level, int margin, int edge)
  : partition(ofVoxels)
  , shared(level)
{
  const PyramidLayout layout(ofVoxels.whole.size);
  this->cells.whole.size = layout.sizes[static_cast<std::size_t>(std::min(level, layout.Top()))];
  for (const VoxelBox& block : ofVoxels.blocks)
  {
    this->around.push_back(BoxAround(block, ofVoxels.whole, margin, edge));
    this->cells.blocks.push_back(this->CellsIn(block));
  }
}

VoxelBox PyramidBlocks::CellsIn(const VoxelBox& box) const
{
  const int edge = 1 << this->shared;
  VoxelBox inside;
  for (int axis = 0; axis < 3; ++axis)
  {
    inside.first[axis] = (box.first[axis] + edge - 1) / edge;
    inside.size[axis] = (EndOf(box, axis) + edge - 1) / edge - inside.first[axis];
  }
  return box.VoxelCount() > 0 && inside.VoxelCount() > 0 ? inside : VoxelBox();
}

Grid PyramidBlocks::GridOf(const std::array<int, 3>& size) const
{
  Grid grid = this->partition.whole;
  grid.size = size;
  return grid;
}

std::vector<float> PyramidBlocks::Gather(Communicator& communicator, const std::vector<float>& made, int fields) const
{
  const int rank = communicator.Rank();
  const VoxelBox all = { {}, this->SharedSize() };
  std::vector<VoxelBox> wanted;
  for (const VoxelBox& block : this->partition.blocks)
  {
    wanted.push_back(block.VoxelCount() > 0 ? all : VoxelBox());
  }
  const VoxelBox& own = this->cells.blocks[static_cast<std::size_t>(rank)];
  const std::vector<float> known = made.empty() ? made : PartOf(made, this->CellsIn(this->Around(rank)), own, fields);
  return ValuesInBox(communicator, this->cells, wanted, known, fields);
}
}
