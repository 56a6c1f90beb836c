#include "FreshResults.h"

#include "RegisteredProxies.h"

#include "vtkCallbackCommand.h"
#include "vtkCollection.h"
#include "vtkNew.h"
#include "vtkPVXMLElement.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"

namespace
{
using Information = vtkSMProxyManager::RegisteredProxyInformation;

void ReadResults(vtkObject* caller, unsigned long, void*, void*)
{
  vtkSMProxy::SafeDownCast(caller)->UpdatePropertyInformation();
}

/// What a frame was drawn with.
void ReadExposures(vtkObject* view, unsigned long, void*, void* isInteractive)
{
  const vtkSMPropertyHelper representations(vtkSMProxy::SafeDownCast(view), "Representations", true);
  const bool moves = isInteractive && *static_cast<int*>(isInteractive) != 0;
  for (unsigned int i = 0; !moves && i < representations.GetNumberOfElements(); ++i)
  {
    vtkSMProxy* const shown = representations.GetAsProxy(i);
    vtkSMProperty* const used = shown ? shown->GetProperty("UsedExposure") : nullptr;
    if (used && vtkSMPropertyHelper(shown, "Visibility", true).GetAsInt() != 0)
    {
      shown->UpdatePropertyInformation(used);
    }
  }
}

vtkCallbackCommand* CommandOf(void (*function)(vtkObject*, unsigned long, void*, void*))
{
  auto* const command = vtkCallbackCommand::New();
  command->SetCallback(function);
  return command;
}

void Observe(vtkSMProxy* proxy, unsigned long event, vtkCallbackCommand* command)
{
  if (!proxy->HasObserver(event, command))
  {
    proxy->AddObserver(event, command);
  }
}

void Notice(vtkObject*, unsigned long, void*, void* data)
{
  static vtkCallbackCommand* const read = CommandOf(ReadResults);
  static vtkCallbackCommand* const readExposures = CommandOf(ReadExposures);
  const auto* registered = static_cast<Information*>(data);
  vtkSMProxy* const proxy = registered->Type == Information::PROXY ? registered->Proxy : nullptr;
  if (!proxy)
  {
    return;
  }
  vtkPVXMLElement* const hints = proxy->GetHints();
  if (hints && hints->FindNestedElementByName("FreshResults"))
  {
    Observe(proxy, vtkCommand::UpdateDataEvent, read);
  }
  vtkNew<vtkCollection> views; // some are older than the plugin
  proxy->GetSessionProxyManager()->GetProxies("views", views);
  for (int i = 0; i < views->GetNumberOfItems(); ++i)
  {
    Observe(vtkSMProxy::SafeDownCast(views->GetItemAsObject(i)), vtkCommand::EndEvent, readExposures);
  }
}
}

void FollowResults()
{
  static bool listening = false;
  FollowRegisteredProxies(listening, Notice);
}
