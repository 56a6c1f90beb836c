#ifndef RegisteredProxies_h
#define RegisteredProxies_h

#include "vtkCallbackCommand.h"
#include "vtkNew.h"
#include "vtkSMProxyManager.h"

/// Registers `notice` as observer of vtkCommand::RegisterEvent: `notice` is called for each proxy that is registered
/// from then on, with a vtkSMProxyManager::RegisteredProxyInformation as call data.
/// @param listening  whether `notice` is registered already: false before the first call, which sets it to true;
///   further calls have no effect
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
