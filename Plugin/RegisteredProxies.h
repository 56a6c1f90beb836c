#ifndef RegisteredProxies_h
#define RegisteredProxies_h

#include "vtkCallbackCommand.h"
#include "vtkNew.h"
#include "vtkSMProxyManager.h"

/// Has `notice` called, from now on, with each proxy that is registered (its call data is a
/// vtkSMProxyManager::RegisteredProxyInformation).
/// @param listening  false before the first call; further calls change nothing
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
