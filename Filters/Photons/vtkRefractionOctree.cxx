#include "vtkRefractionOctree.h"

#include "Common/ArrayRanges.h"
#include "Common/ImageInput.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Common/VectorArray.h"
#include "Distribution/BrickedBytes.h"
#include "Photons/OctreeNodes.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/PieceBlocks.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"
#include "Refraction/Octree/RefractionOctree.h"

#include "vtkCellData.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace
{
using tyndall::FloatField;
using tyndall::Need;

/// Numbers of SetInputArrayToProcess.
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
  settings.extinctionTolerance = filter->GetExtinctionTolerance();
  return settings;
}

/// Fields that determine the octree.
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

/// Makes the trees whose roots begin in this rank's block. Collective. @return the number of nodes of all ranks
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
  output->GetCellData()->AddArray(array); // not SetScalars, which removes the previously active array
  output->GetCellData()->SetActiveScalars("octree_level");
}
}

vtkStandardNewMacro(vtkRefractionOctree);

vtkRefractionOctree::vtkRefractionOctree()
{
  const tyndall::OctreeSettings defaults;
  this->Tolerance = defaults.tolerance;
  this->IncludeExtinction = defaults.includeExtinction;
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
  tyndall::AddFact(output, "left_out", octree.leftOut);
  tyndall::AddFact(output, "device", std::vector<std::string>{ octree.device });
  this->Seconds = octree.seconds;
  this->DeviceName = octree.device;
  this->LeftOut = tyndall::Lines(octree.leftOut);
}

/// Computes the levels and trees of this rank's block. Collective.
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
  this->Seconds = 0.0;
  this->DeviceName.clear();
  this->LeftOut.clear();
  vtkHyperTreeGrid* const nodes = vtkHyperTreeGrid::GetData(outputs, 1);
  const bool isAlone = !tyndall::RanksTogether(request, outputs);
  tyndall::WorkOnSubdomains work;
  work.wantsPieces = [&](vtkInformationVector**) { return tyndall::EachAsksForItsPiece(request, outputs); };
  work.work = [&](const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs) {
    this->Build(pieces, vtkImageData::GetData(inputs[0]), outputs);
    if (isAlone && !tyndall::IsFirstPiece(request, outputs)) // that has all trees
    {
      nodes->Initialize();
      this->NodeCount = 0;
    }
    return true;
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
    PointData, Tolerance, IncludeExtinction, ExtinctionTolerance, Device, NodeCount, Seconds, DeviceName, LeftOut);
}
