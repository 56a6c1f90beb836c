#include "DiscreteOrdinates/OrdinatesScene.h"

#include "Medium/BoxFaces.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
std::unique_ptr<FaceLight> FaceLightOf(Device& device, const OrdinatesScene& scene, const OrdinateGroups& groups)
{
  if (std::all_of(scene.faceAlbedo.begin(), scene.faceAlbedo.end(), IsBlack))
  {
    return nullptr;
  }
  const Grid& grid = scene.medium.grid;
  std::array<double, 6> powerIn = {};
  for (int g = 0; g < groups.Count(); ++g)
  {
    for (int lane = 0; lane < OrdinateLanes; ++lane)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        powerIn[EntryFace(axis, groups.All()[g].up[axis])] +=
          groups.Weight(g, lane) * std::abs(groups.Of(g, lane).omega[axis]) * grid.VoxelVolume() / grid.spacing[axis];
      }
    }
  }
  std::vector<double> ofCells;
  ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) { ofCells.push_back(powerIn[cell.face]); });
  return std::make_unique<FaceLight>(device, grid, 1, std::move(ofCells), scene.faceAlbedo);
}

SweepTally OrdinatesRanks::OfOneThatHas(const SweepTally& tally) const
{
  const std::vector<VoxelBox>& blocks = this->partition.blocks;
  const auto has = [](const VoxelBox& block) { return block.VoxelCount() > 0; };
  const bool isFirst = std::find_if(blocks.begin(), blocks.end(), has) - blocks.begin() == this->others.Rank();
  std::vector<double> values(39, 0.0); // in, out and onTheWay, three channels each
  const auto forEach = [&values](auto& of, const auto& act) {
    std::size_t next = 0;
    for (std::size_t c = 0; c < 3; ++c)
    {
      for (std::size_t face = 0; face < 6; ++face)
      {
        act(values[next++], of.in[face][c]);
        act(values[next++], of.out[face][c]);
      }
      act(values[next++], of.onTheWay[c]);
    }
  };
  if (isFirst)
  {
    forEach(tally, [](double& value, double of) { value = of; });
  }
  values = this->others.Sum(values);
  SweepTally found;
  forEach(found, [](double value, double& of) { of = value; });
  return found;
}

void OrdinatesRecord::Add(double goesOn, double more, const EnergyLedger& ledger)
{
  const EnergyBalance& balance = ledger.Balance();
  this->Sum += more;
  this->Left = goesOn > 0.0 ? this->Rest.After(goesOn, this->Sum) : 0.0;
  this->Rows.push_back({ static_cast<int>(this->Rows.size()), ClockSeconds() - this->Start, this->Left,
    this->Sum > 0.0 ? goesOn / this->Sum : 0.0, balance.absorbed[0], balance.escaped[0], balance.leftOver[0] });
}
}
