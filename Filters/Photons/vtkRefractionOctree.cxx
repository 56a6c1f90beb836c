#include "vtkRefractionOctree.h"

#include "Common/ArrayRanges.h"
#include "Common/ImageInput.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Device/HostThreads.h"
#include "Distribution/BrickedBytes.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/PieceBlocks.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"
#include "Refraction/Octree/RefractionOctree.h"

#include "vtkBitArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkHyperTree.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkType.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
/// Root cells of the vtkHyperTreeGrid of an octree: cubes of 2^level voxels per edge. `level` is the larger of two: the
/// level of the largest node, and three less than the level of the cube that contains the grid. Roots then extend
/// little beyond the grid. Each rank builds the trees of the roots whose first voxel is in its block.
struct OctreeRoots
{
  /// Chooses the size of the root cells.
  /// @param whole  the grid of the domain
  /// @param topLevel  level of the cube that contains the grid
  /// @param largest  largest level of all nodes
  OctreeRoots(const Grid& whole, int topLevel, int largest);

  /// Range of the roots whose first voxel is in the block; its indices count roots.
  VoxelBox Of(const VoxelBox& block) const;
  VoxelBox VoxelsOf(const VoxelBox& roots) const; ///< voxels of a range of roots that lie within the grid

  Grid grid;
  int level;
};

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

using Voxel = std::array<int, 3>;

/// Coordinates of the boundaries between root cells along an axis, first and last boundary included.
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

/// Description of a tree in breadth-first order, as vtkHyperTree needs it. A vertex of the tree is a cube of voxels, an
/// inner node or a leaf.
struct Tree
{
  std::vector<unsigned char> levels;  ///< octree level of each vertex (cube of 2^level voxels per edge)
  std::vector<unsigned char> outside; ///< whether each vertex (cube of voxels) is outside the grid
  /// Whether each vertex (cube of voxels) has children; the deepest vertices, which have none, have no flag.
  std::vector<unsigned char> refined;
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

  /// Makes the description (Tree) of the octree in one root cell.
  /// @param root  the lowest voxel of the root cell
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
  /// Appends the vertices (cubes of 2^level voxels per edge) of one depth to the tree.
  /// @param vertices  the lowest voxel of each vertex
  /// @return the lowest voxels of the children of all vertices
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
    for (std::size_t i = 0; i < vertices.size() && level > 0; ++i) // level 0 is skipped: single voxels have no children
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

/// Builds the trees of a box of roots, in parallel.
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

/// Fills a vtkHyperTreeGrid with the trees of a box of roots; its coordinates are the boundaries of all roots. Leaves
/// are the octree's nodes, with their level as cell array `octree_level`; leaves entirely outside the grid are masked.
/// Without roots the vtkHyperTreeGrid is empty.
/// @param all  the root cells of the domain
/// @param roots  the roots whose trees to build
/// @param ofRoots  octree levels of all voxels of these roots
/// @return the number of octree nodes: leaves that are not masked
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
}

namespace
{
using tyndall::FloatField;
using tyndall::Need;

/// Indices of the input arrays, for SetInputArrayToProcess.
enum OctreeArray
{
  RefractiveIndex = 0,
  Absorption = 1,
  Scattering = 2,
};

tyndall::OctreeSettings SettingsOf(vtkRefractionOctree* filter)
{
  tyndall::OctreeSettings settings;
  settings.tolerance = filter->GetTolerance();
  settings.includeExtinction = filter->GetIncludeExtinction();
  settings.leaveOut = filter->GetLeaveOut();
  settings.extinctionTolerance = filter->GetExtinctionTolerance();
  return settings;
}

/// Arrays that determine the octree: refractive index and, with IncludeExtinction, the medium's coefficients.
struct Quantities
{
  FloatField index, sigma_a, sigma_s;
  tyndall::Medium medium;
};

Quantities Read(vtkRefractionOctree* filter, vtkImageData* image)
{
  Quantities read;
  read.index = tyndall::ReadChosenCells(filter, RefractiveIndex, image, "ior", Need::Required, { 1 });
  if (filter->GetIncludeExtinction())
  {
    read.sigma_a = tyndall::ReadChosenCells(filter, Absorption, image, "sigma_a", Need::Required);
    read.sigma_s = tyndall::ReadChosenCells(filter, Scattering, image, "sigma_s", Need::Required);
  }
  read.medium.grid = tyndall::GridOf(image);
  read.medium.sigma_a = read.sigma_a;
  read.medium.sigma_s = read.sigma_s;
  return read;
}

/// Builds the trees of the root cells whose first voxel is in this rank's block. Collective.
/// @return the number of nodes of all ranks
vtkIdType FillWithTrees(const tyndall::Domain& domain, const tyndall::Octree& octree, vtkHyperTreeGrid* nodes)
{
  const auto largest = std::max_element(octree.levels.begin(), octree.levels.end());
  const double ofAll = domain.Max(largest != octree.levels.end() ? *largest : 0);
  const tyndall::OctreeRoots roots(domain.Whole(), octree.topLevel, static_cast<int>(ofAll));
  std::vector<tyndall::VoxelBox> wanted;
  for (const tyndall::VoxelBox& block : domain.Partition().blocks)
  {
    wanted.push_back(roots.VoxelsOf(roots.Of(block)));
  }
  const tyndall::BrickedBytes levels = tyndall::BytesOfBoxes(domain.Comm(), domain.Partition(), octree.levels, wanted);
  double count = 0.0;
  domain.Collective(
    [&] { count = static_cast<double>(tyndall::FillWithNodes(roots, roots.Of(domain.Own()), levels, nodes)); });
  return static_cast<vtkIdType>(domain.Sum(count));
}

void AddLevels(vtkImageData* output, std::vector<std::uint8_t>&& levels)
{
  const auto array = tyndall::ArrayOf<vtkUnsignedCharArray>("octree_level", std::move(levels), 1);
  tyndall::LeaveRanges(array);
  output->GetCellData()->AddArray(array); // AddArray, because SetScalars would remove the previously active scalars
  output->GetCellData()->SetActiveScalars("octree_level");
}
}

vtkStandardNewMacro(vtkRefractionOctree);

vtkRefractionOctree::vtkRefractionOctree()
{
  const tyndall::OctreeSettings defaults;
  this->Tolerance = defaults.tolerance;
  this->IncludeExtinction = defaults.includeExtinction;
  this->LeaveOut = defaults.leaveOut;
  this->ExtinctionTolerance = defaults.extinctionTolerance;
  this->SetNumberOfOutputPorts(2);
}

vtkRefractionOctree::~vtkRefractionOctree() = default;

int vtkRefractionOctree::FillOutputPortInformation(int port, vtkInformation* information)
{
  information->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkHyperTreeGrid");
  return 1;
}

int vtkRefractionOctree::FillInputPortInformation(int, vtkInformation* information)
{
  tyndall::TakeImages(information);
  tyndall::ReadsVoxels(information, { "ior", "sigma_a", "sigma_s" });
  return 1;
}

int vtkRefractionOctree::RequestInformation(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::TellVoxels(this, 0, inputs[0], outputs);
  return 1;
}

int vtkRefractionOctree::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bool asPiece = tyndall::EachAsksForItsPiece(request, outputs);
  tyndall::AskForAllBut(asPiece ? 0 : -1, request, inputs, 1, outputs);
  return 1;
}

void vtkRefractionOctree::Write(vtkImageData* input, vtkImageData* output, tyndall::Octree&& octree)
{
  tyndall::NoteChoices(
    this, { { RefractiveIndex, "ior" }, { Absorption, "sigma_a" }, { Scattering, "sigma_s" } }, input, output);
  if (!octree.levels.empty())
  {
    AddLevels(output, std::move(octree.levels));
  }
  tyndall::TellLeftOut(this, output, octree.leftOut);
  tyndall::AddFact(output, "device", std::vector<std::string>{ octree.device });
  this->DeviceName = octree.device;
}

/// Computes the octree levels of this rank's block, and writes both outputs. Collective.
void vtkRefractionOctree::Build(const tyndall::PieceBlocks& pieces, vtkImageData* image, vtkInformationVector* outputs)
{
  const tyndall::Domain& domain = pieces.GetDomain();
  vtkSmartPointer<vtkImageData> own;
  Quantities read;
  domain.Collective([&] {
    own = pieces.OwnImage(image);
    if (own || domain.IsSerial())
    {
      read = Read(this, own);
    }
  });
  tyndall::Octree octree =
    tyndall::BuildOctree(domain, read.medium, read.index, SettingsOf(this), this->Device, tyndall::MonitorOf(this));
  this->NodeCount = FillWithTrees(domain, octree, vtkHyperTreeGrid::GetData(outputs, 1));
  if (pieces.IsDecomposed())
  {
    std::vector<float> levels(octree.levels.begin(), octree.levels.end());
    pieces.SpreadToHeld(levels, 1);
    octree.levels.assign(levels.begin(), levels.end());
  }
  vtkImageData* const output = vtkImageData::GetData(outputs, 0);
  tyndall::PassOn(image, output);
  pieces.KeepHeld(output);
  this->Write(image, output, std::move(octree));
}

int vtkRefractionOctree::RequestData(
  vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->NodeCount = 0;
  this->DeviceName.clear();
  vtkHyperTreeGrid* const nodes = vtkHyperTreeGrid::GetData(outputs, 1);
  const bool isAlone = !tyndall::RanksTogether(request, outputs);
  tyndall::WorkOnSubdomains work;
  work.wantsPieces = [&](vtkInformationVector**) { return tyndall::EachAsksForItsPiece(request, outputs); };
  work.work = [&](const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs) {
    this->Build(pieces, vtkImageData::GetData(inputs[0]), outputs);
    if (isAlone && !tyndall::IsFirstPiece(request, outputs)) // all trees belong to the first piece
    {
      nodes->Initialize();
      this->NodeCount = 0;
    }
    return true;
  };
  work.shareResults = [this](tyndall::Communicator& ranks) {
    tyndall::TakeFromFirstRank(ranks, this->NodeCount, this->DeviceName);
  };
  const int done = tyndall::Guarded(this, request, given, outputs, work);
  if (!tyndall::AreEmptied(outputs))
  {
    tyndall::TellExtent(tyndall::AskingPort(request, outputs), outputs->GetInformationObject(1), nodes->GetExtent());
  }
  return done;
}

void vtkRefractionOctree::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(
    PointData, Tolerance, IncludeExtinction, ExtinctionTolerance, LeaveOut, Device, NodeCount, DeviceName);
  tyndall::PrintRun(os, indent, this);
}
