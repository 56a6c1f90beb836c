#include "LightPropagation/Diffusion/BlockWithGhosts.h"

#include "Medium/GridOfBox.h"

#include <algorithm>

namespace tyndall
{
namespace
{
Grid GridOf(const Grid& whole, const VoxelBox& box)
{
  Grid grid = GridOfBox(box, whole);
  grid.size = box.VoxelCount() > 0 ? box.size : std::array<int, 3>{ 0, 0, 0 };
  return grid;
}
}

BlockWithGhosts::BlockWithGhosts(Communicator& communicator, const BlockPartition& partition,
  const std::array<bool, 3>& periodic, int channels, bool sharedExtinction)
  : Comm(communicator)
  , Block(partition.blocks[communicator.Rank()])
  , Alone(GoesRoundAlone(this->Block, partition.whole.size, periodic))
{
  std::vector<std::vector<VoxelBox>> ghosts;
  for (const VoxelBox& block : partition.blocks)
  {
    ghosts.push_back(LayersBeside(block, partition.whole.size, periodic));
  }
  this->Box = Hull(this->Block, ghosts[communicator.Rank()]);
  this->OfBlock = { GridOf(partition.whole, this->Block), channels, sharedExtinction };
  this->OfBox = { GridOf(partition.whole, this->Box), channels, sharedExtinction };
  this->Ghosts = std::make_unique<GhostCells>(communicator, partition.blocks, ghosts, this->Box, partition.whole.size);
}

std::size_t BlockWithGhosts::PlaceOf(std::size_t ownVoxel) const
{
  std::array<int, 3> voxel = this->OfBlock.grid.VoxelAt(ownVoxel);
  for (int axis = 0; axis < 3; ++axis)
  {
    voxel[axis] += this->Block.first[axis] - this->Box.first[axis];
  }
  return this->OfBox.grid.IndexOf(voxel);
}

bool BlockWithGhosts::IsOwn(const std::array<int, 3>& voxel) const
{
  bool own = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int place = voxel[axis] + this->Box.first[axis];
    own = own && place >= this->Block.first[axis] && place < EndOf(this->Block, axis);
  }
  return own;
}

std::size_t BlockWithGhosts::OwnAt(const std::array<int, 3>& voxel) const
{
  std::array<int, 3> own = voxel;
  for (int axis = 0; axis < 3; ++axis)
  {
    own[axis] += this->Box.first[axis] - this->Block.first[axis];
  }
  return this->OfBlock.grid.IndexOf(own);
}

std::vector<float> BlockWithGhosts::Placed(const std::vector<float>& own, int parts, float elsewhere) const
{
  const std::array<int, 3>& n = this->OfBlock.grid.size;
  std::vector<float> held(parts * this->OfBox.Stride() + SweepPadding, elsewhere);
  for (int part = 0; part < parts && this->Has(); ++part)
  {
    for (int row = 0; row < n[1] * n[2]; ++row)
    {
      const std::size_t first = static_cast<std::size_t>(row) * n[0];
      std::copy_n(own.begin() + static_cast<std::ptrdiff_t>(part * this->OfBlock.Stride() + first), n[0],
        held.begin() + static_cast<std::ptrdiff_t>(part * this->OfBox.Stride() + this->PlaceOf(first)));
    }
  }
  return held;
}

void BlockWithGhosts::Spread(const std::vector<float>& own, int parts, Buffer<float>& held, float elsewhere) const
{
  this->Comm.Collective([&] {
    const std::vector<float> values = this->Placed(own, parts, elsewhere);
    held.Write(values.data(), values.size());
  });
}

void BlockWithGhosts::SpreadWithGhosts(const std::vector<float>& own, int parts, Buffer<float>& held) const
{
  std::vector<float> values = this->Placed(own, parts, 0.0f);
  this->Ghosts->Fill(values.data(), parts, this->OfBox.Stride());
  this->Comm.Collective([&] { held.Write(values.data(), values.size()); });
}

void BlockWithGhosts::FillGhosts(Buffer<float>& ofVoxels) const
{
  std::vector<float> values;
  this->Comm.Collective([&] { values = ofVoxels.Read(); });
  this->Ghosts->Fill(values.data(), 1, 0);
  this->Comm.Collective([&] { ofVoxels.Write(values.data()); });
}

std::vector<float> BlockWithGhosts::TakeOwn(const Buffer<float>& held, int parts) const
{
  const std::array<int, 3>& n = this->OfBlock.grid.size;
  std::vector<float> own(parts * this->OfBlock.Stride() + SweepPadding, 0.0f);
  const std::vector<float> values = this->Has() ? held.Read() : std::vector<float>();
  for (int part = 0; part < parts && this->Has(); ++part)
  {
    for (int row = 0; row < n[1] * n[2]; ++row)
    {
      const std::size_t first = static_cast<std::size_t>(row) * n[0];
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(part * this->OfBox.Stride() + this->PlaceOf(first)),
        n[0], own.begin() + static_cast<std::ptrdiff_t>(part * this->OfBlock.Stride() + first));
    }
  }
  return own;
}
}
