#include "LightPropagation/Conservative/Acceleration/FaceBalance.h"

#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "Medium/BoxFaces.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
FaceBalance::FaceBalance(Device& device, FaceLight& faces, const BlockWithGhosts& block)
  : TheDomain(block.TheDomain())
  , Faces(faces)
  , Cells(faces.Cells())
  , HeldCells(block.Has() ? BoxFaceCellCount(block.WithGhosts().grid) : 0)
{
  this->FindOwnCells(block);
  this->TheDomain.Collective([&] {
    this->LeftSwept = faces.TakeOut();
    for (int c = 0; c < faces.Channels(); ++c)
    {
      this->OfBlock.emplace_back(device, (FaceLeaves + 1) * this->HeldCells + 1, "the light at the box's faces");
      this->OfBlock.back().Fill(0.0f);
    }
  });
  this->LeftUncollided.assign(this->LeftSwept.begin(), this->LeftSwept.end());
  for (std::size_t i = 0; i < this->LeftSwept.size(); ++i)
  {
    this->GivenBackByCell.push_back(faces.AlbedoOf(i) * this->LeftSwept[i]);
    this->PowerGivenBack[i / this->Cells] += this->GivenBackByCell.back();
  }
  this->CameBack = this->GivenBackByCell;
  this->CameBackInSweep = this->CameBack;
  this->Leaves.assign(this->CameBack.size(), 0.0);
  this->BackMixing.resize(faces.Channels());
  this->TheDomain.Collective([&] {
    if (faces.Reflects())
    {
      faces.LetIn(this->Leaves, this->GivenBackByCell);
    }
  });
}

void FaceBalance::FindOwnCells(const BlockWithGhosts& block)
{
  if (!block.Has())
  {
    return;
  }
  const Grid& held = block.WithGhosts().grid;
  ForBoxFaceCells(held, [&](const BoxFaceCell& cell) {
    const std::array<int, 3> voxel = held.VoxelAt(cell.voxel);
    if (block.IsOwn(voxel)) // a face of the block with its ghost cells is a face of the box only at an own voxel
    {
      const std::size_t place = LayoutOfFace(this->Faces.Box(), cell.face).CellAt(block.Held().VoxelAt(cell.voxel));
      this->OwnCells.push_back({ cell.number, place, block.OwnAt(voxel) });
    }
  });
}

void FaceBalance::TakeSwept()
{
  this->TheDomain.Collective([&] {
    this->LeftSwept = this->Faces.TakeOut();
    this->CameBackInSweep = this->CameBack;
    for (std::size_t c = 0; c < this->OfBlock.size(); ++c)
    {
      this->OfBlock[c].Write(this->RowsOf(c).data());
    }
  });
}

std::vector<float> FaceBalance::RowsOf(std::size_t channel) const
{
  std::vector<float> rows(this->OfBlock[channel].Size(), 0.0f);
  for (const OwnCell& cell : this->OwnCells)
  {
    const std::size_t i = channel * this->Cells + cell.whole;
    rows[FaceCame * this->HeldCells + cell.held] = static_cast<float>(this->CameBackInSweep[i]);
    rows[FaceGiven * this->HeldCells + cell.held] = static_cast<float>(this->GivenBackByCell[i]);
    rows[FaceLeft * this->HeldCells + cell.held] = this->LeftSwept[i];
  }
  return rows;
}

void FaceBalance::TakeLeaving(const std::vector<bool>& lit)
{
  std::vector<double> leaves(this->Cells * lit.size(), 0.0);
  this->TheDomain.Collective([&] {
    for (std::size_t c = 0; c < lit.size(); ++c)
    {
      const std::vector<float> rows = this->OfBlock[c].Read();
      for (const OwnCell& cell : this->OwnCells)
      {
        leaves[c * this->Cells + cell.whole] = rows[FaceLeaves * this->HeldCells + cell.held];
      }
    }
  });
  leaves = this->TheDomain.Sum(leaves);
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    this->Leaves[i] = lit[i / this->Cells] ? leaves[i] : this->Leaves[i];
  }
}

double FaceBalance::Reflect(int iteration, const Rgb& given)
{
  double change = 0.0;
  this->TheDomain.Collective([&] {
    for (std::size_t c = 0; c < this->BackMixing.size(); ++c)
    {
      change = std::max(change, this->ReflectChannel(iteration, c, given[c]));
    }
    // The power that a sweep carries through a cell varies with the number of rays, for which LetIn() corrects its
    // first argument. The power of the diffusion solution does not vary in this way; it is the second argument.
    this->Faces.LetIn(std::vector<double>(this->CameBack.size(), 0.0), this->CameBack);
  });
  return this->TheDomain.Max(change); // maximum over ranks, whose devices may round differently
}

double FaceBalance::ReflectChannel(int iteration, std::size_t c, double given)
{
  double differs = 0.0, all = given;
  const auto begin = this->CameBack.begin() + static_cast<std::ptrdiff_t>(c * this->Cells);
  const std::vector<double> came(begin, begin + static_cast<std::ptrdiff_t>(this->Cells));
  std::vector<double> found(this->Cells);
  for (std::size_t cell = 0; cell < this->Cells; ++cell)
  {
    const std::size_t i = c * this->Cells + cell;
    found[cell] = this->GivenBackByCell[i] + this->Faces.AlbedoOf(i) * std::max(this->Leaves[i], 0.0);
    differs += std::abs(found[cell] - came[cell]);
    all += found[cell];
  }
  // Mixing accelerates convergence in thin media, where the diffusion systems do not predict how reflected light is
  // transported.
  if (iteration > 0)
  {
    found = this->BackMixing[c].Next(came, found);
  }
  std::copy(found.begin(), found.end(), begin);
  return all > 0.0 ? differs / all : 0.0;
}

std::vector<double> FaceBalance::Left() const
{
  std::vector<double> left = this->LeftUncollided;
  for (std::size_t i = 0; i < left.size(); ++i)
  {
    left[i] += this->Leaves[i];
  }
  return left;
}

void FaceBalance::Count(EnergyLedger& ledger) const
{
  const std::vector<double> left = this->Left();
  std::array<Rgb, 6> all = {}, uncollided = {};
  for (std::size_t i = 0; i < left.size(); ++i)
  {
    const int face = this->Faces.FaceOf(i % this->Cells);
    all[face][i / this->Cells] += (1.0 - this->Faces.AlbedoOf(i)) * left[i];
    uncollided[face][i / this->Cells] += this->LeftUncollided[i];
  }
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < this->Faces.Channels(); ++c)
    {
      // The diffusion solution's outgoing power may be slightly negative where there is almost no light.
      ledger.Escape(c, face, std::max(all[face][c], 0.0) - uncollided[face][c]);
    }
  }
}

/// Optical thickness, along its longest edge, of the voxel at each cell of the box faces, [channel][cell].
std::vector<double> FaceBalance::OpticalLengths(const Medium& medium) const
{
  const std::array<double, 3>& h = this->Faces.Box().spacing;
  const double longest = *std::max_element(h.begin(), h.end());
  std::vector<double> tau(this->Leaves.size(), 0.0);
  for (std::size_t c = 0; c < this->OfBlock.size(); ++c)
  {
    for (const OwnCell& cell : this->OwnCells)
    {
      tau[c * this->Cells + cell.whole] = longest * medium.TransportSigmaT(cell.voxel, static_cast<int>(c));
    }
  }
  return this->TheDomain.Sum(tau);
}

std::vector<double> FaceBalance::LeftWithoutPattern(const std::array<Rgb, 6>& incoming, const Medium& medium) const
{
  // Whether rays spread their power over neighbouring cells (Deposit::spreadsAside).
  const bool spreads = !this->Faces.Reflects();
  const std::vector<double> tau = this->OpticalLengths(medium);
  const Grid& grid = this->Faces.Box();
  const std::vector<double> left = this->Left();
  std::vector<double> smooth = left;
  for (std::size_t i = 0; i < left.size(); ++i)
  {
    const std::size_t c = i / this->Cells, cell = i % this->Cells;
    const int face = this->Faces.FaceOf(cell);
    const double area = grid.VoxelVolume() / grid.spacing[face / 2];
    const double in = static_cast<float>(this->CameBackInSweep[i]) + incoming[face][c] * area;
    const double pattern = this->Faces.Pattern(cell), swept = this->LeftSwept[i];
    const double change = spreads ? swept / pattern - this->Leaves[i] : (1.0 / pattern - 1.0) * (swept - pattern * in);
    smooth[i] = std::max(smooth[i] + change / (1.0 + 0.25 * tau[i] * tau[i]), 0.0);
  }
  return this->Faces.ScaledTo(std::move(smooth), left);
}
}
