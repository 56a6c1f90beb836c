#include "vtkRefractionOctree.h"

#include "Common/ArrayRanges.h"
#include "Common/ImageInput.h"
#include "Common/LightTransportData.h"
#include "Common/VectorArray.h"
#include "Photons/OctreeNodes.h"
#include "Ranks/WholeImage.h"
#include "Work/GuardedWork.h"

#include "vtkCellData.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

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

tyndall::Octree Build(vtkRefractionOctree* filter, vtkImageData* image)
{
  const FloatField index = tyndall::ReadChosenCells(filter, RefractiveIndex, image, "ior", Need::Required, { 1 });
  FloatField sigma_a, sigma_s;
  if (filter->GetIncludeExtinction())
  {
    sigma_a = tyndall::ReadChosenCells(filter, Absorption, image, "sigma_a", Need::Required);
    sigma_s = tyndall::ReadChosenCells(filter, Scattering, image, "sigma_s", Need::Required);
  }
  tyndall::Medium medium;
  medium.grid = tyndall::GridOf(image);
  medium.sigma_a = sigma_a;
  medium.sigma_s = sigma_s;
  return tyndall::BuildOctree(medium, index, SettingsOf(filter), filter->GetDevice(), tyndall::MonitorOf(filter));
}

void AddLevels(vtkImageData* output, std::vector<std::uint8_t>&& levels)
{
  const auto array = tyndall::ArrayOf<vtkUnsignedCharArray>("octree_level", std::move(levels), 1);
  tyndall::LeaveRanges(array);
  output->GetCellData()->AddArray(array); // not SetScalars, which takes away what was active before
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
  return 1;
}

int vtkRefractionOctree::RequestInformation(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::TellSomeExtent(inputs[0], outputs);
  return 1;
}

int vtkRefractionOctree::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::AskForAll(request, inputs[0], outputs);
  return 1;
}

int vtkRefractionOctree::RequestData(
  vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->NodeCount = 0;
  this->Seconds = 0.0;
  this->DeviceName.clear();
  this->LeftOut.clear();
  return tyndall::Guarded(this, request, given, outputs, [&](vtkInformationVector** inputs) {
    vtkImageData* image = vtkImageData::GetData(inputs[0]);
    tyndall::Octree octree = Build(this, image);

    vtkHyperTreeGrid* const nodes = vtkHyperTreeGrid::GetData(outputs, 1);
    if (tyndall::IsFirstPiece(request, outputs))
    {
      this->NodeCount = tyndall::FillWithNodes(tyndall::GridOf(image), octree, nodes);
    }
    tyndall::TellExtent(tyndall::AskingPort(request, outputs), outputs->GetInformationObject(1), nodes->GetExtent());
    vtkImageData* output = vtkImageData::GetData(outputs, 0);
    tyndall::PassOn(image, output);
    AddLevels(output, std::move(octree.levels));
    tyndall::AddFact(output, "left_out", octree.leftOut);
    tyndall::AddFact(output, "device", std::vector<std::string>{ octree.device });
    tyndall::KeepWhatIsAskedFor(outputs->GetInformationObject(0), output);

    this->Seconds = octree.seconds;
    this->DeviceName = octree.device;
    this->LeftOut = tyndall::Lines(octree.leftOut);
  });
}

void vtkRefractionOctree::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "IncludeExtinction: " << this->IncludeExtinction << "\n";
  os << indent << "ExtinctionTolerance: " << this->ExtinctionTolerance << "\n";
  os << indent << "Device: " << this->Device << "\n";
  os << indent << "NodeCount: " << this->NodeCount << "\n";
  os << indent << "Seconds: " << this->Seconds << "\n";
  os << indent << "DeviceName: " << this->DeviceName << "\n";
  os << indent << "LeftOut: " << this->LeftOut << "\n";
}
