#include "Distribution/PyramidBlocks.h"

#include "Distribution/BoxExchange.h"
#include "Numerics/PyramidLayout.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// The block and its margin, extended to multiples of `edge` voxels; empty if the block is empty.
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

PyramidBlocks::PyramidBlocks(const Domain& domain, int shared, int margin, int edge)
  : TheDomain(domain)
  , SharedLevel(shared)
{
  const PyramidLayout layout(domain.Whole().size);
  this->Cells.whole.size = layout.sizes[static_cast<std::size_t>(std::min(shared, layout.Top()))];
  for (const VoxelBox& block : domain.Partition().blocks)
  {
    this->Boxes.push_back(BoxAround(block, domain.Whole(), margin, edge));
    this->Cells.blocks.push_back(this->CellsIn(block));
    this->AnyMargin |= this->Boxes.back().VoxelCount() > block.VoxelCount();
  }
}

VoxelBox PyramidBlocks::CellsIn(const VoxelBox& box) const
{
  const int edge = 1 << this->SharedLevel;
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
  Grid grid = this->TheDomain.Whole();
  grid.size = size;
  return grid;
}

const float* PyramidBlocks::Gather(const float* own, int components, std::vector<float>& storage) const
{
  if (!this->AnyMargin)
  {
    return own;
  }
  const std::size_t count = this->TheDomain.Own().VoxelCount() * static_cast<std::size_t>(components);
  const std::vector<float> values(own, own + (own ? count : 0));
  storage = ValuesInBox(this->TheDomain.Comm(), this->TheDomain.Partition(), this->Boxes, values, components);
  return storage.data();
}

void PyramidBlocks::Crop(std::vector<float>& values, int components) const
{
  if (this->AnyMargin && !values.empty())
  {
    values = PartOf(values, this->Box(), this->TheDomain.Own(), components);
  }
}

void PyramidBlocks::Crop(std::vector<std::uint8_t>& values) const
{
  if (this->AnyMargin && !values.empty())
  {
    values = PartOf(values, this->Box(), this->TheDomain.Own());
  }
}

std::vector<float> PyramidBlocks::GatherCells(const std::vector<float>& made, int components) const
{
  const auto rank = static_cast<std::size_t>(this->TheDomain.Rank());
  std::vector<VoxelBox> wanted;
  for (const VoxelBox& block : this->TheDomain.Partition().blocks)
  {
    wanted.push_back(block.VoxelCount() > 0 ? this->AllCells() : VoxelBox());
  }
  const std::vector<float> known =
    made.empty() ? made : PartOf(made, this->BoxCells(), this->Cells.blocks[rank], components);
  return ValuesInBox(this->TheDomain.Comm(), this->Cells, wanted, known, components);
}
}
