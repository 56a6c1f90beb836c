#include "LightPropagation/Distributed/BlockContact.h"

namespace tyndall
{
std::vector<BlockContact> ContactsBetween(
  const BlockPartition& partition, const ParallelBundles& rays, int from, int to)
{
  const VoxelBox& source = partition.blocks[from];
  const VoxelBox& target = partition.blocks[to];
  if (from == to || source.VoxelCount() == 0 || target.VoxelCount() == 0)
  {
    return {};
  }
  const PlaneAxes axes = AcrossAxis(rays.axis);
  // The layers of cells before the target, along any of the axes.
  const auto before = [&](std::initializer_list<int> along) {
    VoxelBox cells = target;
    for (const int axis : along)
    {
      cells.first[axis] = rays.signs[axis] > 0 ? target.first[axis] - 1 : EndOf(target, axis);
      cells.size[axis] = 1;
    }
    return Common(cells, source);
  };
  std::vector<BlockContact> contacts = { { from, to, BlockContact::Along, before({ axes.axis }) },
    { from, to, BlockContact::AsideU, before({ axes.u }) }, { from, to, BlockContact::AsideV, before({ axes.v }) } };
  if (rays.goThroughEdges)
  {
    contacts.push_back({ from, to, BlockContact::Edge, before({ axes.u, axes.v }) });
  }
  std::vector<BlockContact> there;
  for (const BlockContact& contact : contacts)
  {
    if (contact.cells.VoxelCount() > 0)
    {
      there.push_back(contact);
    }
  }
  return there;
}
}
