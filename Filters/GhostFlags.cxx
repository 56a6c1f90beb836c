#include "GhostFlags.h"

#include "Device/Errors.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkExtentTranslator.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
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

namespace
{
/// Not where a filter works on its piece alone, cell by cell.
bool AsksForAll(vtkInformation* input)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  int update[6], whole[6];
  if (!input || !input->Has(Pipeline::UPDATE_EXTENT()) || !input->Has(Pipeline::WHOLE_EXTENT()))
  {
    return false;
  }
  input->Get(Pipeline::UPDATE_EXTENT(), update);
  input->Get(Pipeline::WHOLE_EXTENT(), whole);
  return std::equal(update, update + 6, whole);
}

/// Whether the cells that are no duplicates are the piece that VTK gives this rank of the whole extent: then the rank has the whole image,
/// and VTK itself has marked what is beyond its piece.
bool IsWholeWithMarks(vtkImageData* image, vtkInformation* input)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  int whole[6], piece[6];
  input->Get(Pipeline::WHOLE_EXTENT(), whole);
  vtkNew<vtkExtentTranslator> translator;
  translator->PieceToExtentThreadSafe(input->Get(Pipeline::UPDATE_PIECE_NUMBER()),
    input->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()), 0, whole, piece, vtkExtentTranslator::BLOCK_MODE, 0);
  int extent[6];
  image->GetExtent(extent);
  vtkUnsignedCharArray* const flags = Flags(image->GetCellData(), image->GetNumberOfCells());
  vtkIdType cell = 0;
  for (int k = extent[4]; k < std::max(extent[5], extent[4] + 1); ++k)
  {
    for (int j = extent[2]; j < std::max(extent[3], extent[2] + 1); ++j)
    {
      for (int i = extent[0]; i < std::max(extent[1], extent[0] + 1); ++i, ++cell)
      {
        const int at[3] = { i, j, k };
        bool own = true;
        for (int a = 0; a < 3; ++a)
        {
          own = own && at[a] >= piece[2 * a] && at[a] < std::max(piece[2 * a + 1], piece[2 * a] + 1);
        }
        if (own != ((flags->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL) == 0))
        {
          return false;
        }
      }
    }
  }
  return std::equal(extent, extent + 6, whole);
}
}

void CheckDuplicates(vtkAlgorithm* filter, vtkInformationVector* outputs)
{
  auto* const pieces = vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES();
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
      if (image && AsksForAll(filter->GetInputInformation(port, i)) &&
        Any(Flags(image->GetCellData(), image->GetNumberOfCells()), vtkDataSetAttributes::DUPLICATECELL) &&
        !IsWholeWithMarks(image, filter->GetInputInformation(port, i)))
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
