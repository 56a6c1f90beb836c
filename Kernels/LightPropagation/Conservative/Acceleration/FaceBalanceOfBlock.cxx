#include "LightPropagation/Conservative/Acceleration/FaceBalanceOfBlock.h"

#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "Medium/BoxFaces.h"

#include <algorithm>

namespace tyndall
{
FaceBalanceOfBlock::FaceBalanceOfBlock(Device& device, FaceLight& faces, const BlockWithGhosts& block)
  : TheDomain(block.TheDomain())
  , Faces(faces)
  , HeldCells(block.Has() ? BoxFaceCellCount(block.WithGhosts().grid) : 0)
{
  const Grid& held = block.WithGhosts().grid;
  if (block.Has())
  {
    ForBoxFaceCells(held, [&](const BoxFaceCell& cell) {
      const std::array<int, 3> voxel = held.VoxelAt(cell.voxel);
      if (block.IsOwn(voxel)) // at its face the grid with ghost cells then ends at the box
      {
        const BoxFaceLayout layout = LayoutOfFace(faces.Box(), cell.face);
        std::size_t place = layout.first;
        for (int axis = 0; axis < 3; ++axis)
        {
          place += (block.Held().first[axis] + voxel[axis]) * layout.step[axis];
        }
        this->Cells.push_back({ cell.number, place, block.OwnAt(voxel) });
      }
    });
  }
  this->TheDomain.Collective([&] {
    this->Box.emplace(faces);
    for (int c = 0; c < faces.Channels(); ++c)
    {
      this->OfBlock.emplace_back(device, (FaceLeaves + 1) * this->HeldCells + 1, "the light at the box's faces");
      this->OfBlock.back().Fill(0.0f);
    }
  });
}

void FaceBalanceOfBlock::TakeSwept()
{
  this->TheDomain.Collective([&] {
    this->Box->TakeSwept();
    for (std::size_t c = 0; c < this->OfBlock.size(); ++c)
    {
      const std::vector<float> all = this->Box->RowsOf(static_cast<int>(c));
      std::vector<float> rows(this->OfBlock[c].Size(), 0.0f);
      for (std::size_t row = 0; row <= FaceLeaves; ++row)
      {
        for (const Cell& cell : this->Cells)
        {
          rows[row * this->HeldCells + cell.held] = all[row * this->Faces.Cells() + cell.whole];
        }
      }
      this->OfBlock[c].Write(rows.data());
    }
  });
}

void FaceBalanceOfBlock::TakeLeaving(const std::vector<bool>& lit)
{
  std::vector<double> leaves(this->Faces.Cells() * lit.size(), 0.0);
  this->TheDomain.Collective([&] {
    for (std::size_t c = 0; c < lit.size(); ++c)
    {
      const std::vector<float> rows = this->OfBlock[c].Read();
      for (const Cell& cell : this->Cells)
      {
        leaves[c * this->Faces.Cells() + cell.whole] = rows[FaceLeaves * this->HeldCells + cell.held];
      }
    }
  });
  leaves = this->TheDomain.Sum(leaves);
  for (std::size_t c = 0; c < lit.size(); ++c)
  {
    const auto begin = leaves.begin() + static_cast<std::ptrdiff_t>(c * this->Faces.Cells());
    if (lit[c])
    {
      this->Box->SetLeaving(static_cast<int>(c), { begin, begin + static_cast<std::ptrdiff_t>(this->Faces.Cells()) });
    }
  }
}

std::vector<double> FaceBalanceOfBlock::LeftByCell(const std::array<Rgb, 6>& incoming, const Medium& medium) const
{
  const std::array<double, 3>& h = this->Faces.Box().spacing;
  const double longest = *std::max_element(h.begin(), h.end());
  std::vector<double> tau(this->Faces.Cells() * this->OfBlock.size(), 0.0);
  for (std::size_t c = 0; c < this->OfBlock.size(); ++c)
  {
    for (const Cell& cell : this->Cells)
    {
      tau[c * this->Faces.Cells() + cell.whole] = longest * medium.TransportSigmaT(cell.voxel, static_cast<int>(c));
    }
  }
  return this->Box->LeftWithoutPattern(incoming, this->TheDomain.Sum(tau), !this->Faces.Reflects());
}
}
