#pragma once

#include "DiscreteOrdinates/Distributed/CellsOfBlock.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/Published/PublishedStep.h"
#include "Distribution/Halo.h"

#include <optional>
#include <vector>

namespace tyndall
{
/// The step of a grid whose blocks lie on several ranks: before light goes from voxel to voxel each rank gets the
/// radiance of the voxels next to its block, past the ends of periodic axes too. The same radiance bit for bit. Cells
/// of the grid's faces that give back light are known on all ranks.
class PublishedStepInBlocks : public OrdinateStep
{
public:
  /// All of it must stay.
  /// @param grid  of this rank's block, or of one voxel where it has none: that is stepped alone
  /// @param reflecting  of the whole grid; null: no face gives back light
  PublishedStepInBlocks(Device& device, const OrdinatesRanks& ranks, const Grid& grid, const OrdinateGroups& groups,
    const std::array<bool, 3>& periodic, const IncomingRadiance& incoming, const LightOfCells* reflecting);

  /// Floats of the radiance that a rank has besides its own, for a block of so many voxels.
  static std::size_t Floats(const Grid& grid, const OrdinateGroups& groups);

  // All ranks call these together, and get what is of all.
  void Apply(const Buffer<float>& radiance, const Buffer<float>& scattered, const Buffer<float>& steady,
    const Buffer<float>& sigma_t, const Buffer<float>& after) override;
  FacePowers Powers(const Buffer<float>& radiance) const override;
  void LeaveByCells(const Buffer<float>& radiance) override;

private:
  SteppedFaces FacesOfBlock(const std::array<bool, 3>& periodic, const LightOfCells* reflecting);
  void SpreadToKnown(const Buffer<float>& radiance);

  Device& TheDevice;
  const OrdinatesRanks& Ranks;
  const Grid TheGrid;
  const OrdinateGroups& Groups;
  const Halo Around;
  std::optional<CellsOfBlock> Cells; ///< where faces give back light
  PublishedStep Step;
  Buffer<float> Known; ///< radiance of all known voxels; empty where there are no own ones
};
}
