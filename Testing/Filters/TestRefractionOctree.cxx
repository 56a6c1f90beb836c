#include "MediumScene.h"

#include "vtkCallbackCommand.h"
#include "vtkHyperTreeGrid.h"
#include "vtkHyperTreeGridNonOrientedGeometryCursor.h"
#include "vtkRefractionOctree.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace
{
/// n(x, y, z) of voxels
using Index = std::function<double(int, int, int)>;

vtkSmartPointer<vtkImageData> WithIndex(const test::Box& box, const Index& n)
{
  auto image = test::MakeImage(box);
  test::AddValues<vtkFloatArray>(image->GetCellData(), "ior", image->GetNumberOfCells(), 1, [&](vtkIdType i, int) {
    const auto cell = static_cast<int>(i);
    return n(cell % box.cells[0], cell / box.cells[0] % box.cells[1], cell / box.cells[0] / box.cells[1]);
  });
  return image;
}

double Waves(int x, int y, int z)
{
  return 1.3 + 0.1 * std::sin(0.2 * x) * std::cos(0.13 * y + 0.05 * z);
}

Index Noise()
{
  return
    [random = std::mt19937(3)](int, int, int) mutable { return std::uniform_real_distribution<>(1.0, 1.5)(random); };
}

vtkHyperTreeGrid* NodesOf(vtkRefractionOctree* filter)
{
  return vtkHyperTreeGrid::SafeDownCast(filter->GetOutputDataObject(1));
}

vtkUnsignedCharArray* LevelsOf(vtkRefractionOctree* filter)
{
  return vtkArrayDownCast<vtkUnsignedCharArray>(filter->GetOutput()->GetCellData()->GetArray("octree_level"));
}

/// Walks all leaves of a filter's second output and compares each with the levels of its first.
class LeavesAgainstLevels
{
public:
  LeavesAgainstLevels(test::Claims& claims, vtkRefractionOctree* filter, const test::Box& box)
    : TheClaims(claims)
    , Box(box)
    , Levels(LevelsOf(filter))
    , LeafLevels(vtkArrayDownCast<vtkUnsignedCharArray>(NodesOf(filter)->GetCellData()->GetArray("octree_level")))
    , Covered(static_cast<std::size_t>(filter->GetOutput()->GetNumberOfCells()), 0)
  {
    if (!claims.That(this->Levels && this->LeafLevels, "both outputs have octree_level"))
    {
      return;
    }
    vtkHyperTreeGrid* nodes = NodesOf(filter);
    vtkHyperTreeGrid::vtkHyperTreeGridIterator trees;
    nodes->InitializeTreeIterator(trees);
    vtkIdType tree = 0;
    vtkNew<vtkHyperTreeGridNonOrientedGeometryCursor> cursor;
    while (trees.GetNextTree(tree))
    {
      nodes->InitializeNonOrientedGeometryCursor(cursor, tree);
      this->Walk(cursor);
    }
    claims.That(std::all_of(this->Covered.begin(), this->Covered.end(), [](int times) { return times == 1; }),
      "every voxel lies in one leaf");
    claims.That(this->LeafLevels->GetNumberOfValues() == nodes->GetNumberOfElements(vtkDataObject::CELL),
      "every vertex has a level");
    claims.That(filter->GetNodeCount() == this->Leaves, "NodeCount is the number of leaves");
  }

  bool AllAgree() const { return this->Disagreements == 0; }
  vtkIdType LeafCount() const { return this->Leaves; }
  vtkIdType MaskedCount() const { return this->Masked; }

private:
  void Walk(vtkHyperTreeGridNonOrientedGeometryCursor* cursor)
  {
    if (cursor->IsLeaf())
    {
      this->Compare(cursor);
      return;
    }
    this->TheClaims.That(!cursor->IsMasked(), "nothing inside is masked");
    for (int child = 0; child < cursor->GetNumberOfChildren(); ++child)
    {
      cursor->ToChild(static_cast<unsigned char>(child));
      this->Walk(cursor);
      cursor->ToParent();
    }
  }

  void Compare(vtkHyperTreeGridNonOrientedGeometryCursor* cursor)
  {
    double bounds[6];
    cursor->GetBounds(bounds);
    const int level = this->LeafLevels->GetValue(cursor->GetGlobalNodeIndex());
    int lowest[3], end[3];
    bool outside = false;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double spacing = this->Box.spacing[axis];
      const double corner = this->Box.origin[axis] + this->Box.firstIndex[axis] * spacing;
      lowest[axis] = static_cast<int>(std::lround((bounds[2 * axis] - corner) / spacing));
      end[axis] = lowest[axis] + (1 << level);
      const double error = std::abs(bounds[2 * axis] - (corner + lowest[axis] * spacing)) +
        std::abs(bounds[2 * axis + 1] - (corner + end[axis] * spacing));
      this->Disagreements +=
        error < 1e-9 * (std::abs(corner) + end[axis] * spacing) && lowest[axis] % (1 << level) == 0 ? 0 : 1;
      outside = outside || lowest[axis] >= this->Box.cells[axis];
      end[axis] = std::min(end[axis], this->Box.cells[axis]);
    }
    this->Disagreements += cursor->IsMasked() == outside ? 0 : 1;
    ++(outside ? this->Masked : this->Leaves);
    for (int z = lowest[2]; z < end[2] && !outside; ++z)
    {
      for (int y = lowest[1]; y < end[1]; ++y)
      {
        for (int x = lowest[0]; x < end[0]; ++x)
        {
          const auto voxel = (z * this->Box.cells[1] + y) * this->Box.cells[0] + x;
          this->Disagreements += this->Levels->GetValue(voxel) == level ? 0 : 1;
          ++this->Covered[voxel];
        }
      }
    }
  }

  test::Claims& TheClaims;
  test::Box Box;
  vtkUnsignedCharArray* Levels;
  vtkUnsignedCharArray* LeafLevels;
  std::vector<int> Covered;
  vtkIdType Leaves = 0;
  vtkIdType Masked = 0;
  vtkIdType Disagreements = 0;
};

void LeavesEqualLevels(test::Claims& claims)
{
  const std::vector<test::Box> boxes = { { { 1, 1, 1 } }, { { 16, 16, 16 } }, { { 5, 3, 9 } },
    { { 1, 13, 6 }, { 0.1, 2.0, 3.0 }, { 1e3, 0.0, -5.0 }, { -3, 7, 2 } },
    { { 33, 1, 1 }, { 1.0, 0.3, 1.0 }, { 0.0, 0.0, 0.0 }, { 0, -100, 50 } },
    { { 31, 32, 17 }, { 1.0 / 3.0, 1.0, 0.7 }, { -7.1, 0.2, 0.0 }, { 11, 0, -8 } }, { { 70, 4, 3 } } };
  for (const test::Box& box : boxes)
  {
    const auto air = [](int, int, int) { return 1.0; };
    for (const Index& index : { Index(Waves), Noise(), Index(air) })
    {
      for (double tolerance : { 0.0, 0.02, 0.3 })
      {
        vtkNew<vtkRefractionOctree> filter;
        test::Errors errors(filter);
        filter->SetInputDataObject(WithIndex(box, index));
        filter->SetTolerance(tolerance);
        filter->Update();
        claims.That(errors.None() && filter->GetOutput()->GetNumberOfCells() > 0, "any grid will do");
        const LeavesAgainstLevels leaves(claims, filter, box);
        claims.That(leaves.AllAgree(),
          "leaves equal levels, " + std::to_string(box.cells[0]) + " x " + std::to_string(box.cells[1]) + " x " +
            std::to_string(box.cells[2]) + ", tolerance " + std::to_string(tolerance));
        claims.That(
          leaves.LeafCount() + leaves.MaskedCount() == NodesOf(filter)->GetNumberOfLeaves(), "all leaves were seen");
      }
    }
  }
}

void LevelsAreThoseOfTheIndex(test::Claims& claims)
{
  // Two halves, the lower one even, the upper one a checkerboard.
  const test::Box box{ { 8, 8, 8 } };
  const auto index = [](int x, int y, int z) { return z < 4 ? 1.0 : 1.2 + 0.1 * ((x + y + z) % 2); };
  vtkNew<vtkRefractionOctree> filter;
  const auto image = WithIndex(box, index);
  filter->SetInputDataObject(image);
  filter->Update();
  vtkUnsignedCharArray* levels = LevelsOf(filter);
  if (!claims.That(levels && levels->GetNumberOfValues() == 512, "octree_level is uint8, one a voxel"))
  {
    return;
  }
  for (int voxel = 0; voxel < 512; ++voxel)
  {
    claims.That(levels->GetValue(voxel) == (voxel < 256 ? 2 : 0), "level of voxel " + std::to_string(voxel));
  }
  claims.That(filter->GetNodeCount() == 4 + 256, "4 nodes of 4^3 voxels, 256 voxels");
  claims.That(filter->GetOutput()->GetCellData()->GetArray("ior") != nullptr, "the input is passed on");
  claims.That(!image->GetCellData()->GetArray("octree_level") && image->GetFieldData()->GetNumberOfArrays() == 0,
    "the input stays as it is");
  auto* device = vtkArrayDownCast<vtkStringArray>(filter->GetOutput()->GetFieldData()->GetAbstractArray("device"));
  claims.That(device && device->GetValue(0) == filter->GetDeviceName() && !device->GetValue(0).empty(), "device");

  filter->SetTolerance(0.15);
  filter->Update();
  claims.That(LevelsOf(filter)->GetRange()[0] == 2 && LevelsOf(filter)->GetRange()[1] == 2, "a checkerboard of 0.1");
  test::Errors errors(filter);
  filter->SetTolerance(2.0);
  filter->Update();
  claims.That(filter->GetTolerance() == 2.0 && errors.WasOneWith("Tolerance is 2; it must be at least 0 and at most 1"),
    "Tolerance is not clamped, but refused");
  filter->SetTolerance(1.0);
  filter->Update();
  claims.That(filter->GetNodeCount() == 1 && LevelsOf(filter)->GetRange()[0] == 3, "one node of 8^3 voxels");
}

void ExtinctionCounts(test::Claims& claims)
{
  const test::Box box{ { 8, 8, 8 }, { 0.5, 0.5, 0.5 } };
  const auto image = WithIndex(box, [](int, int, int) { return 1.0; });
  test::AddCells(image, "sigma_a", 0.25);
  test::AddValues<vtkFloatArray>(
    image->GetCellData(), "sigma_s", 512, 3, [](vtkIdType i, int c) { return c == 1 && i % 8 < 4 ? 0.1 : 0.0; });
  vtkNew<vtkRefractionOctree> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(image);
  filter->Update();
  claims.That(filter->GetNodeCount() == 1, "extinction does not count by default");
  filter->IncludeExtinctionOn();
  const double thickness = 0.1 * std::sqrt(3.0) * 4.0; // of the whole box's diagonal
  filter->SetExtinctionTolerance(0.99 * thickness);
  filter->Update();
  claims.That(filter->GetNodeCount() == 8 && LevelsOf(filter)->GetRange()[0] == 2, "extinction divides the box");
  filter->SetExtinctionTolerance(1.01 * thickness);
  filter->Update();
  claims.That(filter->GetNodeCount() == 1, "a thin box is whole");
  claims.That(std::string(filter->GetLeftOut()).find("refractive index is constant") != std::string::npos, "LeftOut");
  claims.That(errors.None(), "no errors");
  image->GetCellData()->RemoveArray("sigma_s");
  image->Modified();
  filter->Update();
  claims.That(errors.WasOneWith("no array 'sigma_s'"), "included extinction must be there");
}

void OtherArraysCanBeChosen(test::Claims& claims)
{
  const auto image = test::MakeImage({ { 2, 1, 1 } });
  test::AddCells(image, "ior", -1.0);
  const int count = static_cast<int>(image->GetNumberOfPoints());
  test::AddValues<vtkDoubleArray>(
    image->GetPointData(), "n", count, 1, [](vtkIdType i, int) { return 1.0 + i % 3 * 0.1; });
  vtkNew<vtkRefractionOctree> filter;
  test::Errors errors(filter);
  filter->SetInputDataObject(image);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "n");
  filter->SetPointData(vtkRefractionOctree::AVERAGE_TO_CELLS);
  filter->SetTolerance(0.09);
  filter->Update();
  claims.That(errors.None() && filter->GetNodeCount() == 2, "points averaged to cells 1.05 and 1.15 are two nodes");
  filter->SetTolerance(0.11);
  filter->Update();
  claims.That(errors.None() && filter->GetNodeCount() == 1, "or one");
}

void AConstantIndexNeedsNoDevice(test::Claims& claims)
{
  vtkNew<vtkRefractionOctree> filter;
  test::Errors errors(filter);
  filter->SetDevice("no such device");
  filter->SetInputDataObject(WithIndex({ { 100, 30, 7 } }, [](int, int, int) { return 1.33; }));
  filter->Update();
  claims.That(errors.None() && filter->GetNodeCount() == 1, "a constant index is one node");
  claims.That(LevelsOf(filter)->GetRange()[0] == 7 && LevelsOf(filter)->GetRange()[1] == 7, "of 128 voxels an edge");
  claims.That(filter->GetDeviceName()[0] == '\0' && filter->GetLeftOut()[0] != '\0', "nothing ran on a device");
  filter->LeaveOutOff();
  filter->Update();
  claims.That(errors.WasOneWith("no such device"), "unless a constant index is not left out");
  filter->LeaveOutOn();
  filter->SetInputDataObject(WithIndex({ { 10, 3, 7 } }, Waves));
  filter->Update();
  claims.That(errors.WasOneWith("no such device"), "another index needs one");
}

/// As ParaView does, one port after the other.
void BothPortsAreMadeAtOnce(test::Claims& claims)
{
  for (const test::Box& box : { test::Box{ { 40, 23, 17 } }, test::Box{ { 5, 3, 64 } } })
  {
    vtkNew<vtkRefractionOctree> filter;
    int runs = 0;
    vtkNew<vtkCallbackCommand> count;
    count->SetClientData(&runs);
    count->SetCallback([](vtkObject*, unsigned long, void* data, void*) { ++*static_cast<int*>(data); });
    filter->AddObserver(vtkCommand::StartEvent, count);
    filter->SetInputDataObject(WithIndex(box, Waves));
    for (int time = 1; time <= 3; ++time)
    {
      filter->SetTolerance(0.01 * time);
      for (int port : { 0, 1, 0, 1 })
      {
        filter->Update(time == 3 ? 1 - port : port);
      }
      claims.That(runs == time,
        "the octree is built once for both ports, not " + std::to_string(runs) + " times in " + std::to_string(time));
      claims.That(NodesOf(filter)->GetNumberOfLeaves() > 1 && LevelsOf(filter), "both ports have theirs");
    }
  }
}

void BadInputIsOneError(test::Claims& claims)
{
  vtkNew<vtkRefractionOctree> filter;
  test::Errors errors(filter);
  const test::Box box{ { 3, 4, 5 } };
  const auto refused = [&](vtkImageData* image, const std::string& part) {
    filter->SetInputDataObject(image);
    filter->Update();
    claims.That(errors.WasOneWith(part), "refused: " + part);
    claims.That(filter->GetOutput()->GetNumberOfCells() == 0 &&
        NodesOf(filter)->GetNumberOfElements(vtkDataObject::CELL) == 0 && filter->GetNodeCount() == 0,
      "the outputs are empty: " + part);
  };
  const auto good = WithIndex(box, Waves);
  filter->SetInputDataObject(good);
  filter->Update();
  claims.That(errors.None() && filter->GetNodeCount() > 1, "good input");

  auto image = test::MakeImage(box);
  test::AddCells(image, "density", 1.0);
  refused(image, "no array 'ior'. Its cell arrays: 'density'");
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "foo");
  refused(WithIndex(box, Waves), "no array 'foo'. Its cell arrays: 'ior'");
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "ior");
  image = test::MakeImage(box);
  test::AddCells(image, "ior", 1.0, 3);
  refused(image, "'ior' has 3 components; it must have 1");
  for (double wrong : { std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 0.0, -1.5 })
  {
    image = WithIndex(box, Waves);
    image->GetCellData()->GetArray("ior")->SetComponent(16, 0, wrong);
    refused(image, "in voxel (1, 1, 1)");
  }
  refused(test::MakeImage({ { 4, 4, 0 } }), "single layer of points along z");
  refused(vtkSmartPointer<vtkImageData>::New(), "is empty");
  filter->IncludeExtinctionOn();
  filter->SetExtinctionTolerance(-1.0);
  image = WithIndex(box, Waves);
  test::AddCells(image, "sigma_a", 0.5);
  test::AddCells(image, "sigma_s", 0.5);
  refused(image, "ExtinctionTolerance is -1");
  filter->SetExtinctionTolerance(1.0);
  image->GetCellData()->GetArray("sigma_a")->SetComponent(59, 0, -1.0);
  image->Modified();
  refused(image, "sigma_a is -1");

  filter->SetInputDataObject(good);
  filter->IncludeExtinctionOff();
  filter->Update();
  claims.That(errors.None() && filter->GetNodeCount() > 1, "good input after bad is taken");
}
}

int TestRefractionOctree(int, char*[])
{
  return test::WithDevice([](test::Claims& claims) {
    LeavesEqualLevels(claims);
    LevelsAreThoseOfTheIndex(claims);
    ExtinctionCounts(claims);
    OtherArraysCanBeChosen(claims);
    AConstantIndexNeedsNoDevice(claims);
    BothPortsAreMadeAtOnce(claims);
    BadInputIsOneError(claims);
  });
}
