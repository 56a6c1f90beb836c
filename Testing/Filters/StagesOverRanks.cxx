// vtkMeshVoxelizer, vtkRefractionOctree and vtkPhotonReconstruction in a pipeline that MPI ranks run together: each
// rank makes its piece of what one process makes of the whole. Run by mpiexec; a program by itself.

#include "MeshData.h"
#include "OverRanks.h"

#include "vtkMeshVoxelizer.h"
#include "vtkParticipatingMedium.h"
#include "vtkPhotonReconstruction.h"
#include "vtkRefractionOctree.h"

#include "Device/Device.h"

#include "vtkCellData.h"
#include "vtkCommunicator.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkRTAnalyticSource.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <string>

namespace
{
/// A ball of glass in coloured fog; and, of `even`, one of whose index nothing is bent.
void SetUp(vtkMeshVoxelizer* voxelizer, const std::array<int, 3>& size, bool even = false)
{
  voxelizer->SetInputDataObject(test::ToPolyData(shapes::Sphere({ 0.1, 0.2, 0.3 }, 1.0, 4)));
  voxelizer->SetSampleDimensions(size.data());
  voxelizer->SetModelBounds(-1.5, 1.5, -1.5, 1.5, -1.5, 1.5);
  voxelizer->SetFilterSize(5);
  voxelizer->SetOutsideScattering(0.1, 0.2, 0.3);
  voxelizer->SetScatteringNoise(0.3);
  voxelizer->SetInsideScattering(1.0, 1.0, 1.0);
  voxelizer->SetOutsideIndex(even ? 1.5 : 1.0);
}

class Ranks
{
public:
  explicit Ranks(vtkMPIController* controller)
    : Controller(controller)
    , Rank(controller->GetLocalProcessId())
    , Count(controller->GetNumberOfProcesses())
  {
  }

  bool Right() const { return this->AllRight; }

  void Expect(bool holds, const std::string& what)
  {
    if (!holds)
    {
      std::cerr << "rank " << this->Rank << " of " << this->Count << ": " << what << "\n";
      this->AllRight = false;
    }
  }

  /// Of the image on output 0 the piece of each rank, with ghost cells, against what one process makes of the whole.
  /// @param precision  of values, over the largest of their array
  void ExpectPieces(vtkAlgorithm* algorithm, const std::string& what, int ghosts, double precision = 0.0)
  {
    algorithm->Update();
    vtkNew<vtkImageData> whole;
    whole->DeepCopy(algorithm->GetOutputDataObject(0));
    algorithm->Modified();
    algorithm->UpdatePiece(this->Rank, this->Count, ghosts);
    auto* const piece = vtkImageData::SafeDownCast(algorithm->GetOutputDataObject(0));
    long own = 0, all = 0;
    vtkUnsignedCharArray* const flags = piece->GetCellGhostArray();
    for (vtkIdType i = 0; i < piece->GetNumberOfCells(); ++i)
    {
      own += flags && flags->GetValue(i) != 0 ? 0 : 1;
    }
    this->Controller->AllReduce(&own, &all, 1, vtkCommunicator::SUM_OP);
    this->Expect(all == whole->GetNumberOfCells(), what + ": pieces have " + std::to_string(all) + " cells");
    const vtkIdType most = whole->GetNumberOfCells() / this->Count * (ghosts > 0 ? 3 : 2);
    this->Expect(this->Count == 1 || whole->GetNumberOfCells() < 100 || piece->GetNumberOfCells() <= most,
      what + ": more than a piece");
    if (piece->GetNumberOfCells() > 0)
    {
      vtkNew<vtkImageData> wanted;
      wanted->ShallowCopy(whole);
      wanted->Crop(piece->GetExtent());
      this->ExpectSame(piece->GetCellData(), wanted->GetCellData(), what, whole->GetCellData(), precision);
      this->Expect(Fact(piece, "left_out") == Fact(whole, "left_out"), what + ": other left_out");
    }
  }

  vtkMPIController* Controller;
  const int Rank, Count;

private:
  static std::string Fact(vtkImageData* image, const char* name)
  {
    auto* const fact = vtkArrayDownCast<vtkStringArray>(image->GetFieldData()->GetAbstractArray(name));
    return fact && fact->GetNumberOfValues() > 0 ? fact->GetValue(0) : "";
  }

  void ExpectSame(
    vtkCellData* found, vtkCellData* wanted, const std::string& what, vtkCellData* whole, double precision)
  {
    for (int i = 0; i < wanted->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* const there = wanted->GetArray(i);
      vtkDataArray* const here = found->GetArray(there->GetName());
      bool same = here && here->GetNumberOfValues() == there->GetNumberOfValues() &&
        here->GetNumberOfComponents() == there->GetNumberOfComponents();
      for (vtkIdType value = 0; same && value < there->GetNumberOfValues(); ++value)
      {
        const double apart =
          std::abs(here->GetVariantValue(value).ToDouble() - there->GetVariantValue(value).ToDouble());
        same = apart <= precision * LargestOf(whole->GetArray(there->GetName()));
      }
      this->Expect(same, what + ": another " + there->GetName());
    }
  }

  static double LargestOf(vtkDataArray* array)
  {
    double largest = 0.0;
    for (int c = 0; c < array->GetNumberOfComponents(); ++c)
    {
      const double* const range = array->GetRange(c);
      largest = std::max({ largest, range[1], -range[0] });
    }
    return largest;
  }

  bool AllRight = true;
};

void VoxelsAreThoseOfTheWhole(Ranks& ranks)
{
  for (const std::array<int, 3>& size :
    { std::array<int, 3>{ 20, 17, 23 }, std::array<int, 3>{ 64, 3, 2 }, std::array<int, 3>{ 3, 1, 1 } })
  {
    for (const int ghosts : { 0, 1 })
    {
      vtkNew<vtkMeshVoxelizer> voxelizer;
      SetUp(voxelizer, size);
      voxelizer->Update();
      const double volume = voxelizer->GetOccupiedVolume();
      ranks.ExpectPieces(voxelizer, "voxels of " + std::to_string(size[0]), ghosts);
      ranks.Expect(std::abs(voxelizer->GetOccupiedVolume() - volume) <= 1e-9 * volume, "another OccupiedVolume");
    }
  }
  vtkNew<vtkMeshVoxelizer> even;
  SetUp(even, { 12, 12, 12 }, true);
  ranks.ExpectPieces(even, "voxels of one index", 0);
  vtkNew<vtkMeshVoxelizer> empty; // then nothing varies on any rank
  SetUp(empty, { 12, 12, 12 });
  empty->SetModelBounds(2.0, 3.0, 2.0, 3.0, 2.0, 3.0);
  ranks.ExpectPieces(empty, "voxels without a mesh", 0);
}

void LevelsAreThoseOfTheWhole(Ranks& ranks)
{
  for (const int ghosts : { 0, 1 })
  {
    for (const std::array<int, 3>& size : { std::array<int, 3>{ 32, 31, 33 }, std::array<int, 3>{ 3, 1, 1 } })
    {
      vtkNew<vtkMeshVoxelizer> voxelizer;
      SetUp(voxelizer, size);
      vtkNew<vtkRefractionOctree> octree;
      octree->SetInputConnection(voxelizer->GetOutputPort());
      octree->SetTolerance(0.05);
      octree->SetIncludeExtinction(true);
      octree->Update();
      const vtkIdType nodes = octree->GetNodeCount();
      ranks.ExpectPieces(octree, "levels of " + std::to_string(size[0]), ghosts);
      ranks.Expect(octree->GetNodeCount() == nodes, "another NodeCount");
      auto* const tree = vtkHyperTreeGrid::SafeDownCast(octree->GetOutputDataObject(1));
      vtkIdType leaves = tree->GetNumberOfLeaves();
      const bool all = ranks.Rank == 0 && (ranks.Count == 1 || size[0] < 32); // of few roots the first has all
      ranks.Expect(all ? leaves >= nodes : leaves < nodes, "trees are not where they begin");
    }
  }
}

/// Pieces share planes of points, whose voxels are those of the lower rank.
void VoxelsAroundPointsAreThoseOfTheWhole(Ranks& ranks)
{
  for (const int ghosts : { 0, 1 })
  {
    vtkNew<vtkRTAnalyticSource> points;
    points->SetWholeExtent(-3, 8, 0, 6, 2, 9);
    vtkNew<vtkParticipatingMedium> medium;
    medium->SetInputConnection(points->GetOutputPort());
    medium->SetMaximumDensity(300.0);
    ranks.ExpectPieces(medium, "a medium of points", ghosts);
    ranks.Expect(medium->GetPhysicalExtent() == std::string("1.2 x 0.7 x 0.8 cm"),
      std::string("the size of voxels around points: ") + medium->GetPhysicalExtent());
    vtkNew<vtkRefractionOctree> octree;
    octree->SetInputConnection(points->GetOutputPort());
    octree->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "RTData");
    octree->SetTolerance(20.0);
    ranks.ExpectPieces(octree, "levels of points", ghosts);
    vtkNew<vtkRefractionOctree> after;
    after->SetInputConnection(medium->GetOutputPort());
    after->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "RTData");
    after->SetTolerance(20.0);
    ranks.ExpectPieces(after, "levels of a medium of points", ghosts);
  }
}

/// Noisy light of each piece: of two batches, with directions, and bright on one side.
vtkSmartPointer<vtkImageData> NoisyLight(const std::array<int, 3>& size)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(size[0] + 1, size[1] + 1, size[2] + 1);
  vtkNew<vtkFloatArray> fluence, batches, directions;
  fluence->SetName("fluence");
  batches->SetName("fluence_batches");
  batches->SetNumberOfComponents(2);
  directions->SetName("mean_direction");
  directions->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
  {
    const double lit = i % size[0] > size[0] / 2 ? 5.0 : 1.0;
    const double a = lit * (1.0 + 0.3 * std::sin(1.7 * i)), b = lit * (1.0 + 0.3 * std::sin(2.9 * i + 1.0));
    batches->InsertNextTuple2(a, b);
    fluence->InsertNextValue(static_cast<float>(0.5 * (a + b)));
    directions->InsertNextTuple3(0.5, 0.1 * std::sin(0.3 * i), 0.2);
  }
  for (vtkFloatArray* array : { fluence.Get(), batches.Get(), directions.Get() })
  {
    image->GetCellData()->AddArray(array);
  }
  return image;
}

void LightIsSmoothedAsTheWhole(Ranks& ranks)
{
  for (const int scheme : { vtkPhotonReconstruction::CONSERVATIVE, vtkPhotonReconstruction::CONSTANT_RADIUS })
  {
    vtkNew<vtkPhotonReconstruction> smooth;
    smooth->SetInputDataObject(NoisyLight({ 97, 14, 11 }));
    smooth->SetScheme(scheme);
    smooth->Update();
    const double error = smooth->GetMeanError(), bias = smooth->GetBias();
    ranks.ExpectPieces(smooth, "smooth light, scheme " + std::to_string(scheme), ranks.Count == 3 ? 1 : 0, 1e-6);
    ranks.Expect(std::abs(smooth->GetMeanError() - error) <= 1e-6, "another MeanError");
    ranks.Expect(std::abs(smooth->GetBias() - bias) <= 1e-6, "another Bias");
  }
}

/// What goes wrong on one rank is one error on all.
void FailTogether(Ranks& ranks)
{
  const bool last = ranks.Rank == ranks.Count - 1;
  vtkNew<vtkMeshVoxelizer> voxelizer;
  SetUp(voxelizer, { 12, 12, 12 });
  vtkNew<test::Note> ofVoxels, ofOctree;
  voxelizer->AddObserver(vtkCommand::ErrorEvent, ofVoxels);
  voxelizer->AddMaterial(0.5, 1.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0); // no whole number
  if (!last)
  {
    voxelizer->RemoveAllMaterials();
  }
  voxelizer->UpdatePiece(ranks.Rank, ranks.Count, 0);
  ranks.Expect(ofVoxels->said.find("material") != std::string::npos, "no error of voxels: " + ofVoxels->said);
  vtkNew<vtkMeshVoxelizer> right;
  SetUp(right, { 12, 12, 12 });
  vtkNew<vtkRefractionOctree> octree;
  octree->AddObserver(vtkCommand::ErrorEvent, ofOctree);
  octree->SetInputConnection(right->GetOutputPort());
  octree->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, last ? "not there" : "ior");
  octree->UpdatePiece(ranks.Rank, ranks.Count, 0);
  ranks.Expect(ofOctree->said.find("not there") != std::string::npos, "no error of the octree: " + ofOctree->said);
}
}

int main(int argc, char* argv[])
{
  return test::RunOverRanks(argc, argv, [](vtkMPIController* controller) {
    tyndall::Device::Find();
    Ranks ranks(controller);
    VoxelsAreThoseOfTheWhole(ranks);
    LevelsAreThoseOfTheWhole(ranks);
    LightIsSmoothedAsTheWhole(ranks);
    VoxelsAroundPointsAreThoseOfTheWhole(ranks);
    FailTogether(ranks);
    return ranks.Right();
  });
}
