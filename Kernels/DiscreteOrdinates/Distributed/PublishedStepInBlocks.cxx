#include "DiscreteOrdinates/Distributed/PublishedStepInBlocks.h"

#include "DiscreteOrdinates/AngularScattering.h"
#include "Distribution/SharedMedium.h"

#include <algorithm>
#include <iterator>

namespace tyndall
{
PublishedStepInBlocks::PublishedStepInBlocks(Device& device, const OrdinatesRanks& ranks, const Grid& grid,
  const OrdinateGroups& groups, const std::array<bool, 3>& periodic, const IncomingRadiance& incoming,
  const LightOfCells* reflecting)
  : TheDevice(device)
  , Ranks(ranks)
  , TheGrid(grid)
  , Groups(groups)
  , Around(ranks.others, ranks.partition, periodic, 1)
  , Step(device, grid, groups, incoming, this->FacesOfBlock(periodic, reflecting))
  , Known(device, ranks.Has() ? AngularScattering::Floats(groups, this->Around.Known().VoxelCount()) : 0,
      "radiance of all directions round the block")
{
}

std::size_t PublishedStepInBlocks::Floats(const Grid& grid, const OrdinateGroups& groups)
{
  Grid around = grid;
  std::for_each(around.size.begin(), around.size.end(), [](int& size) { size += 2; });
  return AngularScattering::Floats(groups, around.VoxelCount());
}

/// Of a rank without voxels what comes in from outside is all round its one voxel, and counts nowhere.
SteppedFaces PublishedStepInBlocks::FacesOfBlock(const std::array<bool, 3>& periodic, const LightOfCells* reflecting)
{
  const int inner = InnerFacesOf(this->Ranks);
  SteppedFaces faces = SteppedFaces::Of(this->TheGrid, periodic, nullptr);
  faces.whole = this->Ranks.partition.whole;
  faces.counted &= ~inner;
  if (this->Ranks.Has())
  {
    faces.outside &= ~inner;
    faces.known = this->Around.Known();
    for (int axis = 0; axis < 3; ++axis)
    {
      faces.known.first[axis] -= this->Around.Own().first[axis];
    }
  }
  else
  {
    faces.outside = AllFaces;
  }
  if (reflecting)
  {
    this->Cells.emplace(this->TheDevice, this->Ranks, this->TheGrid, periodic, *reflecting);
    faces.reflecting = &this->Cells->Seen();
  }
  return faces;
}

/// Of own voxels, and of those next to them.
void PublishedStepInBlocks::SpreadToKnown(const Buffer<float>& radiance)
{
  const std::size_t voxels = this->Ranks.Has() ? this->TheGrid.VoxelCount() : 0;
  const std::size_t own = OrdinateStride(voxels) * OrdinateLanes;
  const std::size_t known = OrdinateStride(this->Around.Known().VoxelCount()) * OrdinateLanes;
  std::vector<float> values, all, ofGroup;
  this->Ranks.others.Collective([&] {
    values = this->Ranks.Has() ? radiance.Read() : values;
    all.resize(this->Known.Size());
  });
  for (std::size_t g = 0; g < static_cast<std::size_t>(this->Groups.Count()); ++g)
  {
    this->Ranks.others.Collective([&] {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(voxels > 0 ? g * own : 0);
      ofGroup.assign(first, first + static_cast<std::ptrdiff_t>(voxels * OrdinateLanes));
    });
    const std::vector<float> spread = this->Around.Spread(ofGroup, OrdinateLanes);
    std::copy(spread.begin(), spread.end(), all.begin() + static_cast<std::ptrdiff_t>(voxels > 0 ? g * known : 0));
  }
  this->Ranks.others.Collective([&] { this->Known.Write(all.data()); });
}

void PublishedStepInBlocks::Apply(const Buffer<float>& radiance, const Buffer<float>& scattered,
  const Buffer<float>& steady, const Buffer<float>& sigma_t, const Buffer<float>& after)
{
  this->Ranks.others.Collective([&] {
    if (this->Cells)
    {
      this->Cells->LetIn();
    }
    this->Step.Change(radiance, scattered, steady, sigma_t);
  });
  this->SpreadToKnown(radiance);
  this->Ranks.others.Collective([&] { this->Step.MoveOn(this->Ranks.Has() ? this->Known : radiance, after); });
}

FacePowers PublishedStepInBlocks::Powers(const Buffer<float>& radiance) const
{
  FacePowers powers;
  this->Ranks.others.Collective([&] { powers = this->Step.Powers(radiance); });
  // What comes in all know, but ranks without voxels.
  const bool counts = IsFirstThatHas(this->Ranks.others, this->Ranks.partition);
  std::vector<double> sums(powers.out.begin(), powers.out.end());
  std::transform(powers.in.begin(), powers.in.end(), std::back_inserter(sums),
    [counts](double power) { return counts ? power : 0.0; });
  sums = this->Ranks.others.Sum(sums);
  std::copy_n(sums.begin(), 6, powers.out.begin());
  std::copy_n(sums.begin() + 6, 6, powers.in.begin());
  return powers;
}

void PublishedStepInBlocks::LeaveByCells(const Buffer<float>& radiance)
{
  this->Cells->LetOut([&] { this->Step.LeaveByCells(radiance); });
}
}
