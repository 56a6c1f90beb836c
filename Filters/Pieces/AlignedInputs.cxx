#include "Pieces/AlignedInputs.h"

#include "Device/Errors.h"
#include "Pieces/Ranks.h"

#include "vtkAlgorithm.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMatrix3x3.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <string>

namespace tyndall
{
vtkSmartPointer<vtkInformationVector> WithData(vtkInformationVector* given, const ChangeOfData& change)
{
  auto changed = vtkSmartPointer<vtkInformationVector>::New();
  bool any = false;
  for (int i = 0; i < given->GetNumberOfInformationObjects(); ++i)
  {
    vtkInformation* const information = given->GetInformationObject(i);
    vtkDataObject* const data = vtkDataObject::GetData(information);
    const vtkSmartPointer<vtkDataObject> other = change(i, data);
    if (other == data)
    {
      changed->Append(information);
      continue;
    }
    any = true;
    vtkNew<vtkInformation> replaced;
    replaced->Copy(information);
    replaced->Set(vtkDataObject::DATA_OBJECT(), other);
    changed->Append(replaced);
  }
  return any ? changed : nullptr;
}

AlignedInputs::AlignedInputs(vtkMultiProcessController* ranks, vtkAlgorithm* filter, vtkInformationVector** given)
  : ports(given, given + filter->GetNumberOfInputPorts())
  , Filter(filter)
{
  OnAllRanks(ranks, [&] { this->AlignGiven(given); });
  this->AgreeOnAxes(ranks);
  OnAllRanks(ranks, [&] { this->TurnGiven(); });
  this->NoteAveragedArrays();
}

/// Aligns the images at ports that are read as voxels, and their announced extents, with the world axes.
void AlignedInputs::AlignGiven(vtkInformationVector** given)
{
  for (int port = 0; port < this->Filter->GetNumberOfInputPorts(); ++port)
  {
    const VoxelArrays arrays = VoxelArraysOf(this->Filter->GetInputPortInformation(port));
    if (arrays.chosen.empty() && arrays.named.empty())
    {
      continue;
    }
    const vtkSmartPointer<vtkInformationVector> aligned =
      WithData(given[port], [](int, vtkDataObject* data) -> vtkSmartPointer<vtkDataObject> {
        auto* const image = vtkImageData::SafeDownCast(data);
        return image ? Aligned(image).GetPointer() : data;
      });
    for (int i = 0; aligned && i < aligned->GetNumberOfInformationObjects(); ++i)
    {
      vtkInformation* const information = aligned->GetInformationObject(i);
      vtkImageData* const before = vtkImageData::GetData(given[port], i);
      const auto ways = before ? WaysOf(before->GetSpacing(), before->GetDirectionMatrix()->GetData()) : std::nullopt;
      if (ways && information != given[port]->GetInformationObject(i) &&
        information->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()))
      {
        information->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(),
          ways->Extent(information->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT())).data(), 6);
      }
    }
    if (aligned)
    {
      this->ports[static_cast<std::size_t>(port)] = aligned;
    }
  }
}

/// Determines the medium axes (OwnAxes): the axes of the image at port 0, on any rank whose image has points.
/// Collective.
void AlignedInputs::AgreeOnAxes(vtkMultiProcessController* ranks)
{
  const bool reads =
    this->Filter->GetNumberOfInputPorts() > 0 && IsForImagesOfScene(this->Filter->GetInputPortInformation(0));
  const bool any = reads && this->ports[0]->GetNumberOfInformationObjects() > 0;
  this->Medium = any ? vtkDataObject::GetData(this->ports[0], 0) : nullptr;
  auto* const image = vtkImageData::SafeDownCast(this->Medium);
  this->Axes = OwnAxesOf(image);
  if (ranks && reads)
  {
    std::vector<double> words = this->Axes.Words();
    words.push_back(image && image->GetNumberOfPoints() > 0 ? 1.0 : 0.0);
    std::vector<double> all(words.size() * static_cast<std::size_t>(ranks->GetNumberOfProcesses()));
    ranks->AllGather(words.data(), all.data(), static_cast<vtkIdType>(words.size()));
    bool found = false;
    for (auto rank = all.begin(); rank != all.end(); rank += static_cast<std::ptrdiff_t>(words.size()))
    {
      const std::vector<double> said(rank, rank + static_cast<std::ptrdiff_t>(words.size()));
      const OwnAxes axes = OwnAxes::From(said);
      Require(!found || said.back() == 0.0 || axes.direction == this->Axes.direction,
        "The input lies in pieces on several ranks, which are turned by different direction matrices. Give all pieces "
        "of an image the same.");
      if (!found && said.back() > 0.0)
      {
        this->Axes = axes;
        found = true;
      }
    }
  }
  NoteOwnAxes(this->Filter, this->Axes);
}

/// Rotates the images at all ports into the axes of the image at port 0.
void AlignedInputs::TurnGiven()
{
  for (int port = 0; port < this->Filter->GetNumberOfInputPorts() && !this->Axes.AreThoseOfScene(); ++port)
  {
    const auto number = static_cast<std::size_t>(port);
    if (!IsForImagesOfScene(this->Filter->GetInputPortInformation(port)))
    {
      continue;
    }
    const vtkSmartPointer<vtkInformationVector> turned =
      WithData(this->ports[number], [&](int, vtkDataObject* data) -> vtkSmartPointer<vtkDataObject> {
        auto* const image = vtkImageData::SafeDownCast(data);
        return image ? InOwnAxes(image, this->Axes, this->Filter, port).GetPointer() : data;
      });
    if (turned)
    {
      this->ports[number] = turned;
    }
  }
}

void AlignedInputs::PutIntoScene(vtkInformationVector* outputs)
{
  tyndall::PutIntoScene(this->Filter, this->Axes, outputs, vtkImageData::SafeDownCast(this->Medium));
}

/// Records for each image the names of point arrays that are averaged to cells because cell arrays are read as well.
void AlignedInputs::NoteAveragedArrays()
{
  std::vector<std::string> averaged;
  for (std::size_t port = 0; port < this->ports.size(); ++port)
  {
    for (int i = 0; i < this->ports[port]->GetNumberOfInformationObjects(); ++i)
    {
      AreAroundPoints(this->Filter, static_cast<int>(port), vtkImageData::GetData(this->ports[port], i),
        averaged.empty() ? &averaged : nullptr);
    }
  }
  NoteAveraged(this->Filter, averaged);
}
}
