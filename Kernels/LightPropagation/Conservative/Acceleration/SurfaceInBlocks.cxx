#include "LightPropagation/Conservative/Acceleration/SurfaceInBlocks.h"

#include "LightPropagation/Conservative/SurfaceRadiance.h"
#include "Medium/BoxFaces.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace tyndall
{
namespace
{
/// Which faces of a block lie on the box's.
std::array<bool, 6> FacesAtBox(const VoxelBox& block, const Grid& whole, const std::array<bool, 3>& periodic)
{
  std::array<bool, 6> faces;
  for (int axis = 0; axis < 3; ++axis)
  {
    faces[2 * axis] = !periodic[axis] && block.first[axis] == 0;
    faces[2 * axis + 1] = !periodic[axis] && EndOf(block, axis) == whole.size[axis];
  }
  return faces;
}

/// Values of the cells of a block's faces, as many each, to those of the box's.
void PutCells(const std::vector<float>& ofBlock, const VoxelBox& block, const std::array<bool, 6>& faces,
  const Grid& grid, const Grid& whole, std::vector<double>& all)
{
  const std::size_t width = ofBlock.size() / BoxFaceCellCount(grid);
  ForBoxFaceCells(grid, [&](const BoxFaceCell& cell) {
    if (!faces[cell.face])
    {
      return;
    }
    const BoxFaceLayout layout = LayoutOfFace(whole, cell.face);
    const std::array<int, 3> voxel = grid.VoxelAt(cell.voxel);
    std::size_t place = layout.first;
    for (int axis = 0; axis < 3; ++axis)
    {
      place += (block.first[axis] + voxel[axis]) * layout.step[axis];
    }
    std::copy_n(ofBlock.begin() + static_cast<std::ptrdiff_t>(cell.number * width), width,
      all.begin() + static_cast<std::ptrdiff_t>(place * width));
  });
}
}

std::vector<float> SurfaceRadianceInBlocks(Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const std::array<bool, 3>& periodic, int channels, const std::vector<Light>& lamps,
  const std::vector<SurfacePowers>& powers)
{
  const VoxelBox& block = partition.blocks[communicator.Rank()];
  const bool has = block.VoxelCount() > 0;
  const std::array<bool, 6> faces = FacesAtBox(block, partition.whole, periodic);
  const bool thick = has && IsThickAtFaces(medium, faces, channels);
  if (!OnAnyRank(communicator, thick))
  {
    return {};
  }
  std::vector<double> all;
  communicator.Collective([&] {
    all.assign(BoxFaceCellCount(partition.whole) * SurfaceCosines.size() * channels, 0.0);
    if (has)
    {
      PutCells(SurfaceRadiance(medium, faces, lamps, powers), block, faces, medium.grid, partition.whole, all);
    }
  });
  all = communicator.Sum(all);
  return { all.begin(), all.end() };
}
}
