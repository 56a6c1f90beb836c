#include "FreshResults.h"

#include "RegisteredProxies.h"

#include "vtkCollection.h"
#include "vtkNew.h"
#include "vtkPVSessionBase.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkWeakPointer.h"

#include <algorithm>
#include <vector>

namespace
{
/// Sessions whose server has ended. Their properties must not be requested. ParaView 5.11 parses the reply to PullState
/// without checking that it arrived: asking such a server for properties aborts the client.
std::vector<vtkWeakPointer<vtkObject>>& LostSessions()
{
  static std::vector<vtkWeakPointer<vtkObject>> sessions;
  return sessions;
}

bool IsLost(vtkObject* session)
{
  const auto& lost = LostSessions();
  return std::find(lost.begin(), lost.end(), session) != lost.end();
}

void NoteLoss(vtkObject* session, unsigned long, void*, void*)
{
  if (!IsLost(session))
  {
    LostSessions().emplace_back(session);
  }
}

void ReadResults(vtkObject* caller, unsigned long, void*, void*)
{
  auto* const proxy = vtkSMProxy::SafeDownCast(caller);
  if (!IsLost(proxy->GetSession()))
  {
    proxy->UpdatePropertyInformation();
  }
}

/// Reads the exposures (property UsedExposure) with which a view's visible representations rendered a frame, unless the
/// view moves (interactive rendering).
void ReadExposures(vtkObject* view, unsigned long, void*, void* isInteractive)
{
  const vtkSMPropertyHelper representations(vtkSMProxy::SafeDownCast(view), "Representations", true);
  const bool moves = isInteractive && *static_cast<int*>(isInteractive) != 0;
  for (unsigned int i = 0; !moves && i < representations.GetNumberOfElements(); ++i)
  {
    vtkSMProxy* const shown = representations.GetAsProxy(i);
    vtkSMProperty* const used = shown ? shown->GetProperty("UsedExposure") : nullptr;
    if (used && !IsLost(shown->GetSession()) && vtkSMPropertyHelper(shown, "Visibility", true).GetAsInt() != 0)
    {
      shown->UpdatePropertyInformation(used);
    }
  }
}

void Notice(vtkObject*, unsigned long, void*, void* data)
{
  static vtkCallbackCommand* const read = CommandOf(ReadResults);
  static vtkCallbackCommand* const readExposures = CommandOf(ReadExposures);
  static vtkCallbackCommand* const noteLoss = CommandOf(NoteLoss);
  vtkSMProxy* const proxy = RegisteredProxy(data);
  if (!proxy)
  {
    return;
  }
  Observe(proxy->GetSession(), vtkPVSessionBase::ConnectionLost, noteLoss);
  if (HintOf(proxy, "FreshResults"))
  {
    Observe(proxy, vtkCommand::UpdateDataEvent, read);
  }
  vtkNew<vtkCollection> views; // includes views that existed before the plugin was loaded
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
