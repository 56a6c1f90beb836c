#include "Photons/OctreeNodes.h"

#include "Common/ArrayRanges.h"
#include "Common/VectorArray.h"
#include "Device/HostThreads.h"

#include "vtkBitArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkHyperTree.h"
#include "vtkHyperTreeGrid.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
using Voxel = std::array<int, 3>;

/// Coordinates of the borders between roots along an axis.
vtkSmartPointer<vtkDoubleArray> Borders(const Grid& grid, int axis, int rootLevel)
{
  auto borders = vtkSmartPointer<vtkDoubleArray>::New();
  int voxel = 0;
  for (; voxel < grid.size[axis]; voxel += 1 << rootLevel)
  {
    borders->InsertNextValue(grid.origin[axis] + voxel * grid.spacing[axis]);
  }
  borders->InsertNextValue(grid.origin[axis] + voxel * grid.spacing[axis]);
  return borders;
}

/// A tree in breadth-first order, as vtkHyperTree needs it.
struct Tree
{
  std::vector<unsigned char> levels;  ///< of vertices
  std::vector<unsigned char> outside; ///< whether each vertex is outside the grid
  std::vector<unsigned char> refined; ///< whether each vertex is refined, without the deepest level, where none is
  vtkIdType nodes = 0;
};

class TreeDescriber
{
public:
  TreeDescriber(const Grid& grid, const BrickedBytes& levels)
    : TheGrid(grid)
    , TheLevels(levels)
  {
  }

  /// @param root  the root's lowest voxel
  Tree Describe(const Voxel& root, int rootLevel) const
  {
    Tree tree;
    std::vector<Voxel> vertices = { root };
    for (int level = rootLevel; !vertices.empty(); --level)
    {
      vertices = this->DescribeDepth(vertices, level, tree);
    }
    return tree;
  }

private:
  /// Appends the vertices of one depth to the tree.
  /// @return their children
  std::vector<Voxel> DescribeDepth(const std::vector<Voxel>& vertices, int level, Tree& tree) const
  {
    std::vector<Voxel> children;
    const std::size_t first = tree.refined.size(), firstOutside = tree.outside.size();
    tree.levels.insert(tree.levels.end(), vertices.size(), static_cast<unsigned char>(level));
    tree.outside.reserve(firstOutside + vertices.size());
    for (const Voxel& vertex : vertices)
    {
      tree.outside.push_back(this->IsOutside(vertex));
      tree.nodes += tree.outside.back() ? 0 : 1;
    }
    const int half = level > 0 ? 1 << (level - 1) : 0;
    for (std::size_t i = 0; i < vertices.size() && level > 0; ++i) // most vertices are single voxels
    {
      const Voxel& vertex = vertices[i];
      const bool divided = !tree.outside[firstOutside + i] && this->TheLevels.At(vertex) < level;
      tree.refined.push_back(divided);
      tree.nodes -= divided ? 1 : 0;
      for (int child = 0; child < 8 && divided; ++child)
      {
        children.push_back({ vertex[0] + (child & 1 ? half : 0), vertex[1] + (child & 2 ? half : 0),
          vertex[2] + (child & 4 ? half : 0) });
      }
    }
    tree.refined.resize(children.empty() ? first : tree.refined.size());
    return children;
  }

  bool IsOutside(const Voxel& voxel) const
  {
    const Voxel& size = this->TheGrid.size;
    return voxel[0] >= size[0] || voxel[1] >= size[1] || voxel[2] >= size[2];
  }

  const Grid& TheGrid;
  const BrickedBytes& TheLevels;
};

/// Builds the trees of some roots. They are independent of each other and are built in parallel.
std::vector<Tree> Build(
  const Grid& grid, const BrickedBytes& all, int rootLevel, const VoxelBox& roots, vtkHyperTreeGrid* nodes)
{
  const auto count = roots.VoxelCount();
  const TreeDescriber describer(grid, all);
  std::vector<Tree> trees(count);
  std::vector<vtkHyperTree*> built(count);
  std::vector<Voxel> places(count);
  Grid ofRoots;
  ofRoots.size = roots.size;
  for (std::size_t index = 0; index < count; ++index)
  {
    Voxel& root = places[index];
    root = ofRoots.VoxelAt(index);
    std::transform(root.begin(), root.end(), roots.first.begin(), root.begin(), std::plus<int>());
    vtkIdType tree = 0;
    nodes->GetIndexFromLevelZeroCoordinates(
      tree, static_cast<unsigned int>(root[0]), static_cast<unsigned int>(root[1]), static_cast<unsigned int>(root[2]));
    built[index] = nodes->GetTree(tree, true);
  }
  InThreads(count, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t index = begin; index < end; ++index)
    {
      const Voxel& root = places[index];
      Tree& tree = trees[index];
      tree = describer.Describe({ root[0] << rootLevel, root[1] << rootLevel, root[2] << rootLevel }, rootLevel);
      vtkNew<vtkBitArray> refined;
      refined->SetNumberOfValues(static_cast<vtkIdType>(tree.refined.size()));
      for (std::size_t i = 0; i < tree.refined.size(); ++i)
      {
        refined->SetValue(static_cast<vtkIdType>(i), tree.refined[i]);
      }
      built[index]->BuildFromBreadthFirstOrderDescriptor(refined, refined->GetNumberOfValues());
    }
  });
  vtkIdType start = 0;
  for (std::size_t index = 0; index < count; ++index)
  {
    built[index]->SetGlobalIndexStart(start);
    start += static_cast<vtkIdType>(trees[index].levels.size());
  }
  return trees;
}
}

OctreeRoots::OctreeRoots(const Grid& whole, int topLevel, int largest)
  : grid(whole)
  , level(std::max(largest, topLevel - 3))
{
}

VoxelBox OctreeRoots::Of(const VoxelBox& block) const
{
  const int edge = 1 << this->level;
  VoxelBox roots;
  for (int axis = 0; axis < 3 && block.VoxelCount() > 0; ++axis)
  {
    roots.first[axis] = (block.first[axis] + edge - 1) / edge;
    roots.size[axis] = (block.first[axis] + block.size[axis] + edge - 1) / edge - roots.first[axis];
  }
  return roots.VoxelCount() > 0 ? roots : VoxelBox();
}

VoxelBox OctreeRoots::VoxelsOf(const VoxelBox& roots) const
{
  VoxelBox voxels;
  for (int axis = 0; axis < 3 && roots.VoxelCount() > 0; ++axis)
  {
    const int end = (roots.first[axis] + roots.size[axis]) << this->level;
    voxels.first[axis] = roots.first[axis] << this->level;
    voxels.size[axis] = std::min(end, this->grid.size[axis]) - voxels.first[axis];
  }
  return voxels;
}

vtkIdType FillWithNodes(
  const OctreeRoots& all, const VoxelBox& roots, const BrickedBytes& ofRoots, vtkHyperTreeGrid* nodes)
{
  nodes->Initialize();
  if (roots.VoxelCount() == 0)
  {
    return 0;
  }
  const Grid& grid = all.grid;
  const int rootLevel = all.level;
  nodes->SetBranchFactor(2);
  nodes->SetXCoordinates(Borders(grid, 0, rootLevel));
  nodes->SetYCoordinates(Borders(grid, 1, rootLevel));
  nodes->SetZCoordinates(Borders(grid, 2, rootLevel));
  nodes->SetDimensions(static_cast<unsigned int>(nodes->GetXCoordinates()->GetNumberOfTuples()),
    static_cast<unsigned int>(nodes->GetYCoordinates()->GetNumberOfTuples()),
    static_cast<unsigned int>(nodes->GetZCoordinates()->GetNumberOfTuples()));

  std::vector<unsigned char> levels, outside;
  vtkIdType count = 0;
  for (const Tree& tree : Build(grid, ofRoots, rootLevel, roots, nodes))
  {
    levels.insert(levels.end(), tree.levels.begin(), tree.levels.end());
    outside.insert(outside.end(), tree.outside.begin(), tree.outside.end());
    count += tree.nodes;
  }
  if (std::find(outside.begin(), outside.end(), 1) != outside.end())
  {
    vtkNew<vtkBitArray> mask;
    mask->SetNumberOfValues(static_cast<vtkIdType>(outside.size()));
    for (std::size_t i = 0; i < outside.size(); ++i)
    {
      mask->SetValue(static_cast<vtkIdType>(i), outside[i]);
    }
    nodes->SetMask(mask);
  }
  const auto levelOfVertices = ArrayOf<vtkUnsignedCharArray>("octree_level", std::move(levels), 1);
  LeaveRanges(levelOfVertices);
  nodes->GetCellData()->SetScalars(levelOfVertices);
  return count;
}
}
