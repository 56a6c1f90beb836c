#include "DiscreteOrdinates/Distributed/CellsOfBlock.h"

#include "LightPropagation/Sweep/Pipelined/SweepInBlocks.h"
#include "Medium/BoxFaces.h"

namespace tyndall
{
int InnerFacesOf(const OrdinatesRanks& ranks)
{
  const VoxelBox& block = ranks.partition.blocks[ranks.others.Rank()];
  int inner = ranks.Has() ? 0 : AllFaces;
  for (int axis = 0; axis < 3; ++axis)
  {
    inner |= block.first[axis] > 0 ? 1 << (2 * axis) : 0;
    inner |= EndOf(block, axis) < ranks.partition.whole.size[axis] ? 1 << (2 * axis + 1) : 0;
  }
  return inner;
}

CellsOfBlock::CellsOfBlock(Device& device, const OrdinatesRanks& ranks, const Grid& own,
  const std::array<bool, 3>& periodic, const LightOfCells& ofWhole)
  : TheDevice(device)
  , Ranks(ranks)
  , OfWhole(ofWhole)
  , Out(device, BoxFaceCellCount(own), "the light that leaves by cells")
  , In(device, BoxFaceCellCount(own), "the light that faces give back")
  , OfBlock{ this->Out, this->In }
{
  const VoxelBox& block = ranks.partition.blocks[ranks.others.Rank()];
  const int inner = InnerFacesOf(ranks);
  ForBoxFaceCells(own, [&](const BoxFaceCell& cell) {
    if (!(inner >> cell.face & 1) && !periodic[cell.face / 2])
    {
      const std::array<int, 3> at = own.VoxelAt(cell.voxel);
      const BoxFaceLayout layout = LayoutOfFace(ranks.partition.whole, cell.face);
      std::size_t there = layout.first;
      for (int axis = 0; axis < 3; ++axis)
      {
        there += static_cast<std::size_t>(block.first[axis] + at[axis]) * layout.step[axis];
      }
      this->Places.push_back({ cell.number, there });
    }
  });
  this->Out.Fill(0.0f);
}

void CellsOfBlock::LetIn()
{
  const std::vector<float> ofWhole = this->OfWhole.in.Read();
  std::vector<float> in(this->In.Size(), 0.0f);
  for (const auto& [here, there] : this->Places)
  {
    in[here] = ofWhole[there];
  }
  this->In.Write(in.data());
}

void CellsOfBlock::LetOut(const std::function<void()>& leave)
{
  std::vector<double> left;
  this->Ranks.others.Collective([&] {
    left.resize(this->OfWhole.out.Size(), 0.0);
    this->Out.Fill(0.0f);
    leave();
    const std::vector<float> out = this->Out.Read();
    for (const auto& [here, there] : this->Places)
    {
      left[there] = out[here];
    }
  });
  AddOverRanks(this->TheDevice, this->Ranks.others, left, this->OfWhole.out);
}
}
