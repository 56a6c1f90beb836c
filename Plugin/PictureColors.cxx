#include "PictureColors.h"

#include "vtkCallbackCommand.h"
#include "vtkDataObject.h"
#include "vtkNew.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVXMLElement.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyManager.h"
#include "vtkSMPVRepresentationProxy.h" // RemotingViews wants GLEW; of it only inline and virtual functions are called
#include "vtkSMSourceProxy.h"
#include "vtkSMTransferFunctionProxy.h"

namespace
{
constexpr double LogarithmicFrom = 100.0; ///< largest over smallest value
constexpr double Decades = 1e-4;          ///< shown below the largest value where the smallest is 0

void ShowDirectColors(vtkSMProxy* representation)
{
  vtkSMPropertyHelper(representation, "MapScalars").Set(0);
  representation->UpdateVTKObjects();
}

/// What is shown: an output of a source.
struct Shown
{
  vtkSMSourceProxy* source;
  int port;
};

/// The cell array that the hint names, or null where the output does not have it.
vtkPVArrayInformation* HintedArray(const Shown& shown, vtkPVXMLElement* hint)
{
  int port = 0;
  const char* const name = hint->GetAttribute("array");
  if (!shown.source || !name || (hint->GetScalarAttribute("port", &port) && port != shown.port))
  {
    return nullptr;
  }
  return shown.source->GetDataInformation(shown.port)->GetArrayInformation(name, vtkDataObject::CELL);
}

/// @param colors  a map of colours that nobody has seen
void FitColors(vtkSMProxy* colors, vtkPVArrayInformation* array)
{
  double range[2];
  array->GetComponentRange(array->GetNumberOfComponents() > 1 ? -1 : 0, range); // -1: of the magnitude
  const bool spansDecades = range[1] > 0.0 && range[1] >= LogarithmicFrom * range[0];
  if (spansDecades && range[0] <= 0.0)
  {
    range[0] = Decades * range[1];
  }
  vtkSMTransferFunctionProxy::RescaleTransferFunction(colors, range);
  if (spansDecades)
  {
    vtkSMTransferFunctionProxy::MapControlPointsToLogSpace(colors);
    vtkSMPropertyHelper(colors, "UseLogScale").Set(1);
    colors->UpdateVTKObjects();
  }
}

void ColorBy(vtkSMProxy* representation, vtkPVArrayInformation* array)
{
  vtkSMPVRepresentationProxy::SetScalarColoring(representation, array->GetName(), vtkDataObject::CELL);
  vtkSMProxy* const colors = vtkSMPropertyHelper(representation, "LookupTable").GetAsProxy();
  if (colors && vtkSMPropertyHelper(colors, "ScalarRangeInitialized").GetAsInt() == 0)
  {
    FitColors(colors, array);
  }
}

/// A representation is registered when it knows its input, and before anybody sees it.
void Notice(vtkObject*, unsigned long, void*, void* data)
{
  const auto* registered = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(data);
  vtkSMProxy* const representation = registered->Proxy;
  if (registered->Type != vtkSMProxyManager::RegisteredProxyInformation::PROXY || !representation ||
    !representation->GetProperty("MapScalars") || !representation->GetProperty("Input"))
  {
    return;
  }
  const vtkSMPropertyHelper input(representation, "Input");
  const Shown shown = { vtkSMSourceProxy::SafeDownCast(input.GetAsProxy()), static_cast<int>(input.GetOutputPort()) };
  vtkPVXMLElement* const hints = shown.source ? shown.source->GetHints() : nullptr;
  if (hints && hints->FindNestedElementByName("DirectColors"))
  {
    ShowDirectColors(representation);
  }
  vtkPVXMLElement* const colored = hints ? hints->FindNestedElementByName("ColoredBy") : nullptr;
  if (vtkPVArrayInformation* const array = colored ? HintedArray(shown, colored) : nullptr)
  {
    ColorBy(representation, array);
  }
}
}

void ShowPicturesInTheirColors()
{
  static bool listening = false;
  vtkSMProxyManager* manager = vtkSMProxyManager::GetProxyManager();
  if (!listening && manager)
  {
    vtkNew<vtkCallbackCommand> command;
    command->SetCallback(Notice);
    manager->AddObserver(vtkCommand::RegisterEvent, command);
    listening = true;
  }
}
