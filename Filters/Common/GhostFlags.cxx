#include "Common/GhostFlags.h"

#include "Device/Errors.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <string>

namespace tyndall
{
namespace
{
vtkUnsignedCharArray* Flags(vtkDataSetAttributes* attributes, vtkIdType count)
{
  auto* const flags =
    vtkArrayDownCast<vtkUnsignedCharArray>(attributes->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  return flags && flags->GetNumberOfTuples() == count && flags->GetNumberOfComponents() == 1 ? flags : nullptr;
}

bool Any(vtkUnsignedCharArray* flags, unsigned char flag)
{
  const unsigned char* const values = flags ? flags->GetPointer(0) : nullptr;
  return flags &&
    std::any_of(values, values + flags->GetNumberOfTuples(), [=](unsigned char value) { return (value & flag) != 0; });
}

/// The cells that have a point.
void HideAround(vtkImageData* image, vtkIdType point, std::vector<unsigned char>& hidden)
{
  int points[3];
  image->GetDimensions(points);
  const std::array<vtkIdType, 3> at = { point % points[0], point / points[0] % points[1],
    point / points[0] / points[1] };
  const std::array<vtkIdType, 3> cells = { std::max(points[0] - 1, 1), std::max(points[1] - 1, 1),
    std::max(points[2] - 1, 1) };
  for (vtkIdType corner = 0; corner < 8; ++corner)
  {
    const vtkIdType i = at[0] - (corner & 1), j = at[1] - (corner >> 1 & 1), k = at[2] - (corner >> 2);
    if (i >= 0 && i < cells[0] && j >= 0 && j < cells[1] && k >= 0 && k < cells[2])
    {
      hidden[static_cast<std::size_t>((k * cells[1] + j) * cells[0] + i)] = 1;
    }
  }
}
}

std::vector<unsigned char> HiddenCells(vtkImageData* image)
{
  vtkUnsignedCharArray* const ofCells = Flags(image->GetCellData(), image->GetNumberOfCells());
  vtkUnsignedCharArray* const ofPoints = Flags(image->GetPointData(), image->GetNumberOfPoints());
  const bool cellsHidden = Any(ofCells, vtkDataSetAttributes::HIDDENCELL);
  const bool pointsHidden = Any(ofPoints, vtkDataSetAttributes::HIDDENPOINT);
  if (!cellsHidden && !pointsHidden)
  {
    return {};
  }
  std::vector<unsigned char> hidden(static_cast<std::size_t>(image->GetNumberOfCells()), 0);
  for (vtkIdType i = 0; cellsHidden && i < image->GetNumberOfCells(); ++i)
  {
    hidden[static_cast<std::size_t>(i)] = ofCells->GetValue(i) & vtkDataSetAttributes::HIDDENCELL;
  }
  for (vtkIdType i = 0; pointsHidden && i < image->GetNumberOfPoints(); ++i)
  {
    if (ofPoints->GetValue(i) & vtkDataSetAttributes::HIDDENPOINT)
    {
      HideAround(image, i, hidden);
    }
  }
  return hidden;
}

std::vector<long long> PointsThatCount(vtkPolyData* data)
{
  constexpr unsigned char leftOut = vtkDataSetAttributes::HIDDENPOINT | vtkDataSetAttributes::DUPLICATEPOINT;
  vtkUnsignedCharArray* const flags = Flags(data->GetPointData(), data->GetNumberOfPoints());
  std::vector<long long> points;
  points.reserve(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    if (!flags || (flags->GetValue(i) & leftOut) == 0)
    {
      points.push_back(i);
    }
  }
  return points;
}

void CheckDuplicates(vtkAlgorithm* filter, vtkInformationVector* outputs)
{
  auto* const pieces = vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES();
  if (filter->IsA("vtkParticipatingMedium"))
  {
    return; // cell by cell: a duplicate's medium is that of the cell
  }
  bool divided = false;
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* const information = outputs->GetInformationObject(port);
    divided = divided || (information->Has(pieces) && information->Get(pieces) > 1);
  }
  for (int port = 0; divided && port < filter->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < filter->GetNumberOfInputConnections(port); ++i)
    {
      auto* const image = vtkImageData::SafeDownCast(filter->GetInputDataObject(port, i));
      if (image && Any(Flags(image->GetCellData(), image->GetNumberOfCells()), vtkDataSetAttributes::DUPLICATECELL))
      {
        throw InvalidInput(
          "Cells of the input image are marked as duplicates of another rank's (vtkGhostType). Light "
          "crosses the borders of pieces, so every rank works on the whole image, and would count them twice. "
          "Give it the whole image on every rank, without ghost cells.");
      }
    }
  }
}
}
