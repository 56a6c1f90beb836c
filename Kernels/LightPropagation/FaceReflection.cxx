#include "LightPropagation/FaceReflection.h"

#include "Medium/BoxFaces.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
FaceReflection::FaceReflection(
  const Grid& grid, int channels, std::vector<double> powerIn, const std::array<Rgb, 6>& albedo)
  : TheGrid(grid)
  , ChannelCount(channels)
  , AlbedoOfFaces(albedo)
  , AnyAlbedo(!std::all_of(albedo.begin(), albedo.end(), IsBlack))
{
  ForBoxFaceCells(grid, [this](const BoxFaceCell& cell) { this->FaceOfCell.push_back(cell.face); });
  this->SetPowerIn(std::move(powerIn));
}

void FaceReflection::SetPowerIn(std::vector<double> powerIn)
{
  this->PowerIn = std::move(powerIn);
  this->MeanIn.clear();
  std::array<double, 6> sum = {}, count = {};
  for (std::size_t cell = 0; cell < this->Cells(); ++cell)
  {
    sum[this->FaceOf(cell)] += this->PowerIn[cell];
    count[this->FaceOf(cell)] += 1.0;
  }
  for (int face : this->FaceOfCell)
  {
    this->MeanIn.push_back(sum[face] / count[face]);
  }
}

std::vector<float> FaceReflection::RadianceOf(
  const std::vector<double>& swept, const std::vector<double>& uncollided) const
{
  std::vector<double> brought(swept.size()); // W of uncollided light, in the pattern of the rays
  for (std::size_t i = 0; i < swept.size(); ++i)
  {
    const std::size_t cell = i % this->Cells();
    brought[i] = this->MeanIn[cell] > 0.0 ? uncollided[i] * this->PowerIn[cell] / this->MeanIn[cell] : 0.0;
  }
  const std::array<Rgb, 6> is = this->PowerOfFaces(brought), shouldBe = this->PowerOfFaces(uncollided);
  std::vector<float> radiance(swept.size());
  for (std::size_t i = 0; i < swept.size(); ++i)
  {
    const std::size_t cell = i % this->Cells(), c = i / this->Cells();
    const int face = this->FaceOf(cell);
    const double part = is[face][c] > 0.0 ? shouldBe[face][c] / is[face][c] : 0.0;
    radiance[i] =
      static_cast<float>(this->PowerIn[cell] > 0.0 ? (swept[i] + part * brought[i]) / this->PowerIn[cell] : 0.0);
  }
  return radiance;
}

std::array<Rgb, 6> FaceReflection::PowerOfFaces(const std::vector<double>& power) const
{
  std::array<Rgb, 6> sums = {};
  for (std::size_t i = 0; i < power.size(); ++i)
  {
    sums[this->FaceOf(i % this->Cells())][i / this->Cells()] += power[i];
  }
  return sums;
}

double FaceReflection::Pattern(std::size_t cell) const
{
  return this->PowerIn[cell] > 0.0 ? this->PowerIn[cell] / this->MeanIn[cell] : 1.0;
}

std::vector<double> FaceReflection::ScaledTo(std::vector<double> power, const std::vector<double>& sums) const
{
  return this->ScaledTo(std::move(power), this->PowerOfFaces(sums));
}

std::vector<double> FaceReflection::ScaledTo(std::vector<double> power, const std::array<Rgb, 6>& shouldBe) const
{
  const std::array<Rgb, 6> is = this->PowerOfFaces(power);
  for (std::size_t i = 0; i < power.size(); ++i)
  {
    const int face = this->FaceOf(i % this->Cells());
    const std::size_t c = i / this->Cells();
    power[i] *= is[face][c] > 0.0 ? shouldBe[face][c] / is[face][c] : 1.0;
  }
  return power;
}

std::vector<float> FaceReflection::PerArea(const std::vector<double>& power) const
{
  std::vector<float> perArea(power.size());
  for (std::size_t i = 0; i < power.size(); ++i)
  {
    const std::size_t cell = i / this->ChannelCount, c = i % this->ChannelCount;
    const double area = this->TheGrid.VoxelVolume() / this->TheGrid.spacing[this->FaceOf(cell) / 2];
    perArea[i] = static_cast<float>(power[c * this->Cells() + cell] / area);
  }
  return perArea;
}
}
