#pragma once

#include "Distribution/Communicator.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Exchange of ghost cells: each cell of a grid is owned by one rank, and other ranks hold copies of its value.
class GhostCells
{
public:
  /// @param communicator  must outlive this
  /// @param own  the box that each rank owns, disjoint; a box may be empty
  /// @param ghosts  the boxes of each rank's ghost cells, which other ranks own
  /// @param held  a box that contains this rank's own cells and its ghost cells; arrays cover it, x fastest
  /// @param gridSize  cells along each axis; ghost cells beyond an end of the grid wrap around. Zeros: no ghost cells
  ///   lie beyond the grid
  GhostCells(Communicator& communicator, const std::vector<VoxelBox>& own,
    const std::vector<std::vector<VoxelBox>>& ghosts, const VoxelBox& held,
    const std::array<int, 3>& gridSize = { 0, 0, 0 });

  /// Copies the owners' values to the ghost cells. Collective, with the same number of arrays on all ranks.
  /// @param values  `arrays` arrays over the held box, `stride` values apart
  template <class Value>
  void Fill(Value* values, int arrays, std::size_t stride) const;

  // The same for arrays that are kept elsewhere.

  std::vector<std::size_t> OwnedPlaces() const
  {
    return PlacesOf(this->Owned);
  } ///< indices of own cells, once for each rank that has copies
  std::vector<std::size_t> CopiedPlaces() const
  {
    return PlacesOf(this->Copied);
  } ///< indices of this rank's ghost cells
  /// @param owned  values at OwnedPlaces(); of several arrays one after the other for each rank that has copies
  /// @return values at CopiedPlaces(), in the same order by owner. Collective
  template <class Value>
  std::vector<Value> Exchange(const std::vector<Value>& owned, int arrays = 1) const;

private:
  /// The cells exchanged with one other rank.
  struct Shared
  {
    int rank;
    std::vector<std::size_t> places; ///< indices into arrays over the held box
  };
  static std::vector<std::size_t> PlacesOf(const std::vector<Shared>& shared);

  Communicator& Comm;
  std::vector<Shared> Owned;  ///< own cells that are ghost cells of another rank
  std::vector<Shared> Copied; ///< ghost cells of this rank, by their owner
};

/// The periodic axes along which the box spans the whole grid, so that it is its own neighbour.
std::array<bool, 3> GoesRoundAlone(
  const VoxelBox& own, const std::array<int, 3>& gridSize, const std::array<bool, 3>& periodic);

/// The layers of cells, one cell thick, beyond the faces of a box: within the grid, and across the ends of periodic
/// axes unless the box is its own neighbour there. None for an empty box.
std::vector<VoxelBox> LayersBeside(
  const VoxelBox& own, const std::array<int, 3>& gridSize, const std::array<bool, 3>& periodic = {});

/// The smallest box that contains `own` and `others`.
VoxelBox Hull(const VoxelBox& own, const std::vector<VoxelBox>& others);
}
