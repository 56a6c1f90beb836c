#pragma once

#include "Device/Buffer.h"
#include "Device/Device.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/UpwindSweep.h"
#include "Medium/Grid.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
constexpr int AllFaces = 0x3f; ///< bits of the faces -x, +x, ... +z

/// Bits of the faces -x, +x, ... +z of this rank's block that are no faces of the grid; of a rank without voxels all.
int InnerFacesOf(const OrdinatesRanks& ranks);

/// Cells of a block's faces as its own rank sees them, and those of the whole grid's faces, which all ranks know.
class CellsOfBlock
{
public:
  /// @param own  the block's grid, or one voxel where it has none
  /// @param ofWhole  must stay
  CellsOfBlock(Device& device, const OrdinatesRanks& ranks, const Grid& own, const std::array<bool, 3>& periodic,
    const LightOfCells& ofWhole);
  CellsOfBlock(const CellsOfBlock&) = delete;
  CellsOfBlock& operator=(const CellsOfBlock&) = delete;

  const LightOfCells& Seen() const { return this->OfBlock; }
  /// What comes in through cells of the whole grid, to those of the block.
  void LetIn();
  /// What leaves through those of the blocks of all ranks, to those of the whole grid. All ranks call it.
  /// @param leave  adds to Seen().out, which is empty
  void LetOut(const std::function<void()>& leave);

private:
  Device& TheDevice;
  const OrdinatesRanks& Ranks;
  const LightOfCells& OfWhole;
  Buffer<float> Out, In;
  const LightOfCells OfBlock;
  std::vector<std::array<std::size_t, 2>> Places; ///< here, and there
};
}
