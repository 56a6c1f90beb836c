#include "Photons/OctreeNodes.h"

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
#include <vector>

namespace tyndall
{
namespace
{
using Voxel = std::array<int, 3>;

int RootLevel(const Octree& octree)
{
  const int largest = *std::max_element(octree.levels.begin(), octree.levels.end());
  return std::max(largest, octree.topLevel - 3);
}

/// Borders of the roots along an axis.
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

/// Describes trees one after the other, each breadth first, as vtkHyperTree wants it.
class Trees
{
public:
  Trees(const Grid& grid, const Octree& octree)
    : TheGrid(grid)
    , Levels(octree.levels.data())
  {
    this->VertexLevels->SetName("octree_level");
  }

  /// @param root  its lowest voxel
  void Describe(vtkHyperTree* tree, const Voxel& root, int rootLevel)
  {
    tree->SetGlobalIndexStart(this->VertexLevels->GetNumberOfValues());
    vtkNew<vtkBitArray> refined; // All but the last depth: no vertex of that is refined.
    std::vector<Voxel> vertices = { root };
    for (int level = rootLevel; !vertices.empty(); --level)
    {
      vertices = this->DescribeDepth(vertices, level, refined);
    }
    tree->BuildFromBreadthFirstOrderDescriptor(refined, refined->GetNumberOfValues());
  }

  vtkUnsignedCharArray* LevelOfVertices() { return this->VertexLevels; }
  vtkBitArray* MaskOfVertices() { return this->Masked; }
  bool AnyMasked() const { return this->MaskedCount > 0; }
  vtkIdType NodeCount() const { return this->Nodes; }

private:
  /// @return the children
  std::vector<Voxel> DescribeDepth(const std::vector<Voxel>& vertices, int level, vtkBitArray* refined)
  {
    std::vector<Voxel> children;
    std::vector<bool> divided;
    for (const Voxel& vertex : vertices)
    {
      const bool outside = this->IsOutside(vertex);
      divided.push_back(!outside && this->LevelAt(vertex) < level);
      this->VertexLevels->InsertNextValue(static_cast<unsigned char>(level));
      this->Masked->InsertNextValue(outside);
      this->MaskedCount += outside ? 1 : 0;
      this->Nodes += outside || divided.back() ? 0 : 1;
      for (int child = 0; child < 8 && divided.back(); ++child)
      {
        const int half = 1 << (level - 1);
        children.push_back({ vertex[0] + (child & 1 ? half : 0), vertex[1] + (child & 2 ? half : 0),
          vertex[2] + (child & 4 ? half : 0) });
      }
    }
    for (std::size_t i = 0; i < divided.size() && !children.empty(); ++i)
    {
      refined->InsertNextValue(divided[i]);
    }
    return children;
  }

  bool IsOutside(const Voxel& voxel) const
  {
    const Voxel& size = this->TheGrid.size;
    return voxel[0] >= size[0] || voxel[1] >= size[1] || voxel[2] >= size[2];
  }

  int LevelAt(const Voxel& voxel) const { return this->Levels[this->TheGrid.IndexOf(voxel)]; }

  const Grid& TheGrid;
  const std::uint8_t* Levels;
  vtkNew<vtkUnsignedCharArray> VertexLevels;
  vtkNew<vtkBitArray> Masked;
  vtkIdType MaskedCount = 0;
  vtkIdType Nodes = 0;
};
}

vtkIdType FillWithNodes(const Grid& grid, const Octree& octree, vtkHyperTreeGrid* nodes)
{
  const int rootLevel = RootLevel(octree);
  nodes->Initialize();
  nodes->SetBranchFactor(2);
  nodes->SetXCoordinates(Borders(grid, 0, rootLevel));
  nodes->SetYCoordinates(Borders(grid, 1, rootLevel));
  nodes->SetZCoordinates(Borders(grid, 2, rootLevel));
  nodes->SetDimensions(static_cast<unsigned int>(nodes->GetXCoordinates()->GetNumberOfTuples()),
    static_cast<unsigned int>(nodes->GetYCoordinates()->GetNumberOfTuples()),
    static_cast<unsigned int>(nodes->GetZCoordinates()->GetNumberOfTuples()));

  Trees trees(grid, octree);
  for (vtkIdType index = 0; index < nodes->GetMaxNumberOfTrees(); ++index)
  {
    unsigned int root[3];
    nodes->GetLevelZeroCoordinatesFromIndex(index, root[0], root[1], root[2]);
    trees.Describe(nodes->GetTree(index, true),
      { static_cast<int>(root[0] << rootLevel), static_cast<int>(root[1] << rootLevel),
        static_cast<int>(root[2] << rootLevel) },
      rootLevel);
  }
  if (trees.AnyMasked())
  {
    nodes->SetMask(trees.MaskOfVertices());
  }
  nodes->GetCellData()->SetScalars(trees.LevelOfVertices());
  return trees.NodeCount();
}
}
