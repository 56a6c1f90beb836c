#include "Distribution/BrickedBytes.h"

#include <algorithm>

namespace tyndall
{
namespace
{
constexpr std::int32_t NotYet = 256; ///< table entry of a brick without any stored byte; no byte has this value
constexpr std::uint32_t LongestRun = 1u << 24;

/// Run-length encoding of bytes. Each number holds a byte in its lower bits, and the number of repetitions minus one in
/// its upper bits.
std::vector<std::uint32_t> RunsOf(const std::vector<std::uint8_t>& numbers)
{
  std::vector<std::uint32_t> runs;
  for (std::size_t begin = 0; begin < numbers.size();)
  {
    std::size_t end = begin + 1;
    while (end < numbers.size() && end - begin < LongestRun && numbers[end] == numbers[begin])
    {
      ++end;
    }
    runs.push_back(static_cast<std::uint32_t>(end - begin - 1) << 8 | numbers[begin]);
    begin = end;
  }
  return runs;
}

std::vector<std::uint8_t> NumbersIn(const std::vector<std::uint32_t>& runs)
{
  std::vector<std::uint8_t> numbers;
  for (const std::uint32_t run : runs)
  {
    numbers.insert(numbers.end(), (run >> 8) + 1, static_cast<std::uint8_t>(run & 0xff));
  }
  return numbers;
}
}

BrickedBytes::BrickedBytes(const std::array<int, 3>& size)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Count[axis] = static_cast<std::size_t>((size[axis] + Edge - 1) / Edge);
  }
  this->Bricks.assign(this->Count[0] * this->Count[1] * this->Count[2], NotYet);
}

void BrickedBytes::Put(const VoxelBox& part, const VoxelBox& box, const std::vector<std::uint8_t>& numbers)
{
  const auto begin = [&](int axis) { return part.first[axis] / Edge * Edge; };
  for (int z = begin(2); z < EndOf(part, 2) && part.VoxelCount() > 0; z += Edge)
  {
    for (int y = begin(1); y < EndOf(part, 1); y += Edge)
    {
      for (int x = begin(0); x < EndOf(part, 0); x += Edge)
      {
        this->PutInBrick(Common({ { x, y, z }, { Edge, Edge, Edge } }, part), box, numbers);
      }
    }
  }
}

void BrickedBytes::PutInBrick(const VoxelBox& part, const VoxelBox& box, const std::vector<std::uint8_t>& numbers)
{
  std::int32_t& brick = this->Bricks[this->BrickOf(part.first)];
  bool even = true;
  std::uint8_t first = 0;
  const auto width = static_cast<std::size_t>(part.size[0]);
  ForRows(part, box, [&](std::size_t place, const std::array<int, 3>& voxel) {
    first = voxel == part.first ? numbers[place] : first;
    const auto from = numbers.begin() + static_cast<std::ptrdiff_t>(place);
    even = even && std::all_of(from, from + part.size[0], [&](std::uint8_t number) { return number == first; });
  });
  if (even && (brick == NotYet || brick == first))
  {
    brick = first;
    return;
  }
  if (brick >= 0)
  {
    const auto fill = static_cast<std::uint8_t>(brick == NotYet ? first : brick);
    brick = -1 - static_cast<std::int32_t>(this->Uneven.size() / Voxels);
    this->Uneven.resize(this->Uneven.size() + Voxels, fill);
  }
  ForRows(part, box, [&](std::size_t place, const std::array<int, 3>& voxel) {
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(place), width,
      this->Uneven.begin() + static_cast<std::ptrdiff_t>(Begin(brick) + Within(voxel)));
  });
}

namespace
{
std::vector<std::uint8_t> NumbersOf(const VoxelBox& part, const VoxelBox& box, const std::vector<std::uint8_t>& numbers)
{
  std::vector<std::uint8_t> some;
  ForRows(part, box, [&](std::size_t place, const std::array<int, 3>&) {
    const auto from = numbers.begin() + static_cast<std::ptrdiff_t>(place);
    some.insert(some.end(), from, from + part.size[0]);
  });
  return some;
}
}

BrickedBytes BytesOfBoxes(Communicator& communicator, const BlockPartition& partition,
  const std::vector<std::uint8_t>& own, const std::vector<VoxelBox>& wanted)
{
  const int self = communicator.Rank();
  const VoxelBox& block = partition.blocks[self];
  for (int rank = 0; rank < communicator.Ranks(); ++rank)
  {
    if (const VoxelBox part = Common(block, wanted[rank]); rank != self && part.VoxelCount() > 0)
    {
      communicator.Send(rank, MessageTag::RunsOfBytes, RunsOf(NumbersOf(part, block, own)));
    }
  }
  BrickedBytes bytes(partition.whole.size);
  for (int rank = 0; rank < communicator.Ranks(); ++rank)
  {
    const VoxelBox part = Common(partition.blocks[rank], wanted[self]);
    if (part.VoxelCount() == 0)
    {
      continue;
    }
    if (rank == self)
    {
      bytes.Put(part, block, own);
    }
    else
    {
      bytes.Put(part, part, NumbersIn(communicator.Receive<std::uint32_t>(rank, MessageTag::RunsOfBytes)));
    }
  }
  return bytes;
}

BrickedBytes BytesOfAll(
  Communicator& communicator, const BlockPartition& partition, const std::vector<std::uint8_t>& own)
{
  const std::vector<VoxelBox> all(partition.blocks.size(), VoxelBox{ { 0, 0, 0 }, partition.whole.size });
  return BytesOfBoxes(communicator, partition, own, all);
}
}
