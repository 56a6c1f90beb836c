#pragma once

#include "Distribution/Communicator.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Values of a grid's cells each of which one rank owns, and of which others hold copies: ghosts.
class GhostCells
{
public:
  /// @param communicator  must stay
  /// @param own  the box of each rank, none with a cell in common; may be empty
  /// @param ghosts  the boxes of each rank's ghosts, cells that others own
  /// @param held  a box that has this rank's own cells and its ghosts: arrays are over it, x fastest
  /// @param gridSize  ghosts beyond the grid's ends are the cells of its other side; none are without it
  GhostCells(Communicator& communicator, const std::vector<VoxelBox>& own,
    const std::vector<std::vector<VoxelBox>>& ghosts, const VoxelBox& held,
    const std::array<int, 3>& gridSize = { 0, 0, 0 });

  /// Ghosts from those who own them. All ranks call these together, of as many values.
  /// @param values  of several arrays over the box, one after the other, `stride` apart
  void Fill(std::vector<double>& values) const { this->Exchange(values.data(), 1, 0); }
  void Fill(float* values, int arrays, std::size_t stride) const { this->Exchange(values, arrays, stride); }

  /// Adds what this rank has in its ghosts to the owners' values, rank by rank.
  void AddToOwners(std::vector<double>& values) const;

private:
  /// What goes between this rank and another.
  struct Shared
  {
    int rank;
    std::vector<std::size_t> places; ///< in the box
  };
  template <class Value>
  void Exchange(Value* values, int arrays, std::size_t stride) const;

  Communicator& Comm;
  std::vector<Shared> Owned;  ///< of this rank's own cells, those that are ghosts of another
  std::vector<Shared> Copied; ///< of this rank's ghosts, those that another owns
};

/// The periodic axes that a box of a grid has from end to end: what lies beyond its faces there is itself.
std::array<bool, 3> GoesRoundAlone(
  const VoxelBox& own, const std::array<int, 3>& gridSize, const std::array<bool, 3>& periodic);

/// Of a box of a grid the layers of cells beyond its faces, as far as the grid goes, and across the ends of a periodic
/// axis, but where the box goes round alone; none of an empty box.
std::vector<VoxelBox> LayersBeside(
  const VoxelBox& own, const std::array<int, 3>& gridSize, const std::array<bool, 3>& periodic = {});

/// The box and these, in one.
VoxelBox Hull(const VoxelBox& own, const std::vector<VoxelBox>& others);
}
