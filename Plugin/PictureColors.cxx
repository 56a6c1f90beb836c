#include "PictureColors.h"

#include "vtkCallbackCommand.h"
#include "vtkNew.h"
#include "vtkPVXMLElement.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyManager.h"

namespace
{
bool HasDirectColors(vtkSMProxy* source)
{
  vtkPVXMLElement* hints = source ? source->GetHints() : nullptr;
  return hints && hints->FindNestedElementByName("DirectColors");
}

/// A representation is registered when it knows its input, and before anybody sees it.
void Notice(vtkObject*, unsigned long, void*, void* data)
{
  const auto* registered = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(data);
  if (registered->Type != vtkSMProxyManager::RegisteredProxyInformation::PROXY || !registered->Proxy ||
    !registered->Proxy->GetProperty("MapScalars") || !registered->Proxy->GetProperty("Input"))
  {
    return;
  }
  if (HasDirectColors(vtkSMPropertyHelper(registered->Proxy, "Input").GetAsProxy()))
  {
    vtkSMPropertyHelper(registered->Proxy, "MapScalars").Set(0);
    registered->Proxy->UpdateVTKObjects();
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
