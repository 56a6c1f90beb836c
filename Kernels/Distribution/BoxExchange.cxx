#include "Distribution/BoxExchange.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Extracts the values in the box `part` from an array over the box `box`, `components` per voxel.
template <class T>
std::vector<T> TakeFrom(const std::vector<T>& values, const VoxelBox& box, const VoxelBox& part, int components)
{
  std::vector<T> taken;
  taken.reserve(part.VoxelCount() * components);
  const auto width = static_cast<std::ptrdiff_t>(part.size[0]) * components;
  ForRows(part, box, [&](std::size_t place, const auto&) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(place * components);
    taken.insert(taken.end(), from, from + width);
  });
  return taken;
}

}

void PutPart(const std::vector<float>& taken, std::vector<float>& values, const VoxelBox& box, const VoxelBox& part,
  int components)
{
  const std::ptrdiff_t width = static_cast<std::ptrdiff_t>(part.size[0]) * components;
  auto from = taken.begin();
  ForRows(part, box, [&](std::size_t place, const auto&) {
    std::copy_n(from, width, values.begin() + static_cast<std::ptrdiff_t>(place * components));
    from += width;
  });
}

std::vector<float> PartOf(const std::vector<float>& values, const VoxelBox& box, const VoxelBox& part, int components)
{
  return TakeFrom(values, box, part, components);
}

std::vector<std::int64_t> PartOf(const std::vector<std::int64_t>& values, const VoxelBox& box, const VoxelBox& part)
{
  return TakeFrom(values, box, part, 1);
}

std::vector<std::uint8_t> PartOf(const std::vector<std::uint8_t>& values, const VoxelBox& box, const VoxelBox& part)
{
  return TakeFrom(values, box, part, 1);
}

std::vector<float> ValuesInBox(Communicator& communicator, const BlockPartition& partition,
  const std::vector<VoxelBox>& wanted, const std::vector<float>& own, int components)
{
  const int self = communicator.Rank();
  const VoxelBox& block = partition.blocks.at(self);
  const VoxelBox& box = wanted.at(self);
  for (int rank = 0; rank < communicator.Ranks(); ++rank)
  {
    if (const VoxelBox theirs = Common(block, wanted[rank]); rank != self && theirs.VoxelCount() > 0)
    {
      communicator.Send(rank, MessageTag::ValuesOfBoxes, PartOf(own, block, theirs, components));
    }
  }
  std::vector<float> values(box.VoxelCount() * components);
  for (int rank = 0; rank < communicator.Ranks(); ++rank)
  {
    if (const VoxelBox mine = Common(partition.blocks[rank], box); mine.VoxelCount() > 0)
    {
      PutPart(rank == self ? PartOf(own, block, mine, components)
                           : communicator.Receive<float>(rank, MessageTag::ValuesOfBoxes),
        values, box, mine, components);
    }
  }
  return values;
}

std::vector<float> ValuesOfGrid(
  Communicator& communicator, const BlockPartition& partition, const std::vector<float>& own, int components)
{
  const std::vector<VoxelBox> wanted(partition.blocks.size(), VoxelBox{ {}, partition.whole.size });
  return ValuesInBox(communicator, partition, wanted, own, components);
}
}
