#include "Distribution/CoarseBlocks.h"

#include "Distribution/BoxExchange.h"

namespace tyndall
{
CoarseBlocks::CoarseBlocks(Communicator& communicator, const BlockPartition& fine, const Grid& coarse)
  : TheCommunicator(communicator)
  , FinePartition(fine)
  , Whole(fine.whole, coarse)
  , OwnPart(Whole)
  , SeenPart(Whole)
{
  this->CoarsePartition.whole = this->Whole.Coarse();
  for (const VoxelBox& block : fine.blocks)
  {
    const VoxelBox own = block.VoxelCount() > 0 ? this->Whole.CoarseBox(block) : VoxelBox();
    const VoxelBox around = this->Whole.FineBox(own), seen = this->Whole.ParentBox(block);
    this->CoarsePartition.blocks.push_back(own);
    this->AroundBoxes.push_back(around);
    this->SeenBoxes.push_back(seen.VoxelCount() > 0 ? Grown(seen, 1, this->Whole.Coarse()) : seen);
    this->AnyStraddles = this->AnyStraddles || Common(around, block).VoxelCount() < around.VoxelCount();
  }
  const int rank = communicator.Rank();
  this->OwnPart = this->Whole.PartOf(this->AroundBoxes[rank], this->OwnBox());
  this->SeenPart = this->Whole.PartOf(fine.blocks[rank], this->SeenBoxes[rank]);
}

std::vector<float> CoarseBlocks::Around(const std::vector<float>& values, int components) const
{
  return ValuesInBox(this->TheCommunicator, this->FinePartition, this->AroundBoxes, values, components);
}

std::vector<float> CoarseBlocks::Average(const std::vector<float>& values, int components) const
{
  return this->OwnPart.Average(
    this->AnyStraddles ? this->Around(values, components).data() : values.data(), components);
}

std::vector<float> CoarseBlocks::SeenOf(const std::vector<float>& values, int components) const
{
  return ValuesInBox(this->TheCommunicator, this->CoarsePartition, this->SeenBoxes, values, components);
}
}
