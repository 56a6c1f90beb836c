#include "DiscreteOrdinates/OrdinatesScene.h"

#include "Distribution/SharedMedium.h"
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
  const Grid& grid = scene.domain.Whole();
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

std::optional<LightOfCells> CellsOf(const FaceLight* faces)
{
  return faces ? std::optional<LightOfCells>({ faces->Out(), faces->In() }) : std::nullopt;
}

SweepTally SumOf(const Domain& domain, const SweepTally& own)
{
  SweepTally sum = own;
  std::vector<Rgb*> powers = { &sum.onTheWay };
  for (std::size_t face = 0; face < 6; ++face)
  {
    powers.push_back(&sum.in[face]);
    powers.push_back(&sum.out[face]);
  }
  SumOverRanks(domain, powers);
  return sum;
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
