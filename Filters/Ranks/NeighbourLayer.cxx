#include "Ranks/NeighbourLayer.h"

#include "vtkImageData.h"
#include "vtkMultiProcessController.h"

#ifdef TYNDALL_HAS_GHOST_CELLS
#include "Ranks/Ranks.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkGhostCellsGenerator.h"
#include "vtkMultiProcessStream.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <string>
#include <vector>
#endif

namespace tyndall
{
#ifdef TYNDALL_HAS_GHOST_CELLS
namespace
{
/// What arrays there are, in their order.
std::string ArraysInWords(vtkImageData* piece)
{
  std::string words;
  for (vtkDataSetAttributes* const of : { static_cast<vtkDataSetAttributes*>(piece->GetCellData()),
         static_cast<vtkDataSetAttributes*>(piece->GetPointData()) })
  {
    words += ";";
    for (int i = 0; i < of->GetNumberOfArrays(); ++i)
    {
      vtkAbstractArray* const array = of->GetAbstractArray(i);
      const std::string name = array->GetName() ? array->GetName() : "";
      if (name != vtkDataSetAttributes::GhostArrayName())
      {
        words += name + "," + std::to_string(array->GetDataType()) + "," +
          std::to_string(array->GetNumberOfComponents()) + ",";
      }
    }
  }
  return words;
}

/// Whether all that have cells have the same arrays: the same on all ranks.
bool AreAlike(vtkMultiProcessController* ranks, vtkImageData* piece)
{
  const bool any = piece && piece->GetNumberOfCells() > 0;
  vtkMultiProcessStream stream;
  stream << (any ? ArraysInWords(piece) : std::string());
  std::vector<vtkMultiProcessStream> streams;
  ranks->AllGather(stream, streams);
  std::string first;
  bool alike = true;
  for (vtkMultiProcessStream& from : streams)
  {
    std::string words;
    from >> words;
    alike = alike && (words.empty() || first.empty() || words == first);
    first = first.empty() ? words : first;
  }
  return alike;
}

constexpr const char* HiddenName = "tyndall_hidden";

vtkUnsignedCharArray* Bytes(vtkDataSetAttributes* of, const char* name)
{
  return vtkArrayDownCast<vtkUnsignedCharArray>(of->GetAbstractArray(name));
}

/// Flags of what is hidden, as an array like others: vtkGhostCellsGenerator of VTK 9.2 forgets those of points that
/// come from a rank across an edge.
void AddHidden(vtkDataSetAttributes* of, vtkIdType values, unsigned char flag)
{
  vtkUnsignedCharArray* const flags = Bytes(of, vtkDataSetAttributes::GhostArrayName());
  vtkNew<vtkUnsignedCharArray> hidden;
  hidden->SetName(HiddenName);
  for (vtkIdType i = 0; i < values; ++i)
  {
    hidden->InsertNextValue(flags ? flags->GetValue(i) & flag : 0);
  }
  of->AddArray(hidden);
}

void TakeHidden(vtkDataSetAttributes* of)
{
  vtkUnsignedCharArray* const flags = Bytes(of, vtkDataSetAttributes::GhostArrayName());
  vtkUnsignedCharArray* const hidden = Bytes(of, HiddenName);
  for (vtkIdType i = 0; flags && hidden && i < hidden->GetNumberOfValues(); ++i)
  {
    flags->SetValue(i, flags->GetValue(i) | hidden->GetValue(i));
  }
  of->RemoveArray(HiddenName);
}
}

vtkSmartPointer<vtkImageData> WithNeighbourLayer(vtkMultiProcessController* ranks, vtkImageData* piece)
{
  if (!AreAlike(ranks, piece))
  {
    return nullptr;
  }
  vtkNew<vtkImageData> own;
  if (piece && piece->GetNumberOfCells() > 0)
  {
    own->ShallowCopy(piece);
    AddHidden(own->GetCellData(), own->GetNumberOfCells(), vtkDataSetAttributes::HIDDENCELL);
    AddHidden(own->GetPointData(), own->GetNumberOfPoints(), vtkDataSetAttributes::HIDDENPOINT);
  }
  vtkSmartPointer<vtkImageData> surrounded;
  OnAllRanks(ranks, [&] {
    vtkNew<vtkGhostCellsGenerator> generator;
    generator->SetController(ranks);
    generator->SetInputData(own);
    generator->BuildIfRequiredOff();
    generator->SetNumberOfGhostLayers(1);
    generator->Update();
    surrounded = vtkImageData::SafeDownCast(generator->GetOutputDataObject(0));
    TakeHidden(surrounded->GetCellData());
    TakeHidden(surrounded->GetPointData());
  });
  return surrounded;
}
#else
vtkSmartPointer<vtkImageData> WithNeighbourLayer(vtkMultiProcessController*, vtkImageData*)
{
  return nullptr;
}
#endif
}
