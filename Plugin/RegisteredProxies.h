#ifndef RegisteredProxies_h
#define RegisteredProxies_h

#include "vtkCallbackCommand.h"
#include "vtkNew.h"
#include "vtkPVXMLElement.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyManager.h"

/// Makes a command that calls a function. The command is never destroyed, because the observed objects may exist until
/// the process ends.
inline vtkCallbackCommand* CommandOf(void (*function)(vtkObject*, unsigned long, void*, void*))
{
  auto* const command = vtkCallbackCommand::New();
  command->SetCallback(function);
  return command;
}

/// Adds an observer, unless the object has it already.
inline void Observe(vtkObject* object, unsigned long event, vtkCallbackCommand* command)
{
  if (!object->HasObserver(event, command))
  {
    object->AddObserver(event, command);
  }
}

/// The proxy that was registered.
/// @param data  call data of the vtkCommand::RegisterEvent
/// @return null if something else than a proxy was registered
inline vtkSMProxy* RegisteredProxy(void* data)
{
  using Information = vtkSMProxyManager::RegisteredProxyInformation;
  const auto* const registered = static_cast<Information*>(data);
  return registered->Type == Information::PROXY ? registered->Proxy : nullptr;
}

/// Returns the hint `name` of a proxy; null if there is none.
inline vtkPVXMLElement* HintOf(vtkSMProxy* proxy, const char* name)
{
  vtkPVXMLElement* const hints = proxy->GetHints();
  return hints ? hints->FindNestedElementByName(name) : nullptr;
}

/// Registers `notice` as observer of vtkCommand::RegisterEvent: `notice` is called for each proxy that is registered
/// from then on, with a vtkSMProxyManager::RegisteredProxyInformation as call data.
/// @param listening  whether `notice` is registered already; false before the first call. The first call sets it to
///   true, further calls have no effect
inline void FollowRegisteredProxies(bool& listening, void (*notice)(vtkObject*, unsigned long, void*, void*))
{
  vtkSMProxyManager* const manager = vtkSMProxyManager::GetProxyManager();
  if (!listening && manager)
  {
    vtkNew<vtkCallbackCommand> command;
    command->SetCallback(notice);
    manager->AddObserver(vtkCommand::RegisterEvent, command);
    listening = true;
  }
}

#endif
