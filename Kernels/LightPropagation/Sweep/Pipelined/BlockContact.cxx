#include "LightPropagation/Sweep/Pipelined/BlockContact.h"

#include <initializer_list>

namespace tyndall
{
std::vector<BlockContact> ContactsBetween(
  const BlockPartition& partition, const ParallelBundles& rays, int from, int to, const std::array<bool, 3>& periodic)
{
  const VoxelBox& source = partition.blocks[from];
  const VoxelBox& target = partition.blocks[to];
  if (source.VoxelCount() == 0 || target.VoxelCount() == 0)
  {
    return {};
  }
  const PlaneAxes axes = AcrossAxis(rays.axis);
  // Layers of cells upwind of the target block, along each of the axes.
  const auto contact = [&](BlockContact::Kind kind, std::initializer_list<int> along) {
    BlockContact found = { from, to, kind, target, false };
    for (const int axis : along)
    {
      const int size = partition.whole.size[axis];
      int& first = found.cells.first[axis];
      first = rays.signs[axis] > 0 ? target.first[axis] - 1 : EndOf(target, axis);
      found.cells.size[axis] = 1;
      if (periodic[axis] && (first < 0 || first >= size))
      {
        first = first < 0 ? size - 1 : 0;
        found.around = true;
      }
    }
    found.cells = Common(found.cells, source);
    return found;
  };
  std::vector<BlockContact> contacts = { contact(BlockContact::Along, { axes.axis }),
    contact(BlockContact::AsideU, { axes.u }), contact(BlockContact::AsideV, { axes.v }) };
  if (rays.goThroughEdges)
  {
    contacts.push_back(contact(BlockContact::Edge, { axes.u, axes.v }));
  }
  std::vector<BlockContact> there;
  for (const BlockContact& one : contacts)
  {
    if (one.cells.VoxelCount() > 0)
    {
      there.push_back(one);
    }
  }
  return there;
}
}
