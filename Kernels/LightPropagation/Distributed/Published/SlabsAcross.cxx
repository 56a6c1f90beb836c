#include "LightPropagation/Distributed/Published/SlabsAcross.h"

#include <algorithm>

namespace tyndall
{
SlabsAcross::SlabsAcross(const BlockPartition& blocks, int axis)
  : boxes{ blocks.whole, std::vector<VoxelBox>(blocks.blocks.size()) }
{
  std::vector<int> sorted;
  for (std::size_t rank = 0; rank < blocks.blocks.size(); ++rank)
  {
    if (blocks.blocks[rank].VoxelCount() > 0)
    {
      sorted.push_back(static_cast<int>(rank));
    }
  }
  const auto middle = [&](int rank) { return blocks.blocks[rank].first[axis] + EndOf(blocks.blocks[rank], axis); };
  std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) { return middle(a) < middle(b); });
  const std::size_t planes = static_cast<std::size_t>(blocks.whole.size[axis]);
  const std::size_t count = std::min(planes, sorted.size());
  for (std::size_t place = 0; place < count; ++place)
  {
    const int rank = sorted[place * sorted.size() / count];
    const int first = static_cast<int>(place * planes / count);
    VoxelBox& box = this->boxes.blocks[rank];
    box.size = blocks.whole.size;
    box.first[axis] = first;
    box.size[axis] = static_cast<int>((place + 1) * planes / count) - first;
    this->ranks.push_back(rank);
  }
}

int SlabsAcross::PlaceOf(int rank) const
{
  const auto found = std::find(this->ranks.begin(), this->ranks.end(), rank);
  return found == this->ranks.end() ? -1 : static_cast<int>(found - this->ranks.begin());
}
}
