#include "ViewCameras.h"

#include "ChangedProperty.h"
#include "RegisteredProxies.h"

#include "vtkCollection.h"
#include "vtkNew.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMProxySelectionModel.h"
#include "vtkSMSessionProxyManager.h"
// This file calls only inline and virtual functions of vtkSMViewProxy, so that the library RemotingViews, which needs
// GLEW, is not linked.
#include "vtkSMViewProxy.h"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace
{
vtkPVXMLElement* CameraHint(vtkSMProxy* source)
{
  return HintOf(source, "ViewCamera");
}

/// Whether the view shows an output of the source.
bool Shows(vtkSMProxy* view, vtkSMProxy* source)
{
  const vtkSMPropertyHelper representations(view, "Representations", true);
  for (unsigned int i = 0; i < representations.GetNumberOfElements(); ++i)
  {
    vtkSMProxy* const shown = representations.GetAsProxy(i);
    if (shown && vtkSMPropertyHelper(shown, "Input", true).GetAsProxy() == source &&
      vtkSMPropertyHelper(shown, "Visibility", true).GetAsInt() != 0)
    {
      return true;
    }
  }
  return false;
}

std::vector<vtkSMViewProxy*> Views(vtkSMSessionProxyManager* manager)
{
  vtkNew<vtkCollection> found;
  manager->GetProxies("views", found);
  std::vector<vtkSMViewProxy*> views;
  for (int i = 0; i < found->GetNumberOfItems(); ++i)
  {
    if (auto* const view = vtkSMViewProxy::SafeDownCast(found->GetItemAsObject(i)))
    {
      views.push_back(view);
    }
  }
  return views;
}

/// Finds the view whose camera is copied to the source (ViewCameras.h); null: none.
vtkSMViewProxy* ViewFor(vtkSMProxy* source)
{
  vtkSMSessionProxyManager* const manager = source->GetSessionProxyManager();
  std::vector<vtkSMViewProxy*> views = Views(manager);
  if (vtkSMProxySelectionModel* const active = manager->GetSelectionModel("ActiveView"))
  {
    views.insert(views.begin(), vtkSMViewProxy::SafeDownCast(active->GetCurrentProxy()));
  }
  int elsewhere = 0;
  CameraHint(source)->GetScalarAttribute("elsewhere", &elsewhere);
  const auto found = std::find_if(views.begin(), views.end(), [&](vtkSMViewProxy* view) {
    return view && view->GetProperty("CameraPositionInfo") && (elsewhere == 0 || !Shows(view, source));
  });
  return found == views.end() ? nullptr : *found;
}

std::vector<double> Numbers(vtkSMProxy* proxy, const std::string& property)
{
  const vtkSMPropertyHelper helper(proxy, property.c_str(), true);
  std::vector<double> numbers(helper.GetNumberOfElements());
  for (unsigned int i = 0; i < numbers.size(); ++i)
  {
    numbers[i] = helper.GetAsDouble(i);
  }
  return numbers;
}

void SetNumbers(vtkSMProxy* proxy, const std::string& property, const std::vector<double>& numbers)
{
  vtkSMPropertyHelper helper(proxy, property.c_str());
  for (unsigned int i = 0; i < numbers.size(); ++i)
  {
    helper.Set(i, numbers[i]);
  }
}

/// Current values of a camera property of the view. Changes by mouse are only in the corresponding "Info" property,
/// which a property has if the mouse can change it.
std::vector<double> OfView(vtkSMProxy* view, const std::string& property)
{
  const bool moves = view->GetProperty((property + "Info").c_str());
  return Numbers(view, moves ? property + "Info" : property);
}

/// Values for one property of the source, from the view's camera.
/// @param property  <Property> element of the source's hint (ViewCameras.h)
std::vector<double> Asked(vtkSMProxy* view, vtkPVXMLElement* property)
{
  std::vector<double> numbers = OfView(view, property->GetAttributeOrEmpty("of"));
  if (const char* const from = property->GetAttribute("from"))
  {
    const std::vector<double> begin = OfView(view, from);
    std::transform(numbers.begin(), numbers.end(), begin.begin(), numbers.begin(), std::minus<>());
  }
  return numbers;
}

/// Copies the view's camera to the source, as its hint requests.
/// @return whether any property of the source changed
bool Take(vtkSMProxy* view, vtkSMProxy* source)
{
  view->UpdatePropertyInformation();
  vtkPVXMLElement* const hint = CameraHint(source);
  bool changed = false;
  for (unsigned int i = 0; i < hint->GetNumberOfNestedElements(); ++i)
  {
    vtkPVXMLElement* const taken = hint->GetNestedElement(i);
    const std::string name = taken->GetAttributeOrEmpty("name");
    const std::vector<double> numbers = Asked(view, taken);
    if (!numbers.empty() && numbers != Numbers(source, name))
    {
      SetNumbers(source, name, numbers);
      changed = true;
    }
  }
  source->UpdateVTKObjects();
  return changed;
}

void DrawAgain(vtkSMProxy* source)
{
  for (vtkSMViewProxy* const view : Views(source->GetSessionProxyManager()))
  {
    if (Shows(view, source))
    {
      view->StillRender();
    }
  }
}

void Press(vtkObject* caller, unsigned long, void*, void* property)
{
  auto* const source = vtkSMProxy::SafeDownCast(caller);
  const char* const button = CameraHint(source)->GetAttributeOrEmpty("button");
  if (IsChangeOf(property, button))
  {
    if (vtkSMViewProxy* const view = ViewFor(source))
    {
      Take(view, source);
    }
  }
}

void Follow(vtkObject* caller, unsigned long, void*, void* isInteractive)
{
  // True while views are rendered because a source's camera changed, so that this does not cause another change.
  static bool drawing = false;
  auto* const view = vtkSMViewProxy::SafeDownCast(caller);
  if (drawing || (isInteractive && *static_cast<int*>(isInteractive) != 0))
  {
    return;
  }
  drawing = true;
  vtkNew<vtkCollection> sources;
  view->GetSessionProxyManager()->GetProxies("sources", sources);
  for (int i = 0; i < sources->GetNumberOfItems(); ++i)
  {
    auto* const source = vtkSMProxy::SafeDownCast(sources->GetItemAsObject(i));
    vtkPVXMLElement* const hint = CameraHint(source);
    const char* const follow = hint ? hint->GetAttributeOrEmpty("follow") : "";
    if (vtkSMPropertyHelper(source, follow, true).GetAsInt() != 0 && ViewFor(source) == view && Take(view, source))
    {
      DrawAgain(source);
    }
  }
  drawing = false;
}

void Notice(vtkObject*, unsigned long, void*, void* data)
{
  static vtkCallbackCommand* const press = CommandOf(Press);
  static vtkCallbackCommand* const follow = CommandOf(Follow);
  vtkSMProxy* const proxy = RegisteredProxy(data);
  if (!proxy)
  {
    return;
  }
  if (CameraHint(proxy))
  {
    Observe(proxy, vtkCommand::UpdatePropertyEvent, press);
  }
  // Includes views that existed before the plugin was loaded.
  for (vtkSMViewProxy* const view : Views(proxy->GetSessionProxyManager()))
  {
    Observe(view, vtkCommand::EndEvent, follow);
  }
}
}

void FollowViewCameras()
{
  static bool listening = false;
  FollowRegisteredProxies(listening, Notice);
}
