#include "LightPropagation/Diffusion/BlockWithGhosts.h"

#include "Medium/VoxelBox.h"

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

BlockWithGhosts::BlockWithGhosts(
  const Domain& domain, const std::array<bool, 3>& periodic, int channels, bool sharedExtinction)
  : Of(domain)
  , Alone(GoesRoundAlone(domain.Own(), domain.Whole().size, periodic))
{
  const Grid& whole = domain.Whole();
  const std::vector<VoxelBox>& blocks = domain.Partition().blocks;
  std::vector<std::vector<VoxelBox>> ghosts;
  for (const VoxelBox& block : blocks)
  {
    ghosts.push_back(LayersBeside(block, whole.size, periodic));
  }
  this->Box = Hull(domain.Own(), ghosts[domain.Rank()]);
  this->OfBlock = { GridOf(whole, domain.Own()), channels, sharedExtinction };
  this->OfBox = { GridOf(whole, this->Box), channels, sharedExtinction };
  this->Ghosts = std::make_unique<GhostCells>(domain.Comm(), blocks, ghosts, this->Box, whole.size);
}

std::size_t BlockWithGhosts::PlaceOf(std::size_t ownVoxel) const
{
  return this->OfBox.grid.IndexOf(this->Box.Within(this->Of.Own().VoxelAt(ownVoxel)));
}

bool BlockWithGhosts::IsOwn(const std::array<int, 3>& voxel) const
{
  bool own = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int place = voxel[axis] + this->Box.first[axis];
    own = own && place >= this->Of.Own().first[axis] && place < EndOf(this->Of.Own(), axis);
  }
  return own;
}

std::size_t BlockWithGhosts::OwnAt(const std::array<int, 3>& voxel) const
{
  std::array<int, 3> own = voxel;
  for (int axis = 0; axis < 3; ++axis)
  {
    own[axis] += this->Box.first[axis] - this->Of.Own().first[axis];
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

std::vector<float> BlockWithGhosts::TakeOwn(const std::vector<float>& held, int parts) const
{
  const std::array<int, 3>& n = this->OfBlock.grid.size;
  std::vector<float> own(parts * this->OfBlock.Stride(), 0.0f);
  for (int part = 0; part < parts; ++part)
  {
    for (int row = 0; row < n[1] * n[2]; ++row)
    {
      const std::size_t first = static_cast<std::size_t>(row) * n[0];
      std::copy_n(held.begin() + static_cast<std::ptrdiff_t>(part * this->OfBox.Stride() + this->PlaceOf(first)), n[0],
        own.begin() + static_cast<std::ptrdiff_t>(part * this->OfBlock.Stride() + first));
    }
  }
  return own;
}

void BlockWithGhosts::FillGhosts(Buffer<float>& ofVoxels) const
{
  std::vector<float> values;
  this->Of.Collective([&] { values = this->HasGhosts() ? ofVoxels.Read() : values; });
  this->Ghosts->Fill(values.data(), 1, 0);
  this->Of.Collective([&] {
    if (this->HasGhosts())
    {
      ofVoxels.Write(values.data());
    }
  });
}

GhostedBuffer::GhostedBuffer(
  Device& device, const BlockWithGhosts& block, const Buffer<float>& own, int parts, const char* what)
  : Block(&block)
  , Own(&own)
  , Parts(parts)
{
  block.TheDomain().Collective([&] {
    if (block.HasGhosts())
    {
      this->Held = Buffer<float>(device, parts * block.WithGhosts().Stride() + SweepPadding, what);
      this->Held.Fill(0.0f);
    }
  });
}

void GhostedBuffer::Fill()
{
  const bool has = this->Held.Size() > 0;
  std::vector<float> values;
  this->Block->TheDomain().Collective(
    [&] { values = has ? this->Block->Placed(this->Own->Read(), this->Parts, 0.0f) : values; });
  this->Block->Ghosts->Fill(values.data(), this->Parts, this->Block->WithGhosts().Stride());
  this->Block->TheDomain().Collective([&] {
    if (has)
    {
      this->Held.Write(values.data());
    }
  });
}

void GhostedBuffer::FillOwn(float elsewhere)
{
  this->Block->TheDomain().Collective([&] {
    if (this->Held.Size() > 0)
    {
      this->Held.Write(this->Block->Placed(this->Own->Read(), this->Parts, elsewhere).data());
    }
  });
}

void GhostedBuffer::TakeOwn()
{
  this->Block->TheDomain().Collective([&] {
    if (this->Held.Size() > 0)
    {
      const std::vector<float> values = this->Block->TakeOwn(this->Held.Read(), this->Parts);
      this->Target->Write(values.data(), values.size());
    }
  });
}
}
