#include "LightPropagation/Conservative/Acceleration/FaceBalance.h"

#include "LightPropagation/Diffusion/DiffusionShared.h"
#include "Medium/BoxFaces.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall
{
FaceBalance::FaceBalance(FaceLight& faces)
  : Faces(faces)
  , Cells(faces.Cells())
{
  this->LeftSwept = faces.TakeOut();
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
  if (faces.Reflects())
  {
    faces.LetIn(std::vector<double>(this->CameBack.size(), 0.0), this->GivenBackByCell);
  }
}

void FaceBalance::TakeSwept()
{
  this->LeftSwept = this->Faces.TakeOut();
  this->CameBackInSweep = this->CameBack;
}

std::vector<float> FaceBalance::RowsOf(int channel) const
{
  std::vector<float> rows((FaceLeaves + 1) * this->Cells, 0.0f);
  const std::size_t first = channel * this->Cells;
  for (std::size_t cell = 0; cell < this->Cells; ++cell)
  {
    rows[FaceCame * this->Cells + cell] = static_cast<float>(this->CameBackInSweep[first + cell]);
    rows[FaceGiven * this->Cells + cell] = static_cast<float>(this->GivenBackByCell[first + cell]);
    rows[FaceLeft * this->Cells + cell] = this->LeftSwept[first + cell];
  }
  return rows;
}

void FaceBalance::SetLeaving(int channel, const std::vector<float>& leaves)
{
  std::copy(leaves.begin(), leaves.end(), this->Leaves.begin() + static_cast<std::ptrdiff_t>(channel * this->Cells));
}

double FaceBalance::Reflect(int iteration, const Rgb& given)
{
  double change = 0.0;
  for (std::size_t c = 0; c < this->BackMixing.size(); ++c)
  {
    double differs = 0.0, all = given[c];
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
    change = std::max(change, all > 0.0 ? differs / all : 0.0);
    // Mixing helps in thin media, where the diffusion systems do not predict the path of reflected light.
    const std::vector<double> next = iteration > 0 ? this->BackMixing[c].Next(came, found) : found;
    std::copy(next.begin(), next.end(), begin);
  }
  // Powers of the diffusion systems do not have the pattern of rays.
  this->Faces.LetIn(std::vector<double>(this->CameBack.size(), 0.0), this->CameBack);
  return change;
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
  for (std::size_t i = 0; i < left.size(); ++i)
  {
    const int face = this->Faces.FaceOf(i % this->Cells), c = static_cast<int>(i / this->Cells);
    ledger.Escape(c, face, (1.0 - this->Faces.AlbedoOf(i)) * left[i] - this->LeftUncollided[i]);
  }
}

std::vector<double> FaceBalance::LeftWithoutPattern(
  const std::array<Rgb, 6>& incoming, const std::vector<double>& tau, bool spreads) const
{
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
