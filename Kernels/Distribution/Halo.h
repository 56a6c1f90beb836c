#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/Field.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace tyndall
{
/// Exchange of ghost cells: each cell of a grid is owned by one rank, and other ranks have copies of its value.
class GhostCells
{
public:
  /// Determines the cells that this rank exchanges with each rank.
  /// @param communicator  must outlive this object
  /// @param own  by rank, the box of cells that the rank owns; boxes are disjoint and may be empty
  /// @param ghosts  by rank, boxes of the rank's ghost cells; cells within the grid that the rank owns itself are left
  ///   out
  /// @param held  a box that contains this rank's own cells and its ghost cells; arrays cover it, x fastest
  /// @param gridSize  cells along each axis. Ghost cells beyond an end of the grid wrap around; all cells of a box wrap
  ///   by the same number of periods. They may be images of the rank's own cells. If all sizes are 0, no ghost cells
  ///   lie beyond the grid
  GhostCells(Communicator& communicator, const std::vector<VoxelBox>& own,
    const std::vector<std::vector<VoxelBox>>& ghosts, const VoxelBox& held,
    const std::array<int, 3>& gridSize = { 0, 0, 0 });

  /// Copies values from the ranks that own the cells to this rank's ghost cells. Collective, with the same number of
  /// arrays on all ranks.
  /// @param values  `arrays` arrays over the box `held`, `stride` values apart, each with `components` values per cell
  template <class Value>
  void Fill(Value* values, int arrays, std::size_t stride, std::size_t components = 1) const;
  void Fill(std::vector<double>& values) const { this->Fill(values.data(), 1, 0); }
  /// Copies values from the ranks that own the cells to this rank's ghost cells. Collective.
  /// @param values  one array over the box `held`, `components` values per cell
  void FillComponents(std::vector<float>& values, int components) const
  {
    this->Fill(values.data(), 1, 0, static_cast<std::size_t>(components));
  }

  /// Indices, in arrays over the box `held`, of this rank's own cells that are ghost cells of other ranks; a cell is
  /// listed once for each of these ranks.
  std::vector<std::size_t> OwnedPlaces() const { return PlacesOf(this->Owned); }
  /// Indices, in arrays over the box `held`, of this rank's ghost cells.
  std::vector<std::size_t> CopiedPlaces() const { return PlacesOf(this->Copied); }
  /// Exchanges values that are not stored in arrays over the box `held`. Collective.
  /// @param owned  values at OwnedPlaces(), ordered by the rank that has the copies, and for each rank array after
  ///   array
  /// @return values at CopiedPlaces(), ordered by the rank that owns the cells, and for each rank array after array
  template <class Value>
  std::vector<Value> Exchange(const std::vector<Value>& owned, int arrays = 1) const;

  /// Adds the values of all ranks' ghost cells to the owners' values, in rank order. Collective.
  template <class Value>
  void AddToOwners(std::vector<Value>& values) const;

private:
  /// Cells whose values this rank exchanges with one rank, which may be itself.
  struct Shared
  {
    int rank;
    std::vector<std::size_t> places; ///< indices of the cells in arrays over the box `held`
  };
  static std::vector<std::size_t> PlacesOf(const std::vector<Shared>& shared);

  Communicator& Comm;
  std::vector<Shared> Owned;  ///< by rank, the own cells that are ghost cells of that rank
  std::vector<Shared> Copied; ///< by rank, the ghost cells of this rank whose owner is that rank
};

/// A rank's block with `layers` layers of ghost voxels around it, and the exchange of their values. The halo is clipped
/// at the ends of the grid, but wraps around along a periodic axis. Ghost voxels may then be images of the block's own
/// voxels.
class Halo
{
public:
  Halo(Communicator& communicator, const BlockPartition& partition, const std::array<bool, 3>& periodic, int layers);

  /// The block (Own) and the block with its halo (Known), in voxels of the whole grid; the halo may reach beyond the
  /// grid's ends. Empty if the block is empty.
  const VoxelBox& Own() const { return this->OwnBox; }
  const VoxelBox& Known() const { return this->Box; }
  Grid KnownGrid() const; ///< grid of Known(); without voxels if the block is empty
  const std::array<bool, 3>& Periodic() const { return this->Around; }
  const Grid& Whole() const { return this->All; }

  /// Copies the values of all ranks' own voxels to the halos in which these voxels lie. Collective.
  /// @param own  values of the own voxels, `components` per voxel, x fastest
  /// @return values of the block with its halo, `components` per voxel, x fastest
  std::vector<float> Spread(const std::vector<float>& own, int components) const;
  /// Copies the values of a field to halos. Collective.
  /// @param own     values of the own voxels
  /// @param values  receives the values of the block with its halo, to which the result refers
  /// @return the field on the block with its halo; `own` if it has no values
  Field Spread(const Field& own, std::vector<float>& values) const;
  /// Transpose of Spread: sums, for each own voxel, the values of all ranks that have the voxel in their block or halo.
  /// The values are integers, so that the sum does not depend on the order of ranks. Collective.
  /// @param known  values of the block with its halo
  std::vector<std::int64_t> Gather(std::vector<std::int64_t> known) const;

private:
  Grid All;
  std::array<bool, 3> Around; ///< whether each axis is periodic
  VoxelBox OwnBox, Box;
  std::optional<GhostCells> Ghosts;
};

/// Periodic axes along which a block spans the whole grid. The block is then its own neighbour across the ends of the
/// axis.
std::array<bool, 3> GoesRoundAlone(
  const VoxelBox& own, const std::array<int, 3>& gridSize, const std::array<bool, 3>& periodic);

/// Layers of cells, one cell thick, beyond the faces of a block, each as a box. A layer beyond an end of the grid
/// exists only if the axis is periodic and the block does not span all of it; the layer then wraps around. An empty
/// block has no layers.
std::vector<VoxelBox> LayersBeside(
  const VoxelBox& own, const std::array<int, 3>& gridSize, const std::array<bool, 3>& periodic = {});

/// The smallest box that contains `own` and `others`.
VoxelBox Hull(const VoxelBox& own, const std::vector<VoxelBox>& others);
}
